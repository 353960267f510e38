"""Is what is kept of a run, flush by flush, what one would choose who had all of it before him?"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from watchsim.scene.recording import Recording
from watchsim.simulation.event_kinds import EVENT_DTYPE
from watchsim.simulation.record.row_selection import Kept, tail_length

WINDOWS = ((4.0, 6.5), (6.2, 8.0), (11.3, 11.4), (19.0, 30.0))
RECORDINGS = {
    "windows": Recording(WINDOWS),
    "every third": Recording(stride=3),
    "every second in windows": Recording(WINDOWS, stride=2),
    "statistics": Recording(keep="statistics"),
    "statistics and windows": Recording(WINDOWS, "statistics"),
    "events": Recording(keep="events"),
    "events and windows, every second": Recording(WINDOWS, "events", 2),
}


def rows_by_hand(times: np.ndarray, recording: Recording, since: float) -> list[float]:
    """Every so many-th row within a window, the rows on both sides of a window, and of the tail all with the row before it."""
    windows, chosen, met = recording.row_windows, set(), 0
    inside = [any(a <= t <= b for a, b in windows) for t in times]
    for i, t in enumerate(times):
        if inside[i]:
            chosen |= {i} if met % recording.stride == 0 else set()
            met += 1
        beside = [(times[k], times[k + 1]) for k in (i - 1, i) if 0 <= k < len(times) - 1]
        if not inside[i] and any(one < b and other > a for one, other in beside for a, b in windows):
            chosen.add(i)
        if t >= since:
            chosen |= {i, i - 1} if i and times[i - 1] < since < t else {i}
    return [float(times[i]) for i in sorted(chosen)]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("name", RECORDINGS)
def test_any_flushes(name: str, seed: int) -> None:
    """Rows on the borders of windows, empty flushes, and a run that ends within the tail."""
    recording, rng = RECORDINGS[name], np.random.default_rng(seed)
    times = np.unique(rng.integers(0, 240, rng.integers(3, 120))) / 10.0
    events = np.zeros(60, EVENT_DTYPE)
    events["t"] = np.sort(rng.uniform(0.0, times[-1], 60))
    kept, tail, end = Kept(recording, 1.7), 1.7, float(times[-1])
    borders = [0.0, *np.sort(rng.uniform(0.0, end, 5)), end + 1.0]
    for low, high in pairwise(borders):
        rows = np.zeros((int(((times >= low) & (times < high)).sum()), 4))
        rows[:, 0] = times[(times >= low) & (times < high)]
        kept.flush(rows, events[(events["t"] >= low) & (events["t"] < high)])
    since = end - tail if recording.has_tail else np.inf
    closed = kept.closed(end)
    assert closed is not None
    (found, *_), left = closed
    assert found.tolist() == rows_by_hand(times, recording, since)
    if recording.keep == "statistics":
        own = [t for t in events["t"] if t >= since or any(a <= t <= b for a, b in recording.windows)]
        assert left["t"].tolist() == own
    else:
        assert left["t"].tolist() == events["t"].tolist()


@pytest.mark.parametrize(
    ("end", "expected"),
    [(0.5, ((0.0, 0.5),)), (6.0, ((0.0, 2.0), (4.0, 6.0))), (3.0, ((0.0, 3.0),)), (10.0, ((0.0, 2.0), (4.0, 10.0)))],
)
def test_stretches_that_are_kept(end: float, expected: tuple[tuple[float, float], ...]) -> None:
    """From the start to the end of the run at most; what overlaps is one."""
    kept = Kept(Recording(((0.5, 2.0), (-1.0, 1.0), (4.0, 9.0)), "statistics"), 1.7)
    assert np.array(kept.spans(end)) == pytest.approx(np.array(expected))


def test_stretches_of_a_run_shorter_than_its_tail() -> None:
    """All of it, and nothing before it."""
    assert Kept(Recording(keep="statistics"), 1.7).spans(0.5) == ((0.0, 0.5),)


def test_a_stretch_joins_the_one_just_before_it() -> None:
    kept = Kept(Recording(((0.0, 1.0), (3.0, 5.0), (4.0, 6.0))), 1.7)
    assert kept.spans(9.0) == ((0.0, 1.0), (3.0, 6.0))


@pytest.mark.parametrize(("hertz", "seconds"), [(None, 2.0), (8.0, 2.5), (4.0, 3.0), (1.0, 12.0)])
def test_length_of_the_tail(hertz: float | None, seconds: float) -> None:
    """Two seconds or eight periods, whichever is longer, and four periods more."""
    assert tail_length(hertz) == seconds


LONG_TAIL = 1.95  # s


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
    kept = Kept(recording, LONG_TAIL)
    flushes(kept, 1000)
    assert kept.parts == 1000
    closed = kept.closed(999.9)
    assert closed is not None
    (times, *_), events = closed
    wanted = [t for t in np.arange(10000) / 10.0 if any(s - 0.1 < t < s + 2.7 for s in starts)]
    if recording.has_tail:
        wanted += [t for t in np.arange(10000) / 10.0 if t > 999.9 - LONG_TAIL - 0.1]
    assert times == pytest.approx(wanted)
    if recording.keep == "statistics":
        assert events["t"].min() >= 999.9 - LONG_TAIL - 1e-9
        assert len(kept._rows) < 10
    if recording.keep == "events":
        assert len(events) == 10000
