"""When do spans go on as one line or one arc, and when do two arcs become one?"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from watchsim.geometry.biarcs import Curve
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.recognition import (
    _apart,
    _circumcentres,
    _continues,
    _edge,
    _Spans,
    _together,
    joined,
    parts_of,
    whole_circle,
)

LIMIT = 0.05 * 1e-7  # so far circles may lie apart for a tolerance of 0.1 µm


def round_spans(circles: list[tuple[float, float, float]], angles: list[float]) -> _Spans:
    """One span of seven points on each of the circles (x, y, radius), from each of the angles to the next."""
    points = []
    for (x, y, r), (a, b) in zip(circles, pairwise(angles), strict=True):
        t = np.linspace(a, b, 7)
        points.append(np.column_stack((x + r * np.cos(t), y + r * np.sin(t))))
    rows, yes = np.array(circles), np.ones(len(circles), dtype=bool)
    return _Spans(np.array(points), ~yes, yes, rows[:, :2], rows[:, 2])


def straight_spans(*corners: tuple[float, float]) -> _Spans:
    points = np.array([np.linspace(a, b, 7) for a, b in pairwise(corners)])
    yes = np.ones(len(points), dtype=bool)
    return _Spans(points, yes, ~yes, np.full((len(points), 2), np.nan), np.full(len(points), np.nan))


@pytest.mark.parametrize(
    ("dx", "dy", "dr", "goes_on"),
    [
        (0.0, 0.0, 0.0, True),
        (0.55, -0.7, 0.0, True),
        (0.6, -0.85, 0.0, False),
        (0.0, 0.0, 0.95, True),
        (0.0, 0.0, 1.05, False),
        (0.0, 0.0, -0.95, True),
        (0.0, 0.0, -1.05, False),
        (0.3, -0.4, 0.45, True),
        (0.3, -0.4, 0.55, False),
        (0.3, -0.4, -0.55, False),
    ],
)
def test_round_spans_go_on_where_their_circles_differ_by_a_twentieth_of_the_tolerance(
    dx: float, dy: float, dr: float, goes_on: bool
) -> None:
    circles = [(9e-3, 9e-3, 1e-3), (1e-3, 2e-3, 5e-3), (1e-3 + dx * LIMIT, 2e-3 + dy * LIMIT, 5e-3 + dr * LIMIT)]
    assert _continues(round_spans(circles, [0.0, 0.3, 1.0, 1.8]), 1, 2, 1e-7) is goes_on


@pytest.mark.parametrize(("off", "goes_on"), [(0.95, True), (-0.95, True), (1.05, False), (-1.05, False)])
def test_straight_spans_go_on_where_they_are_in_line(off: float, goes_on: bool) -> None:
    """The triangle of both has twice an area of 1e-9 of the square of the whole, at most: 5 m long, of 2 m and 3 m."""
    ux, uy = 0.6, 0.8
    lift = off * 25.0 * 1e-9 / 5.0
    corners = (7.0, 7.0), (0.0, 0.0), (2.0 * ux - lift * uy, 2.0 * uy + lift * ux), (5.0 * ux, 5.0 * uy)
    spans = straight_spans(*corners)
    assert _continues(spans, 1, 2, 1e-7) is goes_on and not _continues(spans, 0, 1, 1e-7)


def test_a_straight_span_that_turns_back_does_not_go_on() -> None:
    assert not _continues(straight_spans((0, 0), (3, 4), (1.5, 2.0)), 0, 1, 1e-7)
    assert not _continues(straight_spans((0, 0), (3, 4), (-3, -4)), 0, 1, 1e-7)
    assert _continues(straight_spans((0, 0), (3, 4), (3.3, 4.4)), 0, 1, 1e-7)


def test_spans_of_different_kinds_do_not_go_on() -> None:
    """Straight, round and neither, with each other."""
    line, bow = straight_spans((0.0, 0.0), (3.0, 4.0)), round_spans([(1.0, 2.0, 5.0)], [0.2, 0.9])
    no = np.zeros(1, dtype=bool)
    rest = bow._replace(round=no)
    kinds = [line, bow, rest]
    for i, one in enumerate(kinds):
        for j, other in enumerate(kinds):
            both = _Spans(*(np.concatenate(pair) for pair in zip(one, other, strict=True)))
            expected = i == j and i != 0  # the same line again would turn back
            assert _continues(both, 0, 1, 1e-7) is expected


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize(("gap", "whole"), [(0.9e-9, True), (1.1e-9, False)])
def test_an_arc_that_nearly_closes_is_a_circle(way: float, gap: float, whole: bool) -> None:
    """Of 3 m of radius, from 0.4 rad on."""
    angles = [0.4 + way * a for a in (0.0, 2.0, 3.5, TURN - gap)]
    edge = _edge(round_spans([(1.0, 2.0, 3.0)] * 3, angles), [0, 1, 2])
    assert isinstance(edge, Arc) and (edge.x, edge.y, edge.radius, edge.start_angle) == pytest.approx((1.0, 2.0, 3.0, 0.4))
    assert edge.sweep == pytest.approx(way * (TURN - gap), abs=2e-9) and (edge.sweep == way * TURN) is whole


def test_the_edge_of_some_spans_runs_from_the_first_to_the_last() -> None:
    line = _edge(straight_spans((9, 9), (1, 2), (4, 6), (7, 10)), [1, 2])
    assert line == Line(1.0, 2.0, 7.0, 10.0)
    circles = [(7.0, 7.0, 1.0), (1.0, 2.0, 5.0), (1.2, 2.4, 5.6)]
    arc = _edge(round_spans(circles, [0.0, 0.3, 0.9, 1.7]), [1, 2])
    assert isinstance(arc, Arc) and (arc.x, arc.y, arc.radius) == pytest.approx((1.1, 2.2, 5.3))
    short = _edge(round_spans([(1.0, 2.0, 3.0)], [0.4, 0.4 + 1e-10]), [0])
    assert isinstance(short, Arc) and abs(short.sweep) < 1e-8  # its ends meet, but it does not go round
    assert _edge(round_spans([(1.0, 2.0, 3.0)], [0.4, 0.9])._replace(round=np.array([False])), [0]) is None


def test_a_circle_through_three_points() -> None:
    p = [[(3.0 + 2.5 * math.cos(a), -1.0 + 2.5 * math.sin(a)) for a in row] for row in ((0.3, 1.9, 4.0), (2.0, 1.1, -0.4))]
    a, b, c = np.array(p).transpose(1, 0, 2)
    assert _circumcentres(a, b, c) == pytest.approx(np.array([(3.0, -1.0)] * 2), rel=1e-12)


@pytest.mark.parametrize(("bow", "straight"), [(0.95, True), (-0.95, True), (1.05, False), (-1.05, False)])
def test_a_span_is_straight_within_a_thousand_millionth_of_its_length(bow: float, straight: bool) -> None:
    """Half of what the middle control point is off."""
    off = 2.0 * bow * 1e-9 * 5e-3
    control = np.array([[(0.0, 0.0, 1.0), (1.5e-3 - 0.8 * off, 2e-3 + 0.6 * off, 1.0), (3e-3, 4e-3, 1.0)]])
    ((part,),) = parts_of([Curve(control, np.array([0.0, 1.0]))], [1e-7])
    assert isinstance(part.edge, Line) is straight


def ring(sweeps: list[float], gap: float = 0.0) -> Curve:
    """Rational arcs about (1, 2) of radius 3; the last point is moved outward by the gap."""
    rows, a = [], 0.4
    for sweep in sweeps:
        h = 0.5 * sweep
        for angle, weight in ((a, 1.0), (a + h, math.cos(h)), (a + sweep, 1.0)):
            rows.append((weight + 3.0 * math.cos(angle), 2.0 * weight + 3.0 * math.sin(angle), weight))
        a += sweep
    control = np.array(rows).reshape(-1, 3, 3)
    control[-1, -1] = control[0, 0]
    control[-1, -1, :2] += gap * np.array([math.cos(0.4), math.sin(0.4)])
    return Curve(control, np.arange(len(sweeps) + 1.0))


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_circle_may_have_short_spans(way: float) -> None:
    fit = whole_circle(ring([way * 1e-3, way * 2.0, way * 2.0, way * (TURN - 4.001)]), 1e-6)
    assert fit is not None and isinstance(fit.edges[0], Arc)
    edge = fit.edges[0]
    assert (edge.x, edge.y, edge.radius, edge.start_angle, edge.sweep) == pytest.approx((1.0, 2.0, 3.0, 0.4, way * TURN))


@pytest.mark.parametrize(("share", "closed"), [(0.98, True), (1.02, False)])
def test_a_circle_is_open_by_a_thousand_millionth_of_its_length_at_most(share: float, closed: bool) -> None:
    gap = share * 1e-9 * TURN * 3.0
    curve = ring([TURN / 4] * 4, gap)
    assert curve.open_by() < 1e-9 and (whole_circle(curve, 1e-4) is not None) is closed


def test_short_arcs_are_joined_and_more_than_a_turn_is_not() -> None:
    edges, _ = joined([Arc(1.0, 2.0, 3.0, 0.4, 0.01), Arc(1.0, 2.0, 3.0, 0.41, 0.02)], 1e-6)
    assert len(edges) == 1 and edges[0].length == pytest.approx(0.09)
    for way in (1.0, -1.0):
        one = Arc(1.0, 2.0, 3.0, 0.4, way * 4.0)
        assert _apart(one, Arc(1.0, 2.0, 3.0, 0.4 + way * 4.0, way * 3.0)) == math.inf
        assert _apart(one, Arc(1.0, 2.0, 3.0, 0.4 + way * 4.0, way * (TURN - 4.0))) == 0.0
        assert _apart(one, Arc(1.0, 2.0, 3.0, 0.4 + way * 4.0, -way)) == math.inf
        whole = _together(one, Arc(1.0, 2.0, 3.0, 0.4 + way * 4.0, way * (TURN - 4.0)))
        assert whole == Arc(1.0, 2.0, 3.0, 0.4, way * TURN)
    assert _apart(Arc(1.0, 2.0, 3.0, 0.4, 1.0), Arc(1.0 + 3e-6, 2.0 - 4e-6, 3.0 - 2e-6, 1.4, 1.0)) == pytest.approx(7e-6)
    with pytest.raises(TypeError):
        _together(Arc(1.0, 2.0, 3.0, 0.4, 1.0), Line(0.0, 0.0, 1.0, 0.0))
