"""How far along a chain is a place, on which side of it lies a point, and who goes over to the other side?"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from watchsim.drawing.chain_faults import Layer, Meeting, crossing_finding, fresh, names, overlap_finding, stretches
from watchsim.drawing.nodes import Grid, Outline, Track, arrival, nearest_fraction, passes_through
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point

MM = 1e-3
RNG = np.random.default_rng(11)


def row(*corners: Point, closed: bool = True) -> Loop:
    ends = [*corners[1:], corners[0]] if closed else corners[1:]
    return Loop(tuple(Line(MM * a, MM * b, MM * c, MM * d) for (a, b), (c, d) in zip(corners, ends, strict=False)), "L", closed)


SQUARE = row((0, 0), (4, 0), (4, 4), (0, 4))
STAIR = row((0, 0), (2, 0), (2, 1), (5, 1), closed=False)
ROUND = Loop((Line(0.0, 0.0, 2e-3, 0.0), Arc(2e-3, 1e-3, 1e-3, -0.5 * math.pi, math.pi), Line(2e-3, 2e-3, 0.0, 0.0)))


@pytest.mark.parametrize(
    "edge",
    [
        *(Line(1.0, -2.0, 4.0, 3.0), Line(4.0, 3.0, 1.0, -2.0), Line(0.0, 1.0, 0.0, -3.0), Line(-2.0, 1.0, 2.0, 1.0)),
        *(
            Arc(1.0, -1.0, 2.0, 0.4, 1.1),
            Arc(1.0, -1.0, 2.0, 0.4, -1.1),
            Arc(0.0, 0.0, 3.0, 2.5, 5.0),
            Arc(0.0, 0.0, 3.0, 2.5, -5.0),
        ),
        *(Arc(0.5, 0.0, 1.0, 1.0, TURN), Arc(0.5, 0.0, 1.0, 1.0, -TURN)),
    ],
    ids=repr,
)
def test_no_point_of_an_edge_is_nearer_than_that_at_the_nearest_fraction(edge: Edge) -> None:
    shares = np.linspace(0.0, 1.0, 5001).tolist()
    dense = np.array([edge.point(share) for share in shares])
    for p in [(x, y) for x, y in RNG.uniform(-5.0, 5.0, (40, 2)).tolist()]:
        f = nearest_fraction(edge, p)
        gaps = np.hypot(*(dense - p).T)
        assert 0.0 <= f <= 1.0 and math.dist(p, edge.point(f)) <= gaps.min() + 1e-12
        assert gaps.min() - math.dist(p, edge.point(f)) < 2e-3
    for share in (0.0, 0.2, 0.5, 0.9):
        assert nearest_fraction(edge, edge.point(share)) == pytest.approx(share, abs=1e-9)
    assert nearest_fraction(Line(1.0, 2.0, 1.0, 2.0), (5.0, 6.0)) == 0.0


@pytest.mark.parametrize("loop", [SQUARE, STAIR, ROUND], ids=["square", "stair", "round"])
def test_places_are_lengths_from_the_start(loop: Loop) -> None:
    track = Track(loop)
    assert track.length == pytest.approx(sum(edge.length for edge in loop.edges), rel=1e-14)
    before = 0.0
    for number, edge in enumerate(loop.edges):
        for share in (0.25, 0.5, 0.75):
            p, s = edge.point(share), before + share * edge.length
            assert track.position(number, p) == pytest.approx(s, rel=1e-12)
            assert track.at(s) == pytest.approx(p, abs=1e-15)
            for turns in (-2, 1):
                found = track.at(s + turns * track.length)
                assert found == (pytest.approx(p, abs=1e-14) if loop.closed else None)
        before += edge.length
    assert track.at(0.0) == pytest.approx(loop.edges[0].start) and track.at(track.length) == pytest.approx(
        loop.edges[-1].end, abs=1e-15
    )
    if not loop.closed:
        assert track.at(-1e-9) is None and track.at(track.length + 1e-9) is None


def test_an_edge_without_length_is_a_place_too() -> None:
    track = Track(Loop((Line(0.0, 0.0, 1e-3, 0.0), Line(1e-3, 0.0, 1e-3, 0.0)), "L", False))
    assert track.at(1e-3) == (1e-3, 0.0)


@pytest.mark.parametrize("loop", [SQUARE, ROUND], ids=["square", "round"])
def test_of_a_closed_outline_the_left_side_is_inside_by_the_least_distance(loop: Loop) -> None:
    """Counter-clockwise; also beside corners, where two edges are equally near."""
    track = Track(loop)
    dense = np.array([edge.point(share) for edge in loop.edges for share in np.linspace(0.0, 1.0, 400).tolist()])
    for p in [(x, y) for x, y in (MM * RNG.uniform(-1.5, 5.5, (60, 2))).tolist()]:
        turns = np.angle(np.roll((dense - p) @ [1.0, 1.0j], -1) / ((dense - p) @ [1.0, 1.0j])).sum()
        gap, side = track.side(p, 0.0, track.length)
        assert gap == pytest.approx(np.hypot(*(dense - p).T).min(), abs=2e-5)
        assert side == (1.0 if turns > 3.0 else -1.0)


def test_only_the_part_asked_for_counts() -> None:
    track = Track(SQUARE)
    middle = (2e-3, 1e-3)
    assert track.side(middle, 1e-3, 3e-3) == pytest.approx((1e-3, 1.0))
    assert track.side(middle, 5e-3, 7e-3) == pytest.approx((2e-3, 1.0))
    assert track.side(middle, 9e-3, 11e-3) == pytest.approx((3e-3, 1.0))
    assert track.side((-1e-3, -1e-3), 15e-3, 17e-3) == pytest.approx((math.hypot(1e-3, 1e-3), -1.0))  # across the start
    stair = Track(STAIR)
    assert stair.side((1e-3, -1e-3), -9.0, 9.0) == pytest.approx((1e-3, -1.0))
    assert stair.side((4e-3, 3e-3), -9.0, 9.0) == pytest.approx((2e-3, 1.0))
    assert stair.side((3e-3, 5e-4), 0.0, 1e-3)[0] == pytest.approx(math.hypot(1e-3, 5e-4))
    for beyond, side in (((-1e-3, 1e-4), 1.0), ((-1e-3, -1e-4), -1.0), ((6e-3, 1.1e-3), 1.0), ((6e-3, 0.9e-3), -1.0)):
        assert stair.side(beyond, -9.0, 9.0)[1] == side


def crossing(a: Loop, b: Loop, p: Point, depth: float = 1e-8) -> bool:
    def place(track: Track) -> float:
        number = min(
            range(len(track.edges)), key=lambda k: math.dist(track.edges[k].point(nearest_fraction(track.edges[k], p)), p)
        )
        return track.position(number, p)

    one, other = Track(a), Track(b)
    return passes_through(one, place(one), other, place(other), depth)


@pytest.mark.parametrize(
    ("corners", "p", "through"),
    [
        ([(2, -1), (2, 1)], (2, 0), True),
        ([(1, -1), (2, 0), (3, -1)], (2, 0), False),
        ([(1, 1), (2, 0), (3, 1)], (2, 0), False),
        ([(1, -1), (2, 0), (3, 0), (3.5, 1)], (2, 0), True),  # along it, and then over
        ([(1, -1), (2, 0), (3, 0), (3.5, -1)], (2, 0), False),
        ([(-1, 1), (1, -1)], (0, 0), False),  # by the corner
        ([(-1, -1), (1, 1)], (0, 0), True),
        ([(2, 0), (2, 1)], (2, 0), False),  # ends there
    ],
)
def test_who_goes_over_to_the_other_side(corners: list[Point], p: Point, through: bool) -> None:
    at = (MM * p[0], MM * p[1])
    for line in (row(*corners, closed=False), row(*reversed(corners), closed=False)):
        assert crossing(SQUARE, line, at) is through
        assert crossing(line, SQUARE, at) is through


@pytest.mark.parametrize(("deep", "through"), [(0.5, False), (1.5, True), (4.0, True)])
def test_what_goes_over_by_less_than_the_depth_goes_not_over(deep: float, through: bool) -> None:
    depth = 1e-6
    peak = row((1, -1), (2, 1e3 * deep * depth), (3, -1), closed=False)
    share = deep * depth / (1e-3 + deep * depth)
    left = (MM * (2.0 - share), 0.0)
    assert crossing(SQUARE, peak, left, depth) is through


def test_arrival_needs_room() -> None:
    a, b = Track(SQUARE), Track(row((2, -1), (2, 1), closed=False))
    assert arrival(a, 2e-3, b, 1e-3, 1.0, 1e-8, 1e-3) == 1.0 and arrival(a, 2e-3, b, 1e-3, -1.0, 1e-8, 1e-3) == -1.0
    assert arrival(a, 2e-3, b, 1e-3, 1.0, 1e-4, 1.2e-4) == 0.0  # no step fits
    assert arrival(a, 2e-3, b, 1e-3, 1.0, 1.9e-3, 9.0) == 0.0  # it ends before it is so far away
    for way, side in ((1.0, 1.0), (-1.0, -1.0)):
        assert arrival(a, 2e-3, b, 1e-3, way, 0.7e-3, 9.0) == side


def layer(*loops: Loop) -> Layer:
    return Layer([Outline(loop, tuple(f"E{k}{n}" for n in range(len(loop.edges)))) for k, loop in enumerate(loops)], 1e-8)


def test_which_edge_follows_which() -> None:
    whole = layer(SQUARE, STAIR, SQUARE)
    chains: Sequence[Sequence[int]] = ((0, 1, 2, 3), (4, 5, 6), (7, 8, 9, 10))
    expected = {(c[k], c[(k + 1) % len(c)]) for c in chains for k in range(len(c)) if k + 1 < len(c) or len(c) == 4}
    one, other = (grid.ravel() for grid in np.meshgrid(np.arange(11), np.arange(11)))
    found = whole.follows(one, other)
    assert {(a, b) for a, b, is_so in zip(one.tolist(), other.tolist(), found.tolist(), strict=True) if is_so} == expected
    assert [whole.track(k)[1] for k in range(11)] == [0, 1, 2, 3, 0, 1, 2, 0, 1, 2, 3]
    assert whole.track(5)[0] is whole.track(6)[0] is not whole.track(7)[0]
    crossing_pairs = whole.may_cross(np.array([0, 0, 4, 4]), np.array([1, 8, 0, 6]))
    assert crossing_pairs.tolist() == [True, True, False, True]


def test_findings_name_their_edges_and_their_place() -> None:
    whole = layer(SQUARE, STAIR, SQUARE)
    p, q = (1.5e-3, -2.5e-3), (3.5e-3, 0.5e-3)
    for first, second, code, severity in (
        (0, 8, "two outlines cross", "error"),
        (0, 2, "the outline crosses itself", "error"),
        (4, 6, "the open chain crosses itself", "warning"),
    ):
        found = crossing_finding(whole, Meeting(first, second, [p]), p)
        assert (
            found.message.startswith(code)
            and found.severity == severity
            and (found.x_mm, found.y_mm) == pytest.approx((1.5, -2.5))
        )
        assert names(whole, Meeting(first, second, [p])) in found.message
    for first, second, severity in ((0, 8, "notice"), (0, 4, "warning"), (4, 0, "warning"), (0, 2, "warning")):
        lying = overlap_finding(whole, Meeting(first, second, [p, q]), p, q)
        assert lying.severity == severity and (lying.x_mm, lying.y_mm) == pytest.approx((2.5, -1.0)) and lying.layer == "L"


def test_a_place_is_new_once_for_each_pair_of_outlines() -> None:
    whole = layer(SQUARE, STAIR, SQUARE)
    places: dict[tuple[int, int], Grid] = {}
    for pair, p, new in (((0, 8), (0.0, 0.0), True), ((1, 9), (1e-9, 0.0), False), ((9, 1), (0.0, 1e-9), False)):
        assert fresh(whole, Meeting(*pair, [p]), p, places) is new
    for pair, p in (((0, 5), (0.0, 0.0)), ((0, 1), (0.0, 0.0)), ((0, 8), (1e-6, 0.0))):
        assert fresh(whole, Meeting(*pair, [p]), p, places)


def test_edges_lie_on_each_other_between_their_common_points_only() -> None:
    circle = Loop((Arc(0.0, 0.0, MM, 0.5, TURN),))
    part = Loop((Arc(0.0, 0.0, MM, 0.2, 1.0),), "L", False)
    ends = [part.edges[0].start, part.edges[0].end]
    for loops, points in (((circle, part), ends), ((circle, part), ends[::-1])):
        ((p, q),) = stretches(layer(*loops), Meeting(0, 1, points))
        assert {p, q} == set(ends)
    chord = row((math.cos(0.2), math.sin(0.2)), (math.cos(1.2), math.sin(1.2)), closed=False)
    assert stretches(layer(circle, chord), Meeting(0, 1, ends)) == stretches(layer(part, chord), Meeting(0, 1, ends)) == []
    assert stretches(layer(SQUARE, SQUARE), Meeting(0, 4, [(0.0, 0.0)])) == []
