"""Which lengths and angles follow from the dimensions of a star and its jumper?

The star's axis is the origin; at rest the beak lies in the root at 0°. The pin passes the star's tip circle where a tooth's
point is `half_push` before and behind the line of centres of finger and star. Millimetres, angles in degrees.
"""

from __future__ import annotations

import math

from watchsim.construction.jumper.jumper_dimensions import Jumper

ENTRY = 0.08  # of the pitch: by which the pin is clear of a tooth's point as it comes in


def pitch(values: Jumper) -> float:
    return 360.0 / values.teeth


def root_radius(values: Jumper) -> float:
    return values.tip_radius - values.depth


def flank_angle(values: Jumper) -> float:
    """Between a flank and the radius at the root."""
    half = math.radians(pitch(values) / 2.0)
    rise, side = values.tip_radius * math.cos(half) - root_radius(values), values.tip_radius * math.sin(half)
    return math.degrees(math.atan2(side, rise))


def beak_at_rest(values: Jumper) -> float:
    """From the star's axis to the middle of the beak that touches both flanks of a root."""
    return root_radius(values) + values.beak_radius / math.sin(math.radians(flank_angle(values)))


def half_push(values: Jumper) -> float:
    return values.push * pitch(values) / 2.0


def finger_distance(values: Jumper) -> float:
    """Of the axes of finger and star. ValueError where the crank is too short to reach both places."""
    angle = math.radians(half_push(values))
    reach = values.crank**2 - (values.tip_radius * math.sin(angle)) ** 2
    return values.tip_radius * math.cos(angle) + math.sqrt(reach)


def finger_direction(values: Jumper) -> float:
    """Of the finger's axis, seen from the star's: the tooth across from the jumper waits just before the pin's way."""
    tooth = (values.teeth // 2 + 0.5) * pitch(values)
    wait = math.degrees(values.pin_radius / values.tip_radius) + ENTRY * pitch(values)
    return tooth + half_push(values) - wait
