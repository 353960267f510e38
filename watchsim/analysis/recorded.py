"""Is the motion at a given time among the rows that were kept?

A scene may record a few windows of a long run only; interpolating across what was left out would invent numbers.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.check import frequency
from watchsim.simulation.trajectory import Array, Trajectory

LONGEST_STEP = 0.26  # periods: within a window rows are never further apart than a quarter of a swing


def nominal_period(run: Trajectory, body: str) -> float:
    """Undamped period (s) of a sprung body."""
    springs = tuple(spring for spring in run.scene.springs if spring.body == body)
    hertz = frequency(dataclasses.replace(run.scene, springs=springs))
    if not hertz:
        raise ValueError(f'no spring acts on "{body}", so it has no period')
    return 1.0 / hertz


def is_recorded(run: Trajectory, times: Array) -> NDArray[np.bool_]:
    """For each time (s), whether rows close enough on both sides of it were kept."""
    if len(run.t) == 0:
        return np.zeros(len(times), bool)
    longest = math.inf
    if run.scene.springs:
        longest = LONGEST_STEP * min(nominal_period(run, spring.body) for spring in run.scene.springs)
    after = np.clip(np.searchsorted(run.t, times, side="left"), 0, len(run.t) - 1)
    before = np.clip(np.searchsorted(run.t, times, side="right") - 1, 0, len(run.t) - 1)
    inside = (times >= run.t[0]) & (times <= run.t[-1])
    return inside & (run.t[after] - run.t[before] <= longest)
