"""How far does the oscillator swing, how fast, and how evenly?

A half swing goes from one turning point through the rest position to the next. Everything follows from the times and values of
turning points and passages, which are events of the run: found to rounding, whatever rows were recorded.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.displays import notebook_html
from watchsim.scene.roles import nominal_frequency, oscillator, oscillators, roles
from watchsim.scene.scene import STATISTICS
from watchsim.simulation.recording import (
    LONGEST_STEP,
    STILL,
    USUAL_PERIODS,
    USUAL_WINDOW,
    Pair,
    first_noises,
    half_swings,
    since_two_before,
    unevenness,
)
from watchsim.simulation.state import EventKind
from watchsim.simulation.tally import sums_of
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.storage.columns import blocks, let_go, rows_where

# A scene may record a few windows of a long run only; interpolating across what was left out would invent numbers.

AT_ONCE = 4096  # times that are looked up together


def nominal_period(run: Trajectory, body: str) -> float:
    """Period (s) that a rate is measured against: of the oscillator its nominal one, of other bodies that of small swings.

    ValueError where nothing pulls the body back.
    """
    scene = run.scene
    found = oscillators(scene)
    if found and found[0].body == body:
        hertz = nominal_frequency(scene)
    else:
        one = oscillator(scene.bodies, scene.springs, scene.gravity, body)
        hertz = one.hertz if one else None
    if not hertz:
        raise ValueError(f'neither a spring nor gravity pulls "{body}" back, so it has no period')
    return 1.0 / hertz


def is_recorded(run: Trajectory, times: Array) -> NDArray[np.bool_]:
    """For each time (s), whether rows close enough on both sides of it were kept."""
    if len(run.t) == 0:
        return np.zeros(len(times), bool)
    longest = math.inf
    frequencies = [one.hertz for one in oscillators(run.scene) if one.hertz]
    if frequencies:
        longest = LONGEST_STEP / max(frequencies)
    found = [_between_rows(run.t, part, longest) for (part,) in blocks(times, length=AT_ONCE)]
    return np.concatenate(found) if found else np.zeros(0, bool)


def _between_rows(t: Array, times: Array, longest: float) -> NDArray[np.bool_]:
    after = np.minimum(np.searchsorted(t, times, side="left"), len(t) - 1)
    before = np.maximum(np.searchsorted(t, times, side="right") - 1, 0)
    found: NDArray[np.bool_] = (times >= t[0]) & (times <= t[-1]) & (t[after] - t[before] <= longest)
    let_go(t)
    return found


Events = NDArray[Any]
Column = NDArray[Any]
Bits = NDArray[np.bool_]


def contact_events(run: Trajectory, wanted: Callable[[Pair], bool], *kinds: EventKind) -> Events:
    """The rows of the event table that concern the wanted pairs of primitives, of those kinds (all if none are named)."""
    found = [part[_concerned(run, part, wanted, kinds)] for (part,) in blocks(run.events)]
    return np.concatenate(found) if found else run.events


def contact_numbers(run: Trajectory, wanted: Callable[[Pair], bool]) -> set[int]:
    """The wanted contacts that ever had an event."""
    numbers = (part["contact"][_concerned(run, part, wanted, ())] for (part,) in blocks(run.events))
    return {number for part in numbers for number in np.unique(part).tolist()}


def contact_columns(run: Trajectory, wanted: Callable[[Pair], bool], names: list[str], *kinds: EventKind) -> list[Column]:
    """Only these columns of the same rows: of a long run there are millions."""
    found: list[list[Column]] = [[] for _ in names]
    for (part,) in blocks(run.events):
        own = _concerned(run, part, wanted, kinds)
        for column, name in zip(found, names, strict=True):
            column.append(part[name][own])
    return [np.concatenate(column or [run.events[name]]) for column, name in zip(found, names, strict=True)]


def _concerned(run: Trajectory, events: Events, wanted: Callable[[Pair], bool], kinds: tuple[EventKind, ...]) -> Bits:
    # Events without a contact have the number -1, that of the last place.
    is_wanted = np.zeros(len(run.pairs) + 1, bool)
    for contact in np.flatnonzero(np.bincount(events["contact"] + 1)).tolist():
        is_wanted[contact - 1] = contact > 0 and wanted(run.pairs[contact - 1])
    mask: Bits = is_wanted[events["contact"]]
    if kinds:
        of_kind = np.zeros(max(EventKind) + 1, bool)
        of_kind[list(kinds)] = True
        mask &= of_kind[events["kind"]]
    return mask


def involves(*names: str) -> Callable[[Pair], bool]:
    """Pairs with any of those bodies on either side."""
    return lambda pair: pair.body_a in names or pair.body_b in names


def between(first: str, others: set[str]) -> Callable[[Pair], bool]:
    """Pairs of body `first` with one of the others."""
    return lambda pair: (pair.body_a == first and pair.body_b in others) or (pair.body_b == first and pair.body_a in others)


def held(times: Column, kinds: Column, spans: Sequence[tuple[float, float]] = ()) -> NDArray[np.int32]:
    """How many contacts hold after each of the events of these kinds, of one body that is free at some time.

    A stretch that was recorded (`spans`, s) may begin while contacts hold, whose closing is no event of it: the count is
    then below zero where none holds.
    """
    change = (kinds == EventKind.CLOSE).astype(np.int8) - (kinds == EventKind.OPEN)
    begins = np.searchsorted(times, [start for start, _ in spans[1:]])
    counts = [np.cumsum(own, dtype=np.int32) for own in np.split(change, begins)]
    return np.concatenate([own - own.min(initial=0) for own in counts], dtype=np.int32)


def holding_at_end(run: Trajectory) -> list[Pair]:
    """The pairs whose contact is in force when the run ends."""
    return [run.pairs[contact] for contact in sums_of(run)["holding"]]


# The first noise of a beat is the impulse pin meeting the fork. Rate and beat error are taken from it by every timegrapher,
# since it comes before anything that depends on the escapement's own play.


def ticks(run: Trajectory, oscillator: str, starts: Array, ends: Array, half_period: float) -> Array:
    """For each half swing from `starts` to `ends` (s), the time of the oscillator's first impact after a silence; else nan."""
    (noises,) = contact_columns(run, involves(oscillator), ["t"], EventKind.IMPACT)
    return first_noises(noises, starts, ends, half_period)


DAY = 86400.0
HEARD = 0.8  # share of the half swings that must have a tick, for the ticks to be what the beat error is measured by


@dataclass(frozen=True)
class Beats:
    """One entry per half swing, in order of time; lengths n, SI units, nan where a value needs half swings before the first.

    t           passage through the rest position, s
    start, end  the turning points before and after it, s
    start_at, end_at  the coordinate there, rad (m where `angular` is False)
    tick        first noise, s: the impulse pin meets the fork; nan where nothing was heard
    period_s    from the passage two half swings ago to this one, s
    before      half swings of the run before the first one here, where not all events were kept
    heard       whether so many of the run have a tick that the beat error is measured by them; None: judged by those here
    """

    body: str
    angular: bool
    nominal_period: float
    t: Array
    start: Array
    end: Array
    start_at: Array
    end_at: Array
    tick: Array
    period_s: Array
    before: int = 0
    heard: bool | None = None

    def __repr__(self) -> str:
        count = f"{len(self)} half {'swing' if len(self) == 1 else 'swings'}"
        if not len(self):
            return f"<Beats of {self.body!r}: {count}>"
        swing = f"{self.amplitude_deg[-1]:.2f}°" if self.angular else f"{1e3 * self.amplitude[-1]:.4g} mm"
        last = f"the last one {swing}, {self.rate_s_per_d[-1]:.2f} s/d, beat error {self.beat_error_ms[-1]:.2g} ms"
        return f"<Beats of {self.body!r}: {count} from {self.start[0]:.6g} s to {self.end[-1]:.6g} s; {last}>"

    def _repr_html_(self) -> str:
        return notebook_html(self)

    def __len__(self) -> int:
        return len(self.t)

    @property
    def amplitude(self) -> Array:
        """Half the way between the two turning points, rad or m."""
        return 0.5 * np.abs(self.end_at - self.start_at)

    @property
    def amplitude_deg(self) -> Array:
        """Amplitude in degrees; nan for a body that slides."""
        return np.degrees(self.amplitude) if self.angular else np.full(len(self), np.nan)

    @property
    def rate_s_per_d(self) -> Array:
        """Seconds gained per day against the nominal frequency."""
        return DAY * (self.nominal_period / self.period_s - 1.0)

    @property
    def mark(self) -> Array:
        """What the beat error is measured by, s: the ticks where they are heard, else the passages."""
        heard = bool(len(self) and np.isfinite(self.tick).mean() >= HEARD) if self.heard is None else self.heard
        return self.tick if heard else self.t

    @property
    def half_period_s(self) -> Array:
        """From the beat before to this one, mark to mark."""
        return np.diff(self.mark, prepend=np.nan)

    @property
    def beat_error_ms(self) -> Array:
        """|T1 - T2|/2 of the two half periods that end with this beat, ms."""
        return 500.0 * np.abs(unevenness(self.mark))


def beats(run: Trajectory, body: str | None = None) -> Beats:
    """The half swings of the oscillator, or of the body named; empty with fewer than three turning points.

    ValueError where neither a spring nor gravity pulls the body back, KeyError where there is no such body.
    """
    name = _swinging(run, body)
    period, angular = nominal_period(run, name), run.scene.body(name).motion == "pivot"
    index = [one.name for one in run.scene.bodies].index(name)
    # From when on (s) all events are there: where a recording has gaps, from the last of them.
    since = run.spans[-1][0] if run.keep == STATISTICS and run.spans else -math.inf
    own = rows_where(run.events, lambda part: (part["body"] == index) & (part["t"] >= since))
    crossings, turns = own[own["kind"] == EventKind.CROSS], own[own["kind"] == EventKind.TURN]
    complete, before, after = half_swings(crossings, turns)
    is_swing = np.abs(turns["value"][after] - turns["value"][before]) > 2.0 * STILL
    complete, before, after = complete[is_swing], before[is_swing], after[is_swing]
    t, start, end = crossings["t"], turns["t"][before], turns["t"][after]
    counted = run.sums.get("half_swings", len(complete)) if run.keep == STATISTICS and body is None else len(complete)
    return Beats(
        name,
        angular,
        period,
        t=t[complete],
        start=start,
        end=end,
        start_at=turns["value"][before],
        end_at=turns["value"][after],
        tick=ticks(run, name, start, end, 0.5 * period),
        period_s=since_two_before(t)[complete],
        before=max(0, counted - len(complete)),
        heard=_heard(run.sums) if run.keep == STATISTICS and body is None else None,
    )


def _heard(sums: Mapping[str, Any]) -> bool | None:
    """Have so many half swings of the whole run a tick? None where that was not counted."""
    return bool(sums["half_swings"] and sums["ticks"] >= HEARD * sums["half_swings"]) if "ticks" in sums else None


def beats_within(found: Beats, window: Sequence[float]) -> Beats:
    """The half swings in a window (s), and one before and after it."""
    first, last = np.searchsorted(found.end, window[0]), np.searchsorted(found.start, window[1])
    own = slice(max(int(first) - 1, 0), int(last) + 1)
    columns = ((field.name, getattr(found, field.name)) for field in fields(found))
    cut: dict[str, Any] = {name: values[own] for name, values in columns if isinstance(values, np.ndarray)}
    return replace(found, before=found.before + own.start, **cut)


def with_the_last(run: Trajectory, found: Beats) -> Beats:
    """The half swings and the one that the end of the run cuts short, whose noises and phases are there all the same."""
    start, end = found.end[-1:], run.t[-1:]
    if not len(found) or not end[0] > start[0]:
        return found
    tick = ticks(run, found.body, start, end, 0.5 * found.nominal_period)
    last = {"start": start, "end": end, "start_at": found.end_at[-1:], "tick": tick}
    names = [field.name for field in fields(found) if isinstance(getattr(found, field.name), np.ndarray)]
    longer: dict[str, Any] = {name: np.append(getattr(found, name), last.get(name, math.nan)) for name in names}
    return replace(found, **longer)


def _swinging(run: Trajectory, body: str | None) -> str:
    if body is not None:
        return run.scene.body(body).name
    found = roles(run.scene).oscillator
    if found is None:
        raise ValueError("no body of this scene swings on a spring or by gravity, so nothing beats")
    return found


# Every error is the standard error of the mean from beat to beat (both directions of swing taken together, as they differ in
# a steady watch too) joined with the drift from the first to the last half of the window: a watch that has not settled says
# so.

Window = tuple[float, float]

FEWEST_PERIODS = 3
RECENT = 3.0  # periods before the window: so far back the half periods reach that are compared in it


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


def mean_over(run: Trajectory, window: Window | None = None) -> Averages:
    """Averages over `window` (s, s; default the last one) for the first sprung body."""
    found = beats(run)
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
    # Of an oscillator that was held for long, what was before is not kept by every recording.
    recent = since_two_before(found.t) <= found.t - start + RECENT * found.nominal_period
    uneven, uneven_error = mean_and_error(_unevenness(found)[inside & recent])
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


# From sums made as the run went, so that nothing of it need have been kept.

Moments = Mapping[str, float]


def whole_run(run: Trajectory, found: Beats) -> dict[str, Any] | None:
    """`beats`; `amplitude_deg` and `period_s`, each {mean, spread, least, largest}, spread being the standard deviation;
    `rate_s_per_d` of the mean period; `beat_error_ms` of the mean difference. Null where unknown; None without beats.
    """
    sums = run.sums
    if not sums.get("half_swings"):
        return None
    period = sums["period"]
    uneven = sums["uneven_ticks" if _heard(sums) else "uneven_passages"]
    return {
        "beats": sums["half_swings"],
        "amplitude_deg": _scaled(sums["amplitude"], math.degrees(1.0)) if found.angular else None,
        "period_s": _scaled(period, 1.0),
        "rate_s_per_d": DAY * (found.nominal_period / period["mean"] - 1.0) if period else None,
        "beat_error_ms": 500.0 * abs(uneven["mean"]) if uneven else None,
    }


def _scaled(moments: Moments | None, factor: float) -> dict[str, float] | None:
    if moments is None:
        return None
    spread = math.sqrt(moments["squares"] / max(moments["number"] - 1.0, 1.0))
    values = {"mean": moments["mean"], "spread": spread, "least": moments["least"], "largest": moments["largest"]}
    return {name: factor * value for name, value in values.items()}
