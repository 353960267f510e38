"""Which points of a pin-pallet escapement follow from its numbers?

The wheel's centre O is the origin and the wheel turns clockwise; a positive lever angle puts the entry pin (left) deep. With
the lever at `unlocked` a pin's centre C stands where OC and the line to the lever's pivot P are at right angles, and the
front corner of a tooth, behind the pin on that line, pushes through P: it neither draws nor drives. Both pins are as far from
P, so that a let-off on one side is the mirror image of that on the other. Millimetres and degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.construction.outline import angle_of, polar
from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.geometry.primitives import Point


@dataclass(frozen=True)
class PinLever(Swiss):
    """The numbers of a Swiss lever, whose fork, roller and banking it has, and those of the pins.

    `half_span` is that of the pins' centres at `unlocked`, `undercut` the lean of a tooth's front from the radius.
    """

    pin: float = 0.15  # radius of the pallets

    @property
    def unlocking_radius(self) -> float:
        """From O to the pin's centre at `unlocked`."""
        return math.sqrt(self.tip_radius**2 - self.pin**2)

    @property
    def lever_pivot(self) -> Point:
        return (0.0, self.unlocking_radius / math.cos(math.radians(self.half_span)))

    @property
    def arm(self) -> float:
        """From P to the pins' centres."""
        return self.unlocking_radius * math.tan(math.radians(self.half_span))

    def pallet(self, side: int) -> Point:
        """Centre of the entry (1) or exit (-1) pin, in the lever's frame."""
        return polar(self.arm, 270.0 - side * (90.0 - self.half_span + self.unlocked))

    def placed(self, side: int, lever: float) -> Point:
        """The same in the movement, the lever at `lever` degrees."""
        return self.in_movement(self.pallet(side), lever)

    def behind_pin(self, centre: Point) -> float:
        """Degrees of the wheel from a pin there to the front corner of the tooth whose front rests on it.

        With the corner at (R, 0) the front goes inwards from it in the direction 180° - u; the pin's centre, the angle b
        before the corner, is a pin's radius off that line: R sin u + |C| sin(b - u) = pin.
        """
        lean = math.radians(self.undercut)
        return self.undercut + math.degrees(math.asin((self.pin - self.tip_radius * math.sin(lean)) / math.hypot(*centre)))

    def locked_corner(self, side: int, lever: float) -> float:
        """Polar angle of the front corner of a tooth whose front rests on a pin, the lever that far to the pin's own side."""
        centre = self.placed(side, side * lever)
        return angle_of(centre) + self.behind_pin(centre)

    def front_used(self, side: int, lever: float) -> float:
        """How far from its corner the front of a tooth touches the pin; negative where the corner does."""
        centre = self.placed(side, side * lever)
        before, lean = math.radians(self.behind_pin(centre)), math.radians(self.undercut)
        x, y = math.hypot(*centre) * math.cos(before), -math.hypot(*centre) * math.sin(before)
        return (self.tip_radius - x) * math.cos(lean) + y * math.sin(lean)

    def draw_of(self, side: int, lever: float) -> float:
        """Where a tooth's front rests on a pin: between its push and the line through P, positive where it draws the pin in."""
        push = self.locked_corner(side, lever) - 90.0 - self.undercut
        touched = polar(-self.pin, push, self.placed(side, side * lever))
        through = angle_of(self.lever_pivot, touched) if side > 0 else angle_of(touched, self.lever_pivot)
        return (through - push + 180.0) % 360.0 - 180.0
