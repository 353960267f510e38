"""Are Béziers that run round a circle taken for it, whichever way they run?"""

from __future__ import annotations

import math

import pytest

from watchsim.drawing.curves import circle_of
from watchsim.drawing.projection import Conic, Spline, Straight, reach, unit

KAPPA = 4.0 / 3.0 * (math.sqrt(2.0) - 1.0)  # of the radius: the usual Béziers of a quarter


def quarters(radius: float, way: float) -> list[Spline]:
    """Four Béziers round the point (1, 2); `way` 1 counter-clockwise, -1 clockwise."""
    made = []
    for k in range(4):
        a, b = way * 0.5 * math.pi * k, way * 0.5 * math.pi * (k + 1)
        (ca, sa), (cb, sb) = (math.cos(a), math.sin(a)), (math.cos(b), math.sin(b))
        r, pull = radius, way * KAPPA * radius
        points = [
            (r * ca, r * sa),
            (r * ca - pull * sa, r * sa + pull * ca),
            (r * cb + pull * sb, r * sb - pull * cb),
            (r * cb, r * sb),
        ]
        made.append(Spline(3, [0.0] * 4 + [1.0] * 4, [(1.0 + x, 2.0 + y, 0.0) for x, y in points], []))
    return made


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_circle_of_beziers_keeps_its_sense(way: float) -> None:
    found = circle_of(quarters(3.0, way), 1e-3)
    assert found is not None
    assert math.isclose(found.arc.sweep, way * math.tau)
    assert math.isclose(found.arc.radius, 3e-3, rel_tol=1e-3) and math.isclose(found.arc.y, 2e-3, rel_tol=1e-6)


def test_what_turns_back_is_no_circle() -> None:
    there = quarters(3.0, 1.0)
    assert circle_of([*there[:2], *quarters(3.0, -1.0)[:2]], 1e-3) is None


def test_a_direction_without_length_is_straight_up() -> None:
    assert unit((0.0, 0.0, 0.0)) == (0.0, 0.0, 1.0)
    assert unit((0.0, 3.0, 4.0)) == (0.0, 0.6, 0.8)


def test_rounding_is_that_of_the_largest_coordinate() -> None:
    """Of all control points in both directions; a circle reaches beyond its centre by its radius."""
    assert reach(Spline(2, [0.0] * 3 + [1.0] * 3, [(1.0, 2.0, 0.0), (-900.0, 3.0, 0.0), (5.0, 70.0, 0.0)], [])) == 900.0
    assert reach(Conic((4.0, -50.0, 0.0), (0.0, 3.0, 0.0), (-3.0, 0.0, 0.0), 0.0, math.tau)) == 53.0
    assert reach(Straight((1.0, -2.0, 0.0), (9.0, 0.0, 0.0))) == 2.0
