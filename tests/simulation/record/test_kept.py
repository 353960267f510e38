"""Is what nobody asked for forgotten, and nothing else?"""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.scene.recording import Recording
from watchsim.simulation.event_kinds import EVENT_DTYPE
from watchsim.simulation.record.row_selection import Kept

TAIL = 1.95  # s


def flushes(kept: Kept, until: int) -> None:
    """A row and an event each tenth of a second, flushed each second."""
    for second in range(until):
        rows, events = np.zeros((10, 4)), np.zeros(10, EVENT_DTYPE)
        rows[:, 0] = events["t"] = second + np.arange(10) / 10.0
        kept.flush(rows, events)


@pytest.mark.parametrize(
    ("recording", "starts"),
    [(Recording(keep="statistics"), []), (Recording(keep="events"), []), (Recording(windows=((4.95, 7.55),)), [4.95])],
    ids=["statistics", "events", "window"],
)
def test_what_stays_of_a_long_run(recording: Recording, starts: list[float]) -> None:
    kept = Kept(recording, TAIL)
    flushes(kept, 1000)
    assert kept.parts == 1000
    closed = kept.closed(999.9)
    assert closed is not None
    (times, *_), events = closed
    wanted = [t for t in np.arange(10000) / 10.0 if any(s - 0.1 < t < s + 2.7 for s in starts)]
    if recording.has_tail:
        wanted += [t for t in np.arange(10000) / 10.0 if t > 999.9 - TAIL - 0.1]
    assert times == pytest.approx(wanted)
    if recording.keep == "statistics":
        assert events["t"].min() >= 999.9 - TAIL - 1e-9
        assert len(kept._rows) < 10
    if recording.keep == "events":
        assert len(events) == 10000
