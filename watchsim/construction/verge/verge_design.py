"""What makes the verge escapement a design?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict, Design
from watchsim.construction.verge.verge_dimensions import Verge
from watchsim.construction.verge.verge_outlines import far_side, foliot, near_side, verge
from watchsim.construction.verge.verge_proportions import depth, height, leaving, pitch
from watchsim.construction.verge.verge_scene import scene_text
from watchsim.drawing.sheet import Sheet

STEEPEST = 80.0  # degrees of a flag against the wheel's axis when it lets go
NARROWEST = 3.0  # degrees of a tooth


def draw(values: Verge) -> dict[str, Sheet]:
    """The verge with its foliot, and the two sides of the crown wheel."""
    return {
        "verge": Sheet((*verge(values), *foliot(values))),
        "near_side": Sheet(tuple(near_side(values))),
        "far_side": Sheet(tuple(far_side(values))),
    }


def conflicts(values: Verge) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    if values.teeth % 2 == 0:
        yield Conflict("teeth", "must be odd: with an even number both sides would meet their flags at once")
    if math.degrees(leaving(values)) > STEEPEST:
        yield Conflict(
            "lift", f"must be below {STEEPEST - 0.5 * values.flag_angle:.4g}° with flags {values.flag_angle:g}° apart"
        )
        return
    if values.drop >= 0.45 * pitch(values):
        yield Conflict("drop", f"must be below {0.45 * pitch(values):.4g} mm, else nothing of the half pitch is left to push")
        return
    if values.slope < values.undercut + NARROWEST:
        yield Conflict("slope", f"must be above {values.undercut + NARROWEST:g}°, else the teeth have no body")
    elif height(values) * math.tan(math.radians(values.slope)) > 0.9 * pitch(values):
        yield Conflict("slope", f"leaves no gap between teeth {height(values):.3g} mm high, {pitch(values):.3g} mm apart")
    if depth(values) < 0.02 * pitch(values):
        yield Conflict("lift", "leaves too short a way between the wheel and the verge's axis")


DESIGN = Design("verge", "Verge escapement with a foliot", Verge, draw, scene_text, conflicts)
