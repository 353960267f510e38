"""Is refused at once what cannot be written at the end, and saved elsewhere what cannot be written all the same?"""

import dataclasses
import errno
import io
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from interpreter import ROOT
from storage.disk_faults import Disk, watched

from watchsim.cli import main
from watchsim.commands import run as run_command
from watchsim.commands import write as write_run
from watchsim.commands.inputs import claimed
from watchsim.paths import profiles_dir
from watchsim.results import folder as write_results
from watchsim.results.folder import read_results
from watchsim.simulation.runner import Run
from watchsim.simulation.state import Stop

LEVER = str(profiles_dir() / "bench_lever")
SHORT = ["run", LEVER, "--duration", "0.05 s", "--no-plots"]


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the command is started from."""
    place = tmp_path / "elsewhere"
    place.mkdir()
    monkeypatch.chdir(place)
    return place


@pytest.mark.parametrize("name", ["file/out", "dangling", "x" * 256])
def test_nothing_is_simulated_for_a_place_that_cannot_be_written(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def never(*_: object) -> None:
        raise AssertionError("simulated")

    monkeypatch.setattr(Run, "__init__", never)
    (tmp_path / "file").write_text("")
    (tmp_path / "dangling").symlink_to(tmp_path / "gone")
    assert main([*SHORT, "-o", str(tmp_path / name)]) == 2
    assert str(tmp_path / name)[:40] in capsys.readouterr().err


def saved(said: str) -> Path:
    found = re.search(r"(?:saved, without pictures, in|kept in) (\S+)", said)
    assert found, said
    return Path(found[1])


def test_results_go_to_a_second_place(tmp_path: Path, elsewhere: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The disk fills up while it computes: every write and rename there fails from then on."""
    target = tmp_path / "disk" / "out"
    target.parent.mkdir()
    actions = 12  # what securing the place does
    with watched(Disk(target.parent, actions, count=10**6)) as disk:
        assert main([*SHORT, "-o", str(target)]) == 2
    assert disk.failed
    said = capsys.readouterr().err
    assert "No space left on device; nothing was changed" in said
    assert saved(said).parent == elsewhere and read_results(saved(said)).simulated == 0.05
    assert (saved(said) / "summary.json").is_file() and not target.exists()


def test_a_folder_made_meanwhile_is_left_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "out"
    original = write_run.write

    def late(*args: object) -> object:
        target.mkdir()
        (target / "thesis.txt").write_text("years of work")
        return original(*args)  # type: ignore[arg-type]

    monkeypatch.setattr("watchsim.commands.run.write", late)
    assert main([*SHORT, "-o", str(target)]) == 2
    assert read_results(saved(capsys.readouterr().err)).simulated == 0.05
    assert [path.name for path in target.iterdir()] == ["thesis.txt"]


@pytest.mark.parametrize("home", ["watchsim.analysis.summary.summary", "watchsim.results.folder.write_events"])
def test_a_fault_in_what_is_made_of_it_does_not_cost_the_motion(
    home: str, tmp_path: Path, elsewhere: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError("a slip")

    monkeypatch.setattr(home, broken)
    assert main([*SHORT, "-o", str(tmp_path / "out")]) == 4
    said = capsys.readouterr().err
    assert read_results(saved(said)).simulated == 0.05
    (report,) = elsewhere.glob("watchsim-fault-*.txt")
    assert str(report) in said and "Traceback" not in said
    assert "ZeroDivisionError: a slip" in report.read_text() and "watchsim run" in report.read_text()


def test_drawings_may_be_gone_at_the_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import shutil

    scene = tmp_path / "scene"
    shutil.copytree(LEVER, scene)
    original = Run.to_the_end

    def gone(self: Run, *args: object) -> object:
        shutil.rmtree(scene)
        return original(self, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(Run, "to_the_end", gone)
    assert main(["run", str(scene), "--duration", "0.05 s", "--no-plots", "-o", str(tmp_path / "out")]) == 0
    assert read_results(tmp_path / "out").simulated == 0.05
    assert (tmp_path / "out" / "drawings" / "lever.dxf").read_bytes() == (Path(LEVER) / "lever.dxf").read_bytes()


def test_a_symlinked_results_folder_is_resumed_behind_its_link(tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    link = tmp_path / "out"
    assert main([*SHORT, "-o", str(tmp_path / "other" / "there")]) == 0
    link.symlink_to(tmp_path / "other" / "there")
    assert main(["run", LEVER, "--resume", str(link), "--duration", "0.1 s", "--no-plots"]) == 0
    assert link.is_symlink() and read_results(link).simulated == 0.1
    assert main([*SHORT, "-o", str(link), "--force"]) == 0
    assert link.is_symlink() and read_results(tmp_path / "other" / "there").simulated == 0.05


def test_memory_that_runs_out_is_no_fault(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    original = Run.flush

    def full(self: Run) -> None:
        if self.saved is None and not hasattr(self, "_failed"):
            self._failed = True  # type: ignore[attr-defined]
            raise MemoryError
        original(self)

    monkeypatch.setattr(Run, "flush", full)
    assert main(["run", LEVER, "--duration", "0.3 s", "--no-plots", "-o", str(tmp_path / "out")]) == 3
    assert "no memory left" in capsys.readouterr().err
    assert read_results(tmp_path / "out").simulated > 0.0


@pytest.mark.skipif(sys.platform == "win32", reason="pipes of Unix")
def test_a_closed_pipe_is_silent(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    reading, writing = os.pipe()
    os.close(reading)
    command = [sys.executable, "-m", "watchsim", *SHORT, "-o", str(tmp_path / "out")]
    done = subprocess.run(command, env=environment, stdout=writing, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writing)
    assert (done.returncode, done.stderr) == (0, "") and (tmp_path / "out" / "summary.json").is_file()


def test_picture_files_are_whole_or_as_they_were(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    main([*SHORT, "-o", str(tmp_path / "out")])
    plot = tmp_path / "plot.png"
    plot.write_bytes(b"before")

    def half(path: Path | io.BytesIO, *_: object, **__: object) -> None:
        if not isinstance(path, io.BytesIO):
            Path(path).write_bytes(b"half")
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("matplotlib.figure.Figure.savefig", lambda self, path, **_: half(path))
    monkeypatch.setattr("imageio.v3.imwrite", half)
    for arguments in (
        ["plot", str(tmp_path / "out"), "-o", str(plot)],
        ["inspect", f"{LEVER}/wheel.dxf", "--png", str(plot)],
        ["check", LEVER, "--png", str(plot)],
    ):
        assert main(arguments) == 2
        assert "nothing was changed" in capsys.readouterr().err
        assert plot.read_bytes() == b"before" and sorted(path.name for path in tmp_path.iterdir()) == [
            "elsewhere",
            "out",
            "plot.png",
        ]


def test_fallback_names_what_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Where no second place can be written either, all places are named."""

    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(write_results, "write_trajectory", full)
    assert main([*SHORT, "-o", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err.count("No space left on device") >= 2


def test_a_sound_that_cannot_be_written_says_so_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each writing of the file itself fails once; no destructor complains besides."""
    unheard: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", unheard.append)
    out = tmp_path / "out"
    assert main(["run", LEVER, "--duration", "0.2 s", "--no-plots", "-o", str(out)]) == 0
    with watched(Disk(tmp_path)) as disk:
        assert main(["sound", str(out)]) == 0
    (out / "tick.wav").unlink()
    actions = [
        number for number, (name, path, *_) in enumerate(disk.log, 1) if name in ("open", "write") and path.endswith(".wav")
    ]
    assert actions
    for number in actions:
        with watched(Disk(tmp_path, number)):
            assert main(["sound", str(out)]) == 2
        assert "could not write" in capsys.readouterr().err and not (out / "tick.wav").exists()
    assert not unheard


def test_a_study_whose_table_cannot_be_written_is_saved_elsewhere(
    tmp_path: Path, elsewhere: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The disk fills up while the points are computed; no table of the earlier study stands beside its rows."""
    from watchsim.studies import sweep as parameter_sweep

    asked = ["sweep", LEVER, "contacts.0.friction=0.1,0.12", "--duration", "1.5 s", "--workers", "1", "--no-plots"]
    target = tmp_path / "disk" / "study"
    target.parent.mkdir()
    assert main([*asked, "-o", str(target)]) == 0
    before = (target / "sweep.csv").read_bytes()
    original = parameter_sweep.computed

    def full(*args: object, **options: object) -> None:
        original(*args, **options)  # type: ignore[arg-type]
        disk.failing, disk.count = len(disk.log) + 1, 10**6

    monkeypatch.setattr(parameter_sweep, "computed", full)
    with watched(Disk(target.parent)) as disk:
        assert main([*asked, "-o", str(target), "--force"]) == 2
    found = re.search(r"saved, without plots, in (\S+)", capsys.readouterr().err)
    assert found and Path(found[1]).parent == elsewhere
    assert (Path(found[1]) / "sweep.csv").read_bytes() == before and not (target / "sweep.csv").exists()


def test_what_was_made_of_a_run_outlives_its_resume(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out"
    assert main([*SHORT, "-o", str(folder)]) == 0
    (folder / "plots").mkdir()
    for name in ("movie.mp4", "report.html", "plots/tape.png"):
        (folder / name).write_text(name)
    resume = ["run", LEVER, "--no-plots", "--resume", str(folder)]
    assert main([*resume, "--duration", "0.1 s"]) == 0
    assert "movie.mp4, plots/tape.png, report.html" in capsys.readouterr().err
    assert (folder / "movie.mp4").read_text() == "movie.mp4" and (folder / "plots" / "tape.png").is_file()
    assert read_results(folder).simulated == pytest.approx(0.1)
    assert main([*resume, "--duration", "0.12 s", "--force"]) == 0
    assert not (folder / "movie.mp4").exists() and not (folder / "report.html").exists()


def test_two_do_not_write_into_one_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("fcntl", reason="locks of folders")
    folder = tmp_path / "out"
    assert main([*SHORT, "-o", str(folder)]) == 0
    more = ["run", LEVER, "--no-plots", "--resume", str(folder), "--duration", "0.1 s"]
    with claimed(folder):
        assert main(more) == 2
        assert "another process is writing" in capsys.readouterr().err
    assert main(more) == 0


def test_a_part_does_not_replace_the_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "out"
    assert main([*SHORT, "-o", str(folder)]) == 0
    before = (folder / "summary.json").read_bytes()
    simulated = run_command.simulate_with_progress

    def interrupted(*args: object, **more: object) -> object:
        trajectory, *more_of_it = simulated(*args, **more)  # type: ignore[arg-type]
        return dataclasses.replace(trajectory, stop=Stop.INTERRUPTED), *more_of_it

    monkeypatch.setattr(run_command, "simulate_with_progress", interrupted)
    for name in ("out-interrupted", "out-interrupted-2"):
        assert main([*SHORT, "-o", str(folder), "--force"]) == 130
        assert (folder / "summary.json").read_bytes() == before
        assert read_results(tmp_path / name).stop == Stop.INTERRUPTED
        said = capsys.readouterr()
        assert f"goes to {tmp_path / name}" in said.err and f"Results: {tmp_path / name}" in said.out


LOOSE = ["--set", 'tolerances."contacts.0.friction".limits=±0.03']


@pytest.mark.parametrize("study", [["tolerance", *LOOSE], ["sweep", "contacts.0.friction=0.1,0.12"]])
def test_a_study_goes_on_only_in_the_folder_of_a_study(
    study: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Was a study written among the files of another command: over scene.toml of `improve`, had it drawn the same names."""
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "scene.toml").write_text("mine")
    assert main([study[0], LEVER, *study[1:], "-o", str(folder), "--resume"]) == 2
    assert "this folder holds no study" in capsys.readouterr().err
    assert [(path.name, path.read_text()) for path in folder.iterdir()] == [("scene.toml", "mine")]
    (folder / "scene.toml").rename(folder / ".hidden")  # what a system leaves in every folder is nobody's result
    assert (
        main(["sweep", LEVER, "contacts.0.friction=0.1", "--duration", "1.5 s", "--no-plots", "-o", str(folder), "--resume"])
        == 0
    )
