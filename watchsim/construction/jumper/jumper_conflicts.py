"""Which dimensions of a star and its jumper do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.jumper.jumper_dimensions import Jumper
from watchsim.construction.jumper.jumper_proportions import (
    ENTRY,
    beak_at_rest,
    finger_distance,
    flank_angle,
    half_push,
    pitch,
    root_radius,
)

LEAST_ROOT = 0.2  # of the tip radius
NARROWEST = 15.0  # degrees between a flank and the radius: the beak would jam


def conflicts(values: Jumper) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    deepest = (1.0 - LEAST_ROOT) * values.tip_radius
    if values.depth > deepest:
        yield Conflict("depth", f"leaves a root radius of {root_radius(values):.3g} mm; at most {deepest:.3g} mm fit")
        return
    if flank_angle(values) <= NARROWEST:
        yield Conflict("depth", "the roots are so narrow that the beak would jam in them: fewer teeth or less depth")
        return
    if beak_at_rest(values) > values.tip_radius:
        yield Conflict("beak_radius", "the beak is too large to lie between two teeth")
    shortest = 1.02 * values.tip_radius * math.sin(math.radians(half_push(values)))
    if values.crank <= shortest:
        yield Conflict("crank", f"must be above {shortest:.3g} mm, else the pin does not carry a tooth that far (push)")
        return
    between = math.radians(pitch(values)) * values.tip_radius
    if 2.0 * values.pin_radius * (1.0 + ENTRY) > 0.5 * between:
        yield Conflict("pin_radius", f"the pin does not fit between the points of two teeth, {between:.3g} mm apart")
    if finger_distance(values) - values.crank - values.pin_radius <= root_radius(values):
        yield Conflict("crank", "the pin would run into the roots of the star: a longer crank comes less deep")
