"""Are extents, lengths, inside tests and vertices of outlines right, arcs included?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.geometry.loops import Loop, chords, edge_extents, extents, points_along, polyline, table_of, total_length, winding
from watchsim.geometry.primitives import TURN, Arc, Line

RING = Loop((Arc(1.0, 2.0, 3.0, 0.7, TURN),))
KEY = Loop(
    (
        Arc(0.0, 0.0, 1.0, math.pi / 4, 1.5 * math.pi),
        Line(*Arc(0, 0, 1, -math.pi / 4, 0).start, 3.0, 0.0),
        Line(3.0, 0.0, *Arc(0, 0, 1, math.pi / 4, 0).start),
    )
)


def test_extents_of_a_circle_and_of_arcs() -> None:
    assert extents([RING]) == pytest.approx((-2.0, -1.0, 4.0, 5.0), rel=1e-15)
    assert edge_extents(Arc(0, 0, 1, 0.1, 1.0)) == pytest.approx((math.cos(1.1), math.sin(0.1), math.cos(0.1), math.sin(1.1)))
    assert edge_extents(Arc(0, 0, 1, 3.0, -3.5)) == pytest.approx((math.cos(3.0), math.sin(-0.5), 1.0, 1.0))
    assert extents([]) is None


@given(st.floats(-9, 9), st.floats(-TURN, TURN).filter(lambda s: abs(s) > 1e-3))
def test_extents_hold_every_point_and_no_more(start: float, sweep: float) -> None:
    arc = Arc(0.5, -0.25, 2.0, start, sweep)
    points = np.array([arc.point(f) for f in np.linspace(0, 1, 5001)])
    xmin, ymin, xmax, ymax = edge_extents(arc)
    assert (xmin, ymin) == pytest.approx(tuple(points.min(axis=0)), abs=4e-6)
    assert (xmax, ymax) == pytest.approx(tuple(points.max(axis=0)), abs=4e-6)
    assert xmin <= points[:, 0].min() + 1e-15 and xmax >= points[:, 0].max() - 1e-15


def test_length() -> None:
    assert total_length([RING]) == pytest.approx(6.0 * math.pi, rel=1e-15)
    assert KEY.length == pytest.approx(1.5 * math.pi + 2 * math.hypot(3.0 - math.sqrt(0.5), math.sqrt(0.5)), rel=1e-15)


def test_inside_a_circle_to_the_last_digits() -> None:
    assert winding(RING, (1.0 + 3.0 * (1 - 1e-14), 2.0)) == 1
    assert winding(RING, (1.0 + 3.0 * (1 + 1e-14), 2.0)) == 0
    assert winding(RING.reversed(), (1.0, 2.0)) == -1


@given(st.floats(-2, 4), st.floats(-2, 2))
def test_inside_agrees_with_a_fine_polygon(x: float, y: float) -> None:
    shapely = pytest.importorskip("shapely")
    fine = shapely.Polygon(polyline(KEY, 1e-6))
    if fine.exterior.distance(shapely.Point(x, y)) > 2e-6:
        assert (winding(KEY, (x, y)) == 1) == fine.contains(shapely.Point(x, y))


def test_level_corners_are_counted_once() -> None:
    diamond = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]
    loop = Loop(tuple(Line(*a, *b) for a, b in zip(diamond, [*diamond[1:], diamond[0]], strict=True)))
    assert winding(loop, (0.0, 0.0)) == 1
    assert winding(loop, (-3.0, 0.0)) == 0
    assert winding(loop, (-3.0, 1.0)) == 0


@pytest.mark.parametrize("deviation", [1e-2, 1e-4, 1e-6])
def test_vertices_stay_within_the_deviation(deviation: float) -> None:
    points = polyline(RING, deviation)
    assert np.hypot(points[:, 0] - 1.0, points[:, 1] - 2.0) == pytest.approx(3.0, rel=1e-14, abs=0.0)
    middles = 0.5 * (points[1:] + points[:-1])
    sag = 3.0 - np.hypot(middles[:, 0] - 1.0, middles[:, 1] - 2.0)
    assert 0.2 * deviation < sag.max() <= deviation * (1 + 1e-9)
    assert tuple(points[0]) == tuple(points[-1])


def test_vertices_of_chains_and_of_tiny_circles() -> None:
    chain = Loop((Line(0, 0, 1, 0), Arc(1, 1, 1, -math.pi / 2, math.pi / 2)), closed=False)
    points = polyline(chain, 1e-3)
    assert tuple(points[0]) == (0.0, 0.0)
    assert tuple(points[-1]) == pytest.approx((2.0, 1.0))
    assert len(polyline(Loop((Arc(0, 0, 1e-3, 0, TURN),)), 1.0)) == 4
    assert polyline(Loop(()), 1.0).shape == (0, 2)


def test_loops_turn_and_reverse() -> None:
    moved = KEY.moved(math.pi / 2, (1.0, 0.0))
    assert moved.edges[2].start == pytest.approx((1.0, 3.0))
    back = KEY.reversed()
    assert [edge.start for edge in back.edges] == [edge.end for edge in reversed(KEY.edges)]
    assert back.reversed().edges[0].start == pytest.approx(KEY.edges[0].start)


@pytest.mark.parametrize("seed", range(20))
def test_columns_of_many_edges_are_those_of_each(seed: int) -> None:
    rows = np.random.default_rng(seed).uniform(-6.28, 6.28, (200, 5)).tolist()
    edges = [Arc(x, y, abs(r), angle, sweep) if r > -3.0 else Line(x, y, angle, sweep) for x, y, r, angle, sweep in rows]
    edges += [Arc(0.0, 0.0, 1.0, k * math.pi / 2, math.copysign(TURN, k - 2)) for k in range(-3, 4)]
    table = table_of(edges)
    assert table.box == pytest.approx(np.array([edge_extents(edge) for edge in edges]), abs=1e-14)
    assert table.start == pytest.approx(np.array([edge.start for edge in edges]), abs=1e-14)
    assert table.end == pytest.approx(np.array([edge.end for edge in edges]), abs=1e-14)
    low, high = table.box[:, :2].min(axis=0), table.box[:, 2:].max(axis=0)
    assert extents([Loop(tuple(edges), "", False)]) == pytest.approx((*low, *high), abs=1e-14)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_turn_has_three_chords_at_least_whichever_way_it_runs(way: float) -> None:
    """However much they may be off; else as many as the sagitta r (1 - cos(step / 2)) asks for."""
    assert chords(Arc(0.0, 0.0, 1e-3, 0.5, way * 2.0 * math.pi), 1e-3) == 3
    assert chords(Arc(0.0, 0.0, 1e-3, 0.5, way * 1.0), 1e-3) == 1
    step = 2.0 * math.acos(1.0 - 1e-3)
    assert chords(Arc(0.0, 0.0, 1e-3, 0.5, way * 3.0), 1e-6) == math.ceil(3.0 / step)


@pytest.mark.parametrize("edge", [Line(1.0, 2.0, -3.0, 0.5), Arc(0.3, -0.2, 1.5, 0.4, 2.0), Arc(0.3, -0.2, 1.5, 0.4, -6.0)])
def test_points_along_an_edge(edge: Line | Arc) -> None:
    fractions = np.array([0.0, 0.3, 1.0])
    expected = [complex(*edge.point(fraction)) for fraction in fractions.tolist()]
    assert points_along(edge, fractions) == pytest.approx(np.array(expected), abs=4e-15)
