"""Do edges find each other, and is everything that is wrong with an outline named?"""

import math
import random
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace

import dxf_text as d
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.drawing.chain_faults import (
    FEW,
    MENDABLE,
    NEAR,
    STRAY,
    chains_of,
    distance,
    gap_finding,
    near_ends,
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
from watchsim.drawing.chain_faults import MOST_TWINS as MOST
from watchsim.drawing.chaining import chain
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding, Stroke
from watchsim.drawing.nodes import Grid, Nodes, Outline
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.geometry.solids import area

Reader = Callable[..., Drawing]
SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]


def by_code(drawing: Drawing) -> dict[str, list[Finding]]:
    found: dict[str, list[Finding]] = {}
    for one in drawing.findings:
        found.setdefault(one.code, []).append(one)
    return found


def square_with_gap(gap_mm: float) -> bytes:
    first = d.line(SQUARE[0], SQUARE[1], handle="4F")
    middle = d.line(SQUARE[1], SQUARE[2]) + d.line(SQUARE[2], SQUARE[3])
    return d.dxf(first + middle + d.line(SQUARE[3], (0.0, gap_mm), handle="51"))


@pytest.mark.parametrize("gap_um", [0.0, 0.0005, 0.9])
def test_gaps_up_to_a_micrometre_close_silently(read_bytes: Reader, gap_um: float) -> None:
    drawing = read_bytes(square_with_gap(gap_um * 1e-3))
    (loop,) = drawing.loops
    assert not drawing.findings
    for one, other in zip(loop.edges, [*loop.edges[1:], loop.edges[0]], strict=True):
        assert one.end == other.start
    assert area(loop) == pytest.approx(16e-6, rel=6e-5, abs=0)


def test_gaps_up_to_ten_micrometres_close_with_a_notice(read_bytes: Reader) -> None:
    drawing = read_bytes(square_with_gap(7e-3))
    assert len(drawing.loops) == 1
    (finding,) = drawing.findings
    assert (finding.code, finding.severity) == ("gap-closed", "notice")
    assert "7 µm" in finding.message and "LINE #4F" in finding.message and "LINE #51" in finding.message


def test_wider_gaps_are_errors_with_both_ends(read_bytes: Reader) -> None:
    drawing = read_bytes(square_with_gap(23e-3))
    assert not drawing.loops and len(drawing.open_chains) == 1
    (finding,) = drawing.findings
    assert (finding.code, finding.severity, finding.layer) == ("open-outline", "error", "0")
    assert "23 µm between (0, 0) and (0, 0.023) mm" in finding.message
    assert "the start of LINE #4F and the end of LINE #51" in finding.message
    assert 'snap = "23 µm"' in finding.fix
    assert (finding.x_mm, finding.y_mm) == pytest.approx((0.0, 0.0), abs=1e-9)
    closed = read_bytes(square_with_gap(23e-3), snap=23e-6)
    assert len(closed.loops) == 1 and not closed.findings


def test_two_gaps_are_two_findings(read_bytes: Reader) -> None:
    upper = d.line((4.0, 2.03), (4, 4)) + d.line((4, 4), (0, 4)) + d.line((0, 4), (0, 2.05))
    lower = d.line((0, 2), (0, 0)) + d.line((0, 0), (4, 0)) + d.line((4, 0), (4, 2))
    gaps = by_code(read_bytes(d.dxf(upper + lower)))["open-outline"]
    assert len(gaps) == 2
    assert sorted(message.split("open: ")[1][:5] for message in (gap.message for gap in gaps)) == ["30 µm", "50 µm"]


def test_edges_shorter_than_the_snap_survive(read_bytes: Reader) -> None:
    """A chamfer of 0.4 µm, well below the snap of 1 µm, is real: its ends meet its neighbours exactly."""
    c = 4e-4
    corners = [(c, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (0.0, c)]
    (loop,) = read_bytes(d.dxf(d.polygon(corners))).loops
    assert len(loop.edges) == 5
    assert min(edge.length for edge in loop.edges) == pytest.approx(c * math.sqrt(2) * 1e-3, rel=1e-9)


def test_lines_are_stretched_to_arcs_and_arcs_stay(read_bytes: Reader) -> None:
    entities = d.arc(4, 1, 1, 270, 90) + d.line((0, 0), (4.0, 3e-4)) + d.line((4.0002, 2), (0, 2)) + d.line((0, 2), (0, 0))
    (loop,) = read_bytes(d.dxf(entities)).loops
    (bend,) = [edge for edge in loop.edges if isinstance(edge, Arc)]
    assert (bend.x, bend.y, bend.radius) == (4e-3, 1e-3, 1e-3)
    for one, other in zip(loop.edges, [*loop.edges[1:], loop.edges[0]], strict=True):
        assert one.end == other.start


def test_holes_and_islands(read_bytes: Reader) -> None:
    shapes = d.circle(0, 0, 5) + d.circle(0, 0, 4) + d.circle(1, 0, 2) + d.circle(0, 0, 3, layer="OTHER") + d.circle(20, 0, 1)
    drawing = read_bytes(d.dxf(shapes))
    holes = {round(loop.edges[0].radius * 1e3): loop.hole for loop in drawing.loops}  # type: ignore[union-attr]
    assert holes == {5: False, 4: True, 2: False, 3: False, 1: False}
    assert all((area(loop) < 0) == loop.hole for loop in drawing.loops)


def test_hole_that_touches_no_box_corner(read_bytes: Reader) -> None:
    """A small square in the notch of an L lies in its box but not in it."""
    ell = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)]
    drawing = read_bytes(d.dxf(d.polygon(ell) + d.polygon([(2, 2), (3, 2), (3, 3), (2, 3)])))
    assert [loop.hole for loop in drawing.loops] == [False, False]


def test_duplicates_forward_and_reversed(read_bytes: Reader) -> None:
    entities = d.polygon(SQUARE) + d.line(SQUARE[1], SQUARE[0]) + d.line(SQUARE[1], SQUARE[2])
    drawing = read_bytes(d.dxf(entities))
    assert len(drawing.loops) == 1 and not drawing.open_chains
    assert [finding.code for finding in drawing.findings] == ["duplicate", "duplicate"]


def test_an_edge_drawn_twice_half_a_micrometre_apart_is_one_edge(read_bytes: Reader) -> None:
    lens = d.arc(9, 0, 1, 0, 120) + d.arc(9, 0, 1, 120, 360)
    again = d.line((4.0, 5e-4), (0.0, -3e-4)) + d.arc(9, 4e-4, 1, 0, 120)
    drawing = read_bytes(d.dxf(d.polygon(SQUARE) + lens + again))
    assert sorted(area(loop) for loop in drawing.loops) == pytest.approx([math.pi * 1e-6, 16e-6], rel=1e-6)
    assert not drawing.open_chains
    assert [finding.code for finding in drawing.findings] == ["duplicate", "duplicate"]


def test_two_lines_a_few_micrometres_apart_are_no_outline(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.line((0, 0), (5, 0)) + d.line((5, 7e-3), (0, 7e-3))))
    assert not drawing.loops and len(drawing.open_chains) == 1
    assert {finding.code for finding in drawing.findings} == {"duplicate", "gap-closed", "stray-line"}


def test_a_thin_lens_is_an_outline(read_bytes: Reader) -> None:
    """Its two arcs join the same ends, five micrometres from each other."""
    rise = 2.5e-3
    drawing = read_bytes(d.dxf(d.lwpolyline([(0, 0, 2 * rise / 4), (4, 0, 2 * rise / 4)], True)))
    assert len(drawing.loops) == 1 and not drawing.findings


def test_whole_outlines_drawn_twice(read_bytes: Reader) -> None:
    entities = d.polygon(SQUARE) + d.lwpolyline(SQUARE[2:] + SQUARE[:2], True) + d.circle(9, 0, 1) + d.arc(9, 0, 1, 90, 450)
    drawing = read_bytes(d.dxf(entities))
    assert len(drawing.loops) == 2
    assert [finding.code for finding in drawing.findings] == ["duplicate", "duplicate"]


def test_rounded_and_square_outline_of_the_same_box_are_two(read_bytes: Reader) -> None:
    """A square and a lens may share box, number of edges and middles of edges."""
    h = 1.0 - math.cos(math.pi / 6)
    bulge = math.tan(math.pi / 12)
    lens = d.lwpolyline([(-1, -1 + h), (1, -1 + h), (1, 1 - h, bulge), (-1, 1 - h)], True)
    square = d.lwpolyline([(-1, -1 + h), (1, -1 + h), (1, 1), (-1, 1)], True)
    assert len(read_bytes(d.dxf(lens + square)).loops) == 2


def test_zero_length_is_left_out_with_a_notice(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.polygon([*SQUARE, SQUARE[3]]) + d.circle(1, 1, 0.0)))
    assert len(drawing.loops) == 1 and len(drawing.loops[0].edges) == 4
    assert [(finding.code, finding.severity) for finding in drawing.findings] == [("zero-length", "notice")] * 2


def test_slit_in_a_polyline(read_bytes: Reader) -> None:
    corners = [(0, 0), (4, 0), (4, 2), (6, 2), (4, 2), (4, 4), (0, 4)]
    drawing = read_bytes(d.dxf(d.lwpolyline(corners, True)))
    (loop,) = drawing.loops
    assert area(loop) == pytest.approx(16e-6, rel=1e-12, abs=0)
    assert {finding.code for finding in drawing.findings} == {"duplicate", "slit"}
    assert not drawing.open_chains


def test_an_outline_bridged_to_its_hole_is_two_loops(read_bytes: Reader) -> None:
    """A keyhole: programs without holes draw them in one go with the outline."""
    corners = [(0, 0), (10, 0), (10, 10), (0, 10), (0, 5), (3, 5), (3, 7), (6, 7), (6, 3), (3, 3), (3, 5), (0, 5)]
    drawing = read_bytes(d.dxf(d.lwpolyline(corners, True)))
    assert sorted((loop.hole, round(area(loop) * 1e6, 9)) for loop in drawing.loops) == [(False, 100.0), (True, -12.0)]
    assert not drawing.open_chains and {finding.code for finding in drawing.findings} == {"duplicate", "slit"}


def test_rectangles_side_by_side_with_their_border_drawn_twice_are_not_joined(read_bytes: Reader) -> None:
    right = [(4.0, 0.0), (7.0, 0.0), (7.0, 4.0), (4.0, 4.0)]
    found = by_code(read_bytes(d.dxf(d.polygon(SQUARE) + d.polygon(right))))
    assert len(found["branch"]) == 2 and "slit" not in found


def test_doubled_open_line_keeps_one(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(2 * (d.line((0, 0), (1, 0)) + d.line((1, 0), (1, 1)))))
    assert len(drawing.open_chains) == 1 and len(drawing.open_chains[0].edges) == 2


def test_branch_is_named_with_its_place(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.polygon(SQUARE) + d.line((4, 4), (6, 5), handle="77")))
    found = by_code(drawing)
    (branch,) = found["branch"]
    assert branch.severity == "error" and "(4, 4) mm" in branch.message and "LINE #77" in branch.message
    assert (branch.x_mm, branch.y_mm) == pytest.approx((4, 4))
    assert len(drawing.loops) == 1, "the square itself comes back to the branch: it is a loop"


def test_closed_polylines_that_touch_or_share_an_edge_stay_two(read_bytes: Reader) -> None:
    right = [(4.0, 0.0), (7.0, 0.0), (7.0, 4.0), (4.0, 4.0)]
    corner = [(4.0, 4.0), (5.0, 4.0), (5.0, 5.0)]
    drawing = read_bytes(d.dxf(d.lwpolyline(SQUARE, True) + d.lwpolyline(right, True) + d.lwpolyline(corner, True)))
    assert sorted(round(area(loop) * 1e6, 9) for loop in drawing.loops) == [0.5, 12.0, 16.0]
    assert [(finding.code, finding.severity) for finding in drawing.findings] == [("overlap", "notice")] * 2


def test_crossing_polylines_go_straight_on(read_bytes: Reader) -> None:
    """Two open polylines with a common corner: each continues along itself."""
    drawing = read_bytes(d.dxf(d.lwpolyline([(0, 0), (1, 1), (2, 0)], False) + d.lwpolyline([(0, 2), (1, 1), (2, 2)], False)))
    assert [len(path.edges) for path in drawing.open_chains] == [2, 2]
    assert "branch" not in by_code(drawing)


def test_stray_line_is_a_warning_only(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.polygon(SQUARE) + d.line((10, 0), (20, 0))))
    assert [(finding.code, finding.severity) for finding in drawing.findings] == [("stray-line", "warning")]
    assert len(drawing.open_chains) == 1


def test_a_single_line_on_a_layer_of_axes_is_meant(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.polygon(SQUARE) + d.line((2, 2), (2, 9), layer="STAFF_AXIS")))
    assert not drawing.findings and len(drawing.open_chains) == 1


def test_layers_do_not_mix(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.polygon(SQUARE, "A") + d.polygon(SQUARE, "B")))
    assert sorted(loop.layer for loop in drawing.loops) == ["A", "B"]
    assert not drawing.findings


def test_facets_are_reported_with_radius_and_rise(read_bytes: Reader) -> None:
    rim = [(2 * math.cos(TURN * k / 32), 2 * math.sin(TURN * k / 32)) for k in range(32)]
    drawing = read_bytes(d.dxf(d.lwpolyline(rim, True)))
    (finding,) = drawing.findings
    assert (finding.code, finding.severity) == ("facets", "warning")
    assert "32 straight pieces" in finding.message and "radius 2 mm" in finding.message
    assert f"{2e3 * (1 - math.cos(math.pi / 32)):.3g} µm" in finding.message


def test_teeth_and_hexagons_are_no_facets(read_bytes: Reader) -> None:
    teeth = [((2 + k % 2) * math.cos(TURN * k / 30), (2 + k % 2) * math.sin(TURN * k / 30)) for k in range(30)]
    nut = [(9 + math.cos(TURN * k / 6), math.sin(TURN * k / 6)) for k in range(6)]
    assert not read_bytes(d.dxf(d.lwpolyline(teeth, True) + d.lwpolyline(nut, True))).findings


@st.composite
def outlines(draw: st.DrawFn) -> list[Edge]:
    """A star-shaped outline of lines and arcs, millimetre size."""
    n = draw(st.integers(3, 12))
    corners: list[Point] = []
    for k in range(n):
        r = draw(st.floats(1e-3, 3e-3))
        corners.append((r * math.cos(TURN * k / n), r * math.sin(TURN * k / n)))
    edges: list[Edge] = []
    for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
        sweep = draw(st.sampled_from((0.0, 0.3, -0.2, 1.0)))
        if sweep:
            lift = 0.5 / math.tan(0.5 * sweep)
            x, y = 0.5 * (a[0] + b[0]) - lift * (b[1] - a[1]), 0.5 * (a[1] + b[1]) + lift * (b[0] - a[0])
            edges.append(Arc(x, y, math.hypot(a[0] - x, a[1] - y), math.atan2(a[1] - y, a[0] - x), sweep))
        else:
            edges.append(Line(*a, *b))
    return edges


@given(outlines(), st.randoms(use_true_random=False), st.floats(-4, 4))
def test_any_order_and_direction_gives_the_same_loop(edges: list[Edge], rng: random.Random, angle: float) -> None:
    shuffled = [edge if rng.random() < 0.5 else edge.reversed() for edge in Loop(tuple(edges)).moved(angle, (2e-3, 1e-3)).edges]
    rng.shuffle(shuffled)
    chains = chain([Stroke(edge, "0", f"edge {k}", k) for k, edge in enumerate(shuffled)], 1e-6)
    (loop,) = chains.loops
    assert not chains.findings and not chains.open_chains
    assert len(loop.edges) == len(edges)
    assert area(loop) == pytest.approx(abs(area(Loop(tuple(edges)))), rel=1e-11, abs=0)
    assert area(loop) > 0.0


def ring(count: int) -> list[Stroke]:
    corners = [((10 + k % 2) * math.cos(TURN * k / count), (10 + k % 2) * math.sin(TURN * k / count)) for k in range(count)]
    lines = [Line(*a, *b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    random.Random(1).shuffle(lines)
    return [Stroke(edge, "0", "LINE", k) for k, edge in enumerate(lines)]


def star(count: int) -> list[Stroke]:
    angle = TURN / count
    return [Stroke(Line(0, 0, math.cos(angle * k), math.sin(angle * k)), "0", "LINE", k) for k in range(count)]


def calls(work: Callable[[], object]) -> int:
    """How many functions are called: the same on every machine, however busy."""
    count = 0

    def counted(_frame: object, event: str, _argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(counted)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.slow
@pytest.mark.parametrize("make", [ring, star])
def test_work_grows_with_the_number_of_edges(make: Callable[[int], list[Stroke]]) -> None:
    few, many = make(500), make(4000)
    chain(many, 1e-6)  # imports what it needs
    assert calls(lambda: chain(many, 1e-6)) < 8 * 1.2 * calls(lambda: chain(few, 1e-6))


def polygon(corners: np.ndarray) -> Loop:
    ends = np.roll(corners, -1, axis=0)
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners.tolist(), ends.tolist(), strict=True)))


def round_polygon(count: int) -> np.ndarray:
    angles = np.arange(count) * 2.0 * math.pi / count
    return np.column_stack((np.cos(angles), np.sin(angles)))


@pytest.mark.parametrize("corner", range(5))
def test_the_corner_that_was_moved_is_found_wherever_it_is(corner: int) -> None:
    """A corner moved outwards: it is the farthest point, and nearest is the corner where it was."""
    plain = round_polygon(5)
    moved = plain.copy()
    moved[corner] *= 1.001
    for pair in ((plain, moved), (moved, plain)):
        assert distance(*map(polygon, pair), 1.0) == pytest.approx(1e-3, rel=1e-9)
        assert distance(*map(polygon, pair), 0.9e-3) == math.inf


@pytest.mark.parametrize("count", [MOST, 5 * MOST])
def test_of_many_edges_those_of_a_shifted_outline_are_found(count: int) -> None:
    """Half of it lies elsewhere: some of the edges looked at are among these."""
    plain = round_polygon(count)
    moved = plain + np.where(plain[:, :1] < 0.0, 0.01, 0.0) * plain
    assert distance(polygon(plain), polygon(moved), 1.0) == pytest.approx(0.01, rel=0.02)


def test_the_finding_stands_on_the_outline() -> None:
    """In the middle of its first edge, in millimetres."""
    loop = polygon(np.array([[2e-3, 5e-3], [4e-3, 5e-3], [4e-3, 9e-3]]))
    (found,) = twins([loop, loop.moved(0.0, (3e-9, 0.0))])
    assert (found.x_mm, found.y_mm) == pytest.approx((3.0, 5.0)) and "within 3 nm" in found.message


MM, NM = 1e-3, 1e-9
RNG = np.random.default_rng(2)


def line(a: Point, b: Point) -> Line:
    return Line(MM * a[0], MM * a[1], MM * b[0], MM * b[1])


def strokes(edges: Sequence[Edge], runs: Sequence[int] | None = None) -> list[Stroke]:
    return [Stroke(edge, "L", f"E{k}", run) for k, (edge, run) in enumerate(zip(edges, runs or range(len(edges)), strict=True))]


def band(*corners: Point, shift: float = 0.0) -> Loop:
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
    turned = band(*BOX[2:], *BOX[:2])
    other_way = Loop(tuple(edge.reversed() for edge in reversed(turned.edges)), "L")
    cut = band((0, 0), (4, 0), (4, 3), (0, 2.99))
    half = band((0, 0), (2, 0), (4, 0), (4, 3), (0, 3))
    whole = [*(band(*BOX), turned, circle(0, 0, 1), other_way, cut, circle(0, 0, 1, 2.0, -TURN), half, band(*BOX, shift=1e-3))]
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
    found = near_ends(points)
    gaps = [gap for gap, _, _ in found]
    assert gaps == sorted(gaps) and len({(i, j) for _, i, j in found}) == len(found)
    assert all(i < j and gap == pytest.approx(math.dist(points[i], points[j])) for gap, i, j in found)
    array, pairs = np.array(points), {(i, j) for _, i, j in found}
    for k in range(0, count, max(1, count // 20)):
        nearest = np.argsort(np.hypot(*(array - array[k]).T))[1:9].tolist()
        assert {(min(k, n), max(k, n)) for n in nearest} <= pairs
    assert near_ends(points[:1]) == near_ends([]) == []


@pytest.mark.parametrize(("gap", "stray"), [(0.9, False), (1.1, True)])
def test_a_line_is_stray_where_it_is_far_from_all_others_beside_its_length(gap: float, stray: bool) -> None:
    for length in (1.0, 7.0):
        off = gap * STRAY * length
        drawn = strokes([line((0, 0), (length, 0)), line((length + off, 0), (length + off, 90)), Arc(1.0, 1.0, MM, 0.0, 1.0)])
        loose = [0, 1, 2, 3, 4, 5]
        near = near_ends([end for stroke in drawn for end in (stroke.edge.start, stroke.edge.end)])
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
        assert bool(twins([band(*box), band(*box, shift=off * limit)])) is alike
    assert twins([circle(0, 0, 1)]) == [] == twins([circle(0, 0, 1), circle(0, 0, 2), circle(0, 5, 1)])
    (found,) = twins([band(*BOX), circle(9, 9, 1), band(*BOX, shift=2e-4)])
    assert found.severity == "error" and "within 200 nm" in found.message
    assert (found.x_mm, found.y_mm) == pytest.approx((2.0, 0.0), abs=1e-3)


def test_how_far_one_outline_leaves_another() -> None:
    bent = band((0, 0), (4, 0), (4, 3), (2, 3.0004), (0, 3))
    for pair in ((band(*BOX), bent), (bent, band(*BOX))):
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
