"""How exactly is a cycle known, and does it close after a whole turn of the wheel?"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from watchsim.studies.limit_cycle.measures import Measures, measures
from watchsim.studies.limit_cycle.return_map import Return, ReturnMap
from watchsim.studies.limit_cycle.run_from_state import Loop
from watchsim.studies.limit_cycle.shooting import Fixed

NUDGE = 1e-3  # of the amplitude: how far apart the map's slope is measured
ALIKE = 1e-9  # of the amplitude: teeth that differ by less are alike
CLOSED = 1e-11  # of the amplitude: what a turn of a wheel with unequal teeth must close to
MOST = 12  # turns
MOST_TEETH = 400
FINER = 0.1  # times the tolerance: to see what the tolerance does


class Slope(NamedTuple):
    """Of the map and of the period over amplitude, by central differences, and how far off the first may be."""

    multiplier: float
    error: float
    period: float  # s/rad


class Polished(NamedTuple):
    """Means over a cycle, their errors (SI), and its multiplier over `per` oscillations; None for what was not asked for."""

    means: Measures
    amplitude_error: float | None = None
    period_error: float | None = None
    beat_error_error: float | None = None
    multiplier: float | None = None
    multiplier_error: float | None = None
    per: int = 1


def glanced(oscillate: ReturnMap, found: Fixed) -> Polished:
    """The cycle by the one oscillation at the fixed point."""
    got = oscillate(found.amplitude)
    return Polished(measures(got.events, oscillate.parts, _start(oscillate, found.amplitude), got.time))


def slope_at(oscillate: ReturnMap, amplitude: float, oscillations: int = 1) -> Slope | Return:
    """Slopes at that amplitude; the return that went wrong where one does."""
    step = NUDGE * amplitude
    ends = []
    for away in (-step, step, -0.5 * step, 0.5 * step):
        got = oscillate(amplitude + away, oscillations)
        if got.trouble:
            return got
        ends.append(got)
    wide = (ends[1].amplitude - ends[0].amplitude) / (2.0 * step)
    narrow = (ends[3].amplitude - ends[2].amplitude) / step
    period = (ends[3].time - ends[2].time) / (step * oscillations)
    return Slope((4.0 * narrow - wide) / 3.0, abs(narrow - wide) / 3.0, period)


def turn_of(oscillate: ReturnMap, amplitude: float) -> tuple[int, Return]:
    """Oscillations in a turn of the wheel (1 without one), and that turn from that amplitude on."""
    parts = oscillate.parts
    if parts.wheel < 0:
        return 1, oscillate(amplitude)
    if parts.teeth:
        return parts.teeth, oscillate(amplitude, parts.teeth)
    got = oscillate(amplitude)
    if got.state is None:
        return 1, got
    step = abs(float(got.state.q[parts.wheel] - oscillate.section.state.q[parts.wheel]))
    guess = 2.0 * np.pi / step if step > 0.0 else 1.0
    number = round(guess) if 1.0 <= guess <= MOST_TEETH else 1
    return number, got if number == 1 else oscillate(amplitude, number)


def polished(oscillate: ReturnMap, found: Fixed, finer: Loop) -> Polished | Return:
    """The cycle at the fixed point of one oscillation, over a whole turn; the return that went wrong where one does.

    Where the teeth differ the turn is closed by Newton's steps of its own.
    """
    amplitude = found.amplitude
    slope = slope_at(oscillate, amplitude)
    if isinstance(slope, Return):
        return slope
    number, turn = turn_of(oscillate, amplitude)
    if turn.trouble:
        return turn
    whole = slope.multiplier**number
    left = (turn.amplitude - amplitude) / (1.0 - whole)
    per, error = 1, slope.error
    if abs(left) > ALIKE * amplitude and number > 1:
        closed = _closed(oscillate, amplitude, number, turn, whole)
        if isinstance(closed, Return):
            return closed
        amplitude, turn, left = closed
        unequal = slope_at(oscillate, amplitude, number)
        if isinstance(unequal, Return):
            return unequal
        whole, error, per = unequal.multiplier, unequal.error, number
    shift, period_shift = _tolerance_shift(oscillate, amplitude, slope, finer)
    means = measures(turn.events, oscillate.parts, _start(oscillate, amplitude), turn.time)
    scatter = means.spread / math.sqrt(number) if per == 1 else 0.0
    amplitude_error = abs(left) + shift + scatter
    return _with_errors(means, amplitude, amplitude_error, slope, period_shift)._replace(
        multiplier=whole if per > 1 else slope.multiplier, multiplier_error=error, per=per
    )


def polished_over(oscillate: ReturnMap, amplitude: float, number: int, finer: Loop) -> Polished | Return:
    """The cycle of so many oscillations that closes near that amplitude; the return that went wrong where one does."""
    slope, turn = slope_at(oscillate, amplitude, number), oscillate(amplitude, number)
    if isinstance(slope, Return) or turn.trouble:
        return slope if isinstance(slope, Return) else turn
    closed = _closed(oscillate, amplitude, number, turn, slope.multiplier)
    if isinstance(closed, Return):
        return closed
    amplitude, turn, left = closed
    slope = slope_at(oscillate, amplitude, number)
    if isinstance(slope, Return):
        return slope
    shift, period_shift = _tolerance_shift(oscillate, amplitude, slope, finer, number)
    means = measures(turn.events, oscillate.parts, _start(oscillate, amplitude), turn.time)
    return _with_errors(means, amplitude, abs(left) + shift, slope, period_shift)._replace(
        multiplier=slope.multiplier, multiplier_error=slope.error, per=number
    )


def _with_errors(means: Measures, amplitude: float, error: float, slope: Slope, period_shift: float) -> Polished:
    """Errors of period and beat error follow from that of the amplitude and from the solver's tolerance."""
    return Polished(means, error, period_shift + abs(slope.period) * error, error / amplitude * means.period + period_shift)


def _start(oscillate: ReturnMap, amplitude: float) -> float:
    return oscillate.parts.level + oscillate.section.side * amplitude


def _closed(
    oscillate: ReturnMap, amplitude: float, number: int, turn: Return, whole: float
) -> tuple[float, Return, float] | Return:
    """The amplitude at which a turn of so many oscillations closes, that turn, and what is left."""
    for _ in range(MOST):
        left = (turn.amplitude - amplitude) / (1.0 - whole)
        if abs(left) <= CLOSED * amplitude:
            break
        earlier, ended = amplitude, turn.amplitude
        amplitude += left
        turn = oscillate(amplitude, number)
        if turn.trouble:
            return turn
        seen = (turn.amplitude - ended) / (amplitude - earlier)
        whole = seen if abs(amplitude - earlier) > 1e-6 * amplitude and seen < 1.0 else whole
    return amplitude, turn, left


def _tolerance_shift(oscillate: ReturnMap, amplitude: float, slope: Slope, finer: Loop, number: int = 1) -> tuple[float, float]:
    """By how much amplitude and period move when the solver is ten times as exact: one return of each is enough."""
    here, there = oscillate(amplitude, number), ReturnMap(finer, oscillate.parts, oscillate.section)
    there.period = oscillate.period
    exact = there(amplitude, number)
    if here.trouble or exact.trouble:
        return np.nan, np.nan
    shift = (exact.amplitude - here.amplitude) / (1.0 - slope.multiplier)
    return abs(shift), abs((exact.time - here.time) / number + slope.period * shift)
