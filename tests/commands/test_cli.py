"""Does the command line keep its names, outputs and exit statuses?"""

import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest
from interpreter import ROOT as COPY
from interpreter import python

from watchsim.cli import COMMANDS, main
from watchsim.commands.inputs import load_scene
from watchsim.results.folder import read_results
from watchsim.scene.load import load
from watchsim.studies.axes import axes_from_texts

ROOT = Path(__file__).resolve().parents[2]
LEVER = ROOT / "profiles" / "bench_lever" / "scene.toml"
SUMMARY_KEYS = [
    *("scene", "method", "tolerance", "simulated_s", "wall_s", "compile_s", "realtime_factor", "stop", "bodies", "impacts"),
    *("events", "lcp_failures", "worst_penetration_m", "energy", "amplitude_deg", "amplitude_deg_error", "period_s"),
    *("period_s_error", "rate_s_per_d", "rate_s_per_d_error", "beat_error_ms", "beat_error_ms_error", "expect", "versions"),
]


def test_help_names_every_command_and_loads_nothing_heavy() -> None:
    code = "import sys; from watchsim.cli import parser; print(parser().format_help()); print(sorted(sys.modules))"
    told = python(code)
    shown = " ".join(told.partition("options:")[0].split())
    lines = [f" {name} {import_module(f'watchsim.commands.{name}').HELP}" for name in COMMANDS]
    assert shown.endswith("COMMAND" + "".join(lines))
    loaded = told.splitlines()[-1]
    assert not [name for name in ("numpy", "numba", "matplotlib", "shapely", "ezdxf", "scipy") if f"'{name}'" in loaded]


def test_inspect_prints_the_fixed_names(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(ROOT / "profiles/bench_lever/wheel.dxf"), "--json"]) == 0
    seen = json.loads(capsys.readouterr().out)
    names = "file format units units_from extents_mm layers loops points fitted ignored findings lines arcs length_mm area_mm2"
    assert set(names.split()) <= set(seen)
    assert seen["units"] == "mm" and seen["units_from"] == "header"
    assert seen["lines"] == 45 and seen["arcs"] == 0


def test_inspect_writes_a_picture(tmp_path: Path) -> None:
    picture = tmp_path / "lever.png"
    assert main(["inspect", str(ROOT / "profiles/swiss_lever/lever.dxf"), "--png", str(picture)]) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_inspect_draws_no_picture_of_what_it_cannot_read(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(tmp_path / "lost.dxf"), "--png", str(tmp_path / "lost.png")]) == 2
    assert "there is no such file" in capsys.readouterr().out and not (tmp_path / "lost.png").exists()


def test_a_file_in_place_of_a_folder_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", str(ROOT / "profiles/swiss_lever"), "-o", str(tmp_path / "all.dxf")]) == 2
    assert "a folder is needed" in capsys.readouterr().err and not (tmp_path / "all.dxf").exists()


def test_a_dimension_of_a_design_goes_by_its_own_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """As `new --slots` and `improve slots=` call it; a scene without a design has none."""
    assert main(["new", "geneva", "-o", str(tmp_path / "a")]) == 0
    assert load_scene(str(tmp_path / "a"), ["slots=5"]).source == load_scene(str(tmp_path / "a"), ["design.slots=5"]).source
    assert load(tmp_path / "a").set("slots", 5).source["design"]["slots"] == "5"
    scene = load(tmp_path / "a")
    (axis,) = axes_from_texts(scene, ["slots=4,5"])
    assert axis.key == "design.slots"
    capsys.readouterr()
    assert main(["run", str(tmp_path / "a"), "--set", "slosts=5"]) == 2
    assert "unknown key" in capsys.readouterr().err
    assert main(["run", str(LEVER), "--set", "slots=5"]) == 2
    assert "unknown key" in capsys.readouterr().err


def test_an_assignment_without_its_option_is_put_right(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["run", str(LEVER), "--set", "torques.0.value=1 µN·m", "bodies.wheel.angle=1°"])
    assert '--set "bodies.wheel.angle=1°"' in capsys.readouterr().err


def test_one_unit_serves_both_ends_of_a_sweep() -> None:
    scene = load(LEVER)
    found = [axes_from_texts(scene, [f"torques.0.value={text}"]) for text in ("-0.8:-1.4 µN·m:3", "-0.8:-1.4:3 µN·m")]
    assert found[0] == found[1] and found[0][0].values == pytest.approx((-0.8e-6, -1.1e-6, -1.4e-6))


def test_check_counts_pairs_and_knows_the_frequency(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(LEVER), "--json"]) == 0
    seen = json.loads(capsys.readouterr().out)
    assert seen["theory"]["frequency_hz"] == pytest.approx(4.0, rel=1e-9)
    assert 0 < seen["pairs"]["typical"] < seen["pairs"]["reachable"] < seen["pairs"]["declared"]
    assert [entry["bodies"] for entry in seen["pairs"]["between"]] == [
        ["wheel", "lever"],
        ["lever", "balance"],
        ["lever", "banking"],
    ]


def test_an_overlap_at_the_start_is_an_error_with_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for drawing in LEVER.parent.glob("*.dxf"):
        (tmp_path / drawing.name).write_bytes(drawing.read_bytes())
    scene, pictures = tmp_path / "scene.toml", [tmp_path / "apart.png", tmp_path / "overlap.png"]
    text = LEVER.read_text(encoding="utf-8")
    scene.write_text(text, encoding="utf-8")
    assert main(["check", str(scene), "--png", str(pictures[0])]) == 0
    scene.write_text(text.replace('"2.886751346 mm"', '"2.8 mm"'), encoding="utf-8")
    assert main(["run", str(scene), "-o", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert "wheel and lever overlap by" in told and f"watchsim check {scene} --png" in told
    assert main(["check", str(scene), "--png", str(pictures[1])]) == 2
    red = [
        np.count_nonzero(np.abs(imageio.imread(picture).astype(int) - (208, 2, 27)).max(axis=2) < 30) for picture in pictures
    ]
    assert red[0] == 0 and red[1] > 30


def test_run_writes_a_results_folder_and_keeps_one_that_exists(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out"
    assert main(["run", str(LEVER), "--duration", "0.4 s", "-o", str(folder), "--json"]) in (0, 1)
    told = json.loads(capsys.readouterr().out)
    assert set(SUMMARY_KEYS) <= set(told)
    assert told["simulated_s"] == 0.4 and told["worst_penetration_m"] < 1e-9
    assert abs(told["energy"]["residual_relative"]) < 1e-8
    kept = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert kept["impacts"] == told["impacts"] > 20
    for name in ("scene.lock.toml", "trajectory.npz", "events.csv", "beats.csv", "phases.csv", "plots/kinematics.png"):
        assert (folder / name).exists(), name
    before = (folder / "trajectory.npz").read_bytes()
    assert main(["run", str(LEVER), "--duration", "0.1 s", "-o", str(folder)]) == 2
    assert "--force" in capsys.readouterr().err
    assert (folder / "trajectory.npz").read_bytes() == before


def test_plot_and_movie_of_a_results_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out"
    main(["run", str(LEVER), "--duration", "0.1 s", "--no-plots", "-o", str(folder)])
    options = ["--bodies", "lever", "--window", "0.055 s:0.07 s", "--format", "png,svg", "-o", str(tmp_path / "beat")]
    assert main(["plot", str(folder), *options]) == 0
    assert (tmp_path / "beat.png").exists() and (tmp_path / "beat.svg").exists()
    film = tmp_path / "beat.gif"
    assert main(["movie", str(folder), "--window", "0.06 s:0.062 s", "--speed", "1/100", "-o", str(film)]) == 0
    assert film.read_bytes().startswith(b"GIF8")
    assert main(["plot", str(folder), "--bodies", "leever"]) == 2
    assert "lever" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["run", "nowhere.toml"], "nowhere.toml"),
        (["inspect", "nowhere.dxf"], "nowhere.dxf"),
        (["check", "nowhere.toml"], "nowhere.toml"),
        (["plot", "nowhere"], "nowhere"),
        (["movie", "nowhere", "--speed", "0"], "--speed"),
        (["run", str(LEVER), "--duration", "5"], "--duration"),
        (["run", str(LEVER), "--duration", "-5 s"], "--duration"),
        (["run", str(LEVER), "--tol", "5"], "--tol"),
        (["run", str(LEVER), "--set", "contacts.0.friction=-1"], "contacts.0.friction"),
        (["run", str(LEVER), "--set", "contacts.0.frction=1"], "friction"),
        (["run", str(LEVER), "--set", "bodies.lever.position.1=2.7 mm"], "overlap"),
        (["inspect", str(LEVER)], "toml"),
    ],
)
def test_bad_input_is_exit_2_with_a_word_and_nothing_written(
    arguments: list[str], word: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    told = capsys.readouterr()
    assert word in told.err + told.out and "Traceback" not in told.err
    assert not list(tmp_path.iterdir())


def test_unknown_command_is_exit_2(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["tock"])
    assert stopped.value.code == 2
    assert 'there is no command "tock"' in capsys.readouterr().err


def test_interrupt_keeps_what_was_simulated(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import watchsim.commands.run as command

    class Impatient(command.Progress):
        def __call__(self, done: float, whole: float) -> None:
            if done > 0.1:
                raise KeyboardInterrupt

    monkeypatch.setattr(command, "Progress", Impatient)
    folder = tmp_path / "out"
    assert main(["run", str(LEVER), "--duration", "3600 s", "--no-plots", "-o", str(folder)]) == 130
    kept = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert 0.1 < kept["simulated_s"] < 3600.0


def test_a_resumed_run_is_the_run_that_never_stopped(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """0.2 s, then on to 0.4 s in the same folder: rows and events as of 0.4 s at once; another scene is refused."""
    half, whole = tmp_path / "half", tmp_path / "whole"
    run = ["run", str(LEVER), "--no-plots"]
    assert main([*run, "--duration", "0.2 s", "-o", str(half)]) == 0
    assert main([*run, "--set", "torques.0.value=-5 µN·m", "--resume", str(half), "--duration", "0.4 s"]) == 2
    assert "another scene" in capsys.readouterr().err
    assert main([*run, "--resume", str(half), "--duration", "0.4 s"]) == 0
    assert main([*run, "--duration", "0.4 s", "-o", str(whole)]) == 0
    assert (half / "events.csv").read_bytes() == (whole / "events.csv").read_bytes()
    one, other = (read_results(folder) for folder in (half, whole))
    assert np.array_equal(one.t, other.t) and np.array_equal(one.q, other.q)


def test_moreau_and_error_bars(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Both methods with error bars: each disc end lies as near the closed form as it says."""
    incline = str(ROOT / "profiles" / "incline")
    truth = 1.14671466467341916  # x after 1 s, see the scene file
    for options in (["--method", "moreau", "--step", "100 µs"], []):
        run = ["run", incline, "--duration", "1 s", "--error-bars", "--json", "--no-plots", "--force", *options]
        assert main([*run, "-o", str(tmp_path / "r")]) == 0
        told = json.loads(capsys.readouterr().out)
        disc = told["bodies"]["disc"]
        assert told["error_bars"]["complete"] is True
        assert told["method"] == ("moreau" if options else "pfeiffer-glocker")
        assert abs(disc["x_m"] - truth) <= 3.0 * disc["x_m_error"] + 1e-12
        assert disc["x_m_error"] < (1e-4 if options else 1e-9)
        assert told["worst_complementarity_residual"] < 1e-12
    assert main(["run", incline, "--step", "1 µs", "-o", str(tmp_path / "s")]) == 2
    assert "fixed step" in capsys.readouterr().err


def test_a_process_ends_with_the_status_of_its_command(tmp_path):
    def status(*words: str) -> int:
        return subprocess.run([sys.executable, "-m", "watchsim", *words], cwd=COPY, capture_output=True, check=False).returncode

    assert status("--version") == 0
    assert status("check", str(tmp_path / "nowhere")) == 2


def test_expectations_of_another_run_are_not_judged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    incline = str(ROOT / "profiles" / "incline")
    assert main(["run", incline, "--duration", "1 s", "--no-plots", "-o", str(tmp_path / "short")]) == 0
    said = [line for line in capsys.readouterr().out.splitlines() if "not checked" in line]
    assert said == ["  expected     2 numbers not checked: changed by --duration"]
    entries = json.loads((tmp_path / "short" / "summary.json").read_text(encoding="utf-8"))["expect"]
    assert entries and all(entry["ok"] is None for entry in entries)
    assert main(["run", incline, "--duration", "3 s", "--no-plots", "-o", str(tmp_path / "own")]) == 0
    assert main(["run", incline, "--resume", str(tmp_path / "short"), "--no-plots"]) == 0, "gone on to the scene's own end"
    for name in ("own", "short"):
        entries = json.loads((tmp_path / name / "summary.json").read_text(encoding="utf-8"))["expect"]
        assert entries and all(entry["ok"] is True for entry in entries)


@pytest.mark.parametrize("command", ["inspect", "check"])
@pytest.mark.parametrize(
    ("name", "words"),
    [("", "is a folder"), ("in.dxf", "must end in .png"), ("x.txt", "must end in .png"), ("same.png", "is the input itself")],
)
def test_a_picture_goes_nowhere_else(
    command: str, name: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Neither over the input, by its own or another name, nor into a file of another kind."""
    source = tmp_path / "in.dxf"
    source.write_bytes(before := (LEVER.parent / "wheel.dxf").read_bytes())
    (tmp_path / "same.png").symlink_to(source)
    assert main([command, str(source), "--png", str(tmp_path / name)]) == 2
    told = capsys.readouterr().err
    assert words in told and "Errno" not in told
    assert source.read_bytes() == before and sorted(path.name for path in tmp_path.iterdir()) == ["in.dxf", "same.png"]


def test_a_picture_makes_the_folders_above_it(tmp_path: Path) -> None:
    assert main(["inspect", str(LEVER.parent / "wheel.dxf"), "--png", str(tmp_path / "none" / "x.png")]) == 0
    assert (tmp_path / "none" / "x.png").is_file()


@pytest.mark.parametrize("command", [["bench", "--quick", "--scene", "incline"], ["verify"]])
def test_an_interrupt_is_no_result(
    command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from watchsim.simulation.runner import Run

    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Run, "_slices", stopped)
    monkeypatch.chdir(tmp_path)
    assert main(command) == 130
    assert capsys.readouterr().out == "" and not list(tmp_path.iterdir())


def test_what_is_no_drawing_gets_advice_and_no_measures(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "photo.dxf"
    picture.write_bytes(b"\x89PNG\r\n\x1a\n")
    cases = ((picture, "Save the drawing as DXF"), (tmp_path, "is a folder"), (tmp_path / "none.dxf", "there is no such file"))
    for path, words in cases:
        assert main(["inspect", str(path)]) == 2
        told = capsys.readouterr().out
        assert words in told and "units" not in told and "measure" not in told


def test_inspect_succeeds_where_there_is_something_to_read(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    opened = tmp_path / "open.svg"
    opened.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="9mm" height="9mm" viewBox="0 0 9 9"><path d="M1 1H5V5"/></svg>'
    )
    assert main(["inspect", str(opened), "--json"]) == 0
    assert [finding["severity"] for finding in json.loads(capsys.readouterr().out)["findings"]] == ["error"]


def test_a_body_without_weight_is_named_where_the_solver_gives_up(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    light = ["--set", "bodies.lever.inertia=1e-30 kg·m²"]
    assert main(["run", str(LEVER), "--duration", "0.1 s", "--no-plots", *light, "-o", str(tmp_path / "r")]) == 3
    assert "The inertia of lever, 1e-30 kg·m², is 1e+21 times smaller" in capsys.readouterr().err


def test_a_missing_folder_is_named_once(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", "nothere"]) == 2
    assert capsys.readouterr().err == "nothere: there is no such results folder\n"


def test_report_writes_a_page_or_says_why_not(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "run"
    assert main(["run", str(LEVER), "--duration", "0.3 s", "--no-plots", "--report", "-o", str(folder)]) == 0
    assert (folder / "report.html").read_text(encoding="utf-8").endswith("</html>\n")
    page = tmp_path / "watch.html"
    capsys.readouterr()
    assert main(["report", str(folder), "-o", str(page), "--window", "0.1 s:0.2 s"]) == 0
    assert capsys.readouterr().out.strip() == str(page) and page.is_file()
    for wrong in (["-o", str(tmp_path / "watch.pdf")], ["--window", "5 s:6 s"], ["--window", "0.2 s:0.1 s"]):
        assert main(["report", str(folder), *wrong]) == 2
        assert "Traceback" not in capsys.readouterr().err
    assert main(["report", str(tmp_path / "nothing")]) == 2
