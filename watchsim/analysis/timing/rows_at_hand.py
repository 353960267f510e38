"""Is the motion at a given time among the rows that were kept?

A scene may record a few windows of a long run only; interpolating across what was left out would invent numbers.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from watchsim.scene.oscillation import nominal_frequency, oscillator, oscillators
from watchsim.simulation.record.trajectory import Array, Trajectory
from watchsim.storage.columns import blocks, let_go

AT_ONCE = 4096  # times that are looked up together
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
    found = [_between_rows(run.t, part, longest) for (part,) in blocks(times, length=AT_ONCE)]
    return np.concatenate(found) if found else np.zeros(0, bool)


def _between_rows(t: Array, times: Array, longest: float) -> NDArray[np.bool_]:
    after = np.minimum(np.searchsorted(t, times, side="left"), len(t) - 1)
    before = np.maximum(np.searchsorted(t, times, side="right") - 1, 0)
    found: NDArray[np.bool_] = (times >= t[0]) & (times <= t[-1]) & (t[after] - t[before] <= longest)
    let_go(t)
    return found
