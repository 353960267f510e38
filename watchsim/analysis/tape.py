"""What does a timegrapher write on its paper?

A dot per beat: by how much the beat came early against a clock of the nominal frequency. Beats of one direction of swing make
one line and those of the other a second; their slope is the rate, and their distance the beat error.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.beats import DAY, Beats, beats
from watchsim.analysis.timing.timegrapher import amplitude_deg, intervals
from watchsim.simulation.record.half_swings import since_two_before, unevenness
from watchsim.simulation.record.trajectory import Array, Trajectory


@dataclass(frozen=True)
class Tape:
    """One entry per beat that was heard (n,); nan where a value needs beats before the first.

    t              first noise, s
    gain_ms        how early it came against the first beat, ms
    forward        swing towards larger angles ("tick"), else back ("tock")
    rate_s_per_d   of the oscillation that ends with it
    beat_error_ms  of its two halves, |T1 - T2|/2
    amplitude_deg  the true one; `shown_deg`: what the instrument makes of the lift angle and the noises
    """

    nominal_period: float
    t: Array
    gain_ms: Array
    forward: NDArray[np.bool_]
    rate_s_per_d: Array
    beat_error_ms: Array
    amplitude_deg: Array
    shown_deg: Array


def tape(run: Trajectory, found: Beats | None = None) -> Tape:
    """Of all beats of a run; ValueError where nothing swings, or none of its beats is heard."""
    found = beats(run) if found is None else found
    heard = np.isfinite(found.tick)
    if not heard.any():
        raise ValueError(f"no beat of {found.body} is heard in this run, so there is nothing to write on the paper")
    t, half = found.tick[heard], 0.5 * found.nominal_period
    number = np.concatenate([[0.0], np.cumsum(np.rint(np.diff(t) / half))])
    # After a beat that was not heard the times before say nothing of one oscillation.
    whole = np.concatenate([np.full(2, np.nan), number])[: len(t)] == number - 2.0
    between = intervals(run, found)[heard]
    lift = run.scene.lift_angle
    shown = [amplitude_deg(lift, one if np.isfinite(one) else None, found.nominal_period) for one in between.tolist()]
    return Tape(
        found.nominal_period,
        t,
        1e3 * (number * half - (t - t[0])),
        (found.end_at > found.start_at)[heard],
        np.where(whole, DAY * (found.nominal_period / since_two_before(t) - 1.0), np.nan),
        np.where(whole, 500.0 * np.abs(unevenness(t)), np.nan),
        found.amplitude_deg[heard],
        np.array([np.nan if one is None else one for one in shown]),
    )
