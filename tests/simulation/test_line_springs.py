"""Do springs between points of bodies act as the equations say? Against scipy's integrator, written down independently."""

import math

import numpy as np
import pytest
from scene.made_gears import read
from scipy.integrate import solve_ivp

import watchsim as ws
from watchsim.scene.errors import SceneError
from watchsim.simulation.state import EventKind

SCENE = """
[scene]
title = "a lever, a slide and a free disc on line springs"

[bodies.lever]
position = ["1 mm", "2 mm"]
angle = "20°"
inertia = "1 g·cm²"

[bodies.slide]
motion = "slide"
position = ["10 mm", "0 mm"]
axis = [0.6, 0.8]
mass = "3 g"
velocity = "20 mm/s"

[bodies.disc]
motion = "free"
position = ["5 mm", "9 mm"]
angle = "70°"
velocity = ["0 mm/s", "-30 mm/s"]
mass = "2 g"
inertia = "0.4 g·cm²"

[[line_springs]]
between = ["lever", "slide"]
points = [["4 mm", "1 mm"], ["0 mm", "1 mm"]]
stiffness = "20 N/m"
length = "3 mm"

[[line_springs]]
between = ["slide", "disc"]
points = [["0 mm", "2 mm"], ["1 mm", "-2 mm"]]
stiffness = "5 N/m"
length = "7 mm"
{damped}

[[line_springs]]
between = ["disc"]
points = [["-2 mm", "0 mm"], ["2 mm", "12 mm"]]
stiffness = "8 N/m"
tension = "10 mN"

[run]
duration = "0.3 s"
tolerance = 1e-12
"""
J, M, m, DISC = 1e-7, 3e-3, 2e-3, 0.4e-7


def rotated(angle: float, point: tuple[float, float]) -> np.ndarray:
    return np.array(
        [math.cos(angle) * point[0] - math.sin(angle) * point[1], math.sin(angle) * point[0] + math.cos(angle) * point[1]]
    )


def oracle(c: float, t: float) -> np.ndarray:
    """q = lever angle, slide travel, disc x, y, angle; forces from the energy's finite geometry, by hand."""
    axis = np.array([0.6, 0.8])
    start = np.array([math.radians(20.0), 0.0, 5e-3, 9e-3, math.radians(70.0), 0.0, 20e-3, 0.0, -30e-3, 0.0])
    wall = np.array([2e-3, 12e-3])
    free = math.dist(start[2:4] + rotated(start[4], (-2e-3, 0.0)), wall) - 0.01 / 8.0

    def rates(_t: float, y: np.ndarray) -> np.ndarray:
        a, s, x, yy, b, wa, vs, vx, vy, wb = y
        arm1 = rotated(a, (4e-3, 1e-3))
        p1, v1 = np.array([1e-3, 2e-3]) + arm1, wa * np.array([-arm1[1], arm1[0]])
        base = np.array([10e-3, 0.0]) + s * axis
        up, v2 = np.array([0.0, 1e-3]), vs * axis
        p2, p3 = base + up, base + 2.0 * up
        arm4, arm5 = rotated(b, (1e-3, -2e-3)), rotated(b, (-2e-3, 0.0))
        centre, v = np.array([x, yy]), np.array([vx, vy])
        v4 = v + wb * np.array([-arm4[1], arm4[0]])

        def pull(p: np.ndarray, q: np.ndarray, k: float, rest: float, rate: np.ndarray, d: float = 0.0) -> np.ndarray:
            n = (q - p) / np.linalg.norm(q - p)
            return (k * (np.linalg.norm(q - p) - rest) + d * float(rate @ n)) * n

        f1 = pull(p1, p2, 20.0, 3e-3, v2 - v1)
        f2 = pull(p3, centre + arm4, 5.0, 7e-3, v4 - v2, c)
        f3 = pull(centre + arm5, wall, 8.0, free, -v)
        turn = -(arm4[0] * f2[1] - arm4[1] * f2[0]) + arm5[0] * f3[1] - arm5[1] * f3[0]
        lever = (arm1[0] * f1[1] - arm1[1] * f1[0]) / J
        disc = (f3 - f2) / m
        return np.array([wa, vs, vx, vy, wb, lever, float((f2 - f1) @ axis) / M, disc[0], disc[1], turn / DISC])

    return np.asarray(solve_ivp(rates, (0.0, t), start, method="DOP853", rtol=1e-12, atol=1e-15).y[:5, -1])


@pytest.mark.parametrize(("damped", "c"), [("", 0.0), ('viscous = "0.05 N·s/m"', 0.05)])
def test_the_motion_is_that_of_an_independent_integration(tmp_path, damped, c) -> None:
    run = ws.simulate(read(tmp_path, SCENE.format(damped=damped)))
    assert run.end_q == pytest.approx(oracle(c, 0.3), abs=1e-9)
    assert run.energy["residual_relative"] < 1e-9
    assert (run.energy["dissipated"]["damping"] > 1e-7) == (c > 0.0)


def test_the_other_method_agrees_at_its_order(tmp_path) -> None:
    scene = read(tmp_path, SCENE.format(damped='viscous = "0.05 N·s/m"'))
    exact = oracle(0.05, 0.1)
    errors = [np.abs(ws.simulate(scene, duration=0.1, method="moreau", step=h).end_q - exact).max() for h in (2e-4, 1e-4)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.3)
    assert ws.simulate(scene, duration=0.1, method="moreau", step=1e-4).energy["residual_relative"] < 1e-9


LEAF = """
[scene]
title = "a leaf spring that rests on its stop"

[bodies.detent]
inertia = "1 g·cm²"
circle = "5 mm"

[bodies.blade]
motion = "slide"
axis = [0.0, 1.0]
position = ["0 mm", "7 mm"]
mass = "1 g"
circle = "1 mm"

[bodies.stop]
motion = "fixed"
line = [["3 mm", "6 mm"], ["-3 mm", "6 mm"]]

[[line_springs]]
between = ["blade"]
points = [["0 mm", "0 mm"], ["0 mm", "30 mm"]]
stiffness = "10 N/m"
tension = "-5 mN"

[[contacts]]
between = ["blade", "stop"]

[[torques]]
body = "blade"
over = "time"
table = [["0 s", "0 mN"], ["1 s", "10 mN"]]

[run]
duration = "1 s"
"""


def test_a_preloaded_leaf_spring_leaves_its_stop_at_its_preload(tmp_path) -> None:
    """Pressed down by 5 mN, it lifts off when the force has grown to that, at 0.5 s."""
    run = ws.simulate(read(tmp_path, LEAF))
    opened = run.events[run.events["kind"] == EventKind.OPEN]["t"]
    assert opened[:1] == pytest.approx([0.5], abs=1e-6)
    w = math.sqrt(10.0 / 1e-3)
    assert run.end_q[1] == pytest.approx(1e-3 * 0.5 - 1e-3 / w * math.sin(0.5 * w), abs=1e-8)


def test_what_cannot_be_is_a_fault(tmp_path) -> None:
    def faults(more: str) -> dict[str, str]:
        with pytest.raises(SceneError) as caught:
            read(tmp_path, SCENE.format(damped="") + "\n[[line_springs]]\n" + more)
        return {fault.key: fault.message for fault in caught.value.faults}

    points = 'points = [["0 mm", "0 mm"], ["9 mm", "0 mm"]]\nstiffness = "1 N/m"\n'
    assert "there is no body" in faults(points + 'between = ["lever", "slyde"]')["line_springs.3.between.1"]
    for between in ('["lever", "lever"]', "[]", '["lever", "slide", "disc"]'):
        assert "one or two bodies are needed" in faults(f"{points}between = {between}")["line_springs.3.between"]
    assert "from its pivot" in faults('stiffness = "1 N/m"\nbetween = ["lever"]')["line_springs.3"]
    assert "leave one out" in faults(points + 'between = ["lever"]\nlength = "1 mm"\ntension = "1 N"')["line_springs.3.tension"]
    assert "shorter than nothing" in faults(points + 'between = ["lever"]\ntension = "1 N"')["line_springs.3.tension"]


GEARED = """
[scene]
title = "two bodies that turn together, one of them on a line spring"
[bodies.first]
inertia = "1 g·cm²"
angle = "20°"
[bodies.second]
position = ["30 mm", "0 mm"]
inertia = "0.2 g·cm²"
[[gears]]
between = ["first", "second"]
ratio = -3.0
[[line_springs]]
between = ["{held}"]
points = [["4 mm", "1 mm"], ["12 mm", "9 mm"]]
stiffness = "20 N/m"
length = "3 mm"
[run]
duration = "0.2 s"
tolerance = 1e-12
"""


@pytest.mark.parametrize(("held", "place", "ratio"), [("first", 0.0, 1.0), ("second", 30e-3, -3.0)])
def test_a_line_spring_turns_what_is_geared_to_its_body_by_the_ratio(tmp_path, held, place, ratio) -> None:
    """By Lagrange's equation of the one coordinate, the torque being the derivative of the spring's energy."""
    angle = {"first": math.radians(20.0), "second": 0.0}[held]

    def length(turned: float) -> float:
        return math.dist(np.array([place, 0.0]) + rotated(angle + ratio * turned, (4e-3, 1e-3)), (12e-3, 9e-3))

    def rates(_t: float, y: np.ndarray) -> list[float]:
        slope = (length(y[0] + 1e-5) - length(y[0] - 1e-5)) / 2e-5
        return [y[1], -20.0 * (length(y[0]) - 3e-3) * slope / (1e-7 + 9.0 * 0.2e-7)]

    turned = solve_ivp(rates, (0.0, 0.2), [0.0, 0.0], method="DOP853", rtol=1e-11, atol=1e-12).y[0, -1]
    run = ws.simulate(read(tmp_path, GEARED.format(held=held)))
    first, second = run.q[-1] - run.q[0]
    assert abs(turned) > 0.01 and first == pytest.approx(turned, abs=1e-6)
    assert second == pytest.approx(-3.0 * first, abs=1e-12) and run.energy["residual_relative"] < 1e-9
