"""Is what is kept of a run, flush by flush, what one would choose who had all of it before him, and do sums replace it?"""

import functools
import gc
import math
import tracemalloc
from itertools import pairwise

import numpy as np
import pytest
from moving_scenes import profile

from watchsim.analysis.summary import summary
from watchsim.analysis.timing import beats
from watchsim.scene.forces import Spring
from watchsim.scene.scene import EVERYTHING, Body, Recording, Scene
from watchsim.simulation import runner as running
from watchsim.simulation.recording import (
    FEWEST_TURNS,
    Pair,
    first_noises,
    half_swings,
    since_two_before,
    stretch_rows,
    tail_length,
    unevenness,
)
from watchsim.simulation.recording import Recorder as Kept
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EVENT_DTYPE, EventKind
from watchsim.simulation.tally import Tally
from watchsim.simulation.trajectory import Trajectory

# Is what is kept of a run, flush by flush, what one would choose who had all of it before him?

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


# When is a part of a run settled, what stays of it for good, and does a run in pieces keep what a whole one does?

TAIL = 1.7
RECORDINGS_SETTLED_ROWS = {
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
@pytest.mark.parametrize("name", RECORDINGS_SETTLED_ROWS)
def test_events_are_told_once_as_soon_as_they_are_settled(name: str, seed: int) -> None:
    recording, parts = RECORDINGS_SETTLED_ROWS[name], parts_of_a_run(np.random.default_rng(seed))
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
@pytest.mark.parametrize("name", RECORDINGS_SETTLED_ROWS)
def test_what_stays_for_good_is_there_whatever_comes(name: str, seed: int) -> None:
    """Of a state within a run its rows are told apart: those that stay, and those that only the tail holds, or the next row."""
    recording, rng = RECORDINGS_SETTLED_ROWS[name], np.random.default_rng(seed)
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
@pytest.mark.parametrize("name", [name for name, recording in RECORDINGS_SETTLED_ROWS.items() if not recording.has_tail])
def test_a_run_in_pieces_keeps_what_a_whole_one_does(name: str, seed: int) -> None:
    """What is unfinished is handed on: how many rows were met, when the last one was, and itself where it waits."""
    recording, parts = RECORDINGS_SETTLED_ROWS[name], parts_of_a_run(np.random.default_rng(seed))
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


# Can sums replace the record: the same numbers and flat memory, however little is kept and however the run is cut?

DURATION = 6.0
CLOCKS = ("wall_s", "compile_s", "realtime_factor")
# counts: how many cells were asked about depends on the runs before; overlap: how often was looked, on the buffers
OTHERWISE = (*CLOCKS, "kept", "counts", "overlap", "verdict_message", "verdict_details")  # words of the beats that are kept


@functools.cache
def whole() -> Trajectory:
    return simulate(profile("swiss_lever"), DURATION)


def small_buffers(patch: pytest.MonkeyPatch) -> None:
    """So that they are emptied many times."""
    patch.setattr(running, "ROWS", 600)
    patch.setattr(running, "EVENTS", 300)


def test_sums_are_those_of_the_beats() -> None:
    found, sums = beats(whole()), whole().sums
    assert sums["half_swings"] == len(found) == 46
    assert sums["ticks"] == np.isfinite(found.tick).sum()
    uneven = np.diff(np.diff(found.t, prepend=np.nan), prepend=np.nan) * np.sign(found.end_at - found.start_at)
    for name, values in (("amplitude", found.amplitude), ("period", found.period_s), ("uneven_passages", uneven)):
        known, told = values[np.isfinite(values)], sums[name]
        assert (told["number"], told["least"], told["largest"]) == (len(known), known.min(), known.max())
        assert told["mean"] == pytest.approx(known.mean(), rel=1e-13, abs=1e-18)
        assert told["squares"] == pytest.approx(((known - known.mean()) ** 2).sum(), rel=1e-9)
    kinds = whole().events["kind"]
    assert sums["events_by_kind"]["impact"] == (kinds == 1).sum() > 1000
    assert sums["events_by_kind"] == {kind.name.lower(): int((kinds == kind).sum()) for kind in EventKind}


def test_an_oscillator_that_is_the_first_of_the_bodies_is_counted() -> None:
    balance = Body("balance", "pivot", velocity=(3.0,), inertia=1e-9)
    run = simulate(Scene("one", (balance,), springs=(Spring("balance", 1e-9 * (2.0 * np.pi) ** 2),)), 5.3)
    assert run.sums["half_swings"] == len(beats(run)) > 5
    assert run.sums["amplitude"]["mean"] == pytest.approx(1.5 / np.pi, rel=1e-9)


@pytest.mark.parametrize("count", [1, 2, 3, 9])
def test_an_even_swing_without_noises(count: int) -> None:
    """It turns at -1 and 1 rad each other second and passes its rest in between: means that are zero are told, too."""
    events = np.zeros(2 * count + 1, EVENT_DTYPE)
    events["t"] = np.arange(len(events))
    events["kind"][::2], events["kind"][1::2] = EventKind.TURN, EventKind.CROSS
    way = (-1.0) ** (np.arange(len(events)) // 2)
    events["value"] = np.where(np.arange(len(events)) % 2 == 0, -way, 3.0 * way)
    balance = Body("balance", "pivot", velocity=(3.0,), inertia=1e-9)
    tally = Tally(Scene("one", (balance,), springs=(Spring("balance", 1e-9),)), ())
    tally.fold(events)
    sums = tally.finished()
    told = max(count, 0) if count > 1 else 0  # two turning points are too few
    assert (sums["half_swings"], sums["ticks"], sums["uneven_ticks"]) == (told, 0, None)
    assert sums["events_by_kind"]["turn"] == count + 1 and sums["events_by_kind"]["cross"] == count
    for name, value, number in (("amplitude", 1.0, told), ("period", 4.0, told - 2), ("uneven_passages", 0.0, told - 2)):
        even = {"number": number, "mean": value, "squares": 0.0, "least": value, "largest": value}
        assert sums[name] == (even if number > 0 else None)


@pytest.mark.parametrize("late", [-1.0, 0.0, 1.0])
def test_a_stop_that_ends_a_swing_is_no_first_noise_of_the_next(late: float) -> None:
    """Every other swing ends at a stop, heard at the turning point but for rounding; each has its tick halfway to its rest."""
    balance, stop = Body("balance", "pivot", velocity=(3.0,), inertia=1e-9), Body("stop", "fixed")
    tally = Tally(
        Scene("one", (balance, stop), springs=(Spring("balance", 1e-9),)),
        (Pair(0, "stop", "line", 0, "", "balance", "corner", 0, ""),),
    )
    turns = np.arange(1.0, 40.0, 2.0)
    stopped = turns[::2] + late * np.spacing(turns[::2])
    kinds = {EventKind.TURN: turns, EventKind.CROSS: turns + 1.0, EventKind.IMPACT: np.concatenate([turns + 0.5, stopped])}
    events = np.concatenate([np.zeros(len(times), EVENT_DTYPE) for times in kinds.values()])
    events["t"], events["kind"] = np.concatenate([*kinds.values()]), np.repeat([*kinds], [len(t) for t in kinds.values()])
    of_turn = events["kind"] == EventKind.TURN
    events["value"][of_turn] = np.resize([-1.0, 1.0], len(turns))
    tally.fold(np.sort(events, order="t", kind="stable"))
    sums = tally.finished()
    assert sums["ticks"] == sums["half_swings"] > 15
    assert sums["uneven_ticks"]["mean"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("parts", [2, 7, 100])
def test_sums_do_not_depend_on_how_events_are_handed_over(parts: int) -> None:
    run = whole()
    tally, rows = Tally(run.scene, run.pairs, run.slices), np.concatenate([run.t[:, None], run.q, run.u, run.a], axis=1)
    tally.waits, done = True, 0
    for part in np.array_split(run.events, parts):
        until = int(np.searchsorted(run.t, part["t"][-1] - 0.01))  # the last events wait for their rows
        tally.fold(part, rows[done:until])
        done = until
    tally.fold(run.events[:0], rows[done:])
    assert tally.finished() == run.sums


@pytest.mark.parametrize("record", ["statistics", "events", Recording(((1.0, 1.5),), "statistics")])
def test_all_headline_numbers_survive(record: str | Recording, monkeypatch: pytest.MonkeyPatch) -> None:
    small_buffers(monkeypatch)
    done = simulate(profile("swiss_lever"), DURATION, record=record)
    one, two = summary(whole()), summary(done)
    assert one["missed_beats"] == 0
    assert one.pop("whole_run") == two.pop("whole_run")
    for name in OTHERWISE:
        one.pop(name), two.pop(name)
    assert one == two
    assert done.t[-1] == DURATION
    assert len(done.t) < 0.7 * len(whole().t)


def with_neighbours(rows: np.ndarray) -> np.ndarray:
    """These rows, the one before the first and the one after the last."""
    first, last = np.flatnonzero(rows)[[0, -1]]
    return (np.arange(len(rows)) >= first - 1) & (np.arange(len(rows)) <= last + 1)


def test_only_what_was_asked_for_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    small_buffers(monkeypatch)
    scene, full = profile("swiss_lever"), whole()
    statistics = simulate(scene, DURATION, record=Recording(((1.0, 1.5),), "statistics"))
    tail = (DURATION - 3.0, DURATION)
    assert statistics.spans == ((1.0, 1.5), tail)
    inside = with_neighbours((full.t >= 1.0) & (full.t <= 1.5)) | with_neighbours(full.t >= tail[0])
    assert np.array_equal(statistics.t, full.t[inside])
    assert np.array_equal(statistics.q, full.q[inside])
    times = full.events["t"]
    assert np.array_equal(statistics.events, full.events[((times >= 1.0) & (times <= 1.5)) | (times >= tail[0])])
    events = simulate(scene, DURATION, record="events")
    assert np.array_equal(events.events, full.events)
    assert np.array_equal(events.t, full.t[with_neighbours(full.t >= tail[0])])
    thinned = simulate(scene, DURATION, record=Recording(stride=7))
    assert np.array_equal(thinned.q, full.q[::7])
    assert np.array_equal(thinned.events, full.events)
    assert np.array_equal(thinned.end_q, full.q[-1])


def test_a_resumed_run_keeps_the_same_windows() -> None:
    record = Recording(((0.5, 0.6), (1.2, 1.3)), "statistics")
    scene = profile("swiss_lever")
    first = simulate(scene, 4.0, record=record)
    both, at_once = simulate(scene, DURATION, record=record, start=first), simulate(scene, DURATION, record=record)
    assert both.t.tolist() == at_once.t.tolist()
    assert both.end_state.rows == at_once.end_state.rows


def test_a_run_that_goes_on_keeps_the_sums_of_both_parts() -> None:
    scene = profile("swiss_lever")
    first = simulate(scene, 4.0, record="statistics")
    both = simulate(scene, DURATION, record="statistics", start=first)
    at_once = simulate(scene, DURATION, record="statistics")
    assert both.sums == at_once.sums
    assert both.t.tolist() == at_once.t.tolist()
    assert both.events.tobytes() == at_once.events.tobytes()
    assert (both.end_state.rows, both.end_state.events) == (at_once.end_state.rows, at_once.end_state.events)


@pytest.mark.parametrize("bad", ["statistic", "", ((2.0, 1.0),)])
def test_what_cannot_be_kept_is_refused(bad: object) -> None:
    with pytest.raises(ValueError, match=r"choose from all, events, statistics|a window runs from"):
        simulate(profile("incline"), 0.1, record=bad)
    assert EVERYTHING.row_windows[0][1] == np.inf


def most_memory(duration: float) -> tuple[int, int]:
    """Bytes: the most that was in use during a run, and what its result holds on to."""
    gc.collect()
    tracemalloc.start()
    done = simulate(profile("swiss_lever"), duration, record="statistics")
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert done.simulated == duration
    return most, done.t.nbytes + done.q.nbytes + done.events.nbytes


@pytest.mark.slow
@pytest.mark.parametrize(("short", "long"), [(20.0, 60.0), (600.0, 3600.0)])
def test_statistics_of_a_long_run_need_no_more_memory(short: float, long: float) -> None:
    simulate(profile("swiss_lever"), short, record="statistics")  # loads, and asks about the cells
    before, after = most_memory(short), most_memory(long)
    assert after[0] < 1.5 * before[0]  # the peak moves by a fifth with where the buffers are emptied
    assert after[1] == pytest.approx(before[1], rel=0.1)


# Are half swings and first noises those that one finds by looking at one event after another?


def events(times: list[int], values: list[float]) -> np.ndarray:
    rows = np.zeros(len(times), EVENT_DTYPE)
    rows["t"], rows["value"] = times, values
    return rows


def by_looking(crossings: np.ndarray, turns: np.ndarray) -> list[tuple[int, int, int]]:
    """(passage, turning point before, turning point after): of several the one furthest out on the side swung to."""

    def between(k: int) -> int | None:
        """The turning point after passage k - 1 and before passage k."""
        since = crossings["t"][k - 1] if k else -math.inf
        until = crossings["t"][k] if k < len(crossings) else math.inf
        side = crossings["value"][k - 1] if k else -crossings["value"][0]
        own = [i for i, turn in enumerate(turns) if since <= turn["t"] < until]
        return max(own, key=lambda i: math.copysign(1.0, side) * turns["value"][i], default=None)

    found = [(k, between(k), between(k + 1)) for k in range(len(crossings))]
    return [(k, a, b) for k, a, b in found if a is not None and b is not None]


@pytest.mark.parametrize("seed", range(40))
def test_half_swings(seed: int) -> None:
    """With knocks, missing turning points, and events at the same instant."""
    rng = np.random.default_rng(seed)
    crossings = events(sorted(rng.choice(30, 8, replace=False)), list(rng.choice([-2.0, 3.0], 8)))
    turns = events(sorted(rng.integers(0, 30, 12)), list(rng.permutation(np.arange(-6.0, 6.0))))
    found = half_swings(crossings, turns)
    assert list(zip(*(column.tolist() for column in found), strict=True)) == by_looking(crossings, turns)


def test_too_few_events_make_none() -> None:
    crossing, turns = events([2], [1.0]), events([1, 3, 4], [-1.0, 1.0, 0.5])
    assert [column.tolist() for column in half_swings(crossing, turns)] == [[0], [0], [1]]
    assert len(turns) == FEWEST_TURNS
    for few in (half_swings(crossing, turns[:-1]), half_swings(crossing[:0], turns)):
        assert [len(column) for column in few] == [0, 0, 0]


@pytest.mark.parametrize("seed", range(20))
def test_the_first_noise_after_a_silence(seed: int) -> None:
    """Times in tenths of the silence: noises at its very end, at the start of a half swing and at its end occur."""
    rng = np.random.default_rng(seed)
    step = 0.1  # a quarter of the silence, which is a tenth of a half period of 4
    noises, starts = step * np.unique(rng.integers(0, 80, 25)), step * np.arange(0.0, 80.0, 10.0)
    ends = starts + 10.0 * step
    expected, turn = [], 1e-6 * 4.0  # at the turning point itself a noise belongs to the half swing that ends
    for start, end in zip(starts, ends, strict=True):
        after = [t for i, t in enumerate(noises) if (i == 0 or t - noises[i - 1] >= 0.4) and start + turn < t]
        expected.append(after[0] if after and after[0] < end + turn else math.nan)
    assert first_noises(noises, starts, ends, 4.0) == pytest.approx(np.array(expected), nan_ok=True, abs=0.0)


@pytest.mark.parametrize("count", [0, 1, 2, 3, 9])
def test_periods_and_unevenness(count: int) -> None:
    times = np.cumsum(np.random.default_rng(count).uniform(0.9, 1.1, count))
    for found, at in ((since_two_before(times), lambda i: times[i] - times[i - 2]),
                      (unevenness(times), lambda i: times[i] - 2.0 * times[i - 1] + times[i - 2])):  # fmt: skip
        expected = [math.nan if i < 2 else at(i) for i in range(count)]
        assert found == pytest.approx(np.array(expected), nan_ok=True)
