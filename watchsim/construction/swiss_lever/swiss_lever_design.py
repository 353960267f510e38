"""What makes the Swiss lever a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.swiss_lever.swiss_lever_conflicts import conflicts
from watchsim.construction.swiss_lever.swiss_lever_derived import swiss
from watchsim.construction.swiss_lever.swiss_lever_dimensions import SwissLever
from watchsim.construction.swiss_lever.swiss_lever_scene import scene_text
from watchsim.construction.swiss_lever.swiss_lever_sheets import sheets
from watchsim.drawing.sheet import Sheet


def draw(values: SwissLever) -> dict[str, Sheet]:
    """Its four sheets."""
    return sheets(swiss(values), values.balance_inertia)


DESIGN = Design("swiss_lever", "Swiss lever escapement with its balance", SwissLever, draw, scene_text, conflicts)
