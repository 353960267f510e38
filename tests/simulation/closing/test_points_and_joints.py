"""How does the point of a body move that lies at a contact, and which joint of a line is the nearer one?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.model.records import FIXED, FREE, LINE, PIVOT, SLIDE
from watchsim.simulation.first_closing import lasting_gap, sunk_level


@pytest.mark.parametrize("seed", range(20))
def test_the_joint_is_that_at_the_nearer_end_of_the_line(seed: int) -> None:
    """Wherever the two bodies stand."""
    rng = np.random.default_rng(seed)
    poses = []
    for _ in range(2):
        turn = np.exp(1j * rng.uniform(-3.0, 3.0))
        poses.append(SimpleNamespace(x=rng.normal(), y=rng.normal(), c=turn.real, s=turn.imag))
    way = np.exp(1j * rng.uniform(-3.0, 3.0))
    line = SimpleNamespace(
        body=1, kind=LINE, x=rng.normal(), y=rng.normal(), tx=way.real, ty=way.imag, length=0.5 if seed < 10 else 1e-3
    )
    line.before, line.after = (-1, 0) if seed % 2 else (0, -1)

    def world(pose: SimpleNamespace, at: complex) -> complex:
        return complex(pose.x, pose.y) + at * complex(pose.c, pose.s)

    point = SimpleNamespace(body=0, x=rng.normal(), y=rng.normal())
    centre, start = world(poses[0], complex(point.x, point.y)), world(poses[1], complex(line.x, line.y))
    end = world(poses[1], complex(line.x, line.y) + line.length * way)
    nearer = line.after if abs(centre - end) < abs(centre - start) else line.before
    model = SimpleNamespace(contacts=[SimpleNamespace(a=0, b=1)], primitives=[point, line])
    assert bool(in_python(sunk_level._by_concave_joint)(model, 0, poses)) == (nearer < 0)


@pytest.mark.parametrize(("motion", "turn"), [(FIXED, 9), (SLIDE, 9), (PIVOT, 2), (FREE, 4)])
def test_a_material_point_has_the_jerk_of_its_body_and_of_its_turning(motion: int, turn: int) -> None:
    """Translation by the sum of both axes; turning by twist', three times turn·twist and turn³ at the arm."""
    body = SimpleNamespace(motion=motion, first=2, ratio=1.0 if motion == FREE else -0.5, axis_x=0.6, axis_y=-0.8)
    jerks, bounds = [9.0, 9.0, 0.3, 0.7, 1.1, 9.0], np.array([9.0, 9.0, 0.2, 9.0, 0.4, 9.0])
    speeds = [9.0, 9.0, 0.5, -0.7, 1.3, 9.0]
    instead = {
        "acceleration_on_path": lambda model, state, step, i, tau, path: speeds[i] * tau,
        "jerk_bound": lambda model, state, step, i: jerks[i],
    }
    pose = SimpleNamespace(vx=0.2, vy=-0.3, w=-0.6)
    ask = in_python(lasting_gap._material_point, **instead)
    found = ask(SimpleNamespace(bodies=[None, body]), None, SimpleNamespace(bound=bounds), 1, 0.3, -0.4, 1.5, 2.0,
                SimpleNamespace(pose=[None, pose]))  # fmt: skip
    if motion == FIXED:
        assert found == (0.0,) * 5
        return
    if motion == SLIDE:
        assert found == pytest.approx((0.2, -0.3, -0.5 * 1.0 * 0.6, 0.5 * 1.0 * 0.8, 0.5 * 0.3))
        return
    ratio, own = abs(body.ratio), 0.3 + 0.7 if motion == FREE else 0.0
    fastest = 0.6 + ratio * bounds[turn] * 1.5
    jerk = own + 0.5 * (ratio * jerks[turn] + 3.0 * ratio * bounds[turn] * fastest + fastest**3)
    twist, point = body.ratio * speeds[turn] * 2.0, complex(0.3, -0.4)
    a = 1j * twist * point - 0.36 * point + (complex(speeds[2], speeds[3]) * 2.0 if motion == FREE else 0.0)
    v = complex(0.2, -0.3) - 0.6j * point
    assert found == pytest.approx((v.real, v.imag, a.real, a.imag, jerk))
    fast = in_python(lasting_gap._fastest_turn)
    path = SimpleNamespace(pose=[None, pose])
    assert fast(SimpleNamespace(bodies=[None, body]), 1, 1.5, SimpleNamespace(bound=bounds), path) == pytest.approx(fastest)


@pytest.mark.parametrize("motion", [FIXED, SLIDE])
def test_what_does_not_turn_has_no_turning_rate(motion: int) -> None:
    body = SimpleNamespace(motion=motion, first=2, ratio=1.0)
    path, step = SimpleNamespace(pose=[SimpleNamespace(w=0.5)]), SimpleNamespace(bound=np.ones(5))
    assert in_python(lasting_gap._fastest_turn)(SimpleNamespace(bodies=[body]), 0, 1.5, step, path) == 0.0
