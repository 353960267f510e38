"""Do arcs follow curves within the tolerance, smoothly, and with nearly the fewest arcs possible?"""

from __future__ import annotations

import math
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from curves import Known, involute, least_arcs, quarter_ellipse, smooth, spiral, spline

from watchsim.geometry import fitting as fitting
from watchsim.geometry.biarcs import Curve
from watchsim.geometry.fitting import Fit, _chord, fit_all, fit_arcs
from watchsim.geometry.primitives import Arc, Line

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "naive"))
from fewest_arcs import fewest_arcs

KNOTS = [0, 0, 0, 0, 1, 2, 3, 3, 3, 3]
CURVES = {
    "quarter ellipse": quarter_ellipse(5e-3, 2e-3),
    "cubic": spline(3, [0] * 4 + [1] * 4, 1e-3 * np.array([(0, 0), (1, 3), (4, 3), (5, -1)])),
    "cubic with inflection": spline(3, [0] * 4 + [1] * 4, 1e-3 * np.array([(0, 0), (3, 0), (2, 4), (5, 4)])),
    "three spans": spline(3, KNOTS, 1e-3 * np.array([(0, 0), (1, 2), (3, 2), (4, -1), (6, 0), (7, 2)])),
    "involute": involute(1e-3, 0.5, 2.0),
}


def true_distance(curve: Known, fit: Fit, low: float, high: float) -> float:
    """Brute force: the largest of the distances of dense curve points to the nearest edge, ends of edges respected."""
    points = curve.points(np.linspace(low, high, 6001))
    nearest = np.full(len(points), np.inf)
    for edge in fit.edges:
        ends = np.array([edge.start, edge.end])
        gap = np.min(np.hypot(*(points[:, None] - ends[None]).transpose(2, 0, 1)), axis=1)
        if isinstance(edge, Arc):
            dx, dy = points[:, 0] - edge.x, points[:, 1] - edge.y
            along = np.mod((np.arctan2(dy, dx) - edge.start_angle) * math.copysign(1.0, edge.sweep), 2 * math.pi)
            gap = np.where(along <= abs(edge.sweep), np.abs(np.hypot(dx, dy) - edge.radius), gap)
        else:
            tx, ty = edge.tangent(0.0)
            dx, dy = points[:, 0] - edge.x0, points[:, 1] - edge.y0
            inside = (dx * tx + dy * ty >= 0.0) & (dx * tx + dy * ty <= edge.length)
            gap = np.where(inside, np.abs(dy * tx - dx * ty), gap)
        nearest = np.minimum(nearest, gap)
    return float(np.max(nearest))


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("tolerance", [1e-5, 1e-7, 1e-8])
def test_bound_holds_and_is_sharp(name: str, tolerance: float) -> None:
    curve = CURVES[name]
    low, high = float(curve.breaks[0]), float(curve.breaks[-1])
    fit = fit_arcs(curve, tolerance)
    measured = true_distance(curve, fit, low, high)
    assert measured <= fit.deviation * (1.0 + 1e-9) <= tolerance * (1.0 + 2e-9)
    assert fit.deviation == pytest.approx(measured, rel=0.03)
    for one, other in pairwise(fit.edges):
        assert math.dist(one.end, other.start) < 1e-15
        assert math.dist(one.tangent(1.0), other.tangent(0.0)) < 1e-9
    p, q = curve.points(np.array([low, high]))
    ways = curve.slopes(np.array([low, high]))
    assert fit.edges[0].start == pytest.approx(p, abs=1e-16) and fit.edges[-1].end == pytest.approx(q, abs=1e-16)
    assert fit.edges[0].tangent(0.0) == pytest.approx(ways[0] / np.hypot(*ways[0]), abs=1e-9)
    assert fit.edges[-1].tangent(1.0) == pytest.approx(ways[1] / np.hypot(*ways[1]), abs=1e-9)


@pytest.mark.parametrize("name", CURVES)
def test_number_of_arcs_against_the_best_biarcs_and_the_limit(name: str) -> None:
    """All biarcs with the curve's tangents on a fine grid, by dynamic programming; and the limit for chains of any kind."""
    curve, tolerance = CURVES[name], 1e-7
    grid = np.linspace(curve.breaks[0], curve.breaks[-1], 401)
    count = len(fit_arcs(curve, tolerance).edges)
    assert count <= fewest_arcs(lambda t: curve.points(t) @ np.array([1.0, 1.0j]), grid, tolerance)
    # Taking the curve's tangent at both ends costs an arc or two.
    assert count <= 1.2 * least_arcs(curve, tolerance) + 2.0


@pytest.mark.parametrize("name", CURVES)
def test_number_of_arcs_grows_with_the_cube_root(name: str) -> None:
    """Slope of the logarithms, and for small tolerances nearly the least number that is possible."""
    tolerances = 1e-8 / 8.0 ** np.arange(5)
    counts = [len(fit_arcs(CURVES[name], float(tolerance)).edges) for tolerance in tolerances]
    slope = np.polyfit(np.log(tolerances), np.log(counts), 1)[0]
    assert slope == pytest.approx(-1.0 / 3.0, rel=0.05)
    least = least_arcs(CURVES[name], float(tolerances[-1]))
    assert 0.99 * least <= counts[-1] <= 1.12 * least


@pytest.mark.slow
def test_many_curves_at_once_are_followed_like_each_alone() -> None:
    """Of several degrees, with and without weights and cusps, with different tolerances."""
    rng = np.random.default_rng(3)
    curves = [*CURVES.values(), spiral(2e-3, 1e-2, 1.5), involute(1e-3, 0.0, 1.0)]
    for _ in range(25):
        points = 1e-3 * rng.uniform(-1.0, 1.0, (4, 2))
        curves.append(spline(3, [0] * 4 + [1] * 4, points))
        curves.append(spline(3, [0] * 4 + [1] * 4, points, rng.uniform(0.2, 5.0, 4).tolist()))
        curves.append(spline(3, [0] * 4 + [1] * 4, points[[0, 0, 2, 3]]))
        curves.append(spline(2, [0] * 3 + [1] * 3, points[:3]))
    tolerances = (1e-7 * 10.0 ** rng.uniform(-1.0, 1.0, len(curves))).tolist()
    for curve, tolerance, fit in zip(curves, tolerances, fit_all(curves, tolerances), strict=True):
        # Places beside others are rounded otherwise, which may just tip the scales.
        assert abs(len(fit.edges) - len(fit_arcs(curve, tolerance).edges)) <= 1
        measured = true_distance(curve, fit, float(curve.breaks[0]), float(curve.breaks[-1]))
        assert measured <= fit.deviation * (1.0 + 1e-6) + 1e-15 and fit.deviation <= tolerance


@pytest.mark.slow
def test_very_many_curves_are_followed_with_a_few_more_arcs(monkeypatch: pytest.MonkeyPatch) -> None:
    """The shorter search keeps the tolerance just as well."""
    rng = np.random.default_rng(4)
    curves = [spline(3, [0] * 4 + [1] * 4, 1e-3 * rng.uniform(-1.0, 1.0, (4, 2))) for _ in range(100)]
    thorough = fit_all(curves, [1e-7] * len(curves))
    monkeypatch.setattr("watchsim.geometry.fitting.MANY_FIT", len(curves) - 1)
    brisk = fit_all(curves, [1e-7] * len(curves))
    for curve, fit in zip(curves, brisk, strict=True):
        measured = true_distance(curve, fit, float(curve.breaks[0]), float(curve.breaks[-1]))
        assert measured <= fit.deviation * (1.0 + 1e-6) + 1e-15 and fit.deviation <= 1e-7
    counts = [sum(len(fit.edges) for fit in fits) for fits in (thorough, brisk)]
    assert counts[0] < counts[1] < 1.1 * counts[0]


def test_involute_from_its_cusp() -> None:
    """At the base circle the involute starts with no speed; its direction there is the limit."""
    curve = involute(1e-3, 0.0, 1.0)
    fit = fit_arcs(curve, 1e-7)
    assert fit.deviation <= 1e-7
    assert true_distance(curve, fit, 0.0, 1.0) <= 1e-7


def test_a_circle_is_found_again() -> None:
    (edge,) = fit_arcs(quarter_ellipse(2e-3, 2e-3), 1e-7).edges
    assert isinstance(edge, Arc) and edge.radius == pytest.approx(2e-3, rel=1e-12)


def test_straight_curve_gives_a_line() -> None:
    fit = fit_arcs(spline(3, [0] * 4 + [1] * 4, [(0, 0), (1e-3, 2e-3), (2e-3, 4e-3), (5e-3, 10e-3)]), 1e-7)
    assert fit.edges == (Line(0.0, 0.0, 5e-3, 10e-3),)
    assert fit.deviation < 1e-16


@pytest.mark.parametrize("shift", [0.0, 0.123])
def test_cusp_inside_stays_a_cusp(shift: float) -> None:
    """x = t², y = t³ turns back at t = 0, in the middle or not."""

    def at(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return 1e-3 * np.column_stack((t**2, t**3)), 1e-3 * np.column_stack((2 * t, 3 * t**2))

    curve = smooth(at, -1.0, 1.0 + shift, degree=3)
    fit = fit_arcs(curve, 1e-7)
    assert fit.deviation <= 1e-7
    assert true_distance(curve, fit, -1.0, 1.0 + shift) <= 1e-7
    assert len(fit.edges) < 40
    turns = [math.dist(a.tangent(1.0), b.tangent(0.0)) for a, b in pairwise(fit.edges)]
    assert max(turns) == pytest.approx(2.0, abs=1e-6) and sorted(turns)[-2] < 1e-4


def test_spiral_is_no_circle() -> None:
    fit = fit_arcs(spiral(2e-3, 1e-3, 2.0), 1e-7)
    assert len(fit.edges) > 5 and fit.deviation <= 1e-7
    radii = np.array([edge.radius for edge in fit.edges if isinstance(edge, Arc)])
    angles = 2 * math.pi * 2.0 * (np.arange(len(radii)) + 0.5) / len(radii)
    assert radii == pytest.approx(2e-3 * (1.0 + 1e-3 * angles), rel=1e-3)


def test_jump_of_curvature_is_an_end_of_arcs() -> None:
    """A parabola runs on into another one that bends the other way: arcs end where they meet."""
    curve = spline(2, [0, 0, 0, 1, 2, 2, 2], 1e-3 * np.array([(0, 0), (1, 0), (3, 2), (4, 2)]))
    fit = fit_arcs(curve, 1e-7)
    (middle,) = curve.points(np.array([1.0]))
    assert any(math.dist(edge.end, middle) < 1e-16 for edge in fit.edges)
    assert true_distance(curve, fit, 0.0, 2.0) <= fit.deviation * (1.0 + 1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_bound_holds_for_high_degree_and_unequal_weights(seed: int) -> None:
    """Where weight and distance have terms beyond the cubic, which are only bounded."""
    rng = np.random.default_rng(seed)
    points = 1e-3 * np.column_stack((np.arange(7.0), rng.uniform(-1.0, 1.0, 7)))
    curve = spline(6, [0] * 7 + [1] * 7, points, (10.0 ** rng.uniform(-1.0, 1.0, 7)).tolist())
    for tolerance in (1e-4, 1e-6):
        fit = fit_arcs(curve, tolerance)
        measured = true_distance(curve, fit, 0.0, 1.0)
        assert measured <= fit.deviation * (1.0 + 1e-6) <= tolerance * (1.0 + 2e-6)
        assert fit.deviation <= 1.1 * measured


def test_a_curve_along_which_no_chain_is_found_is_halved(monkeypatch: pytest.MonkeyPatch) -> None:
    """Made so here: nothing is found along more than an eighth of a span."""
    found, longest = fitting._chains, 0.125

    def few(curves: list[Curve], *others: object) -> list[object]:
        whole = found(curves, *others)
        return [chain if np.ptp(curve.breaks) <= longest else None for curve, chain in zip(curves, whole, strict=True)]

    monkeypatch.setattr(fitting, "_chains", few)
    curve = CURVES["cubic with inflection"]
    fit = fit_arcs(curve, 1e-6)
    assert true_distance(curve, fit, 0.0, 1.0) <= fit.deviation * (1.0 + 1e-9) <= 1e-6
    for one, other in pairwise(fit.edges):
        assert math.dist(one.end, other.start) < 1e-15


@pytest.mark.parametrize("apart", [0.0, 1e-3])
def test_a_curve_too_short_to_follow_is_the_line_between_its_ends_if_they_differ(apart: float) -> None:
    points = np.array([[1.0, 2.0], [1.0 + 5e-4, 2.0 + 1e-9], [1.0 + apart, 2.0]])
    curve = Curve(np.column_stack((points, np.ones(3)))[None], np.array([0.0, 1.0]))
    fit = _chord(curve, 1e-9, 1e-6)
    assert fit.deviation == 1e-9
    assert fit.edges == ((Line(1.0, 2.0, 1.0 + apart, 2.0),) if apart else ())
