"""Does every kind of entity become the lines and arcs it draws?"""

import math
import random
from collections.abc import Callable

import dxf_text as d
import numpy as np
import pytest
from every_time import few
from ezdxf.math import ConstructionEllipse
from random_dxf import drawing

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.dxf_records import COMMON, DxfError, Record, as_number, decoded, read_tags, strange_codes
from watchsim.drawing.findings import named_length
from watchsim.drawing.read import SMALLEST, odd_size, units_missing
from watchsim.geometry.loops import Loop, extents
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.solids import area

Reader = Callable[..., Drawing]
MM = 1e-3


def codes(drawing: Drawing) -> list[str]:
    return [finding.code for finding in drawing.findings]


def only_loop(drawing: Drawing) -> Loop:
    assert not drawing.findings, drawing.findings
    assert len(drawing.loops) == 1 and not drawing.open_chains
    return drawing.loops[0]


def test_circle_is_one_exact_arc(read_bytes: Reader) -> None:
    loop = only_loop(read_bytes(d.dxf(d.circle(1.25, -2.5, 0.16))))
    (edge,) = loop.edges
    assert edge == Arc(1.25 * MM, -2.5 * MM, 0.16 * MM, 0.0, TURN)


def test_lines_and_arc_make_one_loop_counter_clockwise(read_bytes: Reader) -> None:
    entities = d.line((0, 0), (4, 0)) + d.line((0, 2), (4, 2)) + d.arc(4, 1, 1, 270, 90) + d.line((0, 2), (0, 0))
    loop = only_loop(read_bytes(d.dxf(entities)))
    assert area(loop) == pytest.approx((8 + math.pi / 2) * 1e-6, rel=1e-14, abs=0)
    arcs = [edge for edge in loop.edges if isinstance(edge, Arc)]
    assert len(arcs) == 1 and arcs[0].radius == 1 * MM and arcs[0].sweep == pytest.approx(math.pi, rel=1e-15)
    for one, other in zip(loop.edges, [*loop.edges[1:], loop.edges[0]], strict=True):
        assert one.end == pytest.approx(other.start, abs=1e-18)


def test_arc_over_zero_degrees(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.arc(0, 0, 2, 350, 10)))
    (edge,) = drawing.open_chains[0].edges
    assert isinstance(edge, Arc)
    assert edge.sweep == pytest.approx(math.radians(20), rel=1e-14)
    assert edge.point(0.5) == pytest.approx((2 * MM, 0.0), abs=1e-18)


@pytest.mark.parametrize("bulge", [0.25, 1.0, -0.4, 2.5])
def test_bulge_is_the_tangent_of_a_quarter_of_the_angle(read_bytes: Reader, bulge: float) -> None:
    drawing = read_bytes(d.dxf(d.lwpolyline([(0, 0, bulge), (1, 1)], closed=False)))
    (edge,) = drawing.open_chains[0].edges
    assert isinstance(edge, Arc)
    assert edge.sweep == pytest.approx(4 * math.atan(bulge), rel=1e-14)
    assert edge.start == pytest.approx((0, 0), abs=1e-17) and edge.end == pytest.approx((MM, MM), abs=1e-17)
    rise = math.dist(edge.point(0.5), (0.5 * MM, 0.5 * MM))
    assert rise == pytest.approx(abs(bulge) * math.sqrt(2) / 2 * MM, rel=1e-13, abs=0.0)
    to_the_right = (edge.point(0.5)[0] - edge.point(0.5)[1]) > 0.0
    assert to_the_right == (bulge > 0)


def test_closed_lwpolyline_and_old_polyline_are_the_same(read_bytes: Reader) -> None:
    corners = [(0, 0, 0.5), (3, 0, 0), (3, 2, -0.2), (0, 2, 0)]
    light = only_loop(read_bytes(d.dxf(d.lwpolyline(corners, closed=True))))
    vertices = "".join(d.record("VERTEX", *d.point(10, (x, y)), (42, b)) for x, y, b in corners)
    heavy = only_loop(read_bytes(d.dxf(d.record("POLYLINE", (66, 1), (70, 1)) + vertices + d.record("SEQEND"))))
    assert light.edges == heavy.edges
    assert len(light.edges) == 4


def test_polyline_mesh_is_counted_not_drawn(read_bytes: Reader) -> None:
    mesh = d.record("POLYLINE", (70, 64)) + d.record("VERTEX", *d.point(10, (0, 0)), (70, 192)) + d.record("SEQEND")
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + mesh))
    assert drawing.ignored == {"POLYLINE": 1}
    assert len(drawing.loops) == 1


def test_mirrored_extrusion_turns_the_arc_over(read_bytes: Reader) -> None:
    """With the extrusion (0, 0, -1) the x axis points to the left, by the arbitrary-axis rule."""
    drawing = read_bytes(d.dxf(d.arc(5, 1, 2, 0, 90, (210, 0.0), (220, 0.0), (230, -1.0))))
    (edge,) = drawing.open_chains[0].edges
    assert isinstance(edge, Arc)
    assert (edge.x, edge.y, edge.radius) == pytest.approx((-5 * MM, 1 * MM, 2 * MM), rel=1e-15)
    assert edge.start == pytest.approx((-7 * MM, 1 * MM), abs=1e-18)
    assert edge.end == pytest.approx((-5 * MM, 3 * MM), abs=1e-18)


def test_tilted_circle_becomes_an_ellipse(read_bytes: Reader) -> None:
    """Seen under 60° a circle of 2 mm is an ellipse of 2 mm by 1 mm."""
    normal = (math.sin(math.pi / 3), 0.0, math.cos(math.pi / 3))
    drawing = read_bytes(d.dxf(d.circle(0, 0, 2, *zip((210, 220, 230), map(repr, normal), strict=True))))
    assert codes(drawing) == ["tilted"]
    assert area(drawing.loops[0]) == pytest.approx(2 * math.pi * 1e-6, rel=1e-4)
    assert extents(drawing.loops) == pytest.approx((-1 * MM, -2 * MM, 1 * MM, 2 * MM), abs=1.1e-7)


def test_ellipse_within_the_tolerance(read_bytes: Reader) -> None:
    entity = d.record("ELLIPSE", *d.point(10, (1, 2)), *d.point(11, (3, 4)), (40, 0.4), (41, 0.0), (42, repr(TURN)))
    coarse, fine = (read_bytes(d.dxf(entity), fit=fit) for fit in (1e-6, 1e-9))
    assert coarse.fitted_curves == fine.fitted_curves == 1
    assert 0.0 < coarse.fitted_deviation <= 1e-6 and 0.0 < fine.fitted_deviation <= 1e-9
    assert area(fine.loops[0]) == pytest.approx(math.pi * 5 * 2 * 1e-6, rel=1e-6)
    assert fine.fitted_arcs > 5 * coarse.fitted_arcs


@pytest.mark.parametrize(("start", "end"), [(4.0, 1.0), (-2.0, 7.0), (7.0, -2.0), (math.tau, 0.5), (0.0, -1e-12)])
@pytest.mark.parametrize("height", [1.0, -1.0])
def test_ellipse_runs_forward_from_start_to_end_once_at_most(
    read_bytes: Reader, start: float, end: float, height: float
) -> None:
    """Against ezdxf's own ellipse: parameters beyond a turn, running backwards, seen from below."""
    entity = d.record(
        "ELLIPSE",
        *d.point(10, (1, 2)),
        *d.point(11, (5, 1)),
        *d.point(210, (0, 0, height)),
        (40, 0.3),
        (41, repr(start)),
        (42, repr(end)),
    )
    drawing = read_bytes(d.dxf(entity))
    truth = ConstructionEllipse((1, 2), (5, 1), (0, 0, height), 0.3, start, end)
    points = np.array([(p.x, p.y) for p in truth.vertices(np.linspace(start, start + (truth.param_span or TURN), 4000))])
    assert 1e3 * drawing.drawn.length == pytest.approx(float(np.hypot(*np.diff(points, axis=0).T).sum()), rel=1e-5)
    box = extents((*drawing.loops, *drawing.open_chains))
    assert box == pytest.approx(1e-3 * np.concatenate((points.min(axis=0), points.max(axis=0))), abs=2e-7)


def test_ellipse_with_equal_axes_is_a_circle(read_bytes: Reader) -> None:
    entity = d.record("ELLIPSE", *d.point(10, (1, 2)), *d.point(11, (0, 4)), (40, 1.0), (41, 0.0), (42, repr(math.pi)))
    drawing = read_bytes(d.dxf(entity))
    (edge,) = drawing.open_chains[0].edges
    assert isinstance(edge, Arc) and drawing.fitted_curves == 0
    assert edge.start == pytest.approx((1 * MM, 6 * MM), abs=1e-17)
    assert edge.point(0.5) == pytest.approx((-3 * MM, 2 * MM), abs=1e-17)


def test_point(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + d.record("POINT", *d.point(10, (0.5, -0.25)), layer="PIVOT")))
    assert drawing.points == (("PIVOT", 0.5 * MM, -0.25 * MM),)
    assert drawing.layers == ("0", "PIVOT")


def test_text_is_counted(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + 3 * d.record("TEXT", (1, "15 teeth"))))
    assert drawing.ignored == {"TEXT": 3}
    assert [finding.severity for finding in drawing.findings] == ["notice"]


def test_block_turned_scaled_mirrored_nested(read_bytes: Reader) -> None:
    """A quarter disc inside a block inside a block: places by hand, and the arc stays one exact arc."""
    quarter = d.line((0, 0), (2, 0)) + d.arc(0, 0, 2, 0, 90) + d.line((0, 2), (0, 0))
    blocks = d.block("Q", quarter, base=(1, 0)) + d.block("OUTER", d.insert("q", (0, 0), (41, -1.0)))
    drawing = read_bytes(d.dxf(d.insert("OUTER", (10, 20), (41, 3.0), (42, 3.0), (50, 90.0)), blocks=blocks))
    loop = only_loop(drawing)
    (edge,) = [edge for edge in loop.edges if isinstance(edge, Arc)]
    # centre (0, 0) -> minus base (-1, 0) -> mirrored (1, 0) -> times 3 (3, 0) -> turned (0, 3) -> placed (10, 23)
    assert (edge.x, edge.y, edge.radius) == pytest.approx((10 * MM, 23 * MM, 6 * MM), rel=1e-15)
    assert area(loop) == pytest.approx(math.pi * 9 * 1e-6, rel=1e-14, abs=0)
    assert extents([loop]) == pytest.approx((4 * MM, 17 * MM, 10 * MM, 23 * MM), rel=1e-14)


def test_array_of_blocks(read_bytes: Reader) -> None:
    entity = d.insert("B", (0, 0), (70, 3), (71, 2), (44, 5.0), (45, 4.0), (50, 90.0), (43, 0.0))
    drawing = read_bytes(d.dxf(entity, blocks=d.block("B", d.circle(0, 0, 1))))
    places = sorted((round(edge.x / MM, 9), round(edge.y / MM, 9)) for loop in drawing.loops for edge in loop.edges)
    assert places == [(-4, 0), (-4, 5), (-4, 10), (0, 0), (0, 5), (0, 10)]


def test_unequal_scale_makes_ellipses_and_keeps_lines(read_bytes: Reader) -> None:
    content = d.circle(0, 0, 1) + d.lwpolyline([(2, 0), (3, 0), (3, 1)], closed=True)
    drawing = read_bytes(d.dxf(d.insert("B", (0, 0), (41, 2.0), (42, 0.5)), blocks=d.block("B", content)))
    assert drawing.fitted_curves == 1
    areas = sorted(area(loop) for loop in drawing.loops)
    assert areas[0] == pytest.approx(0.5e-6, rel=1e-13, abs=0)
    assert areas[1] == pytest.approx(math.pi * 1e-6, rel=2e-4)


def test_layer_zero_in_a_block_is_the_layer_of_the_insert(read_bytes: Reader) -> None:
    blocks = d.block("B", d.circle(0, 0, 1) + d.circle(5, 0, 1, layer="PIN"))
    drawing = read_bytes(d.dxf(d.insert("B", (0, 0), layer="TEETH"), blocks=blocks))
    assert sorted(loop.layer for loop in drawing.loops) == ["PIN", "TEETH"]


def test_missing_and_self_containing_blocks_are_errors(read_bytes: Reader) -> None:
    blocks = d.block("A", d.insert("B", (0, 0))) + d.block("B", d.insert("A", (0, 0)) + d.circle(0, 0, 1))
    drawing = read_bytes(d.dxf(d.insert("A", (0, 0)) + d.insert("NONE", (1, 1)), blocks=blocks))
    assert sorted(codes(drawing)) == ["block-loop", "block-missing"]
    assert len(drawing.loops) == 1


def test_a_block_drawn_in_another_file_is_an_error_and_an_empty_one_is_said(read_bytes: Reader) -> None:
    head = d.record("BLOCK", (2, "GEAR"), (70, 4), *d.point(10, (0, 0)), (3, "GEAR"), (1, "gear.dwg"))
    blocks = head + "0\nENDBLK\n8\n0\n" + d.block("NONE", "")
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + d.insert("GEAR", (5, 5)) + 2 * d.insert("NONE", (9, 9)), blocks=blocks))
    assert [(finding.code, finding.severity) for finding in drawing.findings] == [
        ("external", "error"),
        ("empty-block", "notice"),
    ]
    assert "gear.dwg" in drawing.findings[0].message
    assert len(drawing.loops) == 1


def test_hidden_layers_are_left_out_and_said(read_bytes: Reader) -> None:
    tables = d.layers(("Off", -7, 0), ("Cold", 7, 1), ("On", 7, 0))
    entities = d.circle(0, 0, 1, layer="OFF") + 2 * d.circle(0, 0, 2, layer="cold") + d.circle(0, 0, 3, layer="ON")
    drawing = read_bytes(d.dxf(entities, tables=tables))
    assert drawing.layers == ("On",)
    assert [(finding.code, finding.layer) for finding in drawing.findings] == [("layer-off", "Off"), ("layer-off", "Cold")]
    assert "2 entities" in drawing.findings[1].message


def test_paper_space_is_left_out_and_said(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + d.circle(0, 0, 2, (67, 1)) + d.record("VIEWPORT", (67, 1))))
    assert len(drawing.loops) == 1
    assert [finding.code for finding in drawing.findings] == ["paper-space"]
    assert drawing.findings[0].message.startswith("1 ")


@pytest.mark.parametrize(("code", "name", "metres"), [(1, "inch", 0.0254), (4, "mm", 1e-3), (6, "m", 1.0), (13, "µm", 1e-6)])
def test_units_of_the_header(read_bytes: Reader, code: int, name: str, metres: float) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 2), units=code))
    assert (drawing.units, drawing.units_from) == (name, "header")
    assert drawing.loops[0].edges[0].radius == 2 * metres  # type: ignore[union-attr]


@pytest.mark.parametrize("units", [None, 0])
def test_unknown_units_are_an_error_with_both_sizes(read_bytes: Reader, units: int | None) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 2.15), units=units))
    assert drawing.units is None and drawing.units_from is None
    (finding,) = drawing.findings
    assert (finding.code, finding.severity) == ("units-missing", "error")
    assert "4.3 mm or 109.2 mm across" in finding.message


def test_the_caller_overrules_the_file_with_a_warning(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1), units=1), units="mm")
    assert (drawing.units, drawing.units_from, drawing.loops[0].edges[0].radius) == ("mm", "option", 1e-3)  # type: ignore[union-attr]
    assert codes(drawing) == ["units-overruled"]
    assert codes(read_bytes(d.dxf(d.circle(0, 0, 1), units=None), units="inch")) == []
    with pytest.raises(ValueError, match="furlong"):
        read_bytes(d.dxf(d.circle(0, 0, 1)), units="furlong")
    with pytest.raises(ValueError, match="not a unit of length"):
        read_bytes(d.dxf(d.circle(0, 0, 1)), units="kg")


def test_binary_file_is_the_same_drawing(read_bytes: Reader, tmp_path: object) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    doc = ezdxf.new("R2000", units=4)
    doc.modelspace().add_lwpolyline([(0, 0, 0.3), (1, 0, 0), (1, 1, 0)], format="xyb", close=True)
    paths = [f"{tmp_path}/{name}.dxf" for name in ("text", "binary")]
    doc.saveas(paths[0])
    doc.saveas(paths[1], fmt="bin")
    from watchsim.drawing.read import read

    text, binary = (read(path) for path in paths)
    assert text.loops == binary.loops and len(text.loops) == 1
    assert binary.units == "mm"


def test_line_in_three_dimensions_is_projected_with_a_warning(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.line((0, 0, 0), (3, 0, 4)) + d.line((3, 0), (0, 4)) + d.line((0, 4), (0, 0))))
    assert codes(drawing) == ["tilted"]
    assert area(drawing.loops[0]) == pytest.approx(6e-6, rel=1e-14, abs=0)


def test_line_directions_do_not_matter(read_bytes: Reader) -> None:
    loop = only_loop(read_bytes(d.dxf(d.line((1, 0), (0, 0)) + d.line((1, 0), (0, 1)) + d.line((0, 0), (0, 1)))))
    assert area(loop) == pytest.approx(0.5e-6, rel=1e-14, abs=0)
    assert all(isinstance(edge, Line) for edge in loop.edges)


@pytest.mark.parametrize("bulge", [-0.3, 0.3, -1.7])
def test_bulges_to_either_side_become_elliptic_in_unequal_scales(read_bytes: Reader, bulge: float) -> None:
    """The area grows by both scales, whichever way the bulge turns."""
    corners = [(3.0, 0.0), (5.0, 0.0), (5.0, 2.0, bulge)]
    plain = read_bytes(d.dxf(d.lwpolyline(corners, True)))
    block = d.block("B", d.lwpolyline(corners, True))
    squashed = read_bytes(d.dxf(d.insert("B", (300, 0), (41, 2.0), (42, 0.5), (50, 20.0)), blocks=block))
    assert not squashed.findings and len(squashed.loops) == 1
    assert area(squashed.loops[0]) == pytest.approx(area(plain.loops[0]), rel=1e-4)


@pytest.mark.parametrize("size", [1e-2, 1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("hand", [1.0, -1.0])
def test_flat_bulges_are_arcs(size: float, hand: float, read_bytes: Reader) -> None:
    """A bulge of 1e-3 over 1 mm rises by 0.5 µm: by the definition the sagitta is half the chord times the bulge."""
    corners = [(0.0, 0.0, hand * size), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]
    (loop,) = read_bytes(d.dxf(d.lwpolyline(corners, True))).loops
    (edge,) = [edge for edge in loop.edges if isinstance(edge, Arc)]
    assert edge.point(0.5)[1] == pytest.approx(-hand * 0.5e-3 * size, rel=1e-6, abs=1e-15)
    assert edge.radius == pytest.approx(0.25e-3 * (1.0 / size + size), rel=1e-9)


@pytest.mark.parametrize(
    ("tags", "sweep"),
    [
        ((), 2.0 * math.pi),
        (((42, 1.0),), 1.0),
        (((41, 1.0),), 2.0 * math.pi - 1.0),
        (((41, 5.0), (42, 1.0)), 2.0 * math.pi - 4.0),
    ],
)
def test_an_ellipse_runs_all_round_where_its_ends_are_not_given(
    read_bytes: Reader, tags: tuple[tuple[int, float], ...], sweep: float
) -> None:
    """With equal axes the parameter is the angle."""
    entity = d.record("ELLIPSE", *d.point(10, (1, 2)), *d.point(11, (3, 4)), (40, 1.0), *tags)
    drawing = read_bytes(d.dxf(entity))
    (loop,) = (*drawing.loops, *drawing.open_chains)
    assert loop.closed is (not tags) and sum(edge.length for edge in loop.edges) == pytest.approx(5e-3 * sweep, rel=1e-9)


def test_escaped_letters_are_decoded() -> None:
    assert decoded(r" \U+00B5m \U+2300 5 ") == "µm ⌀ 5" and decoded(r"\P 5") == r"\P 5"


FIT = 2e-9


@pytest.mark.parametrize("seed", few(range(40), lambda seed: seed % 4 == 1))
def test_length_and_extents_are_those_of_the_points_drawn(read_bytes: Callable[..., Drawing], seed: int) -> None:
    data, rows = drawing(random.Random(seed))
    found = read_bytes(data, fit=FIT)
    plane = [1e-3 * row[:, :2] for row in rows]
    everywhere = np.concatenate(plane)
    low, high = everywhere.min(axis=0), everywhere.max(axis=0)
    size = float(np.max(high - low))
    length = sum(float(np.hypot(*np.diff(row, axis=0).T).sum()) for row in plane)
    assert found.drawn.length == pytest.approx(length, rel=1e-5)
    box = extents((*found.loops, *found.open_chains))
    assert box == pytest.approx((*low, *high), abs=1e-5 * size)
    assert not {"damaged", "fit", "block-missing"} & {finding.code for finding in found.findings}


# As the reference tabulates them (DXF reference, section Entities), without those that all entities may have.
REFERENCE = {
    "LINE": "10 20 30 11 21 31",
    "POINT": "10 20 30 50",
    "CIRCLE": "10 20 30 40",
    "ARC": "10 20 30 40 50 51",
    "ELLIPSE": "10 20 30 11 21 31 40 41 42",
    "LWPOLYLINE": "90 70 43 10 20 40 41 42 91 30",  # 30 is in no reference, but some programs write it
    "POLYLINE": "10 20 30 70 40 41 71 72 73 74 75",
    "VERTEX": "10 20 30 40 41 42 91 70 50 71 72 73 74",
    "INSERT": "2 10 20 30 41 42 43 50 70 71 44 45",
    "SPLINE": "70 71 72 73 74 42 43 44 12 22 32 13 23 33 40 41 10 20 30 11 21 31",
}
EVERY = "5 6 8 39 48 60 62 66 67 92 100 102 160 210 220 230 284 310 330 347 348 360 370 380 390 420 430 440"


@pytest.mark.parametrize("kind", REFERENCE)
def test_every_code_of_the_reference_is_known_and_no_other(kind: str) -> None:
    own, common = (set(map(int, text.split())) for text in (REFERENCE[kind], EVERY))
    assert strange_codes(Record(kind, sorted(own | common), [0] * len(own | common), "line 1")) == []
    for other in range(1000):
        if other not in own | COMMON:
            assert strange_codes(Record(kind, [other], [0], "line 1")) == [other]


WHOLE = "0\nSECTION\n2\nENTITIES\n0\nline\n8\nA\n5\n4f\n0\nENDSEC\n0\nEOF\n"


@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
def test_records_begin_with_group_0_and_know_their_line(ends: str) -> None:
    tags = read_tags(WHOLE.replace("\n", ends).encode())
    assert [(one.kind, one.place) for one in tags.records] == [("SECTION", "line 1"), ("LINE", "line 5"), ("ENDSEC", "line 11")]
    assert list(tags.records[1].codes) == [8, 5] and list(tags.records[1].values) == ["A", "4f"]
    assert tags.records[1].name == "LINE #4F" and tags.records[0].name == "SECTION (line 1)"
    assert (tags.fault, tags.trash, tags.beyond) == ("", False, ())


def test_what_follows_the_end_is_told() -> None:
    more = read_tags((WHOLE + "0\ncircle\n8\nA\n0\nLINE\n").encode())
    assert more.trash and more.beyond == ("CIRCLE", "LINE") and len(more.records) == 3
    garbage = read_tags((WHOLE + "what\never\n").encode())
    assert garbage.trash and not garbage.fault


def test_a_file_that_is_cut_short_loses_its_last_record_only() -> None:
    for text, kinds in (
        (WHOLE[: WHOLE.index("0\nENDSEC")], ["SECTION"]),
        (WHOLE[: WHOLE.index("0\nEOF")], ["SECTION", "LINE", "ENDSEC"]),
    ):
        tags = read_tags(text.encode())
        assert [one.kind for one in tags.records] == kinds and "without EOF" in tags.fault
    broken = read_tags(WHOLE.replace("\n5\n", "\nfive\n").encode())
    assert broken.fault == 'line 9 reads "five" where a group code belongs' and [one.kind for one in broken.records] == [
        "SECTION"
    ]


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b" \n", "empty"),
        (b"AC1032\x00\x01", "DWG"),
        (b"solid\nfacet\n", 'begins with "solid"'),
        (b"8\nA\n", "holds no record"),
        (b"\x07\x00%PDF\n1\n", 'begins with "??%PDF"'),
    ],
)
def test_what_is_no_dxf_file_is_refused(data: bytes, why: str) -> None:
    with pytest.raises(DxfError, match=why.replace("?", r"\?")):
        read_tags(data)


@pytest.mark.parametrize(
    ("page", "data"),
    [
        ("ANSI_1251", "Ж".encode("cp1251")),
        ("dos850", "ø".encode("cp850")),
        ("ANSI_9999", "é".encode("latin-1")),
        ("", "€".encode("cp1252")),
    ],
)
def test_old_files_are_read_in_their_code_page(page: str, data: bytes) -> None:
    head = f"9\n$DWGCODEPAGE\n3\n{page}\n" if page else ""
    text = f"0\nSECTION\n{head}0\nLINE\n8\n".encode() + data + b"\n0\nENDSEC\n0\nEOF\n"
    expected = {"ANSI_1251": "Ж", "dos850": "ø", "ANSI_9999": "é", "": "€"}[page]
    assert read_tags(text).records[1].text(8) == expected
    assert read_tags("\ufeff".encode() + WHOLE.replace("A", "µ").encode()).records[1].text(8) == "µ"


def test_values_are_numbers_of_sensible_size() -> None:
    assert as_number(" 1.5 ", 10) == 1.5 and as_number("-1e11", 10) == -1e11 and as_number(1e11, 10) == 1e11
    for wrong in ("1.1e11", "-1.1e11", "nan", "inf", "x", None, ""):
        with pytest.raises(DxfError, match="group 10"):
            as_number(wrong, 10)
    record = Record("X", [70, 40, 40, 10, 20, 71], ["3", "1", "2", "5", "6", "2.5"], "line 1")
    assert (
        record.integer(70) == 3 and record.integer(99) == 0 and record.integer(99, 4) == 4 and record.numbers(40) == [1.0, 2.0]
    )
    assert (
        record.point(10) == (5.0, 6.0, 0.0)
        and record.point(11, (1.0, 2.0, 3.0)) == (1.0, 2.0, 3.0)
        and record.number(41, 7.0) == 7.0
    )
    for fault in (lambda: record.integer(71), lambda: record.number(40), lambda: record.number(41), lambda: record.point(20)):
        with pytest.raises(DxfError):
            fault()
    assert decoded(r" \U+00B5m ") == "µm" and decoded(r"a\b") == r"a\b"


@pytest.mark.parametrize(
    ("name", "usual", "metres"),
    [
        ("mm", "mm", 1e-3),
        (" inch ", "inch", 0.0254),
        ("µm", "µm", 1e-6),
        ("cm", "cm", 1e-2),
        ("US survey ft", "US survey ft", 1200 / 3937),
    ],
)
def test_units_are_known_by_name(name: str, usual: str, metres: float) -> None:
    assert named_length(name) == (usual, pytest.approx(metres, rel=1e-15))
    for wrong in ("kg", "furlong", ""):
        with pytest.raises(ValueError, match="Write"):
            named_length(wrong)


@pytest.mark.parametrize(("share", "told"), [(0.9, True), (1.1, False)])
def test_a_drawing_of_the_size_of_a_point_is_told(share: float, told: bool) -> None:
    size = share * SMALLEST * 1e-6
    for loop in (
        Loop((Line(1.0, 2.0, 1.0 + size, 2.0),)),
        Loop((Line(0.0, 0.0, 0.0, size),)),
        Loop((Arc(0.0, 0.0, 0.5 * size, 0.0, TURN),)),
    ):
        found = odd_size((loop,), 1e-6, True)
        assert [finding.code for finding in found] == ["tiny"] * told
        assert all(f"{1e6 * size:.3g} µm across" in finding.message and "within 1 µm" in finding.message for finding in found)
    assert odd_size((), 1e-6, True) == []


def test_missing_units_are_said_first_with_both_sizes(read_bytes: Callable[..., Drawing]) -> None:
    finding = units_missing((Loop((Line(-1e-3, 0.0, 3e-3, 1e-3),)), Loop((Line(0.0, 0.0, 0.0, -9e-3),))))
    assert finding.severity == "error" and "would be 10 mm or 254 mm across" in finding.message
    entities = d.record("CIRCLE", (10, "1"), (20, "2"), (40, "-3")) + d.line((0, 0), (0, 0))
    assert read_bytes(d.dxf(entities, units=None)).findings[0].code == "units-missing"
    assert read_bytes(d.dxf(d.record("TEXT", (1, "x")))).findings[0].code == "empty"
