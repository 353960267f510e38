"""What makes the governor fly of a striking train a design?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.construction.design import Conflict, Design
from watchsim.construction.governor.governor_dimensions import Governor
from watchsim.construction.governor.governor_scene import scene_text
from watchsim.construction.outline import circle, rounded
from watchsim.drawing.sheet import Sheet
from watchsim.geometry.loop import Loop


def draw(values: Governor) -> dict[str, Sheet]:
    """Drum and fly: two vanes on a collar, seen along the axis."""
    far, half = values.reach, 0.5 * values.thickness
    vanes = rounded([(-far, -half, 0.0), (far, -half, 0.0), (far, half, 0.0), (-far, half, 0.0)])
    collar = max(0.1 * values.reach, values.thickness)
    return {
        "drum": Sheet((circle("DRUM", (0.0, 0.0), values.drum_radius),)),
        "fly": Sheet((Loop(tuple(vanes), "VANES"), circle("COLLAR", (0.0, 0.0), collar))),
    }


def conflicts(values: Governor) -> Iterator[Conflict]:
    """What cannot be drawn."""
    if values.root >= 0.9 * values.reach:
        yield Conflict("root", f"must be below {0.9 * values.reach:.4g} mm, else no vane is left")
    if values.thickness > 0.2 * values.reach:
        yield Conflict("thickness", f"must be at most {0.2 * values.reach:.4g} mm")


DESIGN = Design("governor", "Governor fly of a striking train", Governor, draw, scene_text, conflicts)
