"""Which points follow from the dimensions of a duplex escapement?

The wheel's centre O is the origin and it turns clockwise; the balance's centre B stands above, and turns counter-clockwise as
it takes its impulse. The circle of the resting teeth's points cuts the roller; a tooth rests on the left of that arc. As the
notch comes by, the point falls into it, goes through with it and is let go on the right; an upright tooth then drops on the
impulse pallet. With a tooth at rest the line of centres is in the middle between two impulse teeth, where the pallet can pass.
Bearings are at O, from the line OB, positive on the left; the pallet's angle is at B, from that line, positive to the right.
"""

from __future__ import annotations

import math

from watchsim.construction.design import Impossible
from watchsim.construction.duplex.duplex_dimensions import Duplex


class DuplexPoints:
    """Lengths in millimetres, angles in degrees."""

    def __init__(self, values: Duplex) -> None:
        self.values = values
        self.pitch = 360.0 / values.teeth
        self.roller = values.roller_ratio * values.tip_radius
        """Radius of the roller."""
        half = math.radians(values.intersection)
        resting = math.asin(self.roller * math.sin(half) / values.tip_radius)
        self.rests = math.degrees(resting)
        """Bearing of the point of a tooth at rest; let go at its negative."""
        self.distance = values.tip_radius * math.cos(resting) + self.roller * math.cos(half)
        self.inside = values.tip_radius + self.roller - self.distance
        """How deep the points come into the roller."""
        self.impulse_radius = values.impulse_ratio * values.tip_radius
        across = self.impulse_radius * math.sin(math.radians(values.reach))
        along = self.distance - self.impulse_radius * math.cos(math.radians(values.reach))
        self.pallet = math.hypot(across, along)
        """From B to the tip of the pallet."""
        self.half_impulse = math.degrees(math.atan2(across, along))
        """Angle of the pallet at the ends of the overlap."""
        self.waiting = self.pitch / 2.0
        """Bearing of the impulse tooth that will drive, with a tooth at rest; the one before it is as far on the right."""

    def pallet_at(self, bearing: float) -> float:
        """Angle of the pallet whose tip a tooth at that bearing would meet: its face points at B."""
        x, y = math.sin(math.radians(bearing)), math.cos(math.radians(bearing))
        return -math.degrees(math.atan2(self.impulse_radius * x, self.distance - self.impulse_radius * y))

    @property
    def pallet_let_go(self) -> float:
        """Angle of the pallet as the notch lets a tooth go: ahead of the impulse tooth by the drop."""
        return self.pallet_at(self.waiting - 2.0 * self.rests) + self.values.drop

    @property
    def driven(self) -> float:
        """Turn of the balance from the letting go to the end of the impulse."""
        found = self.half_impulse - self.pallet_let_go
        if found <= 0.0:
            raise Impossible("drop", "is so large that the pallet is past the tooth: nothing would be left of the impulse")
        return found
