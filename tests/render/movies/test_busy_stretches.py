"""Where does a movie slow down?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.render.movie import _merged, busy
from watchsim.simulation.state import EVENT_DTYPE, EventKind


def phases(*spans: tuple[str, float, float]) -> Any:
    return [SimpleNamespace(name=name, start=start, end=end) for name, start, end in spans]


def test_a_tenth_of_the_longest_before_and_after_what_happens() -> None:
    """Longest 1 s: what lies less than that apart is one; what is locked or outside the window is not looked at."""
    found = phases(
        *(("drop", -5.0, 2.0), ("impulse", 4.0, 5.0), ("locked", 5.0, 7.0), ("drop", 6.1, 6.3), ("impulse", 9.0, 9.5)),
        *(("locked", 9.5, 11.0), ("impulse", 12.0, 19.0)),
    )
    run: Any = SimpleNamespace()
    assert busy(run, found, (2.0, 12.0)) == [pytest.approx((3.9, 6.4)), pytest.approx((8.9, 9.6))]


def test_around_events_where_no_phases_are_known() -> None:
    kinds = (EventKind.IMPACT, EventKind.TURN, EventKind.CLOSE, EventKind.OPEN, EventKind.IMPACT)
    times = (2.0, 3.0, 5.0, 5.01, 30.0)
    events = np.zeros(5, EVENT_DTYPE)
    events["t"], events["kind"] = times, kinds
    run: Any = SimpleNamespace(events=events)
    assert busy(run, [], (0.0, 10.0)) == [pytest.approx((1.96, 2.04)), pytest.approx((4.96, 5.05))]
    assert busy(run, [], (6.0, 10.0)) == []


def test_spans_are_united_and_cut_to_the_window() -> None:
    spans = np.array([(5.0, 6.0), (-1.0, 1.0), (0.0, 0.5), (6.5, 7.0), (7.6, 20.0)])
    assert list(_merged(spans, 0.5, (0.0, 9.0))) == [(0.0, 1.0), (5.0, 7.0), (7.6, 9.0)]
    assert list(_merged(spans[:0], 0.5, (0.0, 9.0))) == []
