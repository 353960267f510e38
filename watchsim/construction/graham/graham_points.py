"""Where do the corners of the pallets lie, and where does a tooth rest on them?

The wheel's axis is the origin, the pendulum's pivot lies above it where the tangents at the two lockings meet; the wheel turns
clockwise. The pendulum's angle is positive with the entry pallet, on the left, deep in the wheel. Pallets are in the
pendulum's frame, that is about its pivot. With the pendulum at +unlocked a tooth leaves the entry pallet's locking face, at
-released its impulse face; the exit pallet is worked at the opposite angles. Millimetres, degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.construction.design import Impossible
from watchsim.construction.graham.graham_dimensions import Graham
from watchsim.construction.outline import polar, turned
from watchsim.geometry.primitives import Point


@dataclass(frozen=True)
class Anchor:
    """The dimensions, and by how much a locking face leans from the arc about the pivot: 0 is dead-beat, more is recoil."""

    values: Graham
    recoil: float = 0.0

    @property
    def half_span(self) -> float:
        return self.values.embraced * 180.0 / self.values.teeth

    @property
    def pallet_width(self) -> float:
        """Of a pallet, at the wheel's centre: half a pitch without drop and tip."""
        return 180.0 / self.values.teeth - self.values.drop - self.values.tip_width

    @property
    def half_angle_seen(self) -> float:
        """Half the angle between the pallets, seen from the pivot."""
        return 90.0 - self.half_span

    @property
    def distance(self) -> float:
        return self.values.tip_radius / math.cos(math.radians(self.half_span))

    @property
    def unlocked(self) -> float:
        return (self.values.lift - self.values.lock) / 2.0

    @property
    def released(self) -> float:
        return (self.values.lift + self.values.lock) / 2.0

    def from_pivot(self, bearing: float, pendulum: float) -> Point:
        """A tooth's tip at `bearing` (from the line of centres, positive on the left) in the pendulum's frame."""
        x, y = polar(self.values.tip_radius, 90.0 + bearing)
        return turned((x, y - self.distance), -pendulum)

    def corners(self, side: int) -> tuple[Point, Point]:
        """Locking corner and let-off corner of the entry (side 1) or exit (-1) pallet."""
        half = self.pallet_width / 2.0
        locking = self.from_pivot(side * self.half_span + half, side * self.unlocked)
        return locking, self.from_pivot(side * self.half_span - half, -side * self.released)

    def face_direction(self, side: int) -> float:
        """Of the locking face at its corner, away from it: along the arc about the pivot, leaning by `recoil`.

        The entry pallet's runs clockwise about the pivot and leans outwards, the exit pallet's counter-clockwise and inwards.
        """
        locking, _ = self.corners(side)
        bearing = math.degrees(math.atan2(locking[1], locking[0]))
        return bearing - side * 90.0 + self.recoil

    def wheel_angle(self, pendulum: float) -> float:
        """Of the wheel, with a tooth on the entry pallet's locking face; at 0 a tip is on the x axis."""
        half = self.pallet_width / 2.0
        if self.recoil == 0.0:
            return 90.0 + self.half_span + half
        (x, y), way = self.corners(1)[0], math.radians(self.face_direction(1) + pendulum)
        x, y = turned((x, y), pendulum)
        y += self.distance
        along = x * math.cos(way) + y * math.sin(way)
        rest = along * along - (x * x + y * y - self.values.tip_radius**2)
        if rest < 0.0:
            raise Impossible("start", "lies so far out that no tooth reaches the locking face")
        ends = [-along + sign * math.sqrt(rest) for sign in (-1.0, 1.0)]
        step = min(ends, key=abs)
        return math.degrees(math.atan2(y + step * math.sin(way), x + step * math.cos(way)))
