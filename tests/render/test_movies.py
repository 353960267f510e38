"""Does a movie show the run, at the speed it says, and is it written whole or not at all?"""

import math
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import imageio.v3 as iio
import numpy as np
import pytest
from every_time import few
from imageio_ffmpeg import get_ffmpeg_exe
from matplotlib.colors import to_rgb
from render.fake_runs import disc_run, slide_run, watch_run
from shapely import LineString, Point

import watchsim as ws
from watchsim.analysis.forces import forces
from watchsim.analysis.sound import SAMPLES
from watchsim.analysis.timeline import shown_beats
from watchsim.commands.movie import parse_speed
from watchsim.geometry.loops import polyline
from watchsim.render import encoder
from watchsim.render import movie as run_movie
from watchsim.render.encoder import _command, _run, check_path, encode, shared_palette
from watchsim.render.insets import beside, insets
from watchsim.render.marks import ForceArrows, PalletStones, arrow_path, changing_speed_text, speed_text
from watchsim.render.movie import adaptive, busy, frame, movie
from watchsim.render.palette import BACKGROUND, BLUED, BRASS, CONTACT, INK, NIGHT, RUBY
from watchsim.render.stage import Extras, Stage
from watchsim.render.view import Frame, placed, poses
from watchsim.simulation.state import EVENT_DTYPE, EventKind
from watchsim.simulation.trajectory import Trajectory

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
    (tmp_path / "file").touch()
    with pytest.raises(OSError, match="file"):
        movie(watch_run(), tmp_path / "file" / "beat.mp4", window=(0.0, 0.01))
    with pytest.raises(ValueError, match="outside"):
        frame(watch_run(), 7.0)


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


SIZES = ((1280, 720), (720, 1280), (480, 480))
BOX = Frame(800.0, 100.0, 200.0, 300.0)


def near(picture, colour):
    """Where (row, column) a picture has that colour."""
    return np.argwhere(np.all(np.abs(picture.astype(int) - np.round(255 * np.array(to_rgb(colour)))) <= 3, axis=2))


@pytest.mark.parametrize("turn", [0.0, -0.5 * math.pi, 0.3])
def test_an_inset_holds_the_rectangle_and_nothing_is_stretched(turn):
    made = insets(watch_run(), (0.0, 2.0), ["-1.4, 1.9 : -0.8, 2.5"], [BOX], turn)[0]
    matrix = made.matrix({})
    for x, y in ((-1.4e-3, 1.9e-3), (-0.8e-3, 2.5e-3), (-1.4e-3, 2.5e-3)):
        u, v, _ = matrix @ (x, y, 1.0)
        assert BOX.left < u < BOX.left + BOX.width and BOX.bottom < v < BOX.bottom + BOX.height
    assert abs(np.linalg.det(matrix[:2, :2])) == pytest.approx(made.view.scale**2)


def test_what_goes_far_is_followed():
    run = disc_run()
    name = next(body.name for body in run.scene.bodies if body.motion == "free")
    made = insets(run, (0.0, 2.0), [name], [BOX], 0.0)[0]
    for t in (0.1, 0.9, 1.8):
        frames = {body: rows[0] for body, rows in poses(run, np.array([t])).items()}
        u, v, _ = made.matrix(frames) @ (*frames[name][:2], 1.0)
        assert (u, v) == pytest.approx((BOX.left + 0.5 * BOX.width, BOX.bottom + 0.5 * BOX.height), abs=1.0)


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ("levr", "bodies with a drawing"),
        ("entyr pallet", 'did you mean "entry pallet"'),
        ("lever.NONE", "layers of lever"),
        ("lever.NONE.1", "layers of lever"),
        ("1,2:3", "two corners"),
        ("1,2:1,4", "empty"),
        ("nan,2:1,4", "empty"),
        ("", "bodies with a drawing"),
    ],
)
def test_a_place_that_is_none_is_refused(place, said):
    with pytest.raises(ValueError, match=said):
        frame(watch_run(), 0.3, insets=[place])


def test_an_outline_is_counted_from_one():
    run = watch_run()
    body = next(body for body in run.scene.bodies if body.name == "lever")
    layer = body.loops[0].layer
    insets(run, (0.0, 2.0), [f"lever.{layer}.1"], [BOX], 0.0)
    for number in (0, 99, "x"):
        with pytest.raises(ValueError, match="counted"):
            insets(run, (0.0, 2.0), [f"lever.{layer}.{number}"], [BOX], 0.0)


@pytest.mark.slow
def test_the_wheel_presses_on_the_stone_of_the_beat():
    run = ws.simulate(ws.load(ws.profiles_dir() / "swiss_lever"), duration=0.6, record="all")
    beats = shown_beats(run, rubbed=False)
    assert {beat.stages[0].pallet for beat in beats} == {"entry", "exit"}
    for beat in beats:
        t = 0.5 * (beat.stages[0].phase.start + beat.stages[0].phase.end)
        told = forces(run, [t])
        pressed = {k: point for k, point in zip(told.pairs, told.point[0], strict=True) if np.isfinite(point[0])}
        (place,) = (p for k, p in pressed.items() if {run.pairs[k].body_a, run.pairs[k].body_b} == {"wheel", "lever"})
        x, y, angle = run.pose("lever", t)
        c, s = math.cos(angle), math.sin(angle)
        own = np.array([[c, s], [-s, c]]) @ (place - (x, y))
        body, loop = PalletStones(run.scene).stone(beat.stages[0].pallet)
        edges = LineString(polyline(loop, 1e-8))
        assert body.name == "lever" and edges.distance(Point(own)) < 2e-8
        assert insets(run, (0.0, 0.6), [f"{beat.stages[0].pallet} stone"], [BOX], 0.0)[0].box == BOX


def test_no_stones_no_inset():
    run = ws.simulate(ws.load(ws.profiles_dir() / "incline"), duration=0.05)
    with pytest.raises(ValueError, match=r'inset "exit stone": the exit pallet is not known.*nothing swings'):
        insets(run, (0.0, 0.05), ["exit stone"], [BOX], 0.0)


@pytest.mark.parametrize("size", [(1280.0, 500.0), (700.0, 1200.0)])
@pytest.mark.parametrize("count", range(1, 7))
def test_insets_lie_apart_beside_the_mechanism(size, count):
    room, boxes = beside(Frame(0.0, 60.0, *size), count)
    all_of_them = [room, *boxes]
    for k, a in enumerate(all_of_them):
        assert a.width > 50.0 and a.height > 50.0
        assert a.left >= 0.0 and a.left + a.width <= size[0] and a.bottom >= 60.0 and a.bottom + a.height <= 60.0 + size[1]
        for b in all_of_them[:k]:
            apart = a.left + a.width <= b.left or b.left + b.width <= a.left
            assert apart or a.bottom + a.height <= b.bottom or b.bottom + b.height <= a.bottom


@pytest.mark.parametrize("size", few(SIZES, 1))
def test_the_cursor_stands_at_its_share_of_the_strip(size):
    run, found = watch_run(), []
    for t in (0.0, 0.05, 0.1):
        rows, columns = near(frame(run, t, size, (0.0, 0.1), strip="balance"), CONTACT).T
        assert len(rows) > 30
        found.append(columns.mean())
    assert found[1] == pytest.approx(0.5 * (found[0] + found[2]), abs=1.0) and found[2] - found[0] > 0.4 * size[0]


def test_the_mechanism_keeps_out_of_strip_and_insets():
    picture = frame(watch_run(), 0.3, strip=True, insets=["lever"])
    room = frame(watch_run(), 0.3, strip=True)
    assert picture.shape == room.shape == (720, 1280, 3)
    assert len(near(picture, RUBY.fill)) > 100 and near(room, RUBY.fill)[:, 0].max() < 0.72 * 720


def test_a_strip_of_what_slides_or_is_free():
    for run in (disc_run(), slide_run()):
        assert len(near(frame(run, 0.4, (640, 360), strip=True), CONTACT)) > 20


def test_arrows_are_as_long_as_their_forces():
    path = arrow_path(np.zeros((2, 2)), np.array([[30.0, 40.0], [0.0, -20.0]]), 50.0)
    tips = np.asarray(path.vertices)
    assert np.hypot(*tips.T).max() == pytest.approx(50.0) and tips[:, 1].min() == pytest.approx(-20.0)
    assert arrow_path(np.zeros((1, 2)), np.zeros((1, 2)), 50.0) is None


def test_phases_are_told_by_name_only_while_they_last():
    from watchsim.analysis.phases import Phase

    still = (0.0, 0.0, 0.0)
    told = Extras(phases=(Phase(1, "unlock", 0.1, 0.2, still, still), Phase(1, "drop", 0.3, 0.4, still, still)))
    assert [told.phase_at(t) for t in (0.0, 0.1, 0.2, 0.35, 0.4)] == ["", "unlock", "", "drop", ""]


@pytest.mark.parametrize(
    ("speed", "said"),
    [(1.0, "true speed"), (0.0233, "1/43 of true speed"), (0.004, "1/250 of true speed"), (2.5, "2.5 × true speed")],
)
def test_a_changing_speed_has_two_digits(speed, said):
    assert changing_speed_text(speed) == said


def test_an_adaptive_movie_is_as_long_as_asked(tmp_path):
    import imageio.v3 as iio

    path = movie(watch_run(), tmp_path / "m.mp4", (0.0, 1.0), "adaptive", length=1.0, fps=20.0, size=(320, 240), strip=True)
    assert abs(len(list(iio.imiter(path))) - 21) <= 1
    with pytest.raises(ValueError, match="length"):
        movie(watch_run(), tmp_path / "n.mp4", length=2.0)
    assert not (tmp_path / "n.mp4").exists()


def test_arrows_tell_the_force_on_a_rolling_disc():
    """Closed form of a uniform disc that rolls down a plane: normal force m g cos α, friction m g sin α / 3 uphill."""
    run = ws.simulate(ws.load(ws.profiles_dir() / "incline" / "scene.toml"), duration=1.2)
    (_, press), slope = ForceArrows(run, np.array([1.1])).at(0), math.radians(20.0)
    weight = run.scene.body("disc").mass * math.hypot(*run.scene.gravity)
    assert press.shape == (1, 2)
    assert math.hypot(*press[0]) == pytest.approx(weight * math.hypot(math.cos(slope), math.sin(slope) / 3.0), rel=1e-6)
    up = -np.array(run.scene.gravity) / math.hypot(*run.scene.gravity)
    assert press[0] @ up == pytest.approx(weight * (math.cos(slope) ** 2 + math.sin(slope) ** 2 / 3.0), rel=1e-6)


def test_no_arrow_stands_for_a_stop_that_is_not_drawn():
    """A tooth presses the click against its stop, and only the tooth is seen: its moment on the wheel is the drive's."""
    run = ws.simulate(ws.designs.winding_click(friction=0.0).scene())
    (((x, y),), ((fx, fy),)) = ForceArrows(run, np.array([run.t[-1]])).at(0)
    assert abs(x * fy - y * fx) == pytest.approx(0.5e-3, rel=1e-6)


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


@pytest.mark.parametrize(
    ("speed", "words"),
    [
        (1.0, "true speed"),
        (2.0, "2 × true speed"),
        (1.0 / 20.0, "1/20 of true speed"),
        (9.0 / 10.0, "9/10 of true speed"),
        (0.11 * 10 / 11.0 + 0.003, "0.103 of true speed"),
        (11.0 / 12.0, "0.9167 of true speed"),
        (1e-7, "1e-07 of true speed"),
    ],
)
def test_speeds(speed: float, words: str) -> None:
    assert speed_text(speed) == words


def test_points_turn_with_their_body_and_shift_with_it() -> None:
    rng = np.random.default_rng(4)
    points, frames = rng.normal(size=(7, 2)), rng.normal(size=(5, 3))
    z = (frames[:, :1] + 1j * frames[:, 1:2]) + np.exp(1j * frames[:, 2:]) * (points[:, 0] + 1j * points[:, 1])
    assert placed(points, frames) == pytest.approx(np.stack((z.real, z.imag), axis=2), abs=1e-14)


# Does the encoder get every byte of every frame, and is it noticed however it fails?

FRAMES = [np.random.default_rng(k).integers(0, 256, (90, 70, 4), np.uint8) for k in range(5)]


def program(*lines: str) -> list[str]:
    return [sys.executable, "-c", "\n".join(("import sys", *lines))]


def test_every_byte_arrives(tmp_path: Path) -> None:
    place = tmp_path / "bytes"
    _run(program(f"open({str(place)!r}, 'wb').write(sys.stdin.buffer.read())"), [frame.data for frame in FRAMES])
    assert place.read_bytes() == b"".join(frame.tobytes() for frame in FRAMES)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (("sys.stdin.buffer.read()", "sys.exit('bad frame')"), "bad frame"),
        (("sys.stdin.buffer.read()", "sys.exit(3)"), "without a message"),
        (
            ("sys.stdin.buffer.read()", "print('first\\n disk: No space left on it', file=sys.stderr)"),
            "disk: No space left on it",
        ),
        (("sys.stdin.buffer.read(9)", "print('had enough', file=sys.stderr)"), "had enough"),
    ],
)
def test_however_it_fails(lines: tuple[str, ...], said: str) -> None:
    """By its status, by its words, or by taking no more."""
    with pytest.raises(OSError, match=said):
        _run(program(*lines), [frame.data for frame in FRAMES] * 12)  # more than a pipe holds


def test_small_frames_do_not_linger_on_the_way() -> None:
    """They would fail once more when the pipe is closed, and hide what the encoder has said."""
    with pytest.raises(OSError, match="had enough"):
        _run(program("sys.stdin.buffer.read(9)", "print('had enough', file=sys.stderr)"), [bytes(1000)] * 1500)


def test_words_alone_are_no_failure() -> None:
    _run(program("sys.stdin.buffer.read()", "print('a warning', file=sys.stderr)"), [FRAMES[0].data])


@pytest.mark.parametrize("gif", [False, True])
@pytest.mark.parametrize("sound", [False, True])
def test_frames_of_a_palette_make_a_gif(gif: bool, sound: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Others are piped as they are; the sound is written beside the movie before the encoder runs."""
    made: list[Any] = []

    def run(command: list[str], frames: Any) -> None:
        made.append((command, [bytes(frame) for frame in frames]))
        heard = [one for one in command if one.endswith(".wav")]
        assert [Path(one).read_text(encoding="utf-8") for one in heard] == (["tick"] if sound and not gif else [])
        Path(command[-1]).write_text("movie", encoding="utf-8")

    class Palette:
        def indexed(self, frame: np.ndarray) -> bytes:
            return b"indexed" + frame[:1, :1].tobytes()

    monkeypatch.setattr(encoder, "_run", run)
    palette: Any = Palette() if gif else None

    def write(place: Path) -> None:
        place.write_text("tick", encoding="utf-8")

    encode(iter(FRAMES), tmp_path / "a.gif", (70, 90), 12.5, palette, write if sound else None)
    ((command, frames),) = made
    assert frames == [palette.indexed(one) if gif else one.tobytes() for one in FRAMES]
    asked = dict(pairwise(command))
    assert (asked["-s"], asked["-r"], asked["-pix_fmt"]) == ("70x90", "12.500000", "pal8" if gif else "rgba")
    assert ("-loop" in command) is gif and ("-an" in command) is (not gif and not sound)
    assert asked["-f"] == "rawvideo" and list(tmp_path.iterdir()) == [tmp_path / "a.gif"]


def test_options_of_an_mp4() -> None:
    command = _command(Path("a"), (70, 90), 60.0, False, Path("b.wav"))
    asked = dict(pairwise(command))
    assert [asked[name] for name in ("-c:v", "-crf", "-c:a", "-b:a", "-colorspace")] == [
        "libx264",
        "19",
        "aac",
        "128k",
        "bt709",
    ]
    assert command[-1] == "a" and command.index("b.wav") > command.index("-") and asked["-vf"].endswith("format=yuv420p")


def test_where_a_movie_can_be_written(tmp_path: Path) -> None:
    (tmp_path / "folder.mp4").mkdir()
    assert check_path(str(tmp_path / "a.Mp4")) == tmp_path / "a.Mp4" and check_path(tmp_path / "b.gif") == tmp_path / "b.gif"
    assert check_path(tmp_path / "new" / "a.mp4") == tmp_path / "new" / "a.mp4"  # missing folders are made
    for name, error in (("a.avi", ValueError), ("folder.mp4", IsADirectoryError)):
        with pytest.raises(error):
            check_path(tmp_path / name)
