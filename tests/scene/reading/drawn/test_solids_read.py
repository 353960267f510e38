"""What do the solids of a body weigh, asked one by one, and what is said of those that cannot be?"""

from __future__ import annotations

import math
from typing import Any

import pytest
from made_scenes import square

from watchsim.drawing.findings import Finding
from watchsim.geometry.hairspring import Spiral
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line, Point
from watchsim.scene.errors import Faults
from watchsim.scene.keys import BODY
from watchsim.scene.outlines import Outlines
from watchsim.scene.read_solids import read_solids
from watchsim.scene.solids import Solid
from watchsim.scene.values import Table

PIVOT = (3e-3, -4e-3)
SHEET: dict[str, Any] = {"thickness": "0.2 mm", "density": "8 g/cm³"}
WIRE: dict[str, Any] = {"hairspring": True, **SHEET, "width": "0.05 mm"}
COIL: dict[str, Any] = {**WIRE, "inner": "0.6 mm", "outer": "2.6 mm", "turns": 10}
PAPER = 8000.0 * 0.2e-3  # kg/m²
ARC = Loop((Arc(0.0, 0.0, 2e-3, 0.5, 1.0),), "BOW", closed=False)
LINES = {
    "AXIS": [(0.0, 6e-3, 3e-3, 10e-3)],
    "TWO": [(0.0, 0.0, 1e-3, 0.0), (5e-3, 0.0, 6e-3, 0.0)],
    "STRIP": [(1e-3, 2e-3, 4e-3, 2e-3)],
}
CHAINS = tuple(Loop((Line(*line),), layer, closed=False) for layer, lines in LINES.items() for line in lines)
BENT = Loop((Line(0.0, 0.0, 1e-3, 0.0), Line(1e-3, 0.0, 1e-3, 1e-3)), "BENT", closed=False)


def outlines(pivot: Point | None = PIVOT, **more: Any) -> Outlines:
    rest = (square(0.4e-3, (7e-3, 1e-3), "PIN"), square(0.2e-3, (1e-3, 9e-3), "HALF"))
    return Outlines((square(2e-3, (5e-3, 1e-3), "PLATE"),), rest, pivot, chains=(*CHAINS, ARC, BENT), **more)


def solids(*entries: Any, made: Outlines | None = None) -> tuple[tuple[Solid, ...], list[str]]:
    table = Table({"solids": list(entries)}, "a", BODY, Faults())
    found = read_solids(table, made or outlines())
    return found, [f"{fault.key.removeprefix('a.solids.')}{fault.shown}: {fault.message}" for fault in table.faults.found]


def one(entry: dict[str, Any], made: Outlines | None = None) -> Solid:
    (found,), said = solids(entry, made=made)
    assert not said
    return found


@pytest.mark.parametrize(("pivot", "middle"), [(PIVOT, PIVOT), (None, (0.0, 0.0))])
def test_copies_are_spread_about_the_pivot_or_the_origin(pivot: Point | None, middle: Point) -> None:
    found = one({"layer": "PIN", "count": 3, **SHEET}, outlines(pivot))
    mass, away = PAPER * 0.16e-6, math.dist(middle, (7e-3, 1e-3))
    assert found.weight.mass == pytest.approx(3 * mass, rel=1e-12, abs=0.0) and found.weight.centre == middle == found.pivot
    assert found.weight.inertia == pytest.approx(3 * mass * (0.16e-6 / 6.0 + away**2), rel=1e-12, abs=0.0)
    assert (found.kind, found.count, found.thickness, found.density, found.layer) == ("plate", 3, 2e-4, 8000.0, "PIN")


def test_a_plate_without_a_layer_is_all_that_touches() -> None:
    found = one(SHEET)
    assert found.weight.mass == pytest.approx(PAPER * 4e-6, rel=1e-12) and found.weight.centre == pytest.approx((5e-3, 1e-3))
    assert found.weight.inertia == pytest.approx(PAPER * 4e-6 * 4e-6 / 6.0, rel=1e-12, abs=0.0)
    assert (found.count, found.layer, found.bores, found.width) == (1, "", (), 0.0)


def test_what_can_touch_is_drawn_once() -> None:
    assert solids({"layer": "PLATE", "count": 2, **SHEET})[1][0].startswith("0.count = 2: this layer can touch")
    assert not solids({"layer": "PLATE", "count": 1, **SHEET})[1]


@pytest.mark.parametrize("axis", ["AXIS", [["0 mm", "6 mm"], ["6 mm", "14 mm"]]])
def test_a_turned_part_stands_on_the_pivot_or_lies(axis: Any) -> None:
    """A ring of square section, turned about a line through (0, 6) mm with the slope 4/3: by Pappus and Steiner."""
    found = one({"layer": "HALF", "turned": axis, "density": "8 g/cm³"})
    away = abs((1e-3 * 0.8) - (3e-3 * 0.6))  # of its middle (1, 9) mm from the axis
    area, own = 0.04e-6, 0.04e-6**2 / 12.0
    mass = 8000.0 * math.tau * away * area
    assert found.weight.mass == pytest.approx(mass, rel=1e-12, abs=0.0) and found.weight.centre == PIVOT
    assert found.weight.inertia == pytest.approx(8000.0 * math.tau * (away**3 * area + 3.0 * away * own), rel=1e-9, abs=0.0)
    lying = one({"layer": "HALF", "turned": axis, "lying": True, "density": "8 g/cm³"})
    along = (1e-3 * 0.6) + (3e-3 * 0.8)
    assert lying.weight.mass == pytest.approx(mass, rel=1e-12, abs=0.0)
    assert lying.weight.centre == pytest.approx((0.6 * along, 6e-3 + 0.8 * along), rel=1e-9)
    assert (found.kind, lying.kind, lying.thickness) == ("upright", "lying", 0.0)
    assert lying.axis[0] == (0.0, 6e-3) and lying.axis[1] == pytest.approx((0.6, 0.8))


@pytest.mark.parametrize("pivot", [PIVOT, None])
def test_a_third_of_a_spiral_counts_about_the_pivot(pivot: Point | None) -> None:
    found, spiral = one(COIL, outlines(pivot)), Spiral(0.6e-3, 2.6e-3, 10.0)
    mass = PAPER * 0.05e-3 * spiral.length / 3.0
    assert found.weight.mass == pytest.approx(mass, rel=1e-12, abs=0.0) and found.weight.centre == (pivot or (0.0, 0.0))
    radii = [0.6e-3 + 2e-3 * (k + 0.5) / 4000 for k in range(4000)]
    second = sum(r**3 for r in radii) / sum(radii)  # the longer coils outside count more
    assert found.weight.inertia == pytest.approx(mass * second, rel=2e-3, abs=0.0)
    assert (found.width, found.spiral, found.loops) == (pytest.approx(5e-5), spiral, ())
    given = one({**{key: value for key, value in COIL.items() if key != "turns"}, "length": f"{spiral.length!r} m"})
    assert given.spiral is not None and given.spiral.turns == pytest.approx(10.0, rel=1e-9)


def test_a_third_of_a_drawn_strip_counts_about_the_pivot() -> None:
    found = one({**WIRE, "layer": "STRIP"})
    mass = PAPER * 0.05e-3 * 3e-3 / 3.0
    steiner = math.dist(PIVOT, (2.5e-3, 2e-3)) ** 2
    assert found.weight.mass == pytest.approx(mass, rel=1e-12, abs=0.0) and found.weight.centre == PIVOT and found.width == 5e-5
    assert found.weight.inertia == pytest.approx(mass * ((9e-6 + 2.5e-9) / 12.0 + steiner), rel=1e-9, abs=0.0)
    closed = one({"layer": "PIN", **{key: value for key, value in WIRE.items() if key != "width"}})
    assert closed.weight.mass == pytest.approx(PAPER * 0.16e-6 / 3.0, rel=1e-12, abs=0.0) and closed.width == 0.0
    assert closed.weight.inertia == pytest.approx(
        closed.weight.mass * (0.16e-6 / 6.0 + math.dist(PIVOT, (7e-3, 1e-3)) ** 2), rel=1e-12, abs=0.0
    )


TURNED = {"layer": "HALF", "density": "8 g/cm³"}
REFUSED: list[tuple[Any, list[str]]] = [
    (3, ["0 = 3: a table of keys is needed here"]),
    ([1], ["0 = [1]: a table of keys is needed here"]),
    ({**SHEET, "hairspring": "yes"}, ['0.hairspring = "yes": true or false']),
    (
        {"layer": "NONE", **SHEET},
        ['0.layer = "NONE": no closed outline is on this layer. There are closed outlines on: PLATE, PIN, HALF'],
    ),
    ({"layer": "TORN", **SHEET}, ['0.layer = "TORN": it is open. Close it.']),
    ({"thickness": "1 mm"}, ['0: density is missing. Write e.g. density = "7.85 g/cm³"']),
    ({"density": "8 g/cm³"}, ['0: thickness is missing. Write e.g. thickness = "0.12 mm"']),
    ({**SHEET, "thickness": "0 mm"}, ['0.thickness = "0 mm": must be above zero: it is the height of the plate']),
    ({**SHEET, "density": "0 g/cm³"}, ['0.density = "0 g/cm³": must be above zero: steel has']),
    ({**SHEET, "layer": "PIN", "count": 1.5}, ["0.count = 1.5: a whole number from 1 to 1000"]),
    ({**SHEET, "layer": "PIN", "count": "x"}, ['0.count = "x": ']),
    ({**SHEET, "lying": True}, ["0.lying = true: belongs to a turned solid"]),
    ({**COIL, "bores": ["X"]}, ['0.bores = ["X"]: belongs to a plate: a hairspring has none']),
    ({**TURNED, "turned": "AXIS", "bores": []}, ["0.bores = []: belongs to a plate: those of a turned solid"]),
    ({**TURNED, "turned": "AXIS", "thickness": "1 mm"}, ['0.thickness = "1 mm": a turned solid has its size']),
    ({**TURNED, "turned": "AXIS", "count": 2}, ["0.count = 2: it stands on the pivot, where there is room for one"]),
    ({**TURNED, "turned": "TWO"}, ['0.turned = "TWO": 2 straight lines are on this layer']),
    ({**TURNED, "turned": "BOW"}, ['0.turned = "BOW": no straight line by itself is']),
    ({**TURNED, "turned": "BENT"}, ['0.turned = "BENT": no straight line by itself is']),
    ({**TURNED, "turned": [["0 mm", "0 mm"]]}, ["0.turned = "]),
    ({**TURNED, "turned": [["0 mm", "0 mm"], ["0 mm", "0 mm"]]}, ["0.turned: its two points are the same"]),
    ({"turned": "AXIS", "density": "8 g/cm³"}, ["0: layer is missing: on which one"]),
    ({**COIL, "count": 2}, ["0.count = 2: a body has as many hairsprings as entries"]),
    ({**COIL, "length": "3 mm"}, ["0.length: turns or length: both are given"]),
    ({**WIRE, "inner": "0.6 mm", "outer": "2.6 mm"}, ["0: turns or length: missing"]),
    ({**COIL, "outer": "0.6 mm"}, ['0.outer = "0.6 mm": must be larger than inner']),
    ({**COIL, "width": "0.2 mm"}, ['0.width = "0.2 mm": there are only 0.2 mm of room']),
    ({**COIL, "inner": "0.02 mm"}, ['0.width = "0.05 mm": there are only 0.04 mm of room']),
    ({**WIRE, "layer": "TWO"}, ['0.layer = "TWO": 2 separate lines are on this layer']),
    ({**WIRE, "layer": "NONE"}, ['0.layer = "NONE": nothing is on this layer']),
    (
        {**WIRE, "layer": "PIN"},
        [
            "0.width = ",
        ],
    ),
    (
        {**WIRE, "layer": "STRIP", "inner": "1 mm", "turns": 3},
        ['0.inner = "1 mm": the hairspring is drawn', "0.turns = 3: the hairspring is"],
    ),
    ({**WIRE, "turned": "AXIS", "layer": "HALF"}, ["0.turned: a solid is a hairspring or turned", "0.thickness = "]),
    (
        {**SHEET, "width": "1 mm", "turns": 3},
        ["0.turns = 3: turns, width belong to a hairspring"],
    ),
]


@pytest.mark.parametrize(("entry", "expected"), REFUSED)
def test_what_cannot_be_is_said_with_its_value(entry: Any, expected: list[str]) -> None:
    torn = Finding("open-outline", "error", "it is open.", "Close it.", "TORN")
    found, said = solids(entry, made=outlines(errors=(torn, Finding("gap", "error", "else", "", "OTHER"))))
    assert not found and len(said) == len(expected), said
    assert all(mine.startswith(words) for mine, words in zip(said, expected, strict=True)), said


@pytest.mark.parametrize("entry", [{"layer": "NONE", **SHEET}, {**TURNED, "turned": "TWO"}, {**WIRE, "layer": "TWO"}])
def test_after_a_fault_of_the_drawing_layers_are_not_asked_for(entry: Any) -> None:
    assert solids(entry, made=outlines(sound=False)) == ((), [])
    assert solids(SHEET, made=Outlines(sound=False)) == ((), [])
    assert solids(SHEET, made=Outlines())[1] == [
        '0: the body has no closed outline to be a plate. Write layer = "..." or draw one'
    ]


def test_the_others_are_read_after_a_fault() -> None:
    found, said = solids({"density": "8 g/cm³"}, SHEET, 5, {"layer": "PIN", **SHEET})
    assert [solid.layer for solid in found] == ["", "PIN"] and {fault[0] for fault in said} == {"0", "2"}
