"""Is a saved state complete, refused where it does not fit, and joined to what follows?"""

import dataclasses
import os
import signal
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import short_runs
from every_time import few
from moving_scenes import profile

from watchsim.mechanism.compile import compile_scene
from watchsim.results.archive import read_state, write_state
from watchsim.scene.scene import Body, Recording, Scene
from watchsim.simulation.saved_state import LATER, SavedState, model_digest, save_state
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EVENT_DTYPE, Stop
from watchsim.simulation.trajectory import Trajectory, joined

# Is a saved state complete? Going on from it must give the same bits as never having stopped.


def assert_same(one: Trajectory, other: Trajectory) -> None:
    for name in ("t", "q", "u", "a", "events"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name
    assert one.simulated == other.simulated
    assert one.energy == other.energy
    assert one.worst_penetration == other.worst_penetration
    assert one.worst_residual == other.worst_residual
    assert met(one) == met(other)


def met(run: Trajectory) -> dict[str, int]:
    """What the motion met, and the work. Only what this process has in its table of cells depends on what it did before."""
    return {name: count for name, count in run.counts.items() if name not in ("cells", "cells_asked")}


CASES = [
    pytest.param("bench_lever", 0.5, (0.2, 0.2003), {}, id="events"),
    pytest.param("incline", 0.6, (0.1, 0.44), {}, id="bounces"),
    pytest.param("bench_lever", 0.2, (0.0731,), {"method": "moreau", "step": 2e-5}, id="fixed steps"),
]


def in_pieces(scene: Scene, cuts: tuple[float, ...], end: float, options: dict[str, Any]) -> Trajectory:
    parts = simulate(scene, cuts[0], **options)
    assert parts.simulated == cuts[0]
    for cut in (*cuts[1:], end):
        parts = simulate(scene, cut, start=parts, **options)
    return parts


@pytest.mark.parametrize("name, end, cuts, options", CASES)
def test_pieces_and_whole_agree_bit_by_bit(name: str, end: float, cuts: tuple[float, ...], options: dict[str, Any]) -> None:
    whole = simulate(profile(name), end, **options)
    parts = in_pieces(profile(name), cuts, end, options)
    assert_same(parts, whole)
    assert parts.stop == Stop.DURATION


WINDOWS = ((0.1, 0.15), (0.18, 0.3))
RECORDINGS = [
    *(Recording(), Recording(WINDOWS), Recording(stride=7), Recording(WINDOWS, stride=3), Recording(keep="events")),
    *(Recording(WINDOWS, "statistics"), Recording(WINDOWS, "events", 2), Recording(((0.1, 0.1001),))),
]


@pytest.mark.parametrize("recording", few(RECORDINGS, 4), ids=str)
def test_with_every_recording(recording: Recording) -> None:
    """Wherever it is cut: within windows, between them, just before the row next to one, and within the tail of the first."""
    scene = profile("bench_lever")
    options = {"record": recording}
    for end, cuts in ((0.4, (0.05,)), (0.4, (0.12, 0.165)), (0.4, (0.0999, 0.1795, 0.31)), (4.0, (0.2, 2.9))):
        assert_same(in_pieces(scene, cuts, end, options), simulate(scene, end, **options))


@pytest.mark.parametrize("name", short_runs.short_runs())
def test_wherever_a_hard_case_is_cut(name: str) -> None:
    """Also at the very instants of events: impacts, jams, bearings that stop, bodies falling asleep, the last rebounds."""
    scene, end, options = short_runs.short_runs()[name]
    whole = simulate(scene, end, **options)
    instants = np.unique(whole.events["t"][whole.events["t"] > 0.0])
    picked = instants[:: max(1, len(instants) // 6)]
    cuts = sorted({float(t) for t in (0.371 * whole.simulated, *picked) if t < whole.simulated})
    assert_same(in_pieces(scene, tuple(cuts), end, options), whole)


def test_from_a_file(tmp_path: Path) -> None:
    """With bearings that hold and bodies asleep."""
    scene, end, _ = short_runs.short_runs()["dry bench_lever, two beats"]
    for method in ({}, {"method": "moreau", "step": 1e-4}):
        whole, first = simulate(scene, end, **method), simulate(scene, 0.1, **method)
        assert first.end_state is not None
        write_state(first.end_state, tmp_path / "state.npz")
        read = read_state(tmp_path / "state.npz")
        assert_same(simulate(scene, end, start=dataclasses.replace(first, end_state=read), **method), whole)


def test_from_a_state_only_what_follows_is_told() -> None:
    scene = profile("bench_lever")
    whole, first = simulate(scene, 0.4), simulate(scene, 0.2)
    rest = simulate(scene, 0.4, start=first.end_state)
    assert np.array_equal(np.concatenate([first.t[: first.end_state.rows], rest.t]), whole.t)
    assert np.array_equal(rest.q[-1], whole.q[-1])


def test_interrupted_and_taken_up_again() -> None:
    scene = profile("bench_lever")

    def impatient(simulated: float, _: float) -> None:
        if simulated > 0.15:
            raise KeyboardInterrupt

    stopped = simulate(scene, 0.5, progress=impatient)
    assert stopped.stop == Stop.INTERRUPTED
    assert stopped.simulated < 0.5
    assert_same(simulate(scene, 0.5, start=stopped), simulate(scene, 0.5))


@pytest.fixture
def ctrl_c() -> Iterator[Callable[[float], None]]:
    """As from the keyboard after so many seconds, while the loop runs; never after the test.

    It reaches Python also where the tests run in the background of a shell, which has it ignored.
    """
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    presses: list[threading.Timer] = []

    def press(after: float) -> None:
        presses.append(threading.Timer(after, os.kill, (os.getpid(), signal.SIGINT)))
        presses[-1].start()

    yield press
    for one in presses:
        one.cancel()
        one.join()
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("options", few([{}, {"method": "moreau", "step": 1e-4}], 1), ids=["events", "fixed steps"])
def test_ctrl_c_at_any_moment_loses_nothing(ctrl_c: Callable[[float], None], options: dict[str, Any]) -> None:
    """Wherever it comes: what was kept is whole, and going on gives the bits of a run that was never stopped."""
    scene = profile("bench_lever")
    simulate(scene, 0.01, **options)
    ctrl_c(0.3)
    stopped = simulate(scene, 1e4, **options)
    assert stopped.stop == Stop.INTERRUPTED
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    end = stopped.simulated + 0.05
    assert_same(simulate(scene, end, start=stopped, **options), simulate(scene, end, **options))


def changed(scene: Scene) -> Scene:
    return dataclasses.replace(scene, torques=(dataclasses.replace(scene.torques[0], value=-5e-6),))


def test_another_scene_is_refused() -> None:
    scene = profile("bench_lever")
    first = simulate(scene, 0.05)
    with pytest.raises(ValueError, match="another scene"):
        simulate(changed(scene), 0.1, start=first)
    with pytest.raises(ValueError, match=r"other settings.*tolerance"):
        simulate(scene, 0.1, 1e-7, start=first)
    assert first.end_state is not None
    older = dataclasses.replace(first.end_state, settings={**first.end_state.settings, "force_zero": 2e-9})
    with pytest.raises(ValueError, match=r"another version of watchsim \(force_zero was 2e-09, now .*start again"):
        simulate(scene, 0.1, start=older)
    with pytest.raises(ValueError, match=r"\(method was pfeiffer-glocker, now moreau\)"):
        simulate(scene, 0.1, start=first, method="moreau")
    with pytest.raises(ValueError, match=r"has reached 0\.05 s already"):
        simulate(scene, 0.05, start=first)


def test_a_state_without_what_came_later_goes_on() -> None:
    scene = profile("bench_lever")
    first = simulate(scene, 0.05).end_state
    assert first is not None
    older = dataclasses.replace(first, arrays={name: part for name, part in first.arrays.items() if name not in LATER})
    assert len(older.arrays) == len(first.arrays) - len(set(LATER) & set(first.arrays)) < len(first.arrays)
    assert_same(simulate(scene, 0.1, start=older), simulate(scene, 0.1, start=first))


# Is a saved state that does not fit together, or belongs to another run, refused?

COMPILED = compile_scene(profile("incline"))
SETTINGS = {"method": "pfeiffer-glocker", "step": None, "tolerance": 1e-9, "gap": 1e-12}
TALLY = {name: np.zeros(2) for name in ("kinds", "beats", "moments", "last", "carried")}


def arrays() -> dict[str, np.ndarray]:
    return {"clock": np.array([2.5, 0.1, 0.0]), "q": np.array([1.0, 2.0, 3.0]), "returning": np.zeros(4)}


def state() -> SavedState:
    recorded = {"met": np.array(3), "last": np.array([2.5, 1.0]), "row": np.zeros(10), "stays": np.ones(7, bool)}
    saved = save_state(COMPILED, SETTINGS, arrays(), 0.25, dict(TALLY))
    return dataclasses.replace(saved, rows=7, events=4, recorded=recorded)


def test_a_state_is_whole_with_or_without_what_decides_about_rows() -> None:
    assert state().is_whole() and state().time == 2.5
    assert dataclasses.replace(state(), recorded={}).is_whole()
    assert dataclasses.replace(state(), events=0).is_whole()
    begun = {**state().recorded, "row": np.zeros(0), "stays": np.zeros(0, bool)}
    assert dataclasses.replace(state(), rows=0, recorded=begun).is_whole()


def recorded(name: str, value: object) -> Callable[[SavedState], SavedState]:
    return lambda whole: dataclasses.replace(whole, recorded={**whole.recorded, name: np.asarray(value)})


def array(name: str, value: object) -> Callable[[SavedState], SavedState]:
    return lambda whole: dataclasses.replace(whole, arrays={**whole.arrays, name: np.asarray(value)})


def given(**changed: object) -> Callable[[SavedState], SavedState]:
    return lambda whole: dataclasses.replace(whole, **changed)


BROKEN = {
    "no clock": given(arrays={"q": np.zeros(3)}),
    "another clock": array("clock", np.zeros(2)),
    "not a number": array("q", [0.0, np.nan, 0.0]),
    "no end": array("clock", [np.inf, 0.0, 0.0]),
    "a sum less": given(tally={name: TALLY[name] for name in list(TALLY)[1:]}),
    "a sum more": given(tally={**TALLY, "other": np.zeros(1)}),
    "no settings": given(settings=None),
    "energy as text": given(stored_at_start="0.25"),
    "negative events": given(events=-1),
    "half an event": given(events=0.5),
    "negative rows": given(rows=-1, recorded={}),
    "part of what decides": given(recorded={"met": np.array(3)}),
    "several numbers met": recorded("met", [3]),
    "half a row met": recorded("met", 3.0),
    "time alone": recorded("last", [2.5]),
    "whole seconds": recorded("last", [2, 1]),
    "a table for a row": recorded("row", np.zeros((1, 10))),
    "a row of whole numbers": recorded("row", np.zeros(10, int)),
    "fewer rows that stay": recorded("stays", np.ones(6, bool)),
    "numbers for rows that stay": recorded("stays", np.ones(7)),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_does_not_fit_together_is_not_whole(name: str) -> None:
    assert not BROKEN[name](state()).is_whole()


def test_a_state_goes_with_its_model_and_settings() -> None:
    state().check(COMPILED, SETTINGS)
    steeper = compile_scene(dataclasses.replace(profile("incline"), gravity=(0.0, -9.0)))
    with pytest.raises(ValueError, match="another scene"):
        state().check(steeper, SETTINGS)
    moved = dataclasses.replace(COMPILED, q=COMPILED.q + 1e-15)
    assert model_digest(moved) != model_digest(COMPILED) == model_digest(compile_scene(profile("incline")))
    assert len(model_digest(COMPILED)) == 16  # as in states that earlier versions have written


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"tolerance": 1e-6}, "tolerance was 1e-09, now 1e-06"),
        ({"tolerance": 1e-6, "method": "moreau", "step": 1e-5}, "method was pfeiffer-glocker, now moreau"),
        ({"gap": 1e-13}, "another version of watchsim .gap was 1e-12, now 1e-13"),
        ({"new": 1}, "another version of watchsim .new was None, now 1"),
    ],
)
def test_other_settings_are_named(changed: dict[str, object], words: str) -> None:
    """Of what is asked the first; what follows from it is not mentioned."""
    with pytest.raises(ValueError, match=words):
        state().check(COMPILED, {**SETTINGS, **changed})


def test_what_is_restored_is_what_was_saved() -> None:
    """Copies; what earlier versions had not begins blank."""
    source = arrays()
    saved = dataclasses.replace(save_state(COMPILED, SETTINGS, source, 0.25, {}), recorded={})
    source["q"][:] = 9.0
    room = {name: np.full_like(one, 7.0) for name, one in source.items()}
    saved.restore(room)
    assert {name: one.tolist() for name, one in room.items()} == {name: one.tolist() for name, one in arrays().items()}
    earlier = dataclasses.replace(saved, arrays={name: saved.arrays[name] for name in ("clock", "q")})
    room["returning"][:] = 7.0
    earlier.restore(room)
    assert room["returning"].tolist() == [0.0] * 4


@pytest.mark.parametrize("broken", [array("q", np.zeros(4)), array("other", 1.0), recorded("row", np.zeros(9))])
def test_a_state_of_another_shape_is_refused(broken: Callable[[SavedState], SavedState]) -> None:
    """A row holds t and three times as many numbers as there are coordinates."""
    state().restore(arrays())
    with pytest.raises(ValueError, match="another version"):
        broken(state()).restore(arrays())


# What becomes of rows, events and times on the clock where a run goes on from a saved state?

SCENE = Scene("one", (Body("one", "pivot"),))


def saved(rows: int, events: int, **recorded: object) -> SavedState:
    return SavedState({}, "", {}, 0.0, rows=rows, events=events, recorded={k: np.asarray(v) for k, v in recorded.items()})


def part(times: list[float], events: list[float], state: SavedState | None, **more: object) -> Trajectory:
    """A part of a run: its places say its times."""
    t, rows = np.array(times), np.zeros(len(events), EVENT_DTYPE)
    rows["t"] = events
    q = t[:, None]
    given = {"simulated": times[-1], "end_state": state, **more}
    return Trajectory(SCENE, t, q, 10.0 * q, 100.0 * q, {"one": slice(0, 1)}, rows, (), Stop.DURATION, **given)


def times_of(run: Trajectory) -> list[float]:
    assert run.q[:, 0].tolist() == run.t.tolist()
    assert np.array_equal(run.u, 10.0 * run.q) and np.array_equal(run.a, 100.0 * run.q)
    return run.t.tolist()


def test_up_to_its_state_the_first_part_counts_and_times_on_the_clock_add_up() -> None:
    first = part([0.0, 1.0, 2.0, 2.5], [0.5, 1.5, 2.2], saved(3, 2), wall=3.0, compile=2.0)
    rest = part([3.0, 4.0], [2.2, 3.5], saved(1, 1), wall=5.0, compile=0.5)
    whole = joined(first, rest)
    assert times_of(whole) == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert whole.events["t"].tolist() == [0.5, 1.5, 2.2, 3.5]
    assert (whole.wall, whole.compile, whole.simulated) == (8.0, 2.5, 4.0)
    assert whole.end_state is not None
    assert (whole.end_state.rows, whole.end_state.events) == (4, 3)
    assert whole.end_state.recorded["stays"].tolist() == [True] * 4


def test_where_the_rest_has_no_state_the_whole_has_none() -> None:
    first, rest = part([0.0, 1.0], [], saved(2, 0)), part([2.0], [], None)
    assert joined(first, rest).end_state is None
    assert times_of(joined(first, dataclasses.replace(rest, keep="statistics"))) == [0.0, 1.0, 2.0]
    with pytest.raises(ValueError, match="no end state"):
        joined(rest, first)


@pytest.mark.parametrize("keep", ["all", "events", "statistics"])
def test_a_row_that_waited_for_the_next_one_is_told_by_the_rest(keep: str) -> None:
    """Where all is kept, rows that wait are not among those told, so that none is left out."""
    first = part([0.0, 1.0, 2.0], [0.5], saved(3, 1, row=[2.0, 2.0, 20.0, 200.0], stays=[True, True, False]), keep=keep)
    rest = part([2.0, 3.0] if keep != "all" else [3.0], [2.5], saved(1, 1, stays=[True]), keep=keep)
    assert times_of(joined(first, rest)) == [0.0, 1.0, 2.0, 3.0]


@pytest.mark.parametrize("keep", ["events", "statistics"])
def test_of_the_first_part_its_last_seconds_are_forgotten(keep: str) -> None:
    """Two seconds are kept of the whole, and the row before them; of the first part what stays for good or is in windows."""
    stays = [True, False, False, False, False]
    first = part([0.0, 1.0, 2.0, 3.0, 4.0], [0.5, 1.5, 3.5], saved(5, 3, row=[], stays=stays), keep=keep)
    state = saved(2, 1, stays=[False, False])
    rest = part([5.0, 6.0], [4.2, 5.5], state, keep=keep, spans=((0.0, 0.9), (4.0, 6.0)))
    whole = joined(first, rest)
    assert times_of(whole) == [0.0, 4.0, 5.0, 6.0]
    assert whole.events["t"].tolist() == ([0.5, 4.2, 5.5] if keep == "statistics" else [0.5, 1.5, 3.5, 4.2, 5.5])
    assert whole.end_state is not None
    assert whole.end_state.rows == 4 and whole.end_state.recorded["stays"].tolist() == [True, False, False, False]
    assert whole.end_state.events == (2 if keep == "statistics" else 4)


def test_of_a_run_shorter_than_the_tail_all_stays() -> None:
    first = part([0.0, 0.5], [], saved(2, 0, row=[], stays=[False, False]), keep="events")
    rest = part([1.0, 1.5], [], saved(1, 0, stays=[False]), keep="events")
    assert times_of(joined(first, rest)) == [0.0, 0.5, 1.0, 1.5]
