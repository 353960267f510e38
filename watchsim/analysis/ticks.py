"""When does a listener hear the beats?

The first noise of a beat is the impulse pin meeting the fork. Rate and beat error are taken from it by every timegrapher, since
it comes before anything that depends on the escapement's own play.
"""

from __future__ import annotations

import numpy as np

from watchsim.analysis.touches import contact_events, involves
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.trajectory import Array, Trajectory

QUIET = 0.1  # of half a period: so long the oscillator must have touched nothing before its first noise


def ticks(run: Trajectory, oscillator: str, starts: Array, ends: Array, half_period: float) -> Array:
    """For each half swing from `starts` to `ends` (s), the time of the oscillator's first impact after a silence; else nan.

    What rings on from the half swing before (a knock at the turning point) is not silence and is passed over.
    """
    noises = contact_events(run, involves(oscillator), EventKind.IMPACT)["t"]
    first_of_burst = noises[np.diff(noises, prepend=-np.inf) >= QUIET * half_period]
    place = np.searchsorted(first_of_burst, starts, side="right")
    found = np.append(first_of_burst, np.inf)[place]
    return np.where(found < ends, found, np.nan)
