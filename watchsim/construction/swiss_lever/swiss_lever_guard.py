"""How wide must the crescent be for the dart to pass through it?"""

from __future__ import annotations

import math

from watchsim.construction.swiss_lever.swiss_lever_points import Swiss

STEPS = 60


def crescent_needed(design: Swiss) -> float:
    """Half opening, degrees: the farthest the dart's point is beside the jewel while it is within the safety roller.

    The lever follows the jewel with the play of the slot; breadth of the point and rounding of the crescent's edge count.
    """
    play = math.degrees((design.slot_width - 2.0 * design.pin_radius) / design.pin_reach)
    farthest = 0.0
    for i in range(STEPS + 1):
        lever = design.bank * i / STEPS
        x, y = _dart(design, lever)
        distance = math.hypot(x, y)
        if distance < design.safety_radius + design.dart_tip:
            breadth = math.degrees((design.dart_tip + 0.02 * design.lever_scale) / distance)
            beside = abs(math.degrees(math.atan2(x, y)) - _jewel(design, lever))
            farthest = max(farthest, beside + breadth + play)
    return farthest


def _dart(design: Swiss, lever: float) -> tuple[float, float]:
    """Centre of the dart's point from the balance's centre: to the left, and towards the lever."""
    a = math.radians(lever)
    return design.dart_centre * math.sin(a), design.lever_to_balance - design.dart_centre * math.cos(a)


def _jewel(design: Swiss, lever: float) -> float:
    """Balance angle (degrees, to the left) with the middle of the jewel on the middle line of the lever."""
    a, ratio = math.radians(lever), design.lever_to_balance / design.pin_reach
    return math.degrees(math.asin(min(1.0, ratio * math.sin(a)))) - lever
