"""Do a movie's rate, size, colours and marks follow from what is asked, before anything is drawn?"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from render.fake_runs import watch_run

from watchsim.render import movie as module
from watchsim.render.movie import _plan, frame, movie
from watchsim.render.palette import DARK, LIGHT

ARROWS = SimpleNamespace(largest=3.5, round_force=2.0)


@dataclass
class Made:
    """What a movie or a frame was made of."""

    stage: dict[str, Any] = field(default_factory=dict)
    film: tuple[Any, ...] = ()
    numbers: list[list[int]] = field(default_factory=list)
    palette: Any = None
    encoded: tuple[Any, ...] = ()
    arrows_at: list[float] = field(default_factory=list)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> Made:
    """Nothing is drawn: pictures are 2 by 3 dots of their number."""
    found = Made()

    def stage(run: Any, pixels: Any, span: Any, **how: Any) -> str:
        found.stage = {"pixels": pixels, "span": span, **how}
        return "stage"

    def pictures(numbers: np.ndarray, progress: Any = None) -> Any:
        found.numbers.append(numbers.tolist())
        return (np.full((2, 3, 4), 10 + k, np.uint16) + np.arange(4, dtype=np.uint16) for k in numbers.tolist())

    def film(*parts: Any) -> Any:
        found.film = parts
        return SimpleNamespace(pictures=pictures)

    def palette(shown: list[np.ndarray], colours: Any) -> str:
        found.palette = ([int(one[0, 0, 0]) - 10 for one in shown], list(colours))
        return "palette"

    def encode(frames: Any, target: Path, *how: Any) -> None:
        found.encoded = (len(list(frames)), target.name, *how)

    def arrows(run: Any, times: np.ndarray) -> Any:
        found.arrows_at = times.tolist()
        return ARROWS

    for name, value in {
        "Stage": stage,
        "Film": film,
        "shared_palette": palette,
        "encode": encode,
        "ForceArrows": arrows,
    }.items():
        monkeypatch.setattr(module, name, value)
    monkeypatch.setattr(module, "ContactMarks", lambda run: "rings")
    monkeypatch.setattr(module, "phases", lambda run: ["unlock", "impulse"])
    monkeypatch.setattr(module, "strip_body", lambda run, asked: asked or "oscillator")
    monkeypatch.setattr(module, "soundtrack", lambda run, plan: ("heard", len(plan.times)))
    monkeypatch.setattr(module, "fitting", lambda run, span, extras, zoom, gif, turn: ((600, 601 + gif), 0.25))
    return found


@pytest.mark.parametrize(
    ("name", "fps", "size"), [("a.mp4", 60.0, (1280, 720)), ("a.GIF", 25.0, (800, 450)), ("b.gif", 25.0, (800, 450))]
)
def test_what_nobody_asks_for(made: Made, tmp_path: Path, name: str, fps: float, size: tuple[int, int]) -> None:
    assert movie(watch_run(), tmp_path / name, (0.5, 0.9), 0.25) == tmp_path / name
    frames = round(0.4 / 0.25 * fps) + 1
    gif = name.lower().endswith("gif")
    assert made.encoded == (frames, name, size, fps, "palette" if gif else None, None)
    assert made.stage["pixels"] == size and made.stage["span"] == (0.5, 0.9) and made.stage["style"] is LIGHT
    assert made.stage["speed"] == 0.25 and made.stage["step"] == pytest.approx(0.25 / fps, rel=1e-12)
    extras = made.stage["extras"]
    assert (extras.insets, extras.strip, extras.phases, extras.force, extras.scale) == ((), None, (), 0.0, 0.0)
    assert made.film[3:] == (None, None, False) and made.numbers[-1] == list(range(frames))
    if gif:
        assert made.palette == (made.numbers[0], []) and made.numbers[0] == [(frames - 1) * k // 11 for k in range(12)]


def test_what_may_be_asked_for(made: Made, tmp_path: Path) -> None:
    asked: dict[str, Any] = {"insets": "lever", "strip": "wheel", "phases": True, "forces": True, "dark": True}
    movie(watch_run(), tmp_path / "a.gif", (0.5, 0.9), 0.5, fps=20.0, size=(321, 200), contacts=True, turn=0.7, **asked)
    extras = made.stage["extras"]
    assert (extras.insets, extras.strip, extras.phases) == (("lever",), "wheel", ("unlock", "impulse"))
    assert (extras.force, extras.scale) == (3.5, 2.0) and made.film[3:] == ("rings", ARROWS, False)
    assert made.stage["style"] is DARK and made.stage["turn"] == 0.7 and made.stage["pixels"] == (322, 200)
    assert made.palette[1] == list(DARK.phases.values()) and made.encoded[0] == 17 == len(made.arrows_at)
    movie(watch_run(), tmp_path / "a.mp4", strip=True, insets=("a", "b"), size="auto", sound=True)
    extras = made.stage["extras"]
    assert (extras.strip, extras.insets, extras.force) == ("oscillator", ("a", "b"), 0.0)
    assert made.stage["pixels"] == (600, 601) and made.stage["turn"] == 0.25 and made.stage["span"] == (0.0, 2.0)
    assert made.encoded[-1].keywords == {"heard": ("heard", 121)}
    with pytest.raises(ValueError, match="a GIF holds none"):
        movie(watch_run(), tmp_path / "a.gif", sound=True)
    with pytest.raises(ValueError, match='or "auto"'):
        movie(watch_run(), tmp_path / "a.mp4", size="large")


@pytest.mark.parametrize(("length", "frames"), [(None, 601), (3.5, 211)])
def test_at_adaptive_speed(
    made: Made, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, length: float | None, frames: int
) -> None:
    """Ten seconds long; the clock shows what tells the slowest frames apart."""
    monkeypatch.setattr(module, "busy", lambda run, phases, span: [(0.6, 0.7)])
    movie(watch_run(), tmp_path / "a.mp4", (0.5, 0.9), "adaptive", length=length)
    assert made.encoded[0] == frames and made.film[-1] is True and made.stage["speed"] is None
    speeds = made.film[2].speeds
    assert speeds.max() > 2.0 * speeds.min() and made.stage["step"] == pytest.approx(float(speeds.min()) / 60.0, rel=1e-12)


def test_words_that_are_no_speed(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match='give a number, or "adaptive"'):
        movie(watch_run(), tmp_path / "a.mp4", speed="slow")
    with pytest.raises(ValueError, match="length = 3: only a movie at speed"):
        movie(watch_run(), tmp_path / "a.mp4", length=3.0)


@pytest.mark.parametrize(
    ("fps", "kept"), [(25.0, 25.0), (30.0, 100.0 / 3.0), (22.0, 20.0), (60.0, 50.0), (240.0, 50.0), (41.0, 50.0), (1.0, 1.0)]
)
def test_a_gif_keeps_time_in_hundredths(fps: float, kept: float) -> None:
    """Of two at least."""
    unused: Any = None
    assert _plan(unused, (0.0, 1.0), 1.0, None, fps, True).fps == pytest.approx(kept, rel=1e-12)
    assert _plan(unused, (0.0, 1.0), 1.0, None, fps, False).fps == fps


def test_one_frame(made: Made) -> None:
    picture = frame(watch_run(), 0.5, window=(0.5, 0.75), forces=True, contacts=True, dark=True)
    assert picture.tolist() == [[[10, 11, 12]] * 3] * 2 and picture.flags.c_contiguous
    assert made.stage["pixels"] == (1280, 720) and made.stage["style"] is DARK and made.arrows_at == [0.5]
    plan = made.film[2]
    assert (plan.times.tolist(), plan.speeds.tolist(), plan.fps) == ([0.5], [1.0], 1.0)
    assert made.film[3:] == ("rings", ARROWS, False) and made.stage["span"] == (0.5, 0.75)
    frame(watch_run(), 0.75, (301, 77), window=(0.5, 0.75), turn=0.5)
    assert made.stage["pixels"] == (301, 77) and made.stage["turn"] == 0.5 and made.film[3:] == (None, None, False)
    frame(watch_run(), 0.6, "auto")
    assert made.stage["pixels"] == (600, 601) and made.stage["turn"] == 0.25
    for t in (0.4999, 0.7501):
        with pytest.raises(ValueError, match=r"lies outside 0\.5 s to 0\.75 s"):
            frame(watch_run(), t, window=(0.5, 0.75))
