"""What does a timegrapher write on its paper?

A dot per beat: by how much the beat came early against a clock of the nominal frequency. Beats of one direction of swing make
one line and those of the other a second; their slope is the rate, and their distance the beat error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing import DAY, Beats, Window, averages, beats, last_window, mean_and_error
from watchsim.simulation.recording import since_two_before, unevenness
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.storage.columns import blocks

# It hears noises only. From the first of a beat (the pin meets the fork, A) to the last loud one (a tooth meets the locking
# face, C) the balance is taken to swing through the lift angle, so that the amplitude is λ / (2 sin(π f Δt)). In truth C
# comes before the end of the lift, so that an instrument reads more than the true amplitude, which stands beside it in the
# summary. It reads nothing where the swing is barely larger than the lift angle: the noises then do not end with the beat.

LOUD = 1.0 / 3.0  # of the energy of the beat's loudest noise; a tooth's rebounds from the stone are fainter
LEAST = 1.5  # lift angles that the amplitude must be: instruments begin to show it at some 80°
ALIKE = 0.5  # °; nearer than that it shows the true amplitude
UNEVEN = 0.2  # of the interval from A to C: with more scatter there is no amplitude to be read
LONGEST = 1.0 / 3.0  # of half a period; later noises, such as a knock at the turning point, are not the escapement's


def timegrapher(run: Trajectory, found: Beats, window: Window | None = None) -> dict[str, Any] | None:
    """Readings over `window` (s; default the last one), null where not to be had; None where no beat is heard.

    `lift_angle_deg`, `interval_ms` from A to C, `amplitude_deg`, and from A alone `rate_s_per_d` and `beat_error_ms`;
    `message`: why the amplitude is not the true one, or is not shown.
    """
    start, end = window or last_window(run, found.nominal_period)
    inside = (found.tick >= start) & (found.tick <= end)
    if not inside.any():
        return None
    between = found.tick - np.concatenate([np.full(2, np.nan), found.tick])[: len(found)]
    period, _ = mean_and_error(between[inside & (found.tick - between >= start)])
    heard = intervals(run, found, inside)
    interval, _ = mean_and_error(heard)
    lift, means = run.scene.lift_angle, averages(found, (start, end))
    true = means.amplitude_deg
    shown = amplitude_deg(lift, interval, found.nominal_period)
    refused = None if shown is None else _refused(math.degrees(lift or 0.0), true, heard)
    if refused is not None:
        shown = None
    return {
        "lift_angle_deg": None if lift is None else math.degrees(lift),
        "interval_ms": None if interval is None else 1e3 * interval,
        "amplitude_deg": shown,
        "rate_s_per_d": None if period is None else DAY * (found.nominal_period / period - 1.0),
        "beat_error_ms": means.beat_error_ms,
        "message": refused or _why_another(shown, true),
    }


def _refused(lift: float, true: float | None, heard: Array) -> str | None:
    """Why an instrument could not determine the amplitude; `lift` and `true` in degrees."""
    if true is not None and true < LEAST * lift:
        return (
            f"it could not determine the amplitude: a swing of {true:.0f}° is barely larger than the lift angle of {lift:.4g}°"
        )
    heard = heard[np.isfinite(heard)]
    if np.std(heard) > UNEVEN * np.mean(heard):
        return "it could not determine the amplitude: the last loud noise comes at another time in each beat"
    return None


def _why_another(shown: float | None, true: float | None) -> str | None:
    if shown is None or true is None or abs(shown - true) < ALIKE:
        return None
    side = "before the lift is over, so it reads high" if shown > true else "after the lift is over, so it reads low"
    return f"its amplitude assumes that the lift ends with the last loud noise of a beat, which comes {side}"


def amplitude_deg(lift: float | None, interval: float | None, period: float) -> float | None:
    """Amplitude (degrees) from the lift angle (rad), the interval from A to C and the nominal period (s)."""
    if lift is None or interval is None or not 0.0 < interval < 0.5 * period:
        return None
    return math.degrees(lift / (2.0 * math.sin(math.pi * interval / period)))


def intervals(run: Trajectory, found: Beats, chosen: NDArray[np.bool_] | None = None) -> Array:
    """From noise A to noise C of each chosen beat (default all), s; nan where one of them is missing."""
    heard = np.isfinite(found.tick) if chosen is None else chosen & np.isfinite(found.tick)
    out = np.full(len(found), np.nan)
    latest = np.minimum(found.end, found.tick + LONGEST * 0.5 * found.nominal_period)
    if heard.any():
        times, energies = noises(run, float(found.tick[heard].min()), float(latest[heard].max()))
    for i in np.flatnonzero(heard):
        first, last = np.searchsorted(times, (found.tick[i], latest[i]), side="right")
        if last > first:
            loud = np.flatnonzero(energies[first:last] >= LOUD * energies[first:last].max())
            out[i] = times[first + loud[-1]] - found.tick[i]
    return out if chosen is None else out[chosen]


def noises(run: Trajectory, start: float = -np.inf, end: float = np.inf) -> tuple[Array, Array]:
    """Instants with impacts (s) from `start` to `end` and the energy lost in all impacts of each (J)."""
    found = [_noisy(part, start, end) for (part,) in blocks(run.events)]
    impacts = np.concatenate(found) if found else run.events
    times, place = np.unique(impacts["t"], return_inverse=True)
    energies: Array = np.bincount(place, weights=impacts["energy_lost"], minlength=len(times)).astype(float)
    return times, energies


def _noisy(events: NDArray[Any], start: float, end: float) -> NDArray[Any]:
    """The impacts among events, from `start` to `end`."""
    times = events["t"]
    return events[(events["kind"] == EventKind.IMPACT) & (times >= start) & (times <= end)]


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


def tape(run: Trajectory) -> Tape:
    """Of all beats of a run; ValueError where nothing swings, or none of its beats is heard."""
    found = beats(run)
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
