"""Are times in which a gap cannot close those of the worst motion that the bounds allow?"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.model.records import ARC, LINE, PIVOT
from watchsim.simulation.first_closing import lasting_gap, safe_times, sunk_level


@pytest.mark.parametrize("seed", range(40))
def test_the_longer_of_the_straight_and_the_curved_way(seed: int) -> None:
    """With centres that stay half as far apart as they are, over the time in which they do; roots by numpy."""
    rng = np.random.default_rng(seed)
    room, approach, closing, bend = 10.0 ** rng.uniform(-2.0, 1.0, 4) * [1.0, rng.choice([-1.0, 1.0]), 1.0, 1.0]
    distance = math.inf if seed % 3 == 0 else float(10.0 ** rng.uniform(-5.0, 1.0))
    limit, curve = 0.5 * distance / closing, bend + (0.0 if distance == math.inf else closing**2 / (0.5 * distance))
    roots = np.roots([-0.5 * curve, -approach, room])
    expected = max(room / closing, min(float(roots[roots > 0.0][0]), limit))
    assert in_python(safe_times.safe_time)(room, approach, closing, bend, distance) == pytest.approx(expected)


def test_without_bend_a_gap_that_does_not_fall_stays_open() -> None:
    ask = in_python(safe_times.safe_time)
    assert ask(0.3, -0.2, 2.0, 0.0, math.inf) == math.inf and ask(0.3, 0.0, 2.0, 0.0, math.inf) == math.inf
    assert ask(0.3, 0.2, 2.0, 0.0, math.inf) == pytest.approx(1.5)
    assert ask(0.3, 1e-4, 2.0, 0.0, math.inf) == pytest.approx(3e3)
    assert ask(0.3, -0.2, 2.0, 1e-4, math.inf) == pytest.approx((0.2 + (0.04 + 0.6e-4) ** 0.5) / 1e-4)
    assert ask(0.3, -0.2, 2.0, 0.1, 0.0) == 0.15  # concentric: nothing is known of the curve


@pytest.mark.parametrize("kind", [LINE, ARC])
@pytest.mark.parametrize("seed", range(12))
def test_outside_until_the_normal_or_the_point_could_have_come_in(seed: int, kind: int) -> None:
    rng = np.random.default_rng(seed)
    a = SimpleNamespace(radius=rng.uniform(0.1, 0.5), length=rng.uniform(0.1, 0.5))
    b = SimpleNamespace(radius=rng.uniform(0.1, 0.5), kind=kind)
    model = SimpleNamespace(contacts=[SimpleNamespace(a=0, b=1)], primitives=[a, b])
    inside_a, inside_b = rng.uniform(-1e-3, 5e-4, 2)
    closing, swing, distance = rng.uniform(0.2, 2.0, 3)
    turn = swing + closing / (0.5 * distance)
    times = [0.0]
    if inside_a < 0.0:
        times.append(-inside_a / (turn * max(a.radius, a.length)))
    if inside_b < 0.0:
        times.append(-inside_b / closing if kind == LINE else -inside_b / (turn * b.radius))
    ask = in_python(safe_times.time_outside)
    assert ask(model, 0, inside_a, inside_b, (closing, swing), distance) == pytest.approx(max(times))
    assert ask(model, 0, -9.0, inside_b, (closing, swing), distance) == pytest.approx(0.5 * distance / closing)
    slowly = ask(model, 0, -1e-3, 1.0, (closing, 1e-4), math.inf)
    assert slowly == pytest.approx(10.0 / max(a.radius, a.length))


@pytest.mark.parametrize(
    ("motion", "time"),
    [
        ((0.2, 0.0, 0.0), 0.1),
        ((0.0, 0.5, 0.0), 0.08**0.5),
        ((0.0, 0.0, 0.7), (0.12 / 0.7) ** (1 / 3)),
        ((0.01, 0.02, 0.03), 0.9),
    ],
)
def test_a_third_of_the_room_for_speed_acceleration_and_jerk_each(motion: tuple[float, float, float], time: float) -> None:
    """0.06 m: 0.02 = v t = a t² / 2 = j t³ / 6. Just below that much of each it is all the time there is."""
    ask, room = in_python(lasting_gap._time_for), 0.06
    assert ask(room, *motion, 0.9) == pytest.approx(time)
    for place, limit in enumerate((0.02 / 0.9, 0.04 / 0.81, 0.12 / 0.729)):
        for share in (0.999, 1.001):
            one = [0.0, 0.0, 0.0]
            one[place] = share * limit
            found = ask(room, *one, 0.9)
            assert found == 0.9 if share < 1.0 else found == pytest.approx(0.9 * share ** (-1.0 / (place + 1)))


def asked(kernel: str, *, side: float = 1.0, carried: tuple[int, int] = (-1, -1), rate: float = -0.3) -> object:
    """What is asked of `_time_for`, or 0, about points whose velocity is (0.3, -0.4) and acceleration (-1.2, 0.5)."""
    primitives = [SimpleNamespace(body=0, side=-1.0), SimpleNamespace(body=1, side=side)]
    bodies = [SimpleNamespace(carrier=one) for one in carried]
    model = SimpleNamespace(contacts=[SimpleNamespace(a=0, b=1)], primitives=primitives, bodies=bodies)
    instead = {
        "_points_apart": lambda model, state, k, left, tau, step, path: (0.3, -0.4, -1.2, 0.5, 7.0 * left + tau),
        "_fastest_turn": lambda model, b, left, step, path: 2.0 * b + left,
        "normal_gap": lambda model, k, pose: SimpleNamespace(nx=0.8, ny=0.6, rate=rate),
        "_time_for": lambda *given: given,
    }
    found: object = in_python(getattr(lasting_gap, kernel), **instead)(
        model, None, 0, 0.06, 0.9, 0.2, None, SimpleNamespace(pose=None)
    )
    return found


def test_a_place_moves_by_the_motion_of_its_points() -> None:
    assert asked("time_still") == pytest.approx((0.06, 0.5, 1.3, 6.5, 0.9))


@pytest.mark.parametrize(("rate", "falls"), [(-0.3, 0.3), (0.3, 0.0)])
def test_a_gap_falls_by_what_goes_against_a_normal_that_turns(rate: float, falls: float) -> None:
    """(e·x)'' has e·a, twice e'·v; its change e·j, three times e'·a, and what the turning makes of these."""
    turn, push = 2.9, 0.8 * 1.2 - 0.6 * 0.5
    expected = (0.06, falls, push + 2.0 * turn * 0.5, 6.5 * (1.0 + turn * 0.9) + 3.0 * turn * 1.3, 0.9)
    assert asked("time_apart", rate=rate) == pytest.approx(expected)


def test_nothing_is_said_of_carried_bodies_and_of_the_gap_of_hollow_arcs() -> None:
    for carried in ((0, -1), (-1, 0), (2, 3)):
        assert asked("time_still", carried=carried) == asked("time_apart", carried=carried) == 0.0
    assert asked("time_apart", side=-1.0) == 0.0 != asked("time_still", side=-1.0)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_tangent_is_followed_where_the_gap_could_not_be_deeper_than_rounding_then(share: float) -> None:
    """B t² / 2 with t = g / v; else the safe time counts."""
    gap, rate, gap_zero = 3e-13, -6e-7, 1e-13
    bend = share * 2.0 * gap_zero / (gap / rate) ** 2
    asked = in_python(safe_times.time_to_touch, safe_time=lambda *given: given)
    found = asked(gap, rate, (2.0, bend, 0.4), SimpleNamespace(gap_zero=gap_zero))
    assert found == (pytest.approx(5e-7) if share < 1.0 else (gap, -rate, 2.0, bend, 0.4))


@pytest.mark.parametrize(("swing", "time"), [(0.0, 0.5 * 1e-3 / 5e-5), (1e-4, 0.5 * 1e-3 / 1.5e-4)])
def test_what_turns_slowly_is_the_same_contact_for_long(swing: float, time: float) -> None:
    asked = in_python(safe_times.time_held, room_beside_active=lambda *_: (1.0, 1e-3))
    found = asked(None, None, SimpleNamespace(extent=1e-9), 0, 2.0, -1.0, (1e-4, 5.0, swing, 4.0), SimpleNamespace(pose=None))
    assert found == pytest.approx(time)


def test_kinematics_are_asked_where_they_are_put() -> None:
    """In the room for one contact."""
    rows: list[int] = []

    def put(model: object, k: int, pose: object, row: int, out: object) -> None:
        rows.append(row)

    def asked(model: object, out: object, row: int, depth: float = 0.0) -> bool:
        rows.append(row)
        return True

    path, line = SimpleNamespace(pose=None, probe=None), SimpleNamespace(kind=ARC, body=0)
    model = SimpleNamespace(contacts=[SimpleNamespace(b=0)], primitives=[line], bodies=[SimpleNamespace(motion=PIVOT)])
    options = SimpleNamespace(behind=1e-8, sunk=1e-6, extent=1e-9)
    waits = in_python(safe_times.time_immovable, contact_kinematics=put, is_immovable=asked)
    assert waits(model, options, 0, -1.0, 1.0, path) > 0.0
    instead = {"contact_kinematics": put, "has_one_way": asked, "_by_concave_joint": lambda *_: True}
    assert in_python(sunk_level.sunk_level, **instead)(model, options, 0, -5e-7, 0.0, path) == -5e-7
    assert rows == [0, 0, 0, 0]
