"""Which lengths follow from the dimensions of a Geneva drive?

The pin enters a slot along the slot: crank and slot are then at right angles, which gives the centre distance
crank / sin(180° / slots) and the wheel's radius. Millimetres, angles in degrees.
"""

from __future__ import annotations

import math

from watchsim.construction.geneva.geneva_dimensions import Geneva


def half_pitch(values: Geneva) -> float:
    """Half of what the wheel turns at a time."""
    return 180.0 / values.slots


def centre_distance(values: Geneva) -> float:
    return values.crank / math.sin(math.radians(half_pitch(values)))


def wheel_radius(values: Geneva) -> float:
    """To the mouths of the slots: where the middle of the pin enters."""
    return values.crank / math.tan(math.radians(half_pitch(values)))


def slot_half(values: Geneva) -> float:
    """Half the width of a slot."""
    return values.pin_radius + values.pin_play


def slot_bottom(values: Geneva) -> float:
    """From the wheel's axis to the middle of the round that ends a slot."""
    return centre_distance(values) - values.crank - values.bottom_play


def disc_radius(values: Geneva) -> float:
    return values.lock_radius - values.lock_play


def hollow_half(values: Geneva) -> float:
    """Half of a locking hollow, seen from the wheel's axis. ValueError where the hollow does not reach the wheel's rim."""
    c, rim, lock = centre_distance(values), wheel_radius(values), values.lock_radius
    return math.degrees(math.acos((c * c + rim * rim - lock * lock) / (2.0 * c * rim)))


def mouth_half(values: Geneva) -> float:
    """Half of a slot's mouth, seen from the wheel's axis. ValueError where the slot is as wide as the wheel."""
    return math.degrees(math.asin(slot_half(values) / wheel_radius(values)))
