"""How large are the vectors that the bar terms of a contact are made of? Two outlines, worked out with complex numbers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.kinematics import closed_contacts, contact_kinematics
from watchsim.contact.poses import place, poses
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.tolerances import SPIN_ROUNDING

_kinematics, _place = in_python(contact_kinematics), in_python(place)
SMALL, LARGE = 0.3, 1.1  # m
OFF_SMALL, OFF_LARGE = 0.2 - 0.5j, -0.4 + 0.7j  # of the middles, from the bodies' origins
Pose = tuple[float, float, float]


def round_loop(radius: float, centre: complex, hole: bool = False) -> Loop:
    return Loop((Arc(centre.real, centre.imag, radius, 0.3, -TURN if hole else TURN),), hole=hole)


def row(a: Loop, pose_a: Pose, rates_a: Pose, b: Loop, pose_b: Pose, rates_b: Pose) -> Any:
    """Kinematics of the only contact of two free bodies."""
    bodies = tuple(Body(name, "free", mass=1.0, inertia=1.0, loops=(loop,)) for name, loop in (("a", a), ("b", b)))
    model = compile_scene(Scene("two", bodies, contacts=(Contact((Side("a"), Side("b"))),))).model
    pose, closed = poses(2), closed_contacts(1)
    _place(model, np.array((*pose_a, *pose_b)), np.array((*rates_a, *rates_b)), pose)
    _kinematics(model, 0, pose, 0, closed)
    return closed.kin[0]


def out(pose: Pose, point: complex) -> complex:
    return complex(*pose[:2]) + point * np.exp(1j * pose[2])


def speed(pose: Pose, rates: Pose, point: complex) -> complex:
    """Of the material at that place in the world."""
    return complex(*rates[:2]) + 1j * rates[2] * (point - complex(*pose[:2]))


def taxi(way: complex) -> float:
    return abs(way.real) + abs(way.imag)


@pytest.mark.parametrize("hollow", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_of_two_circles(hollow: bool, seed: int) -> None:
    """The normal turns with the line of centres; the contact travels along the smaller circle by what that does not turn."""
    rng = np.random.default_rng(seed)
    (pose_a, rates_a, rates_b), pose_b = rng.normal(size=(3, 3)), (0.3, 0.1, 0.8)
    if hollow:  # within a hole: the normal points to the hole's middle
        pose_a = np.array([0.2, -0.3, 1.7])
    found = row(
        round_loop(SMALL, OFF_SMALL), tuple(pose_a), tuple(rates_a),
        round_loop(LARGE, OFF_LARGE, hollow), pose_b, tuple(rates_b),
    )  # fmt: skip
    small, large = out(tuple(pose_a), OFF_SMALL), out(pose_b, OFF_LARGE)
    apart, moving = small - large, speed(tuple(pose_a), tuple(rates_a), small) - speed(pose_b, tuple(rates_b), large)
    turning = float((moving / apart).imag)
    n = (-1.0 if hollow else 1.0) * apart / abs(apart)
    point = small - SMALL * n
    slip = (speed(tuple(pose_a), tuple(rates_a), point) - speed(pose_b, tuple(rates_b), point)) / n
    w_a, w_b = rates_a[2], rates_b[2]
    size = (abs(turning) + abs(w_b)) * taxi(slip) + abs(w_a - w_b) * SMALL * abs(turning - w_a)
    size += w_a**2 * taxi(point - complex(*pose_a[:2])) + w_b**2 * taxi(point - complex(*pose_b[:2]))
    assert found.bar_size == pytest.approx(size, rel=1e-12, abs=0.0)
    assert (found.x, found.y) == pytest.approx((point.real, point.imag), rel=1e-12, abs=0.0)


@pytest.mark.parametrize(("y", "turn"), [(0.9, 0.4), (-0.2, 2.5)])
def test_of_a_circle_over_a_line(y: float, turn: float) -> None:
    """The normal is the line's own, on the right of its way."""
    pose_a, rates_a = (0.3, y, turn), (0.7, -0.2, 1.3)
    pose_b, rates_b = (-0.5, 0.1, 0.35), (0.15, 0.45, -0.6)
    line = Loop((Line(4.0, 0.25, -4.0, 0.25),), closed=False)
    found = row(round_loop(SMALL, OFF_SMALL), pose_a, rates_a, line, pose_b, rates_b)
    n = 1j * np.exp(1j * pose_b[2])
    point = out(pose_a, OFF_SMALL) - SMALL * n
    slip = (speed(pose_a, rates_a, point) - speed(pose_b, rates_b, point)) / n
    size = 2.0 * 0.6 * taxi(slip) + 1.9 * SMALL * 1.9
    size += 1.3**2 * taxi(point - complex(*pose_a[:2])) + 0.6**2 * taxi(point - complex(*pose_b[:2]))
    assert found.bar_size == pytest.approx(size, rel=1e-12)


@pytest.mark.parametrize("swapped", [False, True])
def test_bodies_that_travel_flush_leave_what_rounding_may_turn_them_by(swapped: bool) -> None:
    """The square of that spin, over the two arms; the longer arm belongs to either body."""
    near, far = (0.1, 0.2, 0.0), (-3.0, 0.5, 0.0)
    pose_a, pose_b = (far, near) if swapped else (near, far)
    centre = complex(0.3, 0.9) - complex(*pose_a[:2])
    line = Loop((Line(9.0, 0.6 - pose_b[1], -9.0, 0.6 - pose_b[1]),), closed=False)
    rates_a, rates_b = (-3.0, 0.7, 0.0), (-3.0, 0.7, 0.0)
    found = row(round_loop(SMALL, centre), pose_a, rates_a, line, pose_b, rates_b)
    point = complex(0.3, 0.6)
    arms = taxi(point - complex(*pose_a[:2])) + taxi(point - complex(*pose_b[:2]))
    assert found.g == pytest.approx(0.0, abs=1e-12)
    assert found.bar_size == pytest.approx((SPIN_ROUNDING * 7.4) ** 2 / arms, rel=1e-12, abs=0.0)


def test_each_speed_counts_by_its_size() -> None:
    """Along both axes and of both bodies: bodies that slide past one another without any spin."""
    line, rates_a, rates_b = Loop((Line(9.0, 0.0, -9.0, 0.0),), closed=False), (-5.0, -0.7, 0.0), (-2.0, -11.0, 0.0)
    found = row(round_loop(SMALL, 0.5j), (0.0, 0.0, 0.0), rates_a, line, (-0.4, 0.1, 0.0), rates_b)
    arms = 0.2 + (0.4 + 0.1)
    assert found.bar_size == pytest.approx((SPIN_ROUNDING * 18.7) ** 2 / arms, rel=1e-12, abs=0.0)


def test_short_arms_count_as_long_ones_do() -> None:
    """The contact lies a tenth of a millimetre from one origin and three from the other."""
    line, rates = Loop((Line(9.0, 0.0, -9.0, 0.0),), closed=False), (-5.0, 0.6, 0.0)
    found = row(round_loop(SMALL, 1e-4 + 0.3j), (0.0, 0.0, 0.0), rates, line, (-2e-4, 0.0, 0.0), rates)
    assert found.bar_size == pytest.approx((SPIN_ROUNDING * 11.2) ** 2 / 4e-4, rel=1e-9, abs=0.0)


def test_without_an_arm_nothing_turns() -> None:
    """A corner at its body's origin, on a line through the origin of the other."""
    line = Loop((Line(9.0, 0.0, -9.0, 0.0),), closed=False)
    wedge = Loop((Line(-1.0, 2.0, 0.0, 0.0), Line(0.0, 0.0, 1.0, 2.0)), closed=False)
    found = row(wedge, (0.4, 0.7, 0.0), (3.0, 2.0, 0.0), line, (0.4, 0.7, 0.0), (3.0, 2.0, 0.0))
    assert found.bar_size == 0.0 and math.isfinite(found.bar_N)
