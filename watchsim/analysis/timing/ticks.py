"""When does a listener hear the beats?

The first noise of a beat is the impulse pin meeting the fork. Rate and beat error are taken from it by every timegrapher, since
it comes before anything that depends on the escapement's own play.
"""

from __future__ import annotations

from watchsim.analysis.timing.body_contacts import contact_columns, involves
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.half_swings import first_noises
from watchsim.simulation.record.trajectory import Array, Trajectory


def ticks(run: Trajectory, oscillator: str, starts: Array, ends: Array, half_period: float) -> Array:
    """For each half swing from `starts` to `ends` (s), the time of the oscillator's first impact after a silence; else nan."""
    (noises,) = contact_columns(run, involves(oscillator), ["t"], EventKind.IMPACT)
    return first_noises(noises, starts, ends, half_period)
