"""What makes the co-axial escapement a design?"""

from __future__ import annotations

from watchsim.construction.coaxial.coaxial_conflicts import conflicts
from watchsim.construction.coaxial.coaxial_dimensions import Coaxial
from watchsim.construction.coaxial.coaxial_scene import scene_text
from watchsim.construction.coaxial.coaxial_sheets import sheets
from watchsim.construction.design import Design

DESIGN = Design("coaxial", "Co-axial escapement with its balance", Coaxial, sheets, scene_text, conflicts)
