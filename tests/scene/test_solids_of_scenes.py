"""Are plates, turned parts and hairsprings of a scene as heavy as their formulas say, and is every misuse refused?"""

import json
import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import dxf_text as d
import numpy as np
import pytest
from made_scenes import circle, drawing, square

from watchsim.drawing.findings import Finding
from watchsim.geometry.hairspring import Spiral
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line, Point
from watchsim.mechanism.check import check_report, check_text
from watchsim.mechanism.overlap import overlaps
from watchsim.scene.errors import Faults, SceneError
from watchsim.scene.keys import BODY
from watchsim.scene.load import load
from watchsim.scene.outlines import Outlines
from watchsim.scene.read_solids import read_solids
from watchsim.scene.scene import Scene
from watchsim.scene.solids import HAIRSPRING, LYING, PLATE, UPRIGHT, Solid, Weight, more_seen, total
from watchsim.scene.values import Table

BODY_SOLIDS = '[bodies.balance]\ndrawing = "balance.dxf"\nlayers = ["ROLLER"]\npivot = "PIVOT"\n'
FLAT = 'thickness = "0.2 mm"\ndensity = "8 g/cm³"\n'
HAIRSPRING_SOLIDS = 'hairspring = true\ninner = "0.6 mm"\nouter = "2.6 mm"\nwidth = "0.03 mm"\n' + FLAT
RHO, HEIGHT = 8000.0, 0.2e-3
PIVOT = (2e-3, 1e-3)


def line(layer: str, *points: tuple[float, float]) -> Loop:
    return Loop(tuple(Line(*a, *b) for a, b in pairwise(points)), layer, closed=False)


def rectangle(layer: str, x0: float, y0: float, x1: float, y1: float) -> Loop:
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)), layer)


@pytest.fixture
def balance(desk):
    """A roller; a weight beside it; half a screw at 5 mm and half a staff drawn far away with their axes."""
    x, y = PIVOT
    loops = (
        circle(1.5e-3, PIVOT, "ROLLER"),
        circle(0.3e-3, (x + 4e-3, y), "WEIGHT"),
        rectangle("SCREW", x + 5e-3, y, x + 5.4e-3, y + 0.25e-3),
        rectangle("STAFF", 0.0, 20e-3, 0.4e-3, 24e-3),
    )
    chains = (line("AXIS", (0.0, 19e-3), (0.0, 25e-3)), line("STRIP", (x + 1e-3, y), (x + 2e-3, y), (x + 2e-3, y + 1e-3)))
    layers = ("ROLLER", "WEIGHT", "SCREW", "STAFF", "AXIS", "STRIP", "PIVOT")
    errors = tuple(Finding("open-outline", "error", "it is open", "Close it.", layer) for layer in ("AXIS", "STRIP"))
    desk.put(drawing("balance.dxf", loops, open_chains=chains, layers=layers, findings=errors, points=(("PIVOT", *PIVOT),)))
    return desk


def loaded(desk, *solids: str, body: str = BODY_SOLIDS):
    return load(desk.scene(body + "".join(f"[[bodies.balance.solids]]\n{solid}" for solid in solids)))


def weights(desk, *solids: str):
    return loaded(desk, *solids).body("balance")


def test_layers_of_different_materials_add_up(balance):
    body = weights(balance, 'layer = "ROLLER"\n' + FLAT, 'layer = "WEIGHT"\nthickness = "0.5 mm"\ndensity = "19.3 g/cm³"\n')
    roller, weight = math.pi * 2.25e-6 * HEIGHT * RHO, math.pi * 0.09e-6 * 0.5e-3 * 19300
    assert body.mass == pytest.approx(roller + weight, rel=1e-12)
    assert body.inertia == pytest.approx(roller * 2.25e-6 / 2 + weight * (0.09e-6 / 2 + 16e-6), rel=1e-12, abs=0.0)
    assert body.centre_of_mass == pytest.approx((weight * 4e-3 / (roller + weight), 0.0), rel=1e-12, abs=1e-17)
    assert [solid.kind for solid in body.solids] == ["plate", "plate"]


def test_counted_layers_are_spread_about_the_pivot(balance):
    body = weights(balance, 'layer = "WEIGHT"\ncount = 4\n' + FLAT)
    one = math.pi * 0.09e-6 * HEIGHT * RHO
    assert body.mass == pytest.approx(4 * one, rel=1e-12, abs=0.0)
    assert body.inertia == pytest.approx(4 * one * (0.09e-6 / 2 + 16e-6), rel=1e-12, abs=0.0)
    assert body.centre_of_mass == pytest.approx((0.0, 0.0), abs=1e-17)
    copies = [loop.edges[0] for loop in body.decoration if loop.layer == "WEIGHT"]
    places = {(round(arc.x * 1e3, 9) + 0.0, round(arc.y * 1e3, 9) + 0.0) for arc in copies}
    assert places == {(4.0, 0.0), (0.0, 4.0), (-4.0, 0.0), (0.0, -4.0)}


def test_a_lying_screw_is_a_cylinder_on_its_side(balance):
    screw = 'layer = "SCREW"\nturned = [["2 mm", "1 mm"], ["9 mm", "1 mm"]]\nlying = true\ndensity = "15.5 g/cm³"\ncount = 8\n'
    body = weights(balance, screw)
    r, length, place = 0.25e-3, 0.4e-3, 5.2e-3
    mass = math.pi * r * r * length * 15500
    assert body.mass == pytest.approx(8 * mass, rel=1e-12, abs=0.0)
    assert body.inertia == pytest.approx(8 * mass * ((3 * r * r + length * length) / 12 + place * place), rel=1e-12, abs=0.0)
    assert len([loop for loop in body.decoration if loop.layer == "SCREW"]) == 16  # both halves


def test_a_staff_stands_on_the_pivot_wherever_it_is_drawn(balance):
    staff = 'layer = "STAFF"\nturned = "AXIS"\ndensity = "7.8 g/cm³"\n'
    body = weights(balance, staff)
    mass = math.pi * 0.16e-6 * 4e-3 * 7800
    assert body.mass == pytest.approx(mass, rel=1e-12, abs=0.0)
    assert body.inertia == pytest.approx(mass * 0.16e-6 / 2, rel=1e-12, abs=0.0)
    assert body.centre_of_mass == pytest.approx((0.0, 0.0), abs=1e-17)
    assert "STAFF" not in {loop.layer for loop in (*body.loops, *body.decoration)}


def test_one_third_of_a_hairspring_counts(balance):
    body = weights(balance, "turns = 12\n" + HAIRSPRING_SOLIDS)
    inner, outer = 0.6e-3, 2.6e-3
    mass = RHO * HEIGHT * 0.03e-3 * math.pi * 12 * (inner + outer)  # the hand formula takes the coils as circles
    assert body.mass == pytest.approx(mass / 3, rel=1e-3)
    assert body.inertia == pytest.approx(mass / 3 * (inner**2 + outer**2) / 2, rel=1e-3, abs=0.0)
    length = body.solids[0].spiral.length
    same = weights(balance, f'length = "{length!r} m"\n' + HAIRSPRING_SOLIDS)
    assert (same.mass, same.inertia) == pytest.approx((body.mass, body.inertia), rel=1e-12, abs=0.0)


def test_a_drawn_strip_counts_one_third_too(balance):
    body = weights(balance, 'hairspring = true\nlayer = "STRIP"\nwidth = "0.1 mm"\n' + FLAT)
    bar = RHO * HEIGHT * 1e-4 * 1e-3
    own = bar * (1e-8 + 1e-6) / 12
    assert body.mass == pytest.approx(2 * bar / 3, rel=1e-12, abs=0.0)
    assert body.inertia == pytest.approx((2 * own + bar * 1.5e-3**2 + bar * (4e-6 + 0.25e-6)) / 3, rel=1e-12, abs=0.0)


def test_layers_of_sections_cannot_touch_by_default(balance):
    solids = (
        'layer = "STAFF"\nturned = "AXIS"\ndensity = "7.8 g/cm³"\n',
        'hairspring = true\nlayer = "STRIP"\nwidth = "0.1 mm"\n' + FLAT,
    )
    body = loaded(balance, *solids, body=BODY_SOLIDS.replace('layers = ["ROLLER"]\n', "")).body("balance")
    assert body.layers == ("ROLLER", "WEIGHT", "SCREW")


def test_a_free_body_has_its_copies_about_the_point_they_were_drawn_around(balance):
    free = BODY_SOLIDS.replace('pivot = "PIVOT"\n', 'motion = "free"\n')
    body = loaded(balance, 'layer = "ROLLER"\n' + FLAT, 'layer = "WEIGHT"\ncount = 2\n' + FLAT, body=free).body("balance")
    weight, roller = body.solids[1].weight, body.solids[0].weight
    x, y = ((roller.mass * a + weight.mass * b) for a, b in zip(roller.centre, weight.centre, strict=True))
    assert (x, y) == pytest.approx((0.0, 0.0), abs=1e-20)
    assert weight.centre[0] - roller.centre[0] == pytest.approx(-2e-3, rel=1e-12)  # copies about the drawing's origin


STAFF = 'layer = "STAFF"\nturned = "AXIS"\ndensity = "8 g/cm³"\n'
MISUSES = [
    ('layer = "ROLLER"\n' + FLAT + 'width = "1 mm"\n', "width", "belongs to a hairspring: write hairspring = true as well"),
    ('layer = "ROLLER"\n' + FLAT + "turns = 3\n", "turns", "belongs to a hairspring"),
    ('layer = "ROLLER"\n' + FLAT + "lying = true\n", "lying", "belongs to a turned solid"),
    ('layer = "ROLLER"\n' + FLAT + "count = 2\n", "count", "nothing could touch the copies"),
    ('layer = "WEIGHT"\n' + FLAT + "count = 0\n", "count", "a whole number from 1 to 1000"),
    ('layer = "WEIGHT"\n' + FLAT + "count = 1e30\n", "count", "a whole number from 1 to 1000"),  # took all memory
    ('layer = "WEIGHT"\n' + FLAT + "count = 2.5\n", "count", "a whole number from 1 to 1000"),
    ('layer = "WEIGHT"\n' + FLAT + 'count = "two"\n', "count", "does not begin with a number"),
    ('layer = "WEIGHT"\n' + FLAT + "coutn = 2\n", "coutn", 'Did you mean "count"?'),
    (STAFF + 'thickness = "1 mm"\n', "thickness", "has its size from its profile"),
    (STAFF + "count = 2\n", "count", "room for one"),
    (STAFF + "hairspring = true\n", "turned", "not both"),
    (STAFF + 'lying = "yes"\n', "lying", "true or false is needed here"),
    (STAFF.replace("AXIS", "STAFF"), "turned", "no straight line by itself is on this layer"),
    (STAFF.replace('"AXIS"', "3"), "turned", "a layer with the axis is needed here, or two points"),
    (STAFF.replace('"AXIS"', '[["0 mm", "1 mm"], ["0 mm", "1 mm"]]'), "turned", "its two points are the same"),
    (STAFF.replace('"AXIS"', '[["0 mm", "1 mm"], ["0 mm", 2]]'), "turned.1.1", "a bare number needs a unit"),
    (STAFF.replace('"AXIS"', '[["0.1 mm", "0 mm"], ["0.1 mm", "1 mm"]]'), "turned", "both sides of its axis"),
    (STAFF.replace('layer = "STAFF"\n', ""), "", "on which one is the half profile?"),
    (STAFF.replace('density = "8 g/cm³"\n', ""), "", "density is missing"),
    (HAIRSPRING_SOLIDS, "", "turns or length: missing"),
    ("turns = -1\n" + HAIRSPRING_SOLIDS, "turns", "must be above zero"),
    ("turns = 100\n" + HAIRSPRING_SOLIDS, "width", "its coils would overlap"),
    ('length = "1 mm"\n' + HAIRSPRING_SOLIDS, "length", "does not even reach"),
    ('turns = 1\nlength = "1 m"\n' + HAIRSPRING_SOLIDS, "length", "both are given"),
    ("turns = 12\n" + HAIRSPRING_SOLIDS.replace('"2.6 mm"', '"0.5 mm"'), "outer", "must be larger than inner"),
    ("turns = 12\ncount = 2\n" + HAIRSPRING_SOLIDS, "count", "as many hairsprings as entries"),
    ("turns = 12\n" + HAIRSPRING_SOLIDS.replace('inner = "0.6 mm"\n', ""), "", "inner is missing"),
    ('turns = 12\nhairspring = true\nlayer = "STRIP"\nwidth = "0.1 mm"\n' + FLAT, "turns", "drawn on a layer"),
    ('hairspring = true\nlayer = "STRIP"\n' + FLAT, "", "width is missing"),
    ('hairspring = true\nlayer = "ROLLER"\nwidth = "1 mm"\n' + FLAT, "width", "has its width"),
    ('hairspring = true\nlayer = "NONE"\nwidth = "1 mm"\n' + FLAT, "layer", "nothing is on this layer"),
    ('hairspring = "STRIP"\n' + FLAT, "hairspring", "true or false is needed here"),
]


@pytest.mark.parametrize(("solid", "key", "message"), MISUSES)
def test_every_misuse_has_one_fault_with_its_line(balance, solid, key, message):
    with pytest.raises(SceneError) as caught:
        loaded(balance, solid)
    (fault,) = caught.value.faults
    assert fault.key == f"bodies.balance.solids.0{'.' if key else ''}{key}"
    assert message in fault.message
    assert ".toml:" in fault.place


def test_an_open_outline_has_no_mass(balance):
    with pytest.raises(SceneError) as caught:
        loaded(balance, 'layer = "STRIP"\n' + FLAT)
    (fault,) = caught.value.faults
    assert "it is open. Close it" in fault.message


def test_faults_of_all_solids_come_at_once(balance):
    with pytest.raises(SceneError) as caught:
        loaded(balance, *(solid for solid, _, _ in MISUSES))
    assert len(caught.value.faults) == len(MISUSES)


def test_a_solid_can_be_varied(balance):
    scene = loaded(balance, "turns = 12\n" + HAIRSPRING_SOLIDS)
    more = scene.set("bodies.balance.solids.0.turns", 13).set("bodies.balance.solids.0.inner", 0.7e-3)
    assert more.body("balance").inertia > scene.body("balance").inertia


def test_check_tells_every_solid_and_their_sum(balance):
    scene = loaded(balance, 'layer = "ROLLER"\n' + FLAT, "turns = 12\n" + HAIRSPRING_SOLIDS)
    report = check_report(scene, ())
    (entry,) = report["bodies"].values()
    assert sum(solid["mass_kg"] for solid in entry["solids"]) == pytest.approx(entry["mass_kg"], rel=1e-14)
    assert sum(solid["inertia_kg_m2"] for solid in entry["solids"]) == pytest.approx(entry["inertia_kg_m2"], rel=1e-14)
    json.dumps(report)
    text = check_text(report, scene)
    assert "ROLLER" in text and "plate of 0.2 mm" in text and "hairspring, one third" in text and "together" in text
    assert "11.31 mg" in text and "beside the pivot" not in text


@pytest.mark.parametrize(
    ("gravity", "words"), [(0.0, "so this does nothing"), (9.81, "gravity turns it with up to 17.7518 nN·m")]
)
def test_check_says_what_a_heavy_spot_does(balance, gravity, words):
    scene = loaded(balance, 'layer = "WEIGHT"\n' + FLAT)
    scene = scene.set("scene.gravity", ["0 m/s²", f"{-gravity} m/s²"])
    text = check_text(check_report(scene, ()), scene)
    assert math.pi * 0.09e-6 * HEIGHT * RHO * 4e-3 * 9.81 == pytest.approx(17.7518e-9, rel=1e-5, abs=0.0)
    assert words in text and "lies 4 mm beside the pivot" in text


def test_holes_are_taken_out_of_a_plate(balance):
    balance.put(drawing("balance.dxf", [square(4e-3, layer="ROLLER"), square(2e-3, layer="ROLLER", hole=True)]))
    body = loaded(balance, FLAT, body=BODY_SOLIDS.replace('pivot = "PIVOT"\n', "")).body("balance")
    assert body.mass == pytest.approx(12e-6 * HEIGHT * RHO, rel=1e-12, abs=0.0)
    assert body.inertia == pytest.approx(HEIGHT * RHO * (4e-3**4 - 2e-3**4) / 6, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_check_says_how_many_copies_there_are(balance, count):
    scene = loaded(balance, f'layer = "WEIGHT"\ncount = {count}\n' + FLAT, 'layer = "ROLLER"\n' + FLAT)
    text = check_text(check_report(scene, ()), scene)
    assert (f"WEIGHT × {count}" in text) == (count > 1)


AT = (3e-3, -4e-3)
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


def outlines(pivot: Point | None = AT, **more: Any) -> Outlines:
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


@pytest.mark.parametrize(("pivot", "middle"), [(AT, AT), (None, (0.0, 0.0))])
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
    assert found.weight.mass == pytest.approx(mass, rel=1e-12, abs=0.0) and found.weight.centre == AT
    assert found.weight.inertia == pytest.approx(8000.0 * math.tau * (away**3 * area + 3.0 * away * own), rel=1e-9, abs=0.0)
    lying = one({"layer": "HALF", "turned": axis, "lying": True, "density": "8 g/cm³"})
    along = (1e-3 * 0.6) + (3e-3 * 0.8)
    assert lying.weight.mass == pytest.approx(mass, rel=1e-12, abs=0.0)
    assert lying.weight.centre == pytest.approx((0.6 * along, 6e-3 + 0.8 * along), rel=1e-9)
    assert (found.kind, lying.kind, lying.thickness) == ("upright", "lying", 0.0)
    assert lying.axis[0] == (0.0, 6e-3) and lying.axis[1] == pytest.approx((0.6, 0.8))


@pytest.mark.parametrize("pivot", [AT, None])
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
    steiner = math.dist(AT, (2.5e-3, 2e-3)) ** 2
    assert found.weight.mass == pytest.approx(mass, rel=1e-12, abs=0.0) and found.weight.centre == AT and found.width == 5e-5
    assert found.weight.inertia == pytest.approx(mass * ((9e-6 + 2.5e-9) / 12.0 + steiner), rel=1e-9, abs=0.0)
    closed = one({"layer": "PIN", **{key: value for key, value in WIRE.items() if key != "width"}})
    assert closed.weight.mass == pytest.approx(PAPER * 0.16e-6 / 3.0, rel=1e-12, abs=0.0) and closed.width == 0.0
    assert closed.weight.inertia == pytest.approx(
        closed.weight.mass * (0.16e-6 / 6.0 + math.dist(AT, (7e-3, 1e-3)) ** 2), rel=1e-12, abs=0.0
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
    ({**WIRE, "layer": "PIN"}, ["0.width = "]),
    (
        {**WIRE, "layer": "STRIP", "inner": "1 mm", "turns": 3},
        ['0.inner = "1 mm": the hairspring is drawn', "0.turns = 3: the hairspring is"],
    ),
    ({**WIRE, "turned": "AXIS", "layer": "HALF"}, ["0.turned: a solid is a hairspring or turned", "0.thickness = "]),
    ({**SHEET, "width": "1 mm", "turns": 3}, ["0.turns = 3: turns, width belong to a hairspring"]),
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
        '0: the body has no closed outline to make a plate of. Write layer = "..." or draw one'
    ]


def test_the_others_are_read_after_a_fault() -> None:
    found, said = solids({"density": "8 g/cm³"}, SHEET, 5, {"layer": "PIN", **SHEET})
    assert [solid.layer for solid in found] == ["", "PIN"] and {fault[0] for fault in said} == {"0", "2"}


GROUND = d.line((-5, 0), (5, 0), layer="GROUND", handle="1A") + d.arc(5, 2, 2, 270, 360, layer="GROUND")
BACKWARD = d.lwpolyline([(7, 2, -0.41421356237309503), (5, 0), (-5, 0)], False, layer="GROUND")
CENTRE_LINE = d.line((0, -9), (0, 9), layer="AXES")
HEAD = '[bodies.ground]\ndrawing = "ground.dxf"\nmotion = "fixed"\n'
BALL = '[bodies.ball]\ncircle = "1 mm"\nmotion = "free"\nmass = "1 g"\nposition = ["0 mm", "2 mm"]\n'
CONTACT = '[[contacts]]\nbetween = ["ground.GROUND", "ball"]\n'


def scene(folder: Path, keys: str, entities: str = GROUND + CENTRE_LINE, contact: str = CONTACT, ball: str = BALL) -> Scene:
    (folder / "ground.dxf").write_bytes(d.dxf(entities))
    (folder / "scene.toml").write_text(HEAD + keys + ball + contact, encoding="utf-8")
    return load(folder / "scene.toml")


def faults(folder: Path, keys: str, entities: str = GROUND + CENTRE_LINE) -> str:
    with pytest.raises(SceneError) as caught:
        scene(folder, keys, entities)
    return str(caught.value)


@pytest.mark.parametrize("entities", [GROUND, BACKWARD], ids=["forward", "backward"])
@pytest.mark.parametrize("point", ['["-3 mm", "-0.2 mm"]', '["8 mm", "0 mm"]'])
def test_a_point_behind_the_face_says_it_however_it_was_drawn(tmp_path: Path, entities: str, point: str) -> None:
    (chain,) = scene(tmp_path, f"material = {{ GROUND = {point} }}\n", entities).body("ground").loops
    assert not chain.closed and chain.layer == "GROUND"
    line, arc = chain.edges if isinstance(chain.edges[0], Line) else reversed(chain.edges)
    assert isinstance(line, Line) and isinstance(arc, Arc)
    assert line.tangent(0.0) == pytest.approx((-1.0, 0.0), abs=1e-12), "material below is on the left of travel to the left"
    assert arc.sweep < 0.0, "material outside the circle"


def test_left_and_right_are_seen_along_the_drawn_direction(tmp_path: Path) -> None:
    for side, forward in (("left", 1.0), ("right", -1.0)):
        (chain,) = scene(tmp_path, f'layers = ["GROUND"]\nmaterial = "{side}"\n').body("ground").loops
        line = next(edge for edge in chain.edges if isinstance(edge, Line))
        assert line.tangent(0.0)[0] == pytest.approx(forward, abs=1e-12)


def test_without_layers_one_value_speaks_for_all_open_chains(tmp_path: Path) -> None:
    body = scene(tmp_path, 'material = "left"\n').body("ground")
    assert body.layers == ("GROUND", "AXES")
    only = scene(tmp_path, 'material = { GROUND = "left" }\n', GROUND + CENTRE_LINE + d.circle(0, 20, 1, layer="STUD")).body(
        "ground"
    )
    assert only.layers == ("STUD", "GROUND")


def test_contact_with_an_open_chain_of_unknown_side_is_an_error_that_says_how(tmp_path: Path) -> None:
    for keys in ("", 'layers = ["GROUND"]\n'):
        text = faults(tmp_path, keys)
        assert "the outline is open" in text and "LINE #1A" in text
        assert 'If it is to stay open: material = "left"' in text
    stray = faults(tmp_path, 'layers = ["AXES"]\n')
    assert "there is no closed outline on this layer. Its lines are open: close them, or write material" in stray


def test_mistakes_in_material(tmp_path: Path) -> None:
    assert "a side is left or right" in faults(tmp_path, 'material = "top"\n')
    text = faults(tmp_path, 'material = { GROND = "left", GROUND = ["1 mm"], AXES = ["0 mm", "1 mm"] }\n')
    assert "bodies.ground.material.GROND" in text and 'Did you mean "GROUND"?' in text
    assert "two values are needed here" in text
    assert "the point lies on the chain of layer AXES itself" in text
    assert 'add "AXES" to layers' in faults(tmp_path, 'layers = ["GROUND"]\nmaterial = { AXES = "left", GROUND = "right" }\n')
    assert "there is no open chain it could apply to" in faults(tmp_path, 'material = "left"\n', d.circle(0, 0, 1))
    with pytest.raises(SceneError, match="belongs to a drawing"):
        scene(tmp_path, 'material = "right"\n', ball=BALL + 'material = "left"\n')


@pytest.mark.parametrize(
    ("position", "depth"), [((5.3, 1.2), 0.0), ((6.2, 1.2), 0.4422205), ((0.0, 0.7), 0.3), ((0.0, 1.5), 0.0)]
)
def test_overlap_at_the_start_counts_behind_lines_and_arcs(tmp_path: Path, position: tuple[float, float], depth: float) -> None:
    x, y = position
    moved = BALL.replace('position = ["0 mm", "2 mm"]', f'position = ["{x} mm", "{y} mm"]')
    found = overlaps(scene(tmp_path, 'layers = ["GROUND"]\nmaterial = ["0 mm", "-1 mm"]\n', ball=moved))
    assert max((1e3 * overlap.depth for overlap in found), default=0.0) == pytest.approx(depth, abs=1e-4)


def test_outlines_that_cross_stop_contacts_and_masses_only(tmp_path: Path) -> None:
    plate = d.polygon([(0, 0), (1, 0), (1, 1)], layer="GROUND")
    cross = d.circle(9, 0, 1, layer="MARK") + d.circle(10, 0, 1, layer="MARK")
    loaded = scene(tmp_path, 'layers = ["GROUND"]\n', plate + cross, ball=BALL.replace("2 mm", "3 mm"))
    assert {(finding.code, finding.severity) for finding in loaded.findings} == {("crossing", "warning")}
    assert "two outlines cross at (9.5, 0.866025) mm" in faults(tmp_path, 'layers = ["GROUND", "MARK"]\n', plate + cross)
    solid = 'layers = ["GROUND"]\n[[bodies.ground.solids]]\nlayer = "MARK"\nthickness = "1 mm"\ndensity = "1 g/cm³"\n'
    assert "two outlines cross" in faults(tmp_path, solid, plate + cross)


@pytest.mark.parametrize(("unit", "beside", "refused"), [("mm", 1e-6, False), ("µm", 1e-6, False), ("mm", 1e-11, True)])
def test_a_point_counts_as_on_the_chain_by_a_share_of_its_length(
    tmp_path: Path, unit: str, beside: float, refused: bool
) -> None:
    """Chains of 10 mm and of 10 µm, points beside them in the same unit: less than a thousand-millionth says nothing."""
    code = {"mm": 4, "µm": 13}[unit]
    (tmp_path / "ground.dxf").write_bytes(d.dxf(d.line((-5, 0), (5, 0), layer="GROUND"), units=code))
    text = HEAD + f'material = {{ GROUND = ["0 {unit}", "{beside!r} {unit}"] }}\n' + BALL + CONTACT
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    if refused:
        with pytest.raises(SceneError, match="lies on the chain"):
            load(tmp_path / "scene.toml")
    else:
        assert load(tmp_path / "scene.toml").body("ground").loops[0].edges[0].tangent(0.0) == pytest.approx((1.0, 0.0))


def test_a_misspelt_layer_of_material_is_one_fault(tmp_path: Path) -> None:
    """That the side of the layer that was meant is not known only follows from it."""
    text = faults(tmp_path, 'layers = ["GROUND"]\nmaterial = { GROND = "left" }\n')
    assert 'Did you mean "GROUND"?' in text and "the outline is open" not in text and "no closed outline" not in text


RNG = np.random.default_rng(8)
Cloud = tuple[np.ndarray, np.ndarray]


def cloud(count: int = 4) -> Cloud:
    """Places (complex, m) and masses of points."""
    return RNG.normal(size=count) + 1j * RNG.normal(size=count), RNG.uniform(1.0, 2.0, count)


def weight(places: np.ndarray, masses: np.ndarray) -> Weight:
    centre = complex(places @ masses / masses.sum())
    inertia = float(np.abs(places - centre) ** 2 @ masses)
    return Weight(float(masses.sum()), (centre.real, centre.imag), inertia)


def same(one: Weight, other: Weight) -> bool:
    numbers = [(found.mass, *found.centre, found.inertia) for found in (one, other)]
    return numbers[0] == pytest.approx(numbers[1], rel=1e-12, abs=1e-12)


def test_weights_are_those_of_their_points() -> None:
    (p, m), (q, n) = cloud(), cloud(5)
    one, other = weight(p, m), weight(q, n)
    assert one.about((0.3, -2.0)) == pytest.approx(float(np.abs(p - (0.3 - 2.0j)) ** 2 @ m), rel=1e-12)
    assert same(one.joined(other), weight(np.append(p, q), np.append(m, n)))
    assert same(one.scaled(7.0), weight(p, m * 7.0 / m.sum()))
    assert same(
        total((solid(one), solid(other), solid(one))) or one, weight(np.concatenate((p, q, p)), np.concatenate((m, n, m)))
    )
    assert total(()) is None


@pytest.mark.parametrize("count", [1, 2, 3, 7])
def test_copies_are_spread_about_the_pivot(count: int) -> None:
    places, masses = cloud()
    pivot = 0.4 - 1.1j
    turned = [pivot + (places - pivot) * np.exp(2j * np.pi * k / count) for k in range(count)]
    got = weight(places, masses).repeated(count, (pivot.real, pivot.imag))
    assert same(got, weight(np.concatenate(turned), np.tile(masses, count)))


RING = Loop((Arc(1.0, 2.0, 0.25, 0.0, math.tau),), "RING")
HOLE = Loop((Arc(1.0, 2.0, 0.1, 0.0, -math.tau),), "HOLE", hole=True)
BAR = Loop((Line(0.0, 0.0, 3.0, 0.0), Line(3.0, 0.0, 3.0, 0.5), Line(3.0, 0.5, 0.0, 0.5), Line(0.0, 0.5, 0.0, 0.0)), "BAR")


def solid(heavy: Weight | None = None, kind: str = PLATE, **more: object) -> Solid:
    return Solid(kind, "RING", heavy or weight(*cloud()), 8e3, **more)  # type: ignore[arg-type]


def middle(loop: Loop) -> complex:
    return complex(*loop.edges[0].point(0.5))


@pytest.mark.parametrize("kind", [PLATE, LYING, HAIRSPRING, UPRIGHT])
def test_in_other_coordinates(kind: str) -> None:
    """All but the half profile of what stands on the pivot: it has coordinates of its own."""
    here = solid(kind=kind, loops=(RING, BAR), pivot=(0.5, -0.5), axis=((1.0, 2.0), (0.6, 0.8)), count=3, thickness=0.1)
    there = here.shifted((10.0, -20.0))
    assert same(
        there.weight,
        Weight(here.weight.mass, (here.weight.centre[0] + 10.0, here.weight.centre[1] - 20.0), here.weight.inertia),
    )
    assert there.pivot == (10.5, -20.5) and (there.count, there.thickness, there.kind) == (3, 0.1, kind)
    if kind == UPRIGHT:
        assert there.loops == here.loops and there.axis == here.axis
    else:
        assert there.axis == ((11.0, -18.0), (0.6, 0.8))
        moved = [middle(b) - middle(a) for a, b in zip(here.loops, there.loops, strict=True)]
        assert moved == [pytest.approx(10.0 - 20.0j)] * 2


@pytest.mark.parametrize("way", [(1.0, 0.0), (0.6, 0.8), (0.0, -1.0)])
def test_a_half_profile_stands_on_its_axis(way: tuple[float, float]) -> None:
    """A bar on an axis through (1, 2): along x and above it, with its foot at the origin. What stands stays."""
    turn, foot = math.atan2(way[1], way[0]), (1.0, 2.0)
    drawn = BAR.moved(turn, foot)
    (profile,) = solid(kind=LYING, loops=(drawn,), axis=(foot, way)).upright_profile()
    assert [edge.start for edge in profile.edges] == [pytest.approx(edge.start, abs=1e-12) for edge in BAR.edges]
    assert solid(kind=UPRIGHT, loops=(drawn,), axis=(foot, way)).upright_profile() == (drawn,)


@pytest.mark.parametrize("first", [0, 1, 2])
def test_places_of_copies(first: int) -> None:
    pivot = 0.5 - 0.5j
    found = solid(pivot=(0.5, -0.5), count=4).copies([RING, BAR], first)
    wanted = [pivot + (middle(loop) - pivot) * 1j**k for k in range(first, 4) for loop in (RING, BAR)]
    assert [middle(loop) for loop in found] == [pytest.approx(place, abs=1e-12) for place in wanted]


def test_what_pictures_show_besides_outlines() -> None:
    """Bores that nothing fills, copies but the first, both halves of what lies; each once, and nothing of what stands."""
    bored = solid(loops=(RING, HOLE), bores=("HOLE",))
    assert bored.drilled == (HOLE,) and more_seen((bored,)) == (HOLE,)
    assert more_seen((bored,), ("HOLE",)) == () and more_seen((bored, solid(loops=(BAR,)))) == (HOLE,)
    filling = Solid(PLATE, "HOLE", weight(*cloud()), 8e3, (BAR,))
    assert more_seen((bored, filling)) == ()
    twice = solid(loops=(RING, HOLE), bores=("HOLE",), count=2)
    assert [middle(loop) for loop in more_seen((twice,))] == [
        pytest.approx(one) for one in (middle(HOLE), -middle(RING), -middle(HOLE))
    ]
    assert [middle(loop) for loop in more_seen((twice, filling))] == [pytest.approx(-middle(RING))]
    lying = solid(kind=LYING, loops=(BAR,), axis=((0.0, 0.0), (1.0, 0.0)))
    assert len(more_seen((lying, lying))) == 2
    assert {round(edge.start[1], 9) for loop in more_seen((lying,)) for edge in loop.edges} == {0.0, 0.5, -0.5}
    assert more_seen((solid(kind=UPRIGHT, loops=(BAR,)), solid(kind=HAIRSPRING, loops=(BAR,)))) == ()


def test_names() -> None:
    assert solid().name == "RING" and Solid(PLATE, "", weight(*cloud()), 1.0).name == "plate"
