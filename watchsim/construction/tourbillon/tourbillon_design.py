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

# Shares of the distance from wheel to balance, with each corner's radius: a foot under the wheel, two arms over the balance.
BRIDGE = (
    *((-0.23, -1.2, 0.1), (0.0, -1.34, 0.3), (0.23, -1.2, 0.1), (0.12, 0.0, 0.15), (0.38, 0.55, 0.05), (0.28, 0.71, 0.05)),
    *((0.0, 0.22, 0.08), (-0.28, 0.71, 0.05), (-0.38, 0.55, 0.05), (-0.12, 0.0, 0.15)),
)


def draw(values: Tourbillon) -> dict[str, Sheet]:
    """The sheets of the lever, and the carriage about the balance's axis."""
    scale = swiss(values).balance_pivot[1]
    bridge = Loop(tuple(rounded([(scale * x, scale * y, scale * radius) for x, y, radius in BRIDGE])), "BRIDGE")
    return {**draw_lever(values), "carriage": Sheet((bridge,))}


DESIGN = Design("tourbillon", "Swiss lever on the carriage of a tourbillon", Tourbillon, draw, scene_text, conflicts)
