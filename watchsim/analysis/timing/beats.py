"""How far does the oscillator swing, how fast, and how evenly?

A half swing goes from one turning point through the rest position to the next. Everything follows from the times and values of
turning points and passages, which are events of the run: found to rounding, whatever rows were recorded.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from watchsim.analysis.timing.rows_at_hand import nominal_period
from watchsim.analysis.timing.ticks import ticks
from watchsim.displays import notebook_html
from watchsim.scene.recording import STATISTICS
from watchsim.scene.roles import roles
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.half_swings import half_swings, since_two_before, unevenness
from watchsim.simulation.record.trajectory import Array, Trajectory
from watchsim.storage.columns import rows_where

DAY = 86400.0
HEARD = 0.8  # share of the half swings that must have a tick, for the ticks to be what the beat error is measured by
STILL = 1e-13  # rad or m: half swings no larger are rounding, of a body at rest


@dataclass(frozen=True)
class Beats:
    """One entry per half swing, in order of time; lengths n, SI units, nan where a value needs half swings before the first.

    t           passage through the rest position, s
    start, end  the turning points before and after it, s
    start_at, end_at  the coordinate there, rad (m where `angular` is False)
    tick        first noise, s: the impulse pin meets the fork; nan where nothing was heard
    period_s    from the passage two half swings ago to this one, s
    before      half swings of the run before the first one here, where not all events were kept
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
        return self.tick if len(self) and np.isfinite(self.tick).mean() >= HEARD else self.t

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
    since = _unbroken_since(run)
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
    )


def beats_within(found: Beats, window: Sequence[float]) -> Beats:
    """The half swings in a window (s), and one before and after it."""
    first, last = np.searchsorted(found.end, window[0]), np.searchsorted(found.start, window[1])
    own = slice(max(int(first) - 1, 0), int(last) + 1)
    columns = ((field.name, getattr(found, field.name)) for field in fields(found))
    cut: dict[str, Any] = {name: values[own] for name, values in columns if isinstance(values, np.ndarray)}
    return replace(found, before=found.before + own.start, **cut)


def _unbroken_since(run: Trajectory) -> float:
    """From when on (s) all events are there: where a recording has gaps, from the last of them."""
    return run.spans[-1][0] if run.keep == STATISTICS and run.spans else -math.inf


def _swinging(run: Trajectory, body: str | None) -> str:
    if body is not None:
        return run.scene.body(body).name
    found = roles(run.scene).oscillator
    if found is None:
        raise ValueError("no body of this scene swings on a spring or by gravity, so nothing beats")
    return found
