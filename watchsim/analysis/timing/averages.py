"""What are amplitude, rate and beat error over a stretch of time, and how sure are they?

Every error is the standard error of the mean from beat to beat (both directions of swing taken together, as they differ in a
steady watch too) joined with the drift from the first to the last half of the window: a watch that has not settled says so.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from watchsim.analysis.timing.beats import DAY, Beats, beats
from watchsim.scene.roles import roles
from watchsim.simulation.record.half_swings import unevenness
from watchsim.simulation.record.row_selection import USUAL_PERIODS, USUAL_WINDOW
from watchsim.simulation.record.trajectory import Array, Trajectory

Window = tuple[float, float]

FEWEST_PERIODS = 3


@dataclass(frozen=True, slots=True)
class Averages:
    """Means over the window from `start_s` to `end_s`, each with its error; None where the window holds too little."""

    start_s: float
    end_s: float
    beats: int
    amplitude_deg: float | None = None
    amplitude_deg_error: float | None = None
    period_s: float | None = None
    period_s_error: float | None = None
    rate_s_per_d: float | None = None
    rate_s_per_d_error: float | None = None
    beat_error_ms: float | None = None
    beat_error_ms_error: float | None = None


def headline(run: Trajectory) -> Averages | None:
    """The averages at the end of a run, see `last_window`; None where nothing swings."""
    if roles(run.scene).oscillator is None:
        return None
    found = beats(run)
    return averages(found, last_window(run, found.nominal_period))


def mean_over(run: Trajectory, window: Window | None = None, body: str | None = None) -> Averages:
    """Averages over `window` (s, s; default the last one) for the first sprung body or the one named."""
    found = beats(run, body)
    return averages(found, window or last_window(run, found.nominal_period))


def last_window(run: Trajectory, period: float) -> Window:
    """The last 2 s or eight periods, whichever is longer; at most the last third of a short run, at least three periods."""
    end = run.simulated
    length = min(max(USUAL_WINDOW, USUAL_PERIODS * period), end / 3.0)
    return max(0.0, end - max(length, FEWEST_PERIODS * period)), end


def averages(found: Beats, window: Window) -> Averages:
    """Means of the half swings whose passage through the rest position lies in the window."""
    start, end = window
    inside = (found.t >= start) & (found.t <= end)
    amplitude, amplitude_error = mean_and_error(found.amplitude_deg[inside])
    period, period_error = mean_and_error(found.period_s[inside & (found.t - found.period_s >= start)])
    rate, rate_error = _rate(found.nominal_period, period, period_error)
    uneven, uneven_error = mean_and_error(_unevenness(found)[inside])
    return Averages(
        start_s=start,
        end_s=end,
        beats=int(inside.sum()),
        amplitude_deg=amplitude,
        amplitude_deg_error=amplitude_error,
        period_s=period,
        period_s_error=period_error,
        rate_s_per_d=rate,
        rate_s_per_d_error=rate_error,
        beat_error_ms=None if uneven is None else abs(uneven),
        beat_error_ms_error=uneven_error,
    )


def mean_and_error(values: Array) -> tuple[float | None, float | None]:
    """Mean and error of one value per beat, without nan; None where there are too few: one for the mean, four for the error."""
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return None, None
    if len(values) < 4:
        return float(values.mean()), None
    pairs = values[len(values) % 2 :].reshape(-1, 2).mean(axis=1)
    half = len(pairs) // 2
    scatter = pairs.std(ddof=1) / math.sqrt(len(pairs))
    drift = pairs[-half:].mean() - pairs[:half].mean()
    return float(values.mean()), float(math.hypot(scatter, drift))


def _rate(nominal: float, period: float | None, error: float | None) -> tuple[float | None, float | None]:
    """Of the mean period, not the mean of the rates: what the hands show."""
    if period is None:
        return None, None
    return DAY * (nominal / period - 1.0), None if error is None else DAY * nominal / period**2 * error


def _unevenness(found: Beats) -> Array:
    """(T1 - T2)/2 in ms with the sign of the direction of swing, so that chance does not add up to a beat error."""
    return 500.0 * unevenness(found.mark) * np.sign(found.end_at - found.start_at)
