"""Are springs between points drawn from point to point, wherever the bodies go, and all within the picture?"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from render.fake_runs import MM, watch_run

from watchsim.pages.report_page import page_text
from watchsim.render.palette import BLUED
from watchsim.render.stage import Stage
from watchsim.render.view import COILS, WIDTH, poses, zigzags
from watchsim.scene.forces import LineSpring
from watchsim.simulation.trajectory import Trajectory

HOOK = (30.0 * MM, 40.0 * MM)  # far from all bodies
SPRING = LineSpring(("lever", None), ((1.0 * MM, 0.5 * MM), HOOK), stiffness=1.0, length=5.0 * MM)


def run_with_spring() -> Trajectory:
    run = watch_run()
    return replace(run, scene=replace(run.scene, line_springs=(SPRING,)))


def at(run: Trajectory, t: float) -> dict[str, np.ndarray]:
    return {name: rows[0] for name, rows in poses(run, np.array([t])).items()}


def test_the_zigzag_runs_from_point_to_point_about_the_line() -> None:
    run = run_with_spring()
    (spring,) = zigzags(run.scene)
    for t in (0.1, 0.7, 1.9):
        frames = at(run, t)
        x, y, angle = frames["lever"]
        first = complex(x, y) + complex(*SPRING.points[0]) * complex(math.cos(angle), math.sin(angle))
        way = complex(*HOOK) - first
        seen = (spring.line(frames) @ [1.0, 1j] - first) / way  # the line is the real axis from 0 to 1
        assert abs(seen[0]) < 1e-12 and abs(seen[-1] - 1.0) < 1e-12
        assert np.all(np.diff(seen.real) > 0.0)
        sides = abs(way) * seen.imag
        assert np.count_nonzero(np.diff(np.sign(sides[2:-2])) != 0.0) == 2 * COILS - 1
        assert np.ptp(np.abs(sides[2:-2])) < 1e-15
    apart = math.dist(HOOK, zigzags(run.scene)[0].ends(at(run, 0.0))[0])
    assert spring.half == WIDTH * max(apart, SPRING.length)


def test_the_picture_has_room_for_the_fixed_end_and_shows_the_wire() -> None:
    run, size = run_with_spring(), (960, 540)
    stage = Stage(run, size, (0.0, 2.0))
    frames = at(run, 0.7)
    matrix = stage.view.matrix(stage.view.centre_at(frames))
    x, y, _ = matrix @ (*HOOK, 1.0)
    assert 0.0 < x < size[0] and 0.0 < y < size[1]
    picture = stage.draw(0.7, frames)
    pin = picture[size[1] - 1 - math.floor(y), math.floor(x), :3]
    wanted = [int(BLUED.line[k : k + 2], 16) for k in (1, 3, 5)]
    assert np.abs(pin.astype(int) - wanted).max() < 40


def test_the_page_holds_it_in_player_and_still_picture() -> None:
    text = page_text(run_with_spring())
    assert 'data-zigzag="0"' in text and '"half":' in text
    assert "data-zigzag=" not in page_text(watch_run()).split("<script")[0]
