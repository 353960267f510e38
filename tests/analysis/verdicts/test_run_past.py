"""How far must a wheel run ahead before it has tripped?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timing.escape_wheel import Advance
from watchsim.analysis.verdicts import tripping
from watchsim.simulation.event_kinds import EVENT_DTYPE


@pytest.mark.parametrize(
    ("angles", "times", "start"),
    [
        ((0, 1, 2, 3, 4), 0, None),
        ((0, 2, 3, 4, 5), 0, None),  # the wheel may start on either side of a half swing
        ((0, 3, 4, 5, 6), 1, 0.0),  # two half pitches too many in the first
        ((0, 1, 2, 4, 5), 1, 0.25),
        ((0, 0, 2, 3, 4), 0, None),  # a step caught up
        ((0, 1, 3, 5, 6), 2, 0.125),
    ],
)
@pytest.mark.parametrize("before", [0, 7])
def test_half_pitches_that_no_half_swing_let_go(
    monkeypatch: pytest.MonkeyPatch, angles: tuple[int, ...], times: int, start: float | None, before: int
) -> None:
    """`before`: half swings of the run of which nothing was kept. `start` of the first half swing that was too many, s."""
    half_swings = before + np.arange(len(angles), dtype=float)
    monkeypatch.setattr(tripping, "advance", lambda *_: Advance(0.2, half_swings, 0.2 * np.array(angles)))
    ends = 0.125 * np.arange(1.0, len(angles))
    found = SimpleNamespace(end=ends, start=ends - 0.125, before=before)
    watch: Any = SimpleNamespace(
        **{"run": None, "wheel": "wheel", "lever": "lever", "oscillator": "balance", "found": found, "pitch": 0.4},
        events=lambda *_: np.zeros(0, EVENT_DTYPE),
        drive=lambda _: 1e-6,
    )
    verdict = tripping._run_past(watch)
    assert (verdict.count if verdict else 0) == times
    assert (verdict.t if verdict else None) == start
