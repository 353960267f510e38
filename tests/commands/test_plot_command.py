"""Does watchsim plot write the kinds of plots that were asked for, and say why one cannot be drawn?"""

import json
import wave
from pathlib import Path

import imageio.v3 as iio
import pytest

from watchsim.cli import main
from watchsim.paths import profiles_dir


@pytest.fixture(scope="module")
def lever(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "lever"
    assert main(["run", str(profiles_dir() / "bench_lever"), "--duration", "0.8 s", "--no-plots", "-o", str(folder)]) == 0
    return folder


@pytest.fixture(scope="module")
def disc(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "disc"
    assert main(["run", str(profiles_dir() / "incline"), "--duration", "1 s", "--no-plots", "-o", str(folder)]) == 0
    return folder


def test_several_kinds_go_to_the_plots_of_the_run_or_to_a_folder(lever: Path, tmp_path: Path) -> None:
    assert main(["plot", str(lever), "--kind", "torque,energy", "--format", "svg,pdf"]) == 0
    assert sorted(path.name for path in (lever / "plots").iterdir()) == ["energy.pdf", "energy.svg", "torque.pdf", "torque.svg"]
    assert main(["plot", str(lever), "--kind", "timing,timing,phases", "-o", str(tmp_path / "own")]) == 0
    assert sorted(path.name for path in (tmp_path / "own").iterdir()) == ["phases.png", "timing.png"]


@pytest.mark.parametrize(("width", "dots"), [("170 mm", 1338), ("85 mm", 669)])
def test_pictures_are_as_wide_as_print_asks(lever: Path, tmp_path: Path, width: str, dots: int) -> None:
    path = tmp_path / "torque.png"
    assert main(["plot", str(lever), "--kind", "torque", "--width", width, "-o", str(path)]) == 0
    assert abs(iio.improps(path).shape[1] - dots) <= 1  # 200 dots an inch


def test_a_dark_plot_has_dark_ground(lever: Path, tmp_path: Path) -> None:
    light, dark = tmp_path / "light.png", tmp_path / "dark.png"
    assert main(["plot", str(lever), "--kind", "energy", "-o", str(light)]) == 0
    assert main(["plot", str(lever), "--kind", "energy", "--dark", "-o", str(dark)]) == 0
    means = [iio.imread(path)[..., :3].mean() for path in (light, dark)]
    assert means[0] > 220.0 and means[1] < 80.0


def test_short_forms_are_kinds(lever: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(lever), "--phases", "--tape", "-o", str(tmp_path / "both")]) == 0
    assert sorted(path.name for path in (tmp_path / "both").iterdir()) == ["phases.png", "tape.png"]
    assert "the account closes to" in capsys.readouterr().out


def test_all_leaves_out_what_a_run_does_not_have(disc: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(disc), "--kind", "all", "-o", str(tmp_path / "all")]) == 0
    assert sorted(path.name for path in (tmp_path / "all").iterdir()) == [
        *("energy.png", "forces.png", "kinematics.png", "phase-portrait.png", "sound.png", "wear.png")
    ]
    assert "No plot of torque: nothing in this scene swings" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--kind", "torqe"], "choose from kinematics, phases"),
        (["--kind", ","], "choose from kinematics, phases"),
        (["--kind", "torque"], "nothing in this scene swings"),
        (["--kind", "torque,tape"], "none of torque, tape can be drawn"),
        (["--kind", "energy,forces", "-o", "both.png"], "need a folder"),
        (["--kind", "forces", "--window", "2 s:3 s"], "was recorded"),
        (["--width", "5 m"], "mm wide"),
    ],
)
def test_what_cannot_be_drawn_is_said(disc: Path, options: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(disc), *options]) == 2
    assert told in capsys.readouterr().err
    assert not Path("both.png").exists()


# Does the command line say when a watch does not work, and let it be heard?

SWISS = str(profiles_dir() / "swiss_lever")


@pytest.fixture(scope="module")
def knocking(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "knocking"
    asked = ["run", SWISS, "--set", "torques.0.value=-10 µN·m", "--duration", "3 s", "--no-plots", "-o", str(folder)]
    assert main(asked) == 1
    return folder


def test_a_watch_that_knocks_is_no_good_result(knocking: Path) -> None:
    numbers = json.loads((knocking / "summary.json").read_text(encoding="utf-8"))
    assert numbers["verdict"] == "knocks" and numbers["verdict_message"].startswith("t = 0.6185 s  the watch knocks: ")
    about = numbers["verdict_details"]
    assert about["works"] is False and about["body"] == "balance" and about["torque_Nm"] == pytest.approx(-1e-5)
    assert about["pair"].startswith("balance.PIN arc") and about["t_s"] == pytest.approx(0.6185, abs=1e-4)
    lines = (knocking / "report.txt").read_text(encoding="utf-8").splitlines()
    assert next(line for line in lines if not line.startswith("Note")) == "Swiss lever, 4 Hz, 15 teeth"
    told = {line[2:14].strip(): line for line in lines if line.startswith("  ") and line[2] != " "}
    assert "the watch knocks" in told["verdict"]
    for label in ("amplitude", "rate", "beat error"):
        assert told[label].endswith(", while it knocks")


def test_what_has_not_settled_is_said_and_is_no_failure(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", SWISS, "--duration", "3 s", "--no-plots", "--json", "-o", str(tmp_path / "run")]) == 0
    told = capsys.readouterr()
    numbers = json.loads(told.out)
    assert numbers["verdict"] == "unsettled" and "on its way to about 279°" in numbers["verdict_message"]
    assert "does not work" not in told.err


def test_no_watch_no_verdict(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["run", str(profiles_dir() / "incline"), "--duration", "0.1 s", "--no-plots", "--json", "-o", str(tmp_path / "run")]
    assert main(asked) == 0
    numbers = json.loads(capsys.readouterr().out)
    assert [numbers[key] for key in ("verdict", "verdict_message", "verdict_details")] == [None, None, None]


def test_a_run_is_heard_for_as_long_as_is_asked(knocking: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sound", str(knocking)]) == 0
    assert capsys.readouterr().out.strip() == str(knocking / "tick.wav")
    target = tmp_path / "long.wav"
    assert main(["sound", str(knocking), "--duration", "7 s", "-o", str(target)]) == 0
    assert "oscillations are repeated" in capsys.readouterr().err
    for path, seconds in ((knocking / "tick.wav", 3), (target, 7)):
        with wave.open(str(path)) as file:
            assert file.getnframes() == seconds * 48000


def test_the_paper_of_a_run(knocking: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(knocking), "--tape"]) == 0
    assert (knocking / "plots" / "tape.png").read_bytes().startswith(b"\x89PNG")
    assert main(["plot", str(knocking), "--tape", "--window", "1 s:2 s", "-o", str(tmp_path / "paper.svg")]) == 0
    assert b"<svg" in (tmp_path / "paper.svg").read_bytes()
    capsys.readouterr()
    # What these commands wrote belongs to the results and goes with them.
    asked = ["run", SWISS, "--duration", "0.1 s", "--no-plots", "--force", "-o", str(knocking)]
    assert main(asked) == 0 and not (knocking / "tick.wav").exists() and not (knocking / "plots").exists()


@pytest.mark.parametrize(
    ("extra", "why"),
    [
        (["--duration", "13 h"], "up to 12 hours"),
        (["--duration", "60"], "needs a unit"),
        (["-o", "tick.mp3"], "ends in .wav"),
        (["-o", "/dev/null/tick.wav"], "/dev/null"),
    ],
)
def test_what_no_sound_can_be_is_refused(extra, why, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = tmp_path / "run"
    assert main(["run", SWISS, "--duration", "0.2 s", "--no-plots", "-o", str(run)]) == 0
    assert main(["sound", str(run), *extra]) == 2
    assert why in capsys.readouterr().err
    assert main(["sound", str(tmp_path / "nothing")]) == 2


def test_an_anchor_without_a_lift_angle_has_phases_by_its_geometry(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The same beats as where the scene names one; a click on its wheel has none, and is told what is missing."""
    tables = []
    assert main(["new", "recoil_anchor", "--drawings", "-o", str(tmp_path / "anchor")]) == 0
    scene = tmp_path / "anchor" / "scene.toml"
    for number in range(2):
        assert main(["run", str(scene), "--duration", "6 s", "--no-plots", "-o", str(tmp_path / f"run{number}")]) in (0, 1)
        assert ("Lift angle: 2.4°, as check measures it" in capsys.readouterr().err) == (number == 1)
        assert main(["report", str(tmp_path / f"run{number}")]) == 0
        assert "is not known: say so by" not in (tmp_path / f"run{number}" / "report.html").read_text(encoding="utf-8")
        capsys.readouterr()
        assert main(["plot", str(tmp_path / f"run{number}"), "--phases", "-o", str(tmp_path / f"{number}.png")]) == 0
        said = capsys.readouterr()
        tables.append([line for line in said.out.splitlines() if not line.endswith(".png")])
        assert ("Lift angle: 2.4°, as check measures it" in said.err) == (number == 1)
        text = scene.read_text(encoding="utf-8")
        scene.write_text(text.replace('[timegrapher]\nlift_angle = "2.0°"\n', ""), encoding="utf-8")
    assert tables[0] == tables[1] and any("recoil" in line for line in tables[0])
    assert main(["run", str(profiles_dir() / "ratchet"), "--no-plots", "-o", str(tmp_path / "click")]) in (0, 1)
    capsys.readouterr()
    assert main(["plot", str(tmp_path / "click"), "--phases", "-o", str(tmp_path / "click.png")]) == 2
    assert "Lift angle" not in capsys.readouterr().err
