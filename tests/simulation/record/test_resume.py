"""Is a saved state complete? Going on from it must give the same bits as never having stopped."""

from __future__ import annotations

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

from watchsim.candidates import cell_table
from watchsim.candidates import pair_cache as known
from watchsim.results.state_file import read_state, write_state
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation.record.saved_state import LATER
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop


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


@pytest.mark.parametrize("method", [{}, {"method": "moreau", "step": 1e-4}], ids=["events", "fixed steps"])
def test_however_slices_end(method: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    """After each step, after seven, or after as many as take a tenth of a second: the same bits."""
    whole = simulate(profile("bench_lever"), 0.3, **method)
    for steps in (1.0, 7.0):
        monkeypatch.setattr("watchsim.simulation.slice_pace.FEWEST_STEPS", steps)
        monkeypatch.setattr("watchsim.simulation.slice_pace.MOST_STEPS", steps)
        assert_same(simulate(profile("bench_lever"), 0.3, **method), whole)


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


def test_the_order_in_which_cells_are_learned_does_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each cell alone, when it is met, instead of with its neighbours: more questions, another table, the same bits."""
    scene = profile("bench_lever")
    known._store.clear()
    plain = simulate(scene, 0.3)
    known._store.clear()
    for name in ("AROUND", "BESIDE", "AHEAD"):
        monkeypatch.setattr(cell_table, name, {1: 0, 2: 0, 3: 0})
    other = simulate(scene, 0.3)
    assert 0 < other.counts["cells_asked"] < plain.counts["cells_asked"]
    assert_same(plain, other)


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
    with pytest.raises(ValueError, match=r"another version of watchsim \(force_zero was 2e-09, now .*begin anew"):
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
    assert len(older.arrays) == len(first.arrays) - len(LATER)
    assert_same(simulate(scene, 0.1, start=older), simulate(scene, 0.1, start=first))
