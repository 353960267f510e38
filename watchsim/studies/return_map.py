"""How exactly is a cycle known, and does it close after a whole turn of the wheel?"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from watchsim.analysis.verdict_kinds import BACKWARDS, KNOCKS, STOPS, TRIPS, UNSETTLED
from watchsim.simulation.knock_tally import OUTSIDE
from watchsim.simulation.state import EventKind, State
from watchsim.simulation.trajectory import Array
from watchsim.studies.cycle import Measures, measures
from watchsim.studies.section import Events, Loop, Parts, Section, SolverGaveUp, copied, is_touched, others_rest, turns

# One oscillation, from a turning point to the next one on the same side, and what else must be true of it: two turning
# points, all else at rest at the last one, and the wheel one tooth further.

EARLY, LATE = 0.03, 0.06  # of a period: how long before its end an oscillation is looked at, and for how long after
LONGER = 1.5  # times the time of the last oscillation: how long the next one may take
NEAR = 0.05  # of a pitch: by how much the wheel may miss a whole number of teeth
RECENT = 32  # returns that are remembered


class Return(NamedTuple):
    """One oscillation or several; SI.

    amplitude  at the turning point it ends with; `time` of it, from that at which it began
    trouble    "" for a regular one, else the verdict that it suggests
    state      at its end, or shortly before where nothing touches the oscillator; all but that at rest. None after trouble
    events     all of it
    """

    amplitude: float
    time: float
    trouble: str
    state: State | None
    events: Events


class ReturnMap:
    """Oscillations from one section, at any amplitude. `period` (s) follows what was found last."""

    def __init__(self, loop: Loop, parts: Parts, section: Section) -> None:
        self.loop, self.parts, self.section = loop, parts, section
        self.period = parts.period
        self._recent: dict[float, Return] = {}  # single ones by their amplitude: that of a fixed point is looked at again

    def __call__(self, amplitude: float, oscillations: int = 1) -> Return:
        """So many oscillations that begin at that amplitude; whoever gets one that is known leaves its state as it is."""
        if oscillations > 1:
            return self._computed(amplitude, oscillations)
        if amplitude not in self._recent:
            if len(self._recent) >= RECENT:
                self._recent.clear()
            self._recent[amplitude] = self._computed(amplitude, 1)
        return self._recent[amplitude]

    def _computed(self, amplitude: float, oscillations: int) -> Return:
        begin = self.section.at(self.loop, self.parts, amplitude)
        if begin is None:
            return Return(np.nan, 0.0, UNSETTLED, None, np.zeros(0))
        try:
            got, usual = self._followed(copied(begin), oscillations), self.period
            if got.trouble in (UNSETTLED, STOPS) and self._timed_anew(begin, oscillations):
                got = self._followed(begin, oscillations)
                self.period = usual if got.trouble else self.period
            return got
        except SolverGaveUp as failure:
            return Return(np.nan, failure.time, str(failure), None, np.zeros(0))

    def _timed_anew(self, begin: State, oscillations: int) -> bool:
        """True where it swings in another time than the last one did: `period` is then that time."""
        state = copied(begin)
        own = turns(self.loop.on(state, LONGER * oscillations * self.period), self.parts)
        if len(own) < 2 * oscillations:
            return False
        period = float(own[2 * oscillations - 1]["t"]) / oscillations
        other = abs(period - self.period) > 0.5 * EARLY * self.period
        self.period = period if other else self.period
        return other

    def _followed(self, state: State, oscillations: int) -> Return:
        end = oscillations * self.period
        events = self.loop.on(state, end - EARLY * self.period, exactly=True)
        seen = len(turns(events, self.parts))
        advance = self._advance(state)
        kept = copied(state)
        events = np.concatenate([events, self.loop.on(state, end + LATE * self.period)])
        own = turns(events, self.parts)
        trouble = self._trouble(seen, own, events, oscillations, advance)
        if trouble:
            return Return(np.nan, end, trouble, None, events)
        last = own[2 * oscillations - 1]
        if self.section.touching:
            self.loop.on(kept, float(last["t"]), exactly=True)
        if is_touched(self.parts, kept) != self.section.touching or not others_rest(self.loop, self.parts, kept):
            return Return(np.nan, end, UNSETTLED, None, events)
        self.period = float(last["t"]) / oscillations
        away = self.section.side * (float(last["value"]) - self.parts.level)
        return Return(away, float(last["t"]), "", kept, events[events["t"] <= last["t"]])

    def _advance(self, state: State) -> float:
        """How far the wheel has come, rad."""
        i = self.parts.wheel
        return self.parts.sense * float(state.q[i] - self.section.state.q[i]) if i >= 0 else 0.0

    def _trouble(self, seen: int, own: Events, events: Events, oscillations: int, advance: float) -> str:
        parts = self.parts
        if parts.has_lever and knocked(events, own, parts):
            return KNOCKS
        teeth = advance / parts.pitch if parts.pitch else None
        if teeth is not None:
            if teeth < -NEAR:
                return BACKWARDS
            if teeth > oscillations + NEAR:
                return TRIPS
            if teeth < oscillations - NEAR:
                return STOPS
        elif parts.wheel >= 0 and advance <= 0.0:
            return BACKWARDS if advance < 0.0 else STOPS
        if len(own) < 2 * oscillations:
            return STOPS
        sides = np.sign(own["value"][: 2 * oscillations] - parts.level) * self.section.side
        regular = seen == 2 * oscillations - 1 and (sides == np.resize([-1.0, 1.0], 2 * oscillations)).all()
        return "" if regular else UNSETTLED


def knocked(events: Events, own: Events, parts: Parts) -> bool:
    """Was the oscillator struck by the lever, or by a stop, more than half a turn from its rest position?

    How far from it a noise was heard follows from its time: between passage and turning point nearly a sine.
    """
    noises = events["t"][(events["kind"] == EventKind.IMPACT) & parts.blocking[events["contact"]]]
    passages = events["t"][(events["kind"] == EventKind.CROSS) & (events["body"] == parts.body)]
    reach = np.abs(own["value"] - parts.level)
    if not len(noises) or not len(passages) or not reach.max(initial=0.0) > OUTSIDE:
        return False
    reached, reach = np.append(0.0, own["t"]), np.append(reach[0], reach)
    for passage in passages:
        after = int(np.searchsorted(reached, passage))
        if after == len(reached):
            continue
        heard = noises[(noises > reached[after - 1]) & (noises <= reached[after])]
        turn = np.where(heard < passage, after - 1, after)
        away = reach[turn] * np.sin(0.5 * np.pi * (heard - passage) / (reached[turn] - passage))
        if (away > OUTSIDE).any():
            return True
    return False


# Orbits of a smooth map of one number run monotonically to the next fixed point, or out of the region where the mechanism
# works as it should. So the search goes where the map goes, by Newton's steps with slopes between the last two points, and
# keeps brackets.

EXACT = 2e-14  # of the amplitude: less than rounding
ENOUGH = 1e-10  # of the amplitude: what must be reached
MOST = 60  # oscillations
FARTHEST = 0.5  # of the amplitude, in one step
EDGE = 2e-3  # of the amplitude: how closely the end of the region is looked for
LEAST = 1e-3  # of the first amplitude: smaller swings are none


class Fixed(NamedTuple):
    """The fixed point, what is left of its residual, and the slope of the map there as the search saw it."""

    amplitude: float
    residual: float
    slope: float


class Lost(NamedTuple):
    """No fixed point on the way: at `amplitude` there is `trouble`; `rising` where that lies above the start."""

    amplitude: float
    trouble: str
    rising: bool


def fixed_point(oscillate: Callable[[float], Return], start: float, slope: float | None = None) -> Fixed | Lost:
    """The fixed point that the orbit from `start` runs to; `slope` of the map, where about that is expected."""
    first = oscillate(start)
    if first.trouble:
        return Lost(start, first.trouble, False)
    old, g_old = start, first.amplitude - start
    here = first.amplitude if slope is None else _newton(start, g_old, slope)
    below = above = bad = None  # ends of a bracket of the fixed point, and where the mechanism does not work as it should
    slope, best = 0.0, Fixed(start, g_old, 0.0)
    below, above = (start, None) if g_old > 0.0 else (None, start)
    for _ in range(MOST):
        got = oscillate(here)
        if got.trouble:
            bad, trouble = here, got.trouble
            if abs(bad - old) <= EDGE * start:
                return Lost(bad, trouble, g_old > 0.0)
            here = 0.5 * (old + bad)
            continue
        g = got.amplitude - here
        if abs(here - old) > EXACT * start:
            slope = 1.0 + (g - g_old) / (here - old)
        if abs(g) < abs(best.residual):
            best = Fixed(here, g, slope)
        if abs(g) <= EXACT * start or (abs(g) >= abs(g_old) and abs(best.residual) <= ENOUGH * start):
            return best
        below, above = (here, above) if g > 0.0 else (below, here)
        old, g_old = here, g
        # Newton's step; within the bracket, no further than half the amplitude, and on the good side of what went wrong.
        new = _newton(here, g, slope)
        if below is not None and above is not None and not min(below, above) < new < max(below, above):
            new = 0.5 * (below + above)
        if bad is not None and (bad - here) * (bad - new) <= 0.0:
            new = 0.5 * (here + bad)
        here = new
        if here < LEAST * start:
            return Lost(here, UNSETTLED, False)
    return best if abs(best.residual) <= ENOUGH * start else Lost(here, UNSETTLED, g_old > 0.0)


def _newton(here: float, residual: float, slope: float) -> float:
    """Newton's step, no further than half the amplitude; so far where the map would never come back."""
    step = residual / (1.0 - slope) if slope < 1.0 else math.copysign(math.inf, residual)
    return here + max(-FARTHEST * here, min(FARTHEST * here, step))


# An orbit is followed without restarting it, and its turning points are compared with those 1, 2, 3, … oscillations
# before.

FOLLOWED = 64  # oscillations
MOST_REPEATS = 16  # oscillations after which it may repeat itself
NEAR_REPEATS = 1e-5  # of the amplitude: how closely it must have come back
ROUNDS = 6  # times so many oscillations are followed


def repeats(oscillate: ReturnMap, amplitude: float) -> tuple[int, float] | None:
    """After how many oscillations the orbit from there repeats itself, and at which amplitude; None where it does not."""
    for _ in range(ROUNDS):
        reached = followed(oscillate, amplitude)
        if reached is None:
            return None
        amplitude = float(reached[-1])
        for number in range(1, MOST_REPEATS + 1):
            if np.abs(reached[-2 * number :] - reached[-3 * number : -number]).max() <= NEAR_REPEATS * amplitude:
                return number, amplitude
    return None


def followed(oscillate: ReturnMap, amplitude: float) -> Array | None:
    """Amplitudes after each of the next oscillations; None where one of them is not regular."""
    got = oscillate(amplitude, FOLLOWED)
    if got.trouble:
        return None
    values = turns(got.events, oscillate.parts)["value"][1::2]
    reached: Array = oscillate.section.side * (values - oscillate.parts.level)
    return reached


NUDGES = (1e-3, 1e-4, 1e-5)  # of the amplitude: how far apart the map's slope is measured, until it is even there
SMOOTH = 1e-3  # of the slope: what two steps may differ by
ALIKE = 1e-9  # of the amplitude: teeth that differ by less are alike
CLOSED = 1e-11  # of the amplitude: what a turn of a wheel with unequal teeth must close to
MOST_POLISH = 12  # turns
MOST_TEETH = 400
MOST_ROUNDS = 20  # turns of the wheel
FINER, COARSER = 0.01, 10.0  # times the tolerance: to see what the tolerance does
CAUTION = 3.0  # times what it does, and what else is known of the error


class Slope(NamedTuple):
    """Of the map and of the period over amplitude, by central differences, and how far off the first may be."""

    multiplier: float
    error: float
    period: float  # s/rad


class Polished(NamedTuple):
    """Means over a cycle, their errors (SI), and its multiplier over `per` oscillations; None for what was not asked for.

    `amplitude`: where it turns at the section; `turn`: the whole cycle from there.
    """

    means: Measures
    amplitude: float
    turn: Return
    amplitude_error: float | None = None
    period_error: float | None = None
    beat_error_error: float | None = None
    multiplier: float | None = None
    multiplier_error: float | None = None
    per: int = 1

    def moved_by(self, amplitude: float) -> Polished:
        """The same, the amplitude less sure by so much (rad or m)."""
        return self._replace(amplitude_error=(self.amplitude_error or 0.0) + amplitude)


def glanced(oscillate: ReturnMap, found: Fixed) -> Polished:
    """The cycle by the one oscillation at the fixed point."""
    got = oscillate(found.amplitude)
    return Polished(measures(got.events, oscillate.parts, _start(oscillate, found.amplitude), got.time), found.amplitude, got)


def slope_at(oscillate: ReturnMap, amplitude: float, oscillations: int = 1) -> Slope | Return:
    """Slopes at that amplitude; the return that went wrong where one does."""
    found = None
    for nudge in NUDGES:
        step = nudge * amplitude
        ends = []
        for away in (-step, step, -0.5 * step, 0.5 * step):
            got = oscillate(amplitude + away, oscillations)
            if got.trouble:
                return found or got
            ends.append(got)
        wide = (ends[1].amplitude - ends[0].amplitude) / (2.0 * step)
        narrow = (ends[3].amplitude - ends[2].amplitude) / step
        period = (ends[3].time - ends[2].time) / (step * oscillations)
        found = Slope((4.0 * narrow - wide) / 3.0, abs(narrow - wide) / 3.0, period)
        if found.error <= SMOOTH:
            break
    assert found is not None
    return found


def turn_of(oscillate: ReturnMap, amplitude: float) -> tuple[int, Return]:
    """Oscillations until the wheel stands as before, and its train (1 without one); and these from that amplitude on.

    Where a train takes more than MOST_ROUNDS turns for that, so many are all.
    """
    parts = oscillate.parts
    if parts.wheel < 0:
        return 1, oscillate(amplitude)
    if parts.teeth:
        number = parts.teeth * min(parts.rounds, MOST_ROUNDS)
        return number, oscillate(amplitude, number)
    got = oscillate(amplitude)
    if got.state is None:
        return 1, got
    step = abs(float(got.state.q[parts.wheel] - oscillate.section.state.q[parts.wheel]))
    guess = 2.0 * np.pi / step if step > 0.0 else 1.0
    number = round(guess) if 1.0 <= guess <= MOST_TEETH else 1
    return number, got if number == 1 else oscillate(amplitude, number)


def polished(oscillate: ReturnMap, found: Fixed, others: Sequence[Loop]) -> Polished | Return:
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
    shift, period_shift = _tolerance_shift(oscillate, amplitude, turn, number, whole, slope.period, others)
    means = measures(turn.events, oscillate.parts, _start(oscillate, amplitude), turn.time)
    scatter = means.spread / math.sqrt(number) if per == 1 else 0.0
    amplitude_error = CAUTION * (abs(left) + shift) + scatter
    if oscillate.parts.rounds > MOST_ROUNDS:  # other teeth of the train mesh in each turn
        amplitude_error += float(np.ptp(np.reshape(means.each, (MOST_ROUNDS, -1)).mean(axis=1)))
    return _with_errors(means, amplitude, turn, amplitude_error, slope, period_shift)._replace(
        multiplier=whole if per > 1 else slope.multiplier, multiplier_error=error, per=per
    )


def polished_over(oscillate: ReturnMap, amplitude: float, number: int, others: Sequence[Loop]) -> Polished | Return:
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
    shift, period_shift = _tolerance_shift(oscillate, amplitude, turn, number, slope.multiplier, slope.period, others)
    means = measures(turn.events, oscillate.parts, _start(oscillate, amplitude), turn.time)
    return _with_errors(means, amplitude, turn, CAUTION * (abs(left) + shift), slope, period_shift)._replace(
        multiplier=slope.multiplier, multiplier_error=slope.error, per=number
    )


def _with_errors(means: Measures, amplitude: float, turn: Return, error: float, slope: Slope, period_shift: float) -> Polished:
    """Errors of period and beat error follow from that of the amplitude and from the solver's tolerance."""
    uneven = error / amplitude * means.period + period_shift
    return Polished(means, amplitude, turn, error, period_shift + abs(slope.period) * error, uneven)


def _start(oscillate: ReturnMap, amplitude: float) -> float:
    return oscillate.parts.level + oscillate.section.side * amplitude


def _closed(
    oscillate: ReturnMap, amplitude: float, number: int, turn: Return, whole: float
) -> tuple[float, Return, float] | Return:
    """The amplitude at which a turn of so many oscillations closes, that turn, and what is left."""
    for _ in range(MOST_POLISH):
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


def _tolerance_shift(
    oscillate: ReturnMap, amplitude: float, turn: Return, number: int, whole: float, period: float, others: Sequence[Loop]
) -> tuple[float, float]:
    """By how much amplitude and period move at most when the solver is more exact, or less: one turn of each is enough."""
    shifts = [(0.0, 0.0)]
    for other in others:
        there = ReturnMap(other, oscillate.parts, oscillate.section)
        there.period = oscillate.period
        got = there(amplitude, number)
        shift = np.nan if got.trouble else (got.amplitude - turn.amplitude) / (1.0 - whole)
        shifts.append((abs(shift), CAUTION * abs((got.time - turn.time) / number + period * shift)))
    return float(np.max([shift for shift, _ in shifts])), float(np.max([shift for _, shift in shifts]))
