"""When is a part of a run settled, what stays of it for good, and does a run in pieces keep what a whole one does?"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from watchsim.scene.recording import Recording
from watchsim.simulation.event_kinds import EVENT_DTYPE
from watchsim.simulation.record.row_selection import Kept, stretch_rows

TAIL = 1.7
WINDOWS = ((4.0, 6.5), (6.2, 8.0), (11.3, 11.4), (19.0, 30.0))
RECORDINGS = {
    "all": Recording(),
    "every third": Recording(stride=3),
    "windows": Recording(WINDOWS),
    "every second in windows": Recording(WINDOWS, stride=2),
    "statistics": Recording(keep="statistics"),
    "statistics and windows": Recording(WINDOWS, "statistics"),
    "events and windows, every second": Recording(WINDOWS, "events", 2),
}
Part = tuple[np.ndarray, np.ndarray]


def parts_of_a_run(rng: np.random.Generator) -> list[Part]:
    """Rows (time, q, u, a) and events as they are flushed, some parts without rows, some without events."""
    times = np.unique(rng.integers(0, 240, rng.integers(10, 150))) / 10.0
    rows = np.column_stack([times, rng.normal(size=(len(times), 3))])
    events = np.zeros(rng.integers(0, 40), EVENT_DTYPE)
    events["t"] = np.sort(rng.uniform(0.0, times[-1], len(events)))
    events["value"] = np.arange(len(events))
    borders = [0.0, *np.sort(rng.uniform(0.0, times[-1], rng.integers(1, 12))), times[-1] + 1.0]
    return [
        (rows[(times >= low) & (times < high)], events[(events["t"] >= low) & (events["t"] < high)])
        for low, high in pairwise(borders)
    ]


def closed(kept: Kept, end: float) -> tuple[np.ndarray, np.ndarray]:
    """The rows and events of a run that ends now."""
    found = kept.closed(end)
    assert found is not None
    (t, q, u, a), events = found
    return np.column_stack([t, q, u, a]), events


def settled_by_hand(parts: list[Part], recording: Recording) -> int:
    """How many of the parts nothing that comes can change.

    With windows the next row says whether the last one stays. Of a tail the row before it counts, too: settled are the parts
    whose rows and events, and the rows of the part behind them, are older than it.
    """
    with_rows = [k for k, (rows, _) in enumerate(parts) if len(rows)]
    if not with_rows:
        return 0
    if not recording.has_tail:
        return with_rows[-1]
    since = parts[with_rows[-1]][0][-1, 0] - TAIL
    for k, (rows, events) in enumerate(parts):
        after = parts[k + 1][0] if k + 1 < len(parts) else np.zeros((0, 4))
        old = [len(one) > 0 and one[-1, 0] < since for one in (rows, after)]
        if not all(old) or (events["t"] >= since).any():
            return k
    raise AssertionError("the last part is never old")


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("name", RECORDINGS)
def test_events_are_told_once_as_soon_as_they_are_settled(name: str, seed: int) -> None:
    recording, parts = RECORDINGS[name], parts_of_a_run(np.random.default_rng(seed))
    told: list[float] = []
    kept = Kept(recording, TAIL)
    kept.follow = lambda events, _: told.extend(events["value"])
    chosen: list[float] = []
    for count, (rows, events) in enumerate(parts, 1):
        kept.flush(rows, events)
        before = [one["value"] for _, one in parts[: settled_by_hand(parts[:count], recording)]]
        chosen = [float(value) for values in before for value in values]
        if recording.keep == "statistics":
            times = {float(event["value"]): event["t"] for _, one in parts for event in one}
            chosen = [value for value in chosen if any(a <= times[value] <= b for a, b in recording.windows)]
        assert told == chosen
        assert kept.parts == count


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("name", RECORDINGS)
def test_what_stays_for_good_is_there_whatever_comes(name: str, seed: int) -> None:
    """Of a state within a run its rows are told apart: those that stay, and those that only the tail holds, or the next row."""
    recording, rng = RECORDINGS[name], np.random.default_rng(seed)
    parts = parts_of_a_run(rng)
    cut = int(rng.integers(1, len(parts)))
    kept = Kept(recording, TAIL)
    for rows, events in parts[:cut]:
        kept.flush(rows, events)
    before = np.concatenate([rows for rows, _ in parts[:cut]])
    if not len(before):
        return
    end, count = float(before[-1, 0]), kept.parts
    rows, events = closed(kept, end)
    stays = kept.for_good(end, count)
    assert kept.counts(end, count) == (len(rows), len(events))
    early = int(rng.integers(0, count + 1))
    assert kept.counts(end, early)[0] == (rows[:, 0] <= max([-1.0, *(p[0][-1, 0] for p in parts[:early] if len(p[0]))])).sum()
    assert kept.counts(end, early)[1] == sum(np.isin(p[1]["value"], events["value"]).sum() for p in parts[:early])
    assert np.array_equal(kept.for_good(end, early), stays[: kept.counts(end, early)[0]])
    # The run goes on for long, its next row far from every window.
    kept.flush(np.array([[end + 1e-3, 0.0, 0.0, 0.0], [900.0, 0.0, 0.0, 0.0]]), np.zeros(0, EVENT_DTYPE))
    later = {float(t) for t in closed(kept, 1000.0)[0][:, 0]}
    across = any(start < end + 1e-3 and end < stop for start, stop in recording.row_windows)
    assert [t for t in rows[stays, 0] if t not in later] == []
    lost = {float(t) for t in rows[:, 0]} - later
    assert lost <= {float(t) for t in rows[~stays, 0]}
    kept_after_all = {float(t) for t in rows[~stays, 0]} & later
    assert kept_after_all <= ({end} if across else set())


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("name", [name for name, recording in RECORDINGS.items() if not recording.has_tail])
def test_a_run_in_pieces_keeps_what_a_whole_one_does(name: str, seed: int) -> None:
    """What is unfinished is handed on: how many rows were met, when the last one was, and itself where it waits."""
    recording, parts = RECORDINGS[name], parts_of_a_run(np.random.default_rng(seed))
    end = max(float(rows[-1, 0]) for rows, _ in parts if len(rows))
    whole, piece = Kept(recording, TAIL), Kept(recording, TAIL)
    found: list[np.ndarray] = []
    for rows, events in parts:
        whole.flush(rows, events)
        piece.flush(rows, events)
        if len(rows):
            got = closed(piece, end)[0]
            found.append(got)
            unfinished = piece.unfinished()
            assert (len(unfinished["row"]) > 0) <= np.array_equal(unfinished["row"], rows[-1])
            piece = Kept(recording, TAIL)
            piece.go_on(unfinished)
            for at_once in [piece.closed(end)] if len(unfinished["row"]) else []:
                assert at_once is not None and [len(column) for column in (*at_once[0], at_once[1])] == [0] * 5
    times = np.concatenate(found)[:, 0]
    assert times.tolist() == closed(whole, end)[0][:, 0].tolist()


def test_nothing_is_known_of_a_run_that_begins() -> None:
    kept = Kept(Recording(), TAIL)
    assert kept.closed(1.0) is None
    assert kept.unfinished()["row"].shape == (0,)
    kept.go_on({})
    assert kept.parts == 0


@pytest.mark.parametrize("seed", range(20))
def test_rows_of_stretches(seed: int) -> None:
    """Those within, and the ones on both sides of each stretch, however short it is."""
    rng = np.random.default_rng(seed)
    times = np.unique(rng.integers(0, 40, 15)) / 2.0
    starts = rng.integers(0, 20, 3) + 0.25 * rng.integers(0, 2, 3)
    spans = tuple((float(a), float(a + length)) for a, length in zip(starts, (0.1, 1.0, 2.5), strict=True))
    chosen = set()
    for a, b in spans:
        chosen |= {i for i, t in enumerate(times) if a <= t <= b}
        chosen |= {k for i in range(len(times) - 1) if times[i] < b and times[i + 1] > a for k in (i, i + 1)}
    assert np.flatnonzero(stretch_rows(times, spans)).tolist() == sorted(chosen)


def test_of_no_rows_none_are_chosen() -> None:
    assert stretch_rows(np.zeros(0), ((0.0, 1.0),)).tolist() == []
    assert stretch_rows(np.ones(1), ((0.0, 2.0),)).tolist() == [True]
    assert stretch_rows(np.ones(1), ((2.0, 3.0),)).tolist() == [False]
