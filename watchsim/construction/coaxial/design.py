"""What makes the co-axial escapement a design?"""

from __future__ import annotations

from watchsim.construction.coaxial.dimensions import Coaxial
from watchsim.construction.coaxial.lever import banking, lever
from watchsim.construction.coaxial.points import Points
from watchsim.construction.coaxial.roller import roller
from watchsim.construction.coaxial.scene_text import scene_text
from watchsim.construction.coaxial.wheel import wheel
from watchsim.construction.design import Design
from watchsim.drawing.sheet import Sheet


def draw(values: Coaxial) -> dict[str, Sheet]:
    """Its four sheets. ValueError where a fillet does not fit."""
    points = Points(values)
    parts = {"escape_wheel": wheel(points), "lever": lever(points), "roller": roller(points), "banking": banking(points)}
    return {name: Sheet(tuple(loops)) for name, loops in parts.items()}


DESIGN = Design("coaxial", "Co-axial escapement with its balance", Coaxial, draw, scene_text)
