"""Are velocities, accelerations and bounds of material points those of rigid motions along given paths?"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.model.records import FIXED, FREE, PIVOT, SLIDE
from watchsim.simulation.first_closing import gap_bounds, lasting_gap, safe_times

LEFT = 0.4
PATHS = [np.polynomial.Polynomial(c) for c in ([0.3, 0.5, -0.4, 0.9], [-0.2, 1.5, 0.7, -0.3], [0.1, -0.8, 0.6, 0.5])]
RATIO = -0.5
AXIS = (0.6, 0.8)


def largest(series: np.polynomial.Polynomial) -> float:
    return float(np.abs(series(np.linspace(0.0, LEFT, 400))).max())


STEP = SimpleNamespace(bound=[largest(path.deriv(2)) for path in PATHS])


def frame(motion: int, t: float) -> tuple[float, float, float]:
    """x, y and angle of a body that begins at the origin of its place."""
    first = PATHS[0](t)
    if motion == FREE:
        return PATHS[0](t), PATHS[1](t), PATHS[2](t)
    return {
        FIXED: (0.0, 0.0, 0.0),
        PIVOT: (0.0, 0.0, RATIO * first),
        SLIDE: (RATIO * first * AXIS[0], RATIO * first * AXIS[1], 0.0),
    }[motion]


def place(motion: int, point: tuple[float, float], t: float) -> np.ndarray:
    x, y, turn = frame(motion, t)
    c, s = math.cos(turn), math.sin(turn)
    return np.array([x + c * point[0] - s * point[1], y + s * point[0] + c * point[1]])


def rates(motion: int, point: tuple[float, float], t: float) -> list[np.ndarray]:
    """Velocity, acceleration, third derivative by central quotients."""
    h = 2e-3
    p = [place(motion, point, t + k * h) for k in (-2, -1, 0, 1, 2)]
    velocity = (p[0] - 8 * p[1] + 8 * p[3] - p[4]) / (12 * h)
    acceleration = (-p[0] + 16 * p[1] - 30 * p[2] + 16 * p[3] - p[4]) / (12 * h * h)
    return [velocity, acceleration, (-p[0] + 2 * p[1] - 2 * p[3] + p[4]) / (2 * h**3)]


@pytest.mark.parametrize("motion", [FIXED, PIVOT, SLIDE, FREE])
@pytest.mark.parametrize("point", [(0.3, -0.2), (0.0, 0.0), (-0.01, 0.5)])
def test_a_material_point_moves_as_its_body_and_no_bound_is_exceeded(motion: int, point: tuple[float, float]) -> None:
    ratio = 1.0 if motion == FREE else RATIO
    turn = frame(motion, 0.0)[2]
    ahead, behind = frame(motion, 1e-6), frame(motion, -1e-6)
    vx, vy, w = ((one - other) / 2e-6 for one, other in zip(ahead, behind, strict=True))
    body = SimpleNamespace(first=0, motion=motion, ratio=ratio, axis_x=AXIS[0], axis_y=AXIS[1])
    model = SimpleNamespace(bodies=[body])
    instead = {
        "acceleration_on_path": lambda model, state, step, i, tau, path: PATHS[i].deriv(2)(tau),
        "jerk_bound": lambda model, state, step, i: largest(PATHS[i].deriv(3)),
    }
    c, s = math.cos(turn), math.sin(turn)
    arm = c * point[0] - s * point[1], s * point[0] + c * point[1]
    path = SimpleNamespace(pose=[SimpleNamespace(vx=vx, vy=vy, w=w)])
    found = in_python(lasting_gap._material_point, **instead)(model, None, STEP, 0, *arm, LEFT, 0.0, path)
    velocity, acceleration, _ = rates(motion, point, 0.0)
    assert found[:2] == pytest.approx(velocity.tolist(), abs=1e-7)
    assert found[2:4] == pytest.approx(acceleration.tolist(), abs=1e-6)
    true = max(float(np.hypot(*rates(motion, point, t)[2])) for t in np.linspace(0.0, LEFT, 60))
    assert true <= found[4] * 1.001 + 1e-5
    assert found[4] <= 8.0 * true + 1e-5  # no idle bound


@pytest.mark.parametrize("motion", [FIXED, PIVOT, SLIDE, FREE])
def test_bounds_of_a_frame_are_those_of_its_path_at_the_end_of_a_stretch(motion: int) -> None:
    ratio = 1.0 if motion == FREE else RATIO
    body = SimpleNamespace(first=0, motion=motion, ratio=ratio, carrier=-1)
    path = SimpleNamespace(u=[path.deriv()(0.0) for path in PATHS])
    bounds = in_python(gap_bounds.body_bounds)(SimpleNamespace(bodies=[body]), 0, LEFT, STEP, path)
    times = np.linspace(0.0, LEFT, 400)
    u, a = ([path.deriv(order)(times) for path in PATHS] for order in (1, 2))
    linear = {FREE: (np.hypot(u[0], u[1]), np.hypot(a[0], a[1])), SLIDE: (ratio * u[0], ratio * a[0])}.get(
        motion, (0.0 * times,) * 2
    )
    turning = {FREE: (u[2], a[2]), PIVOT: (ratio * u[0], ratio * a[0])}.get(motion, (0.0 * times,) * 2)
    true = [float(np.abs(x).max()) for x in (linear[0], turning[0], linear[1], turning[1])]
    for bound, least in zip(bounds, true, strict=True):
        assert least <= bound * (1.0 + 1e-12) and bound <= 2.5 * least
    turn = in_python(lasting_gap._fastest_turn)
    pose = SimpleNamespace(pose=[SimpleNamespace(w=ratio * u[0][0] if motion == PIVOT else u[2][0] if motion == FREE else 0.0)])
    assert turn(SimpleNamespace(bodies=[body]), 0, LEFT, STEP, pose) == pytest.approx(bounds[1])


def test_a_carried_frame_adds_the_motion_of_its_carrier_at_its_arm() -> None:
    carrier = SimpleNamespace(first=0, motion=PIVOT, ratio=1.0, carrier=-1)
    planet = SimpleNamespace(first=1, motion=PIVOT, ratio=2.0, carrier=0, x=0.3, y=-0.4)
    path = SimpleNamespace(u=[3.0, -1.0])
    step = SimpleNamespace(bound=[5.0, 7.0])
    found = in_python(gap_bounds.body_bounds)(SimpleNamespace(bodies=[carrier, planet]), 1, 0.1, step, path)
    turn = 3.0 + 5.0 * 0.1
    assert found == pytest.approx((turn * 0.5, 2.0 * (1.0 + 0.7), 5.0 * 0.5 + turn * turn * 0.5, 14.0))


@pytest.mark.parametrize("seed", range(30))
def test_a_way_stays_within_its_room_for_that_time(seed: int) -> None:
    rng = np.random.default_rng(seed)
    room, left = 10.0 ** rng.uniform(-6.0, -2.0), 10.0 ** rng.uniform(-3.0, 0.0)
    speed, push, jerk = 10.0 ** rng.uniform(-4.0, 2.0, 3) * (rng.random(3) < 0.8)
    time = in_python(lasting_gap._time_for)(room, speed, push, jerk, left)

    def way(t: float) -> float:
        return speed * t + push * t**2 / 2.0 + jerk * t**3 / 6.0

    assert 0.0 < time <= left and way(time) <= room * (1.0 + 1e-12)
    assert time == left or way(3.0 * time) >= room  # nor is much given away


def test_a_gap_that_falls_fast_need_not_be_looked_at_so_closely() -> None:
    ask = in_python(lasting_gap.may_last)
    assert ask(1.0, 5.0, 100.0) and ask(1.0, -0.3, 1.1) and not ask(1.0, -0.3, 1.2)


def held(way: float, turn: float, swing: float = 0.5, wait: float = 0.0, tau: float = 2.0) -> float:
    instead = {"room_beside_active": lambda *_: (way, turn), "time_immovable": lambda *_: wait}
    options, path = SimpleNamespace(extent=1e-9), SimpleNamespace(pose=None)
    return in_python(safe_times.time_held, **instead)(None, None, options, 0, tau, -1.0, (2.0, 5.0, swing, 4.0), path)


def test_a_contact_beside_one_in_force_is_held_until_point_or_normal_could_have_come_apart() -> None:
    assert held(1e-3, 1.0) == pytest.approx(0.5 * 1e-3 / 2.0)
    assert held(1.0, 1e-3) == pytest.approx(0.5 * 1e-3 / (0.5 + 2.0 / 2.0))
    assert held(0.0, 0.0) == pytest.approx(0.25 * 1e-9 / 2.0)


@pytest.mark.parametrize("tau", [2.0, 2e-3])
def test_no_wait_is_shorter_than_the_rounding_of_time(tau: float) -> None:
    assert held(-1.0, 0.0, wait=0.25, tau=tau) == 0.25
    assert held(-1.0, 0.0, wait=1e-30, tau=tau) == pytest.approx(4e-16 * tau, abs=0.0)
    assert held(-1.0, 0.0, wait=0.0, tau=tau) == 0.0


@pytest.mark.parametrize("seed", range(4))
def test_two_points_move_against_each_other_as_their_difference(seed: int) -> None:
    """The circle's centre and the point of the other body that lies there now; bounds add up."""
    rng = np.random.default_rng(seed)
    poses = [SimpleNamespace(x=x, y=y) for x, y in rng.normal(size=(2, 2)).tolist()]
    told = {5: rng.normal(size=5), 6: rng.normal(size=5)}
    asked = {}

    def material_point(model, state, step, body, rx, ry, left, tau, path):
        asked[body] = (rx, ry, left, tau)
        return tuple(told[body + 5])

    primitives = [SimpleNamespace(body=0, x=0.3, y=-0.7), SimpleNamespace(body=1, x=9.0, y=9.0)]
    model = SimpleNamespace(contacts=[None, SimpleNamespace(a=0, b=1)], primitives=primitives)
    instead = {"_material_point": material_point, "point_of": lambda pose, x, y: (2.0 * x, 3.0 * y)}
    path = SimpleNamespace(pose=poses)
    found = in_python(lasting_gap._points_apart, **instead)(model, None, 1, LEFT, 0.1, None, path)
    one, two = told[5], told[6]
    assert found == pytest.approx([*(one[:4] - two[:4]), one[4] + two[4]])
    assert asked[0] == (0.6, pytest.approx(-2.1), LEFT, 0.1)
    centre = np.array([poses[0].x + 0.6, poses[0].y - 2.1])
    assert asked[1] == (pytest.approx(centre[0] - poses[1].x), pytest.approx(centre[1] - poses[1].y), LEFT, 0.1)
