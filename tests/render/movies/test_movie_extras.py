"""Do insets, strip, phase names and arrows show what they say, where they say it?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from every_time import few
from matplotlib.colors import to_rgb
from render.fake_runs import disc_run, slide_run, watch_run
from shapely import LineString, Point

import watchsim as ws
from watchsim.analysis.forces import forces
from watchsim.analysis.timeline import shown_beats
from watchsim.geometry.loops import polyline
from watchsim.render.insets import beside, insets
from watchsim.render.marks import ForceArrows, PalletStones, arrow_path, changing_speed_text
from watchsim.render.movie import frame, movie
from watchsim.render.palette import CONTACT, RUBY
from watchsim.render.stage import Extras
from watchsim.render.view import Frame, poses

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
        body, loop = PalletStones(run.scene).stone(f"{beat.stages[0].pallet} stone")
        edges = LineString(polyline(loop, 1e-8))
        assert body.name == "lever" and edges.distance(Point(own)) < 2e-8
        assert insets(run, (0.0, 0.6), [f"{beat.stages[0].pallet} stone"], [BOX], 0.0)[0].box == BOX


def test_no_stones_no_inset():
    run = ws.simulate(ws.load(ws.profiles_dir() / "incline"), duration=0.05)
    with pytest.raises(ValueError, match=r'inset "exit stone" is not known.*nothing swings'):
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
