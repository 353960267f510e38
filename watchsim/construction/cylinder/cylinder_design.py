"""What makes the cylinder escapement a design?"""

from __future__ import annotations

from watchsim.construction.cylinder.cylinder_conflicts import conflicts
from watchsim.construction.cylinder.cylinder_dimensions import Cylinder
from watchsim.construction.cylinder.cylinder_outlines import balance, wheel
from watchsim.construction.cylinder.cylinder_points import shell
from watchsim.construction.cylinder.cylinder_scene import scene_text
from watchsim.construction.design import Design
from watchsim.drawing.sheet import Sheet


def draw(values: Cylinder) -> dict[str, Sheet]:
    """Wheel, and balance with its cylinder."""
    made = shell(values)
    return {"escape_wheel": Sheet(tuple(wheel(made))), "balance": Sheet(tuple(balance(made)))}


DESIGN = Design("cylinder", "Cylinder escapement of a watch with its balance", Cylinder, draw, scene_text, conflicts)
