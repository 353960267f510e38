"""How heavy is a body by what is written of it, where does it stand, and what of it is refused? By hand, body by body."""

import math
from typing import Any

import pytest
from made_scenes import circle, drawing, square
from scene_texts import BODIES, faults, read, spring

from watchsim.scene.errors import SceneError
from watchsim.scene.forces import LineSpring, Spring
from watchsim.scene.load import changed, load, load_set
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


BODIES_LIMITS = """
[bodies.wheel]
circle = "1 mm"
inertia = "2 g·cm²"
[bodies.pinion]
circle = "0.5 mm"
inertia = "3 g·cm²"
position = ["5 mm", "0 mm"]
"""
SPRING = '[[springs]]\nbody = "wheel"\nstiffness = "5 µN·m/rad"\n'
GEARS = '[[gears]]\nbetween = ["wheel", "pinion"]\nratio = -3\nbacklash = "2°"\n'
CONTACT = '[[contacts]]\nbetween = ["wheel", "pinion"]\n'
LAW = f"{CONTACT}restitution = 0.5\n"
TRAIN = """[[torques]]
body = "wheel"
over = "barrel"
table = [["0 rev", "9 mN·m"], ["7 rev", "3 mN·m"]]
"""
WIRE = '[bodies.b]\n[[bodies.b.solids]]\nhairspring = true\nthickness = "0.1 mm"\ndensity = "8 g/cm³"\n'
SCREW = """[bodies.b]
polygon = [["3 mm", "0 mm"], ["5 mm", "0 mm"], ["4 mm", "1 mm"]]
[[bodies.b.solids]]
layer = "polygon"
turned = [["0 mm", "0 mm"], ["1 mm", "0 mm"]]
lying = true
density = "8 g/cm³"
"""
LEAF = """[[springs]]
body = "wheel"
leaf = {{ modulus = "200 GPa", length = "5 mm", width = "2 mm", thickness = "{}", arm = "3 mm" }}
"""


LIMITS = [  # (text with a place for the value, the last that is taken, the first that is not, what is said of it)
    (BODIES_LIMITS + "[run]\ntolerance = {}", "1.0e-13", "0.99e-13", "between 1e-13 and 0.01"),
    (BODIES_LIMITS + "[run]\ntolerance = {}", "0.01", "0.0101", "between 1e-13 and 0.01"),
    (BODIES_LIMITS + '[run]\nrecord = "every {}"', "999999999", "1000000000", "every 10"),
    (BODIES_LIMITS + '[run]\nrecord = "every {}"', "1", "0", "every 10"),
    (BODIES_LIMITS + '[run]\nrecord = ["{} s", "0.5 s"]', "0", "-0.001", "from an earlier"),
    (BODIES_LIMITS + '[run]\nrecord = ["0.5 s", "{} s"]', "0.5001", "0.5", "from an earlier"),
    (BODIES_LIMITS + '[run]\nduration = "{} s"', "1e-100", "0.9e-100", "too small"),
    (BODIES_LIMITS + '[run]\nduration = "{} s"', "1e50", "1.1e50", "too large"),
    (BODIES_LIMITS + '[bodies.far]\nmotion = "fixed"\nposition = ["{} m", "0 m"]', "1e9", "1.1e9", "too large"),
    (BODIES_LIMITS + '[bodies.far]\nmotion = "fixed"\nposition = ["{} m", "0 m"]', "-1e9", "-1.1e9", "too large"),
    (BODIES_LIMITS + '[bodies.far]\nmotion = "fixed"\nangle = "{} rad"', "1e9", "1.1e9", "too large"),
    (BODIES_LIMITS + "[scene]\nschema = {}", "1", "2", "reads schema 1"),
    (BODIES_LIMITS + '[scene]\ntangential_law = "pg1996"\nnu = {}', "0", "-0.001", "between 0 and 1"),
    (BODIES_LIMITS + '[scene]\ntangential_law = "pg1996"\nnu = {}', "1", "1.001", "between 0 and 1"),
    (BODIES_LIMITS + '[scene]\ntangential_law = "shifted"\nnu = {}', "0", "0.0001", "the law here is shifted"),
    (BODIES_LIMITS + '[timegrapher]\nlift_angle = "{}°"', "359.9", "360", "below a full turn"),
    (BODIES_LIMITS + "[expect]\nimpacts = {{ value = 3, tolerance = {} }}", "0.001", "0", "above zero"),
    (BODIES_LIMITS + CONTACT + "friction = {}", "0", "-0.001", "would drive"),
    (BODIES_LIMITS + CONTACT + "restitution = {}", "0", "-0.001", "must lie"),
    (BODIES_LIMITS + CONTACT + "restitution = {}", "1", "1.001", "must lie"),
    (BODIES_LIMITS + LAW + 'tangential_restitution = {}\n[scene]\ntangential_law = "pg1996"', "1", "1.001", "must lie"),
    (BODIES_LIMITS + LAW + 'tangential_restitution = {}\n[scene]\ntangential_law = "pg1996"', "0", "-0.001", "must lie"),
    (BODIES_LIMITS + LAW + 'tangential_restitution = {}\n[scene]\ntangential_law = "shifted"', "0.5", "0.501", "not be above"),
    (BODIES_LIMITS + LAW + "tangential_restitution = {}", "0", "0.0001", "gives no tangential impulse"),
    (BODIES_LIMITS + GEARS + "restitution = {}", "0", "-0.001", "must lie"),
    (BODIES_LIMITS + GEARS + "restitution = {}", "1", "1.001", "must lie"),
    (BODIES_LIMITS + GEARS + "efficiency = {}", "1", "1.001", "share of the work"),
    (BODIES_LIMITS + GEARS + "efficiency = {}", "0.001", "0", "share of the work"),
    (BODIES_LIMITS + GEARS + 'pressure_angle = "{}°"', "0", "-0.1", "between 0° and 45°"),
    (BODIES_LIMITS + GEARS + 'pressure_angle = "{}°"', "44.9", "45", "between 0° and 45°"),
    (BODIES_LIMITS + GEARS.replace("2°", "{}°"), "0", "-0.1", "cannot be negative"),
    (BODIES_LIMITS + GEARS.replace("-3", "{}"), "-0.001", "0", "must not be 0"),
    (BODIES_LIMITS + TRAIN + "ratio = -3\nefficiency = {}", "1", "1.001", "share of the work"),
    (BODIES_LIMITS + TRAIN + "ratio = -3\nefficiency = {}", "0.001", "0", "share of the work"),
    (BODIES_LIMITS + TRAIN + "ratio = {}", "1.0e-6", "0.99e-6", "must not be 0"),
    (BODIES_LIMITS + TRAIN + "ratio = {}", "-1.0e-6", "-0.99e-6", "must not be 0"),
    (BODIES_LIMITS + LEAF, "4.9 mm", "5 mm", "a leaf is thin"),
    (BODIES_LIMITS + SPRING + 'rest = "5°"\nstop = "2°"\nrestitution = {}', "1", "1.001", "lies between"),
    (BODIES_LIMITS + SPRING + 'rest = "5°"\nstop = "2°"\nrestitution = {}', "0", "-0.001", "lies between"),
    (BODIES_LIMITS + SPRING + 'rest = "5°"\nstop = "{}°"', "0", "-0.1", "stands beyond it"),
    (BODIES_LIMITS + SPRING + 'draw = {{ inner = "1 mm", outer = "2 mm", turns = {} }}', "1", "0.99", "1 to 100 turns"),
    (BODIES_LIMITS + SPRING + 'draw = {{ inner = "1 mm", outer = "2 mm", turns = {} }}', "100", "100.1", "1 to 100 turns"),
    (BODIES_LIMITS + SPRING + 'draw = {{ inner = "1 mm", outer = "{} mm", turns = 9 }}', "1.001", "1", "outside the collet"),
    (BODIES_LIMITS + '[[damping]]\nbody = "wheel"\nviscous = "{} nN·m·s"', "0", "-0.001", "would drive"),
    (BODIES_LIMITS + '[[damping]]\nbody = "wheel"\nquadratic = "{} nN·m·s²/rad²"', "0", "-0.001", "would drive"),
    (BODIES_LIMITS + '[[damping]]\nbody = "wheel"\ncoulomb = "{} nN·m"', "0", "-0.001", "would drive"),
    (BODIES_LIMITS + SPRING + '[timegrapher]\nfrequency = "{} Hz"', "0.8753", "0.8754", "more than 10 % off"),
    (BODIES_LIMITS + SPRING + '[timegrapher]\nfrequency = "{} Hz"', "0.7162", "0.7161", "more than 10 % off"),
    (WIRE + 'inner = "0.6 mm"\nouter = "{} mm"\nwidth = "1 nm"\nturns = 9', "0.61", "0.6", "larger than inner"),
    (WIRE + 'inner = "0.6 mm"\nouter = "1.5 mm"\nwidth = "{} mm"\nturns = 9', "0.099", "0.101", "only 0.1 mm of room"),
    (WIRE + 'inner = "0.1 mm"\nouter = "4.6 mm"\nwidth = "{} mm"\nturns = 9', "0.199", "0.2", "only 0.2 mm of room"),
    (SCREW + "count = {}", "1", "0", "from 1 to 1000"),
    (SCREW + "count = {}", "1000", "1001", "from 1 to 1000"),
]


@pytest.mark.parametrize(("text", "taken", "refused", "said"), LIMITS)
def test_the_last_value_is_taken_and_the_next_refused(text: str, taken: str, refused: str, said: str) -> None:
    read(text.format(taken))
    with pytest.raises(SceneError) as caught:
        read(text.format(refused))
    (fault,) = caught.value.faults
    assert said in str(fault)


TURN = math.radians


LEAF_SPRINGS_READ = 'leaf = { modulus = "200 GPa", length = "5 mm", width = "2 mm", thickness = "0.1 mm"%s }\n'
BENT = 3.0 * 200e9 * (2e-3 * 1e-12 / 12.0) / 125e-9  # N/m
SPRINGS = [
    (spring("a", 'frequency = "3 Hz"\nrest = "20°"\n'), Spring("a", 5e-7 * (6 * math.pi) ** 2, TURN(20), 3.0)),
    (spring("s", 'frequency = "3 Hz"\n'), Spring("s", 2e-3 * (6 * math.pi) ** 2, 0.0, 3.0)),
    (spring("a", 'stiffness = "4 µN·m/rad"\npreload = "1 µN·m"\n'), Spring("a", 4e-6, TURN(30) + 0.25)),
    (spring("a", 'stiffness = "4 µN·m/rad"\npreload = "1 µN·m"\nstop = "10°"\nrestitution = 0\n'), None),
    (spring("s", 'stiffness = "4 N/m"\npreload = "3 mN"\nstop = "-1 mm"\n'), None),
    (
        spring("s", 'stiffness = "4 N/m"\npreload = "-3 mN"\nstop = "-1 mm"\nrestitution = 0.4\n'),
        Spring("s", 4.0, -1.75e-3, stop=-1e-3, restitution=0.4),
    ),
    (
        spring("a", 'stiffness = "4 µN·m/rad"\npreload = "-1 µN·m"\nstop = "10°"\nrestitution = 0.4\n'),
        Spring("a", 4e-6, TURN(10) - 0.25, stop=TURN(10), restitution=0.4),
    ),
    (spring("a", LEAF_SPRINGS_READ % ', arm = "3 mm"'), Spring("a", BENT * 9e-6)),
    (spring("s", LEAF_SPRINGS_READ % ""), Spring("s", BENT)),
    (spring("s", 'against = "t"\nstiffness = "4 N/m"\npreload = "2 N"\n'), Spring("s", 4.0, 0.5, against="t")),
    (spring("a", 'against = "d"\nstiffness = "4 N·m/rad"\npreload = "2 N·m"\n'), Spring("a", 4.0, 0.5 + TURN(30), against="d")),
    (spring("a", 'stiffness = "4 N·m/rad"\ncubic = "-3 µN·m/rad³"\n'), Spring("a", 4.0, cubic=-3e-6)),
    (spring("s", 'stiffness = "4 N/m"\ncubic = "2 N/mm³"\n'), Spring("s", 4.0, cubic=2e9)),
    (spring("s", 'stiffness = "4 N/m"\ncubic = "2 N·m/rad³"\n'), None),
    (spring("s", 'against = "t"\nstiffness = "4 N/m"\ncubic = "2 N/m³"\n'), None),
    (spring("s", 'stiffness = "4 N/m"\ncubic = "2 N/m³"\n') + spring("s", 'stiffness = "1 N/m"\n'), None),
    ('[bodies.c]\non = "a"\ninertia = "5 g·cm²"\n' + spring("c", 'stiffness = "4 N·m/rad"\ncubic = "2 N·m/rad³"\n'), None),
    (spring("d", 'stiffness = "4 N·m/rad"\n'), None),
    (spring("b", 'stiffness = "4 N·m/rad"\n'), None),
    (spring("a", 'against = "s"\nstiffness = "4 N·m/rad"\n'), None),
    (spring("a", LEAF_SPRINGS_READ % ""), None),
    (spring("s", LEAF_SPRINGS_READ % ', arm = "3 mm"'), None),
]


@pytest.mark.parametrize(("text", "expected"), SPRINGS)
def test_a_spring_on_a_coordinate(text: str, expected: Spring | None) -> None:
    if expected is None:
        assert len(faults(BODIES + text)) == 1
        return
    (found,) = read(BODIES + text).springs
    for name in ("body", "against", "coil"):
        assert getattr(found, name) == getattr(expected, name)
    for name in ("stiffness", "cubic", "rest", "frequency", "stop", "restitution"):
        one, other = getattr(found, name), getattr(expected, name)
        assert one is None if other is None else one == pytest.approx(other, rel=1e-12, abs=0.0), name


WITH_CARRIED = BODIES + '[bodies.c]\non = "a"\ninertia = "5 g·cm²"\n'
POINTS = 'points = [["4 mm", "1 mm"], ["-2 mm", "5 mm"]]\n'


def line(ends: str, more: str, points: str = POINTS) -> str:
    return f"[[line_springs]]\nbetween = {ends}\n{points}{more}"


def apart(other: complex, turned: complex) -> float:
    """m, at the start, of (4, 1) mm on the body a from (-2, 5) mm on another."""
    first = 3e-3 - 2e-3j + (4e-3 + 1e-3j) * complex(math.cos(TURN(30)), math.sin(TURN(30)))
    return abs(first - (other + (-2e-3 + 5e-3j) * turned))


FIXED = apart(11e-3 + 6e-3j, complex(math.cos(TURN(50)), -math.sin(TURN(50))))
FREE = apart(0j, 1 + 0j)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (line('["a", "b"]', 'stiffness = "20 N/m"\nlength = "0.5 mm"\n'), (("a", "b"), 20.0, 5e-4, 0.0)),
        (line('["a", "b"]', 'stiffness = "20 N/m"\nlength = "0 mm"\n'), (("a", "b"), 20.0, 0.0, 0.0)),
        (line('["a", "b"]', 'stiffness = "20 N/m"\n'), (("a", "b"), 20.0, FIXED, 0.0)),
        (line('["a", "b"]', 'stiffness = "20 N/m"\ntension = "0.08 N"\n'), (("a", "b"), 20.0, FIXED - 4e-3, 0.0)),
        (line('["a", "b"]', 'stiffness = "20 N/m"\ntension = "-0.08 N"\n'), (("a", "b"), 20.0, FIXED + 4e-3, 0.0)),
        (line('["a"]', 'stiffness = "20 N/m"\nviscous = "3 N·s/m"\n'), (("a", None), 20.0, FREE, 3.0)),
    ],
)
def test_a_line_spring_between_two_points(text: str, expected: tuple[tuple[str, str | None], float, float, float]) -> None:
    (found,) = read(WITH_CARRIED + text).line_springs
    assert isinstance(found, LineSpring) and found.between == expected[0]
    assert (found.stiffness, found.length, found.viscous) == pytest.approx(expected[1:], rel=1e-12, abs=0.0)
    assert found.points == ((4e-3, 1e-3), (-2e-3, 5e-3))


STIFF = 'stiffness = "20 N/m"\n'
REFUSED_LINE_SPRINGS_READ = [
    (line('["a", "b"]', 'stiffness = "20 N/m"\nlength = "-0.1 µm"\n'), ["line_springs.0.length: a length is not negative"]),
    (
        line('["a", "b"]', f'stiffness = "20 N/m"\ntension = "{20 * FIXED + 1e-6!r} N"\n'),
        ["line_springs.0.tension: without force"],
    ),
    (line('["a", "b"]', STIFF + 'length = "1 mm"\ntension = "1 N"\n'), ["line_springs.0.tension: length and tension say"]),
    (line('["a", "b"]', STIFF + 'viscous = "-0.1 N·s/m"\n'), ["line_springs.0.viscous: negative damping"]),
    (line('["a", "b"]', ""), ["line_springs.0: missing: stiffness"]),
    (line('["a", "b"]', STIFF, ""), ["line_springs.0: a point of each is needed"]),
    (line('["a", "b"]', STIFF, 'points = [["1 mm", "2 mm"]]\n'), ["line_springs.0.points: a point of each is needed"]),
    (line('["a", "b"]', STIFF, 'points = [["1 mm", "2 mm"], ["3 mm", 4]]\n'), ["line_springs.0.points.1.1: a bare number"]),
    (line('["b"]', STIFF), ["line_springs.0.between: nothing that it holds can give way"]),
    (line('["d", "b"]', STIFF), ["line_springs.0.between: nothing that it holds can give way"]),
    (line('["d"]', STIFF), ["line_springs.0.between: nothing that it holds can give way"]),
    (line('["a", "b", "d"]', STIFF), ["line_springs.0.between: one or two bodies are needed"]),
    (line('["a", "a"]', STIFF), ["line_springs.0.between: one or two bodies are needed"]),
    (line("[]", STIFF), ["line_springs.0.between: one or two bodies are needed"]),
    ("[[line_springs]]\n" + STIFF + POINTS, ["line_springs.0: one or two bodies are needed"]),
    (line('["a", "e"]', STIFF), ['line_springs.0.between.1: there is no body "e"']),
    (line('["c"]', STIFF), ["line_springs.0.between.0: c is carried by a"]),
    (line('["a"]', STIFF, 'points = [["0 mm", "0 mm"], ["3 mm", "-2 mm"]]\n'), ["line_springs.0.points: lie on each other"]),
]


@pytest.mark.parametrize(("text", "expected"), REFUSED_LINE_SPRINGS_READ)
def test_what_cannot_be_is_said_once_line_springs_read(text: str, expected: list[str]) -> None:
    said = faults(WITH_CARRIED + text)
    assert len(said) == len(expected) and all(one.startswith(words) for one, words in zip(said, expected, strict=True)), said


def test_a_faulty_value_is_replaced(desk, good):
    bad = desk.scene(good.replace('drawing = "wheel.dxf"', 'drawing = "lost.dxf"').replace('"180 s"\n', "180\n"))
    mended = load_set(bad, {"bodies.wheel.drawing": "wheel.dxf", "run.duration": "20 s"})
    assert mended == changed(load(desk.scene(good)), {"run.duration": "20 s"})


def test_every_fault_is_told_once_with_its_source(desk, good):
    bad = desk.scene(good.replace("friction = 0.12", "friction = -1"))
    with pytest.raises(SceneError) as caught:
        load_set(bad, {"torques.0.value": "3 mm", "bodies.whel.angle": "1°"})
    assert {(fault.key, fault.place.rpartition("/")[2]) for fault in caught.value.faults} == {
        ("contacts.0.friction", "scene.toml:42"),
        ("torques.0.value", "--set"),
        ("bodies.whel.angle", "--set"),
    }


def test_one_coordinate_of_a_place_that_the_drawing_gives(desk):
    """The pivot is at (5, -7) mm in the drawing, where the body stands; a new pivot moves what is not said."""
    desk.put(drawing("plate.dxf", (square(2e-3, (5e-3, -7e-3), "B"),), points=(("Q", 5e-3, -7e-3),)))
    path = desk.scene('[bodies.b]\ndrawing = "plate.dxf"\nlayers = ["B"]\nposition = "as drawn"\npivot = "Q"\nmass = "2 g"\n')
    assert load_set(path, {"bodies.b.position.0": "6 mm"}).body("b").position == pytest.approx((6e-3, -7e-3))
    both = {"bodies.b.position.0": "6 mm", "bodies.b.pivot": ["5 mm", "-8 mm"]}
    assert load_set(path, both).body("b").position == pytest.approx((6e-3, -8e-3))
    with pytest.raises(SceneError, match=r'^--set  bodies\.b\.position\.0 = "6 s"\n.*here a length is needed'):
        load_set(path, {"bodies.b.position.0": "6 s"})


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("bodies = 5", "bodies.wheel.angle"),
        ("[bodies]\nwheel = 5", "bodies.wheel.angle"),
        ("run = 5", "run.duration"),
        ("expect = 5", "expect.rate.value"),
        ("springs = 5", "springs.0.rest"),
        ("springs = [5]", "springs.0.rest"),
        ("[bodies.wheel]\nsolids = 5", "bodies.wheel.solids.0.density"),
        ("[bodies.wheel]\nsolids = [5]", "bodies.wheel.solids.0.density"),
        ("[bodies.wheel]\nswing = 5", "bodies.wheel.swing.phase"),
        ("[[torques]]\ntrain = [5]", "torques.0.train.0.ratio"),
    ],
)
def test_what_is_no_table_is_left_to_the_reader(desk, text, key):
    with pytest.raises(SceneError) as caught:
        load_set(desk.scene(text), {key: "1"})
    assert caught.value.faults and key not in [fault.key for fault in caught.value.faults]


def test_a_design_takes_its_values_first(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('[design]\nof = "swiss_lever"\nlock = "95°"\n', encoding="utf-8")
    assert load_set(path, {"design.lock": "2°"}).path == path
    with pytest.raises(SceneError, match=r'^--set  design\.lock = "96°"'):
        load_set(path, {"design.lock": "96°"})
