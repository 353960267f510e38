"""Do scenes, runs, beats and figures show themselves in a notebook, in a few lines and a small picture?"""

import base64
import html
import io
import re
from pathlib import Path

import imageio.v3 as iio
import numpy as np
import pytest
from every_time import few
from interpreter import python
from pages.browser import opened
from render.fake_runs import disc_run, watch_run

import watchsim as ws
from watchsim.analysis.timing import Beats, beats
from watchsim.scene.scene import Scene
from watchsim.studies.axes import Axis
from watchsim.studies.cycle import Cycle
from watchsim.studies.point import outputs_named
from watchsim.studies.sensitivity import Derivative, Effect, Quantity, Sensitivity
from watchsim.studies.sweep import Sweep
from watchsim.units import TORQUE

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


@pytest.mark.parametrize("profile", few(["carriage", "swiss_lever", "bench_lever", "balance", "incline"], 1))
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


def test_studies_show_themselves_and_print_in_a_line() -> None:
    torque = Axis("torques.0.value", tuple(-1e-6 * (1.0 + 0.05 * k) for k in range(40)), "N·m", "µN·m")
    row = {"amplitude_deg": 280.0, "amplitude_deg_error": 0.1, "verdict": "ticks", "message": ""}
    rows = tuple({"torques.0.value": value, **row} for value in torque.values)
    swept = Sweep("A <b>watch</b>", (torque,), outputs_named(["amplitude"]), rows, True, 1.0)
    text = swept._repr_html_()
    assert len(text.encode()) < LARGEST and "40 points" in text and "the first 12 of 40" in text and "<b>watch" not in text
    assert picture(text).shape[1] == 560 and "−1.05" in text
    assert len(repr(swept)) < 200 and "40 points over torques.0.value" in repr(swept)
    nothing = Sweep("A watch", (torque,), outputs_named(["amplitude"]), (), False, 0.0)
    assert "interrupted" in nothing._repr_html_() and "interrupted" in repr(nothing)

    by = {"amplitude_deg": Derivative(2e8, 2e8, True, 0.0)}
    quantity = Quantity("torques.0.value", -1e-6, TORQUE, "µN·m", -1e-8, -1e-8, "1 %")
    cycle = Cycle(True, "ticks", amplitude_deg=280.0, rate_s_per_d=-5.5, beat_error_ms=0.01, multipliers=(0.88,))
    found = Sensitivity("A watch", cycle, outputs_named(["amplitude"]), (Effect(quantity, by),), True, 1.0)
    text = found._repr_html_()
    assert len(text.encode()) < LARGEST and "torques.0.value" in text and picture(text).shape[1] == 560
    assert len(repr(found)) < 200 and "1 quantities" in repr(found)
    assert "280.000°" in repr(cycle) and "multiplier 0.88" in cycle._repr_html_()
    standing = Cycle(False, "stops", "it stands")
    assert "stops" in repr(standing) and "it stands" in standing._repr_html_()


def test_a_run_plays_in_a_frame_that_may_do_nothing_else() -> None:
    run = watch_run()
    shown = run.player((0.2, 0.9))
    text = shown._repr_html_()
    assert text.startswith("<iframe") and len(text.encode()) < 300_000 and len(repr(shown)) < 200
    assert 'sandbox="allow-scripts allow-downloads"' in text and "allow-same-origin" not in text
    page = html.unescape(re.search(r'srcdoc="([^"]*)"', text)[1])
    assert page == shown.page and "<canvas" in page and "default-src 'none'" in page
    assert ws.show(run, (0.2, 0.9)).page == page
    with pytest.raises(ValueError, match="was recorded"):
        ws.show(run, (5.0, 6.0))


@pytest.mark.slow
def test_the_player_plays_inside_a_frame(tmp_path: Path) -> None:
    path = tmp_path / "notebook.html"
    ready = "<script>window.watchsim = true</script>"  # what the browser waits for; the frame has its own
    path.write_text(f"<!DOCTYPE html><html><body>{ready}{watch_run().player()._repr_html_()}</body></html>", encoding="utf-8")
    with opened(path) as page:
        # Chromium, on a busy machine, may never let the process of a frame draw, whatever is in it: then it is opened anew.
        for _ in range(4):
            page.wait_for_timeout(500)
            if page.frames[1].evaluate("watchsim.pace().fps"):
                break
            page.reload()
        frame = page.frames[1]
        before = frame.evaluate("document.getElementById('scrub').value")
        frame.click("#play")
        page.wait_for_timeout(800)
        assert frame.evaluate("document.getElementById('scrub').value") != before
        assert frame.evaluate("getComputedStyle(document.getElementById('sheet')).display") == "none"
        assert page.said == [] and all(address.startswith(("file:", "about:", "data:")) for address in page.asked)


@pytest.mark.slow
def test_the_player_waits_for_a_frame_that_has_no_size_yet(tmp_path: Path) -> None:
    """A cell that is folded in, or a frame not laid out yet: the first picture failed, and no other followed."""
    path = tmp_path / "folded.html"
    cell = f'<div id="cell" style="width: 0">{watch_run().player()._repr_html_()}</div>'
    ready = "<script>window.watchsim = true</script>"
    path.write_text(f"<!DOCTYPE html><html><body>{ready}{cell}</body></html>", encoding="utf-8")
    with opened(path) as page:
        page.wait_for_timeout(800)
        assert page.frames[1].evaluate("document.getElementById('picture').clientWidth") == 0
        page.evaluate("document.getElementById('cell').style.width = '900px'")
        for _ in range(40):
            page.wait_for_timeout(250)
            if page.frames[1].evaluate("watchsim.pace().drawn > 0"):
                break
        before = page.frames[1].evaluate("document.getElementById('scrub').value")
        page.frames[1].click("#play")
        page.wait_for_timeout(800)
        assert page.frames[1].evaluate("document.getElementById('scrub').value") != before
        assert page.said == []


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
    assert python(code) == "True"
