"""Do edges find each other, and is everything that is wrong with an outline named?"""

from __future__ import annotations

import math
import random
import sys
from collections.abc import Callable

import dxf_text as d
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.drawing.chaining import chain
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding, Stroke
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.geometry.solids import area

Reader = Callable[..., Drawing]
SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]


def by_code(drawing: Drawing) -> dict[str, list[Finding]]:
    found: dict[str, list[Finding]] = {}
    for finding in drawing.findings:
        found.setdefault(finding.code, []).append(finding)
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
