"""Does a movie tick when its pictures show the blow, at any speed?"""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from every_time import few
from imageio_ffmpeg import get_ffmpeg_exe
from render.fake_runs import watch_run

from watchsim.analysis.sound import SAMPLES
from watchsim.commands.movie import parse_speed
from watchsim.render.movie import adaptive, busy, movie
from watchsim.simulation.state import EVENT_DTYPE, EventKind
from watchsim.simulation.trajectory import Trajectory

BLOWS = (0.31, 0.52, 0.548, 0.9)
RING = 0.004  # s: a blow has died away
QUIET = 0.02  # of full scale
FPS = 30.0
SIZE = (320, 180)


def ticking(blows: tuple[float, ...] = BLOWS) -> Trajectory:
    run = watch_run(duration=1.0)
    rows = [(t, EventKind.IMPACT, 0, -1, 2e-9, 0.0, 4e-12, 0.0) for t in blows]
    return Trajectory(**{**run.__dict__, "events": np.array(rows, dtype=EVENT_DTYPE)})


def heard(path: Path) -> np.ndarray:
    """The sound as samples, by the decoder alone."""
    command = [get_ffmpeg_exe(), "-v", "error", "-i", str(path), "-f", "s16le", "-ac", "1", "-ar", str(SAMPLES), "-"]
    raw = subprocess.run(command, capture_output=True, check=True).stdout
    return np.frombuffer(raw, "<i2") / 32768.0


def onsets(path: Path) -> np.ndarray:
    """Seconds at which something is heard after a silence."""
    loud = np.flatnonzero(np.abs(heard(path)) > QUIET)
    return loud[np.diff(loud, prepend=-SAMPLES) > RING * SAMPLES] / SAMPLES


@pytest.mark.parametrize("speed", few(["1", "1/2", "1/10", "2"], lambda speed: speed in ("1/2", "2")))
def test_at_an_even_speed_blows_are_heard_when_they_are_shown(speed: str, tmp_path: Path) -> None:
    rate = parse_speed(speed)
    window = (0.2, 0.95)
    film = movie(ticking(), tmp_path / "a.mp4", window, rate, fps=FPS, size=SIZE, sound=True)
    found = onsets(film)
    assert len(found) == len(BLOWS)
    assert np.abs(found - (np.array(BLOWS) - window[0]) / rate).max() < 1.0 / FPS
    assert len(heard(film)) / SAMPLES == pytest.approx((window[1] - window[0]) / rate, abs=2.0 / FPS)


def test_at_an_adaptive_speed_they_are_heard_with_the_pictures_that_show_them(tmp_path: Path) -> None:
    run = ticking((0.31, 0.9))
    film = movie(run, tmp_path / "a.mp4", (0.0, 1.0), "adaptive", length=4.0, fps=FPS, size=SIZE, sound=True)
    times = adaptive((0.0, 1.0), busy(run, [], (0.0, 1.0)), 4.0, FPS).times
    found = onsets(film)
    assert len(found) == 2
    for blow, onset in zip((0.31, 0.9), found, strict=True):
        first = np.flatnonzero(times >= blow)[0] / FPS  # the first picture after it
        assert abs(onset - first) < 1.0 / FPS


def test_a_blow_is_as_long_in_slow_motion_as_in_the_watch(tmp_path: Path) -> None:
    lasts = []
    for speed in (1.0, 0.1):
        film = movie(ticking((0.5,)), tmp_path / f"{speed}.mp4", (0.45, 0.55), speed, fps=FPS, size=SIZE, sound=True)
        loud = np.flatnonzero(np.abs(heard(film)) > QUIET)
        lasts.append((loud[-1] - loud[0]) / SAMPLES)
    assert lasts[1] == pytest.approx(lasts[0], abs=0.002)


def test_silence_and_gifs_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="a GIF holds none"):
        movie(ticking(), tmp_path / "a.gif", sound=True)
    with pytest.raises(ValueError, match="nothing sounds"):
        movie(ticking(), tmp_path / "a.mp4", (0.6, 0.8), sound=True)
    assert list(tmp_path.iterdir()) == []
