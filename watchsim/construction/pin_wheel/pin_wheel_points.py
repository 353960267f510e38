"""Where do the corners of the pallets of a pin-wheel escapement lie?

The wheel's axis O is the origin and it turns clockwise; the pendulum's pivot P stands above the rightmost point of the pin
circle, so that the pins between the anchor's arms move straight away from P. A pin rests on the upper pallet (side -1, on the
right), drives it to the right, drops on the lower one (side 1, on the left), drives that to the left, and is gone. Resting
faces are arcs about P. Of a pin the half that looks down is left; its upper side is flat along the radius. Pallets are in the
pendulum's frame, that is about P. Millimetres, degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.construction.outline import polar, turned
from watchsim.construction.pin_wheel.pin_wheel_dimensions import PinWheel
from watchsim.geometry.primitives import Point


@dataclass(frozen=True)
class PinAnchor:
    """What follows from the dimensions."""

    values: PinWheel

    @property
    def half_pitch(self) -> float:
        return 180.0 / self.values.pins

    @property
    def driven(self) -> float:
        """Turn of the wheel while a pin drives a pallet."""
        return self.half_pitch - self.values.drop

    @property
    def pin(self) -> float:
        """Radius of a pin."""
        return self.values.pin_diameter / 2.0

    @property
    def pivot(self) -> Point:
        return (self.values.pin_circle, 2.0 * self.values.arm_ratio * self.values.pin_circle)

    @property
    def unlocked(self) -> float:
        return (self.values.lift - self.values.lock) / 2.0

    @property
    def released(self) -> float:
        return (self.values.lift + self.values.lock) / 2.0

    def locked(self, side: int) -> float:
        """Polar angle of a pin that rests on a pallet: the ways on both are even about the line from O to the right."""
        return (self.driven - side * self.half_pitch) / 2.0

    def from_pivot(self, point: Point, pendulum: float) -> Point:
        """A place of the movement in the pendulum's frame, the pendulum at that angle."""
        return turned((point[0] - self.pivot[0], point[1] - self.pivot[1]), -pendulum)

    def corners(self, side: int) -> tuple[Point, Point]:
        """Where a pallet's resting face ends, and where a pin leaves it.

        As a pin is unlocked the corner is at its lowest point, seen from P; as it is let off, beside it at the edge of its
        flat.
        """
        centre = polar(self.values.pin_circle, self.locked(side))
        x, y = self.from_pivot(centre, side * self.unlocked)
        away = math.hypot(x, y)
        locking = (x * (1.0 + self.pin / away), y * (1.0 + self.pin / away))
        edge = polar(self.values.pin_circle - side * self.pin, self.locked(side) - self.driven)
        return locking, self.from_pivot(edge, -side * self.released)
