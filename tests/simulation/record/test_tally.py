"""Can sums replace the record: the same numbers and flat memory, however little is kept and however the run is cut?"""

from __future__ import annotations

import functools
import gc
import tracemalloc

import numpy as np
import pytest
from moving_scenes import profile

from watchsim.analysis.summary import summary
from watchsim.analysis.timing.beats import beats
from watchsim.scene.body import Body
from watchsim.scene.force import Spring
from watchsim.scene.recording import EVERYTHING, Recording
from watchsim.scene.scene import Scene
from watchsim.simulation import runner as running
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.record.tally import Tally
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.runner import ROWS
from watchsim.simulation.simulate import simulate

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


@pytest.mark.parametrize("parts", [2, 7, 100])
def test_sums_do_not_depend_on_how_events_are_handed_over(parts: int) -> None:
    tally = Tally(whole().scene, whole().pairs)
    for part in np.array_split(whole().events, parts):
        tally.fold(part)
    assert same(tally.finished(), whole().sums)


def same(one: object, two: object) -> bool:
    """Equal, numbers to rounding."""
    if isinstance(one, dict) and isinstance(two, dict):
        return one.keys() == two.keys() and all(same(one[name], two[name]) for name in one)
    return one == pytest.approx(two, rel=1e-9, abs=1e-18)  # the scatter of periods is a millionth of them


@pytest.mark.parametrize("record", ["statistics", "events", Recording(((1.0, 1.5),), "statistics")])
def test_all_headline_numbers_survive(record: str | Recording, monkeypatch: pytest.MonkeyPatch) -> None:
    small_buffers(monkeypatch)
    done = simulate(profile("swiss_lever"), DURATION, record=record)
    one, two = summary(whole()), summary(done)
    assert one["missed_beats"] == 0
    assert same(one.pop("whole_run"), two.pop("whole_run"))
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


@pytest.mark.parametrize("rows", [ROWS, 1])
def test_a_window_without_a_row_keeps_its_neighbours(rows: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Motion within the shortest windows, and at the ends of others, is that of the whole run, whatever the buffers' size."""
    monkeypatch.setattr(running, "ROWS", rows)
    full = whole()
    gap = int(np.argmax(np.diff(full.t)))
    short = tuple(full.t[gap] + np.array([0.4, 0.5]) * (full.t[gap + 1] - full.t[gap]))
    done = simulate(profile("swiss_lever"), DURATION, record=[short, (5.0, 5.25), (7.0, 8.0)])
    assert done.spans in ((short, (5.0, 5.25)), ((5.0, 5.25), short))
    assert {full.t[gap], full.t[gap + 1]} <= set(done.t.tolist())
    times = np.concatenate([np.linspace(*short, 5), np.linspace(5.0, 5.25, 100)])
    for one, other in zip(done.sample(times), full.sample(times), strict=True):
        assert np.array_equal(one, other)


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
    assert same(both.sums, at_once.sums)
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
