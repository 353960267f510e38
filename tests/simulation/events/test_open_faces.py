"""Does a ball move on an open chain of a drawing as the closed forms say?"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import pytest
from reference import pendulum

from watchsim.scene.file.load import load
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

sys.path.append(str(Path(__file__).resolve().parents[2] / "drawing"))
import dxf_text as d

GRAVITY, BOWL, BALL = 9.81, 30e-3, 2e-3
SCENE = """
[scene]
gravity = ["0 m/s²", "-9.81 m/s²"]
[bodies.ground]
drawing = "ground.dxf"
motion = "fixed"
material = ["0 mm", "-40 mm"]
[bodies.ball]
circle = "2 mm"
motion = "free"
mass = "1 g"
position = ["{x!r} mm", "{y!r} mm"]
[[contacts]]
between = ["ground", "ball"]
[run]
duration = "{duration!r} s"
tolerance = 1e-11
"""


@pytest.mark.parametrize("forward", [True, False])
def test_a_ball_in_an_open_bowl_swings_like_a_pendulum(tmp_path: Path, forward: bool) -> None:
    """Without friction its centre runs on a circle of the difference of the radii."""
    reach = 1e3 * BOWL * math.sin(1.2)
    height = -1e3 * BOWL * math.cos(1.2)
    bulge = math.tan(0.6) if forward else -math.tan(0.6)
    ends = [(-reach, height, bulge), (reach, height)] if forward else [(reach, height, bulge), (-reach, height)]
    (tmp_path / "ground.dxf").write_bytes(d.dxf(d.lwpolyline(ends, False)))
    length, start = BOWL - BALL, 0.6
    x, y = 1e3 * length * math.sin(start), -1e3 * length * math.cos(start)
    (tmp_path / "scene.toml").write_text(SCENE.format(x=x, y=y, duration=1.0), encoding="utf-8")
    done = simulate(load(tmp_path / "scene.toml"))
    assert done.stop == Stop.DURATION
    for t in (0.1, 0.37, 1.0):
        q, _ = done.at(t)
        angle, _ = pendulum.swing(t, start, math.sqrt(GRAVITY / length))
        assert math.atan2(q[0], -q[1]) == pytest.approx(angle, abs=1e-6)
        assert math.hypot(q[0], q[1]) == pytest.approx(length, abs=1e-9)


def test_a_ball_slides_down_a_line_and_off_its_end(tmp_path: Path) -> None:
    """Down the slope with g sin α, then along a parabola."""
    slope, way = math.radians(30.0), 10e-3
    foot = (0.0, 0.0)
    head = (-50.0 * math.cos(slope), 50.0 * math.sin(slope))
    (tmp_path / "ground.dxf").write_bytes(d.dxf(d.line(foot, head)))
    x = -way * math.cos(slope) + BALL * math.sin(slope)
    y = way * math.sin(slope) + BALL * math.cos(slope)
    (tmp_path / "scene.toml").write_text(SCENE.format(x=1e3 * x, y=1e3 * y, duration=0.2), encoding="utf-8")
    done = simulate(load(tmp_path / "scene.toml"))
    leaves = math.sqrt(2.0 * way / (GRAVITY * math.sin(slope)))
    speed = GRAVITY * math.sin(slope) * leaves
    q, _ = done.at(0.5 * leaves)
    assert q[0] == pytest.approx(x + 0.25 * way * math.cos(slope), abs=1e-9)
    q, u = done.at(leaves)
    assert math.hypot(u[0], u[1]) == pytest.approx(speed, rel=1e-6)
    assert q[0] == pytest.approx(BALL * math.sin(slope), abs=1e-8)
    assert speed * speed / BALL > GRAVITY * math.cos(slope), "too fast to turn about the end of the line: it flies"
    after = 0.2 - leaves
    q, _ = done.at(0.2)
    assert q[0] == pytest.approx(BALL * math.sin(slope) + speed * math.cos(slope) * after, abs=1e-7)
    assert q[1] == pytest.approx(
        BALL * math.cos(slope) - speed * math.sin(slope) * after - 0.5 * GRAVITY * after * after, abs=1e-7
    )
