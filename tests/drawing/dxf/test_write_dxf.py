"""Is a profile that was written as DXF and read again the same?"""

from __future__ import annotations

import math
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from made_outlines import parts
from same_outlines import compare, same_edge

from watchsim.drawing.read import read
from watchsim.drawing.write import Sheet, dxf_text
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.solids import section

ROOT = Path(__file__).resolve().parents[3]


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
