"""Can the brute-force distance be trusted? Shapes whose distance is known."""

import math

import pytest
from naive.distance_oracle import gap, nearest

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line

STILL = (0.0, 0.0, 0.0)


def circle(radius: float, hole: bool = False) -> Loop:
    return Loop((Arc(0.0, 0.0, radius, 0.0, -2.0 * math.pi if hole else 2.0 * math.pi),), hole=hole)


def square(half: float) -> Loop:
    corners = [(half, half), (-half, half), (-half, -half), (half, -half)]
    return Loop(tuple(Line(*corners[i], *corners[(i + 1) % 4]) for i in range(4)))


def test_circles_apart_and_overlapping() -> None:
    for distance in (5.0, 3.5, 3.001, 2.7):
        turned = (distance * math.cos(0.7), distance * math.sin(0.7), 0.3)
        assert gap((circle(2.0),), STILL, (circle(1.0),), turned, 0.01) == pytest.approx(distance - 3.0, abs=5e-5)


def test_points_are_on_their_own_body() -> None:
    found = nearest((circle(2.0),), STILL, (circle(1.0),), (5.0, 0.0, 0.0), 0.01)
    assert found.on_a == pytest.approx((2.0, 0.0), abs=1e-2)
    assert found.on_b == pytest.approx((4.0, 0.0), abs=1e-2)


def test_corner_against_circle() -> None:
    """A unit square turned by 45 degrees points its corner at the circle."""
    apart = (1.0 + math.sqrt(2.0) + 0.25, 0.0, math.pi / 4.0)
    assert gap((circle(1.0),), STILL, (square(1.0),), apart, 0.005) == pytest.approx(0.25, abs=1e-5)
    into = (1.0 + math.sqrt(2.0) - 0.1, 0.0, math.pi / 4.0)
    assert gap((circle(1.0),), STILL, (square(1.0),), into, 0.005) == pytest.approx(-0.1, abs=1e-5)


def test_pin_in_a_ring() -> None:
    ring = (circle(5.0), circle(2.0, hole=True))
    assert gap(ring, STILL, (circle(0.5),), (1.0, 0.0, 0.0), 0.01) == pytest.approx(0.5, abs=5e-5)
    assert gap(ring, STILL, (circle(0.5),), (1.7, 0.0, 0.0), 0.01) == pytest.approx(-0.2, abs=5e-5)


def test_order_does_not_matter() -> None:
    pose = (2.3, 0.4, 0.2)
    one, other = (
        nearest((square(1.0),), STILL, (circle(1.0),), pose, 0.01),
        nearest((circle(1.0),), pose, (square(1.0),), STILL, 0.01),
    )
    assert one.gap == pytest.approx(other.gap, abs=1e-12)
    assert one.on_a == pytest.approx(other.on_b)
