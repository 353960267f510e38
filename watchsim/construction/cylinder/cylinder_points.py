"""Which lengths and angles of a cylinder escapement follow from its dimensions?

The wheel's centre O is the origin and it turns clockwise; the balance's centre B stands above, at the distance D. A tooth's
impulse face runs from its point, D - x from O, back to its heel, D + x from O. With the balance turned counter-clockwise the
point rests outside on the left wall of the shell. Turning back, the left lip passes the point, and the face lifts the lip;
once the heel is through, the point drops on the inside of the right wall. On the way back the face lifts the right lip, and
the next tooth's point drops on the left wall. Lips are half round: unlocked is where the middle of the lip and the point are
in line with B, let off where the lip's middle and the heel are in line with O. Bearings are at O, from the line OB, positive
on the left; directions at B. Millimetres, degrees.
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

    @cached_property
    def inner(self) -> float:
        """Radius of the shell inside: a tooth and the drop fit."""

        def excess(inner: float) -> float:
            return self._let_off_bearing(inner, self._outer(inner)) + self.bearing(self.point_radius, inner) - fits

        fits = self.values.tooth_width + self.values.drop
        return float(brentq(excess, 1.001 * self.rise, 0.5 * self.distance, xtol=FINE * self.distance))

    @cached_property
    def outer(self) -> float:
        """Radius of the shell outside: it and the drop fit between two teeth."""
        return self._outer(self.inner)

    def _outer(self, inner: float) -> float:
        """With equal drops the walls take what is left of a pitch beside two teeth and two drops."""
        walls = self.pitch - 2.0 * (self.values.tooth_width + self.values.drop)
        angle = math.radians(self.bearing(self.point_radius, inner) + walls)
        x, y = self.point_radius * math.sin(angle), self.point_radius * math.cos(angle) - self.distance
        return math.hypot(x, y)

    def _let_off_bearing(self, inner: float, outer: float) -> float:
        """Of heel and lip's middle, in line with O."""
        return self.bearing(self.heel_radius + (outer - inner) / 2.0, (inner + outer) / 2.0)

    @property
    def let_off_bearing(self) -> float:
        return self._let_off_bearing(self.inner, self.outer)

    @property
    def driven(self) -> tuple[float, float]:
        """Turn of the wheel during the impulse on the left and on the right lip."""
        across = self.let_off_bearing - self.values.tooth_width
        return self.rests_outside - across, self.rests_inside + self.let_off_bearing + self.values.tooth_width

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
        return self._direction(self.point_radius, self.outer, 1), self._lip_let_off(1)

    @cached_property
    def exit(self) -> tuple[float, float]:
        """The same of the right lip."""
        return self._direction(self.point_radius, self.inner, -1), self._lip_let_off(-1)

    def _lip_let_off(self, side: int) -> float:
        return self._direction(self.heel_radius + (self.outer - self.inner) / 2.0, (self.inner + self.outer) / 2.0, side)

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
        """Swing at which the other end of the shell comes round to a resting tooth; of the side where that is first."""
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
