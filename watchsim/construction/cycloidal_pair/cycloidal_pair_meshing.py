"""How do wheel and pinion mesh: distance, play, and how long does a tooth lead evenly?"""

from __future__ import annotations

import math

from watchsim.construction.cycloidal_pair.cycloidal_pair_dimensions import CycloidalPair
from watchsim.construction.cycloidal_pair.cycloidal_pair_gear import Wheel


def distance(values: CycloidalPair) -> float:
    """Of the centres, mm."""
    return values.module * ((values.pinion_teeth + values.wheel_teeth) / 2.0 + values.spread)


def play(values: CycloidalPair) -> float:
    """On the pitch circles, in modules."""
    return math.pi - values.tooth - values.leaf


def lead_after_centres(values: CycloidalPair) -> float:
    """How far a tooth leads evenly beyond the line of centres, in pitches.

    While the rolling circle turns by an angle about its centre, the pinion, of twice its radius, turns by half of it.
    """
    return Wheel(values).last_roll / 2.0 / (2.0 * math.pi / values.pinion_teeth)
