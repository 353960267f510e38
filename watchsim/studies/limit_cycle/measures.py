"""What are amplitude, period and beat error over a cycle that closes?

The same definitions as for the beats of a run, over exactly one turn of the wheel: half swings from turning point to turning
point, noises with the silence before them. As the cycle closes, the first half swing has its predecessors too.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from watchsim.analysis.timing.beats import HEARD
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.half_swings import first_noises, unevenness
from watchsim.simulation.record.trajectory import Array
from watchsim.studies.limit_cycle.oscillator_and_wheel import Parts
from watchsim.studies.limit_cycle.run_from_state import Events
from watchsim.studies.limit_cycle.section import turns


class Measures(NamedTuple):
    """Means over a cycle; SI. `spread` is the largest minus the smallest amplitude of whole oscillations, `each` all of them.

    uneven  half of: the half period that ends in a swing upwards, less the one that ends in a swing downwards; the beat error
            is its magnitude
    """

    amplitude: float
    period: float
    uneven: float
    spread: float
    each: tuple[float, ...] = ()


def measures(events: Events, parts: Parts, start: float, time: float) -> Measures:
    """Of a cycle that begins at time 0 at the turning point `start` (rad or m) and ends after `time` (s) at the last one."""
    own = turns(events, parts)
    reached = np.append(start, own["value"])
    ways = np.diff(reached)
    amplitude = 0.5 * np.abs(ways)
    whole = 0.5 * (amplitude[0::2] + amplitude[1::2])
    marks = _marks(events, parts, np.append(0.0, own["t"]))
    around = np.concatenate([marks[-2:] - time, marks])
    uneven = np.sign(ways) * unevenness(around)[2:]
    period = time / (len(ways) // 2)
    return Measures(float(amplitude.mean()), period, 0.5 * float(uneven.mean()), float(np.ptp(whole)), tuple(whole.tolist()))


def _marks(events: Events, parts: Parts, ends: Array) -> Array:
    """What the beat error is measured by: first noises where they are heard, else passages; one for each half swing."""
    noises = events["t"][(events["kind"] == EventKind.IMPACT) & parts.touching[events["contact"]]]
    heard = first_noises(noises, ends[:-1], ends[1:], 0.5 * parts.period)
    passages = events["t"][(events["kind"] == EventKind.CROSS) & (events["body"] == parts.body)]
    if len(passages) != len(heard) or np.isfinite(heard).mean() >= HEARD:
        return heard
    return passages
