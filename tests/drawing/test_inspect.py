"""Does the report use the fixed names, and does the text say what matters?"""

import json
import math
from collections.abc import Callable
from itertools import pairwise

import dxf_text as d
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.drawing.circles import curvatures, facets
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.drawing.inspection import finding_lines, inspect_report, inspect_text
from watchsim.drawing.read import odd_size
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line

Reader = Callable[..., Drawing]

TOP = (
    *("file", "format", "units", "units_from", "extents_mm", "layers", "loops", "points", "fitted", "drawn", "ignored"),
    "findings",
    *("lines", "arcs", "length_mm", "area_mm2", "circles"),
)


def wheel() -> bytes:
    ring = d.circle(0, 0, 2.15, layer="TEETH") + d.circle(0, 0, 1, layer="TEETH") + d.line((5, 5), (6, 5), layer="SLOT")
    return d.dxf(ring + d.record("POINT", *d.point(10, (0, 0)), layer="PIVOT") + d.record("TEXT", (1, "x")))


def test_fixed_names_and_values(read_bytes: Reader) -> None:
    report = inspect_report(read_bytes(wheel()))
    assert tuple(report) == TOP
    assert json.loads(json.dumps(report)) == report
    assert report["units"] == "mm" and report["units_from"] == "header" and report["format"] == "dxf"
    assert report["extents_mm"] == pytest.approx([-2.15, -2.15, 6.0, 5.0])
    assert report["layers"] == {
        "TEETH": {"lines": 0, "arcs": 2, "loops": 2, "open_chains": 0},
        "SLOT": {"lines": 1, "arcs": 0, "loops": 0, "open_chains": 1},
        "PIVOT": {"lines": 0, "arcs": 0, "loops": 0, "open_chains": 0},
    }
    loops = report["loops"]
    assert isinstance(loops, list)
    assert [set(loop) for loop in loops] == [{"layer", "lines", "arcs", "area_mm2", "length_mm", "closed", "hole"}] * 3
    assert [(loop["closed"], loop["hole"]) for loop in loops] == [(True, False), (True, True), (False, False)]
    assert [loop["area_mm2"] for loop in loops] == pytest.approx([math.pi * 2.15**2, math.pi, 0.0], rel=1e-13)
    assert report["area_mm2"] == pytest.approx(math.pi * (2.15**2 - 1), rel=1e-13)
    assert report["length_mm"] == pytest.approx(2 * math.pi * 3.15 + 1, rel=1e-13)
    assert (report["lines"], report["arcs"]) == (1, 2)
    assert report["points"] == [{"layer": "PIVOT", "x_mm": 0.0, "y_mm": 0.0}]
    assert report["fitted"] == {"curves": 0, "arcs": 0, "worst_deviation_um": 0.0}
    assert report["drawn"] == {"kinds": {"circle": 2, "line": 1}, "length_mm": pytest.approx(6.3 * math.pi + 1.0)}
    assert report["ignored"] == {"TEXT": 1}
    findings = report["findings"]
    assert isinstance(findings, list)
    assert set(findings[0]) == {"code", "severity", "layer", "x_mm", "y_mm", "message", "fix"}


def test_text_for_people(read_bytes: Reader) -> None:
    text = inspect_text(read_bytes(wheel()))
    assert "units: mm, as the file says" in text
    assert "the part is 8.15 mm across (8.15 × 7.15 mm" in text
    assert "TEETH  2 outlines (1 hole), 2 arcs" in text
    assert "PIVOT  a point at (0, 0) mm" in text
    assert "not read: 1 TEXT" in text
    assert "warning (stray-line) [layer SLOT]" in text


def test_the_place_of_a_small_part_far_from_the_origin_is_told(read_bytes: Reader) -> None:
    text = inspect_text(read_bytes(d.dxf(d.polygon([(1e5, -2e-5), (1e5 + 4.25, -2e-5), (1e5 + 4.25, 3)]))))
    assert "x 100000 to 100004.25, y 0 to 3)" in text


def test_text_without_units_and_without_anything(read_bytes: Reader) -> None:
    text = inspect_text(read_bytes(d.dxf(d.circle(0, 0, 2.15), units=None)))
    assert "units: not stated" in text and "4.3 mm or 109.2 mm across" in text and 'Set units = "mm"' in text
    nothing = read_bytes(d.dxf(""))
    assert "nothing to measure" in inspect_text(nothing)
    assert inspect_report(nothing)["extents_mm"] is None


def test_text_says_when_all_is_well_and_cuts_long_lists(read_bytes: Reader) -> None:
    assert "no faults found" in inspect_text(read_bytes(d.dxf(d.circle(0, 0, 1))))
    strays = "".join(d.line((5 * k, 0), (5 * k + 1, 0)) for k in range(30))
    text = inspect_text(read_bytes(d.dxf(strays)))
    assert text.count("(stray-line) [") == 12
    assert "and 18 more of stray-line" in text


def test_alike_findings_without_a_place_are_one_line() -> None:
    said = [Finding("external", "error", f'block "A" is drawn in another file; INSERT #{k:X} is left out') for k in range(175)]
    other = Finding("external", "error", 'block "B" is drawn in another file; INSERT #C is left out')
    text = "\n".join(finding_lines([*said, other]))
    assert text.count("(external)") == 2 and "INSERT #0 is left out (and 174 more alike)" in text and "more of" not in text


@pytest.mark.parametrize(("sides", "found"), [(64, True), (12, True), (8, False)])
def test_a_regular_polygon_is_the_circle_that_it_stands_for(read_bytes: Reader, sides: int, found: bool) -> None:
    """As a program without arcs writes a bore; its deviation is the rise of a chord. A nut is a nut."""
    corners = [(3.0 + math.cos(TURN * k / sides), 4.0 + math.sin(TURN * k / sides)) for k in range(sides)]
    drawing = read_bytes(d.dxf(d.circle(3, 4, 2) + d.polygon(corners)))
    polygons = [circle for circle in inspect_report(drawing)["circles"] if circle["sides"]]  # type: ignore[attr-defined]
    assert len(polygons) == found
    if found:
        (one,) = polygons
        assert one["hole"] and (one["x_mm"], one["y_mm"], one["radius_mm"]) == pytest.approx((3.0, 4.0, 1.0), abs=1e-6)
        assert one["deviation_um"] == pytest.approx(1e3 * (1.0 - math.cos(math.pi / sides)), abs=1e-3)
        assert f"drawn as {sides} straight pieces" in inspect_text(drawing)


def test_every_finding_with_a_place_tells_it_once() -> None:
    inside = Finding("open-outline", "error", "the outline is open: 1 mm between (1, -2) and (1, -3) mm", x_mm=1.0, y_mm=-2.0)
    beside = Finding("slit", "notice", "LINE #4F goes out and back along itself", x_mm=1.25, y_mm=-2.0)
    nowhere = Finding("units-missing", "warning", "the drawing does not say its units")
    lines = finding_lines([inside, beside, nowhere])
    assert sum("(1, -2)" in line for line in lines) == 1 and not any("(1, -2) mm, at" in line for line in lines)
    assert any(line.endswith("along itself, at (1.25, -2) mm") for line in lines)
    assert any(line.endswith("its units") for line in lines)


def test_areas_of_several_layers_are_called_a_sum(read_bytes: Reader) -> None:
    assert "mm² of material\n" in inspect_text(read_bytes(wheel()))
    text = inspect_text(read_bytes(d.dxf(d.circle(0, 0, 2, layer="TABLE") + d.circle(0, 0, 1, layer="SAFETY"))))
    assert f"{5 * math.pi:.5g} mm² of material in all layers added up" in text


def test_bores_are_taken_out_and_pivots_are_no_material(read_bytes: Reader) -> None:
    pivot = d.circle(0, 0, 0.5, layer="PIVOT")
    bore = d.circle(0, 0, 1, layer="BORE")
    drawing = read_bytes(d.dxf(d.circle(0, 0, 4, layer="TEETH") + bore + pivot))
    assert inspect_report(drawing)["area_mm2"] == pytest.approx(math.pi * (16 - 1), rel=1e-13)
    text = inspect_text(drawing)
    assert f"{15 * math.pi:.5g} mm² of material\n" in text
    assert f"BORE   1 outline, 1 arc, {math.pi:.5g} mm² taken out" in text
    assert f"PIVOT  1 outline, 1 arc, {0.25 * math.pi:.5g} mm², no material" in text


def test_a_bore_in_a_hole_takes_out_nothing_more(read_bytes: Reader) -> None:
    ring = d.circle(0, 0, 4, layer="TEETH") + d.circle(0, 0, 1, layer="TEETH")
    for radius in (0.7, 1.0):
        report = inspect_report(read_bytes(d.dxf(ring + d.circle(0, 0, radius, layer="Wheel hole 2"))))
        assert report["area_mm2"] == pytest.approx(math.pi * (16 - 1), rel=1e-13)


def test_slots_among_bores_and_the_ring_of_a_bore_count_once(read_bytes: Reader) -> None:
    slot = d.polygon([(2, -0.5), (3, -0.5), (3, 0.5), (2, 0.5)], layer="holes")
    ring = d.circle(0, 0, 1, layer="holes") + d.circle(0, 0, 0.8, layer="holes")
    report = inspect_report(read_bytes(d.dxf(d.circle(0, 0, 4, layer="PLATE") + slot + ring)))
    assert report["area_mm2"] == pytest.approx(math.pi * (16 - 1) - 1, rel=1e-13)


def test_the_last_word_of_a_layer_says_what_it_holds(read_bytes: Reader) -> None:
    def measured(layer: str) -> float:
        content = d.circle(0, 0, 4, layer="PLATE") + d.circle(2, 0, 1, layer=layer)
        return inspect_report(read_bytes(d.dxf(content)))["area_mm2"] / math.pi

    for layer in ("CENTER WHEEL", "HOLE_JEWEL", "PIN", "0"):
        assert measured(layer) == pytest.approx(17)
    for layer in ("Lever_Pivot-2", "WHEEL CENTRE", "AXIS"):
        assert measured(layer) == pytest.approx(16)
    for layer in ("Pivot-Holes", "BORE_D0.3"):
        assert measured(layer) == pytest.approx(15)


def test_what_is_drawn_on_layers_of_bores_and_pivots_alone_is_the_part(read_bytes: Reader) -> None:
    report = inspect_report(read_bytes(d.dxf(d.circle(0, 0, 2, layer="HOLES") + d.circle(5, 0, 1, layer="PIVOT"))))
    assert report["area_mm2"] == pytest.approx(5 * math.pi, rel=1e-13)


def test_points_are_in_millimetres(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + d.record("POINT", *d.point(10, (3.0, -4.0)), layer="PIVOT")))
    assert inspect_report(drawing)["points"] == [{"layer": "PIVOT", "x_mm": 3.0, "y_mm": -4.0}]


@pytest.mark.parametrize(("apart", "tiny"), [((0.0, 0.0), True), ((3e-3, 0.0), False), ((0.0, 3e-3), False)])
def test_a_drawing_hardly_larger_than_one_point_is_told(apart: tuple[float, float], tiny: bool) -> None:
    """Two small circles, which have no ends apart: on each other, side by side, one above the other."""
    loops = tuple(Loop((Arc(x, y, 1e-7, 0.0, TURN),)) for x, y in ((0.0, 0.0), apart))
    found = odd_size(loops, 1e-6, True)
    assert [finding.code for finding in found] == (["tiny"] if tiny else [])
    assert not tiny or "0.2 µm across, and ends within 1 µm" in found[0].message


@pytest.mark.parametrize(("scale", "huge"), [(0.99, None), (1.01, "10.1 m"), (1e3, "10 km")])
def test_a_drawing_larger_than_any_clock_is_told(read_bytes: Reader, scale: float, huge: str | None) -> None:
    """Two circles, 10 m across together in a file that says metres; one that says nothing is asked for its units."""
    circles = d.circle(0, 0, scale) + d.circle(8 * scale, 0, scale)
    found, unsaid = (read_bytes(d.dxf(circles, units)) for units in (6, 0))
    assert [(one.code, one.message) for one in found.findings] == [("huge", f"the whole drawing is {huge} across")] * bool(huge)
    assert [one.code for one in unsaid.findings] == ["units-missing"]
    assert ("mm across" in inspect_text(found)) is not bool(huge)


Point = tuple[float, float]


def off(drawing: Drawing) -> list[float]:
    """Deviations (µm) that the findings tell."""
    words = [finding.message for finding in drawing.findings if finding.code == "facets"]
    return [float(text.split("(up to ")[1].split(" µm")[0]) for text in words]


def rim(angles: list[float], radius: float = 2.0, x: float = 0.0) -> list[Point]:
    return [(x + radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]


def widest(angles: list[float], radius: float) -> float:
    """µm by which the longest chord leaves its circle."""
    gaps = [b - a for a, b in zip(angles, [*angles[1:], angles[0] + math.tau], strict=True)]
    return 1e3 * radius * (1.0 - math.cos(0.5 * max(gaps)))


@given(st.lists(st.floats(0.6, 1.5), min_size=60, max_size=80))
def test_uneven_facets_of_a_pin(steps: list[float]) -> None:
    angles = [math.tau * sum(steps[:k]) / sum(steps) for k in range(len(steps))]
    points = [(1e-3 * x, 1e-3 * y) for x, y in rim(angles, 10.0)]
    edges = tuple(Line(*a, *b) for a, b in zip(points, [*points[1:], points[0]], strict=True))
    (finding,) = facets([Loop(edges, "0")])
    found = float(finding.message.split("(up to ")[1].split(" µm")[0])
    assert found == pytest.approx(widest(angles, 10.0), rel=1e-2)


@pytest.mark.parametrize(("pieces", "told"), [(68, True), (300, True), (900, False)])
def test_what_no_fitted_curve_would_show_is_not_told(pieces: int, told: bool, read_bytes: Reader) -> None:
    angles = [math.tau * k / pieces for k in range(pieces)]
    rise = 2e3 * (1.0 - math.cos(math.pi / pieces))
    assert (rise > 0.1) == told
    found = off(read_bytes(d.dxf(d.lwpolyline(rim(angles), True))))
    assert found == ([pytest.approx(rise, rel=0.01)] if told else [])


def test_one_finding_for_an_outline(read_bytes: Reader) -> None:
    """A slot with two faceted ends: one finding, with the larger deviation, and what to do."""
    right = rim([-0.5 * math.pi + math.pi * k / 20 for k in range(21)], 1.0, 10.0)
    left = rim([0.5 * math.pi + math.pi * k / 12 for k in range(13)], 1.0, -10.0)
    drawing = read_bytes(d.dxf(d.lwpolyline([*right, *left], True)))
    (finding,) = drawing.findings
    assert "32 straight pieces stand for curves at 2 places" in finding.message and "ARC" in finding.fix
    assert off(drawing) == [pytest.approx(1e3 * (1.0 - math.cos(math.pi / 24)), rel=0.01)]


def test_a_curve_that_is_no_arc(read_bytes: Reader) -> None:
    """Half an ellipse of 4 × 1 mm in 40 pieces; the deviation against the sampled ellipse."""
    at = [math.pi * k / 40 for k in range(41)]
    points = [(4.0 * math.cos(t), math.sin(t)) for t in at]
    true = 0.0
    for a, b, s in zip(points, points[1:], at, strict=False):
        for k in range(1, 100):
            t = s + math.pi / 40 * k / 100
            p = (4.0 * math.cos(t), math.sin(t))
            length = math.dist(a, b)
            true = max(true, abs((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / length)
    (finding,) = read_bytes(d.dxf(d.lwpolyline(points, True))).findings
    assert "stand for a curve" in finding.message and "SPLINE" in finding.fix
    assert float(finding.message.split("(up to ")[1].split(" µm")[0]) == pytest.approx(
        1e3 * true, rel=0.1
    )  # at its end only one corner is known


def test_designed_corners_are_no_facets(read_bytes: Reader) -> None:
    chamfers = [(0, 0), (9, 0), (10, 1), (10, 4), (9.5, 6), (5, 6.5), (1, 6), (0, 5)]
    stairs = [(20 + k, 0.3 * k + (0.5 if k % 2 else 0.0)) for k in range(12)] + [(31, -5), (20, -5)]
    assert not off(read_bytes(d.dxf(d.lwpolyline(chamfers, True) + d.lwpolyline(stairs, True))))


@pytest.mark.parametrize("apart", [5e-6, 5e-5, 5e-4])
def test_outlines_that_all_but_coincide_are_found(apart: float, read_bytes: Reader) -> None:
    """A copy 5 to 500 nm beside its original; drawn 2 µm away it is another outline, which crosses."""
    shape = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 2.0), (0.0, 2.0)]
    moved = [(x + apart, y + 0.3 * apart) for x, y in shape]
    codes = [(f.code, f.severity) for f in read_bytes(d.dxf(d.lwpolyline(shape, True) + d.lwpolyline(moved, True))).findings]
    assert ("overlap", "error") in codes
    circles = d.circle(0, 0, 1) + d.circle(apart, 0, 1 - 0.5 * apart)
    assert ("overlap", "error") in [(f.code, f.severity) for f in read_bytes(d.dxf(circles)).findings]
    ring = d.circle(0, 0, 1) + d.circle(0, 0, 0.99)
    assert not read_bytes(d.dxf(ring)).findings


def test_ends_of_unrelated_parts_are_not_paired(read_bytes: Reader) -> None:
    """Two brackets 30 mm apart, one of them all but closed: each is told by itself."""
    first = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0.05)]
    second = [(34, 0), (38, 0), (38, 4)]
    found = read_bytes(d.dxf(d.lwpolyline(first, False) + d.lwpolyline(second, False))).findings
    assert [f.code for f in found] == ["open-outline"] * 2
    assert "50 µm" in found[0].message
    assert all((f.x_mm < 10) == (f.other_mm[0] < 10) for f in found)


def test_pieces_of_one_part_are_paired_over_a_gap(read_bytes: Reader) -> None:
    halves = d.lwpolyline([(0, 0), (4, 0), (4, 4)], False) + d.lwpolyline([(0, 0.2), (0, 4), (3.9, 4)], False)
    found = read_bytes(d.dxf(halves)).findings
    assert sorted(round(math.dist((f.x_mm, f.y_mm), f.other_mm), 3) for f in found) == [0.1, 0.2]


def test_a_piece_without_length_hides_the_curvature_at_its_two_ends_only() -> None:
    """Elsewhere it is that of the circle, 1 / r."""
    angles = np.linspace(0.0, math.tau, 25)
    corners = 2e-3 * np.column_stack((np.cos(angles), np.sin(angles)))
    ways = np.diff(np.insert(corners, 10, corners[10], axis=0), axis=0)
    found = curvatures(ways)
    assert np.flatnonzero(np.isnan(found)).tolist() == [9, 10]
    assert np.delete(found, [9, 10]) == pytest.approx(500.0, rel=1e-9)


def row_of_radii(radii: list[float]) -> Loop:
    """Pieces of 0.1 rad each, open: at corner k they lie on a circle of radius k (m), which turns left."""
    points = [0.0j, complex(0.1 * radii[0])]
    for radius in radii:
        way = points[-1] - points[-2]
        half = 0.5 * abs(way)
        centre = points[-2] + 0.5 * way + 1j * way / abs(way) * math.sqrt(radius * radius - half * half)
        points.append(centre + (points[-1] - centre) * complex(math.cos(0.1), math.sin(0.1)))
    edges = [Line(a.real, a.imag, b.real, b.imag) for a, b in pairwise(points)]
    return Loop(tuple(edges), "0", closed=False)


@pytest.mark.parametrize(("difference", "is_arc"), [(0.0, True), (0.019, True), (0.022, False)])
@pytest.mark.parametrize("order", [1, -1])
def test_radii_within_two_percent_make_an_arc(difference: float, is_arc: bool, order: int) -> None:
    radii = [2e-3 * (1.0 - difference * k / 10) for k in range(11)][::order]
    (finding,) = facets([row_of_radii(radii)])
    curve = "an arc of radius" if is_arc else "a curve"
    assert f"12 straight pieces stand for {curve} " in finding.message
    assert ("SPLINE" in finding.fix) != is_arc
