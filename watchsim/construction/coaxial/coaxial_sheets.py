"""Which sheets does a co-axial escapement need?"""

from __future__ import annotations

from watchsim.construction.coaxial.coaxial_dimensions import Coaxial
from watchsim.construction.coaxial.coaxial_lever import banking, lever
from watchsim.construction.coaxial.coaxial_points import Points
from watchsim.construction.coaxial.coaxial_roller import roller
from watchsim.construction.coaxial.coaxial_wheel import wheel
from watchsim.drawing.sheet import Sheet


def sheets(values: Coaxial) -> dict[str, Sheet]:
    """File name without ending -> the part. ValueError where a fillet does not fit."""
    points = Points(values)
    parts = {"escape_wheel": wheel(points), "lever": lever(points), "roller": roller(points), "banking": banking(points)}
    return {name: Sheet(tuple(loops)) for name, loops in parts.items()}
