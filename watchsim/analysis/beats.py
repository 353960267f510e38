"""How far does the oscillator swing, how fast, and how evenly?

A half swing goes from one turning point through the rest position to the next. Everything follows from the times and values of
turning points and passages, which are events of the run: found to rounding, whatever rows were recorded.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.recorded import nominal_period
from watchsim.analysis.ticks import ticks
from watchsim.analysis.touches import Events
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.trajectory import Array, Trajectory

Indices = NDArray[np.int64]

DAY = 86400.0
FEWEST_TURNS = 3
HEARD = 0.8  # share of the half swings that must have a tick, for the ticks to be what the beat error is measured by


@dataclass(frozen=True)
class Beats:
    """One entry per half swing, in order of time; lengths n, SI units, nan where a value needs half swings before the first.

    t           passage through the rest position, s
    start, end  the turning points before and after it, s
    start_at, end_at  the coordinate there, rad (m where `angular` is False)
    tick        first noise, s: the impulse pin meets the fork; nan where nothing was heard
    period_s    from the passage two half swings ago to this one, s
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
        """Seconds gained per day against the spring's undamped frequency."""
        return DAY * (self.nominal_period / self.period_s - 1.0)

    @property
    def half_period_s(self) -> Array:
        """From the beat before to this one: from tick to tick where ticks are heard, else from passage to passage."""
        mark = self.tick if len(self) and np.isfinite(self.tick).mean() >= HEARD else self.t
        return np.diff(mark, prepend=np.nan)

    @property
    def beat_error_ms(self) -> Array:
        """|T1 - T2|/2 of the two half periods that end with this beat, ms."""
        return 500.0 * np.abs(np.diff(self.half_period_s, prepend=np.nan))


def beats(run: Trajectory, body: str | None = None) -> Beats:
    """The half swings of the first sprung body, or of the one named; empty with fewer than three turning points.

    ValueError where no spring acts on the body, KeyError where there is no such body.
    """
    name = _sprung(run, body)
    period, angular = nominal_period(run, name), run.scene.body(name).motion == "pivot"
    index = [one.name for one in run.scene.bodies].index(name)
    own = run.events[run.events["body"] == index]
    crossings, turns = own[own["kind"] == EventKind.CROSS], own[own["kind"] == EventKind.TURN]
    complete, before, after = _half_swings(crossings, turns)
    t, start, end = crossings["t"], turns["t"][before], turns["t"][after]
    periods = t - np.concatenate([np.full(2, np.nan), t])[: len(t)]
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
        period_s=periods[complete],
    )


def _sprung(run: Trajectory, body: str | None) -> str:
    if body is not None:
        return run.scene.body(body).name
    if not run.scene.springs:
        raise ValueError("no body of this scene has a spring, so nothing beats")
    return run.scene.springs[0].body


def _half_swings(crossings: Events, turns: Events) -> tuple[Indices, Indices, Indices]:
    """Rows of the passages that have a turning point on both sides, and the rows of these turning points.

    An oscillator that knocks turns more than once between two passages: of these turning points the outermost counts.
    """
    nothing = np.zeros(0, np.int64)
    if len(turns) < FEWEST_TURNS or len(crossings) == 0:
        return nothing, nothing, nothing
    heading = np.sign(crossings["value"])
    side = np.concatenate([-heading[:1], heading])  # on which side of the rest position it is before the first passage, ...
    interval = np.searchsorted(crossings["t"], turns["t"], side="right")
    outermost = np.full(len(side), -1)
    reach = side[interval] * turns["value"]
    for i, k in enumerate(interval):
        if outermost[k] < 0 or reach[i] > reach[outermost[k]]:
            outermost[k] = i
    complete = np.flatnonzero((outermost[:-1] >= 0) & (outermost[1:] >= 0))
    return complete, outermost[complete], outermost[complete + 1]
