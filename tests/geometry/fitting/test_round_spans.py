"""Which spans are round, and which part of a curve is each edge?"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from watchsim.geometry.biarcs import Curve
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.recognition import parts_of, whole_circle


def bow(sweep: float, radius: float, stretch: float = 1.0) -> list[tuple[float, float, float]]:
    """Control points of an arc about (1, 2) from 0.4 rad on, stretched along x."""
    h, rows = 0.5 * sweep, []
    for angle, w in ((0.4, 1.0), (0.4 + h, math.cos(h)), (0.4 + sweep, 1.0)):
        rows.append((w + stretch * radius * math.cos(angle), 2.0 * w + radius * math.sin(angle), w))
    return rows


def off_round(sweep: float, stretch: float) -> float:
    """How far seven points are off their mean distance from the centre of three of them, over 1e-5 of the rise."""
    w = math.cos(0.5 * sweep)
    points = []
    for k in range(7):
        u = k / 6.0
        a, b, c = (1.0 - u) ** 2, 2.0 * u * (1.0 - u), u * u
        rows = bow(sweep, 3.0, stretch)
        weight = a + b * w + c
        points.append([(a * rows[0][j] + b * rows[1][j] + c * rows[2][j]) / weight for j in (0, 1)])
    (ax, ay), (bx, by), (cx, cy) = points[0], points[2], points[4]
    matrix = np.array([(2.0 * (bx - ax), 2.0 * (by - ay)), (2.0 * (cx - ax), 2.0 * (cy - ay))])
    x, y = np.linalg.solve(matrix, [bx**2 - ax**2 + by**2 - ay**2, cx**2 - ax**2 + cy**2 - ay**2])
    distances = [math.dist(p, (x, y)) for p in points]
    mean = math.fsum(distances) / 7.0
    return max(abs(d - mean) for d in distances) / (1e-5 * mean * min(1.0, sweep * sweep / 8.0))


@pytest.mark.parametrize("sweep", [0.7, 1.6, -1.6, 2.6, 3.0, -3.0])
def test_a_span_is_round_within_a_hundred_thousandth_of_its_rise(sweep: float) -> None:
    """The rise of small arcs is an eighth of the square of the angle, of large ones their radius at most."""
    low, high = 1.0, 1.01
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if off_round(sweep, middle) > 1.0 else (middle, high)
    for share, is_round in ((0.98, True), (1.02, False)):
        control = np.array([bow(sweep, 3.0, 1.0 + share * (low - 1.0))])
        ((part,),) = parts_of([Curve(control, np.array([0.0, 1.0]))], [1e-2])
        assert isinstance(part.edge, Arc) is is_round


@pytest.mark.parametrize("sweep", [3e-3, -3e-3, 0.02, 1.0])
def test_flat_arcs_are_round(sweep: float) -> None:
    ((part,),) = parts_of([Curve(np.array([bow(sweep, 3.0)]), np.array([0.0, 1.0]))], [1e-6])
    assert isinstance(part.edge, Arc)
    assert (part.edge.radius, part.edge.sweep) == pytest.approx((3.0, sweep), rel=1e-6)


def test_each_edge_comes_with_its_part_of_the_curve() -> None:
    """Two spans in line, one and two others round the corner; and two that are neither straight nor round."""
    corners = [(0, 0), (1, 0), (3, 0), (3, 2), (3, 5), (3, 6)]
    rows = [[(*a, 1.0), (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 1.0), (*b, 1.0)] for a, b in pairwise(corners)]
    rows += [[(3, 6, 1), (3, 8, 1), (5, 9, 1)], [(5, 9, 1), (7, 10, 1), (7.5, 14, 1)]]
    curve = Curve(np.array(rows, dtype=float), np.arange(8.0) ** 2)
    alone = Curve(curve.control[5:], curve.breaks[5:])
    (whole, rest) = parts_of([curve, alone], [1e-7, 1e-7])
    breaks = [0.0, 1.0, 4.0], [4.0, 9.0, 16.0, 25.0], [25.0, 36.0, 49.0]
    for part, expected in zip(whole, breaks, strict=True):
        assert part.curve.breaks.tolist() == expected and len(part.curve.control) == len(expected) - 1
    assert [part.edge for part in whole] == [Line(0.0, 0.0, 3.0, 0.0), Line(3.0, 0.0, 3.0, 6.0), None]
    assert len(rest) == 1 and rest[0].edge is None and rest[0].curve is alone


@pytest.mark.parametrize("radius", [5e-5, 3.0])
def test_small_circles_and_large_ones(radius: float) -> None:
    rows = []
    for k in range(4):
        h = TURN / 8
        for angle, w in ((2 * k * h, 1.0), ((2 * k + 1) * h, math.cos(h)), ((2 * k + 2) * h, 1.0)):
            rows.append((radius * math.cos(angle), radius * math.sin(angle), w))
    control = np.array(rows).reshape(-1, 3, 3)
    control[-1, -1] = control[0, 0]
    fit = whole_circle(Curve(control, np.arange(5.0)), 1e-4 * radius)
    assert fit is not None and isinstance(fit.edges[0], Arc)
    assert fit.edges[0].radius == pytest.approx(radius, rel=1e-9, abs=0.0) and fit.deviation < 1e-9 * radius
