"""Does watchsim plot write the kinds of plots that were asked for, and say why one cannot be drawn?"""

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
