"""Which lengths and angles of a cylinder escapement follow from its dimensions?

The wheel's centre O is the origin and it turns clockwise; the balance's centre B stands above, at the distance D. A tooth's
impulse face runs from its point, D - x from O, back to its heel, D + x from O. With the balance turned counter-clockwise the
point rests outside on the left wall of the shell. Turning back, the left lip passes the point; the face lifts the lip until
the heel has come within the inner radius; the point drops on the inside of the right wall. On the way back the face lifts
the right lip until the heel is beyond the outer radius, and the next tooth's point drops on the left wall. Lips are half round:
unlocking and let-off are where point and heel are beside the middle of the lip, seen from B. Bearings are at O, from the line
OB, positive on the left; directions at B. Millimetres, degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from scipy.optimize import brentq

from watchsim.construction.cylinder.cylinder_dimensions import Cylinder
from watchsim.construction.design import Impossible
from watchsim.construction.outline import angle_of, polar
from watchsim.geometry.primitives import Point

FINE = 1e-14  # of the centre distance
STEEPEST = 0.14  # of it: half the rise of the impulse face


@dataclass(frozen=True)
class Shell:
    """The dimensions, and half the rise of the impulse faces."""

    values: Cylinder
    rise: float

    @property
    def distance(self) -> float:
        return self.values.centre_distance

    @property
    def balance(self) -> Point:
        return (0.0, self.distance)

    @property
    def pitch(self) -> float:
        return 360.0 / self.values.teeth

    @property
    def point_radius(self) -> float:
        return self.distance - self.rise

    @property
    def heel_radius(self) -> float:
        return self.distance + self.rise

    def bearing(self, reach: float, radius: float) -> float:
        """Of what is `reach` from O and `radius` from B."""
        cosine = (reach**2 + self.distance**2 - radius**2) / (2.0 * reach * self.distance)
        return math.degrees(math.acos(cosine)) if cosine < 1.0 else 0.0

    def _across(self, radius: float) -> float:
        """Degrees of the wheel from where the point is on the circle about B on one side to the heel on it on the other."""
        return self.bearing(self.point_radius, radius) + self.bearing(self.heel_radius, radius)

    @cached_property
    def inner(self) -> float:
        """Radius of the shell inside: a tooth and the drop fit."""
        return self._radius(self.values.tooth_width + self.values.drop)

    @cached_property
    def outer(self) -> float:
        """Radius of the shell outside: it and the drop fit between two teeth."""
        return self._radius(self.pitch - self.values.tooth_width - self.values.drop)

    def _radius(self, across: float) -> float:
        return float(brentq(lambda r: self._across(r) - across, self.rise, self.distance, xtol=FINE * self.distance))

    @property
    def rests_outside(self) -> float:
        """Bearing of the point."""
        return self.bearing(self.point_radius, self.outer)

    @property
    def rests_inside(self) -> float:
        return -self.bearing(self.point_radius, self.inner)

    def _direction(self, reach: float, radius: float, side: int) -> float:
        """From B, of what is so far from O and from B: on the left (side 1) 90° to 270°, on the right (-1) -90° to 90°."""
        seen = angle_of(polar(reach, 90.0 + side * self.bearing(reach, radius)), self.balance)
        return seen % 360.0 if side > 0 else seen

    @cached_property
    def entry(self) -> tuple[float, float]:
        """Direction of the left lip's middle at unlocking and let-off."""
        return self._direction(self.point_radius, self.outer, 1), self._direction(self.heel_radius, self.inner, 1)

    @cached_property
    def exit(self) -> tuple[float, float]:
        """The same of the right lip."""
        return self._direction(self.point_radius, self.inner, -1), self._direction(self.heel_radius, self.outer, -1)

    @property
    def lifts(self) -> tuple[float, float]:
        """Of the balance, on the left and on the right lip."""
        return self.entry[0] - self.entry[1], self.exit[1] - self.exit[0]

    @property
    def span(self) -> float:
        """From lip to lip, over the shell: so that the lesser lock is as asked for."""
        return max(self.entry[1] - self.exit[0], self.entry[0] - self.exit[1]) + self.values.lock

    @property
    def locks(self) -> tuple[float, float]:
        """Inside and outside, of the balance."""
        return self.span - self.entry[1] + self.exit[0], self.span - self.entry[0] + self.exit[1]

    @property
    def left_lip(self) -> float:
        """Direction of its middle with the balance at rest: both let-offs are as far from there."""
        return (self.entry[1] + self.exit[1] + self.span) / 2.0

    @property
    def let_off(self) -> float:
        """Of the balance, from rest."""
        return self.left_lip - self.entry[1]

    @property
    def most(self) -> float:
        """Swing at which the other end of the shell comes round to a resting tooth; the same on both sides but for the locks."""
        return min(self.entry[0] - self.left_lip + self.span, self.left_lip - self.exit[0]) - self.values.lock


def shell(values: Cylinder) -> Shell:
    """The faces rise such that the mean lift is as asked for."""
    most = STEEPEST * values.centre_distance

    def excess(rise: float) -> float:
        return sum(Shell(values, rise).lifts) / 2.0 - values.lift

    try:
        if excess(most) > 0.0:
            return Shell(values, float(brentq(excess, 1e-3 * most, most, xtol=FINE * most)))
    except ValueError:
        raise Impossible("tooth_width", "no cylinder fits round such a tooth and between two of them") from None
    raise Impossible("lift", "needs impulse faces too steep to slide")
