"""What makes a tourbillon a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.outline import rounded
from watchsim.construction.swiss_lever.swiss_lever_conflicts import conflicts
from watchsim.construction.swiss_lever.swiss_lever_derived import swiss
from watchsim.construction.swiss_lever.swiss_lever_design import draw as draw_lever
from watchsim.construction.tourbillon.tourbillon_dimensions import Tourbillon
from watchsim.construction.tourbillon.tourbillon_scene import scene_text
from watchsim.drawing.sheet import Sheet
from watchsim.geometry.loop import Loop

# Shares of the distance from wheel to balance: a foot under the wheel, two arms over the balance.
BRIDGE = (
    *((-0.224, -1.178), (-0.112, -1.318), (0.112, -1.318), (0.224, -1.178), (0.154, 0.0), (0.365, 0.589), (0.28, 0.701)),
    *((0.0, 0.337), (-0.28, 0.701), (-0.365, 0.589), (-0.154, 0.0)),
)


def draw(values: Tourbillon) -> dict[str, Sheet]:
    """The sheets of the lever, and the carriage about the balance's axis."""
    scale = swiss(values).balance_pivot[1]
    bridge = Loop(tuple(rounded([(scale * x, scale * y, 0.0) for x, y in BRIDGE])), "BRIDGE")
    return {**draw_lever(values), "carriage": Sheet((bridge,))}


DESIGN = Design("tourbillon", "Swiss lever on the carriage of a tourbillon", Tourbillon, draw, scene_text, conflicts)
