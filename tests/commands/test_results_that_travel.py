"""Does a results folder hold all that it needs, wherever it goes and whatever becomes of the drawings?"""

import shutil
from pathlib import Path

import numpy as np
import pytest

from watchsim.cli import main
from watchsim.commands.console import BAD_INPUT, FINE
from watchsim.paths import profiles_dir
from watchsim.results.folder import kept_names, read_results, travelling
from watchsim.scene.load import load


@pytest.fixture
def moved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    """Results of a scene that no longer exists, in another place than they were written to."""
    scene = tmp_path / "desk" / "bench"
    shutil.copytree(profiles_dir() / "bench_lever", scene)
    assert main(["run", str(scene), "--duration", "0.3 s", "--no-plots", "-o", str(tmp_path / "desk" / "out")]) == FINE
    (tmp_path / "out.txt").write_text(capsys.readouterr().out, encoding="utf-8")
    (tmp_path / "post").mkdir()
    (tmp_path / "desk" / "out").rename(tmp_path / "post" / "received")
    shutil.rmtree(tmp_path / "desk")
    return tmp_path / "post" / "received"


def test_every_command_works_on_it(moved: Path, tmp_path: Path) -> None:
    assert main(["plot", str(moved), "-o", str(tmp_path / "a.png")]) == FINE
    assert main(["movie", str(moved), "--window", "0.1 s:0.11 s", "--size", "320x180", "-o", str(tmp_path / "a.gif")]) == FINE
    assert main(["export", str(moved), "--format", "dxf", "-o", str(tmp_path / "parts")]) == FINE
    assert main(["check", str(moved)]) == FINE
    assert (tmp_path / "a.png").stat().st_size > 10_000 and (tmp_path / "parts" / "lever.dxf").is_file()


def test_it_can_be_gone_on_from_without_a_scene(moved: Path, tmp_path: Path) -> None:
    assert main(["run", "--resume", str(moved), "--duration", "0.5 s", "--no-plots", "-o", str(tmp_path / "more")]) == FINE
    assert (
        main(["run", str(profiles_dir() / "bench_lever"), "--duration", "0.5 s", "--no-plots", "-o", str(tmp_path / "all")])
        == FINE
    )
    more, whole = read_results(tmp_path / "more"), read_results(tmp_path / "all")
    assert np.array_equal(more.t, whole.t) and np.array_equal(more.q, whole.q)
    assert main(["run", "--resume", str(moved), "--duration", "0.4 s", "--no-plots"]) == FINE  # in its own place
    assert read_results(moved).simulated == 0.4 and (moved / "drawings" / "lever.dxf").is_file()


def test_the_report_is_what_the_terminal_said(moved: Path) -> None:
    said = (moved.parent.parent / "out.txt").read_text(encoding="utf-8")
    report = (moved / "report.txt").read_text(encoding="utf-8")
    assert said.startswith(report) and said[len(report) :].startswith("Results: ")
    assert "amplitude" in report


def test_the_report_ends_with_the_timeline_of_the_last_oscillation(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["run", str(profiles_dir() / "bench_lever"), "--duration", "1 s", "--no-plots", "-o", str(out)]) == FINE
    said, _, _ = capsys.readouterr().out.partition("Results: ")
    report = (out / "report.txt").read_text(encoding="utf-8")
    assert report.startswith(said)
    assert report[len(said) :].startswith("\nTimeline, t = ")
    assert report.count("unlock ") == 4  # of two beats, in the tables of motion and of energy


def test_variants_of_one_edited_drawing_stand_side_by_side(tmp_path: Path) -> None:
    scene = tmp_path / "bench"
    shutil.copytree(profiles_dir() / "bench_lever", scene)
    run = ["run", str(scene), "--duration", "0.1 s", "--no-plots", "-o"]
    assert main([*run, str(tmp_path / "first")]) == FINE
    text = (scene / "banking.dxf").read_text(encoding="utf-8")
    (scene / "banking.dxf").write_text("999\nedited\n" + text, encoding="utf-8")
    assert main([*run, str(tmp_path / "second")]) == FINE
    first, second = (read_results(tmp_path / name) for name in ("first", "second"))
    assert first.scene == second.scene and first.scene.drawings != second.scene.drawings
    assert first.scene.drawings["drawings/banking.dxf"].decode() == text


def test_a_drawing_that_was_tampered_with_in_the_folder_is_noticed(moved: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with (moved / "drawings" / "lever.dxf").open("ab") as file:
        file.write(b"\n")
    assert main(["plot", str(moved)]) == BAD_INPUT
    assert "the drawing was changed after this scene was locked" in capsys.readouterr().err


def test_what_is_kept_is_what_was_read_not_what_lies_there_now(tmp_path: Path) -> None:
    scene_folder = tmp_path / "bench"
    shutil.copytree(profiles_dir() / "bench_lever", scene_folder)
    before = (scene_folder / "lever.dxf").read_bytes()
    scene = load(scene_folder)
    (scene_folder / "lever.dxf").write_text("edited while the run went on", encoding="utf-8")
    assert travelling(scene)["drawings/lever.dxf"] == before


def test_new_results_replace_old_drawings_but_nobody_elses(tmp_path: Path) -> None:
    scene = tmp_path / "bench"
    shutil.copytree(profiles_dir() / "bench_lever", scene)
    run = ["run", str(scene), "--duration", "0.01 s", "--no-plots", "--force", "-o", str(tmp_path / "out")]
    assert main(run) == FINE
    drawings = tmp_path / "out" / "drawings"
    (drawings / "mine.dxf").write_text("mine", encoding="utf-8")
    (scene / "lever.dxf").rename(scene / "fork.dxf")
    text = (scene / "scene.toml").read_text(encoding="utf-8")
    (scene / "scene.toml").write_text(text.replace("lever.dxf", "fork.dxf"), encoding="utf-8")
    assert main(run) == FINE
    names = {path.name for path in drawings.iterdir()}
    assert {"fork.dxf", "mine.dxf"} < names and "lever.dxf" not in names
    assert load(tmp_path / "out").drawings["drawings/fork.dxf"] == (scene / "fork.dxf").read_bytes()


def test_different_drawings_of_one_name_get_names_of_their_own(tmp_path: Path) -> None:
    text = "[scene]\nschema = 1\n"
    for folder, other in (("one", "banking"), ("two", "lever"), ("three", "banking")):
        (tmp_path / folder).mkdir()
        shutil.copy(profiles_dir() / "bench_lever" / f"{other}.dxf", tmp_path / folder / "part.dxf")
        text += f'[bodies.{folder}]\ndrawing = "{folder}/part.dxf"\nmotion = "fixed"\n'
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    scene = load(tmp_path)
    names = kept_names(scene)
    assert names == {
        "one/part.dxf": "drawings/part.dxf",
        "two/part.dxf": "drawings/part_2.dxf",
        "three/part.dxf": "drawings/part.dxf",
    }
    place = tmp_path / "results"
    for name, content in travelling(scene).items():
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_bytes(content.encode() if isinstance(content, str) else content)
    assert load(place) == scene


def test_a_run_without_scene_or_results_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run"]) == BAD_INPUT
    assert "name a scene file" in capsys.readouterr().err


def test_a_folder_without_a_scene_says_what_it_lacks(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(tmp_path)]) == BAD_INPUT
    assert "neither scene.toml nor scene.lock.toml is in it" in capsys.readouterr().err
