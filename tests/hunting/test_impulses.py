"""Does the judge find where outlines touch, and which jumps of velocity their impulses can make?"""

from __future__ import annotations

import math

import hunt_path  # noqa: F401
import numpy as np
import pytest
from hunt.generator.parts import fixed, free
from hunt.generator.shapes import box, circle
from hunt.impulses import Touches, touching

from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene


@pytest.mark.parametrize("angle", [0.0, 1.0, 2.5, 4.0])
def test_disc_against_disc(angle):
    c, s = math.cos(angle), math.sin(angle)
    first, second = [Arc(5.0 * c, 5.0 * s, 2.0, 0.3, 2.0 * math.pi)], [Arc(0.0, 0.0, 3.0, 1.0, 2.0 * math.pi)]
    points = list(touching(first, second, 1e-9))
    assert points
    for point, normal in points:
        assert point == pytest.approx((3.0 * c, 3.0 * s))
        assert normal == pytest.approx((c, s))


def test_disc_in_a_hollow():
    points = list(touching([Arc(0.0, -2.0, 1.0, 0.0, 2.0 * math.pi)], [Arc(0.0, 0.0, 3.0, 0.0, -math.pi)], 1e-9))
    assert [(tuple(np.round(p, 12)), tuple(np.round(n, 12))) for p, n in points] == [((0.0, -3.0), (0.0, 1.0))]


def test_disc_beside_an_arc_does_not_touch_it():
    assert not list(touching([Arc(0.0, 2.0, 1.0, 0.0, 2.0 * math.pi)], [Arc(0.0, 0.0, 3.0, 0.0, -math.pi)], 1e-9))


def test_corner_on_a_line():
    corner = [Line(1.0, 0.0, 2.0, 1.0), Line(0.0, 1.0, 1.0, 0.0)]
    points = list(touching(corner, [Line(3.0, 0.0, -3.0, 0.0)], 1e-9))
    assert {point for point, _ in points} == {(1.0, 0.0)}
    assert {normal for _, normal in points} == {(0.0, 1.0)}


def scene(friction):
    bodies = (fixed("floor", box(1.0, 0.2, (0.0, -0.1))), free("block", box(0.2, 0.1), (0.0, 0.05), 2.0))
    return Scene("block", bodies, contacts=(Contact((Side("floor"), Side("block")), friction, 0.0),))


@pytest.mark.parametrize(
    ("friction", "jump", "possible"),
    [
        (0.0, (0.0, 1.0, 0.0), True),  # thrown up
        (0.0, (0.0, -1.0, 0.0), False),  # pulled down
        (0.0, (0.1, 1.0, 0.0), False),  # pushed along without friction
        (0.5, (0.4, 1.0, 0.0), True),  # the couple of the friction is balanced by unequal loads of the two corners
        (0.5, (0.0, 1.0, 0.0), True),
        (0.2, (0.3, 1.0, 0.0), False),  # beyond the cone
    ],
)
def test_pushes_of_a_floor(friction, jump, possible):
    masses = np.array([2.0, 2.0, 2.0 * (0.2**2 + 0.1**2) / 12.0])
    share, points = Touches(scene(friction), {"block": slice(0, 3)}, masses, 1e-6).unexplained(
        np.array([0.0, 0.05, 0.0]), np.array(jump)
    )
    assert points >= 2
    assert (share < 1e-9) == possible


def test_rolling_disc_needs_friction_of_its_cone():
    """A disc of spin ω stopped from sliding: Δv = μ Δv_N, Δω = -μ m r Δv_N / J."""
    bodies = (fixed("floor", box(1.0, 0.2, (0.0, -0.1))), free("disc", circle(0.1), (0.0, 0.1), 2.0))
    made = Scene("disc", bodies, contacts=(Contact((Side("floor"), Side("disc")), 0.3, 0.0),))
    inertia = 0.5 * 2.0 * 0.1**2
    masses, q = np.array([2.0, 2.0, inertia]), np.array([0.0, 0.1, 0.0])
    touches = Touches(made, {"disc": slice(0, 3)}, masses, 1e-6)
    push = 0.3
    assert touches.unexplained(q, np.array([push, 1.0, push * 2.0 * 0.1 / inertia]))[0] < 1e-9
    assert touches.unexplained(q, np.array([push, 1.0, -push * 2.0 * 0.1 / inertia]))[0] > 0.1
    assert touches.unexplained(q, np.array([0.35, 1.0, 0.35 * 2.0 * 0.1 / inertia]))[0] > 1e-2


@pytest.mark.parametrize("turn", [1e-7, 1e-3])
def test_turn_of_a_face_on_to_which_a_disc_slides(turn):
    """A disc that slides at v and is pulled on to a face that falls away by d gets v d across the floor, and no spin."""
    bodies = (fixed("floor", box(1.0, 0.2, (0.0, -0.1))), free("disc", circle(0.1), (0.0, 0.1), 2.0))
    made = Scene("disc", bodies, contacts=(Contact((Side("floor"), Side("disc")), 0.3, 0.0),))
    touches = Touches(made, {"disc": slice(0, 3)}, np.array([2.0, 2.0, 0.01]), 1e-6)
    q, before = np.array([0.0, 0.1, 0.0]), np.array([3.0, 0.0, 0.0])
    assert touches.turn(q, before, np.array([0.0, -3.0 * turn, 0.0])) == pytest.approx(turn, rel=1e-9)
    assert touches.turn(q, before, np.array([-3.0 * turn, 0.0, 0.0])) == math.inf
    assert touches.turn(q, np.zeros(3), np.array([0.0, -1.0, 0.0])) == math.inf
