"""What makes the detent escapement a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.detent.detent_conflicts import conflicts
from watchsim.construction.detent.detent_dimensions import Detent
from watchsim.construction.detent.detent_scene import scene_text
from watchsim.construction.detent.detent_sheets import sheets

DESIGN = Design("detent", "Detent escapement of a marine chronometer with its balance", Detent, sheets, scene_text, conflicts)
