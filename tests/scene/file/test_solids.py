"""Are plates, turned parts and hairsprings of a scene as heavy as their formulas say, and is every misuse refused?"""

from __future__ import annotations

import json
import math
from itertools import pairwise

import pytest
from made_scenes import circle, drawing, square

from watchsim.drawing.findings import Finding
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.mechanism.check import check_report, check_text
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load

BODY = '[bodies.balance]\ndrawing = "balance.dxf"\nlayers = ["ROLLER"]\npivot = "PIVOT"\n'
PLATE = 'thickness = "0.2 mm"\ndensity = "8 g/cm³"\n'
HAIRSPRING = 'hairspring = true\ninner = "0.6 mm"\nouter = "2.6 mm"\nwidth = "0.03 mm"\n' + PLATE
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


def loaded(desk, *solids: str, body: str = BODY):
    return load(desk.scene(body + "".join(f"[[bodies.balance.solids]]\n{solid}" for solid in solids)))


def weights(desk, *solids: str):
    return loaded(desk, *solids).body("balance")


def test_layers_of_different_materials_add_up(balance):
    body = weights(balance, 'layer = "ROLLER"\n' + PLATE, 'layer = "WEIGHT"\nthickness = "0.5 mm"\ndensity = "19.3 g/cm³"\n')
    roller, weight = math.pi * 2.25e-6 * HEIGHT * RHO, math.pi * 0.09e-6 * 0.5e-3 * 19300
    assert body.mass == pytest.approx(roller + weight, rel=1e-12)
    assert body.inertia == pytest.approx(roller * 2.25e-6 / 2 + weight * (0.09e-6 / 2 + 16e-6), rel=1e-12, abs=0.0)
    assert body.centre_of_mass == pytest.approx((weight * 4e-3 / (roller + weight), 0.0), rel=1e-12, abs=1e-17)
    assert [solid.kind for solid in body.solids] == ["plate", "plate"]


def test_counted_layers_are_spread_about_the_pivot(balance):
    body = weights(balance, 'layer = "WEIGHT"\ncount = 4\n' + PLATE)
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
    body = weights(balance, "turns = 12\n" + HAIRSPRING)
    inner, outer = 0.6e-3, 2.6e-3
    mass = RHO * HEIGHT * 0.03e-3 * math.pi * 12 * (inner + outer)  # the hand formula takes the coils as circles
    assert body.mass == pytest.approx(mass / 3, rel=1e-3)
    assert body.inertia == pytest.approx(mass / 3 * (inner**2 + outer**2) / 2, rel=1e-3, abs=0.0)
    length = body.solids[0].spiral.length
    same = weights(balance, f'length = "{length!r} m"\n' + HAIRSPRING)
    assert (same.mass, same.inertia) == pytest.approx((body.mass, body.inertia), rel=1e-12, abs=0.0)


def test_a_drawn_strip_counts_one_third_too(balance):
    body = weights(balance, 'hairspring = true\nlayer = "STRIP"\nwidth = "0.1 mm"\n' + PLATE)
    bar = RHO * HEIGHT * 1e-4 * 1e-3
    own = bar * (1e-8 + 1e-6) / 12
    assert body.mass == pytest.approx(2 * bar / 3, rel=1e-12, abs=0.0)
    assert body.inertia == pytest.approx((2 * own + bar * 1.5e-3**2 + bar * (4e-6 + 0.25e-6)) / 3, rel=1e-12, abs=0.0)


def test_layers_of_sections_cannot_touch_by_default(balance):
    solids = (
        'layer = "STAFF"\nturned = "AXIS"\ndensity = "7.8 g/cm³"\n',
        'hairspring = true\nlayer = "STRIP"\nwidth = "0.1 mm"\n' + PLATE,
    )
    body = loaded(balance, *solids, body=BODY.replace('layers = ["ROLLER"]\n', "")).body("balance")
    assert body.layers == ("ROLLER", "WEIGHT", "SCREW")


def test_a_free_body_has_its_copies_about_the_point_they_were_drawn_around(balance):
    free = BODY.replace('pivot = "PIVOT"\n', 'motion = "free"\n')
    body = loaded(balance, 'layer = "ROLLER"\n' + PLATE, 'layer = "WEIGHT"\ncount = 2\n' + PLATE, body=free).body("balance")
    weight, roller = body.solids[1].weight, body.solids[0].weight
    x, y = ((roller.mass * a + weight.mass * b) for a, b in zip(roller.centre, weight.centre, strict=True))
    assert (x, y) == pytest.approx((0.0, 0.0), abs=1e-20)
    assert weight.centre[0] - roller.centre[0] == pytest.approx(-2e-3, rel=1e-12)  # copies about the drawing's origin


STAFF = 'layer = "STAFF"\nturned = "AXIS"\ndensity = "8 g/cm³"\n'
MISUSES = [
    ('layer = "ROLLER"\n' + PLATE + 'width = "1 mm"\n', "width", "belongs to a hairspring: write hairspring = true as well"),
    ('layer = "ROLLER"\n' + PLATE + "turns = 3\n", "turns", "belongs to a hairspring"),
    ('layer = "ROLLER"\n' + PLATE + "lying = true\n", "lying", "belongs to a turned solid"),
    ('layer = "ROLLER"\n' + PLATE + "count = 2\n", "count", "nothing could touch the copies"),
    ('layer = "WEIGHT"\n' + PLATE + "count = 0\n", "count", "a whole number from 1 to 1000"),
    ('layer = "WEIGHT"\n' + PLATE + "count = 1e30\n", "count", "a whole number from 1 to 1000"),  # took all memory
    ('layer = "WEIGHT"\n' + PLATE + "count = 2.5\n", "count", "a whole number from 1 to 1000"),
    ('layer = "WEIGHT"\n' + PLATE + 'count = "two"\n', "count", "does not begin with a number"),
    ('layer = "WEIGHT"\n' + PLATE + "coutn = 2\n", "coutn", 'Did you mean "count"?'),
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
    (HAIRSPRING, "", "turns or length: missing"),
    ("turns = -1\n" + HAIRSPRING, "turns", "must be above zero"),
    ("turns = 100\n" + HAIRSPRING, "width", "its coils would overlap"),
    ('length = "1 mm"\n' + HAIRSPRING, "length", "does not even reach"),
    ('turns = 1\nlength = "1 m"\n' + HAIRSPRING, "length", "both are given"),
    ("turns = 12\n" + HAIRSPRING.replace('"2.6 mm"', '"0.5 mm"'), "outer", "must be larger than inner"),
    ("turns = 12\ncount = 2\n" + HAIRSPRING, "count", "as many hairsprings as entries"),
    ("turns = 12\n" + HAIRSPRING.replace('inner = "0.6 mm"\n', ""), "", "inner is missing"),
    ('turns = 12\nhairspring = true\nlayer = "STRIP"\nwidth = "0.1 mm"\n' + PLATE, "turns", "drawn on a layer"),
    ('hairspring = true\nlayer = "STRIP"\n' + PLATE, "", "width is missing"),
    ('hairspring = true\nlayer = "ROLLER"\nwidth = "1 mm"\n' + PLATE, "width", "has its width"),
    ('hairspring = true\nlayer = "NONE"\nwidth = "1 mm"\n' + PLATE, "layer", "nothing is on this layer"),
    ('hairspring = "STRIP"\n' + PLATE, "hairspring", "true or false is needed here"),
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
        loaded(balance, 'layer = "STRIP"\n' + PLATE)
    (fault,) = caught.value.faults
    assert "it is open. Close it" in fault.message


def test_faults_of_all_solids_come_at_once(balance):
    with pytest.raises(SceneError) as caught:
        loaded(balance, *(solid for solid, _, _ in MISUSES))
    assert len(caught.value.faults) == len(MISUSES)


def test_a_solid_can_be_varied(balance):
    scene = loaded(balance, "turns = 12\n" + HAIRSPRING)
    more = scene.set("bodies.balance.solids.0.turns", 13).set("bodies.balance.solids.0.inner", 0.7e-3)
    assert more.body("balance").inertia > scene.body("balance").inertia


def test_check_tells_every_solid_and_their_sum(balance):
    scene = loaded(balance, 'layer = "ROLLER"\n' + PLATE, "turns = 12\n" + HAIRSPRING)
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
    scene = loaded(balance, 'layer = "WEIGHT"\n' + PLATE)
    scene = scene.set("scene.gravity", ["0 m/s²", f"{-gravity} m/s²"])
    text = check_text(check_report(scene, ()), scene)
    assert math.pi * 0.09e-6 * HEIGHT * RHO * 4e-3 * 9.81 == pytest.approx(17.7518e-9, rel=1e-5, abs=0.0)
    assert words in text and "lies 4 mm beside the pivot" in text


def test_holes_are_taken_out_of_a_plate(balance):
    balance.put(drawing("balance.dxf", [square(4e-3, layer="ROLLER"), square(2e-3, layer="ROLLER", hole=True)]))
    body = loaded(balance, PLATE, body=BODY.replace('pivot = "PIVOT"\n', "")).body("balance")
    assert body.mass == pytest.approx(12e-6 * HEIGHT * RHO, rel=1e-12, abs=0.0)
    assert body.inertia == pytest.approx(HEIGHT * RHO * (4e-3**4 - 2e-3**4) / 6, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_check_says_how_many_copies_there_are(balance, count):
    scene = loaded(balance, f'layer = "WEIGHT"\ncount = {count}\n' + PLATE, 'layer = "ROLLER"\n' + PLATE)
    text = check_text(check_report(scene, ()), scene)
    assert (f"WEIGHT × {count}" in text) == (count > 1)
