"""How do the two gears mesh: distance, play, contact ratio, and what part of a flank is used?"""

from __future__ import annotations

import math

from watchsim.construction.involute_pair.involute_pair_dimensions import InvolutePair
from watchsim.construction.involute_pair.involute_pair_gear import Gear, pair


def distance(values: InvolutePair) -> float:
    """Of the centres, mm."""
    return values.module * ((values.pinion_teeth + values.wheel_teeth) / 2.0 + values.spread)


def working_angle(values: InvolutePair) -> float:
    """The pressure angle at which the gears work at that distance, radians."""
    pinion, wheel = pair(values)
    return math.acos((pinion.base_radius + wheel.base_radius) / distance(values))


def play(values: InvolutePair) -> float:
    """By which the pinion can turn with the wheel held, radians: the pitch less both teeth, on the circles that roll."""
    working, taken = working_angle(values), 0.0
    for gear in pair(values):
        rolling = gear.base_radius / math.cos(working)
        taken += 2.0 * gear.half_tooth(rolling) * rolling
    pinion = pair(values)[0]
    rolling = pinion.base_radius / math.cos(working)
    return 2.0 * math.pi / pinion.teeth - taken / rolling


def beyond_base(values: InvolutePair, gear: Gear, other: Gear) -> float:
    """Where the other gear's tip ends the line of action, from the point of tangency on this gear's base circle, mm.

    Negative where it reaches under the base circle, where there is no involute.
    """
    line = (gear.base_radius + other.base_radius) * math.tan(working_angle(values))
    return line - math.sqrt(other.tip_radius**2 - other.base_radius**2)


def contact_ratio(values: InvolutePair) -> float:
    """Teeth in mesh on average."""
    pinion, wheel = pair(values)
    line = (pinion.base_radius + wheel.base_radius) * math.tan(working_angle(values))
    used = sum(math.sqrt(gear.tip_radius**2 - gear.base_radius**2) for gear in (pinion, wheel)) - line
    return used * pinion.teeth / (2.0 * math.pi * pinion.base_radius)
