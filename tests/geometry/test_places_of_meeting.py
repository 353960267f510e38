"""Where do single lines and arcs meet, how near is near, and what lies inside?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.geometry.loops import Inside, Loop, near_pairs, table_of, winding
from watchsim.geometry.meetings import meetings, within
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point, moved

REACH = 1e-6
ONE, OTHER = np.zeros(1, np.int64), np.ones(1, np.int64)
ROOT3 = math.sqrt(3.0)


def met(a: Edge, b: Edge, reach: float = REACH) -> set[Point]:
    """The places, each once; the same whichever edge comes first and whichever way they run."""
    found: list[set[Point]] = []
    for pair in ((a, b), (b, a), (a.reversed(), b), (a, b.reversed())):
        points = meetings(table_of(pair), ONE, OTHER, reach).point.tolist()
        found.append({(round(x, 9) + 0.0, round(y, 9) + 0.0) for x, y in points})
    assert found[0] == found[1] == found[2] == found[3]
    return found[0]


def circle(x: float, y: float, r: float) -> Arc:
    return Arc(x, y, r, 0.7, TURN)


CASES: list[tuple[Edge, Edge, set[Point]]] = [
    (Line(0, 0, 4, 0), Line(1, -1, 1, 3), {(1.0, 0.0)}),
    (Line(0, 0, 4, 0), Line(1, 1, 1, 3), set()),
    (Line(0, 0, 4, 0), Line(5, -1, 5, 3), set()),
    (Line(0, 0, 4, 0), Line(4, 0, 6, 6), {(4.0, 0.0)}),
    (Line(0, 0, 4, 0), Line(1, 1, 3, 1), set()),
    (Line(0, 0, 4, 0), Line(3, 0, 6, 0), {(3.0, 0.0), (4.0, 0.0)}),
    (Line(0, 0, 3, 4), Line(3, 0, 0, 4), {(1.5, 2.0)}),
    (Line(-3, 0, 3, 0), circle(0, 0, 2), {(-2.0, 0.0), (2.0, 0.0)}),
    (Line(-3, 1, 3, 1), circle(0, 0, 2), {(round(-ROOT3, 9), 1.0), (round(ROOT3, 9), 1.0)}),
    (Line(0, -1, 9, -1), circle(0, 0, 2), {(round(ROOT3, 9), -1.0)}),
    (Line(-3, 2.1, 3, 2.1), circle(0, 0, 2), set()),
    (Line(0, 0, 9, 0), Arc(0, 0, 2, 0.1, 1.0), set()),
    (Line(0, 0, 9, 9), Arc(0, 0, 2, 0.1, 1.0), {(round(math.sqrt(2), 9), round(math.sqrt(2), 9))}),
    (Line(0, 0, -9, -9), Arc(0, 0, 2, 3.0, 1.0), {(round(-math.sqrt(2), 9), round(-math.sqrt(2), 9))}),
    (circle(0, 0, 2), circle(2, 0, 2), {(1.0, round(ROOT3, 9)), (1.0, round(-ROOT3, 9))}),
    (
        circle(0, 0, 2),
        circle(0, 3, 1.5),
        {
            (round(math.sqrt(4 - (10.75 / 6) ** 2), 9), round(10.75 / 6, 9)),
            (round(-math.sqrt(4 - (10.75 / 6) ** 2), 9), round(10.75 / 6, 9)),
        },
    ),
    (circle(0, 0, 2), circle(0.5, 0, 1), set()),
    (circle(0.5, 0, 1), circle(0, 0, 2), set()),
    (circle(0, 0, 2), circle(9, 0, 1), set()),
    (Arc(0, 0, 2, 0.0, math.pi), Arc(2, 0, 2, 0.0, math.pi), {(1.0, round(ROOT3, 9))}),
    (Arc(0, 0, 2, 0.0, -math.pi), Arc(2, 0, 2, 0.0, -math.pi), {(1.0, round(-ROOT3, 9))}),
    (Arc(0, 0, 2, 0.2, 0.3), Arc(2, 0, 2, 0.0, math.pi), set()),
]


@pytest.mark.parametrize(("a", "b", "places"), CASES, ids=[f"{a} {b}" for a, b, _ in CASES])
def test_edges_meet_at_these_places(a: Edge, b: Edge, places: set[Point]) -> None:
    assert met(a, b) == places
    for turn, shift in ((0.4, (0.0, 0.0)), (-2.0, (30.0, -7.0))):  # the same figure elsewhere
        c, s = math.cos(turn), math.sin(turn)
        found = meetings(table_of([moved(a, turn, shift), moved(b, turn, shift)]), ONE, OTHER, REACH).point
        images = [(c * x - s * y + shift[0], s * x + c * y + shift[1]) for x, y in places]
        assert all(min(math.dist(p, q) for q in images) < 1e-8 for p in found.tolist())
        assert all(np.hypot(*(found - q).T).min() < 1e-8 for q in images)


@pytest.mark.parametrize(("gap", "touches"), [(-0.9, True), (0.9, True), (1.1, False)])
def test_what_comes_within_the_reach_meets(gap: float, touches: bool) -> None:
    off = gap * REACH
    pairs: list[tuple[Edge, Edge]] = [
        (Line(0, 0, 4, 0), Line(1, off, 1, 3)),
        (Line(0, 0, 4, 0), Line(4 + off, 0, 6, 1)),
        (Line(-3, 2 + off, 3, 2 + off), circle(0, 0, 2)),
        (circle(0, 0, 2), circle(3 + off, 0, 1)),
        (Line(2 + off, 0, 5, 0), circle(0, 0, 2)),
        (Line(2 - off, 0, 1, 0), circle(0, 0, 2)),
    ]
    for a, b in pairs:
        for one, other in ((a, b), (b, a)):
            for unit in (1.0, 1e-5):
                table = table_of([scaled(one, unit), scaled(other, unit)])
                assert bool(len(meetings(table, ONE, OTHER, unit * REACH).point)) is touches, (a, b)


@pytest.mark.parametrize("unit", [1.0, 1e-5])
@pytest.mark.parametrize(
    "edge",
    [Line(1, 2, 5, 5), Arc(1, 2, 3, 0.4, 2.0), Arc(1, 2, 3, 0.4, -2.0), Arc(0, 0, 2, 3.0, 5.5)],
    ids=repr,
)
def test_a_point_is_near_an_edge_within_the_reach_of_any_of_its_points(edge: Edge, unit: float) -> None:
    dense = np.array([edge.point(share) for share in np.linspace(0.0, 1.0, 2001).tolist()])
    rng = np.random.default_rng(1)
    points = np.vstack((rng.uniform(-4.0, 7.0, (300, 2)), dense[::50], dense[::50] + rng.normal(0.0, 0.5, (41, 2))))
    gaps = np.array([np.hypot(*(dense - p).T).min() for p in points])
    table = table_of([scaled(edge, unit)])
    for reach in (0.01, 0.3, 1.0):
        found = within(table, np.zeros(len(points), np.int64), unit * points, unit * reach)
        sure = np.abs(gaps - reach) > 5e-3
        beyond = found != (gaps <= reach)
        assert not np.any(beyond & sure)


def scaled(edge: Edge, unit: float) -> Edge:
    if isinstance(edge, Line):
        return Line(unit * edge.x0, unit * edge.y0, unit * edge.x1, unit * edge.y1)
    return Arc(unit * edge.x, unit * edge.y, unit * edge.radius, edge.start_angle, edge.sweep)


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("far", [0.0, 1000.0])
def test_the_winding_is_one_inside_whatever_the_height(way: int, far: float) -> None:
    corners = [(0.0, 0.0), (6.0, 0.0), (6.0, 1.0), (2.0, 1.0), (2.0, 2.0), (6.0, 2.0), (6.0, 5.0), (0.0, 5.0)]
    edges: list[Edge] = [
        Line(a + far, b, c + far, d) for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1], strict=True)
    ]
    edges[5:6] = [Line(6 + far, 2, 6 + far, 3), Arc(6 + far, 3.5, 0.5, -0.5 * math.pi, math.pi), Line(6 + far, 4, 6 + far, 5)]
    loop = Loop(tuple(edges))
    loop = loop if way > 0 else loop.reversed()
    inside = Inside(loop)
    for x in np.arange(-0.75, 7.0, 0.3).tolist():
        for y in (-9.0, -0.25, 0.0005, 0.25, 0.75, 1.25, 1.75, 2.5, 3.25, 3.6, 3.9, 4.75, 5.25, 99.0):
            bump = math.hypot(x - 6.0, y - 3.5) < 0.5 and x > 6.0
            expected = (0 < x < 6 and 0 < y < 5 and not (2 < x < 6 and 1 < y < 2)) or bump
            assert inside.winding((x + far, y)) == winding(loop, (x + far, y)) == (way if expected else 0)


def test_a_flat_loop_holds_nothing_and_what_is_level_with_a_corner_counts_once() -> None:
    flat = Loop((Line(0, 0, 4, 0), Line(4, 0, 0, 0)))
    assert Inside(flat).winding((1.0, 0.5)) == Inside(flat).winding((1.0, -0.5)) == Inside(flat).winding((9.0, 0.0)) == 0
    kite = Loop((Line(0, -2, 3, 0), Line(3, 0, 0, 2), Line(0, 2, -3, 0), Line(-3, 0, 0, -2)))
    for x, inner in ((-4.0, 0), (-2.9, 1), (0.0, 1), (2.9, 1), (3.1, 0)):
        assert Inside(kite).winding((x, 0.0)) == winding(kite, (x, 0.0)) == inner
    tiny = Loop(tuple(Line(1e-3 * e.x0, 1e-3 * e.y0, 1e-3 * e.x1, 1e-3 * e.y1) for e in kite.edges if isinstance(e, Line)))
    assert [winding(tiny, (0.0, y)) for y in (-2.1e-3, -1e-4, 1e-4, 5e-4, 2.1e-3)] == [0, 1, 1, 1, 0]


@pytest.mark.parametrize("reach", [1e-9, 0.05])
def test_no_pair_of_near_edges_is_lost_and_few_far_ones_come_along(reach: float) -> None:
    """Against all pairs by dense points, many short edges in one corner and long ones over all."""
    rng = np.random.default_rng(0)
    edges: list[Edge] = []
    for k in range(70):
        size = 0.05 if k < 50 else 2.0
        x, y, dx, dy = (rng.uniform(-1, 1, 4) * [1, 1, size, size]).tolist()
        x, y = (0.2 * x, 0.2 * y) if k < 50 else (x, y)
        edges.append(Line(x, y, x + dx, y + dy) if k % 2 else Arc(x, y, abs(dx) + 1e-3, 7 * dy, 2 + dx))
    near = near_pairs(table_of(edges), reach)
    found = set(zip(near.first.tolist(), near.second.tolist(), strict=True))
    assert len(found) == len(near.first) and all(a < b for a, b in found) and near.crowds == ()
    first, second = np.triu_indices(len(edges), 1)
    dense = np.array([[edge.point(share) for share in np.linspace(0, 1, 25).tolist()] for edge in edges]) @ [1.0, 1.0j]
    gaps = np.array([np.abs(dense[a][:, None] - dense[b]).min() for a, b in zip(first, second, strict=True)])
    together = set(meetings(table_of(edges), first, second, 1e-9).pair.tolist()) | set(np.flatnonzero(gaps <= reach).tolist())
    assert len(together) > 20 and {(int(first[k]), int(second[k])) for k in together} <= found
    boxes = table_of(edges).box
    for a, b in found:
        assert np.all(boxes[a, :2] <= boxes[b, 2:] + reach) and np.all(boxes[b, :2] <= boxes[a, 2:] + reach)


def test_two_edges_are_a_pair_and_one_is_none() -> None:
    crossing = [Line(0, 0, 4, 0), Line(1, -1, 1, 3)]
    found = near_pairs(table_of(crossing), REACH)
    assert (found.first.tolist(), found.second.tolist(), found.crowds) == ([0], [1], ())
    assert len(near_pairs(table_of(crossing[:1]), REACH).first) == 0
