"""Do chains come out whole in whatever order and direction their strokes were drawn, and where do stretched lines meet?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import permutations, product

import pytest

from watchsim.drawing.chaining import assembled, chain, closed_runs, folded, joint_of
from watchsim.drawing.findings import Stroke
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point

MM = 1e-3
SNAP = 1e-6


def line(a: Point, b: Point) -> Line:
    return Line(MM * a[0], MM * a[1], MM * b[0], MM * b[1])


def polygon(*corners: Point) -> list[Edge]:
    return [line(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]


def strokes(edges: Sequence[Edge], runs: Sequence[int] | None = None) -> list[Stroke]:
    runs = runs or range(len(edges))
    return [Stroke(edge, "L", f"E{k}", run) for k, (edge, run) in enumerate(zip(edges, runs, strict=True))]


def half(x: float, y: float, r: float, start: float, sweep: float = math.pi) -> Arc:
    return Arc(MM * x, MM * y, MM * r, start, sweep)


LENS: list[Edge] = [
    half(0.0, -1.0, math.sqrt(2.0), 0.25 * math.pi, 0.5 * math.pi),
    half(0, 1, math.sqrt(2), -2.356194490192345, 0.5 * math.pi),
]
SQUARE = polygon((0, 0), (2, 0), (2, 2), (0, 2))
SLIT = polygon((0, 0), (2, 0), (2, 1), (1, 1), (2, 1), (2, 2), (0, 2))


@pytest.mark.parametrize(
    ("edges", "is_so"),
    [
        (SQUARE, False),
        (SLIT, True),
        ([line((0, 0), (3, 1)), line((3, 1), (0, 0))], True),
        (LENS, False),
        ([half(0, 0, 1, 0.0), line((-1, 0), (1, 0))], False),
        ([half(0, 0, 1, 0.0, TURN)], False),
        (polygon((0, 0), (2, 0), (1, 1)), False),
        (polygon((0, 0), (2, 0), (1, 0), (2, 0)), True),
    ],
    ids=["square", "slit", "there and back", "lens", "half disc", "circle", "triangle", "hook"],
)
def test_a_run_that_goes_along_itself_is_no_outline_by_itself(edges: list[Edge], is_so: bool) -> None:
    run = strokes(edges, [5] * len(edges))
    assert folded(run) is is_so
    whole, rest = closed_runs(run)
    assert (whole, rest) == (([], run) if is_so else ([run], []))


def test_what_does_not_close_within_a_nanometre_is_chained_with_others() -> None:
    for gap, closes in ((0.0, True), (0.9e-9, True), (1.1e-9, False)):
        last = replace(SQUARE[3], y1=gap)
        for edges in ([*SQUARE[:3], last], [*SQUARE[1:3], last, SQUARE[0]], [last, *SQUARE[:3]]):
            run = strokes(edges, [1] * 4)
            assert closed_runs(run) == (([run], []) if closes else ([], run))
    two = strokes([*SQUARE, *SQUARE[:3]], [1] * 4 + [2] * 3)
    assert closed_runs(two) == ([two[:4]], two[4:])


@pytest.mark.parametrize("order", list(permutations(range(4))))
def test_an_open_chain_is_found_whole_in_any_order_of_its_strokes(order: tuple[int, ...]) -> None:
    corners: list[Point] = [(0, 0), (3, 0), (4, 2), (7, 2), (7, 5)]
    edges = [line(corners[k], corners[k + 1]) for k in order]
    for turned in ((), (0,), (1, 2), (0, 1, 2, 3)):
        drawn = [edge.reversed() if k in turned else edge for k, edge in enumerate(edges)]
        found = chain(strokes(drawn), SNAP)
        (only,) = found.open_chains
        assert not found.loops and len(only.edges) == 4
        assert all(a.end == b.start for a, b in zip(only.edges, only.edges[1:], strict=False))
        assert drawn[0] in only.edges  # travelled as its first stroke is


@pytest.mark.parametrize("turned", list(product((False, True), repeat=4)))
def test_a_closed_chain_begins_with_its_first_stroke(turned: tuple[bool, ...]) -> None:
    for order in ((0, 1, 2, 3), (2, 0, 3, 1), (3, 2, 1, 0)):
        edges = [SQUARE[k].reversed() if turned[k] else SQUARE[k] for k in order]
        (loop,) = chain(strokes(edges), SNAP).loops
        assert {frozenset((edge.start, edge.end)) for edge in loop.edges} == {frozenset((e.start, e.end)) for e in SQUARE}
        assert loop.closed and all(a.end == b.start for a, b in zip(loop.edges, loop.edges[1:], strict=False))


def test_a_loop_on_a_stick_is_a_loop_and_a_stick() -> None:
    """At their common point nobody knows which way was meant, but what comes back to it is closed."""
    stick = [line((2, 0), (4, -1)), line((4, -1), (6, 0))]
    found = chain(strokes([*SQUARE, *stick]), SNAP)
    assert [len(loop.edges) for loop in found.loops] == [4] and [len(one.edges) for one in found.open_chains] == [2]
    (branch,) = [finding for finding in found.findings if finding.code == "branch"]
    assert (branch.x_mm, branch.y_mm, branch.layer, branch.severity) == (2.0, 0.0, "L", "error")
    assert branch.message == "3 edges meet at (2, 0) mm: E0, E1, E4; which way does the outline go?"
    open_one = chain(strokes([*stick, line((2, 0), (2, 3)), line((2, 0), (0, 1))]), SNAP)
    assert not open_one.loops and len(open_one.open_chains) == 3


def test_arcs_that_only_nearly_agree_are_both_kept() -> None:
    """A lens is an outline however thin, as long as it is thicker than rounding."""
    flat = half(0.0, -50.0, math.hypot(1.0, 50.0), 0.5 * math.pi - math.atan2(1.0, 50.0), 2.0 * math.atan2(1.0, 50.0))
    sagitta = math.hypot(1.0, 50.0) - 50.0
    for thinner, loops in ((0.5e-3, 1), (0.5e-6, 0)):  # mm
        low = sagitta - thinner
        r = 0.5 * (1.0 + low * low) / low
        t = math.atan2(1.0, r - low)
        other = half(0.0, low - r, r, 0.5 * math.pi - t, 2.0 * t)
        found = chain(strokes([flat, other]), SNAP)
        assert len(found.loops) == loops and [f.code for f in found.findings if f.code == "duplicate"] == ["duplicate"] * (
            1 - loops
        )


@pytest.mark.parametrize("closed", [True, False])
def test_lines_meet_half_way_and_at_the_ends_of_arcs(closed: bool) -> None:
    gap = 1e-7
    a, b = Line(0.0, 0.0, 1.0, 0.0), Line(1.0 + gap, 2.0 * gap, 1.0, 1.0)
    bow = Arc(0.5, 1.0 + 3.0 * gap, 0.5, 0.0, math.pi)
    back = Line(0.0, 1.0, 0.0, 4.0 * gap)
    loop = assembled(strokes([a, b, bow, back]), "L", closed).loop
    assert isinstance(loop, Loop) and loop.closed is closed and loop.layer == "L"
    middle = (1.0 + 0.5 * gap, gap)
    assert loop.edges[0].end == loop.edges[1].start == pytest.approx(middle, rel=1e-15, abs=0.0)
    assert loop.edges[1].end == bow.start and loop.edges[2] == bow and loop.edges[3].start == bow.end
    joint = (0.0, 2.0 * gap)
    assert loop.edges[3].end == (pytest.approx(joint) if closed else back.end)
    assert loop.edges[0].start == (pytest.approx(joint) if closed else a.start)


def test_two_arcs_stay_and_lines_that_meet_are_the_same_lines() -> None:
    pair: list[Edge] = [half(0, 0, 1, 0.0), half(0, 1e-5, 1, math.pi)]
    assert assembled(strokes(pair), "L", True).loop.edges == tuple(pair)
    assert assembled(strokes(SQUARE), "L", True).loop.edges == tuple(SQUARE)
    assert assembled(strokes(SQUARE[:1]), "L", True).loop.edges == tuple(SQUARE[:1])
    for before, after, place in (
        (pair[0], SQUARE[0], pair[0].end),
        (SQUARE[0], pair[0], pair[0].start),
        (SQUARE[1], SQUARE[2], SQUARE[1].end),
    ):
        assert joint_of(before, after) == place


def test_a_gap_that_was_closed_is_told_with_both_names_and_its_place() -> None:
    """Ten times the snap: up to there a gap is closed, and named."""
    for wide, told in ((0.9e-3, []), (5e-3, ["gap-closed"])):  # mm
        edges = [*SQUARE[:3], line((0, 2), (0, wide))]
        found = chain(strokes(edges), SNAP)
        assert [finding.code for finding in found.findings] == told and len(found.loops) == 1
        for finding in found.findings:
            assert finding.message == "a gap of 5 µm between E0 and E3 was closed"
            assert (finding.x_mm, finding.y_mm) == pytest.approx((0.0, 0.0), abs=6e-3) and finding.layer == "L"
    shifted = [line((7, 3), (9, 3)), line((9, 3), (9, 5)), line((9, 5), (7, 5)), line((7, 5), (7, 3.005))]
    (finding,) = chain(strokes(shifted), SNAP).findings
    assert (finding.x_mm, finding.y_mm) == pytest.approx((7.0, 3.0), abs=6e-3)
