"""Is the real watch-size lever read layer by layer as its authors describe it?"""

import json
import math
from pathlib import Path
from typing import Any

import pytest
from strangers import PIN_LEVER, marks

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import read
from watchsim.geometry.loops import Loop, extents
from watchsim.geometry.primitives import Arc, Line
from watchsim.geometry.solids import mass_properties

pytestmark = marks(PIN_LEVER)


@pytest.fixture(scope="module")
def folder() -> Path:
    return PIN_LEVER


@pytest.fixture(scope="module")
def assembly(folder: Path) -> Drawing:
    return read(folder / "siconos_pin_lever_assembly.dxf")


@pytest.fixture(scope="module")
def facts(folder: Path) -> dict[str, Any]:
    return json.loads((folder / "pin_lever.json").read_text())


def loops(drawing: Drawing, layer: str) -> list[Loop]:
    return [loop for loop in drawing.loops if loop.layer == layer]


def test_every_layer_is_closed_and_nothing_is_wrong(assembly: Drawing) -> None:
    assert not assembly.open_chains
    assert [(finding.code, finding.severity) for finding in assembly.findings] == [("ignored", "notice")]
    assert assembly.ignored == {"TEXT": 3}
    assert assembly.units == "mm"
    counts = {layer: len(loops(assembly, layer)) for layer in assembly.layers}
    assert counts == {
        **{"ESCAPE_WHEEL_z-1.30": 5, "LEVER_z-1.20": 1, "PALLET_A": 1, "PALLET_B": 1, "LEVER_z-1.45": 4, "LEVER_z-0.90": 2},
        **{"BALANCE_z-1.10_IMPULSE": 2, "BALANCE_z-1.40": 1, "BALANCE_z-0.80": 1, "BALANCE_RIM_z0.00": 4, "STOP_A": 1},
        **{"STOP_B": 1, "PIVOTS": 0},
    }


def test_pivots_are_points(assembly: Drawing, facts: dict[str, Any]) -> None:
    places = sorted((1e3 * x, 1e3 * y) for layer, x, y in assembly.points if layer == "PIVOTS")
    stated = sorted(facts["pivots_mm"].values())
    assert len(places) == len(stated) == 3
    for place, expected in zip(places, stated, strict=True):
        assert place == pytest.approx(expected, abs=1e-6)


def test_wheel_has_fifteen_teeth_of_the_stated_radii(assembly: Drawing, facts: dict[str, Any]) -> None:
    outline = max(loops(assembly, "ESCAPE_WHEEL_z-1.30"), key=lambda loop: loop.length)
    x, y = facts["pivots_mm"]["escape_wheel"]
    reach = [math.hypot(1e3 * edge.start[0] - x, 1e3 * edge.start[1] - y) for edge in outline.edges]
    assert max(reach) == pytest.approx(facts["wheel_tip_radius_mm"], abs=1e-5)
    assert sum(r > facts["wheel_tip_radius_mm"] - 1e-4 for r in reach) == facts["teeth"]
    radii = {round(1e3 * edge.radius, 5) for edge in outline.edges if isinstance(edge, Arc)}
    assert {round(r, 5) for r in facts["tooth_arc_radii_mm"]} <= radii


def test_guard_pin_and_banking(assembly: Drawing, facts: dict[str, Any]) -> None:
    (stop_b,) = loops(assembly, "STOP_B")
    (pin,) = stop_b.edges
    assert isinstance(pin, Arc)
    assert (1e3 * pin.x, 1e3 * pin.y, 1e3 * pin.radius) == pytest.approx((*facts["banking"]["B"]["centre"], 0.2), abs=1e-6)
    box = min((extents([loop]) for loop in loops(assembly, "LEVER_z-0.90")), key=lambda b: -b[0] if b else 0.0)
    assert box is not None
    assert (500 * (box[0] + box[2]), 500 * (box[1] + box[3])) == pytest.approx(facts["guard_pin"]["centre"], abs=1e-5)


def test_tilted_stop_is_an_ellipse_within_a_tenth_of_a_micrometre(assembly: Drawing, facts: dict[str, Any]) -> None:
    (stop,) = loops(assembly, "STOP_A")
    x, y = facts["banking"]["A"]["centre"]
    assert all(isinstance(edge, Arc) for edge in stop.edges)
    for edge in stop.edges:
        assert math.hypot(1e3 * edge.start[0] - x, 1e3 * edge.start[1] - y) == pytest.approx(0.2, abs=1e-3)
    assert assembly.fitted_deviation <= 1e-7


def test_impulse_pin_is_smooth_arcs_not_two_thousand_facets(assembly: Drawing) -> None:
    pin = min(loops(assembly, "BALANCE_z-1.10_IMPULSE"), key=lambda loop: loop.length)
    assert len(pin.edges) <= 40
    for one, other in zip(pin.edges, [*pin.edges[1:], pin.edges[0]], strict=True):
        assert math.dist(one.end, other.start) < 1e-11
        assert math.dist(one.tangent(1.0), other.tangent(0.0)) < 2e-3


def test_pallets_are_four_lines(assembly: Drawing) -> None:
    for layer in ("PALLET_A", "PALLET_B"):
        (stone,) = loops(assembly, layer)
        assert [type(edge) for edge in stone.edges] == [Line] * 4


@pytest.mark.parametrize(("part", "pivot"), [("wheel", "escape_wheel"), ("lever", "lever")])
def test_single_parts_are_the_same_as_in_the_assembly(folder: Path, assembly: Drawing, part: str, pivot: str) -> None:
    alone = read(folder / f"siconos_pin_lever_{part}.dxf")
    layer = {"wheel": "ESCAPE_WHEEL_z-1.30", "lever": "LEVER_z-1.20"}[part]
    assert not alone.findings
    x, y = (1e-3 * c for c in json.loads((folder / "pin_lever.json").read_text())["pivots_mm"][pivot])
    one, other = (mass_properties(set_of, 1.5e-4, 7750.0) for set_of in (alone.loops, loops(assembly, layer)))
    assert one.mass == pytest.approx(other.mass, rel=1e-9, abs=0)
    assert one.inertia_about((x, y)) == pytest.approx(other.inertia_about((x, y)), rel=1e-9, abs=0)
