"""Is the motion at a given time among the rows that were kept?

A scene may record a few windows of a long run only; interpolating across what was left out would invent numbers.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from watchsim.scene.oscillation import nominal_frequency, oscillator, oscillators
from watchsim.simulation.record.trajectory import Array, Trajectory
from watchsim.storage.columns import let_go

LONGEST_STEP = 0.26  # periods: within a window rows are never further apart than a quarter of a swing


def nominal_period(run: Trajectory, body: str) -> float:
    """Period (s) that a rate is measured against: of the oscillator its nominal one, of other bodies that of small swings.

    ValueError where nothing pulls the body back.
    """
    scene = run.scene
    found = oscillators(scene)
    if found and found[0].body == body:
        hertz = nominal_frequency(scene)
    else:
        one = oscillator(scene.bodies, scene.springs, scene.gravity, body)
        hertz = one.hertz if one else None
    if not hertz:
        raise ValueError(f'neither a spring nor gravity pulls "{body}" back, so it has no period')
    return 1.0 / hertz


def is_recorded(run: Trajectory, times: Array) -> NDArray[np.bool_]:
    """For each time (s), whether rows close enough on both sides of it were kept."""
    if len(run.t) == 0:
        return np.zeros(len(times), bool)
    longest = math.inf
    frequencies = [one.hertz for one in oscillators(run.scene) if one.hertz]
    if frequencies:
        longest = LONGEST_STEP / max(frequencies)
    after = np.clip(np.searchsorted(run.t, times, side="left"), 0, len(run.t) - 1)
    before = np.clip(np.searchsorted(run.t, times, side="right") - 1, 0, len(run.t) - 1)
    inside = (times >= run.t[0]) & (times <= run.t[-1])
    found = inside & (run.t[after] - run.t[before] <= longest)
    let_go(run.t)
    return np.asarray(found)
