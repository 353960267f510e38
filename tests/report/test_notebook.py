"""Do scenes, runs, beats and figures show themselves in a notebook, in a few lines and a small picture?"""

from __future__ import annotations

import base64
import io
import re
import subprocess
import sys
from pathlib import Path

import imageio.v3 as iio
import numpy as np
import pytest
from render.fake_runs import disc_run, watch_run

import watchsim as ws
from watchsim.analysis.timing.beats import Beats, beats
from watchsim.scene.scene import Scene

LARGEST = 30_000
PROFILES = Path(str(ws.profiles_dir()))


def hour() -> Beats:
    """An hour of 4 Hz, as an oscillator without any error would give it."""
    t = 0.125 * np.arange(28_800)
    period = np.concatenate(([np.nan, np.nan], np.full(len(t) - 2, 0.25)))
    swing = np.where(np.arange(len(t)) % 2 == 0, 4.8, -4.8)
    return Beats("balance", True, 0.25, t, t - 0.0625, t + 0.0625, -swing, swing, t - 0.001, period)


def picture(text: str) -> np.ndarray:
    data = re.search(r"data:image/png;base64,([^\"]+)", text)
    assert data is not None
    return iio.imread(io.BytesIO(base64.b64decode(data[1])))


@pytest.mark.parametrize("profile", ["swiss_lever", "bench_lever", "carriage", "balance", "incline"])
def test_a_scene_shows_itself(profile: str) -> None:
    scene = ws.load(PROFILES / profile)
    text = scene._repr_html_()
    assert scene.title in text and len(text.encode()) < LARGEST
    assert all(body.name in text for body in scene.bodies)
    assert len(np.unique(picture(text).reshape(-1, picture(text).shape[-1]), axis=0)) > 5


def test_a_run_shows_itself() -> None:
    run = ws.simulate(ws.load(PROFILES / "bench_lever"), duration=1.0)
    text = run._repr_html_()
    assert len(text.encode()) < LARGEST and "amplitude" in text and "s/d" in text
    assert picture(text).shape[:2] == (315, 560)


def test_runs_of_all_kinds_do() -> None:
    for run in (watch_run(), disc_run()):
        assert len(run._repr_html_().encode()) < LARGEST
    bare = ws.simulate(ws.load(PROFILES / "balance"), duration=0.4, record="statistics")
    assert len(bare._repr_html_().encode()) < LARGEST


def test_an_hour_of_beats_is_small() -> None:
    found = hour()
    assert len(found._repr_html_().encode()) < LARGEST
    assert found._repr_html_().count("<circle") > 100
    assert "28800 half swings" in repr(found) and "275.02°" in repr(found) and len(repr(found).splitlines()) == 1


def test_few_beats_and_none() -> None:
    run = ws.simulate(ws.load(PROFILES / "balance"), duration=0.05)
    assert "0 half swings" in repr(beats(run)) and "0 half swings" in beats(run)._repr_html_()


def test_titles_stay_text() -> None:
    assert "<img src=x" not in Scene("<img src=x onerror=alert(1)>", ws.load(PROFILES / "balance").bodies)._repr_html_()


def test_a_figure_shows_itself() -> None:
    pixels = iio.imread(io.BytesIO(ws.plot_kinematics(watch_run())._repr_png_()))
    assert pixels.shape[1] > 600 and pixels.std() > 1.0


def test_a_notebook_asks_for_these() -> None:
    display = pytest.importorskip("IPython.core.interactiveshell", reason="IPython is not installed")
    formatter = display.InteractiveShell.instance().display_formatter
    shown, _ = formatter.format(watch_run().scene)
    assert shown["text/html"].startswith('<div class="watchsim">') and "image/png" not in shown
    shown, _ = formatter.format(ws.plot_kinematics(watch_run()))
    assert shown["image/png"]


def test_the_function_is_not_hidden_by_a_package() -> None:
    """`watchsim.report` is a function, whatever has been imported before."""
    code = "import watchsim as ws; ws.load(ws.profiles_dir() / 'balance')._repr_html_(); print(callable(ws.report))"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "True"
