"""After how many oscillations does the swing repeat itself, where it does not after one?

An orbit is followed without taking it up anew, and its turning points are compared with those 1, 2, 3, … oscillations before.
"""

from __future__ import annotations

import numpy as np

from watchsim.simulation.record.trajectory import Array
from watchsim.studies.limit_cycle.return_map import ReturnMap
from watchsim.studies.limit_cycle.section import turns

FOLLOWED = 64  # oscillations
MOST = 16  # oscillations after which it may repeat itself
NEAR = 1e-3  # of the amplitude: how closely it must have come back
ROUNDS = 3  # times so many oscillations are followed


def repeats(oscillate: ReturnMap, amplitude: float) -> tuple[int, float] | None:
    """After how many oscillations the orbit from there repeats itself, and at which amplitude; None where it does not."""
    for _ in range(ROUNDS):
        reached = followed(oscillate, amplitude)
        if reached is None:
            return None
        amplitude = float(reached[-1])
        for number in range(1, MOST + 1):
            if np.abs(reached[-2 * number :] - reached[-3 * number : -number]).max() <= NEAR * amplitude:
                return number, amplitude
    return None


def followed(oscillate: ReturnMap, amplitude: float) -> Array | None:
    """Amplitudes after each of the next oscillations; None where one of them is not regular."""
    got = oscillate(amplitude, FOLLOWED)
    if got.trouble:
        return None
    values = turns(got.events, oscillate.parts)["value"][1::2]
    reached: Array = oscillate.section.side * (values - oscillate.parts.level)
    return reached
