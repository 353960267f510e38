"""Do slices grow and shrink towards a tenth of a second on the clock?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from watchsim.simulation import slice_pace
from watchsim.simulation.slice_pace import FEWEST_STEPS, MOST_STEPS, Pace


def slice_of(monkeypatch: pytest.MonkeyPatch, pace: Pace, wall: float, simulated: float, left: float, now: float = 5.0) -> Any:
    """A slice that took so long on the clock (s), with so many of its steps left."""
    until = SimpleNamespace(slice_end=math.nan, steps=math.nan)
    monkeypatch.setattr(slice_pace.time, "perf_counter", iter((100.0, 100.0 + wall)).__next__)
    pace.begin(now, until, math.inf)
    until.steps = left
    pace.end(now + simulated, until)
    return until


def test_where_a_slice_ends() -> None:
    """After a hundred thousandth of the run at first, but not beyond the run or the next look."""
    for now, look, end in ((5.0, math.inf, 5.001), (5.0, 5.0004, 5.0004), (99.9995, math.inf, 100.0)):
        pace, until = Pace(100.0), SimpleNamespace()
        pace.begin(now, until, look)
        assert until.slice_end == pytest.approx(end, abs=1e-12) and until.steps == FEWEST_STEPS


@pytest.mark.parametrize(
    ("wall", "simulated", "left", "length", "steps"),
    [
        (0.05, 4e-4, 4.0, 8e-4, 24.0),  # twice as long
        (0.2, 4e-4, 4.0, 2e-4, 6.0),  # half as long
        (0.001, 1e-3, 1.0, 1e-2, 32.0),  # ten times and twice at most
        (0.0, 1e-3, 1.0, 1e-2, 32.0),  # quicker than the clock can tell
        (1000.0, 1e-4, 1.0, 1e-7, 1.0),  # never nothing
        (0.05, 4e-4, 0.0, 1e-3, 32.0),  # ended by its steps: says nothing about the time
    ],
)
def test_the_next_slice(
    monkeypatch: pytest.MonkeyPatch, wall: float, simulated: float, left: float, length: float, steps: float
) -> None:
    pace = Pace(100.0)
    slice_of(monkeypatch, pace, wall, simulated, left)
    assert (pace.length, pace.steps) == pytest.approx((length, steps), rel=1e-6, abs=0.0)


def test_steps_have_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    pace = Pace(100.0)
    for _ in range(12):
        slice_of(monkeypatch, pace, 1e-3, 1e-3, 0.0)
    assert pace.steps == MOST_STEPS
