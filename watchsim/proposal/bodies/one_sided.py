"""Does a part work on one side of a wheel only, as a click does, and which way is it pressed into the teeth?"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.primitives import Point
from watchsim.mechanism.material_polygons import placed
from watchsim.proposal.bodies.part import Part
from watchsim.proposal.bodies.symmetry_centre import Turned

SWING = math.radians(15.0)  # to either side: what is an anchor has its other pallet in the teeth by then
STEP = math.radians(0.1)


@dataclass(frozen=True)
class Nose:
    """Of a click: the way (+1 counter-clockwise) that leads into the wheel, and its distance from the click's pivot (m)."""

    inward: int
    arm: float


def is_one_sided(part: Part, wheel: Part) -> bool:
    """Turned one way it comes within the tips of the wheel's teeth, and turned the other way it is clear of them."""
    toothed = toothing(wheel)
    if part.centre is None or toothed is None:
        return False
    ways = [_nearest(part, toothed.centre, angle)[0] < toothed.outer for angle in (-SWING, SWING)]
    return ways[0] != ways[1]


def nose_of(part: Part, wheel: Part) -> Nose:
    """The place of the part nearest to the wheel's centre, as it is drawn."""
    toothed = toothing(wheel)
    assert part.centre is not None and toothed is not None
    _, place = _nearest(part, toothed.centre, 0.0)
    closer = _nearest(part, toothed.centre, STEP)[0] < _nearest(part, toothed.centre, -STEP)[0]
    return Nose(1 if closer else -1, math.dist(part.centre.at, place))


def toothing(wheel: Part) -> Turned | None:
    """What comes back onto itself as the wheel turns, be it a wheel of many teeth or a star of a few."""
    return max((piece.turned for piece in wheel.pieces if piece.turned is not None), key=lambda one: one.outer, default=None)


def _nearest(part: Part, centre: Point, angle: float) -> tuple[float, Point]:
    """The least distance of the part's outlines from a point once it is turned by `angle`, and where it is."""
    assert part.centre is not None
    pivot = part.centre.at
    points: NDArray[np.float64] = np.concatenate([piece.points for piece in part.pieces])
    about = placed(points - np.array(pivot), (*pivot, angle)) - np.array(centre)
    k = int(np.argmin(np.hypot(*about.T)))
    return float(np.hypot(*about[k])), (float(about[k, 0] + centre[0]), float(about[k, 1] + centre[1]))
