"""Which lengths and angles follow from the dimensions of a grasshopper escapement?

Both pallets hang on one pivot P of the frame, at the distance h to the left of the pendulum's axis and, at rest, where the
tangents at half the span meet above the wheel. A pallet of length l that holds a tooth at the circle of the points is a link
with two pins: with P at the distance d from the wheel's axis, the two teeth that pallets could hold are apart by

    2 arccos((R² + d² - l²) / (2 R d))

One pallet takes over from the other at +release and at -release, where this must be a whole number of pitches, one more at the
first than at the second: two equations for h and l. Wheel's axis at the origin, clockwise; millimetres, degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.construction.grasshopper.grasshopper_dimensions import Grasshopper
from watchsim.construction.outline import angle_of, polar, turned
from watchsim.geometry.primitives import Point

ENTRY, EXIT = 1, -1
NEAREST, FURTHEST = 0.01, 5.0  # of the frame's pivot from the pendulum's axis, by the wheel's radius


@dataclass(frozen=True)
class Points:
    """The dimensions with the arm h of the frame and the length l of the pallets."""

    values: Grasshopper
    arm: float
    length: float

    @property
    def axis(self) -> Point:
        return (self.arm, _height(self.values))

    @property
    def pitch(self) -> float:
        return 360.0 / self.values.teeth

    @property
    def furthest(self) -> float:
        return self.values.release + self.values.overswing

    def pivot(self, swing: float) -> Point:
        return _pivot(self.values, self.arm, swing)

    def tooth(self, swing: float, side: int) -> float:
        """Direction of the point of the tooth that a pallet holds, with the pendulum at `swing`."""
        far, r = math.hypot(*self.pivot(swing)), self.values.tip_radius
        half = math.acos((r**2 + far**2 - self.length**2) / (2.0 * r * far))
        return angle_of(self.pivot(swing)) + side * math.degrees(half)

    def lean(self, swing: float, side: int) -> float:
        """Direction of that pallet from its pivot, in the frame."""
        tip = polar(self.values.tip_radius, self.tooth(swing, side))
        return angle_of(tip, self.pivot(swing)) - swing

    def stopped(self, side: int) -> float:
        """The same on the pallet's stop: where it would hold a tooth at the end of the overswing on its side."""
        return self.lean(side * self.furthest, side)


def points(values: Grasshopper) -> Points:
    """ValueError where no frame makes the pallets take over from each other."""
    low, high = NEAREST * values.tip_radius, FURTHEST * values.tip_radius
    below = _mismatch(values, low)
    if below * _mismatch(values, high) > 0.0:
        raise ValueError("no arm of the frame moves the wheel by half a pitch")
    while high - low > 1e-13 * high:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if below * _mismatch(values, middle) > 0.0 else (low, middle)
    far, half = math.hypot(*_pivot(values, low, values.release)), _half(values, values.span + 1)
    return Points(values, low, math.sqrt(values.tip_radius**2 + far**2 - 2.0 * values.tip_radius * far * math.cos(half)))


def _mismatch(values: Grasshopper, arm: float) -> float:
    """Of the two squares of a pallet's length, from either end of the swing."""
    ends = (values.release, values.span + 1), (-values.release, values.span)
    squares = []
    for swing, pitches in ends:
        far = math.hypot(*_pivot(values, arm, swing))
        squares.append(far**2 - 2.0 * values.tip_radius * far * math.cos(_half(values, pitches)))
    return squares[0] - squares[1]


def _half(values: Grasshopper, pitches: float) -> float:
    return math.pi * pitches / values.teeth


def _height(values: Grasshopper) -> float:
    """Of both axes above the wheel's, at rest."""
    return values.tip_radius / math.cos(_half(values, values.span + 0.5))


def _pivot(values: Grasshopper, arm: float, swing: float) -> Point:
    x, y = turned((-arm, 0.0), swing)
    return (arm + x, _height(values) + y)
