"""Are bores on layers of their own taken out of plates exactly, once, and only where they lie in material?"""

import json
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_scenes import circle, drawing, square

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line, Point
from watchsim.mechanism.check import check_report, check_text
from watchsim.results.folder import lock_text
from watchsim.scene.errors import Faults, SceneError
from watchsim.scene.keys import BODY
from watchsim.scene.load import load
from watchsim.scene.outlines import Outlines
from watchsim.scene.placing import given_pivot, marked_pivot, marks_on
from watchsim.scene.read_bodies import read_bodies
from watchsim.scene.read_bores import bore_notices, uniform_notices
from watchsim.scene.read_solids import read_solids
from watchsim.scene.solids import Weight
from watchsim.scene.values import Table

RHO, HEIGHT = 7850.0, 0.2e-3
PLATE = 'layer = "LEVER"\nthickness = "0.2 mm"\ndensity = "7.85 g/cm³"\n'
STONE = 'layer = "STONE"\nthickness = "0.3 mm"\ndensity = "3.98 g/cm³"\n'


@pytest.fixture
def lever(desk):
    """A disc of 2 mm about (1, 0) mm with a hole, and on other layers: two bores, one too many, a stone, a section."""
    chain = Loop((Line(0.0, 8e-3, 1e-3, 8e-3),), "TORN", closed=False)
    hole = Loop((Arc(1e-3, -1e-3, 0.3e-3, 0.0, -TURN),), "LEVER", hole=True)
    loops = (
        *(circle(2e-3, (1e-3, 0.0), "LEVER"), hole),
        *(circle(0.5e-3, (2e-3, 0.0), "BORE"), circle(0.25e-3, (0.0, 0.0), "BORE")),
        *(circle(0.4e-3, (1e-3, 1.2e-3), "STONE"), circle(0.2e-3, (1e-3, 1.2e-3), "PIN")),
        *(circle(0.1e-3, (1e-3, -1e-3), "IN_HOLE"), circle(0.5e-3, (1e-3, -1e-3), "ROUND_HOLE")),
        *(circle(0.3e-3, (3e-3, 0.0), "ACROSS"), circle(0.2e-3, (2.4e-3, 0.4e-3), "NEAR"), circle(0.1e-3, (6e-3, 0.0), "AWAY")),
        square(1e-3, (0.0, 20e-3), "STAFF"),
    )
    layers = (*dict.fromkeys(loop.layer for loop in loops), "TORN", "PIVOT")
    torn = Finding("open-outline", "error", "the outline is open", "Close it.", "TORN")
    desk.put(drawing("lever.dxf", loops, open_chains=(chain,), layers=layers, findings=(torn,), points=(("PIVOT", 0.0, 0.0),)))
    return desk


def scene_of(desk, *solids: str, more: str = 'layers = ["LEVER"]\n'):
    head = f'[bodies.lever]\ndrawing = "lever.dxf"\npivot = "PIVOT"\n{more}'
    return load(desk.scene(head + "".join(f"[[bodies.lever.solids]]\n{solid}" for solid in solids)))


def faults_of(desk, *solids: str, more: str = 'layers = ["LEVER"]\n'):
    with pytest.raises(SceneError) as caught:
        scene_of(desk, *solids, more=more)
    return caught.value.faults


def disc(radius: float, centre: tuple[float, float], about: tuple[float, float]) -> tuple[float, float, float, float]:
    """Mass, static moments and inertia about a point, by the handbook."""
    mass = RHO * HEIGHT * math.pi * radius**2
    x, y = centre[0] - about[0], centre[1] - about[1]
    return mass, mass * x, mass * y, mass * (0.5 * radius**2 + x * x + y * y)


@pytest.mark.parametrize("pivot", [(0.0, 0.0), (1e-3, 0.0), (-7e-3, 3e-3)])
def test_a_disc_with_eccentric_bores_is_as_heavy_as_the_handbook_says(lever, pivot) -> None:
    parts = [disc(2e-3, (1e-3, 0.0), pivot), disc(0.3e-3, (1e-3, -1e-3), pivot)]
    parts += [disc(0.5e-3, (2e-3, 0.0), pivot), disc(0.25e-3, (0.0, 0.0), pivot)]
    mass, x, y, inertia = (2 * column[0] - math.fsum(column) for column in zip(*parts, strict=True))
    scene = scene_of(lever, PLATE + 'bores = ["BORE"]\n')
    body = scene.set("bodies.lever.pivot", [f"{value!r} m" for value in pivot]).body("lever")
    assert (body.mass, body.inertia) == pytest.approx((mass, inertia), rel=1e-12, abs=0.0)
    assert body.centre_of_mass == pytest.approx((x / mass, y / mass), rel=1e-12, abs=0.0)


def test_without_the_key_nothing_is_taken_out(lever) -> None:
    plain, none = (scene_of(lever, PLATE + text).body("lever") for text in ("", "bores = []\n"))
    assert plain.mass == pytest.approx(disc(2e-3, (0, 0), (0, 0))[0] - disc(0.3e-3, (0, 0), (0, 0))[0], rel=1e-12, abs=0.0)
    assert plain == none


@pytest.mark.parametrize("touching", [False, True])
def test_a_stone_in_its_bore_has_its_own_mass_and_is_seen(lever, touching) -> None:
    more = 'layers = ["LEVER", "STONE"]\n' if touching else 'layers = ["LEVER"]\n'
    body = scene_of(lever, PLATE + 'bores = ["STONE"]\n', STONE, more=more).body("lever")
    plate, stone = body.solids
    assert plate.weight.mass == pytest.approx(RHO * HEIGHT * math.pi * (4 - 0.09 - 0.16) * 1e-6, rel=1e-12, abs=0.0)
    assert stone.weight.mass == pytest.approx(3980.0 * 0.3e-3 * math.pi * 0.16e-6, rel=1e-12)
    seen = [loop for loop in (body.loops if touching else body.decoration) if loop.layer == "STONE"]
    assert [loop.hole for loop in seen] == [False]
    assert touching == ("STONE" in body.layers) != ("STONE" in {loop.layer for loop in body.decoration})


def test_copies_have_their_bores(lever) -> None:
    body = scene_of(lever, STONE + 'count = 3\nbores = ["PIN"]\n').body("lever")
    ring = 3980.0 * 0.3e-3 * math.pi * (0.16e-6 - 0.04e-6)
    assert body.mass == pytest.approx(3 * ring, rel=1e-12, abs=0.0)
    own, square_of_distance = 0.5 * (0.16e-6 + 0.04e-6), 1e-6 + 1.44e-6
    assert body.inertia == pytest.approx(3 * ring * (own + square_of_distance), rel=1e-12, abs=0.0)
    assert len([loop for loop in body.decoration if loop.layer == "PIN" and loop.hole]) == 3


def test_bores_are_seen_and_cannot_be_touched(lever) -> None:
    lever.drawings["lever.dxf"] = drawing("lever.dxf", lever.drawings["lever.dxf"].loops, points=(("PIVOT", 0.0, 0.0),))
    body = scene_of(lever, PLATE + 'bores = ["BORE"]\n', more="").body("lever")
    assert "BORE" not in body.layers and "STONE" in body.layers
    assert [loop.hole for loop in body.decoration if loop.layer == "BORE"] == [True, True]
    contact = '[bodies.pin]\ncircle = "1 mm"\nmotion = "fixed"\n[[contacts]]\nbetween = ["lever.BORE", "pin"]\n'
    (fault,) = faults_of(lever, PLATE + 'bores = ["BORE"]\n' + contact, more="")
    assert "taken out as a bore; to be touched, draw the bore on the layer of its plate" in fault.message


def test_a_plate_of_all_that_touches_leaves_its_bores_out(lever) -> None:
    loops = [loop for loop in lever.drawings["lever.dxf"].loops if loop.layer in ("LEVER", "BORE")]
    lever.put(drawing("lever.dxf", loops, points=(("PIVOT", 0.0, 0.0),)))
    plate = PLATE.replace('layer = "LEVER"\n', "") + 'bores = ["BORE"]\n'
    whole, named = scene_of(lever, plate, more="").body("lever"), scene_of(lever, PLATE + 'bores = ["BORE"]\n').body("lever")
    assert (whole.mass, whole.inertia) == (named.mass, named.inertia)


MISUSES = [
    ('bores = "BORE"\n', "bores", 'a list of texts is needed here, such as bores = ["LEVER_BORE"]'),
    ('bores = ["BORE", 3]\n', "bores", "a list of texts is needed here"),
    ('bores = ["BOER"]\n', "bores.0", 'no closed outline is on this layer. Did you mean "BORE"?'),
    ('bores = ["BORE", "BORE"]\n', "bores.1", "named twice"),
    ('bores = ["LEVER"]\n', "bores.0", "the plate's own layer: the holes drawn on it are taken out already"),
    ('bores = ["ACROSS"]\n', "bores.0", "the bore at (3, 0) mm crosses an outline of the plate at (2."),
    ('bores = ["ROUND_HOLE"]\n', "bores.0", "the bore at (1, -1) mm has a hole of the plate in it, at (1, -1) mm"),
    ('bores = ["IN_HOLE"]\n', "bores.0", "(they lie in holes that are drawn already); its first outline is at (1, -1) mm"),
    (
        'bores = ["AWAY"]\n',
        "bores.0",
        "nothing on this layer lies in the material of the plate; its first outline is at (6, 0) mm",
    ),
    ('bores = ["BORE", "NEAR"]\n', "bores.1", "the bore at (2.4, 0.4) mm crosses one of layer BORE at (2."),
    ('bores = ["TORN"]\n', "", "the outline is open. Close it"),
]


@pytest.mark.parametrize(("line", "key", "message"), MISUSES)
def test_every_misuse_has_one_fault_with_its_line(lever, line, key, message) -> None:
    (fault,) = faults_of(lever, PLATE + line)
    assert message in fault.message
    assert fault.key == (f"bodies.lever.solids.0.{key}" if key else "bodies.lever.drawing")
    assert ".toml:" in fault.place


def test_a_layer_that_is_no_text_is_one_fault_of_the_layer(lever) -> None:
    faults = faults_of(lever, PLATE.replace('"LEVER"', '["LEVER"]') + 'bores = ["BORE"]\n')
    assert {fault.key for fault in faults} == {"bodies.lever.solids.0.layer"}


def test_faults_of_all_bores_come_at_once(lever) -> None:
    lines = PLATE + 'bores = ["BOER", "ACROSS", "ROUND_HOLE", "AWAY", "LEVER"]\n'
    found = faults_of(lever, lines, 'layer = "STONE"\nthickness = "0 mm"\ndensity = "1 g/cm³"\nbores = ["PINS"]\n')
    keys = [fault.key.removeprefix("bodies.lever.solids.") for fault in found]
    assert sorted(keys) == ["0.bores.0", "0.bores.1", "0.bores.2", "0.bores.3", "0.bores.4", "1.bores.0", "1.thickness"]


@pytest.mark.parametrize(
    ("solid", "message"),
    [
        ('layer = "STAFF"\nturned = [["0 mm", "0 mm"], ["0 mm", "1 mm"]]\ndensity = "8 g/cm³"\n', "drawn in its half profile"),
        ('hairspring = true\nlayer = "STONE"\nthickness = "1 mm"\ndensity = "8 g/cm³"\n', "a hairspring has none"),
    ],
)
def test_only_plates_have_bores(lever, solid, message) -> None:
    found = [fault for fault in faults_of(lever, solid + 'bores = ["BORE"]\n') if fault.key.endswith(".bores")]
    assert len(found) == 1 and message in found[0].message


def test_a_section_is_no_bore(lever) -> None:
    staff = 'layer = "STAFF"\nturned = [["-0.5 mm", "0 mm"], ["-0.5 mm", "1 mm"]]\ndensity = "8 g/cm³"\n'
    (fault,) = faults_of(lever, PLATE + 'bores = ["STAFF"]\n', staff)
    assert "the section or the strip of another solid" in fault.message


def test_a_shape_without_a_drawing_has_no_layers_of_bores(desk) -> None:
    text = '[bodies.disc]\ncircle = "1 mm"\n[[bodies.disc.solids]]\nthickness = "1 mm"\ndensity = "8 g/cm³"\nbores = ["BORE"]\n'
    with pytest.raises(SceneError, match=r"no closed outline is on this layer\. There is no other layer with one"):
        load(desk.scene(text))


def test_the_layers_that_touch_are_no_bores_of_themselves(lever) -> None:
    plate = PLATE.replace('layer = "LEVER"\n', "") + 'bores = ["STONE"]\n'
    (fault,) = faults_of(lever, plate, more='layers = ["LEVER", "STONE"]\n')
    assert "one of those that touch, of which the plate is made" in fault.message


def test_bores_can_be_set_and_locked(lever, tmp_path: Path) -> None:
    scene = scene_of(lever, PLATE)
    bored = scene.set("bodies.lever.solids.0.bores", ["BORE"])
    assert bored.body("lever").mass < scene.body("lever").mass
    assert bored.set("bodies.lever.solids.0.bores", []).body("lever") == scene.body("lever")
    path = tmp_path / "locked.toml"
    path.write_text(lock_text(bored, tmp_path), encoding="utf-8")
    assert 'bores = ["BORE"]' in path.read_text(encoding="utf-8")
    assert load(path).body("lever") == bored.body("lever")
    with pytest.raises(SceneError, match="Did you mean"):
        scene.set("bodies.lever.solids.0.bores", ["BOR"])


CELLS = st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=1, max_size=12, unique=True)
SHAPES = st.tuples(st.floats(0.05, 0.49), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.booleans(), st.booleans())


@given(cells=CELLS, data=st.data(), pivot=st.tuples(st.floats(-9e-3, 9e-3), st.floats(-9e-3, 9e-3)))
def test_bores_on_another_layer_weigh_what_holes_on_their_own_layer_do(cells, data, pivot) -> None:
    """A plate of 6 x 6 cells of 1 mm, some with a disc or a square anywhere in them, drawn either way round."""
    bores, holes = [], []
    for i, j in cells:
        r, dx, dy, straight, backward = data.draw(SHAPES)
        room = 0.5 - r
        centre = (1e-3 * (i + 0.5 + room * dx), 1e-3 * (j + 0.5 + room * dy))
        loop = square(1e-3 * r * math.sqrt(2.0), centre, "B") if straight else circle(1e-3 * r, centre, "B")
        bores.append(loop.reversed() if backward else loop)
        holes.append(Loop(loop.reversed().edges, "PLATE", hole=True))
    plate = square(6e-3, (3e-3, 3e-3), "PLATE")
    bored, one = (weight(loops, pivot, more) for loops, more in (((plate, *bores), {"bores": ["B"]}), ((plate, *holes), {})))
    scale = RHO * HEIGHT * 36e-6
    assert bored.mass == pytest.approx(one.mass, rel=1e-12)
    assert bored.centre == pytest.approx(one.centre, rel=1e-12)
    assert bored.about(pivot) == pytest.approx(one.about(pivot), rel=1e-12)
    by_hand = scale - RHO * HEIGHT * math.fsum(
        math.pi * loop.edges[0].radius ** 2 if isinstance(loop.edges[0], Arc) else loop.edges[0].length ** 2 for loop in bores
    )
    assert bored.mass == pytest.approx(by_hand, rel=1e-12, abs=1e-13 * scale)


def weight(loops: tuple[Loop, ...], pivot: tuple[float, float], more: dict[str, object]) -> Weight:
    """Of the plate alone, without a file."""
    entry = {"layer": "PLATE", "thickness": "0.2 mm", "density": "7.85 g/cm³", **more}
    faults = Faults("scene")
    table = Table({"solids": [entry]}, "bodies.plate", BODY, faults)
    touchable = tuple(loop for loop in loops if loop.layer == "PLATE")
    outlines = Outlines(touchable, pivot=pivot, bores=tuple(loop for loop in loops if loop.layer == "B"))
    (solid,) = read_solids(table, outlines)
    assert not faults.found
    return solid.weight


BODY_TEXT = 'layer = "LEVER"\nthickness = "0.2 mm"\ndensity = "8 g/cm³"\n'
HEAD = 'drawing = "lever.dxf"\nlayers = ["LEVER"]\npivot = "PIVOT"\n'
WHOLE, BORE = 8000 * 0.2e-3 * 16e-6, 8000 * 0.2e-3 * math.pi * 0.25e-6  # kg
BORES = (circle(0.5e-3, (1e-3, 0.0), "LEVER_BORE"), circle(0.5e-3, (-1e-3, 0.0), "LEVER_BORE"))


def put(desk, *loops) -> None:
    desk.put(drawing("lever.dxf", [square(4e-3, layer="LEVER"), *loops], points=(("PIVOT", 0.0, 0.0),)))


def noticed(desk, *solids: str, head: str = HEAD, more: str = ""):
    entries = "".join(f"[[bodies.lever.solids]]\n{solid}" for solid in solids)
    return load(desk.scene(f"[bodies.lever]\n{head}{entries}{more}"))


def notices(scene) -> list[tuple[str, str]]:
    return [(finding.message, finding.fix) for finding in scene.findings if finding.code == "bore"]


def test_a_forgotten_layer_is_told_with_its_mass_and_the_line_to_add(desk) -> None:
    put(desk, *BORES)
    scene = noticed(desk, BODY_TEXT)
    ((message, fix),) = notices(scene)
    assert message == "lever: not taken out of the plate LEVER: 2 bores of LEVER_BORE lying in it"
    assert 'Write bores = ["LEVER_BORE"] beside its thickness: 25.6 mg become 23.0867 mg' in fix
    by_hand = (1e6 * WHOLE, 1e6 * (WHOLE - 2 * BORE))
    assert by_hand == pytest.approx((25.6, 23.0867), abs=5e-5)
    told = noticed(desk, BODY_TEXT + 'bores = ["LEVER_BORE"]\n')
    assert told.body("lever").mass == pytest.approx(WHOLE - 2 * BORE, rel=1e-12) and not notices(told)
    assert f"notice: {message}. {fix}" in check_text(check_report(scene, ()), scene)


def test_an_empty_list_says_that_the_plate_is_whole(desk) -> None:
    put(desk, *BORES)
    scene = noticed(desk, BODY_TEXT + "bores = []\n")
    assert scene.body("lever").mass == pytest.approx(WHOLE, rel=1e-12) and not notices(scene)


def test_the_line_to_add_keeps_what_is_named_already(desk) -> None:
    put(desk, BORES[0], circle(0.2e-3, (1e-3, 1e-3), "SLOT"), circle(0.1e-3, (0.0, -1e-3), "PIN_HOLE"))
    ((message, fix),) = notices(noticed(desk, BODY_TEXT + 'bores = ["SLOT"]\n'))
    assert "2 bores of LEVER_BORE, PIN_HOLE lying in it" in message
    assert 'bores = ["SLOT", "LEVER_BORE", "PIN_HOLE"]' in fix


def test_marks_outlines_beside_and_holes_in_holes_are_not_told(desk) -> None:
    hole = square(1e-3, (1e-3, 1e-3), "LEVER", hole=True)
    put(desk, hole, circle(0.2e-3, (1e-3, 1e-3), "BORE"), circle(0.1e-3, layer="PIVOT"), circle(1e-3, (9e-3, 0.0), "BORES"))
    assert not notices(noticed(desk, BODY_TEXT))


def test_a_plate_of_all_that_touches_must_not_weigh_its_bores(desk) -> None:
    put(desk, *BORES)
    bare = BODY_TEXT.replace('layer = "LEVER"\n', "")
    scene = noticed(desk, bare, head=HEAD.replace('["LEVER"]', '["LEVER", "LEVER_BORE"]'))
    assert scene.body("lever").mass == pytest.approx(WHOLE + 2 * BORE, rel=1e-12, abs=0.0)
    ((message, fix),) = notices(scene)
    assert "counted as material of the plate: 2 bores of LEVER_BORE" in message
    assert fix.startswith("Take LEVER_BORE out of layers and write") and "28.1133 mg become 23.0867 mg" in fix
    scene = noticed(desk, bare, head=HEAD.replace('layers = ["LEVER"]\n', ""))
    assert notices(scene)[0][1].startswith('Write bores = ["LEVER_BORE"]')
    scene = scene.set("bodies.lever.solids.0.bores", ["LEVER_BORE"])
    assert scene.body("lever").mass == pytest.approx(WHOLE - 2 * BORE, rel=1e-12)


def test_a_bore_across_the_outline_is_told_with_its_place(desk) -> None:
    put(desk, circle(0.5e-3, (2e-3, 0.0), "BORE"))
    ((message, fix),) = notices(noticed(desk, BODY_TEXT))
    assert "the bore at (2, 0) mm of layer BORE lies across an outline of the plate LEVER" in message
    assert fix == "Draw what is missing there in the outline itself."


def test_named_bores_that_take_nothing_out_are_told(desk) -> None:
    hole = square(1e-3, (1e-3, 1e-3), "LEVER", hole=True)
    more = (circle(0.2e-3, (1e-3, 1e-3), "X"), circle(0.2e-3, (5e-3, 0.0), "X"), circle(0.1e-3, (-1e-3, 0.0), "X"))
    put(desk, hole, circle(0.4e-3, (-1e-3, 0.0), "X"), *more)
    scene = noticed(desk, BODY_TEXT + 'bores = ["X"]\n')
    assert scene.body("lever").mass == pytest.approx(8000 * 0.2e-3 * (15e-6 - math.pi * 0.16e-6), rel=1e-12, abs=0.0)
    assert [message for message, _ in notices(scene)] == [
        "lever: the bore at (1, 1) mm of layer X lies in a hole that is drawn already",
        "lever: the bore at (5, 0) mm of layer X lies outside of every plate that names it",
        "lever: the bore at (-1, 0) mm of layer X lies in another bore, taken out with it",
    ]


def test_one_layer_of_bores_may_serve_several_plates(desk) -> None:
    put(desk, *BORES, square(4e-3, (8e-3, 0.0), "COVER"), circle(0.3e-3, (8e-3, 0.0), "LEVER_BORE"))
    line = 'bores = ["LEVER_BORE"]\n'
    scene = noticed(desk, BODY_TEXT + line, BODY_TEXT.replace("LEVER", "COVER") + line)
    assert [len(solid.drilled) for solid in scene.body("lever").solids] == [2, 1] and not notices(scene)


def test_what_another_body_of_the_drawing_names_is_not_told(desk) -> None:
    put(desk, square(8e-3, layer="WHEEL"), *BORES)
    other = f"[bodies.wheel]\n{HEAD.replace('LEVER', 'WHEEL')}[[bodies.wheel.solids]]\n{BODY_TEXT.replace('LEVER', 'WHEEL')}"
    assert [message[:6] for message, _ in notices(noticed(desk, BODY_TEXT, more=other))] == ["lever:", "wheel:"]
    scene = noticed(desk, BODY_TEXT + 'bores = ["LEVER_BORE"]\n', more=other)
    assert not notices(scene)
    assert {loop.layer for loop in scene.body("lever").decoration} == {"LEVER_BORE"}
    assert not scene.body("wheel").decoration


def test_a_bore_that_can_be_touched_is_told(desk) -> None:
    put(desk, *BORES)
    scene = noticed(desk, BODY_TEXT + 'bores = ["LEVER_BORE"]\n', head=HEAD.replace('["LEVER"]', '["LEVER", "LEVER_BORE"]'))
    (finding,) = scene.findings
    assert finding.severity == "warning" and "can be touched as if it were filled" in finding.message
    filled = BODY_TEXT.replace("LEVER", "LEVER_BORE")
    head = HEAD.replace('["LEVER"]', '["LEVER", "LEVER_BORE"]')
    assert not noticed(desk, BODY_TEXT + 'bores = ["LEVER_BORE"]\n', filled, head=head).findings


def test_a_mass_spread_over_outlines_is_told(desk) -> None:
    put(desk, *BORES)
    ((message, fix),) = notices(noticed(desk, head=HEAD + 'mass = "1 mg"\n'))
    assert "2 bores of LEVER_BORE lying in them count as filled" in message and "Give solids" in fix
    ((message, _),) = notices(noticed(desk, head=HEAD.replace('layers = ["LEVER"]', 'mass = "1 mg"')))
    assert "count as one more part" in message
    assert not notices(noticed(desk, head=HEAD + 'mass = "1 mg"\ninertia = "1 mg·cm²"\n'))


def test_check_names_the_bores_of_a_plate(desk) -> None:
    put(desk, *BORES)
    scene = noticed(desk, BODY_TEXT + 'bores = ["LEVER_BORE"]\n')
    report = check_report(scene, ())
    (solid,) = report["bodies"]["lever"]["solids"]
    assert solid["bores"] == ["LEVER_BORE"] and solid["mass_kg"] == pytest.approx(WHOLE - 2 * BORE, rel=1e-12)
    json.dumps(report)
    assert "plate of 0.2 mm less 2 bores" in check_text(report, scene)


TOLD = {"layer": "P", "thickness": "0.2 mm", "density": "8 g/cm³"}
HOLE = Loop(square(1e-3, (2e-3, -3e-3), "BORE").reversed().edges, "BORE")  # drawn the other way round
RINGS = (circle(0.5e-3, (-3e-3, 4e-3), "SLOTS"), circle(0.2e-3, (4e-3, 3e-3), "DRILL"))
MORE = (circle(0.4e-3, (0.0, 20e-3), "SLOTS"), circle(0.3e-3, (30e-3, 5e-3), "SLOTS"))


def told(
    entry: dict[str, Any], *rest: Loop, touching: tuple[Loop, ...] = (), elsewhere: frozenset[str] = frozenset()
) -> tuple[Finding, ...]:
    outlines = Outlines((square(20e-3, layer="P"), *touching), rest)
    table = Table(
        {"solids": [{**TOLD, **entry}], "layers": ["P", *(loop.layer for loop in touching)]}, "bodies.b", BODY, Faults()
    )
    solids = read_solids(table, outlines)
    assert not table.faults.found
    return bore_notices(table, outlines, solids, elsewhere)


def test_what_is_forgotten_is_weighed_whichever_way_it_was_drawn() -> None:
    """400 mm² of 0.2 mm are 640 mg; a square bore of 1 mm² and a round one of 0.126 mm² take 1.6 mg and 0.2 mg away."""
    (one,) = told({}, HOLE, RINGS[1])
    assert one.message == "b: not taken out of the plate P: 2 bores of BORE, DRILL lying in it"
    assert 'Write bores = ["BORE", "DRILL"] beside its thickness: 640 mg become 638.199 mg.' in one.fix
    assert (one.x_mm, one.y_mm, one.layer, one.severity) == (pytest.approx(2.0), pytest.approx(-3.0), "BORE", "notice")
    (two,) = told({"bores": ["SLOTS"]}, RINGS[0], HOLE)
    assert 'Write bores = ["SLOTS", "BORE"] beside its thickness: 638.743 mg become 637.143 mg.' in two.fix
    (three,) = told({"count": 3, "layer": "Q"}, square(20e-3, layer="Q"), HOLE)
    assert "1920 mg become 1915.2 mg." in three.fix


def test_what_is_idle_and_what_can_be_touched_is_told_with_its_place() -> None:
    idle = told({"bores": ["SLOTS"]}, RINGS[0], *MORE)
    assert [(one.x_mm, one.y_mm) for one in idle] == [pytest.approx((0.0, 20.0)), pytest.approx((30.0, 5.0))]
    assert all("outside of every plate that names it" in one.message for one in idle)
    assert told({"bores": ["SLOTS"]}, RINGS[0]) == ()
    (touched,) = told({"bores": ["SLOTS"]}, touching=(circle(0.1e-3, (9e-3, 9e-3), "T"), RINGS[0]))
    assert (touched.layer, touched.severity, touched.x_mm, touched.y_mm) == (
        "SLOTS",
        "warning",
        pytest.approx(-3.0),
        pytest.approx(4.0),
    )
    assert "layer SLOTS is taken out as a bore, but can be touched" in touched.message


def test_what_another_body_takes_out_is_its_own() -> None:
    assert told({}, HOLE, elsewhere=frozenset({"BORE"})) == () and len(told({}, HOLE, elsewhere=frozenset({"DRILL"}))) == 1
    assert told({"bores": []}, HOLE) == ()


def test_a_mass_alone_is_spread_over_what_touches() -> None:
    outlines = Outlines((square(20e-3, layer="P"),), (HOLE, *RINGS))
    table = Table({"mass": "1 g"}, "bodies.b", BODY, Faults())
    (one,) = uniform_notices(table, outlines, Weight(1e-3, (0.0, 0.0), 1e-9), frozenset())
    assert one.message == (
        "b: its mass is spread evenly over its outlines, and 2 bores of BORE, DRILL lying in them count as filled"
    )
    assert (one.x_mm, one.y_mm) == (pytest.approx(2.0), pytest.approx(-3.0))
    assert uniform_notices(table, outlines, Weight(1e-3, (0.0, 0.0), 1e-9), frozenset({"BORE", "DRILL"})) == ()
    both = Outlines((square(20e-3, layer="P"), HOLE), ())
    assert (
        "1 bore of BORE lying in them count as one more part"
        in uniform_notices(table, both, Weight(1e-3, (0.0, 0.0), 1e-9), frozenset())[0].message
    )


@pytest.mark.parametrize(
    ("first", "second", "file", "told_of"),
    [
        ([], ["BORE"], "plate.dxf", []),
        (None, ["BORE"], "plate.dxf", []),
        (None, None, "plate.dxf", ["a", "b"]),
        (["BORE"], None, "plate.dxf", []),
        (["BORE"], ["BORE"], "plate.dxf", []),
        (None, ["BORE"], "copy.dxf", ["a"]),
    ],
)
def test_bores_belong_to_the_bodies_of_one_drawing(desk: Any, first: Any, second: Any, file: str, told_of: list[str]) -> None:
    """A body that names them itself, or another one of the same drawing."""
    for name in ("plate.dxf", "copy.dxf"):
        desk.put(drawing(name, (square(20e-3, layer="P"), square(10e-3, layer="Q"), HOLE)))

    def body(layer: str, bores: Any, path: str) -> dict[str, Any]:
        solid = {**TOLD, "layer": layer, **({} if bores is None else {"bores": bores})}
        return {"drawing": path, "layers": [layer], "pivot": ["0 mm", "0 mm"], "solids": [solid]}

    found = read_bodies({"a": body("P", first, "plate.dxf"), "b": body("Q", second, file)}, desk.folder, Faults())
    assert [one.message[0] for one in found.findings if one.code == "bore"] == told_of
    assert sorted(found.drawings) == sorted({"plate.dxf", file}) and found.sound == {"a", "b"}


PIN = Loop((Arc(2e-3, 1e-3, 0.2e-3, 0.0, -math.tau),), "PLATE", hole=True)
LOOPS = (square(20e-3, layer="PLATE"), PIN, circle(0.3e-3, (5e-3, 1e-3), "STUD"), circle(0.1e-3, (-4e-3, 3e-3), "STUD"))
POINTS = (("AXIS", -1e-3, -2e-3), ("MARK", 3e-3, -6e-3), ("MARK", 7e-3, -6e-3))
DRAWING = drawing("plate.dxf", LOOPS, points=POINTS)


def named(text: object, made: Drawing = DRAWING) -> tuple[Point, list[str]]:
    table = Table({"pivot": text}, "bodies.a", BODY, Faults())
    found = marked_pivot(table, made)
    return found, [fault.message for fault in table.faults.found]


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("AXIS", (-1e-3, -2e-3)),
        ("PLATE", (2e-3, 1e-3)),
        ("hole near [1.5 mm, 0.5 mm]", (2e-3, 1e-3)),
        ("hole near [5 mm, 1 mm]", (2e-3, 1e-3)),  # only the bore is a hole of its own layer
        ("circle near [4.5 mm, 1 mm]", (5e-3, 1e-3)),
        ("circle near [1.5 mm, 0.5 mm]", (2e-3, 1e-3)),
        ("circle near [-3000 µm, 0.3 cm]", (-4e-3, 3e-3)),
        ("point near [-1 mm, 0 mm]", (-1e-3, -2e-3)),
        ("point near [8 mm, -6 mm]", (7e-3, -6e-3)),
        ("  point   near[ '8 mm' , \"-6 mm\" ] ", (7e-3, -6e-3)),
    ],
)
def test_a_layer_or_what_is_nearest(text: str, place: Point) -> None:
    assert named(text) == (place, [])


@pytest.mark.parametrize(("x", "clear"), [(4.2, True), (4.34, False), (5.6, False), (5.68, True)])
def test_the_next_one_must_be_twice_as_far(x: float, clear: bool) -> None:
    """The marks lie at 3 mm and 7 mm: twice as far from 4 1/3 mm and from 5 2/3 mm."""
    (px, _), said = named(f"point near [{x} mm, -6 mm]")
    assert (px == (3e-3 if x < 5.0 else 7e-3)) if clear else math.isnan(px)
    words = ["(3.000, -6.000), (7.000, -6.000)" if x < 5.0 else "(7.000, -6.000), (3.000, -6.000)"]
    assert said == ([] if clear else [f"{words[0]} mm are about equally near: give the place more exactly"])


def test_exactly_twice_as_far_is_clear() -> None:
    made = drawing("a.dxf", (), points=(("A", 0.0, 0.0), ("B", 3.0, 0.0)))
    assert named("point near [1 m, 0 m]", made) == ((0.0, 0.0), [])
    assert named("point near [1.001 m, 0 m]", made)[1]


def test_without_holes_every_circle_is_one() -> None:
    made = drawing("a.dxf", (circle(0.3e-3, (5e-3, 1e-3), "BORE"), square(4e-3, layer="PLATE")))
    assert named("hole near [0 mm, 0 mm]", made) == ((5e-3, 1e-3), [])
    square_hole = drawing("a.dxf", (circle(0.3e-3, (5e-3, 1e-3), "BORE"), square(4e-3, layer="PLATE", hole=True)))
    assert named("hole near [0 mm, 0 mm]", square_hole) == ((5e-3, 1e-3), [])


@pytest.mark.parametrize(("apart", "count"), [(0.0, 1), (0.9e-9, 1), (1.1e-9, 2), (-0.9e-9, 1), (-1.1e-9, 2)])
def test_marks_a_nanometre_apart_are_one(apart: float, count: int) -> None:
    made = drawing(
        "a.dxf", (circle(1e-3, (3e-3, 4e-3), "P"), circle(2e-3, (9e-3, 9e-3), "Q")), points=(("P", 3e-3 + apart, 4e-3),)
    )
    assert len(marks_on(made, "P")) == count
    assert marks_on(made, "P")[0] == (3e-3 + apart, 4e-3)
    assert bool(named("P", made)[1]) is (count == 2)


REFUSED: list[tuple[object, str]] = [
    ("MARK", "2 points or circles are on this layer, at (3.000, -6.000), (7.000, -6.000) mm: leave one, or say which"),
    ("STUD", "2 points or circles are on this layer, at (5.000, 1.000), (-4.000, 3.000) mm"),
    ("BODY", "the drawing has no such layer. plate.dxf has PLATE, STUD."),
    ("MARKS", 'the drawing has no such layer. Did you mean "MARK"? plate.dxf has PLATE, STUD.'),
    ("slot near [1 mm, 2 mm]", "write hole, circle or point near a place"),
    ("hole near 1 mm", "write hole, circle or point near a place"),
    ("hole near [1 mm, 2 mm, 3 mm]", "write hole, circle or point near a place"),
    ("hole near [1, 2.5 mm]", 'write pivot = "hole near [1 mm, 2.5 mm]"'),
    ("point near [1 mm, -2e-3]", 'write pivot = "point near [1 mm, -2e-3 mm]"'),
    ("point near [1 s, 2 mm]", "is a time; here a length is needed"),
    ("point near [1 mm, 2 s]", "is a time; here a length is needed"),
]


@pytest.mark.parametrize(("text", "words"), REFUSED)
def test_what_is_not_clear_is_refused_once(text: object, words: str) -> None:
    place, said = named(text)
    assert len(said) == 1 and words in said[0] and all(map(math.isnan, place))


def test_at_most_four_places_are_listed() -> None:
    made = drawing("a.dxf", (), points=tuple(("P", k * 1e-3, 0.0) for k in range(6)))
    (said,) = named("P", made)[1]
    assert "6 points or circles" in said and said.count("(") == 4 and "(3.000, 0.000) mm: leave one" in said


def test_a_layer_without_marks_and_a_drawing_without_anything() -> None:
    made = drawing("a.dxf", (square(1e-3, layer="LEVER"),))
    assert named("LEVER", made)[1] == ["neither a point nor a circle is on this layer"]
    assert named("point near [1 mm, 2 mm]", made)[1] == ["the drawing holds no point"]
    assert named("circle near [1 mm, 2 mm]", made)[1] == ["the drawing holds no circle"]
    assert named("LEVER", drawing("a.dxf"))[1] == ["the drawing has no such layer. a.dxf has no layers with lines."]


def test_a_layer_may_be_called_like_a_place() -> None:
    made = drawing("a.dxf", (), points=(("hole near [1 mm, 2 mm]", 5e-3, 6e-3), ("X", 1e-3, 2e-3)))
    assert named("hole near [1 mm, 2 mm]", made) == ((5e-3, 6e-3), [])


@pytest.mark.parametrize(
    ("mapping", "pivot", "faults"),
    [({}, None, 0), ({"pivot": ["3 mm", "-4 mm"]}, (3e-3, -4e-3), 0), ({"pivot": "AXIS"}, (math.nan, math.nan), 1)],
)
def test_without_a_drawing_a_pivot_is_given_by_coordinates(mapping: dict[str, Any], pivot: Point | None, faults: int) -> None:
    table = Table(mapping, "bodies.a", BODY, Faults())
    assert given_pivot(table) == (pivot if pivot is None else pytest.approx(pivot, abs=0.0, nan_ok=True))
    assert len(table.faults.found) == faults
