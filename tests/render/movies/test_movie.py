"""Does a movie show the run, at the speed it says, and is it written whole or not at all?"""

from __future__ import annotations

import math
from pathlib import Path

import imageio.v3 as iio
import numpy as np
import pytest
from every_time import few
from matplotlib.colors import to_rgb
from render.fake_runs import disc_run, slide_run, watch_run

from watchsim.render import encoder
from watchsim.render import movie as run_movie
from watchsim.render.encoder import shared_palette
from watchsim.render.movie import frame, movie
from watchsim.render.palette import BACKGROUND, BLUED, BRASS, INK, NIGHT, RUBY
from watchsim.render.stage import Stage
from watchsim.render.view import poses

SMALL = (480, 270)


def rgb(colour):
    return np.round(255 * np.array(to_rgb(colour)))


def spot(stage, frames, body, point):
    """Row and column of a body point (m)."""
    x, y, angle = frames[body]
    c, s = math.cos(angle), math.sin(angle)
    place = np.array([x + c * point[0] - s * point[1], y + s * point[0] + c * point[1], 1.0])
    u, v, _ = stage.view.matrix(stage.view.centre_at(frames)) @ place
    return stage.draw(0.0, frames).shape[0] - 1 - int(v), int(u)


@pytest.mark.parametrize("t", few([0.37, 0.0, 1.99, 1.0], 2))
def test_parts_are_where_the_motion_puts_them(t):
    run = watch_run()
    stage = Stage(run, (1280, 720), (0.0, 2.0))
    frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
    picture = frame(run, t)
    assert picture.shape == (720, 1280, 3) and picture.dtype == np.uint8
    for body, point, colour in (
        ("balance", (0.0, -0.7e-3), RUBY.fill),
        ("lever", (1e-3, -0.5e-3), RUBY.fill),
        ("wheel", (0.0, -1.5e-3), BRASS.fill),
        ("wheel", (0.3e-3, 0.0), BACKGROUND),  # the bore is empty
        ("wheel", (1.4e-3, 0.0), INK),  # nothing else would show that a ring turns
    ):
        assert picture[spot(stage, frames, body, point)] == pytest.approx(rgb(colour), abs=8), (body, point)


def test_a_frame_does_not_depend_on_the_ones_before():
    run = watch_run()
    stage = Stage(run, SMALL, (0.0, 2.0))
    where = poses(run, np.array([0.3, 1.7]))
    first, last = ({name: rows[k] for name, rows in where.items()} for k in (0, 1))
    once = stage.draw(0.3, first).copy()
    stage.draw(1.7, last)
    assert np.array_equal(stage.draw(0.3, first), once)


def test_a_drawing_unlike_any_other_is_drawn():
    for run in (disc_run(), slide_run()):
        picture = frame(run, 0.4, SMALL)
        assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 20
    ground = frame(disc_run(), 0.4, SMALL)
    assert not np.array_equal(ground, frame(disc_run(), 0.41, SMALL))


def test_words_do_not_leave_the_picture_or_touch_the_mechanism():
    run = watch_run(title="An escapement with a title that is far too long for any picture of this size, and then some")
    for size in ((1280, 720), (320, 180), (600, 900)):
        picture = frame(run, 0.2, size)
        assert np.all(picture[:, [0, -1]] == rgb(BACKGROUND)) and np.all(picture[[0, -1]] == rgb(BACKGROUND))


def test_mp4_has_the_asked_length_size_and_pixels(tmp_path):
    run = watch_run()
    done = []
    path = movie(
        run, tmp_path / "beat.mp4", (0.5, 0.75), 1 / 4, fps=30, size=(479, 270), progress=lambda k, n: done.append((k, n))
    )
    about = iio.immeta(path, plugin="FFMPEG")
    assert about["size"] == (480, 270) and about["fps"] == 30.0 and about["codec"] == "h264" and "yuv420p" in about["pix_fmt"]
    frames = iio.imread(path, plugin="FFMPEG")
    assert len(frames) == 31 == len(done)  # 0.25 s at a quarter of true speed, first and last included
    assert done[-1] == (31, 31)
    alone = frame(run, 0.5 + 15 / 120, (480, 270), (0.5, 0.75)).astype(int)
    middle = slice(60, 220)
    assert np.abs(frames[15][middle].astype(int) - alone[middle]).mean() < 3.0
    assert np.abs(frames[0][middle].astype(int) - alone[middle]).mean() > 3.0
    assert list(tmp_path.iterdir()) == [path]


def test_gif_keeps_time_and_rubies(tmp_path):
    path = movie(watch_run(), tmp_path / "beat.gif", (0.5, 0.75), 1 / 4, size=SMALL)
    frames = iio.imread(path, plugin="pillow")
    assert len(frames) == 26  # 25 a second
    assert iio.immeta(path, plugin="pillow", index=1)["duration"] == 40
    packed = frames[..., :3].astype(int) @ (65536, 256, 1)
    colours = np.unique(packed)
    assert len(colours) <= 64
    for colour in (BACKGROUND, RUBY.fill, BRASS.fill, BLUED.fill):
        assert int(colour[1:], 16) in colours
    assert path.stat().st_size < 400_000


def test_a_palette_keeps_what_is_plain():
    picture = np.zeros((50, 50, 4), dtype=np.uint8)
    picture[:25], picture[25:], picture[3, 3] = (*rgb(BRASS.fill), 255), (*rgb(NIGHT.fill), 255), (196, 35, 79, 255)
    palette = shared_palette([picture])
    raw = np.frombuffer(palette.indexed(picture), dtype=np.uint8)
    table = raw[2500:].reshape(256, 4)
    assert np.array_equal(table[raw[:2500]][:, [2, 1, 0, 3]].reshape(50, 50, 4), picture)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"path": "beat.avi"}, ".mp4 or .gif"),
        ({"path": "beat"}, ".mp4 or .gif"),
        ({"window": (1.0, 3.0)}, "0 s to 2 s was recorded"),
        ({"speed": 0.0}, "seconds of the watch per second"),
        ({"speed": math.nan}, "seconds of the watch per second"),
        ({"fps": 0}, "1 to 240"),
        ({"size": (10, 10)}, "64 to 8192"),
        ({"size": (64, 64)}, "no room is left"),
        ({"speed": 1e-300}, "more than 1e\\+06 frames"),
        ({"size": "big"}, "width, height"),
        ({"zoom": ["ballance"]}, "wheel, lever, balance"),
    ],
)
def test_bad_arguments_are_refused_before_anything_is_written(tmp_path, arguments, said):
    arguments = {"path": "beat.mp4", **arguments}
    with pytest.raises(ValueError, match=said):
        movie(watch_run(), tmp_path / arguments.pop("path"), **arguments)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(FileNotFoundError, match="create it first"):
        movie(watch_run(), tmp_path / "none" / "beat.mp4")
    with pytest.raises(ValueError, match="outside"):
        frame(watch_run(), 7.0)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
@pytest.mark.parametrize("name", ["beat.mp4", "beat.gif"])
def test_a_full_disk_leaves_the_old_movie(tmp_path, monkeypatch, name):
    (tmp_path / name).write_bytes(b"old")
    command = encoder._command
    monkeypatch.setattr(encoder, "_command", lambda *given: [*command(*given)[:-1], "-f", name[-3:], "/dev/full"])
    with pytest.raises(OSError, match=r"could not write .*No space left on device.*nothing was changed"):
        movie(watch_run(), tmp_path / name, (0.5, 0.75), size=SMALL)
    assert (tmp_path / name).read_bytes() == b"old"
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_an_encoder_that_dies_at_once_is_reported(tmp_path, monkeypatch):
    command = encoder._command
    monkeypatch.setattr(encoder, "_command", lambda *given: [*command(*given)[:-1], "-nonsense", str(given[0])])
    with pytest.raises(OSError, match=r"could not write .*nothing was changed"):
        movie(watch_run(), tmp_path / "beat.mp4", size=SMALL)
    assert list(tmp_path.iterdir()) == []


def test_an_interrupt_leaves_nothing(tmp_path):
    def stop(done, total):
        if done == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        movie(watch_run(), tmp_path / "beat.mp4", size=SMALL, progress=stop)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("speed", "fps", "window"),
    few([(1.0, 25.0, (0.0, 2.0)), (0.05, 60.0, (0.3, 0.5)), (1 / 40, 50.0, (1.0, 1.1))], 2, several=True),
)
def test_frames_lie_as_far_apart_as_speed_and_rate_say(speed, fps, window, tmp_path, monkeypatch):
    """Frame k shows the instant start + k speed / fps, to the last one in the window."""
    shown = []
    monkeypatch.setattr(Stage, "draw", lambda self, t, *_, **__: shown.append(t) or np.zeros((180, 320, 4), np.uint8))
    movie(watch_run(), tmp_path / "a.mp4", window=window, speed=speed, fps=fps, size=(320, 180))
    assert len(shown) == round((window[1] - window[0]) * fps / speed) + 1
    assert shown == pytest.approx([window[0] + k * speed / fps for k in range(len(shown))], rel=1e-12, abs=0.0)
    assert iio.immeta(tmp_path / "a.mp4", plugin="FFMPEG")["fps"] == fps


@pytest.mark.parametrize(("speed", "step"), [(0.05, 0.05 / 60.0), ("adaptive", None)])
def test_the_clock_has_the_decimals_of_the_slowest_frames(speed, step, tmp_path, monkeypatch):
    """At adaptive speed those that lie nearest to each other."""
    asked, known = {}, []

    def noted(times, *_, **more):
        known.append(times)
        raise KeyboardInterrupt

    monkeypatch.setattr(run_movie, "Stage", lambda *_, **more: asked.update(more))
    monkeypatch.setattr(run_movie, "Film", lambda stage, run, plan, *_: noted(plan.times))
    with pytest.raises(KeyboardInterrupt):
        movie(watch_run(), tmp_path / "a.mp4", speed=speed, size=SMALL)
    apart = np.diff(known[0])
    assert asked["step"] == pytest.approx(step or apart.min(), rel=0.05)
    assert step or apart.max() > 3.0 * apart.min()
