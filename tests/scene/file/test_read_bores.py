"""Are bores on layers of their own taken out of plates exactly, once, and only where they lie in material?"""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_scenes import circle, drawing, square

from watchsim.drawing.findings import Finding
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.results.folder import lock_text
from watchsim.scene.errors import Faults, SceneError
from watchsim.scene.keys import BODY
from watchsim.scene.load import load
from watchsim.scene.outlines import Outlines
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
