"""What makes the detent escapement a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.detent.conflicts import conflicts
from watchsim.construction.detent.dimensions import Detent
from watchsim.construction.detent.scene_text import scene_text
from watchsim.construction.detent.sheets import sheets

DESIGN = Design("detent", "Detent escapement of a marine chronometer with its balance", Detent, sheets, scene_text, conflicts)
