"""Where do single lines and arcs meet, how near is near, and what lies inside?"""

import cmath
import math
import random
from dataclasses import replace
from decimal import Decimal

import mpmath
import numpy as np
import pytest
from every_time import few
from hypothesis import given
from hypothesis import strategies as st

from watchsim.geometry.loops import (
    Inside,
    Loop,
    chords,
    edge_extents,
    extents,
    meetings,
    near_pairs,
    points_along,
    polyline,
    table_of,
    total_length,
    winding,
    within,
)
from watchsim.geometry.primitives import QUARTER, TURN, Arc, Edge, Line, Point, cos_sin, moved
from watchsim.geometry.solids import pieces, region
from watchsim.scene import outlines
from watchsim.scene.outlines import first_crossing

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
    "edge", [Line(1, 2, 5, 5), Arc(1, 2, 3, 0.4, 2.0), Arc(1, 2, 3, 0.4, -2.0), Arc(0, 0, 2, 3.0, 5.5)], ids=repr
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


REACH_MEETINGS = 1e-9
SAMPLES = 4000


def random_edge(rng: random.Random, size: float) -> Edge:
    x, y = rng.uniform(-1, 1), rng.uniform(-1, 1)
    if rng.random() < 0.5:
        return Line(x, y, x + rng.uniform(-size, size), y + rng.uniform(-size, size))
    return Arc(x, y, rng.uniform(0.05, size), rng.uniform(-7, 7), rng.choice((-1, 1)) * rng.uniform(0.2, 6.2))


def places(edge: Edge, t: np.ndarray) -> np.ndarray:
    """Points of the edge as complex numbers."""
    if isinstance(edge, Line):
        return complex(edge.x0, edge.y0) + t * complex(edge.x1 - edge.x0, edge.y1 - edge.y0)
    return complex(edge.x, edge.y) + edge.radius * np.exp(1j * (edge.start_angle + t * edge.sweep))


def level(edge: Edge, z: np.ndarray) -> np.ndarray:
    """A function that vanishes on the line or circle of the edge."""
    if isinstance(edge, Line):
        a, b = complex(edge.x0, edge.y0), complex(edge.x1, edge.y1)
        return np.imag((z - a) * np.conj(b - a)) / abs(b - a)
    return np.abs(z - complex(edge.x, edge.y)) - edge.radius


def on(edge: Edge, z: complex) -> bool:
    """Does a point of the line or circle lie on the edge itself?"""
    if isinstance(edge, Line):
        a, b = complex(edge.x0, edge.y0), complex(edge.x1, edge.y1)
        return 0.0 < ((z - a) / (b - a)).real < 1.0
    turn = cmath.phase((z - complex(edge.x, edge.y)) * cmath.exp(-1j * edge.start_angle))
    return (turn if edge.sweep > 0 else -turn) % (2 * math.pi) < abs(edge.sweep)


def by_sampling(a: Edge, b: Edge) -> list[complex]:
    """Changes of sign along a, refined by bisection."""
    t = np.linspace(0.0, 1.0, SAMPLES)
    f = level(b, places(a, t))
    found = []
    for k in np.flatnonzero(f[:-1] * f[1:] < 0.0):
        low, high = t[k], t[k + 1]
        for _ in range(60):
            middle = 0.5 * (low + high)
            same = level(b, places(a, np.array([middle])))[0] * f[k] > 0.0
            low, high = (middle, high) if same else (low, middle)
        z = complex(places(a, np.array([low]))[0])
        found += [z] if on(b, z) else []
    return found


@pytest.mark.parametrize("seed", few(range(3), 1))
def test_points_are_those_of_sampling_and_no_pair_is_lost(seed: int) -> None:
    rng = random.Random(seed)
    edges = [random_edge(rng, rng.choice((0.1, 0.5, 2.0))) for _ in range(80)]
    table = table_of(edges)
    near = near_pairs(table, REACH_MEETINGS)
    found = meetings(table, near.first, near.second, REACH_MEETINGS)
    points: dict[tuple[int, int], list[complex]] = {}
    for k, (x, y) in zip(found.pair.tolist(), found.point.tolist(), strict=True):
        points.setdefault((int(near.first[k]), int(near.second[k])), []).append(complex(x, y))
    total = 0
    for i, a in enumerate(edges):
        for j in range(i + 1, len(edges)):
            expected, got = by_sampling(a, edges[j]), points.get((i, j), [])
            total += len(expected)
            assert len(got) == len(expected), (i, j)
            assert all(min(abs(z - w) for w in got) < 1e-9 for z in expected)
    assert total > 50


def test_pairs_come_once_and_far_edges_not_at_all() -> None:
    edges: list[Edge] = [Line(float(k), 0.0, float(k + 1), 0.0) for k in range(3000)]
    near = near_pairs(table_of(edges), REACH_MEETINGS)
    assert set(zip(near.first.tolist(), near.second.tolist(), strict=True)) >= {(k, k + 1) for k in range(2999)}
    assert len(near.first) == 2999 and not near.crowds
    assert not len(near_pairs(table_of(edges[:1]), REACH_MEETINGS).first)


def test_edges_that_cannot_be_told_apart_are_reported() -> None:
    near = near_pairs(table_of([Line(0.0, 0.0, 1.0, 1.0)] * 500), REACH_MEETINGS)
    assert near.crowds and len(near.first) < 500 * 40


STEPS = 400  # along each edge
NEAR = 5e-3  # of the outline's size: so near to an arc its chords do not tell


def arc_between(a: complex, b: complex, sweep: float) -> Arc:
    """The arc from a to b that turns by `sweep` on its way."""
    centre = 0.5 * (a + b) + 0.5j * (b - a) / math.tan(0.5 * sweep)
    return Arc(centre.real, centre.imag, abs(a - centre), cmath.phase(a - centre), sweep)


def made_up(rng: np.random.Generator, count: int) -> Loop:
    """A loop of lines and arcs that may cross itself; arcs turn by up to a whole turn, either way."""
    corners = rng.uniform(-1.0, 1.0, count) + 1j * rng.uniform(-1.0, 1.0, count)
    edges: list[Edge] = []
    for a, b in zip(corners, np.roll(corners, -1), strict=True):
        sweep = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.3, 5.5))
        edges.append(arc_between(a, b, sweep) if rng.random() < 0.7 else Line(a.real, a.imag, b.real, b.imag))
    return Loop(tuple(edges))


def dense(loop: Loop) -> np.ndarray:
    return np.concatenate([[complex(*edge.point(share)) for share in np.linspace(0.0, 1.0, STEPS)] for edge in loop.edges])


def turns(points: np.ndarray, p: complex) -> int:
    steps = np.angle((np.append(points[1:], points[0]) - p) / (points - p))
    return round(float(steps.sum()) / TURN)


@pytest.mark.parametrize("count", [2, 3, 7, 40])
@pytest.mark.parametrize("shift", [0.0, 30.0])
def test_against_the_angle_swept(count: int, shift: float) -> None:
    """Also far from the origin, where what is measured from there would give other strips."""
    rng = np.random.default_rng(count)
    loop = made_up(rng, count).moved(0.0, (shift, -shift))
    points = dense(loop)
    size = float(np.abs(points - points.mean()).max())
    inside, asked, found = Inside(loop), 0, set()
    for _ in range(300):
        p = points.mean() + size * complex(*rng.uniform(-1.0, 1.0, 2))
        if np.abs(points - p).min() > NEAR * size:
            asked += 1
            truth = turns(points, p)
            assert winding(loop, (p.real, p.imag)) == inside.winding((p.real, p.imag)) == truth
            found.add(truth)
    assert asked > 200 and len(found) > 1


@pytest.mark.parametrize("sweep", [-TURN, TURN])
def test_a_circle(sweep: float) -> None:
    """From any start: points within, beside, above and below, level with its start as well."""
    for start in np.linspace(-4.0, 4.0, 9):
        loop = Loop((Arc(1.0, -2.0, 0.5, float(start), sweep),))
        inside, level = Inside(loop), loop.edges[0].start[1]
        for x in (0.4, 0.6, 0.9, 1.3, 1.6):
            for y in (-2.6, -2.4, -2.0, -1.7, -1.4, level):
                away = math.hypot(x - 1.0, y + 2.0) - 0.5
                if abs(away) > 1e-6:
                    truth = 0 if away > 0.0 else round(sweep / TURN)
                    assert winding(loop, (x, y)) == inside.winding((x, y)) == truth


SAMPLES_EXTENT = 4001  # odd: the middle of an arc is one of them


def made_up_extent(seed: int) -> list[Edge]:
    """Lines, arcs of any sweep either way, and short ones whose middle lies on an axis."""
    rng = np.random.default_rng(seed)
    edges: list[Edge] = [Line(*rng.uniform(-1.0, 1.0, 4)) for _ in range(5)]
    edges += [Arc(*rng.uniform(-1.0, 1.0, 2), 0.5, rng.uniform(-7.0, 7.0), rng.uniform(-6.0, 6.0)) for _ in range(30)]
    for quarter in range(-5, 6):
        half = rng.choice([-1.0, 1.0]) * 2e-4
        edges.append(Arc(*rng.uniform(-1.0, 1.0, 2), 0.5, quarter * math.pi / 2 - half, 2.0 * half))
    return edges


def sampled(edge: Edge) -> tuple[float, float, float, float]:
    share = np.linspace(0.0, 1.0, SAMPLES_EXTENT)
    if isinstance(edge, Arc):
        angle = edge.start_angle + share * edge.sweep
        x, y = edge.x + edge.radius * np.cos(angle), edge.y + edge.radius * np.sin(angle)
    else:
        x, y = edge.x0 + share * (edge.x1 - edge.x0), edge.y0 + share * (edge.y1 - edge.y0)
    return x.min(), y.min(), x.max(), y.max()


@pytest.mark.parametrize("seed", range(4))
def test_boxes_against_samples(seed: int) -> None:
    """Between two samples an arc rises by its step squared over eight, at most 3e-7 of the radius."""
    edges = made_up_extent(seed)
    table = table_of(edges)
    for edge, row in zip(edges, table.box, strict=True):
        finest = 1e-12 if abs(getattr(edge, "sweep", 0.0)) < 1e-3 else 2e-7
        assert edge_extents(edge) == pytest.approx(sampled(edge), abs=finest)
        assert row == pytest.approx(sampled(edge), abs=finest)
    few, many = Loop(tuple(edges[:9])), Loop(tuple(edges))
    for loop in (few, many):
        boxes = np.array([sampled(edge) for edge in loop.edges])
        assert extents([loop]) == pytest.approx((*boxes[:, :2].min(axis=0), *boxes[:, 2:].max(axis=0)), abs=2e-7)
    assert total_length([few, many]) == pytest.approx(
        sum(edge.length for edge in (*few.edges, *many.edges)), rel=1e-14, abs=0.0
    )


def test_lines_have_nothing_of_an_arc() -> None:
    table = table_of([Line(1.0, 2.0, 3.0, 5.0), Arc(1.0, 2.0, 3.0, 0.5, -1.5)])
    assert table.arc.tolist() == [False, True]
    rows = np.column_stack((table.centre, table.radius, table.start_angle, table.sweep))
    assert rows.tolist() == [[0.0] * 5, [1.0, 2.0, 3.0, 0.5, -1.5]]
    assert table.start[0].tolist() == [1.0, 2.0] and table.end[0].tolist() == [3.0, 5.0]


def test_nothing_has_no_box() -> None:
    assert extents([]) is None and extents([Loop(())]) is None and total_length([]) == 0.0


RADII = (5e-3, 3e-3, 1e-3)


def circle_enclosed_area(radius: float, way: float, hole: bool) -> Loop:
    return replace(Loop((Arc(1e-3, -2e-3, radius, 0.3, way * TURN),)), closed=True, hole=hole)


@pytest.mark.parametrize("way", [-1.0, 1.0])
@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_an_island_in_a_hole_is_material(way: float, order: tuple[int, ...]) -> None:
    loops = [circle_enclosed_area(radius, way, k == 1) for k, radius in enumerate(RADII)]
    for scale in (None, 1e3):
        found = region([loops[k] for k in order], 1e-8, *([scale] if scale else []))
        exact = math.pi * (RADII[0] ** 2 - RADII[1] ** 2 + RADII[2] ** 2) * (scale or 1.0) ** 2
        assert found.area == pytest.approx(exact, rel=1e-4)
        assert [len(part.interiors) for part in sorted(pieces(found), key=lambda part: part.area)] == [0, 1]


def test_open_chains_enclose_nothing() -> None:
    assert region([replace(circle_enclosed_area(1e-3, 1.0, False), closed=False), Loop(())], 1e-8).is_empty
    assert not list(pieces(region([], 1e-8)))


CHOSEN = random.Random(1)
ANGLES = [
    *(QUARTER * k / 2 for k in range(-9, 10)),  # where one series takes over from the other
    *(Decimal(CHOSEN.uniform(-20.0, 20.0)) for _ in range(30)),
    *(sign * Decimal(10) ** -power for sign in (-1, 1) for power in (1, 7, 19)),
]


@pytest.mark.parametrize("angle", ANGLES, ids=lambda angle: f"{angle:.4g}")
def test_many_digits(angle: Decimal) -> None:
    """Against mpmath with 60 digits; what is small keeps its digits, too."""
    with mpmath.workdps(60):
        exact = mpmath.mpf(str(angle))
        for value, truth in zip(cos_sin(angle), (mpmath.cos(exact), mpmath.sin(exact)), strict=True):
            assert abs(mpmath.mpf(str(value)) - truth) < mpmath.mpf("1e-37")


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


# Which sides of a polygon cross?


def crossing_by_pairs(points: list[Point]) -> tuple[int, int] | None:
    """The first two sides that meet, by all pairs of them: exactly, of corners in whole numbers."""

    def turn(a: Point, b: Point, c: Point) -> float:
        return math.copysign(1.0, cross) if (cross := (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) else 0.0

    count = len(points)
    for i in range(count):
        for j in range(i + 2, count - (i == 0)):
            a, b, c, d = points[i], points[(i + 1) % count], points[j], points[(j + 1) % count]
            apart = any(max(a[k], b[k]) < min(c[k], d[k]) or max(c[k], d[k]) < min(a[k], b[k]) for k in (0, 1))
            if not apart and turn(a, b, c) * turn(a, b, d) <= 0.0 and turn(c, d, a) * turn(c, d, b) <= 0.0:
                return i, j
    return None


def star(rng: random.Random, count: int) -> list[Point]:
    """Corners around the origin, in whole numbers; hardly ever do sides cross."""
    angles = sorted(rng.uniform(0.0, TURN) for _ in range(count))
    corners = ((rng.uniform(5e5, 1e6), angle) for angle in angles)
    return list(dict.fromkeys((float(round(r * math.cos(a))), float(round(r * math.sin(a)))) for r, a in corners))


def test_the_crossing_sides_of_a_polygon_are_those_of_all_pairs() -> None:
    rng = random.Random(5)
    found = []
    for number in range(200):
        points = star(rng, rng.choice((3, 5, 12, 60)))
        if number % 2:  # two corners exchanged
            i, j = rng.sample(range(len(points)), 2)
            points[i], points[j] = points[j], points[i]
        if number % 5 == 0:  # on few places: sides touch, and lie on each other
            points = list(dict.fromkeys((float(rng.randrange(5)), float(rng.randrange(5))) for _ in points + points))
        found.append(first_crossing(points))
        assert found[-1] == crossing_by_pairs(points), points
    assert 20 < found.count(None) < 180
    crowd = [(math.cos(2.0 * k), math.sin(2.0 * k)) for k in range(400)]  # where all sides crowd the first pair is named, too
    assert first_crossing(crowd) == crossing_by_pairs(crowd)


def test_looking_for_crossing_sides_takes_work_in_proportion_to_their_number(monkeypatch: pytest.MonkeyPatch) -> None:
    looked_at = []

    def counted(corners: np.ndarray, first: np.ndarray, second: np.ndarray) -> tuple[int, int] | None:
        looked_at[-1] += len(first)
        return meeting(corners, first, second)

    meeting = outlines._meeting
    monkeypatch.setattr(outlines, "_meeting", counted)
    for count in (2000, 16000):
        looked_at.append(0)
        angles = np.arange(count) * (TURN / count)
        radii = 1.0 + 0.3 * np.sin(3.0 * angles) + 0.02 * np.cos(37.0 * angles)
        assert (
            first_crossing(list(zip((radii * np.cos(angles)).tolist(), (radii * np.sin(angles)).tolist(), strict=True))) is None
        )
    assert looked_at[0] >= 2000 and looked_at[1] <= 10 * looked_at[0]
