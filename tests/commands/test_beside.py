"""Does a run leave the same files with one core and with more, whatever becomes of the copy that draws its plots?"""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from interpreter import ROOT

from watchsim.commands.beside import Meanwhile, can_copy
from watchsim.paths import profiles_dir
from watchsim.results.tables import EventLines, write_events
from watchsim.scene.load import load
from watchsim.simulation.simulate import simulate

SAME = ("events.csv", "beats.csv", "phases.csv", "plots/kinematics.png", "plots/last_beats.png")
COMMAND = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where the tests run in the background
case, *sys.argv[1:] = sys.argv[1:]
os.sched_getaffinity = lambda _: {0} if case == "one core" else {0, 1}
from watchsim.render import kinematics_plot
write, first = kinematics_plot.write_png, os.getpid()
def write_png(*what):
    print("here" if os.getpid() == first else "beside", flush=True)
    if os.getpid() != first:
        if case == "killed":
            os.kill(os.getpid(), signal.SIGKILL)
        if case == "fails":
            raise ValueError
        if case == "waits":
            open(os.environ["CHILD"], "w").write(str(os.getpid()))
            signal.pause()
    write(*what)
kinematics_plot.write_png = write_png
def full():
    raise OSError
if case == "no room":
    os.fork = full
from watchsim.process import process
process()
"""
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are copied on Linux only")


def started(case: str, folder: Path, duration: str = "0.3 s") -> subprocess.Popen[str]:
    args = ["run", str(profiles_dir() / "swiss_lever"), "--duration", duration, "--record", "all", "-o", str(folder)]
    around = {**os.environ, "PYTHONPATH": str(ROOT), "CHILD": f"{folder}.child"}
    command = [sys.executable, "-c", COMMAND, case, *args]
    return subprocess.Popen(command, env=around, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def contents(folder: Path) -> dict[str, bytes]:
    return {name: (folder / name).read_bytes() for name in SAME}


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    folder = tmp_path_factory.mktemp("alone") / "run"
    out, errors = started("one core", folder).communicate()
    assert out.splitlines().count("here") == 2, errors
    return contents(folder)


@pytest.mark.parametrize("case", ["two cores", "killed", "fails", "no room"])
def test_the_same_files_whatever_becomes_of_the_copy(case: str, alone: dict[str, bytes], tmp_path: Path) -> None:
    process = started(case, tmp_path / "run")
    out, errors = process.communicate()
    assert (process.returncode, errors) == (0, "")
    assert out.splitlines().count("here") == (0 if case == "two cores" else 2)
    assert contents(tmp_path / "run") == alone


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_the_copy_goes_with_the_run(number: signal.Signals, tmp_path: Path) -> None:
    """Ctrl-C reaches both; a second one is not waited for by either."""
    process = started("waits", tmp_path / "run")
    note = tmp_path / "run.child"
    while not (note.exists() and note.read_text()):
        assert process.poll() is None
        time.sleep(0.02)
    child = int(note.read_text())
    for _ in range(1 if number == signal.SIGKILL else 2):
        os.kill(child, number) if number == signal.SIGINT else None
        process.send_signal(number)
        time.sleep(0.2)
    _, errors = process.communicate(timeout=20)
    assert "Traceback" not in errors and process.returncode != 0
    for _ in range(100):
        if not Path(f"/proc/{child}/cmdline").exists() or not Path(f"/proc/{child}/cmdline").read_bytes():
            return  # gone, or waiting to be reaped by whoever inherited it
        time.sleep(0.05)
    pytest.fail("the copy goes on")


def test_other_peoples_processes_are_not_copied() -> None:
    assert not can_copy()


def test_events_made_into_text_meanwhile_are_the_same_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With buffers so small that they are emptied many times; what is followed is what the run holds."""
    monkeypatch.setattr("watchsim.simulation.runner.EVENTS", 20)
    monkeypatch.setattr("watchsim.simulation.runner.ROWS", 100)
    scene = load(profiles_dir() / "bench_lever")
    meanwhile, told = Meanwhile(scene, tmp_path), []

    def follow(*values: object) -> None:
        told.append(values)
        meanwhile.follow(*values)

    run = simulate(scene, 0.3, progress=meanwhile.progress, follow=follow)
    lines, _ = meanwhile.end()
    assert lines is not None and 50 < lines.rows <= len(run.events)
    lines.settle(run)
    write_events(run, tmp_path / "whole.csv")
    for name in ("begun.csv", "again.csv"):  # in another place, where the first could not be written to
        lines.write(run, tmp_path / name)
        assert (tmp_path / name).read_bytes() == (tmp_path / "whole.csv").read_bytes()
    assert len(told) > 5 and all(pairs is run.pairs for pairs, _, _ in told)
    for column, whole in enumerate((run.t, run.q, run.u, run.a)):
        rows = np.concatenate([rows[column] for _, _, rows in told])
        assert len(rows) > 50 and np.array_equal(rows, whole[: len(rows)])


def test_events_that_the_disk_did_not_take_are_written_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = simulate(load(profiles_dir() / "bench_lever"), 0.1)
    lines = EventLines(run.scene, run.pairs, tmp_path)

    def full(_: int) -> None:
        raise OSError

    monkeypatch.setattr("watchsim.results.tables.os.fsync", full)
    lines.settle(run)
    lines.write(run, tmp_path / "begun.csv")
    write_events(run, tmp_path / "whole.csv")
    assert (tmp_path / "begun.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()


def test_what_fails_meanwhile_is_left_to_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object) -> None:
        raise OSError

    monkeypatch.setattr(EventLines, "add", fails)
    meanwhile = Meanwhile(load(profiles_dir() / "bench_lever"), tmp_path)
    meanwhile.follow([], np.zeros(1))
    assert meanwhile.end() == (None, None)
