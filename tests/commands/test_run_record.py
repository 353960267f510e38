"""Does the command line choose what is kept, and do the numbers stay?"""

import json
from pathlib import Path

import numpy as np
import pytest

from watchsim.cli import main
from watchsim.commands.console import BAD_INPUT, FINE, GAVE_UP
from watchsim.commands.inputs import load_scene, record_size, room_for
from watchsim.paths import profiles_dir
from watchsim.render.opening import last_beats
from watchsim.results.folder import read_results
from watchsim.simulation.simulate import simulate
from watchsim.storage.destination import LEAST_ROOM

SCENE = str(profiles_dir() / "bench_lever")


def test_a_long_run_says_what_it_records(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """The estimate holds for what is measured, within a factor of two; so much room the disk must have."""
    scene = load_scene(SCENE)
    run = simulate(scene, 3.0)
    made = run.events.nbytes + 8 * len(run.t) * (1 + 3 * run.q.shape[1])
    whole = scene.set("run.record", "all")
    assert 0.5 < record_size(whole, 3.0) / made < 2.0
    assert record_size(whole, 30.0) == pytest.approx(10.0 * record_size(whole, 3.0))
    assert room_for(whole, 5.0, tmp_path) == LEAST_ROOM and capsys.readouterr().err == ""
    assert room_for(whole, 3600.0, tmp_path) > 2.0 * record_size(whole, 3600.0) > 1e9
    assert f"in files beside {tmp_path}" in capsys.readouterr().err
    less = {what: record_size(scene.set("run.record", what), 3600.0) for what in ("events", "every 10", "statistics")}
    assert less["statistics"] == 0.0 < less["events"] < record_size(whole, 3600.0)
    assert less["every 10"] - less["events"] == pytest.approx(0.1 * (record_size(whole, 3600.0) - less["events"]))
    window = scene.set("run.record", [["10 s", "13 s"], "statistics"])
    assert record_size(window, 3600.0) == pytest.approx(record_size(whole, 3.0))


def test_a_run_in_files_is_the_run_in_memory(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Every file of the results, but for the times on the clock; nothing is left beside them."""
    folders = {name: tmp_path / name / "run" for name in ("memory", "files")}
    for name, folder in folders.items():
        if name == "files":
            monkeypatch.setattr("watchsim.storage.columns.IN_MEMORY", 1e4)
        folder.parent.mkdir()
        assert main(["run", SCENE, "--duration", "1 s", "--record", "all", "--no-plots", "-o", str(folder)]) == FINE
        assert main(["run", SCENE, "--duration", "1.5 s", "--resume", str(folder)]) == FINE
        assert [path.name for path in folder.parent.iterdir()] == ["run"]
    runs = [read_results(folder) for folder in folders.values()]
    for column in ("t", "q", "u", "a", "events"):
        first, second = (getattr(run, column) for run in runs)
        assert len(first) > 300 and first.tobytes() == second.tobytes()
    for table in ("events.csv", "beats.csv", "phases.csv", "plots/kinematics.png", "plots/last_beats.png"):
        first, second = ((folder / table).read_bytes() for folder in folders.values())
        assert first == second, table


def summary_of(folder: Path, *options: str) -> dict[str, object]:
    assert main(["run", SCENE, "--duration", "5 s", "--no-plots", "-o", str(folder), *options]) == FINE
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def test_statistics_with_a_window(tmp_path) -> None:
    whole = summary_of(tmp_path / "whole")
    few = summary_of(tmp_path / "few", "--record", "statistics", "--record", "1 s:1.5 s")
    assert (whole["kept"], few["kept"]) == ("all", "statistics")
    for name in ("amplitude_deg", "rate_s_per_d", "beat_error_ms", "energy", "missed_beats", "events_by_kind", "bodies"):
        assert few[name] == whole[name], name
    assert not (tmp_path / "few" / "plots").exists()
    with np.load(tmp_path / "few" / "trajectory.npz") as kept:
        inside = (kept["t"] >= 1.0) & (kept["t"] <= 1.5)
        assert inside.sum() > 100
        assert np.sum(~inside & (kept["t"] < 2.0)) <= 3  # those next to the window and to the last seconds
    # The locked scene says what was kept, and the folder can be gone on from.
    assert '"statistics"' in (tmp_path / "few" / "scene.lock.toml").read_text(encoding="utf-8")
    more = ["run", str(tmp_path / "few" / "scene.lock.toml"), "--resume", str(tmp_path / "few"), "--duration", "6 s"]
    assert main([*more, "--no-plots", "-o", str(tmp_path / "more")]) == FINE
    told = json.loads((tmp_path / "more" / "summary.json").read_text(encoding="utf-8"))
    assert told["whole_run"]["beats"] == few["whole_run"]["beats"] + 8


@pytest.mark.parametrize(
    ("what", "words"),
    [
        ("statistic", 'write all, events, statistics, "every 10", or a window such as "179 s:180 s"'),
        ("0.5 s", "or a window such as"),
        ("every 0", "or a window such as"),
        ("2 s:1 s", "the second time must be later"),
        ("1:2", "a bare number needs a unit"),
        ("1 s:2 s:3 s", "write two times"),
    ],
)
def test_what_cannot_be_kept(what: str, words: str, capsys, tmp_path) -> None:
    assert main(["run", SCENE, "--record", what, "-o", str(tmp_path / "x")]) == BAD_INPUT
    told = capsys.readouterr().err
    assert f'--record "{what}": ' in told and words in told
    assert main(["run", SCENE, "--record", "all", "--record", "events", "-o", str(tmp_path / "x")]) == BAD_INPUT
    assert "all and events exclude each other" in capsys.readouterr().err


def test_what_has_no_beats_has_no_picture_of_them(tmp_path) -> None:
    """A follower whose spring presses it onto its cam."""
    assert main(["run", str(profiles_dir() / "cam"), "--duration", "1 s", "-o", str(tmp_path / "cam")]) == FINE
    assert {path.name for path in (tmp_path / "cam" / "plots").iterdir()} == {"kinematics.png", "last_stretch.png"}


def test_windows_of_any_kind_cost_no_run(capsys, tmp_path) -> None:
    """Two windows, one between two rows, and one after the end."""
    run = ["run", SCENE, "--duration", "0.5 s"]
    two = ["--record", "0.1 s:0.2 s", "--record", "0.3 s:0.4 s", "-o", str(tmp_path / "two")]
    assert main([*run, *two]) == FINE
    assert {path.name for path in (tmp_path / "two" / "plots").iterdir()} == {"kinematics.png", "last_beats.png"}
    assert last_beats(read_results(tmp_path / "two")) == (pytest.approx(0.3), pytest.approx(0.4))
    run.append("--no-plots")
    assert main([*run, "--record", "0.21 s:0.2101 s", "-o", str(tmp_path / "short")]) == FINE
    kept = read_results(tmp_path / "short").t
    assert len(kept) < 30 and kept[0] <= 0.21 and kept[-1] >= 0.2101
    capsys.readouterr()
    assert main([*run, "--record", "5 s:6 s", "-o", str(tmp_path / "late")]) == BAD_INPUT
    assert "the run ends at 0.5 s" in capsys.readouterr().err
    assert not (tmp_path / "late").exists()
    assert main([*run, "--set", 'run.record=["5.8 s", "6 s"]', "--report", "-o", str(tmp_path / "moved")]) == FINE
    assert "recorded is 0.3 s to 0.5 s instead" in capsys.readouterr().err
    assert "0.5 s simulated; " in (tmp_path / "moved" / "report.html").read_text(encoding="utf-8")
    moved = read_results(tmp_path / "moved")
    assert moved.t[0] <= 0.3 < moved.t[2] and moved.t[-1] == 0.5


def test_a_plot_that_fails_costs_a_line_only(capsys, tmp_path, monkeypatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("no ink")

    monkeypatch.setattr("watchsim.render.kinematics_plot.write_png", fail)
    assert main(["run", SCENE, "--duration", "0.1 s", "-o", str(tmp_path / "r")]) == FINE
    assert "kinematics.png could not be drawn: no ink" in capsys.readouterr().err
    assert (tmp_path / "r" / "trajectory.npz").is_file() and not list((tmp_path / "r" / "plots").iterdir())


# Does a run that ends in a jam say so, with status 3, and no fault of the program behind it?

JAM = """
[bodies.pusher]
circle = "2 mm"
motion = "driven"
velocity = "90 °/s"
pivot = ["-5 mm", "0 mm"]
[bodies.lever]
polygon = [["-1 mm", "-1 mm"], ["9 mm", "-1 mm"], ["9 mm", "1 mm"], ["-1 mm", "1 mm"]]
position = ["0 mm", "7 mm"]
inertia = "1 g·cm²"
[bodies.bank]
circle = "1 mm"
position = ["6 mm", "9.5 mm"]
motion = "fixed"
[[contacts]]
between = ["pusher", "lever"]
[[contacts]]
between = ["lever", "bank"]
[run]
duration = "2 s"
"""


def test_a_driven_body_that_jams_another_is_named_in_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "scene.toml").write_text(JAM, encoding="utf-8")
    assert main(["run", str(tmp_path), "--no-plots", "-o", str(tmp_path / "run")]) == GAVE_UP
    said = capsys.readouterr().err
    assert "pusher, which is driven, leaves lever no way out" in said
    assert "This is a jam" in said
    assert "complementarity" not in said
    assert "fault of watchsim" not in said
