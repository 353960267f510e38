"""How far are two edges from each other? Points by complex numbers, distances by trying all along one of the two."""

import math
from typing import Any

import numpy as np
import pytest
from mpmath import mp
from plain_kernels import in_python

from watchsim.contact import edge_distance as kernels
from watchsim.contact.edge_distance import EDGE, edge_records
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, moved
from watchsim.model import records

_to_edge, _from_point, _on, _over, _place, _nearest, _profile = (
    in_python(getattr(kernels, name))
    for name in ("edge_to_edge", "point_to_edge", "point_on", "height_over", "place_edges", "nearest_edges", "depth_profile")
)
Points = np.ndarray  # as complex numbers


def along(edge: Edge, share: Any) -> Any:
    """The points of an edge at those shares of its way, counter-clockwise for an arc."""
    if isinstance(edge, Line):
        return complex(edge.x0, edge.y0) + np.asarray(share) * complex(edge.x1 - edge.x0, edge.y1 - edge.y0)
    sweep = min(abs(edge.sweep), TURN)
    low = min(edge.start_angle, edge.start_angle + edge.sweep)
    return complex(edge.x, edge.y) + edge.radius * np.exp(1j * (low + np.asarray(share) * sweep))


def apart(edge: Edge, points: Points) -> Points:
    """How far points are from an edge."""
    ends = np.minimum(np.abs(points - along(edge, 0.0)), np.abs(points - along(edge, 1.0)))
    if isinstance(edge, Line):
        start, way = along(edge, 0.0), along(edge, 1.0) - along(edge, 0.0)
        share = ((points - start) / way).real
        return np.where((share >= 0.0) & (share <= 1.0), np.abs(((points - start) / way).imag) * abs(way), ends)
    seen = points - complex(edge.x, edge.y)
    low = min(edge.start_angle, edge.start_angle + edge.sweep)
    within = (np.angle(seen) - low) % TURN <= min(abs(edge.sweep), TURN)
    return np.where(within, np.abs(np.abs(seen) - edge.radius), ends)


def searched(a: Edge, b: Edge) -> float:
    """The shortest way from any point of a, between whose best samples is searched again and again."""
    best, share = math.inf, np.linspace(0.0, 1.0, 801)
    first = apart(b, along(a, share))
    low = np.flatnonzero((first <= np.append(first[1:], math.inf)) & (first <= np.insert(first[:-1], 0, math.inf)))
    for k in low[np.argsort(first[low])][:4]:
        left, right = max(share[k] - 1.0 / 800.0, 0.0), min(share[k] + 1.0 / 800.0, 1.0)
        for _ in range(9):
            fine = np.linspace(left, right, 41)
            values = apart(b, along(a, fine))
            i = int(np.argmin(values))
            left, right = fine[max(i - 1, 0)], fine[min(i + 1, 40)]
            best = min(best, float(values[i]))
    return best


def drawn(rng: np.random.Generator) -> Edge:
    x, y, more, other = rng.uniform(-1.0, 1.0, 4)
    if rng.random() < 0.35:
        return Line(x, y, more, other)
    radius = rng.choice([0.05, 0.3, 0.3, 0.8, 3.0])
    return Arc(x, y, float(radius), 3.0 * more, float(rng.choice([-1.0, 1.0])) * rng.uniform(0.2, 1.1) * min(6.0, 2.0 / radius))


PAIRS = [(drawn(rng), drawn(rng)) for rng in [np.random.default_rng(12)] for _ in range(160)]


def one(edge: Edge) -> Any:
    return edge_records([edge])[0]


def checked(a: Edge, b: Edge) -> tuple[float, bool]:
    """The distance that is told and whether they cross; it is that of the two points that are told, which lie on them."""
    first, second = one(a), one(b)
    distance, way_a, way_b, crossing = _to_edge(first, second)
    p, q = complex(*_on(first, way_a)), complex(*_on(second, way_b))
    assert abs(way_a) <= first.half and abs(way_b) <= second.half
    assert abs(p - q) == pytest.approx(distance, abs=1e-13)
    assert apart(a, np.array([p]))[0] < 1e-14 and apart(b, np.array([q]))[0] < 1e-14
    return distance, crossing


@pytest.mark.parametrize("k", range(len(PAIRS)))
def test_no_point_of_either_is_nearer(k: int) -> None:
    a, b = PAIRS[k]
    truth = searched(a, b)
    (distance, crossing), (back, again) = checked(a, b), checked(b, a)
    assert distance == pytest.approx(truth, abs=1e-9) and back == pytest.approx(distance, abs=1e-13)
    assert crossing is again is (truth < 1e-9)


def in_millimetres(edge: Edge) -> Edge:
    if isinstance(edge, Line):
        return Line(1e-3 * edge.x0, 1e-3 * edge.y0, 1e-3 * edge.x1, 1e-3 * edge.y1)
    return Arc(1e-3 * edge.x, 1e-3 * edge.y, 1e-3 * edge.radius, edge.start_angle, edge.sweep)


@pytest.mark.parametrize("k", range(0, len(PAIRS), 3))
def test_small_edges_too(k: int) -> None:
    small, (a, b) = [in_millimetres(edge) for edge in PAIRS[k]], PAIRS[k]
    (distance, crossing), (whole, meets) = checked(small[0], small[1]), checked(a, b)
    assert distance == pytest.approx(1e-3 * whole, abs=1e-15) and crossing is meets


def test_of_flat_arcs_nothing_is_lost() -> None:
    """A millimetre of a circle a kilometre wide: its middle to the last digit."""
    arc = Arc(0.0, -500.0, 500.0, 0.5 * math.pi - 1.3e-6, 2e-6)
    (row,) = edge_records([arc])
    with mp.workdps(40):
        turn = mp.mpf(arc.start_angle) + mp.mpf(arc.sweep) / 2
        assert abs(mp.mpf(float(row.x)) - 500 * mp.cos(turn)) < 1e-18
        assert abs(mp.mpf(float(row.y)) - (500 * mp.sin(turn) - 500)) < 1e-18


def test_the_pairs_are_of_all_kinds() -> None:
    kinds = {(type(a).__name__, type(b).__name__, searched(a, b) < 1e-9) for a, b in PAIRS}
    assert len(kinds) == 8


HALF = Arc(0.0, 0.0, 0.5, 0.2, 2.5)


@pytest.mark.parametrize(
    "other",
    [
        Arc(0.0, 0.0, 0.5, 3.0, 1.0),  # the same circle, farther on
        Arc(0.3, 0.4, 0.5, 0.1, 1.4),  # as round, aside
        Arc(0.1, -0.2, 0.5, 3.3, 2.0),
        Arc(0.0, 0.0, 0.7, 0.5, 1.0),  # about the same middle
        Arc(0.0, 0.0, 0.7, 3.5, 1.0),
        Arc(1.0, 0.0, 0.5, 2.8, 0.7),  # touching it from outside, or nearly
        Arc(0.1, 0.1, 0.2, 0.0, TURN),  # within it
        Line(-1.0, 0.5, 1.0, 0.5),  # a tangent
        Line(0.0, 0.0, 0.3, 0.1),
    ],
)
def test_circles_that_have_much_in_common(other: Edge) -> None:
    for a, b in ((HALF, other), (other, HALF)):
        assert checked(a, b)[0] == pytest.approx(searched(a, b), abs=1e-9)


@pytest.mark.parametrize(
    "edge", [Line(0.3, -0.2, -0.9, 0.7), HALF, Arc(0.4, -0.1, 0.3, 1.0, -2.0), Arc(0.1, 0.2, 0.6, 1.0, TURN)]
)
def test_records_and_points_by_their_way_from_the_middle(edge: Edge) -> None:
    row = one(edge)
    length = abs(along(edge, 1.0) - along(edge, 0.0)) if isinstance(edge, Line) else edge.radius * abs(edge.sweep)
    assert 2.0 * row.half == pytest.approx(length, rel=1e-12)
    assert row.curvature == (0.0 if isinstance(edge, Line) else pytest.approx(1.0 / edge.radius, rel=1e-15))
    for share in (0.0, 0.21, 0.5, 0.83, 1.0):
        assert complex(*_on(row, (share - 0.5) * length)) == pytest.approx(complex(along(edge, share)), abs=1e-14)
    outwards = complex(row.nx, row.ny)
    if isinstance(edge, Arc):
        assert outwards == pytest.approx((along(edge, 0.5) - complex(edge.x, edge.y)) / edge.radius, abs=1e-14)
    else:
        assert outwards == pytest.approx(-1j * (along(edge, 1.0) - along(edge, 0.0)) / length, abs=1e-14)
    for height, share in ((0.07, 0.3), (-0.04, 0.9)):
        normal = outwards if isinstance(edge, Line) else (along(edge, share) - complex(edge.x, edge.y)) / edge.radius
        p = along(edge, share) + height * normal
        assert _over(row, p.real, p.imag) == pytest.approx((height, (share - 0.5) * length), abs=1e-14)


def test_what_has_no_length_is_left_out_and_no_circle_is_longer_than_itself() -> None:
    rows = edge_records(
        [Line(1.0, 2.0, 1.0, 2.0), Arc(0.0, 0.0, 0.4, 0.0, 9.0), Line(0.0, 0.0, 3.0, 4.0), Line(0.0, 0.0, 3e-4, 4e-4)]
    )
    assert [2.0 * row.half for row in rows] == pytest.approx([TURN * 0.4, 5.0, 5e-4], rel=1e-14)


@pytest.mark.parametrize("seed", range(6))
def test_points_and_several_edges_anywhere(seed: int) -> None:
    """Of all pairs the nearest, wherever both sets stand; and of points on one edge the nearest of the others."""
    rng = np.random.default_rng(seed)
    sets = [[drawn(rng) for _ in range(3)] for _ in range(2)]
    places = [(*rng.uniform(-1.5, 1.5, 2), rng.uniform(-3.0, 3.0)) for _ in range(2)]
    poses = [(x, y, math.cos(turn), math.sin(turn)) for x, y, turn in places]
    own = [edge_records(edges) for edges in sets]
    room = [records(EDGE, 3) for _ in range(2)]
    found = _nearest(own[0], poses[0], own[1], poses[1], *room)
    there = [[moved(edge, turn, (x, y)) for edge in edges] for edges, (x, y, turn) in zip(sets, places, strict=True)]
    truth = np.array([[searched(a, b) for b in there[1]] for a in there[0]])
    assert found.distance == pytest.approx(truth.min(), abs=1e-9) and found.crossing is bool(truth.min() < 1e-9)
    assert truth[found.edge_a, found.edge_b] == pytest.approx(truth.min(), abs=1e-9)
    p = complex(*_on(room[0][found.edge_a], found.way_a))
    q = complex(*_on(room[1][found.edge_b], found.way_b))
    assert abs(p - q) == pytest.approx(found.distance, abs=1e-13)
    ways = np.linspace(-1.0, 1.0, 5) * room[0][1].half
    depths, feet = np.zeros(5), np.zeros((5, 2))
    _profile(room[0], 1, ways, room[1], depths, feet)
    points = np.array([complex(*_on(room[0][1], way)) for way in ways])
    assert depths == pytest.approx(np.min([apart(edge, points) for edge in there[1]], axis=0), abs=1e-13)
    assert np.abs(points - feet @ (1.0, 1.0j)) == pytest.approx(depths, abs=1e-13)


@pytest.mark.parametrize("k", range(0, len(PAIRS), 4))
def test_points(k: int) -> None:
    edge, row = PAIRS[k][0], one(PAIRS[k][0])
    for p in np.random.default_rng(k).normal(size=(20, 2)) @ (1.0, 1.0j):
        distance, way = _from_point(row, p.real, p.imag)
        assert distance == pytest.approx(float(apart(edge, np.array([p]))[0]), abs=1e-13)
        assert abs(p - complex(*_on(row, way))) == pytest.approx(distance, abs=1e-13)
