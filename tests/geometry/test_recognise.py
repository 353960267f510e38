"""Do circles and straight parts hidden in curves come out as one arc, one line?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from curves import spiral, spline

from watchsim.geometry.biarcs import Curve
from watchsim.geometry.fitting import fit_arcs
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.recognition import Part, joined, parts_of, whole_circle


def parts(curve: Curve, tolerance: float) -> list[Part]:
    (result,) = parts_of([curve], [tolerance])
    return result


def rational_arc(radius: float, sweep: float, spans: int, decimals: int = 16) -> Curve:
    """A circular arc as `spans` rational parabolas with doubled knots, control points in metres, rounded in millimetres."""
    half = sweep / spans / 2.0
    angles = half * np.arange(2 * spans + 1)
    far = np.where(np.arange(2 * spans + 1) % 2 == 1, 1.0 / math.cos(half), 1.0)
    points = radius * far[:, None] * np.column_stack((np.cos(angles), np.sin(angles))) + np.array([3e-3, -1e-3])
    weights = np.where(np.arange(2 * spans + 1) % 2 == 1, math.cos(half), 1.0)
    knots = [0, *np.repeat(np.arange(spans + 1), 2).tolist(), spans]
    return spline(2, knots, np.round(1e3 * points, decimals) / 1e3, weights.tolist())


@pytest.mark.parametrize("spans", [3, 4, 5, 7, 12])
@pytest.mark.parametrize("decimals", [16, 8])
def test_full_circle_of_any_number_of_spans(spans: int, decimals: int) -> None:
    (part,) = parts(rational_arc(2e-3, TURN, spans, decimals), 1e-7)
    assert isinstance(part.edge, Arc) and part.edge.sweep == TURN
    assert (part.edge.x, part.edge.y, part.edge.radius) == pytest.approx(
        (3e-3, -1e-3, 2e-3), abs=1e-13 + 10.0 ** -(decimals + 2)
    )


@pytest.mark.parametrize("sweep", [0.3, 1.0, 3.5, 6.0, -0.3, -3.5])
def test_rational_arcs(sweep: float) -> None:
    (part,) = parts(rational_arc(2e-3, sweep, 3), 1e-7)
    assert isinstance(part.edge, Arc) and part.edge.sweep == pytest.approx(sweep, rel=1e-9)


def test_line_arc_line_in_one_spline() -> None:
    """A rounded corner as one quadratic spline."""
    h = math.sqrt(0.5)
    points = 1e-3 * np.array([(-3, -1), (-1.5, -1), (0, -1), (1, -1), (1, 0), (1, 2), (1, 4)])
    curve = spline(2, [0, 0, 0, 1, 1, 2, 2, 3, 3, 3], points, [1, 1, 1, h, 1, 1, 1])
    one, two, three = (part.edge for part in parts(curve, 1e-7))
    assert one == Line(-3e-3, -1e-3, 0.0, -1e-3) and three == Line(1e-3, 0.0, 1e-3, 4e-3)
    assert isinstance(two, Arc) and (two.radius, two.sweep) == pytest.approx((1e-3, math.pi / 2), rel=1e-12)


def four_cubics(radius: float) -> Curve:
    k = 0.5522847498307936
    quarter = [(1, 0), (1, k), (k, 1), (0, 1)]
    points = [(1, 0)]
    for turn in range(4):
        c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[turn]
        points += [(c * x - s * y, s * x + c * y) for x, y in quarter[1:]]
    return spline(3, [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 4], radius * np.array(points, dtype=float))


def test_four_cubics_within_the_tolerance_are_a_circle() -> None:
    """They bulge by 2.7253e-4 of the radius at most; the best circle halves that."""
    fit = whole_circle(four_cubics(5e-4), 1e-7)
    assert fit is not None
    (edge,) = fit.edges
    assert isinstance(edge, Arc) and abs(edge.sweep) == TURN
    assert edge.radius == pytest.approx(5e-4 * (1 + 1.5e-4), rel=1e-4)
    assert 0.5 * 2.7253e-4 * 5e-4 <= fit.deviation <= 1e-7


def test_four_cubics_beyond_the_tolerance_and_spirals_are_none() -> None:
    assert whole_circle(four_cubics(2e-3), 1e-7) is None
    assert whole_circle(spiral(2e-3, 1e-5, 1.0), 1e-7) is None
    assert all(part.edge is None for part in parts(spiral(2e-3, 1e-4, 1.0), 1e-7))


def uneven_circle(centre: tuple[float, float], radius: float, sweeps: list[float]) -> Curve:
    """A circle of rational parabolas, each with its own share of the turn (rad)."""
    borders = np.concatenate(([0.0], np.cumsum(sweeps)))
    angles, weights = [0.0], [1.0]
    for start, sweep in zip(borders, sweeps, strict=False):
        angles += [start + 0.5 * sweep, start + sweep]
        weights += [math.cos(0.5 * sweep), 1.0]
    points = np.column_stack((np.cos(angles), np.sin(angles))) * radius / np.array(weights)[:, None] + np.array(centre)
    knots = [0, *np.repeat(np.arange(len(sweeps) + 1), 2).tolist(), len(sweeps)]
    return spline(2, knots, points, weights)


def test_a_circle_is_known_by_its_points_however_they_crowd_on_one_side() -> None:
    fit = whole_circle(uneven_circle((3e-3, -1e-3), 2e-3, [0.2, 0.3, 0.5, 1.0, 2.0, TURN - 4.0]), 1e-9)
    assert fit is not None
    (edge,) = fit.edges
    assert isinstance(edge, Arc) and (edge.x, edge.y, edge.radius) == pytest.approx((3e-3, -1e-3, 2e-3), rel=1e-9)


def test_how_far_a_curve_is_open_is_measured_along_its_control_polygon() -> None:
    """Sides of 3 mm, 4 mm and 1 mm, the ends 2 mm and 4 mm apart; what has no length is open."""
    sides = spline(3, [0, 0, 0, 0, 1, 1, 1, 1], 1e-3 * np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 4.0), (2.0, 4.0)]))
    assert sides.open_by() == pytest.approx(math.hypot(2.0, 4.0) / 8.0, rel=1e-12)
    turned = spline(3, [0, 0, 0, 0, 1, 1, 1, 1], 1e-3 * np.array([(0.0, 0.0), (0.0, 3.0), (-4.0, 3.0), (-4.0, 2.0)]))
    assert turned.open_by() == pytest.approx(math.hypot(2.0, 4.0) / 8.0, rel=1e-12)
    assert spline(2, [0, 0, 0, 1, 1, 1], np.zeros((3, 2))).open_by() == math.inf


def test_joined_makes_one_circle_of_four_quarters() -> None:
    quarters = [Arc(1e-3, 2e-3, 5e-3, k * math.pi / 2, math.pi / 2) for k in range(4)]
    edges, moved = joined(quarters, 1e-7)
    assert edges == [Arc(1e-3, 2e-3, 5e-3, 0.0, TURN)] and moved == 0.0


def test_joined_keeps_different_circles() -> None:
    two = [Arc(0.0, 0.0, 5e-3, 0.0, 1.0), Arc(0.0, 0.0, 5.0001e-3, 1.0, 1.0), Line(0.0, 0.0, 1.0, 0.0)]
    assert joined(two, 1e-7)[0] == two


def test_straight_curve_that_turns_back_near_its_end_is_not_one_line() -> None:
    """It overshoots its end by 0.9 µm, between any samples that are looked at."""
    curve = spline(3, [0] * 4 + [1] * 4, 1e-3 * np.array([(0, 0), (1, 0), (3.05, 0), (3, 0)]))
    (part,) = parts(curve, 1e-7)
    assert part.edge is None
    furthest = float(np.max(curve.points(np.linspace(0.0, 1.0, 100_001))[:, 0]))
    ends = [edge.end[0] for edge in fit_arcs(curve, 1e-7).edges]
    assert max(ends) == pytest.approx(furthest, abs=1e-10) and furthest > 3.0008e-3
    assert ends[-1] == pytest.approx(3e-3, abs=1e-15)


def test_weights_along_a_straight_line_bend_nothing() -> None:
    points = 1e-3 * np.array([(0, 0), (1, 2), (2, 4), (5, 10)])
    (part,) = parts(spline(3, [0] * 4 + [1] * 4, points, [9.0, 1.0, 4.0, 0.2]), 1e-7)
    assert part.edge == Line(0.0, 0.0, 5e-3, 10e-3)
