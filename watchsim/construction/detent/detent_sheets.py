"""Which sheets does a detent escapement need?"""

from __future__ import annotations

from watchsim.construction.detent.detent_dimensions import Detent
from watchsim.construction.detent.detent_outlines import banking, detent, passing, roller, wheel
from watchsim.construction.detent.detent_points import Points
from watchsim.drawing.sheet import Sheet


def sheets(values: Detent) -> dict[str, Sheet]:
    """File name without ending -> the part. ValueError where a fillet does not fit."""
    points = Points(values)
    parts = {
        "escape_wheel": wheel(points),
        "detent": detent(points),
        "passing_spring": passing(points),
        "roller": roller(points),
        "banking": banking(points),
    }
    return {name: Sheet(tuple(loops)) for name, loops in parts.items()}
