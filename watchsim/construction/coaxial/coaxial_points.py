"""Which points follow from the dimensions of a co-axial escapement?

The wheel's centre O is the origin, the lever's pivot P stands above it, the balance's centre B to the right; the wheel turns
clockwise. The locking corners stand on the tip circle where its tangents from P touch, one and a half pitches apart: the first
to the left of P, the second to the right. A positive lever angle puts the first stone deep. Two circles that overlap give each
impulse: the tips of the large wheel and the roller stone's about B, the tips of the small wheel and the lever stone's about P.
Angles in degrees, counter-clockwise from +x; millimetres.
"""

from __future__ import annotations

import math

from watchsim.construction.coaxial.coaxial_dimensions import Coaxial
from watchsim.construction.outline import along, angle_of, polar, turned
from watchsim.geometry.primitives import Point

TEETH = 8
PITCH = 360.0 / TEETH
HALF_SPAN = 0.75 * PITCH
FIRST, SECOND = 1, -1  # the locking stones


def sine(degrees: float) -> float:
    return math.sin(math.radians(degrees))


def cosine(degrees: float) -> float:
    return math.cos(math.radians(degrees))


class Points:
    """Places in the movement and in the parts."""

    def __init__(self, values: Coaxial) -> None:
        self.values = values
        self.scale = values.tip_radius / 2.25
        """What was drawn for a wheel of 4.5 mm is so much larger."""
        self.lever_pivot = (0.0, values.tip_radius / cosine(HALF_SPAN))
        self.bank = (values.lock + values.lift + 2.0 * values.run) / 2.0
        self.let_off = self.bank - values.run
        self.unlocked = self.let_off - values.lock
        """The lever angle (unsigned) at which a locking corner stands on the tip circle."""
        self.stone_reach = values.stone_ratio * values.tip_radius
        """From B to the tip of the roller stone."""
        self.direct_balance = math.degrees(math.asin(values.tip_radius * sine(values.direct_reach) / self.stone_reach))
        """Turn of the balance on either side of the line of centres in which roller stone and tips overlap."""
        apart = values.tip_radius * cosine(values.direct_reach) + self.stone_reach * cosine(self.direct_balance)
        self.balance_bearing = 90.0 + HALF_SPAN - 2.0 * PITCH - values.direct_lead
        self.balance_pivot = polar(-apart, self.balance_bearing + 180.0)
        both = sine(values.indirect_reach + values.indirect_lever)
        self.small_radius = self.lever_pivot[1] * sine(values.indirect_lever) / both
        self.impulse_reach = self.lever_pivot[1] * sine(values.indirect_reach) / both
        """From P to the tip of the lever's impulse stone."""
        self.small_turn = (90.0 + values.indirect_lead - (90.0 - HALF_SPAN)) % PITCH
        """From a large tooth to the next small one, counter-clockwise."""
        dx, dy = (b - p for b, p in zip(self.balance_pivot, self.lever_pivot, strict=True))
        self.lever_to_balance = math.hypot(dx, dy)
        self.fork_bearing = math.degrees(math.atan2(dy, dx))
        """Direction from P to B."""
        half = values.lift_angle / 2.0
        self.pin_reach = self.lever_to_balance * sine(self.bank) / sine(half + self.bank)
        self.slot_width = 2.0 * values.pin_radius + values.shake

    def balance_at(self, lever: float) -> float:
        """Angle of the balance (unsigned) with its pin in the fork at a lever angle (unsigned)."""
        sine_at_pin = self.lever_to_balance * sine(lever) / self.pin_reach
        return math.degrees(math.asin(sine_at_pin)) - lever

    def in_lever(self, point: Point, lever: float) -> Point:
        """A point of the movement in the lever's own frame, with the lever at `lever` degrees."""
        return turned((point[0] - self.lever_pivot[0], point[1] - self.lever_pivot[1]), -lever)

    def in_movement(self, point: Point, lever: float) -> Point:
        """A point of the lever in the movement, with the lever at `lever` degrees."""
        x, y = turned(point, lever)
        return (x + self.lever_pivot[0], y + self.lever_pivot[1])

    def locking_corner(self, side: int) -> Point:
        """Of the first or second stone, in the lever's frame."""
        return self.in_lever(polar(self.values.tip_radius, 90.0 + side * HALF_SPAN), side * self.unlocked)

    def face_direction(self, side: int) -> float:
        """Direction of the locking face away from the wheel, in the lever's frame: leaning to the right by the draw."""
        return 90.0 + side * HALF_SPAN - self.values.draw - side * self.bank

    def locked_tip(self, side: int, lever: float) -> float:
        """Polar angle of the tip that a locking face holds, lever at `lever` degrees to its side."""
        corner = self.in_movement(self.locking_corner(side), side * lever)
        direction = self.face_direction(side) + side * lever
        return angle_of(along(corner, direction, self._to_tip_circle(corner, direction)))

    def _to_tip_circle(self, start: Point, direction: float) -> float:
        """How far along `direction` the tip circle is crossed from inside."""
        ux, uy = cosine(direction), sine(direction)
        ahead = start[0] * ux + start[1] * uy
        return -ahead + math.sqrt(ahead**2 + self.values.tip_radius**2 - start[0] ** 2 - start[1] ** 2)
