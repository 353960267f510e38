"""Does the report use the fixed names, and does the text say what matters?"""

from __future__ import annotations

import json
import math
from collections.abc import Callable

import dxf_text as d
import pytest

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.drawing.inspection import finding_lines, inspect_report, inspect_text
from watchsim.drawing.read import smallness
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc

Reader = Callable[..., Drawing]

TOP = (
    *(
        "file",
        "format",
        "units",
        "units_from",
        "extents_mm",
        "layers",
        "loops",
        "points",
        "fitted",
        "drawn",
        "ignored",
        "findings",
    ),
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
    found = smallness(loops, 1e-6)
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
