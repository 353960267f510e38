"""Which events of an oscillator make a half swing, and which noises a beat?

A half swing goes from one turning point through the rest position to the next.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.int64]
Array = NDArray[np.float64]
Events = NDArray[Any]

FEWEST_TURNS = 3
QUIET = 0.1  # of half a period: so long the oscillator must have touched nothing before its first noise


def half_swings(crossings: Events, turns: Events) -> tuple[Indices, Indices, Indices]:
    """Rows of the passages that have a turning point on both sides, and the rows of these turning points.

    An oscillator that knocks turns more than once between two passages: of these turning points the outermost counts.
    """
    nothing = np.zeros(0, np.int64)
    if len(turns) < FEWEST_TURNS or len(crossings) == 0:
        return nothing, nothing, nothing
    heading = np.sign(crossings["value"])
    side = np.concatenate([-heading[:1], heading])  # on which side of the rest position it is before the first passage, ...
    interval = np.searchsorted(crossings["t"], turns["t"], side="right")
    outermost = np.full(len(side), -1)
    reach = side[interval] * turns["value"]
    for i, k in enumerate(interval):
        if outermost[k] < 0 or reach[i] > reach[outermost[k]]:
            outermost[k] = i
    complete = np.flatnonzero((outermost[:-1] >= 0) & (outermost[1:] >= 0))
    return complete, outermost[complete], outermost[complete + 1]


def first_noises(noises: Array, starts: Array, ends: Array, half_period: float) -> Array:
    """For each half swing from `starts` to `ends` (s), the time of the first of the noises (s) after a silence; else nan.

    What rings on from the half swing before (a knock at the turning point) is not silence and is passed over.
    """
    first_of_burst = noises[np.diff(noises, prepend=-np.inf) >= QUIET * half_period]
    place = np.searchsorted(first_of_burst, starts, side="right")
    found = np.append(first_of_burst, np.inf)[place]
    return np.where(found < ends, found, np.nan)


def since_two_before(times: Array) -> Array:
    """From each time to the one two before it; nan for the first two."""
    earlier: Array = np.concatenate([np.full(2, np.nan), times])[: len(times)]
    return times - earlier


def unevenness(marks: Array) -> Array:
    """By how much the half period that ends with each mark differs from the one before it, s; nan for the first two."""
    return np.diff(np.diff(marks, prepend=np.nan), prepend=np.nan)
