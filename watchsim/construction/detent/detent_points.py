"""Which points follow from the dimensions of a detent escapement?

The wheel's centre O is the origin and it turns clockwise; the balance's centre B stands above, and turns counter-clockwise
while it unlocks and takes its impulse. A tooth is locked one and a half pitches beyond the line OB; the detent's pivot P lies
on the tangent of the tip circle there, so that locking pushes through P, and draw alone turns the detent to its bank. Positive
detent angles are counter-clockwise, into the wheel: it unlocks to negative ones. Degrees and millimetres.
"""

from __future__ import annotations

import math

from watchsim.construction.design import Impossible
from watchsim.construction.detent.detent_dimensions import Detent
from watchsim.construction.outline import along, angle_of, polar, turned
from watchsim.geometry.primitives import Point


def sine(degrees: float) -> float:
    return math.sin(math.radians(degrees))


def cosine(degrees: float) -> float:
    return math.cos(math.radians(degrees))


class Points:
    """Places in the movement; parts are drawn as they stand there, the detent on its bank."""

    def __init__(self, values: Detent) -> None:
        self.values = values
        self.scale = values.tip_radius / 6.5
        self.pitch = 360.0 / values.teeth
        radius = values.tip_radius
        self.stone_reach = values.stone_ratio * radius
        """From B to the tip of the impulse stone."""
        self.half_impulse = math.degrees(math.asin(radius * sine(values.reach) / self.stone_reach))
        """Turn of the balance on either side of the line of centres in which impulse stone and tips overlap."""
        self.balance_pivot = (0.0, radius * cosine(values.reach) + self.stone_reach * cosine(self.half_impulse))
        self.locked_at = 90.0 - 1.5 * self.pitch
        """Polar angle of the tooth that is locked, just before it is let go."""
        self.locking = polar(radius, self.locked_at)
        self.foot = values.foot * radius
        self.pivot = along(self.locking, self.locked_at - 90.0, self.foot)
        dx, dy = (b - p for b, p in zip(self.balance_pivot, self.pivot, strict=True))
        self.apart = math.hypot(dx, dy)
        self.line = math.degrees(math.atan2(dy, dx))
        """Direction from P to B."""
        self.blade = self.line + values.clearance
        """Direction from P to the tip of the passing spring, along its face."""
        self.discharge = values.discharge_ratio * radius
        """From B to the outermost point of the discharging stone."""
        end = values.travel - values.clearance
        square = self.discharge**2 - (self.apart * sine(end)) ** 2
        if end <= 0.0 or square <= 0.0:
            raise Impossible("travel", "the discharging stone cannot carry the detent so far: take less travel, or more reach")
        self.blade_reach = self.apart * cosine(end) - math.sqrt(square)
        """From P to the tip of the passing spring: it slips off the discharging stone after the travel."""
        self.pin_centre = self.discharge - values.discharge_radius

    def in_detent(self, point: Point, angle: float = 0.0) -> Point:
        """A place of the movement in the detent's own frame, with the detent at `angle` degrees."""
        return turned((point[0] - self.pivot[0], point[1] - self.pivot[1]), -angle)

    def locking_corner(self) -> Point:
        """Of the locking stone, in the detent's frame: on the tip circle when the tooth is let go."""
        return self.in_detent(self.locking, -self.values.lock)

    def face_direction(self) -> float:
        """Direction of the locking face away from the wheel, in the detent's frame."""
        return self.locked_at - self.values.draw

    def wheel_angle(self) -> float:
        """Polar angle of the tip that the locking face holds, the detent on its bank."""
        cx, cy = self.locking_corner()
        x, y = cx + self.pivot[0], cy + self.pivot[1]
        ux, uy = cosine(self.face_direction()), sine(self.face_direction())
        ahead = -(x * ux + y * uy)
        return angle_of(
            along((x, y), self.face_direction(), ahead + math.sqrt(ahead**2 + self.values.tip_radius**2 - x * x - y * y))
        )

    def pin_bearing(self) -> float:
        """Direction from B to the discharging stone's middle as the tooth is let go: it touches the passing spring's tip."""
        tip = along(self.pivot, self.blade - self.values.lock, self.blade_reach)
        away, own, reach = math.dist(tip, self.balance_pivot), self.values.discharge_radius, self.pin_centre
        cos = (away**2 + reach**2 - own**2) / (2.0 * away * reach)
        if not -1.0 < cos < 1.0:
            raise Impossible("clearance", "the discharging stone does not meet the passing spring before the tooth is let go")
        # It comes from the side of the wheel.
        return angle_of(tip, self.balance_pivot) - math.degrees(math.acos(cos))

    def stone_bearing(self) -> float:
        """Direction from B to the impulse stone's tip as the tooth is let go."""
        return -90.0 - self.half_impulse + self.values.inside
