"""Does a run leave the same files with and without a second process, and whatever becomes of it?"""

from __future__ import annotations

import contextlib
import functools
import os
import signal
import sys
from pathlib import Path
from typing import IO

import numpy as np
import pytest
from interpreter import python

from watchsim import stopping
from watchsim.commands.second import second_process as module
from watchsim.commands.second.second_process import SecondProcess, second_process
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.simulation.simulate import simulate

linux = pytest.mark.skipif(sys.platform != "linux", reason="processes are copied on Linux only")
SAME = ("events.csv", "beats.csv", "phases.csv", "plots/kinematics.png", "plots/last_beats.png")
COMMAND = """
import os, sys
if {alone}:
    os.sched_setaffinity(0, list(os.sched_getaffinity(0))[:1])
sys.argv = ["watchsim", *{args}]
from watchsim.process import process
process()
"""


@pytest.mark.slow
@linux
def test_the_results_are_the_same_with_one_core_and_with_more(tmp_path: Path) -> None:
    """Long enough that some phases are over long before the run is."""
    for name, alone in (("more", False), ("one", True)):
        args = ["run", str(profiles_dir() / "swiss_lever"), "--duration", "85 s", "-o", str(tmp_path / name)]
        python(COMMAND.format(alone=alone, args=args))
    for name in SAME:
        assert (tmp_path / "more" / name).read_bytes() == (tmp_path / "one" / name).read_bytes(), name


@pytest.fixture
def second(monkeypatch: pytest.MonkeyPatch) -> SecondProcess:
    """One that is told at once what it is made for, and is waited for where the machine has something else to do."""
    monkeypatch.setattr(stopping, "installed", lambda: True)
    monkeypatch.setattr(module, "QUEUE", 1 << 22)
    monkeypatch.setattr(module, "_cores", lambda: 2)
    made = module._made()
    assert made is not None
    return made


def plain(target: Path | IO[bytes]) -> None:
    assert isinstance(target, Path)
    target.write_text("drawn here")


@linux
def test_it_makes_events_and_plots(second: SecondProcess, tmp_path: Path) -> None:
    scene = load(profiles_dir() / "bench_lever")
    second.prepare(scene, tmp_path / "results", 0.3, "pfeiffer-glocker", scene.tolerance)
    run = simulate(scene, 0.3, follow=second.follow)
    second.finish(run)
    assert second.phases() == {}
    events = second.events()
    assert events is not None
    events.seek(0)
    assert events.read().count(b"\n") == len(run.events) + 1
    drawn = second.drawn({"plots/last_beats.png": plain, "plots/other.png": plain})
    for name, draw in drawn.items():
        draw(tmp_path / Path(name).name)
    second.end()
    assert (tmp_path / "last_beats.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "other.png").read_text() == "drawn here"


@linux
@pytest.mark.parametrize("when", ["at once", "before the end", "after the end"])
def test_what_it_cannot_do_is_done_here(second: SecondProcess, tmp_path: Path, when: str) -> None:
    scene = load(profiles_dir() / "incline")
    kill = functools.partial(os.kill, second._child, signal.SIGKILL)
    if when == "at once":
        kill()
    second.prepare(scene, tmp_path / "results", 0.1, "pfeiffer-glocker", scene.tolerance)
    if when == "before the end":
        kill()
    run = simulate(scene, 0.1, follow=second.follow)
    second.finish(run)
    if when == "after the end":
        kill()
    second.drawn({"plot": plain})["plot"](tmp_path / "plot")
    assert (tmp_path / "plot").read_text() == "drawn here"
    assert second.events() is None or when == "after the end"
    second.end()


@linux
def test_it_goes_with_the_first(second: SecondProcess) -> None:
    second.end()
    with contextlib.suppress(ChildProcessError):
        os.waitpid(second._child, 0)
    with pytest.raises(ProcessLookupError):
        os.kill(second._child, 0)


def test_other_peoples_processes_are_not_copied(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module.os, "fork", lambda: pytest.fail("forked"))
    with second_process() as second:
        assert second is None


@pytest.mark.parametrize(("wanted", "cores"), [(False, 2), (True, 1)])
def test_none_is_made_where_it_is_of_no_use(monkeypatch: pytest.MonkeyPatch, wanted: bool, cores: int) -> None:
    monkeypatch.setattr(stopping, "installed", lambda: True)
    monkeypatch.setattr(module, "_cores", lambda: cores)
    monkeypatch.setattr(module.os, "fork", lambda: pytest.fail("forked"))
    with second_process(wanted) as second:
        assert second is None


@linux
def test_without_room_for_another_process_there_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    def full() -> int:
        raise OSError

    monkeypatch.setattr(stopping, "installed", lambda: True)
    monkeypatch.setattr(module, "_cores", lambda: 2)
    monkeypatch.setattr(module.os, "fork", full)
    with second_process() as second:
        assert second is None


def test_what_settles_is_what_the_run_holds(monkeypatch: pytest.MonkeyPatch) -> None:
    """The events and rows that are followed are the first of the run's, in order."""
    monkeypatch.setattr("watchsim.simulation.runner.EVENTS", 20)
    monkeypatch.setattr("watchsim.simulation.runner.ROWS", 100)
    told = []
    run = simulate(load(profiles_dir() / "bench_lever"), 0.3, follow=lambda *values: told.append(values))
    assert len(told) > 5 and all(pairs is run.pairs for pairs, _, _ in told)
    events = np.concatenate([events for _, events, _ in told])
    assert len(events) > 50 and np.array_equal(events, run.events[: len(events)])
    for column, whole in enumerate((run.t, run.q, run.u, run.a)):
        rows = np.concatenate([rows[column] for _, _, rows in told])
        assert len(rows) > 50 and np.array_equal(rows, whole[: len(rows)])
