"""Do biarcs follow curves within the tolerance, smoothly, and with few arcs?"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from watchsim.geometry.biarc import arc_from, arcs_from, biarc_joints
from watchsim.geometry.fit import Fit, fit_arcs
from watchsim.geometry.primitives import Arc, Line


def ellipse(a: float, b: float) -> Curve:
    def at(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.column_stack((a * np.cos(t), b * np.sin(t))), np.column_stack((-a * np.sin(t), b * np.cos(t)))

    return at


def involute(r: float) -> Curve:
    def at(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        c, s = np.cos(t), np.sin(t)
        return r * np.column_stack((c + t * s, s - t * c)), r * np.column_stack((t * c, t * s))

    return at


def true_distance(curve: Curve, fit: Fit, start: float, stop: float) -> float:
    """Brute force: the largest of the distances of dense curve points to the nearest edge, ends of edges respected."""
    points, _ = curve(np.linspace(start, stop, 4001))
    nearest = np.full(len(points), np.inf)
    for edge in fit.edges:
        fractions = np.linspace(0.0, 1.0, 2)
        ends = np.array([edge.point(f) for f in fractions])
        gap = np.min(np.hypot(*(points[:, None] - ends[None]).transpose(2, 0, 1)), axis=1)
        if isinstance(edge, Arc):
            dx, dy = points[:, 0] - edge.x, points[:, 1] - edge.y
            along = np.mod((np.arctan2(dy, dx) - edge.start_angle) * math.copysign(1.0, edge.sweep), 2 * math.pi)
            gap = np.where(along <= abs(edge.sweep), np.abs(np.hypot(dx, dy) - edge.radius), gap)
        nearest = np.minimum(nearest, gap)
    return float(np.max(nearest))


def assert_smooth(fit: Fit, sharp: float = 1e-9) -> None:
    for one, other in zip(fit.edges, fit.edges[1:], strict=False):
        assert math.dist(one.end, other.start) < 1e-15
        assert math.dist(one.tangent(1.0), other.tangent(0.0)) < sharp


@pytest.mark.parametrize("tolerance", [1e-6, 1e-7, 1e-8])
def test_quarter_ellipse(tolerance: float) -> None:
    curve = ellipse(5e-3, 2e-3)
    fit = fit_arcs(curve, (0.0, math.pi / 2), tolerance)
    assert fit.deviation <= tolerance
    measured = true_distance(curve, fit, 0.0, math.pi / 2)
    assert measured <= tolerance * 1.01
    assert fit.deviation == pytest.approx(measured, rel=0.02)
    assert_smooth(fit)
    assert fit.edges[0].start == pytest.approx((5e-3, 0.0), abs=1e-17)
    assert fit.edges[-1].end == pytest.approx((0.0, 2e-3), abs=1e-17)


def test_number_of_arcs_grows_with_the_cube_root() -> None:
    counts = [len(fit_arcs(ellipse(5e-3, 2e-3), (0.0, math.pi / 2), 1e-6 / 8**k).edges) for k in range(4)]
    for few, many in pairwise(counts):
        assert 1.6 < many / few < 2.4


def test_deviation_falls_with_the_cube_of_the_step() -> None:
    curve = involute(1e-3)
    worst = []
    for n in (16, 32, 64):
        knots = np.linspace(0.5, 1.5, n + 1)
        points, slopes = curve(knots)
        slopes /= np.hypot(*slopes.T)[:, None]
        edges = [
            edge
            for k in range(n)
            for edge in biarc(tuple(points[k]), tuple(slopes[k]), tuple(points[k + 1]), tuple(slopes[k + 1]))
        ]
        worst.append(true_distance(curve, Fit(tuple(edges), 0.0), 0.5, 1.5))
    assert worst[0] / worst[1] == pytest.approx(8.0, rel=0.15)
    assert worst[1] / worst[2] == pytest.approx(8.0, rel=0.15)


def test_involute_from_its_cusp() -> None:
    """At the base circle the involute starts with no speed; its direction there is the limit."""
    fit = fit_arcs(involute(1e-3), (0.0, 1.0), 1e-7)
    assert fit.deviation <= 1e-7
    assert true_distance(involute(1e-3), fit, 0.0, 1.0) <= 1.05e-7


def test_a_circle_is_found_again() -> None:
    fit = fit_arcs(ellipse(2e-3, 2e-3), (0.0, math.pi / 2), 1e-7)
    assert fit.deviation < 1e-17
    assert all(isinstance(edge, Arc) and edge.radius == pytest.approx(2e-3, rel=1e-12) for edge in fit.edges)


def test_straight_curve_gives_lines() -> None:
    def at(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.column_stack((t, 2.0 * t)), np.column_stack((np.ones_like(t), np.full_like(t, 2.0)))

    fit = fit_arcs(at, (0.0, 1e-3), 1e-7)
    assert all(isinstance(edge, Line) for edge in fit.edges)
    assert fit.deviation < 1e-18


def test_cusp_inside_does_not_hang() -> None:
    """x = t², y = t³ turns back at t = 0."""

    def at(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return 1e-3 * np.column_stack((t**2, t**3)), 1e-3 * np.column_stack((2 * t, 3 * t**2))

    fit = fit_arcs(at, (-1.0, 1.0), 1e-7)
    assert fit.deviation <= 1.01e-7
    assert true_distance(at, fit, -1.0, 1.0) <= 1.05e-7
    assert len(fit.edges) < 200


def test_arc_from_semicircle_and_line() -> None:
    arc = arc_from((0.0, 0.0), (0.0, -1.0), (2.0, 0.0))
    assert isinstance(arc, Arc)
    assert (arc.x, arc.y, arc.radius, arc.sweep) == pytest.approx((1.0, 0.0, 1.0, math.pi))
    assert isinstance(arc_from((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), Line)


@settings(deadline=None, max_examples=80)
@given(st.floats(-1.2, 1.2), st.floats(-1.2, 1.2), st.floats(1e-6, 10.0), st.floats(-3.2, 3.2))
def test_biarc_meets_points_and_tangents(u: float, v: float, length: float, turn: float) -> None:
    p, q = (0.3, -0.2), (0.3 + length * math.cos(turn), -0.2 + length * math.sin(turn))
    tp, tq = (math.cos(turn + u), math.sin(turn + u)), (math.cos(turn + v), math.sin(turn + v))
    first, second = biarc(p, tp, q, tq)
    assert first.start == pytest.approx(p, abs=1e-9 * length) and second.end == pytest.approx(q, abs=1e-9 * length)
    assert first.end == pytest.approx(second.start, abs=1e-9 * length)
    assert first.tangent(0.0) == pytest.approx(tp, abs=3e-6) and second.tangent(1.0) == pytest.approx(tq, abs=3e-6)
    assert first.tangent(1.0) == pytest.approx(second.tangent(0.0), abs=3e-6)
