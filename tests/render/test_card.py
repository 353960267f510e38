"""Does a card show the run, at the size that sites show, and is it refused where it cannot be made?"""

import math
import wave
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest
from matplotlib.collections import LineCollection
from render.fake_runs import disc_run, watch_run

import watchsim as ws
from watchsim.analysis.wear import CELLS
from watchsim.cli import main
from watchsim.mechanism.compile import compile_scene
from watchsim.render.palette import LIGHT
from watchsim.simulation.state import EventKind


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


# Does the sound that is drawn agree with the WAV file, and are its noises named by what met?

STEP = 2e-3  # s


def test_the_curve_is_the_sound_and_names_are_those_of_the_impacts(tmp_path: Path) -> None:
    run = ws.simulate(ws.load(ws.profiles_dir() / "swiss_lever"), duration=0.6, record="all")
    window = (0.3, 0.6)
    axes = ws.plot_sound(run, window).axes[0]
    x, y = axes.lines[0].get_data()
    with wave.open(str(ws.sound(run, tmp_path / "tick.wav"))) as file:
        rate, samples = file.getframerate(), np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(float)
    heard = samples[round(0.3 * rate) : round(0.58 * rate)]
    # Envelopes of two milliseconds: the plot keeps what a picture needs, the file every sample.
    t = np.asarray(x) / 1e3  # a window that ends before 1 s counts ms from zero
    edges = np.arange(0.3, 0.58, STEP)
    drawn = np.array([np.abs(y[(t >= a) & (t < a + STEP)]).max(initial=0.0) for a in edges])
    file_envelope = np.array([np.abs(heard[round((a - 0.3) * rate) :][: round(STEP * rate)]).max() for a in edges])
    assert np.corrcoef(drawn, file_envelope)[0, 1] > 0.99
    impacts = run.events[run.events["kind"] == EventKind.IMPACT]
    roles = {"FORK": "fork", "PIN": "roller jewel", "ARMS": "lever", "PINS": "banking", "TEETH": "wheel"}
    compiled, known = compile_scene(run.scene), set()
    for contact in {int(number) for number in impacts["contact"]}:
        sides = (int(compiled.model.contacts[contact][side]) for side in ("a", "b"))
        where = {compiled.layers[side]: float(compiled.model.primitives[side].px) for side in sides}
        # The wheel turns clockwise below the lever: its teeth come from the left.
        stone = "entry stone" if where.get("STONES", 0.0) < 0.0 else "exit stone"
        known.add(" / ".join(sorted(roles.get(layer, stone) for layer in where)))
    named = {" / ".join(sorted(text.get_text().split(" / "))) for text in axes.texts}
    assert len(named) >= 3 and named <= known


def test_silence_is_refused() -> None:
    with pytest.raises(ValueError, match="nothing sounds there"):
        ws.plot_sound(watch_run(), (0.01, 0.011))


# Does the picture of wear colour what slides, by as much as it wears, where it lies?

SLIDER = """[bodies.block]
motion = "slide"
axis = [1, 0]
circle = "2 mm"
mass = "1 g"
velocity = "{speed} m/s"
[bodies.plate]
motion = "slide"
axis = [0, 1]
mass = "2 g"
position = ["0 mm", "-2 mm"]
line = [["60 mm", "0 mm"], ["-4 mm", "0 mm"]]
[[torques]]
body = "plate"
value = "{press} N"
[[contacts]]
between = ["block", "plate"]
friction = 0.1
[run]
duration = "0.1 s"
"""


def test_a_line_that_is_slid_over_has_the_colour_of_its_load(tmp_path: Path) -> None:
    """N for each metre of way: N·m for each mm is a thousandth of the load, here in one run, times a year over its time."""
    press = 0.02
    (tmp_path / "scene.toml").write_text(SLIDER.format(speed=0.3, press=press))
    run = ws.simulate(ws.load(tmp_path))
    figure = ws.plot_wear(run)
    found = {axes.get_title(): axes for axes in figure.axes if axes.get_title()}
    worn = [one for one in found["plate, line"].collections if isinstance(one, LineCollection)]
    values = np.concatenate([np.asarray(one.get_array()) for one in worn])
    year = 365.25 * 86400.0 / 0.1
    assert np.median(values) == pytest.approx(press * 1e-3 * year, rel=1e-2)
    # Where the block has been: from 0 to v t - ½ μ N t²/m on the line, which is 64 mm long in so many pieces.
    way = 0.3 * 0.1 - 0.5 * 0.1 * press / 1e-3 * 0.1**2
    ends = np.concatenate([np.concatenate(one.get_segments()) for one in worn])[:, 0]
    assert ends.min() == pytest.approx(0.0, abs=64.0 / CELLS) and ends.max() == pytest.approx(1e3 * way, abs=64.0 / CELLS)
    assert "N·m a year" in found["plate, line"].get_xlabel()


def test_panels_are_stones_and_one_tooth_of_all() -> None:
    run = ws.simulate("profiles/swiss_lever", 1.0)
    titles = [axes.get_title() for axes in ws.plot_wear(run).axes if axes.get_title()]
    assert {"lever, entry stone", "lever, exit stone", "balance, roller jewel", "lever, fork", "banking"} <= set(titles)
    assert sum("tooth" in title for title in titles) == 1
    with pytest.raises(ValueError, match="no step of the run"):
        ws.plot_wear(run, (5.0, 6.0))


def test_what_does_not_slide_does_not_wear(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SLIDER.format(speed=0.0, press=0.02))
    run = ws.simulate(ws.load(tmp_path))
    assert math.isclose(run.end_u[0], 0.0)
    with pytest.raises(ValueError, match="nothing slides"):
        ws.plot_wear(run)
