"""Does the picture hold what moves, the right way up?"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from render.fake_runs import MM, disc_run, polygon, watch_run

from watchsim.render.view import MARGIN, Frame, placed, poses, view
from watchsim.scene.scene import Body

FRAME = Frame(0.0, 50.0, 1280.0, 600.0)


def seen(the_view, frames, points):
    """Pixels of points in metres."""
    matrix = the_view.matrix(the_view.centre_at(frames))
    return points @ matrix[:2, :2].T + matrix[:2, 2]


def test_a_flat_mechanism_is_turned_where_that_enlarges_it():
    run = watch_run()
    turned = view(run, (0.0, 2.0), FRAME, None, None)
    upright = view(run, (0.0, 2.0), FRAME, None, 0.0)
    assert turned.turn == pytest.approx(-math.pi / 2)
    # 10 mm from the foot of the wheel to the top of the roller, 4 mm across
    assert upright.scale == pytest.approx(600 * (1 - 2 * MARGIN) / (10 * MM), rel=1e-3)
    assert turned.scale > 1.25 * upright.scale
    tall = view(run, (0.0, 2.0), Frame(0, 0, 600, 1280), None, None)
    assert tall.turn == 0.0


def test_gravity_points_down():
    run = watch_run(gravity=(9.81, 0.0))
    shown = view(run, (0.0, 2.0), FRAME, None, None)
    down = shown.matrix(shown.centre)[:2, :2] @ np.array([1.0, 0.0])
    assert down / np.hypot(*down) == pytest.approx((0.0, -1.0), rel=1e-12, abs=1e-15)


def test_everything_stays_inside_at_equal_scales():
    run = watch_run()
    shown = view(run, (0.0, 2.0), FRAME, None, None)
    for t in np.linspace(0.0, 2.0, 37):
        frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
        pin = placed(np.array([[0.0, -0.85 * MM]]), frames["balance"][None])[0]
        x, y = seen(shown, frames, pin)[0]
        assert 0 <= x <= 1280 and 50 <= y <= 650
    matrix = shown.matrix(shown.centre)[:2, :2]
    assert matrix @ matrix.T == pytest.approx(shown.scale**2 * np.eye(2), rel=1e-12, abs=1e-6)


def test_a_pivoted_body_takes_only_the_room_it_sweeps():
    hand = Body("hand", "pivot", loops=(polygon([(0, 0), (10, 0), (10, 1), (0, 1)], "A"),))
    run = watch_run()
    run = replace(run, scene=replace(run.scene, bodies=(hand,)), slices={"hand": slice(1, 2)})
    narrow = view(run, (0.0, 0.9), FRAME, None, 0.0)  # swings by 0.1 rad only
    high = 10 * MM * math.sin(0.1) + 1 * MM * math.cos(0.1)
    low = -10 * MM * math.sin(0.1)
    assert narrow.centre[1] == pytest.approx(0.5 * (low + high), rel=1e-2)


def test_zoom_frames_the_named_bodies():
    run = watch_run()
    near = view(run, (0.0, 2.0), FRAME, ["balance"], None)
    assert near.centre == pytest.approx((0.0, 7 * MM), abs=1e-6)
    assert near.scale == pytest.approx(600 * (1 - 2 * MARGIN) / (2 * MM), rel=1e-3)
    with pytest.raises(ValueError, match="'ballance'; there are: wheel, lever, balance, banking"):
        view(run, (0.0, 2.0), FRAME, ["ballance"], None)


def test_a_far_traveller_is_followed_along_its_way():
    run = disc_run()
    shown = view(run, (0.0, 3.0), FRAME, None, None)
    assert shown.follow == "disc"
    for t in (0.0, 1.0, 3.0):
        frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
        x, y = seen(shown, frames, frames["disc"][None, :2])[0]
        assert x == pytest.approx(640, abs=1) and y == pytest.approx(350, abs=1)
    assert view(run, (0.0, 0.1), FRAME, None, None).follow is None


def test_a_scene_without_outlines_cannot_be_drawn():
    run = watch_run(bodies=(Body("wheel"), Body("lever"), Body("balance")))
    with pytest.raises(ValueError, match="no body of this scene has an outline"):
        view(run, (0.0, 2.0), FRAME, None, None)


def test_ground_near_the_bodies_is_brought_into_sight():
    """A disc of 50 mm stands still, 1 mm above a plane that reaches 20 m to the right, or a hundred sizes above it."""
    run = disc_run()
    for height, near in ((0.06, True), (10.0, False)):
        at_rest = replace(run, q=np.tile([0.3, height, 0.0], (len(run.t), 1)), u=0.0 * run.u, a=0.0 * run.a)
        shown = view(at_rest, (0.0, 3.0), FRAME, None, 0.0)
        below = seen(shown, {}, np.array([[0.3, -1e-3]]))[0]
        assert (FRAME.bottom < below[1] < FRAME.bottom + FRAME.height) == near
        left, right = seen(shown, {}, np.array([[0.25, height], [0.35, height]]))[:, 0]
        assert FRAME.left < left < right < FRAME.left + FRAME.width
