"""Is every crossing of outlines found with its place, and no touch taken for one?"""

import math
import random
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import dxf_text as d
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.drawing import chaining as nesting
from watchsim.drawing.chain_faults import Meeting, crossings, stretches
from watchsim.drawing.chaining import chain
from watchsim.drawing.circles import circle_of, circle_reports, lies
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding, Stroke
from watchsim.drawing.material import layer_roles
from watchsim.drawing.nodes import Outline
from watchsim.geometry import loops as near_edges
from watchsim.geometry.loops import Loop, table_of
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, moved

Reader = Callable[..., Drawing]
SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]


def of_code(drawing: Drawing, code: str) -> list[Finding]:
    return [finding for finding in drawing.findings if finding.code == code]


def places(findings: list[Finding]) -> list[tuple[float, float]]:
    return sorted((round(f.x_mm or 0.0, 6) + 0.0, round(f.y_mm or 0.0, 6) + 0.0) for f in findings)


def found_places(outlines: list[list[Edge]], closed: bool = True) -> list[tuple[float, float]]:
    named = [Outline(Loop(tuple(edges), "0", closed), ("edge",) * len(edges)) for edges in outlines]
    return places([finding for finding in crossings(named) if finding.code == "crossing"])


def polygon(*corners: tuple[float, float]) -> list[Edge]:
    return [
        Line(1e-3 * a[0], 1e-3 * a[1], 1e-3 * b[0], 1e-3 * b[1])
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    ]


def circle(x: float, y: float, r: float, start: float = 0.3) -> list[Edge]:
    return [Arc(1e-3 * x, 1e-3 * y, 1e-3 * r, start, TURN)]


def test_a_bow_tie_of_lines_is_an_error_that_names_both(read_bytes: Reader) -> None:
    corners = [(0, 0), (4, 4), (4, 0), (0, 4)]
    lines = [d.line(a, b, handle=f"A{k}") for k, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1], strict=True))]
    (finding,) = of_code(read_bytes(d.dxf("".join(lines))), "crossing")
    assert finding.severity == "error" and (finding.x_mm, finding.y_mm) == pytest.approx((2.0, 2.0), abs=1e-12)
    assert "crosses itself at (2, 2) mm" in finding.message and "LINE #A0 and LINE #A2" in finding.message


def test_a_figure_of_eight_through_a_corner_that_is_drawn_twice(read_bytes: Reader) -> None:
    crossing = [(0, 0), (2, 2), (4, 4), (4, 0), (2, 2), (0, 4)]
    touching = [(0, 0), (2, 2), (0, 4), (4, 4), (2, 2), (4, 0)]
    assert places(of_code(read_bytes(d.dxf(d.lwpolyline(crossing, True))), "crossing")) == [(2.0, 2.0)]
    assert not of_code(read_bytes(d.dxf(d.lwpolyline(touching, True))), "crossing")


def test_circles_cross_touch_or_stay_apart() -> None:
    height = math.sqrt(3.0) / 2.0
    assert found_places([circle(0, 0, 1), circle(1, 0, 1)]) == places(
        [Finding("", "", "", "", "0", 0.5, side * height) for side in (-1, 1)]
    )
    for x in (2.0, 0.5, 3.0, 0.0):
        radius = 0.5 if x == 0.5 else 1.0 if x != 0.0 else 0.7
        assert not found_places([circle(0, 0, 1), circle(x, 0, radius)]), x


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.1])
def test_tangent_lines_and_arcs_are_touches_and_cuts_are_not(angle: float) -> None:
    def turned(edges: list[Edge]) -> list[Edge]:
        return [moved(edge, angle, (3e-3, -1e-3)) for edge in edges]

    disc = turned(circle(0, 0, 1))
    assert not found_places([disc, turned(polygon((-2, 1), (2, 1), (0, 3)))]), "a side touches from outside"
    assert not found_places([disc, turned(polygon((-2, 1 + 1e-6), (2, 1 - 1e-6), (0, 3)))]), "to a nanometre"
    assert not found_places([disc, turned(polygon((0, 1), (1, 2), (-1, 2)))]), "a corner touches"
    assert len(found_places([disc, turned(polygon((-2, 0.9999), (2, 0.9999), (0, 3)))])) == 2, "0.1 µm deep"
    assert len(found_places([disc, turned(polygon((0, 0.9), (1, 2), (-1, 2)))])) == 2, "a corner inside"


def test_an_outline_that_passes_through_the_corner_of_another_one() -> None:
    square = polygon(*SQUARE)
    through = polygon((2.0, 2.0), (6.0, 6.0), (6.0, 2.0))
    corner = polygon((4.0, 4.0), (6.0, 4.0), (6.0, 6.0))
    assert (4.0, 4.0) in found_places([square, through])
    assert not found_places([square, corner])


def test_an_arc_that_comes_back_over_its_neighbour() -> None:
    """Both lines that close a three-quarter turn cut the arc a second time."""
    arc = Arc(0.0, 0.0, 1e-3, 0.0, 1.5 * math.pi)
    legs: list[Edge] = [Line(0.0, -1e-3, -2e-3, 0.5e-3), Line(-2e-3, 0.5e-3, 1e-3, 0.0)]
    foot = found_places([[arc, *legs]])
    assert len(foot) == 2 and all(math.hypot(*p) == pytest.approx(1.0, abs=1e-6) for p in foot)


def test_joints_that_do_not_quite_meet_are_no_crossings(read_bytes: Reader) -> None:
    """Ends overshoot each other by a nanometre to five micrometres; arcs stay as drawn."""
    for gap in (1e-6, 4e-4, 5e-3):
        entities = d.arc(0, 0, 1, 0, 180) + d.arc(-gap, -gap, 1, 180, 360 + 1e-3 * gap)
        drawing = read_bytes(d.dxf(entities))
        assert len(drawing.loops) == 1 and not of_code(drawing, "crossing"), gap


def test_lines_and_arcs_that_lie_partly_on_each_other(read_bytes: Reader) -> None:
    sides = d.line((0, 0), (3, 0), handle="A") + d.line((2, 0), (4, 0), handle="B")
    drawing = read_bytes(d.dxf(sides + d.arc(9, 0, 1, 0, 120, (5, "C")) + d.arc(9, 0, 1, 90, 200, (5, "D"))))
    lines, arcs = of_code(drawing, "overlap")
    assert lines.severity == "warning" and (lines.x_mm, lines.y_mm) == pytest.approx((2.5, 0.0), abs=1e-9)
    assert "LINE #A and LINE #B" in lines.message and "(2, 0)" in lines.message and "(3, 0)" in lines.message
    assert "ARC #C and ARC #D" in arcs.message
    assert math.atan2(arcs.y_mm or 0.0, (arcs.x_mm or 0.0) - 9.0) == pytest.approx(math.radians(105), abs=1e-9)


@pytest.mark.parametrize("start", [0.0, 100.0, 200.0, 359.0])
def test_an_arc_on_a_circle_lies_on_it_wherever_that_begins(start: float) -> None:
    """From 90° to 200°, the circle from anywhere; beside it an arc that meets it nowhere."""
    arc = Arc(1e-3, 2e-3, 5e-3, math.radians(90.0), math.radians(110.0))
    whole = Arc(1e-3, 2e-3, 5e-3, math.radians(start), math.tau)
    layer: Any = SimpleNamespace(edges=[whole, arc])
    ((p, q),) = stretches(layer, Meeting(0, 1, [arc.end, arc.start]))
    assert {p, q} == {arc.start, arc.end}
    assert stretches(layer, Meeting(0, 1, [arc.end])) == []


def test_a_spike_shorter_on_the_way_back(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.lwpolyline([(0, 0), (4, 0), (4, 2), (6, 2), (5, 2), (5, 4), (0, 4)], True)))
    (overlap,) = of_code(drawing, "overlap")
    assert (overlap.x_mm, overlap.y_mm) == pytest.approx((5.5, 2.0), abs=1e-9)


def test_centre_lines_may_cross_what_they_like(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + d.line((-2, 0), (2, 0)) + d.line((0, -2), (0, 2))))
    assert {finding.code for finding in drawing.findings} == {"stray-line"}


def test_an_end_on_the_middle_of_another_edge_is_no_crossing(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.line((0, 0), (10, 0)) + d.line((5, 0), (5, 3)) + d.line((5, 3), (0, 0))))
    assert [finding.code for finding in drawing.findings] == ["open-outline"]


def test_an_open_chain_that_crosses_itself_is_a_warning(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.lwpolyline([(0, 0), (4, 0), (4, 2), (2, 2), (2, -2)], False)))
    (finding,) = of_code(drawing, "crossing")
    assert finding.severity == "warning" and places([finding]) == [(2.0, 0.0)]


def test_outlines_on_different_layers_may_cross(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1, layer="A") + d.circle(1, 0, 1, layer="B")))
    assert not drawing.findings


@pytest.mark.parametrize("seed", range(6))
def test_random_polygons_cross_where_every_pair_of_sides_says(seed: int) -> None:
    """Against all pairs, with rational arithmetic."""
    from fractions import Fraction

    rng = random.Random(seed)
    corners = [(rng.randrange(1000), rng.randrange(1000)) for _ in range(60)]
    expected = []
    sides = list(zip(corners, corners[1:] + corners[:1], strict=True))
    for i, (a, b) in enumerate(sides):
        for c, e in sides[i + 2 : len(sides) - (i == 0)]:
            ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], e[0] - c[0], e[1] - c[1]
            cross = ux * vy - uy * vx
            if cross:
                s = Fraction((c[0] - a[0]) * vy - (c[1] - a[1]) * vx, cross)
                t = Fraction((c[0] - a[0]) * uy - (c[1] - a[1]) * ux, cross)
                if 0 < s < 1 and 0 < t < 1:
                    expected.append((round(float(a[0] + s * ux), 6), round(float(a[1] + s * uy), 6)))
    assert len(expected) > 100
    found = found_places([polygon(*[(float(x), float(y)) for x, y in corners])])
    assert len(found) == len(expected)
    for p, q in zip(found, sorted(expected), strict=True):
        assert p == pytest.approx(q, abs=2e-6)


@pytest.mark.slow
def test_many_edges_through_one_point_are_said_where_not_all_are_looked_at() -> None:
    petals = []
    for k in range(400):
        angle = TURN * k / 400
        petals.append([moved(edge, angle, (0.0, 0.0)) for edge in polygon((0, 0), (1, -0.004), (1, 0.004))])
    named = [Outline(Loop(tuple(edges)), ("edge",) * 3) for edges in petals]
    codes = {finding.code for finding in crossings(named)}
    assert codes <= {"crowded"}, "they touch at the centre only"


MEGABYTE = 1 << 20


def heap(count: int, spacing: float) -> list[Stroke]:
    """Circles of a millimetre, `spacing` metres apart in one row."""
    return [Stroke(Arc(spacing * k, 0.0, 1e-3, 0.0, TURN), "0", "CIRCLE", k) for k in range(count)]


@pytest.mark.slow
def test_a_heap_of_circles_takes_no_more_memory_than_its_limits_allow(monkeypatch: pytest.MonkeyPatch) -> None:
    """All 3000 of them cross all others: 4.5 million pairs, each with two points."""
    monkeypatch.setattr(near_edges, "MOST_PAIRS", 50_000)
    monkeypatch.setattr(nesting, "MOST", 200_000)
    monkeypatch.setattr(nesting, "AT_ONCE", 30_000)
    strokes = heap(3000, 1e-7)
    chain(strokes[:1000], 1e-6)  # imports what it needs
    tracemalloc.start()
    chains = chain(strokes, 1e-6)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 150 * MEGABYTE
    assert len(chains.loops) == 3000
    found = {(finding.code, finding.severity) for finding in chains.findings}
    assert {("crossing", "error"), ("crowded", "error"), ("crowded", "warning")} <= found


def test_the_crowd_that_took_all_the_room_is_named_and_no_other_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """40 circles over each other and, far away, 60."""
    monkeypatch.setattr(near_edges, "MOST_PAIRS", 1000)
    most = [Arc(0.1 + 1e-7 * k, 0.1, 1e-3, 0.0, TURN) for k in range(60)]
    table = table_of([stroke.edge for stroke in heap(40, 1e-7)] + most)
    crowds = near_edges.near_pairs(table, 1e-6).crowds
    assert crowds
    assert all(abs(x - 0.1) < 5e-3 and abs(y - 0.1) < 5e-3 for x, y in crowds), crowds


def test_rings_in_rings_are_told_apart_in_parts(read_bytes: Callable[..., Drawing], monkeypatch: pytest.MonkeyPatch) -> None:
    """400 rings round one centre, more pairs than are looked at in one go."""
    monkeypatch.setattr(nesting, "AT_ONCE", 5000)
    drawing = read_bytes(d.dxf("".join(d.circle(0, 0, 1 + 0.01 * k) for k in range(400))))
    assert all(finding.severity != "error" for finding in drawing.findings)
    assert [loop.hole for loop in drawing.loops] == [k % 2 == 0 for k in range(400)]


MM = 1e-3


def disc(x: float, y: float, r: float, hole: bool = False) -> Loop:
    return Loop((Arc(MM * x, MM * y, MM * r, 0.3, -TURN if hole else TURN),), hole=hole)


def box(x0: float, y0: float, x1: float, y1: float) -> Loop:
    corners = [(MM * x0, MM * y0), (MM * x1, MM * y0), (MM * x1, MM * y1), (MM * x0, MM * y1)]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)))


RING = (disc(0, 0, 5), disc(0, 0, 2, hole=True))
TARGET = (*RING, disc(0, 0, 1))  # with an island in its hole


def test_a_bore_in_material_is_taken() -> None:
    for bore in (disc(3.5, 0, 0.5), disc(3.5, 0, 0.5, hole=True), disc(0, 0, 0.5)):
        (lie,) = lies([bore], TARGET)
        assert lie.taken and lie.depth == 1


@pytest.mark.parametrize(("bore", "holes"), [(disc(9, 0, 1), 0), (disc(1.5, 0, 0.3), 1), (disc(5, 5, 1), 0)])
def test_a_bore_where_nothing_is_is_clear_but_not_taken(bore: Loop, holes: int) -> None:
    (lie,) = lies([bore], TARGET)
    assert lie.clear and not lie.taken and (lie.depth, lie.holes) == (0, holes)


@pytest.mark.parametrize("shift", [0.0, 5e-6, -5e-6], ids=lambda shift: f"{shift:g} mm")
@pytest.mark.parametrize("wider", [0.0, 5e-7, -5e-7, 2e-6, -2e-6], ids=lambda wider: f"by {wider:g} mm")
def test_a_bore_in_the_place_of_a_hole_lies_in_it_whatever_rounding_did(shift: float, wider: float) -> None:
    for hole in (False, True):
        (lie,) = lies([disc(shift, 0, 2 + wider, hole)], RING)
        assert lie.clear and (lie.outlines, lie.holes) == (1, 1)


@pytest.mark.parametrize(("inside", "taken"), [(-2e-5, False), (0.0, False), (0.5e-5, False), (1.5e-5, True), (0.01, True)])
def test_a_bore_as_large_as_the_outline_around_it_leaves_nothing(inside: float, taken: bool) -> None:
    """Ten nanometres of material are rounding; a hundredth of a millimetre is a ring."""
    (lie,) = lies([disc(0, 0, 5 - inside)], [disc(0, 0, 5)])
    assert lie.taken is taken and (lie.around is None) is taken and lie.crosses is None


def test_what_crosses_among_the_outlines_or_within_a_bore_is_no_matter_of_bores() -> None:
    (lie,) = lies([disc(-2, 0, 1)], [disc(0, 0, 5), disc(8, 0, 5)])
    assert lie.taken
    corners = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 1.5)]
    tie = Loop(
        tuple(Line(MM * a, MM * b, MM * c, MM * d) for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1], strict=True))
    )
    (lie,) = lies([tie], [disc(0, 0, 5)])
    assert lie.clear


def test_touching_is_no_crossing() -> None:
    plate = [box(0, 0, 4, 2)]
    slot, notch, round_one, beside = box(1, 0, 2, 1), box(3, 0, 4, 2), disc(2.5, 1.5, 0.5), disc(-0.5, 1, 0.5)
    found = lies([slot, notch, round_one, beside], plate)
    assert [lie.taken for lie in found] == [True, True, True, False]
    assert all(lie.clear for lie in found)


def test_a_crossing_is_told_with_its_place() -> None:
    (lie,) = lies([disc(5, 0, 3)], [disc(0, 0, 5)])
    assert lie.crosses is not None and not lie.clear
    x = 5.0 - 0.9  # two circles of 5 and 3 mm, centres 5 mm apart
    assert lie.crosses[0] == pytest.approx(MM * x, rel=1e-12)
    assert abs(lie.crosses[1]) == pytest.approx(MM * math.sqrt(25.0 - x * x), rel=1e-12, abs=0.0)


def test_a_bore_round_a_hole_or_an_island_is_not_clear() -> None:
    (round_hole,), (round_island,), (round_all,) = (lies([disc(0, 0, r)], TARGET) for r in (3.0, 1.5, 7.0))
    assert round_hole.around in TARGET[1:] and round_island.around == TARGET[2] and round_all.around in TARGET
    assert not (round_hole.clear or round_island.clear or round_all.clear)
    (instead,) = lies([disc(0, 0, 5)], [disc(0, 0, 5)])
    assert instead.around is not None


def test_bores_in_bores_and_across_bores() -> None:
    found = lies([disc(0, 0, 1), disc(0.2, 0, 0.5), disc(0, 0, 1), disc(3, 0, 0.5), disc(3.6, 0, 0.5)], [disc(0, 0, 9)])
    assert [lie.taken for lie in found] == [True, False, False, True, False]
    assert [lie.within for lie in (found[0], found[2], found[3])] == [None, 0, None] and found[1].within in (0, 2)
    assert found[4].meets is not None and found[4].meets[0] == 3
    assert found[4].meets[1][0] == pytest.approx(3.3 * MM, rel=1e-12)


def test_two_outlines_above_each_other_are_counted() -> None:
    (lie,) = lies([disc(0, 0, 1)], [disc(0, 0, 5), disc(1, 0, 5)])
    assert lie.depth == 2 and not lie.taken


def test_no_bores_need_no_plate() -> None:
    assert lies([], RING) == []
    assert lies([disc(0, 0, 1)], [])[0].depth == 0


@given(st.floats(-7, 7), st.floats(-7, 7), st.floats(0.05, 6))
def test_circles_in_a_ring_are_sorted_by_their_distances(x: float, y: float, r: float) -> None:
    """Against the plain inequalities of circles, for bores that do not just touch."""
    far = math.hypot(x, y)
    gaps = [abs(far - abs(R - r)) for R in (2.0, 5.0)] + [abs(far - (R + r)) for R in (2.0, 5.0)]
    if min(gaps) < 1e-3:
        return
    (lie,) = lies([disc(x, y, r)], RING)
    crosses = any(abs(R - r) < far < R + r for R in (2.0, 5.0))
    inside, in_hole, round_hole = far + r < 5.0, far + r < 2.0, far + 2.0 < r
    assert (lie.crosses is not None) == crosses
    if not crosses:
        assert lie.taken == (inside and not in_hole and not round_hole)
        assert (lie.around is not None) == (round_hole or far + 5.0 < r)


def test_a_layer_called_a_pivot_is_a_mark_only_while_it_holds_circles_alone() -> None:
    """An arbor drawn with a square is a part; bores are bores whatever their outline; alone, marks are the parts."""
    part, mark, square = (
        replace(one, layer=name)
        for one, name in ((box(0, 0, 9, 9), "PART"), (disc(1, 1, 1), "PIVOT"), (box(3, 3, 4, 4), "PIVOT"))
    )
    half = Loop((Arc(0.0, 0.0, MM, 0.0, math.pi), Line(-MM, 0.0, MM, 0.0)), "PIVOT")
    bore = replace(box(5, 5, 6, 6), layer="BORES")
    assert layer_roles([part, mark, bore]) == {"PART": "material", "PIVOT": "mark", "BORES": "bore"}
    for other in ([square], [mark, square], [square, mark], [half]):
        assert layer_roles([part, *other]) == {"PART": "material", "PIVOT": "material"}
    assert layer_roles([mark]) == {"PIVOT": "material"}


RIGHT = Arc(1e-3, 2e-3, 5e-3, -math.pi / 2, math.pi)
LEFT = Arc(1e-3, 2e-3, 5e-3, math.pi / 2, math.pi)
THIRDS = tuple(Arc(1e-3, 2e-3, 5e-3, 1.0 - k * TURN / 3.0, -TURN / 3.0) for k in range(3))


@pytest.mark.parametrize("edges", [(RIGHT, LEFT), THIRDS, (Arc(1e-3, 2e-3, 5e-3, 0.7, TURN),)], ids=len)
def test_arcs_of_one_circle_are_that_circle(edges: tuple[Arc, ...]) -> None:
    found = circle_of(Loop(edges))
    assert found is not None and found.centre == (1e-3, 2e-3) and found.radius == 5e-3
    assert circle_of(replace(Loop(edges), closed=False)) is None
    rounded = (replace(edges[0], radius=5e-3 + 0.9e-9, x=1e-3 - 0.9e-9), *edges[1:])
    assert circle_of(Loop(rounded)) is not None


@pytest.mark.parametrize(
    "edges",
    [
        (RIGHT, replace(LEFT, radius=5e-3 + 2e-9)),
        (RIGHT, replace(LEFT, radius=5e-3 - 2e-9)),
        (RIGHT, replace(LEFT, x=1e-3 + 2e-9)),
        (RIGHT, replace(LEFT, y=2e-3 - 2e-9)),
        (RIGHT, Line(*RIGHT.end, *RIGHT.start)),
        (Line(*RIGHT.end, *RIGHT.start), RIGHT),
        (RIGHT,),
    ],
)
def test_anything_else_is_none(edges: tuple[Arc | Line, ...]) -> None:
    assert circle_of(Loop(edges)) is None


def test_what_is_said_of_circles_is_where_they_are() -> None:
    """In millimetres; a hole is said to be one, and other outlines are not told of."""
    square = tuple(Line(*a, *b) for a, b in pairwise([(0.0, 0.0), (1e-3, 0.0), (1e-3, 1e-3), (0.0, 0.0)]))
    loops = [Loop(THIRDS, layer="rim"), Loop(square), Loop((RIGHT, LEFT), layer="bore", hole=True)]
    where = {"x_mm": 1.0, "y_mm": 2.0, "radius_mm": 5.0}
    assert circle_reports(loops) == [
        {"layer": name, **where, "hole": hole, "sides": 0, "deviation_um": 0.0}
        for name, hole in (("rim", False), ("bore", True))
    ]
