"""What is drawn twice, what has no length, which ends belong together, and what is said of each?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from watchsim.drawing.chain_faults import (
    FEW,
    MENDABLE,
    NEAR,
    STRAY,
    chains_of,
    distance,
    gap_finding,
    near_pairs,
    paired,
    related,
    same_edge,
    same_loop,
    shown,
    stray_finding,
    stray_lines,
    twins,
    unbroken_rows,
    unique_loops,
    with_length,
    without_doubles,
)
from watchsim.drawing.findings import Stroke
from watchsim.drawing.nodes import Grid, Nodes, Outline
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point

MM, NM = 1e-3, 1e-9
RNG = np.random.default_rng(2)


def line(a: Point, b: Point) -> Line:
    return Line(MM * a[0], MM * a[1], MM * b[0], MM * b[1])


def strokes(edges: Sequence[Edge], runs: Sequence[int] | None = None) -> list[Stroke]:
    return [Stroke(edge, "L", f"E{k}", run) for k, (edge, run) in enumerate(zip(edges, runs or range(len(edges)), strict=True))]


def ring(*corners: Point, shift: float = 0.0) -> Loop:
    ends = [(x + shift, y) for x, y in corners]
    return Loop(tuple(line(a, b) for a, b in zip(ends, [*ends[1:], ends[0]], strict=True)), "L")


def circle(x: float, y: float, r: float, start: float = 0.3, sweep: float = TURN) -> Loop:
    return Loop((Arc(MM * x, MM * y, MM * r, start, sweep),), "L")


BOX = ((0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0))


def test_pieces_without_length_are_left_out_and_told() -> None:
    drawn = strokes(
        [line((1, 2), (1, 2)), Line(0.0, 0.0, 0.9e-12, 0.0), Line(0.0, 0.0, 1.1e-12, 0.0), Arc(2e-3, 3e-3, 0.0, 0.0, 1.0)]
    )
    kept, findings = with_length(drawn)
    assert (
        kept == drawn[2:3]
        and [f.code for f in findings] == ["zero-length"] * 3
        and {f.severity for f in findings} == {"notice"}
    )
    assert (findings[0].x_mm, findings[0].y_mm, findings[0].layer) == (1.0, 2.0, "L") and "E0" in findings[0].message


@pytest.mark.parametrize(("off", "same"), [(0.0, True), (0.8 * NM, True), (1.2 * NM, False)])
def test_edges_are_the_same_within_a_nanometre(off: float, same: bool) -> None:
    base = line((0, 0), (4, 1))
    for dx, dy in ((off, 0.0), (0.0, -off), (-0.6 * off, 0.8 * off)):
        assert same_edge(base, Line(base.x0 + dx, base.y0 + dy, base.x1 + dx, base.y1 + dy)) is same
        assert same_loop(circle(1, 2, 3), replace(circle(1, 2, 3), edges=(Arc(MM + dx, 2 * MM + dy, 3 * MM, 1.0, -TURN),))) is (
            max(abs(dx), abs(dy)) <= NM
        )
    for longer, alike in ((3.5 * NM, True), (4.5 * NM, False), (-3.5 * NM, True), (-4.5 * NM, False)):
        assert same_edge(Line(0.0, 0.0, MM, 0.0), Line(-0.5 * longer, 0.0, MM + 0.5 * longer, 0.0)) is alike
    for grown, alike in ((0.8 * NM, True), (-0.8 * NM, True), (1.2 * NM, False), (-1.2 * NM, False)):
        assert same_loop(circle(1, 2, 3), circle(1, 2, 3 + grown / MM)) is alike
    flat = Arc(2e-3, 1e3, math.hypot(2e-3, 1e3), -0.5 * math.pi - math.asin(2e-6), 2.0 * math.asin(2e-6))
    assert not same_edge(Line(0.0, 0.0, 4e-3, 0.0), flat)


def test_outlines_drawn_twice_are_kept_once_wherever_they_begin() -> None:
    turned = ring(*BOX[2:], *BOX[:2])
    other_way = Loop(tuple(edge.reversed() for edge in reversed(turned.edges)), "L")
    cut = ring((0, 0), (4, 0), (4, 3), (0, 2.99))
    half = ring((0, 0), (2, 0), (4, 0), (4, 3), (0, 3))
    whole = [ring(*BOX), turned, circle(0, 0, 1), other_way, cut, circle(0, 0, 1, 2.0, -TURN), half, ring(*BOX, shift=1e-3)]
    outlines = [Outline(loop, tuple(f"P{k}" for _ in loop.edges)) for k, loop in enumerate(whole)]
    kept, findings = unique_loops(outlines)
    assert kept == [outlines[k] for k in (0, 2, 4, 6, 7)]
    assert [(f.code, f.severity, f.layer) for f in findings] == [("duplicate", "notice", "L")] * 3
    assert ["P1" in findings[0].message, "P3" in findings[1].message, "P5" in findings[2].message] == [True] * 3
    assert (findings[0].x_mm, findings[0].y_mm) == pytest.approx((2.0, 3.0))


def test_edges_drawn_twice_are_kept_once() -> None:
    bow, flat = (
        Arc(2e-3, 0.0, 2e-3, 0.0, math.pi),
        Arc(2e-3, -1e-3, math.hypot(2e-3, 1e-3), math.atan2(1, 2), math.pi - 2 * math.atan2(1, 2)),
    )
    edges: list[Edge] = [line((0, 0), (4, 0)), line((4, 0), (0, 0)), bow, flat, bow.reversed(), line((4, 0), (4, 1))]
    drawn = strokes(edges)
    drawn[4] = replace(drawn[4], source="E2")
    nodes = Nodes(drawn)
    kept, doubled, findings = without_doubles(drawn, nodes, range(6), NM)
    assert kept == {0, 2, 3, 5} and doubled == {0: 1, 2: 4}
    assert "E1 repeats an edge of E0" in findings[0].message and "E2 repeats an edge of itself" in findings[1].message
    assert sorted(end for members in nodes.members for end in members) == [0, 1, 4, 5, 6, 7, 10, 11]
    for reach, count in ((0.9e-6, 2), (1.1e-6, 1)):
        near = strokes([bow, replace(bow, y=1e-6)])
        assert len(without_doubles(near, Nodes(strokes([bow, bow])), range(2), reach)[0]) == count


def test_what_one_entity_draws_without_lifting_the_pen_is_a_row() -> None:
    edges = [line((0, 0), (1, 0)), line((1, 0), (2, 0)), line((2, 0), (3, 0)), line((3, 1e-7), (4, 0)), line((4, 5e-6), (5, 0))]
    assert unbroken_rows(strokes(edges, [1, 1, 2, 2, 2])) == [0, 0, 1, 1, 2] and unbroken_rows([]) == []


@pytest.mark.parametrize("count", [2, 5, 40, FEW, FEW + 1])
def test_the_nearest_ends_are_paired_first(count: int) -> None:
    points = [(x, y) for x, y in RNG.uniform(0.0, 1.0, (count, 2)).tolist()]
    found = near_pairs(points)
    gaps = [gap for gap, _, _ in found]
    assert gaps == sorted(gaps) and len({(i, j) for _, i, j in found}) == len(found)
    assert all(i < j and gap == pytest.approx(math.dist(points[i], points[j])) for gap, i, j in found)
    array, pairs = np.array(points), {(i, j) for _, i, j in found}
    for k in range(0, count, max(1, count // 20)):
        nearest = np.argsort(np.hypot(*(array - array[k]).T))[1:9].tolist()
        assert {(min(k, n), max(k, n)) for n in nearest} <= pairs
    assert near_pairs(points[:1]) == near_pairs([]) == []


@pytest.mark.parametrize(("gap", "stray"), [(0.9, False), (1.1, True)])
def test_a_line_is_stray_where_it_is_far_from_all_others_beside_its_length(gap: float, stray: bool) -> None:
    for length in (1.0, 7.0):
        off = gap * STRAY * length
        drawn = strokes([line((0, 0), (length, 0)), line((length + off, 0), (length + off, 90)), Arc(1.0, 1.0, MM, 0.0, 1.0)])
        loose = [0, 1, 2, 3, 4, 5]
        near = near_pairs([end for stroke in drawn for end in (stroke.edge.start, stroke.edge.end)])
        found = stray_lines([0, 1, 2], loose, near, drawn)
        assert (0 in found) is stray and 1 not in found and 2 not in found
        assert 0 not in stray_lines([1, 2], loose, near, drawn) and 0 not in stray_lines([0], loose[1:], [], drawn)


def test_ends_of_one_chain_or_of_near_ones_belong_together() -> None:
    for gap, is_so in ((0.9, True), (1.1, False)):
        assert related(gap * STRAY * 2.0, (0, 2.0), (1, 5.0)) is related(gap * STRAY * 2.0, (0, 5.0), (1, 2.0)) is is_so
    assert related(99.0, (3, 1.0), (3, 1.0)) and related(99.0, None, (3, 1.0)) and related(99.0, (3, 1.0), None)
    drawn = strokes([line((0, 0), (3, 4)), line((3, 4), (3, 5)), line((9, 9), (9, 8))])
    assert chains_of([[0, 2], [5]], drawn) == {
        0: (0, pytest.approx(6 * MM)),
        1: (0, pytest.approx(6 * MM)),
        2: (1, pytest.approx(MM)),
    }


def test_each_loose_end_has_one_partner_or_none() -> None:
    owners = {0: (0, 1.0), 1: (1, 1.0), 2: (2, 1.0), 3: (3, 1.0)}
    near = [(0.1, 1, 2), (0.15, 0, 2), (0.2, 3, 4), (0.9, 5, 6)]
    assert paired([0, 1, 2, 3, 4, 5, 6], near, {}, owners) == [(1, 2), (3, 4), (0, -1), (5, -1), (6, -1)]
    assert paired([0, 1, 2, 3, 4, 5, 6], near, {2: None}, owners) == [(1, 2), (0, -1), (3, -1), (6, -1)]
    sizes = {0: (0, 0.1), 1: (1, 9.0), 2: (2, 9.0), 3: (3, 0.1)}
    for far, pairs in ((2.0, [(2, 4), (1, -1), (6, -1)]), (2.5, [(1, -1), (2, -1), (4, -1), (6, -1)])):
        assert paired([1, 2, 4, 6], [(far, 1, 2), (far, 0, 1), (far, 2, 3)], {}, sizes) == pairs
    assert paired([0, 1, 6], [], {}, owners) == [(0, 1), (6, -1)] and paired([8, 10], [], {}, {}) == [(8, -1), (10, -1)]


@pytest.mark.parametrize(
    ("gap", "width", "fix"),
    [
        *(
            (0.02, "20 µm", 'Join them in CAD, or set snap = "20 µm".'),
            (0.0205, "20.5 µm", 'Join them in CAD, or set snap = "21 µm".'),
        ),
        *(
            (0.985 * MENDABLE * 1e3, "98.5 µm", 'Join them in CAD, or set snap = "99 µm".'),
            (0.101, "101 µm", "Join them in CAD."),
        ),
        *((0.999, "999 µm", "Join them in CAD."), (1.25, "1.25 mm", "Join them in CAD.")),
    ],
)
def test_a_gap_is_told_with_both_its_ends(gap: float, width: str, fix: str) -> None:
    drawn = strokes([line((1, 2), (3, 4)), line((3, 4 + gap), (9, 9))])
    found = gap_finding(1, 2, drawn, Nodes(drawn))
    assert f"open: {width} between (3, 4) and ({3}, {4 + gap:g}) mm, the end of E0 and the start of E1" in found.message
    assert (
        found.fix == fix
        and (found.x_mm, found.y_mm) == pytest.approx((3.0, 4.0))
        and found.other_mm == pytest.approx((3.0, 4 + gap))
    )
    alone = gap_finding(0, -1, drawn, Nodes(drawn))
    assert alone.message.startswith("the outline is open at (1, 2) mm, the start of E0") and (
        alone.x_mm,
        alone.y_mm,
    ) == pytest.approx((1.0, 2.0))
    stray = stray_finding(drawn[0])
    assert (stray.x_mm, stray.y_mm, stray.layer, stray.severity) == (pytest.approx(2.0), pytest.approx(3.0), "L", "warning")
    assert shown((-1e-12, 1.2345678e-3)) == "(0, 1.23457)"


@pytest.mark.parametrize(("off", "alike"), [(0.8, True), (-0.8, True), (1.2, False), (-1.2, False)])
def test_outlines_within_a_micrometre_are_twins_and_small_ones_within_a_twentieth(off: float, alike: bool) -> None:
    for size, limit in ((10.0, 1e-3), (0.01, 5e-4)):  # mm
        one, other = circle(3, 4, 0.5 * size), circle(3 + off * limit, 4, 0.5 * size)
        assert bool(twins([one, other])) is bool(twins([other, one])) is alike
        box = [(0, 0), (size, 0), (size, 0.5 * size), (0, 0.5 * size)]
        assert bool(twins([ring(*box), ring(*box, shift=off * limit)])) is alike
    assert twins([circle(0, 0, 1)]) == [] == twins([circle(0, 0, 1), circle(0, 0, 2), circle(0, 5, 1)])
    (found,) = twins([ring(*BOX), circle(9, 9, 1), ring(*BOX, shift=2e-4)])
    assert found.severity == "error" and "within 200 nm" in found.message
    assert (found.x_mm, found.y_mm) == pytest.approx((2.0, 0.0), abs=1e-3)


def test_how_far_one_outline_leaves_another() -> None:
    bent = ring((0, 0), (4, 0), (4, 3), (2, 3.0004), (0, 3))
    for pair in ((ring(*BOX), bent), (bent, ring(*BOX))):
        assert distance(*pair, NEAR) == pytest.approx(4e-7, rel=1e-6, abs=0.0) and distance(*pair, 3e-7) == math.inf


def test_ends_are_snapped_nearest_first_and_only_loose_ones() -> None:
    drawn = strokes(
        [
            line((0, 0), (1, 0)),
            line((1, 2e-3), (2, 0)),
            line((1, -3e-3), (2, 5)),
            line((9, 0), (9, 5e-4)),
            line((1, 1e-3), (1, 9)),
        ]
    )
    nodes = Nodes(drawn)
    joins = nodes.snap(1.5e-6, loose_only=True)
    assert (
        [round(join.gap / MM, 9) for join in joins] == [1e-3]
        and nodes.node[1] == nodes.node[8]
        and nodes.node[6] != nodes.node[7]
    )
    joins = nodes.snap(2.5e-6, loose_only=False)
    assert len(joins) == 1 and nodes.node[2] == nodes.node[8] == nodes.node[1] != nodes.node[4]
    assert not nodes.snap(3.5e-6, loose_only=True) and len(nodes.snap(3.5e-6, loose_only=False)) == 1
    assert (
        nodes.node[4] == nodes.node[1]
        and sorted(nodes.members[nodes.node[1]]) == [1, 2, 4, 8]
        and nodes.joined == {nodes.node[1]}
    )
    assert nodes.of(1) == (nodes.node[2], nodes.node[3])
    nodes.drop(1)
    assert sorted(nodes.members[nodes.node[1]]) == [1, 4, 8]


@pytest.mark.parametrize("short", [2.9, 3.1])
def test_an_edge_keeps_its_two_ends_unless_it_is_long_beside_the_snap(short: float) -> None:
    drawn = strokes([line((0, 0), (1, 0)), line((1, 0), (1, short * 1e-3))])
    other = strokes([line((1, short * 0.5e-3), (3, 3))])
    nodes = Nodes([*drawn, *other])
    nodes.snap(1.6e-6, loose_only=False)
    assert nodes.node[2] != nodes.node[3]


def test_far_cells_hold_nothing_of_what_lies_here() -> None:
    """Cells are four times as wide as the reach: what is further away than a cell and the reach is not looked at."""
    for reach in (1e-9, 1e-3):
        grid = Grid(reach)
        for k in range(200):
            grid.add((0.5 * k * reach, -0.25 * k * reach), k)
        for k in range(0, 200, 7):
            near = grid.around((0.5 * k * reach, -0.25 * k * reach))
            assert k in near and len(near) <= 17 and len(set(near)) == len(near)


@pytest.mark.parametrize("short", [1.5 * NM, 2.5 * NM, 4.0 * NM])
def test_the_shortest_edges_hang_together_with_their_neighbours(short: float) -> None:
    """By both ends, which stay two nodes."""
    row = [Line(0.0, 0.0, MM, 0.0), Line(MM, 0.0, MM, short), Line(MM, short, 2 * MM, MM)]
    nodes = Nodes(strokes(row))
    assert nodes.node[1] == nodes.node[2] != nodes.node[3] == nodes.node[4] and len(nodes.at) == 4
