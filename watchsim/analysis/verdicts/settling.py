"""Has the swing settled?

An amplitude settles like an exponential. Of three equal stretches of time in a row, with mean amplitudes a, b, c, what is
still to come after the last is (c - b) r / (1 - r) with r = (c - b) / (b - a) (Aitken).
"""

from __future__ import annotations

import math

import numpy as np

from watchsim.analysis.timing.averages import averages, last_window
from watchsim.analysis.verdicts.verdict_kinds import UNSETTLED, Verdict
from watchsim.analysis.verdicts.watch import Watch
from watchsim.simulation.record.trajectory import Array

FEWEST = 12  # half swings that three stretches take
LONGEST = 120  # half swings that are looked at: those before may belong to another motion
SETTLED = 2e-3  # of the amplitude: how far it may still have to go
SURE = 3.0  # standard errors, beyond which a drift is one
SLOWEST = 0.98  # ratio of steps, beyond which no end is foretold


def unsettled(watch: Watch) -> Verdict | None:
    """None where the amplitude will change by less than 0.2 %."""
    found = watch.found
    if len(found) < FEWEST:
        words = f"not settled yet: {len(found)} half swings are too few to tell how the watch goes"
        return Verdict(UNSETTLED, words, body=watch.oscillator)
    stretch = 2 * (min(len(found), LONGEST) // 6)  # half swings of both directions in each
    parts = found.amplitude_deg[-3 * stretch :].reshape(3, stretch)
    steps, error = np.diff(parts.mean(axis=1)), _error(parts)
    if abs(steps[1]) <= SURE * error:
        return None
    ratio = steps[1] / steps[0] if steps[0] else np.inf
    last, whole = float(found.amplitude_deg[-1]), float(parts[2].mean())
    to_come = steps[1] * ratio / (1.0 - ratio) if 0.0 < ratio < SLOWEST else None
    goal = None if to_come is None else whole + to_come
    left = abs(steps[1]) if goal is None else abs(goal - last)
    if left <= SETTLED * whole:
        return None
    per_second = steps[1] / (stretch * 0.5 * found.nominal_period)
    words = f"not settled yet: the amplitude {'rises' if per_second > 0.0 else 'falls'} by {abs(per_second):.2g}° per second"
    words += f", on its way to about {goal:.{_decimals(abs(goal - last))}f}°" if goal is not None and goal > 0.0 else ""
    words += _rate(watch)
    return Verdict(UNSETTLED, words, float(found.t[-1]), watch.oscillator, torque=watch.drive(watch.run.simulated))


def _decimals(way: float) -> int:
    """So many that what is still to come can be seen."""
    return max(0, -math.floor(math.log10(way)))


def _error(parts: Array) -> float:
    """Standard error of the difference of two means, by the scatter about the straight lines through the stretches."""
    pairs = parts.reshape(3, -1, 2).mean(axis=2)
    if pairs.shape[1] < 3:
        return 0.0
    place = np.arange(pairs.shape[1]) - 0.5 * (pairs.shape[1] - 1)
    slopes = pairs @ place / (place @ place)
    rest = pairs - pairs.mean(axis=1, keepdims=True) - slopes[:, None] * place
    return float(np.sqrt(2.0 * rest.var() / pairs.shape[1]))


def _rate(watch: Watch) -> str:
    """How sure the rate is, where it is known."""
    means = averages(watch.found, last_window(watch.run, watch.found.nominal_period))
    return "" if means.rate_s_per_d is None else "; amplitude and rate are those of this moment, not of the watch"
