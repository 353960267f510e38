"""Does a card show the run, at the size that sites show, and is it refused where it cannot be made?"""

from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest
from render.fake_runs import disc_run

import watchsim as ws
from watchsim.cli import main
from watchsim.render.palette import LIGHT


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("card") / "run"
    command = ["run", str(ws.profiles_dir() / "swiss_lever"), "--duration", "1.2 s", "--no-plots", "-o", str(made)]
    assert main(command) in (0, 1)
    return made


def near(picture: np.ndarray, colour: str) -> int:
    wanted = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)])
    return int((np.abs(picture.astype(int) - wanted).max(axis=2) < 8).sum())


def test_a_png_shows_an_impulse_with_its_forces(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["card", str(folder)]) == 0
    assert capsys.readouterr().out.strip() == str(folder / "card.png")
    picture = imageio.imread(folder / "card.png")
    assert picture.shape == (630, 1200, 3)
    assert near(picture[:100, :400], LIGHT.phases["impulse"]) > 50  # the chip before the name of the phase
    assert near(picture[:, :870], LIGHT.force) > 200
    assert near(picture[:, 870:], LIGHT.ink) > 800  # numbers


def test_a_gif_moves_for_five_seconds(folder: Path, tmp_path: Path) -> None:
    assert main(["card", str(folder), "--dark", "-o", str(tmp_path / "shared.gif")]) == 0
    about = imageio.immeta(tmp_path / "shared.gif", plugin="pillow")
    frames = imageio.imread(tmp_path / "shared.gif", plugin="pillow", index=None)
    assert len(frames) * about["duration"] / 1e3 == pytest.approx(5.0, abs=0.05)
    assert frames.shape[1:3] == (630, 1200)
    assert (frames[0][:, :870] != frames[60][:, :870]).any() and (frames[0][:, 870:] == frames[60][:, 870:]).all()
    assert (tmp_path / "shared.gif").stat().st_size < 4e6


def test_what_keeps_no_time_has_a_card_too(tmp_path: Path) -> None:
    run = ws.simulate(ws.load(ws.profiles_dir() / "incline"), duration=0.5)
    assert imageio.imread(ws.card(run, tmp_path / "incline.png", 0.25)).shape == (630, 1200, 3)


@pytest.mark.parametrize(
    ("name", "t", "said"),
    [
        ("card.jpg", None, "the ending decides the format of a card"),
        ("card.png", 9.0, "lies outside"),
        ("card.gif", 1.0, "leave the time out"),
    ],
)
def test_a_card_that_cannot_be_is_refused(name: str, t: float | None, said: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=said):
        ws.card(disc_run(), tmp_path / name, t, numbers={})
    assert not list(tmp_path.iterdir())
