"""How is a return map looked at where the parts rest otherwise than at the section that is known?

A second wheel is let off by large swings only, a tooth rests on another face. There the mechanism is brought by itself: on
its way in the oscillator gets the velocity that belongs to the other amplitude, and the next clear turning point is a section.
"""

from __future__ import annotations

import bisect
import dataclasses
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from watchsim.analysis.timing import DAY, Averages, averages, beats
from watchsim.analysis.verdict import verdict
from watchsim.analysis.verdict_kinds import STOPS, TICKS, UNSETTLED
from watchsim.dynamics.forces import stored_energy
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Recording
from watchsim.simulation.foregone import Foregone
from watchsim.simulation.runner import Run, trajectory_of
from watchsim.simulation.state import NO_CONTACT, State, Stop, write_state
from watchsim.simulation.trajectory import Trajectory
from watchsim.studies.cycle import Cycle, Orbit, Range, measures
from watchsim.studies.return_map import CAUTION, Return, ReturnMap
from watchsim.studies.section import Loop, NoSection, Section, SolverGaveUp, first_section

# An ordinary run from where the search for a cycle ended, and the verdict on it. The only place that knows how a run is
# judged.

WHEN = re.compile(r"^t = \S+ s  ")  # counted from the start of a run that nobody has asked for


@dataclass(frozen=True)
class Judgement:
    """`name` is a verdict; None where nothing can be said, such as when the solver gave up."""

    name: str | None
    message: str


def run_from(loop: Loop, state: State | None, duration: float) -> Trajectory:
    """An ordinary run of so many seconds from a state with time 0; None: from the scene's start. KeyboardInterrupt ends it."""
    run = Run(loop.scene, loop.compiled, loop.tolerance, Recording())
    run.warm_up()
    if state is None:
        try:
            run.begin()
        except SceneError:
            state = loop.begin()  # which gives way by a little
    if state is not None:
        write_state(run.state, state)
        run.stored_at_start = float(stored_energy(run.compiled.model, run.state.q, run.state.u))
    run.foregone = Foregone(loop.scene, loop.compiled, at=run.state.q)
    stop = run.to_the_end(duration, None)
    if stop == Stop.INTERRUPTED:
        raise KeyboardInterrupt
    loop.simulated += float(run.state.clock.time)
    return trajectory_of(run, stop, 0.0, 0.0)


def judged(run: Trajectory, since_start: bool = False) -> Judgement:
    """What the mechanism does in that run; times are given only where it began with the scene (`since_start`)."""
    if run.stop.gave_up:
        return Judgement(None, run.stop_message)
    found = verdict(run)
    message = found.message or ""
    return Judgement(found.name, message if since_start else WHEN.sub("", message))


def late_means(run: Trajectory) -> Averages:
    """Means over the last third of a run, with their scatter, and what is still to come where it settles slowly."""
    found, end = beats(run), run.simulated
    late = averages(found, (2.0 * end / 3.0, end))
    parts = [averages(found, (share * end, (share + 1.0 / 6.0) * end)) for share in (0.5, 2.0 / 3.0, 5.0 / 6.0)]

    def error(name: str) -> float | None:
        known, values = getattr(late, f"{name}_error"), [getattr(part, name) for part in parts]
        return None if known is None or None in values else max(known, _to_come(*values))

    return dataclasses.replace(
        late,
        amplitude_deg_error=error("amplitude_deg"),
        period_s_error=error("period_s"),
        rate_s_per_d_error=error("rate_s_per_d"),
    )


def less_sure(means: Averages, others: Sequence[Averages]) -> Averages:
    """The errors of the means and by how much those of other runs of the same motion differ from them."""

    def error(name: str) -> float | None:
        here, known = getattr(means, name), getattr(means, f"{name}_error")
        there = [value for other in others if (value := getattr(other, name)) is not None]
        return None if known is None else known + CAUTION * max((abs(here - value) for value in there), default=0.0)

    return dataclasses.replace(
        means,
        amplitude_deg_error=error("amplitude_deg"),
        period_s_error=error("period_s"),
        rate_s_per_d_error=error("rate_s_per_d"),
        beat_error_ms_error=error("beat_error_ms"),
    )


def _to_come(a: float, b: float, c: float) -> float:
    """How far the end of an exponential that has these means in three equal stretches lies from the mean of the last two."""
    first, second = abs(b - a), abs(c - b)
    ratio = second / first if first > 0.0 else 0.0
    return 0.5 * second + (second * ratio / (1.0 - ratio) if ratio < 1.0 else second)


# The return map P is looked at from small swings to large ones. Where P(A) - A, or P(P(A)) - A, changes its sign there is a
# cycle of one or two oscillations, or a jump of the map. What a swing leads to follows from the map between the samples.

DOWN, UP = 16.0, 4.0  # times the amplitude that is known: how far the map is looked at
RATIO = 1.08  # from sample to sample
BEYOND = 3  # samples in a row where the mechanism does not work: larger swings are not examined
EXACT = 1e-12  # of the amplitude: how closely a cycle is looked for
EDGE = 1e-5  # of the amplitude: how closely the end of regular work is looked for
ROOT = 1e-7  # of the amplitude: more left than that, and it is no cycle but a jump of the map
ALIKE = 1e-5  # of the amplitude: cycles closer to each other are one, and oscillations that differ by less are alike
BESIDE = 1e-4  # of the amplitude: where the search begins for two that have split off from an unstable one
DOUBLINGS = 18  # of the number of oscillations that are followed along the samples
CLOSER = 256  # samples from one before to one behind, where the map jumps between two
HERE = 2e-4  # of the amplitude: what ends so near to a stable cycle goes there
STEP = 1e-3  # of the amplitude, for a slope

Oscillate = Callable[[float], Return]


class Found(NamedTuple):
    """A cycle: the amplitudes (rad, m) of its oscillations one after the other, its period (s) and its multiplier."""

    amplitudes: tuple[float, ...]
    period: float
    multiplier: float | None

    @property
    def stable(self) -> bool:
        return self.multiplier is not None and abs(self.multiplier) < 1.0


class Span(NamedTuple):
    """Swings between two amplitudes (rad, m) that lead to the cycle of that number, or else to what `verdict` says."""

    low: float
    high: float
    verdict: str
    cycle: int | None


class Sample(NamedTuple):
    """Where a swing of that amplitude turns next, and the time that takes; `trouble` where it is not regular."""

    amplitude: float
    next: float
    time: float
    trouble: str


class Survey:
    """The return map of a mechanism that is known to swing regularly at one amplitude, or nearly so."""

    def __init__(self, oscillate: Oscillate, known: float) -> None:
        self._oscillate = oscillate
        self._seen: dict[float, Sample] = {}
        self._grid(known)
        self.cycles = self._cycles()
        self._ends = self._followed()
        self.spans = self._spans()

    def _at(self, amplitude: float) -> Sample:
        if amplitude not in self._seen:
            got = self._oscillate(amplitude)
            self._seen[amplitude] = Sample(amplitude, got.amplitude, got.time, got.trouble)
        return self._seen[amplitude]

    def _grid(self, known: float) -> None:
        """Samples, and more of them where regular work ends."""
        count = int(np.log(DOWN) / np.log(RATIO))
        grid = [known * RATIO**k for k in range(-count, 1)]
        silent = 0
        while silent < BEYOND and grid[-1] < UP * known:
            silent = silent + 1 if self._at(grid[-1]).trouble else 0
            grid.append(grid[-1] * RATIO)
        samples = [self._at(one) for one in grid]
        for one, other in pairwise(samples):
            self._edge(one, other)

    def _edge(self, low: Sample, high: Sample) -> None:
        """Samples between two, by halving, until what goes wrong changes only between the last ones."""
        while low.trouble != high.trouble and high.amplitude - low.amplitude > EDGE * high.amplitude:
            between = self._at(0.5 * (low.amplitude + high.amplitude))
            low, high = (between, high) if between.trouble == low.trouble else (low, between)

    def _samples(self) -> list[Sample]:
        return [self._seen[one] for one in sorted(self._seen)]

    def _gain(self, amplitude: float, oscillations: int) -> float:
        """By how much a swing has grown after so many oscillations; not a number where one is not regular."""
        reached = amplitude
        for _ in range(oscillations):
            if not reached > 0.0:
                return np.nan
            sample = self._at(reached)
            reached = np.nan if sample.trouble else sample.next
        return reached - amplitude

    def _cycles(self) -> tuple[Found, ...]:
        found: list[Found] = []
        for oscillations in (1, 2):
            grid = [(one.amplitude, self._gain(one.amplitude, oscillations)) for one in self._samples()]
            brackets = [(low[0], high[0]) for low, high in pairwise(grid) if low[1] * high[1] < 0.0 or low[1] == 0.0]
            for low, high in list(brackets):
                if self._root(low, high, oscillations) is None:  # a jump: beside it there may be cycles all the same
                    brackets += self._within(low / RATIO, high * RATIO, oscillations)
            if oscillations == 2:
                brackets += [b for one in found if (one.multiplier or 0.0) < -1.0 for b in self._beside(one.amplitudes[0])]
            for low, high in brackets:
                amplitude = self._root(low, high, oscillations)
                if amplitude is None or any(self._is_of(one, amplitude) for one in found):
                    continue
                cycle = self._cycle(amplitude, oscillations)
                if oscillations == 1 or np.ptp(cycle.amplitudes) > ALIKE * amplitude:
                    found.append(cycle)
        return tuple(sorted(found))

    def _within(self, low: float, high: float, oscillations: int) -> list[tuple[float, float]]:
        """Between which closer samples the gain changes its sign."""
        grid = [(one, self._gain(float(one), oscillations)) for one in np.linspace(low, high, CLOSER + 1)]
        return [(float(a[0]), float(b[0])) for a, b in pairwise(grid) if a[1] * b[1] < 0.0]

    def _is_of(self, cycle: Found, amplitude: float) -> bool:
        return any(abs(one - amplitude) <= ALIKE * amplitude for one in cycle.amplitudes)

    def _beside(self, amplitude: float) -> list[tuple[float, float]]:
        """Where a pair may lie that has split off from an unstable cycle: swings grow inside of it, and shrink outside."""
        low, high = amplitude * (1.0 + BESIDE), amplitude * (1.0 + 2.0 * BESIDE)
        while high < 2.0 * amplitude:
            inner, outer = self._gain(low, 2), self._gain(high, 2)
            if inner * outer < 0.0:
                return [(low, high)]
            low, high = high, amplitude + 1.5 * (high - amplitude)
        return []

    def _root(self, low: float, high: float, oscillations: int) -> float | None:
        """Where the gain vanishes between the two; None where it jumps, or where something in between is not regular."""
        from scipy.optimize import brentq

        try:
            found = float(brentq(self._sure, low, high, args=(oscillations,), xtol=EXACT * high, rtol=1e-14))
        except (ValueError, ArithmeticError):
            return None
        return found if abs(self._gain(found, oscillations)) <= ROOT * found else None

    def _sure(self, amplitude: float, oscillations: int) -> float:
        gain = self._gain(amplitude, oscillations)
        if np.isnan(gain):
            raise ArithmeticError
        return gain

    def _cycle(self, amplitude: float, oscillations: int) -> Found:
        amplitudes, time, multiplier = [amplitude], 0.0, 1.0
        for _ in range(oscillations):
            here = self._at(amplitudes[-1])
            time += here.time / oscillations
            multiplier *= self._slope(amplitudes[-1])
            amplitudes.append(here.next)
        return Found(tuple(amplitudes[:-1]), time, None if np.isnan(multiplier) else multiplier)

    def _slope(self, amplitude: float) -> float:
        """Of the map, by central differences with two steps; not a number where it is not regular on both sides."""
        step = STEP * amplitude
        ends = [self._oscillate(amplitude + way * step) for way in (-1.0, 1.0, -0.5, 0.5)]
        low, high, nearer, near = (np.nan if one.trouble else one.amplitude for one in ends)
        return float((4.0 * (near - nearer) / step - (high - low) / (2.0 * step)) / 3.0)

    def _spans(self) -> tuple[Span, ...]:
        samples = self._samples()
        ends = [self.end_of(one.amplitude) for one in samples]
        spans: list[Span] = []
        for i, (what, cycle) in enumerate(ends):
            low = samples[0].amplitude if i == 0 else self._border(samples[i - 1], samples[i])
            high = samples[-1].amplitude if i == len(ends) - 1 else self._border(samples[i], samples[i + 1])
            if spans and spans[-1][2:] == (what, cycle):
                spans[-1] = spans[-1]._replace(high=high)
            else:
                spans.append(Span(low, high, what, cycle))
        return tuple(spans)

    def _border(self, low: Sample, high: Sample) -> float:
        """An unstable cycle between the two, else the middle."""
        for one in self.cycles:
            if not one.stable and low.amplitude <= one.amplitudes[0] <= high.amplitude:
                return one.amplitudes[0]
        return 0.5 * (low.amplitude + high.amplitude)

    def _followed(self) -> dict[float, tuple[str, int | None]]:
        """By sample: what its orbit ends with, trouble and "", or the number of a stable cycle.

        Along lines between the samples, k oscillations and k more at once; what is not regular stays where it is.
        """
        samples = self._samples()
        amplitudes = np.array([one.amplitude for one in samples])
        reached = np.array([one.amplitude if one.trouble else one.next for one in samples])
        for _ in range(DOUBLINGS):
            reached = np.interp(reached, amplitudes, reached)
        return {one.amplitude: self._end(float(end), samples) for one, end in zip(samples, reached, strict=True)}

    def _end(self, amplitude: float, samples: list[Sample]) -> tuple[str, int | None]:
        for number, one in enumerate(self.cycles):
            if one.stable and any(abs(amplitude - other) <= HERE * other for other in one.amplitudes):
                return "", number
        return _nearest(amplitude, samples).trouble or UNSETTLED, None

    def end_of(self, amplitude: float) -> tuple[str, int | None]:
        """What a swing of that size leads to: trouble and "", or the number of a stable cycle."""
        return self._ends[_nearest(amplitude, self._samples()).amplitude]


def _nearest(amplitude: float, samples: list[Sample]) -> Sample:
    """The sample next to an amplitude; the outermost one beyond them."""
    place = bisect.bisect_left([one.amplitude for one in samples], amplitude)
    around = samples[max(0, place - 1) : place + 1]
    return min(around, key=lambda one: abs(one.amplitude - amplitude))


INSIDE = 0.5  # of the smaller amplitude: where on the way in the velocity is changed
TURNS = 3  # clear turning points until one lies on the right side
LATER = 0.1  # of a period: from one turning point on to the next


class Swings:
    """One return map, from sections as they are needed; the first one is known."""

    def __init__(self, known: ReturnMap) -> None:
        self.known = known
        self._maps = [known]

    def __call__(self, amplitude: float, oscillations: int = 1) -> Return:
        """So many oscillations that begin at that amplitude (rad, m)."""
        chosen = self.map_at(amplitude)
        if chosen is None:
            return Return(np.nan, 0.0, UNSETTLED, None, np.zeros(0))
        return chosen(amplitude, oscillations)

    def state_at(self, amplitude: float) -> State | None:
        """The mechanism at a turning point of that amplitude; None where it cannot be brought there."""
        chosen = self.map_at(amplitude)
        return None if chosen is None else chosen.section.at(self.known.loop, self.known.parts, amplitude)

    def map_at(self, amplitude: float) -> ReturnMap | None:
        """The return map from a section where the parts rest as they do at that amplitude; None where there is none."""
        loop, parts = self.known.loop, self.known.parts
        nearest = sorted(self._maps, key=lambda one: abs(math.log(one.section.amplitude / amplitude)))
        for one in nearest:
            if one.section.at(loop, parts, amplitude) is not None:
                return one
        section = self._brought(nearest[0].section, amplitude)
        if section is None or section.at(loop, parts, amplitude) is None:
            return None
        self._maps.append(ReturnMap(loop, parts, section))
        return self._maps[-1]

    def _brought(self, section: Section, amplitude: float) -> Section | None:
        """A section near that amplitude, on the same side; None where the mechanism does not come to one."""
        loop, parts = self.known.loop, self.known.parts
        state, i, omega = section.at(loop, parts, section.amplitude), parts.coordinate, math.tau / parts.period
        if state is None:
            return None
        inside = INSIDE * min(1.0, amplitude / section.amplitude)
        try:
            loop.on(state, math.acos(inside) / omega, exactly=True)
            away = float(state.q[i]) - parts.level
            if abs(away) >= amplitude:
                return None
            state.u[i] = -section.side * omega * math.sqrt(amplitude**2 - away**2)
            state.instant.event_waits, state.instant.touched = 1, NO_CONTACT
            for _ in range(TURNS):
                found = first_section(loop, parts, state)
                if isinstance(found, NoSection) or found.side == section.side:
                    return None if isinstance(found, NoSection) else found
                state = found.state
                loop.on(state, LATER * parts.period, exactly=True)
        except SolverGaveUp:
            pass
        return None


FOLLOWED = 24  # periods: how long a swing that is not regular is watched


def with_all_cycles(cycle: Cycle, survey: Survey, swings: Swings) -> Cycle:
    """The cycle with all that the survey found."""
    ranges: list[Range] = []
    for span in survey.spans:
        found = _range(swings, survey, span)
        if found is None:
            continue
        if ranges and (ranges[-1].verdict, ranges[-1].cycle) == (found.verdict, found.cycle):
            ranges[-1] = dataclasses.replace(ranges[-1], to_deg=found.to_deg)
        else:
            ranges.append(found)
    return dataclasses.replace(cycle, cycles=tuple(_orbit(swings, found) for found in survey.cycles), starts=tuple(ranges))


def _orbit(swings: Swings, found: Found) -> Orbit:
    """Its amplitudes are half the ways between turning points, as those of a run."""
    parts = swings.known.parts
    got = swings(found.amplitudes[0], len(found.amplitudes))
    start = parts.level + swings.known.section.side * found.amplitudes[0]
    each = found.amplitudes if got.trouble else measures(got.events, parts, start, got.time).each
    rate = DAY * (parts.nominal / found.period - 1.0)
    return Orbit(tuple(math.degrees(one) for one in each), found.period, rate, found.multiplier, found.stable)


def _range(swings: Swings, survey: Survey, span: Span) -> Range | None:
    """What becomes of a swing from the middle of the span; None where the parts cannot stand so."""
    ends = int(swings.known.section.side), math.degrees(span.low), math.degrees(span.high)
    if span.cycle is not None:
        return Range(*ends, TICKS if swings.known.parts.wheel >= 0 else UNSETTLED, span.cycle)
    loop, parts = swings.known.loop, swings.known.parts
    state = swings.state_at(0.5 * (span.low + span.high))
    if state is None:
        return None
    run = run_from(loop, state, FOLLOWED * parts.period)
    name = judged(run).name
    if name not in (TICKS, UNSETTLED, None):
        return Range(*ends, name or UNSETTLED, None)
    reached = beats(run).amplitude_deg
    cycle = survey.end_of(math.radians(float(reached[-1])))[1] if len(reached) else None
    verdict = TICKS if cycle is not None else (span.verdict if span.verdict == STOPS else UNSETTLED)
    return Range(*ends, verdict, cycle)
