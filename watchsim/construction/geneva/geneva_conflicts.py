"""Which dimensions of a Geneva drive do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.geneva.geneva_dimensions import Geneva
from watchsim.construction.geneva.geneva_proportions import (
    centre_distance,
    disc_radius,
    half_pitch,
    hollow_half,
    mouth_half,
    slot_bottom,
    slot_half,
    wheel_radius,
)

LEAST_RIM = 0.02  # of the wheel's radius, that must stay between slot and hollow


def conflicts(values: Geneva) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    half, bottom, rim = slot_half(values), slot_bottom(values), wheel_radius(values)
    if bottom * math.sin(math.radians(half_pitch(values))) <= 1.05 * half or bottom <= 1.1 * half:
        yield Conflict("pin_radius", f"the slots, {2.0 * half:.4g} mm wide, would run into each other near the wheel's axis")
        return
    deepest = centre_distance(values) - rim
    if values.lock_radius <= 1.01 * deepest or disc_radius(values) <= 0.0:
        yield Conflict("lock_radius", f"must be more than {1.01 * deepest:.4g} mm, else the disc does not reach into the wheel")
        return
    if disc_radius(values) >= values.crank - values.pin_radius:
        free = values.crank - values.pin_radius
        yield Conflict("lock_radius", f"must be less than {free:.4g} mm: the pin stands beside the disc")
        return
    left = math.radians(half_pitch(values) - hollow_half(values) - mouth_half(values)) * rim
    if left < LEAST_RIM * rim:
        what = f"leaves {left:.3g} mm of rim between a slot and a hollow; {LEAST_RIM * rim:.3g} mm are needed"
        yield Conflict("lock_radius", what)
