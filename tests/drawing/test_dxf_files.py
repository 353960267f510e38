"""Is one drawing the same in every version of the format, as text and binary, written and measured by ezdxf?"""

import io
import math
import os
import struct
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import dxf_text as d
import ezdxf
import numpy as np
import pytest
from every_time import few
from ezdxf.disassemble import recursive_decompose
from ezdxf.document import Drawing as EzDrawing
from hypothesis import HealthCheck, given, settings
from made_outlines import compare, parts, same_edge
from scipy import constants as c

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import INSUNITS
from watchsim.drawing.read import read
from watchsim.drawing.write import Sheet, dxf_text
from watchsim.geometry.loops import Loop, extents, total_length
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.solids import section

Reader = Callable[..., Drawing]
VERSIONS = ("R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018")
NORMALS = ((0.0, 0.0, 1.0), (0.0, 0.0, -1.0))
FINE = 2e-6  # mm: distance of ezdxf's polygons


def content(version: str) -> EzDrawing:
    """Every entity that this version knows, plain and in blocks: nested, arrayed, turned, mirrored, scaled unequally."""
    doc = ezdxf.new(version, units=4)
    inner, outer = doc.blocks.new("INNER", base_point=(1, 2)), doc.blocks.new("OUTER")
    for k, space in enumerate((doc.modelspace(), inner)):
        shift = 30.0 * k
        space.add_line((shift, 0), (shift + 3, 1))
        space.add_circle((shift + 5, 1), 0.7)
        for normal in NORMALS:
            space.add_arc((shift + 8, 2), 1.5, 20, 250, dxfattribs={"extrusion": normal})
        for normal in NORMALS:
            space.add_polyline2d(
                [(0, 4, 0.5), (3, 4, -0.3), (3, 6, 0), (0, 6, 1.2)], format="xyb", close=True
            ).dxf.extrusion = normal
        space.add_polyline3d([(0, 8, 0), (1, 9, 0), (2, 8, 0)])
        if version != "R12":
            for normal in NORMALS:
                row = space.add_lwpolyline([(5, 4, 0.4), (8, 4, -2.0), (8, 6, 0)], format="xyb", close=k == 0)
                row.dxf.extrusion, row.dxf.elevation = normal, 0.0
                space.add_ellipse((shift + 5, 8), (2, 1), 0.4, 0.3, 5.0, dxfattribs={"extrusion": normal})
            space.add_spline(degree=3).set_open_rational([(2 * x, 10 + x % 2, 0) for x in range(5)], [1, 2, 0.7, 1, 1])
            space.add_spline(degree=3).set_closed([(12, 10, 0), (14, 12, 0), (16, 10, 0), (14, 8, 0)])
    outer.add_blockref("INNER", (3, 1), dxfattribs={"rotation": 30, "xscale": -1.0, "yscale": 1.0})
    outer.add_blockref("INNER", (0, 50), dxfattribs={"rotation": 200, "xscale": 0.5, "yscale": 1.5, "zscale": 0.25})
    model = doc.modelspace()
    if version != "R12":
        model.add_spline([(20, 10), (21, 12), (23, 11), (24, 13)])  # in blocks ezdxf scales the points, not the curve
    model.add_blockref("OUTER", (0, 40), dxfattribs={"xscale": 2.0, "yscale": -2.0, "rotation": -70})
    grid = {"column_count": 2, "row_count": 1, "column_spacing": 80.0, "row_spacing": 90.0, "rotation": 15}
    model.add_blockref("INNER", (0, 200), dxfattribs=grid)
    return doc


def written(doc: EzDrawing, binary: bool) -> bytes:
    if binary:
        stream = io.BytesIO()
        doc.write(stream, fmt="bin")
        return stream.getvalue()
    text = io.StringIO()
    doc.write(text)
    return doc.encode(text.getvalue())


def polygons(doc: EzDrawing) -> Iterable[np.ndarray]:
    """What ezdxf makes of the same drawing, blocks unfolded by it: points (n, 2) in mm."""
    for entity in recursive_decompose(doc.modelspace()):
        kind = entity.dxftype()
        if kind == "LINE":
            yield np.array([entity.dxf.start, entity.dxf.end])[:, :2]
        elif kind in ("LWPOLYLINE", "POLYLINE") and (kind == "LWPOLYLINE" or entity.is_2d_polyline):
            for part in entity.virtual_entities():
                yield np.array([part.dxf.start, part.dxf.end])[:, :2] if part.dxftype() == "LINE" else flat(part)
        elif kind == "POLYLINE":
            yield np.array([tuple(p) for p in entity.points()])[:, :2]
        elif kind == "SPLINE" and entity.control_points:
            yield de_boor(entity)  # ezdxf flattens unclamped splines beyond their ends
        else:
            yield flat(entity)


def de_boor(entity: Any) -> np.ndarray:
    """Points along a SPLINE by de Boor's triangle in homogeneous coordinates."""
    degree, knots = entity.dxf.degree, np.array(entity.knots)
    weights = np.array(entity.weights if len(entity.weights) else [1.0] * len(entity.control_points))
    points = np.column_stack((np.array(list(entity.control_points))[:, :2] * weights[:, None], weights))
    rows = []
    for k in range(degree, len(points)):
        if knots[k + 1] > knots[k]:
            t = np.linspace(knots[k], knots[k + 1], 400)[:, None]
            level = [points[j] + 0.0 * t for j in range(k - degree, k + 1)]
            for r in range(1, degree + 1):
                for j in range(degree, r - 1, -1):
                    low, high = knots[j + k - degree], knots[j + 1 + k - r]
                    a = (t - low) / (high - low)
                    level[j] = (1.0 - a) * level[j - 1] + a * level[j]
            rows.append(level[degree])
    row = np.concatenate(rows)
    return row[:, :2] / row[:, 2:]


def flat(entity: Any) -> np.ndarray:
    return np.array([tuple(p) for p in entity.flattening(FINE)])[:, :2]


@pytest.mark.parametrize("binary", [False, True], ids=["text", "binary"])
@pytest.mark.parametrize("version", few(VERSIONS, lambda version: version in ("R12", "R2000", "R2018")))
def test_every_version_is_the_drawing_that_ezdxf_wrote(read_bytes: Reader, version: str, binary: bool) -> None:
    doc = content(version)
    drawing = read_bytes(written(doc, binary), fit=3e-8)
    assert not [
        f for f in drawing.findings if f.code in ("damaged", "truncated", "trash", "strange-group", "ignored", "tilted")
    ]
    assert drawing.units == (None if version == "R12" else "mm")  # ezdxf writes no $INSUNITS there
    rows = list(polygons(doc))
    length = math.fsum(float(np.sum(np.hypot(*np.diff(row, axis=0).T))) for row in rows)
    assert 1e3 * drawing.drawn.length == pytest.approx(length, rel=2e-6)
    points = np.concatenate(rows)
    box = extents((*drawing.loops, *drawing.open_chains))
    assert box is not None
    assert [1e3 * side for side in box] == pytest.approx([*points.min(axis=0), *points.max(axis=0)], abs=5e-5)


def test_all_versions_have_the_same_outlines(read_bytes: Reader) -> None:
    """From R2000 on nothing but the clothing changes: equal to the last digit but rounding of the written decimals."""
    drawings = [read_bytes(written(content(version), binary)) for version in ("R2000", "R2018") for binary in (False, True)]
    for other in drawings[1:]:
        assert other.drawn.kinds == drawings[0].drawn.kinds
        assert other.drawn.length == pytest.approx(drawings[0].drawn.length, rel=1e-12)


@pytest.mark.parametrize("version", ["AC1006", "AC1004", "AC1003", "AC1002"])
def test_old_versions_down_to_release_2(read_bytes: Reader, version: str) -> None:
    """R10 and older have no handles, no OBJECTS and the same entities as R12."""
    entities = d.line((0, 0), (1, 0)) + d.arc(1, 1, 1, 270, 90) + d.line((1, 2), (0, 0))
    head = f"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\n{version}\n0\nENDSEC\n"
    drawing = read_bytes((head + d.dxf(entities, units=None).decode()).encode(), units="mm")
    assert len(drawing.loops) == 1 and not drawing.findings
    assert total_length(drawing.loops) == pytest.approx(1e-3 * (1 + math.pi + math.sqrt(5)), rel=1e-14)


def binary_release_12(entities: list[tuple[int, object]]) -> bytes:
    """Group codes of one byte, as programs before R13 write them; codes from 255 on follow a byte 255."""
    data = b"AutoCAD Binary DXF\r\n\x1a\x00"
    for code, value in entities:
        data += bytes([code]) if code < 255 else b"\xff" + struct.pack("<H", code)
        if isinstance(value, str):
            data += value.encode() + b"\0"
        else:
            data += struct.pack("<d", value) if isinstance(value, float) else struct.pack("<h", value)
    return data


def test_binary_with_codes_of_one_byte(read_bytes: Reader) -> None:
    tags: list[tuple[int, object]] = [(0, "SECTION"), (2, "HEADER"), (9, "$INSUNITS"), (70, 1), (0, "ENDSEC")]
    tags += [(0, "SECTION"), (2, "ENTITIES"), (0, "CIRCLE"), (8, "0"), (10, 1.5), (20, -2.0), (30, 0.0), (40, 0.25)]
    tags += [(0, "ENDSEC"), (0, "EOF")]
    drawing = read_bytes(binary_release_12(tags))
    ((edge,),) = [loop.edges for loop in drawing.loops]
    assert (edge.x, edge.y, edge.radius) == pytest.approx((1.5 * 0.0254, -2 * 0.0254, 0.25 * 0.0254), rel=1e-15)
    assert drawing.units == "inch" and not drawing.findings


@pytest.mark.parametrize("code", range(25))
def test_every_code_of_insunits(read_bytes: Reader, code: int) -> None:
    """Lengths from scipy's table of constants."""
    metres = (
        *(math.nan, c.inch, c.foot, c.mile, c.milli, c.centi, 1.0, c.kilo, c.micro * c.inch, c.mil, c.yard, c.angstrom, c.nano),
        *(c.micro, c.deci, c.deka, c.hecto, c.giga, c.au, c.light_year, c.parsec, c.survey_foot, c.survey_foot / 12),
        *(3 * c.survey_foot, c.survey_mile),
    )
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1), units=code))
    if code == 0:
        assert drawing.units is None and any(f.code == "units-missing" for f in drawing.findings)
        return
    ((edge,),) = [loop.edges for loop in drawing.loops]
    assert drawing.units == INSUNITS[code][0]
    assert edge.radius == pytest.approx(metres[code], rel=1e-12, abs=0.0)


def stripped(data: bytes, *codes: int) -> bytes:
    """The file without all tags of those codes."""
    lines = data.decode().splitlines()
    pairs = zip(lines[::2], lines[1::2], strict=False)
    return "".join(f"{code}\n{value}\n" for code, value in pairs if int(code) not in codes).encode()


def test_without_subclass_markers_handles_and_owners(read_bytes: Reader) -> None:
    data = written(content("R2000"), False)
    bare = read_bytes(stripped(data, 100, 5, 330, 360, 102, 105))
    whole = read_bytes(data)
    assert bare.drawn == whole.drawn and len(bare.loops) == len(whole.loops)


def test_entities_only(read_bytes: Reader) -> None:
    data = written(content("R12"), False).decode()
    start = data.index("  0\nSECTION\n  2\nENTITIES")
    bare = read_bytes(data[start:].encode(), units="mm")
    missing = {f.message for f in bare.findings if f.code == "block-missing"}
    assert missing and bare.drawn.kinds["line"] >= 1


def test_paper_space_and_hidden_layers_from_ezdxf(read_bytes: Reader) -> None:
    doc = ezdxf.new("R2010", units=4)
    doc.layers.add("OFF").off()
    doc.layers.add("COLD").freeze()
    doc.modelspace().add_circle((0, 0), 1)
    doc.modelspace().add_circle((0, 0), 2, dxfattribs={"layer": "OFF"})
    doc.modelspace().add_circle((0, 0), 3, dxfattribs={"layer": "COLD"})
    doc.layout("Layout1").add_circle((0, 0), 4)
    drawing = read_bytes(written(doc, False))
    assert [loop.edges[0].radius for loop in drawing.loops] == [1e-3]
    said = {f.code: f.message for f in drawing.findings}
    assert "paper space" in said["paper-space"] and "layer-off" in said


@pytest.mark.parametrize("scales", [(1, 1, 0), (0.5, 2, 0), (-1, 1, 0)])
def test_insert_with_no_height(read_bytes: Reader, scales: tuple[float, float, float]) -> None:
    """Old LibreCAD writes a z-scale of 0; the drawing plane does not care."""
    block = d.block("B", d.circle(1, 0, 1))
    entity = d.insert("B", (0, 0), (41, scales[0]), (42, scales[1]), (43, scales[2]))
    drawing = read_bytes(d.dxf(entity, blocks=block))
    box = extents(drawing.loops)
    assert box is not None
    low, high = sorted((0.0, 2e-3 * scales[0]))
    assert box == pytest.approx((low, -1e-3 * abs(scales[1]), high, 1e-3 * abs(scales[1])), abs=1e-9)


def test_nested_unequal_scales_shear(read_bytes: Reader) -> None:
    """A turned block in an unequally scaled one: the corners by matrices. (ezdxf cannot express it.)"""
    corners = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 2.0)]
    inner = d.block("IN", d.polygon(corners), base=(1.0, 2.0))
    outer = d.block("OUT", d.insert("IN", (3, 1), (41, -1.0), (50, 30.0)))
    drawing = read_bytes(d.dxf(d.insert("OUT", (0, 40), (41, 2.0), (42, -0.5), (50, -70.0)), blocks=inner + outer))

    def turn(degrees: float) -> np.ndarray:
        a = math.radians(degrees)
        return np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])

    local = (np.array(corners) - (1, 2)) @ (turn(30) @ np.diag([-1.0, 1.0])).T + (3, 1)
    true = 1e-3 * (local @ (turn(-70) @ np.diag([2.0, -0.5])).T + (0, 40))
    (loop,) = drawing.loops
    assert np.array(sorted(edge.start for edge in loop.edges)) == pytest.approx(np.array(sorted(map(tuple, true))), abs=1e-15)


def test_truncated_anywhere_is_an_error(tmp_path: Path) -> None:
    for binary in (False, True):
        data = written(content("R12"), binary)
        for cut in range(len(data) // 2, len(data) - 20, len(data) // 23):
            path = tmp_path / "cut.dxf"
            path.write_bytes(data[:cut])
            assert any(f.severity == "error" for f in read(path, units="mm").findings), (binary, cut)


# DXF reference, HEADER section, $INSUNITS; in metres from their definitions.
REFERENCE = {
    **{1: 25.4e-3, 2: 12 * 25.4e-3, 3: 63360 * 25.4e-3, 4: 1e-3, 5: 1e-2, 6: 1.0, 7: 1e3, 8: 25.4e-9, 9: 25.4e-6},
    **{10: 36 * 25.4e-3, 11: 1e-10, 12: 1e-9, 13: 1e-6, 14: 0.1, 15: 10.0, 16: 100.0, 17: 1e9, 18: 149597870700.0},
    **{19: 299792458.0 * 365.25 * 86400.0, 20: 149597870700.0 * 648000.0 / 3.141592653589793, 21: 1200.0 / 3937.0},
    **{22: 100.0 / 3937.0, 23: 3600.0 / 3937.0, 24: 5280.0 * 1200.0 / 3937.0},
}


@pytest.mark.parametrize("code", REFERENCE)
def test_every_code_has_its_length(code: int) -> None:
    assert INSUNITS[code][1] == pytest.approx(REFERENCE[code], rel=1e-15, abs=0.0)


def test_there_is_no_other() -> None:
    assert set(INSUNITS) == set(REFERENCE)


def test_a_unit_that_cannot_be_read_is_none(tmp_path: Path) -> None:
    """Said as an error; not taken for inches, nor for what the next file says."""
    path = tmp_path / "damaged.dxf"
    entities = f"0\nSECTION\n2\nENTITIES\n{d.circle(0.0, 0.0, 1.0)}0\nENDSEC\n0\nEOF\n"
    path.write_text(d.header(4).replace("70\n4", "70\nfour") + entities)
    drawing = read(path)
    assert drawing.units is None
    assert any("$INSUNITS" in finding.message for finding in drawing.findings if finding.severity == "error")


ROOT = Path(__file__).resolve().parents[2]


def read_back(text: str, folder: Path):
    path = folder / "again.dxf"
    path.write_text(text, encoding="utf-8")
    return read(path)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(parts())
def test_random_outlines_come_back_the_same(tmp_path: Path, loops: tuple[Loop, ...]) -> None:
    again = read_back(dxf_text(loops), tmp_path)
    assert again.units == "mm" and again.units_from == "header" and not again.findings
    compare(loops, again.loops)


@pytest.mark.parametrize("name", ["escape_wheel", "lever", "roller", "banking"])
def test_real_outlines_come_back_the_same(name: str, tmp_path: Path) -> None:
    drawing = read(ROOT / "profiles" / "swiss_lever" / f"{name}.dxf")
    again = read_back(dxf_text(drawing.loops, [("PIVOT", (0.0, 0.0))]), tmp_path)
    compare(drawing.loops, again.loops)
    assert again.points == (("PIVOT", 0.0, 0.0),)


def test_what_is_written_is_what_cad_expects(tmp_path: Path) -> None:
    """Read by ezdxf itself, audited, with entities of the right kinds on their layers."""
    square = Loop(tuple(Line(*a, *b) for a, b in [((0, 0), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 0))]), "PLATE")
    slot = Loop((Line(2, 0, 3, 0), Arc(3, 0.5, 0.5, -math.pi / 2, math.pi), Line(3, 1, 2, 1), Line(2, 1, 2, 0)), "SLOT:1")
    disc, line = Loop((Arc(5, 5, 1, 0, TURN),), "DISC"), Loop((Line(0, -1, 1, -1),), "LINE", closed=False)
    path = tmp_path / "out.dxf"
    path.write_text(dxf_text((square, slot, disc, line), colours={"PLATE": "#dcb862"}), encoding="utf-8")
    document = ezdxf.readfile(path)
    assert not document.audit().errors
    assert document.dxfversion == "AC1024" and document.header["$INSUNITS"] == 4
    kinds = [(entity.dxftype(), entity.dxf.layer) for entity in document.modelspace()]
    assert kinds == [
        ("LWPOLYLINE", "PLATE"),
        ("LINE", "SLOT_1"),
        ("ARC", "SLOT_1"),
        *[("LINE", "SLOT_1")] * 2,
        ("CIRCLE", "DISC"),
        ("LINE", "LINE"),
    ]
    assert document.layers.get("PLATE").rgb == (0xDC, 0xB8, 0x62)


def test_loops_that_touch_stay_two_loops(tmp_path: Path) -> None:
    """Two half discs that share a corner: as single edges nobody could tell which belong together."""
    left = Loop((Arc(-1e-3, 0.0, 1e-3, 0.0, math.pi), Line(-2e-3, 0.0, 0.0, 0.0)), "A")
    right = Loop((Arc(1e-3, 0.0, 1e-3, 0.0, math.pi), Line(0.0, 0.0, 2e-3, 0.0)), "A")
    again = read_back(dxf_text((left, right)), tmp_path)
    assert len(again.loops) == 2 and not [f for f in again.findings if f.severity == "error"]
    assert section(again.loops).area == pytest.approx(math.pi * 1e-6, rel=1e-12)


def test_the_same_outlines_give_the_same_bytes() -> None:
    disc = Loop((Arc(0.0, 0.0, 1e-3, 0.0, TURN),), "A")
    assert dxf_text((disc,)) == dxf_text((disc,))


def test_open_chains_stay_open(tmp_path: Path) -> None:
    chain = Loop((Line(0.0, 0.0, 1e-3, 0.0), Arc(1e-3, 1e-3, 1e-3, -math.pi / 2, 1.0)), "FACE", closed=False)
    (again,) = read_back(dxf_text((chain,)), tmp_path).open_chains
    assert all(same_edge(a, b, 1e-15) for a, b in zip(chain.edges, again.edges, strict=True))


@pytest.mark.parametrize("sweep", [2.0, -2.0, 5.0, -5.0])
def test_a_made_sheet_holds_arcs_of_either_sense(tmp_path: Path, sweep: float) -> None:
    """Arcs of the format run anticlockwise only: the outline read is the one that was put in."""
    arc = Arc(1.0, 2.0, 3.0, 0.3, sweep)
    path = tmp_path / "sheet.dxf"
    loop = Loop((arc, Line(*arc.end, *arc.start)), layer="part")
    path.write_bytes(Sheet((loop,), None).dxf())
    (drawn,) = ezdxf.readfile(path).modelspace().query("ARC")
    assert drawn.dxf.center.isclose((1.0, 2.0, 0.0))
    (again,) = read(path).loops
    (turned,) = [edge for edge in again.edges if isinstance(edge, Arc)]
    ends = np.array(sorted([arc.start, arc.end]))
    assert np.array(sorted([turned.start, turned.end])) == pytest.approx(1e-3 * ends)
    assert abs(turned.sweep) == pytest.approx(abs(sweep))
    assert turned.point(0.5) == pytest.approx(tuple(1e-3 * np.array(arc.point(0.5))))


WRITTEN = """
from watchsim.drawing.write import dxf_text
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc
print(dxf_text([Loop((Arc(0.0, 0.0, 1e-3, 0.0, 6.283185307179586),), "RIM")]))
"""


def test_another_process_writes_the_same_bytes() -> None:
    """Whatever the order of its sets, which changes with the seed of their hashes."""
    texts = set()
    for seed in "14":
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        texts.add(subprocess.run([sys.executable, "-c", WRITTEN], env=environment, capture_output=True, check=True).stdout)
    assert len(texts) == 1 and b"CIRCLE" in texts.pop()
