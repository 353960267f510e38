"""How heavy is a body by what is written of it, where does it stand, and what of it is refused? By hand, body by body."""

from __future__ import annotations

from typing import Any

import pytest
from made_scenes import circle, drawing, square
from scene_texts import faults, read

from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.scene import Body

SHAPE = 'polygon = [["1 mm", "-2 mm"], ["3 mm", "-2 mm"], ["3 mm", "4 mm"], ["1 mm", "4 mm"]]\n'  # 2 mm by 6 mm about (2, 1)
OWN, OFF = 5e-3 * 40e-6 / 12.0, 5e-3 * 5e-6  # kg·m² of 5 g about its middle, and of the way from there to the origin
CARRIER = '[bodies.c]\nmotion = "pivot"\ninertia = "900 g·cm²"\nmass = "1 kg"\ncentre_of_mass = ["0 mm", "0 mm"]\n'
MASS, INERTIA, SLIDE, ON = 'mass = "5 g"\n', 'inertia = "7 g·mm²"\n', 'motion = "slide"\naxis = [3, 4]\n', 'on = "c"\n'
MIDDLE = 'pivot = ["2 mm", "1 mm"]\n'


def bodies(text: str) -> dict[str, Body]:
    return {body.name: body for body in read(text).bodies}


WEIGHED = [  # what is written, then mass (kg), inertia (kg·m²) and centre of mass (mm, from the body's origin)
    (MASS, 5e-3, OWN + OFF, (2.0, 1.0)),
    (MASS + MIDDLE, 5e-3, OWN, (0.0, 0.0)),
    (MASS + 'pivot = ["2 mm", "4 mm"]\n', 5e-3, OWN + 5e-3 * 9e-6, (0.0, -3.0)),
    (INERTIA, 0.0, 7e-9, (0.0, 0.0)),
    (MASS + INERTIA, 5e-3, 7e-9, (2.0, 1.0)),
    (MASS + INERTIA + 'centre_of_mass = ["-3 mm", "8 mm"]\n', 5e-3, 7e-9, (-3.0, 8.0)),
    (MASS + INERTIA + MIDDLE + 'centre_of_mass = ["-3 mm", "8 mm"]\n', 5e-3, 7e-9, (-3.0, 8.0)),
    ('motion = "free"\n' + MASS, 5e-3, OWN, (0.0, 0.0)),
    ('motion = "free"\n' + MASS + 'pivot = ["2 mm", "4 mm"]\n', 5e-3, OWN, (0.0, 0.0)),
    ('motion = "free"\n' + MASS + INERTIA, 5e-3, 7e-9, (0.0, 0.0)),
    (SLIDE + MASS, 5e-3, 0.0, (0.0, 0.0)),
    (SLIDE + MASS + INERTIA, 5e-3, 7e-9, (0.0, 0.0)),
    ('motion = "fixed"\n', 0.0, 0.0, (0.0, 0.0)),
    ('motion = "fixed"\n' + MASS, 5e-3, 0.0, (0.0, 0.0)),
    ('motion = "fixed"\n' + ON, 0.0, 0.0, (0.0, 0.0)),
    ('motion = "fixed"\n' + ON + MASS, 5e-3, OWN + OFF, (2.0, 1.0)),
    ('motion = "fixed"\n' + ON + MASS + INERTIA, 5e-3, 7e-9, (2.0, 1.0)),
    ('motion = "driven"\nvelocity = "2 rad/s"\n', 0.0, 0.0, (0.0, 0.0)),
    (ON + MASS + MIDDLE, 5e-3, OWN, (0.0, 0.0)),
    (ON + MASS + INERTIA, 5e-3, 7e-9, (0.0, 0.0)),
]


@pytest.mark.parametrize(("keys", "mass", "inertia", "centre"), WEIGHED)
def test_mass_inertia_and_centre(keys: str, mass: float, inertia: float, centre: tuple[float, float]) -> None:
    body = bodies(f"{CARRIER}[bodies.b]\n{SHAPE}{keys}")["b"]
    assert (body.mass, body.inertia) == pytest.approx((mass, inertia), rel=1e-12, abs=0.0)
    assert body.centre_of_mass == pytest.approx((1e-3 * centre[0], 1e-3 * centre[1]), rel=1e-9, abs=1e-17)


def test_outlines_of_a_free_body_lie_about_its_centre() -> None:
    """Or about its pivot, where one is written."""
    for pivot, corner in (("", (-1e-3, -3e-3)), ('pivot = ["2 mm", "4 mm"]\n', (-1e-3, -6e-3))):
        body = bodies(f'[bodies.b]\nmotion = "free"\n{SHAPE}{MASS}{pivot}')["b"]
        assert body.loops[0].edges[0].start == pytest.approx(corner, rel=1e-12)


REFUSED = [
    ("", ["bodies.b: the body can move (pivot) but has no inertia. Write inertia = "]),
    (SLIDE, ["bodies.b: the body can move (slide) but has no mass. Write mass = "]),
    ('motion = "free"\n', ["bodies.b: the body can move (free) but has no mass", "bodies.b: the body can move (free)"]),
    ('inertia = "0 g·cm²"\n', ["bodies.b.inertia: the body can move (pivot) but has no inertia"]),
    ('inertia = "-1 g·cm²"\n', ["bodies.b.inertia: must not be negative"]),
    (INERTIA + 'mass = "-1 g"\n', ["bodies.b.mass: must not be negative"]),
    ('inertia = "0.9e-100 kg·m²"\n', ["bodies.b.inertia: is too small to compute with"]),
    (INERTIA + 'mass = "0.9e-100 kg"\n', ["bodies.b.mass: is too small"]),
    ('inertai = "1 g·cm²"\n', ["bodies.b.inertai: unknown key"]),
    (MASS + 'centre_of_mass = ["1 mm", "2 mm"]\n', ["bodies.b.centre_of_mass: needs mass and inertia"]),
    (INERTIA + 'centre_of_mass = ["1 mm", "2 mm"]\n', ["bodies.b.centre_of_mass: needs mass and inertia"]),
    (SLIDE + MASS + 'centre_of_mass = ["1 mm", "2 mm"]\n', ["bodies.b.centre_of_mass: has no effect on a body that cannot"]),
    ('motion = "fixed"\ncentre_of_mass = ["1 mm", "2 mm"]\n', ["bodies.b.centre_of_mass: has no effect on a body that cannot"]),
    ('motion = "fixed"\n' + ON + 'centre_of_mass = ["1 mm", "2 mm"]\n', ["bodies.b.centre_of_mass: needs mass and inertia"]),
    ('motion = "free"\n' + MASS + 'centre_of_mass = ["1 mm", "2 mm"]\n', ["bodies.b.centre_of_mass: a free body turns about"]),
    ('spin = "1 rad/s"\n' + INERTIA, ['bodies.b.spin: belongs to motion = "free"; here']),
    ('motion = "slide"\naxis = [0, 0]\n' + MASS, ["bodies.b.axis: a direction of length zero points nowhere"]),
    ('motion = "slide"\n' + MASS, ["bodies.b: a sliding body needs its direction"]),
    ('motion = "fixed"\nvelocity = "1 rad/s"\n', ["bodies.b.velocity: a fixed body does not move"]),
    ("axis = [1, 0]\n" + INERTIA, ['bodies.b.axis: belongs to motion = "slide" or']),
    ('position = "as drawn"\n' + INERTIA, ["bodies.b.position: the body has no drawing: give its coordinates"]),
    ('position = "there"\n' + INERTIA, ['bodies.b.position: write ["1 mm", "0 mm"], or "as drawn"']),
    ('on = "b"\n' + INERTIA, ["bodies.b.on: a body cannot carry itself"]),
    ('on = "d"\n' + INERTIA, ["bodies.b.on: there is no such body. Known here: c."]),
]


@pytest.mark.parametrize(("keys", "expected"), REFUSED)
def test_what_cannot_be_is_said_once(keys: str, expected: list[str]) -> None:
    said = faults(f"{CARRIER}[bodies.b]\n{SHAPE}{keys}")
    assert len(said) == len(expected) and all(one.startswith(words) for one, words in zip(said, expected, strict=True)), said


@pytest.mark.parametrize(("keys", "shown"), [("", ""), ('inertia = "0 g·cm²"\n', ' = "0 g·cm²"')])
def test_a_value_is_shown_where_there_is_one(keys: str, shown: str) -> None:
    with pytest.raises(SceneError) as caught:
        bodies(f"[bodies.b]\n{SHAPE}{keys}")
    assert caught.value.faults[0].shown == shown


def test_solids_and_what_says_the_same_exclude_each_other() -> None:
    solid = '[[bodies.b.solids]]\nthickness = "1 mm"\ndensity = "8 g/cm³"\n'
    assert faults(f"[bodies.b]\n{SHAPE}{MASS}{solid}") == [
        "bodies.b.mass: the solids give the mass already: leave out mass or solids"
    ]
    free = f'[bodies.b]\nmotion = "free"\n{SHAPE}'
    assert faults(f"{free}{MIDDLE}{solid}")[0].startswith("bodies.b.pivot: a free body turns about its centre of mass")
    assert bodies(f"{free}{solid}")["b"].mass == pytest.approx(12e-9 * 8000.0)
    assert bodies(f"{free}{MIDDLE}{MASS}")["b"].mass == 5e-3
    plate = bodies(f"[bodies.b]\n{SHAPE}{solid}")["b"]
    assert (plate.mass, plate.inertia) == pytest.approx((9.6e-5, 9.6e-5 * (40e-6 / 12.0 + 5e-6)), rel=1e-12, abs=0.0)
    assert plate.centre_of_mass == pytest.approx((2e-3, 1e-3))
    assert faults(f'[bodies.b]\n{SHAPE}{solid}centre_of_mass = ["1 mm", "2 mm"]\n')[0].startswith(
        "bodies.b.solids.0.centre_of_mass"
    )
    given = f'[bodies.b]\n{SHAPE}centre_of_mass = ["1 mm", "2 mm"]\n{solid}'
    assert faults(given)[0].startswith("bodies.b.centre_of_mass: the solids already give the centre of mass")


@pytest.mark.parametrize("solids", ["[3]", "[[]]", "3", "false", "{}"])
def test_what_are_no_solids_is_one_fault(solids: str) -> None:
    assert len(faults(f"[bodies.b]\n{SHAPE}solids = {solids}\n")) == 1


def test_the_smallest_weights_are_taken() -> None:
    assert bodies('[bodies.b]\ninertia = "1e-100 kg·m²"\nmass = "1e-100 kg"\n')["b"].inertia == 1e-100


def test_what_is_left_out_of_a_run_and_of_a_body() -> None:
    scene = read(f"[bodies.b]\n{INERTIA}")
    assert (scene.duration, scene.tolerance, scene.record.stride, scene.record.keep) == (1.0, 1e-9, 1, "all")
    assert (scene.lift_angle, scene.nominal, scene.gravity, scene.nu, scene.title) == (None, None, (0.0, 0.0), 0.0, "")
    body = scene.bodies[0]
    assert (body.position, body.angle, body.velocity, body.loops) == ((0.0, 0.0), 0.0, (0.0,), ())
    assert bodies(f"[bodies.b]\n{SLIDE}{MASS}")["b"].axis == pytest.approx((0.6, 0.8))


@pytest.fixture
def drawn(desk: Any) -> Any:
    """Two drawings: plate.dxf with layers A, B and marks P (3, 4) mm and Q (5, -7) mm; bare.dxf with C about R (2, 8) mm."""
    points = (("P", 3e-3, 4e-3), ("Q", 5e-3, -7e-3))
    loops = (square(1e-3, (3e-3, 4e-3), "A"), square(2e-3, (5e-3, -7e-3), "B"))
    desk.put(drawing("plate.dxf", loops, points=points))
    desk.put(drawing("bare.dxf", (circle(1e-3, (2e-3, 8e-3), "C"),), points=(("R", 2e-3, 8e-3),)))
    return desk


def body(name: str, layer: str, pivot: str, more: str = "", file: str = "plate.dxf") -> str:
    return f'[bodies.{name}]\ndrawing = "{file}"\nlayers = ["{layer}"]\npivot = "{pivot}"\ninertia = "1 g·cm²"\n{more}'


C = body("c", "C", "R", file="bare.dxf")
PLACES = [  # what is written, and where the body a stands (mm)
    (body("a", "A", "P"), (0.0, 0.0)),
    (body("a", "A", "P", 'position = "as drawn"\n'), (3.0, 4.0)),
    (body("a", "A", "P", 'position = ["9 mm", "-6 mm"]\n'), (9.0, -6.0)),
    (body("a", "A", "P") + body("b", "B", "Q"), (3.0, 4.0)),
    (body("a", "A", "P") + C, (0.0, 0.0)),
    (body("a", "A", "P", 'position = ["9 mm", "-6 mm"]\n') + body("b", "B", "Q"), (9.0, -6.0)),
    (body("a", "A", "P", 'on = "b"\n') + body("b", "B", "Q"), (-2.0, 11.0)),
    (body("a", "A", "P", 'on = "b"\nposition = "as drawn"\n') + body("b", "B", "Q"), (-2.0, 11.0)),
    (body("a", "A", "P", 'on = "c"\n') + C, (0.0, 0.0)),
    (body("a", "A", "P", 'on = "c"\n') + body("b", "B", "Q") + C, (0.0, 0.0)),
    (body("a", "A", "P", 'on = "c"\nposition = ["9 mm", "-6 mm"]\n') + C, (9.0, -6.0)),
    (f"[bodies.a]\n{INERTIA}[bodies.b]\n{INERTIA}", (0.0, 0.0)),
]


@pytest.mark.parametrize(("text", "place"), PLACES)
def test_a_body_stands_as_drawn_where_several_share_a_drawing(drawn: Any, text: str, place: tuple[float, float]) -> None:
    found = load(drawn.scene(text)).body("a")
    assert found.position == pytest.approx((1e-3 * place[0], 1e-3 * place[1]), rel=1e-12, abs=0.0)


def test_as_drawn_means_nothing_on_a_carrier_of_another_drawing(drawn: Any) -> None:
    with pytest.raises(SceneError, match="is not in the drawing of c, which carries it"):
        load(drawn.scene(body("a", "A", "P", 'on = "c"\nposition = "as drawn"\n') + C))


def test_what_is_left_out_by_layers_is_drawn_by_one_body_alone(drawn: Any) -> None:
    """Of a drawing that several share, each draws its own."""
    assert {loop.layer for loop in load(drawn.scene(body("a", "A", "P"))).body("a").decoration} == {"B"}
    shared = load(drawn.scene(body("a", "A", "P") + body("b", "B", "Q")))
    assert [one.decoration for one in shared.bodies] == [(), ()]
    asked = load(drawn.scene(body("a", "A", "P", 'draw = ["B"]\n') + body("b", "B", "Q")))
    assert {loop.layer for loop in asked.body("a").decoration} == {"B"} and not asked.body("b").decoration
