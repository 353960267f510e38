"""How do geared bodies share a coordinate, and what do racks and planets feel? By virtual work and by hand."""

import math
from pathlib import Path

import pytest
from made_gears import read

from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.backlash import FLANK, TOOTH, pitch_radius, rack_ways, with_racks
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.forces import Damping, Spring, Torque
from watchsim.scene.scene import Body, Gear, Geared, Prescribed, Scene
from watchsim.scene.trains import rides

# How do forces on geared bodies act on the coordinate that they share? By virtual work.

WHEEL = Body("wheel", inertia=7.0, angle=0.5)
PINION = Body("pinion", inertia=2.0, angle=-0.25, geared=Geared("wheel", -3.0))
RACK = Body("rack", "slide", mass=5.0, axis=(0.6, 0.8), geared=Geared("wheel", 0.5))
BODIES = (PINION, Body("other", inertia=1.0), WHEEL, RACK)


def test_with_the_ratio_as_lever_arm() -> None:
    """Stiffness by its square, quadratic damping by its cube, dry friction by its size."""
    scene = Scene(
        "t",
        BODIES,
        springs=(Spring("pinion", 4.0, 1.25), Spring("wheel", 9.0, -0.5)),
        torques=(Torque("pinion", 6.0), Torque("rack", 10.0), Torque("wheel", 1.0)),
        damping=(Damping("pinion", 2.0, 3.0, 5.0), Damping("rack", 8.0, 16.0, 4.0), Damping("wheel", 0.25, 0.125, 0.5)),
        gravity=(1.0, -9.0),
    )
    other, row = compile_scene(scene).model.coordinates
    assert (other.mass, other.force, other.viscous, other.stiffness) == (1.0, 0.0, 0.0, 0.0)
    assert row.mass == pytest.approx(7.0 + 9.0 * 2.0 + 0.25 * 5.0)
    assert row.force == pytest.approx(-3.0 * 6.0 + 0.5 * 10.0 + 1.0 + 0.5 * 5.0 * (0.6 - 7.2))
    assert row.viscous == pytest.approx(9.0 * 2.0 + 0.25 * 8.0 + 0.25)
    assert row.quadratic == pytest.approx(27.0 * 3.0 + 0.125 * 16.0 + 0.125)
    assert row.coulomb == pytest.approx(3.0 * 5.0 + 0.5 * 4.0 + 0.5)
    assert row.stiffness == pytest.approx(9.0 * 4.0 + 9.0)
    rest = 0.5 + (1.25 + 0.25) / -3.0  # of the wheel, where the pinion stands at 1.25
    assert row.rest == pytest.approx((36.0 * rest + 9.0 * -0.5) / 45.0)


def test_a_table_of_a_geared_body_is_one_of_the_coordinate() -> None:
    """Its abscissae turn round with the ratio, its values are multiplied by it."""
    table = ((-0.25, 10.0), (2.75, 20.0), (5.75, 40.0))
    model = compile_scene(Scene("t", BODIES, torques=(Torque("pinion", over="angle", table=table),))).model
    assert [tuple(knot) for knot in model.knots.tolist()] == [
        pytest.approx(knot) for knot in ((-1.5, -120.0), (-0.5, -60.0), (0.5, -30.0))
    ]
    assert (model.tables[0].coordinate, model.tables[0].on) == (1, -1)


def test_a_driven_holder_weighs_nothing_and_feels_no_gravity() -> None:
    law = Prescribed(square=4.0, middle=0.75)
    driven = Body("wheel", inertia=7.0, angle=0.5, prescribed=law)
    rows = compile_scene(Scene("t", (driven, PINION, RACK), gravity=(1.0, -9.0))).model.coordinates
    (row,) = rows
    assert (row.mass, row.driven, row.scale, row.stiffness, row.rest, row.force) == (1.0, 1, 1.0, 4.0, 0.75, 0.0)
    path = Body("s", "slide", mass=3.0, prescribed=Prescribed(table=((0.0, 0.0), (1.0, 2.0), (3.0, 0.0))))
    model = compile_scene(
        Scene("t", (Body("a", inertia=1.0), path), torques=(Torque("a", over="time", table=((5.0, 6.0), (7.0, 8.0))),))
    ).model
    assert [(one.coordinate, one.on, one.start, one.count) for one in model.tables] == [(0, -1, 0, 2), (1, -1, 2, 3)]
    assert model.knots.tolist() == [[5.0, 6.0], [7.0, 8.0], [0.0, 0.0], [1.0, 2.0], [3.0, 0.0]]
    assert model.coordinates[1].scale == 1e-3


# How do gears with play and stops of springs become racks, a tooth and flanks? By hand, with unequal numbers.

SIZE = 0.02
WHEEL_RACKS, PINION_RACKS = (
    Body("wheel", position=(1e-3, 2e-3), inertia=1.0),
    Body("pinion", position=(4e-3, 6e-3), inertia=1.0),
)
RACK_RACKS = Body("rack", "slide", mass=1.0, position=(5e-3, 0.0))


def line_of(body: Body, k: int = 0) -> Line:
    edge = body.loops[k].edges[0]
    assert isinstance(edge, Line) and not body.loops[k].closed
    return edge


@pytest.mark.parametrize(
    ("first", "second", "ratio", "radius"),
    [
        (WHEEL_RACKS, PINION_RACKS, -3.0, 5e-3 / 4.0),
        (WHEEL_RACKS, PINION_RACKS, 3.0, 5e-3 / 2.0),
        (WHEEL_RACKS, PINION_RACKS, 0.25, 5e-3 / 0.75),
        (WHEEL_RACKS, PINION_RACKS, 1.0, SIZE),
        (WHEEL_RACKS, WHEEL_RACKS, -3.0, SIZE),
        (RACK_RACKS, PINION_RACKS, 400.0, SIZE),
        (WHEEL_RACKS, RACK_RACKS, 0.4, 1.0),
        (RACK_RACKS, RACK_RACKS, 0.4, 1.0),
    ],
)
def test_both_run_alike_at_the_pitch_point(first: Body, second: Body, ratio: float, radius: float) -> None:
    assert pitch_radius(first, second, ratio, SIZE) == pytest.approx(radius, rel=1e-12)


@pytest.mark.parametrize("order", [("carriage", "planet"), ("planet", "carriage")])
def test_of_a_carriage_and_a_planet_the_carriage_goes_one_more(order: tuple[str, str]) -> None:
    bodies = (Body("carriage", inertia=1.0), Body("planet", inertia=1.0, position=(3e-3, 4e-3), on="carriage"))
    ways = rack_ways(Scene("t", bodies), rides(bodies), Gear(order, 4.0, 0.1), SIZE)
    carriage = order.index("carriage")
    assert ways.far[carriage] == 5.0 if carriage == 0 else ways.far == (4.0, 5.0)
    assert ways.far == ((5.0, 1.0) if carriage == 0 else (4.0, 5.0))
    assert ways.askew == ((0.6, -1.0) if carriage == 0 else (1.0, 0.6)) and ways.reach == pytest.approx(1e-3)
    on_axis = (bodies[0], Body("planet", inertia=1.0, on="carriage"))
    assert rack_ways(Scene("t", on_axis), rides(on_axis), Gear(order, 4.0, 0.1), SIZE).reach == SIZE


@pytest.mark.parametrize("efficiency", [1.0, 0.6])
def test_a_tooth_between_two_flanks(efficiency: float) -> None:
    """Half the play at the pitch radius on either side; askew by 45° where work is lost, by as much further."""
    gear = Gear(("wheel", "pinion"), -3.0, 0.08, 0.4, efficiency)
    made, named = with_racks(Scene("t", (WHEEL_RACKS, PINION_RACKS), gears=(gear,)), SIZE)
    tooth, flanks = made.bodies[2:]
    arc = tooth.loops[0].edges[0]
    assert isinstance(arc, Arc) and (arc.radius, arc.x, arc.y) == (pytest.approx(2e-3), 0.0, 0.0) and TOOTH == 0.1
    apart = 2e-3 + 0.5 * 0.08 * 1.25e-3
    one, other = line_of(flanks, 0), line_of(flanks, 1)
    assert (one.x0, one.x1, other.x0, other.x1) == pytest.approx((apart, apart, -apart, -apart), rel=1e-12)
    assert (one.y0, one.y1, other.y0, other.y1) == (FLANK * SIZE, -FLANK * SIZE, -FLANK * SIZE, FLANK * SIZE)
    long = math.sqrt(2.0) if efficiency < 1.0 else 1.0
    assert tooth.geared == Geared("wheel", pytest.approx(-3.0 * 1.25e-3 * long))
    assert flanks.geared == Geared("pinion", pytest.approx(1.25e-3 * long))
    slope = 1.0 if efficiency < 1.0 else 0.0
    assert tooth.axis == pytest.approx((1.0 / long, slope / long)) and flanks.axis == pytest.approx((1.0 / long, -slope / long))
    (contact,) = made.contacts
    assert contact.friction == pytest.approx(0.25 if efficiency < 1.0 else 0.0) and contact.restitution == 0.4
    assert named == {tooth.name: "wheel", flanks.name: "pinion"} and contact.sides[0].body == tooth.name


def test_racks_of_geared_bodies_are_geared_to_what_those_are_geared_to() -> None:
    third = Body("third", position=(9e-3, 0.0), inertia=1.0, geared=Geared("wheel", 7.0))
    made, _ = with_racks(Scene("t", (WHEEL_RACKS, PINION_RACKS, third), gears=(Gear(("third", "pinion"), -3.0, 0.08),)), SIZE)
    radius = math.dist(third.position, PINION_RACKS.position) / 4.0
    assert made.bodies[3].geared == Geared("wheel", pytest.approx(7.0 * -3.0 * radius))
    assert made.bodies[4].geared == Geared("pinion", pytest.approx(radius))


@pytest.mark.parametrize(
    ("rest", "stop", "angle", "side"), [(0.9, 0.5, 0.2, -1.0), (-0.9, -0.5, 0.2, 1.0), (0.1, 0.4, 0.6, 1.0)]
)
def test_a_stop_is_a_flank_on_the_way_to_the_rest(rest: float, stop: float, angle: float, side: float) -> None:
    """As far from the tooth as the body still has to go."""
    body = Body("click", inertia=1.0, angle=angle)
    spring = Spring("click", 3.0, rest, stop=stop, restitution=0.3)
    made, named = with_racks(Scene("t", (body,), springs=(Spring("click", 2.0), spring)), SIZE)
    tooth, wall = made.bodies[1:]
    line = line_of(wall)
    assert tooth.geared == Geared("click", SIZE) and tooth.axis == (1.0, 0.0) and wall.motion == "fixed"
    assert line.x0 == line.x1 == pytest.approx(-side * (2e-3 + abs(angle - stop) * SIZE), rel=1e-12)
    assert (line.y0, line.y1) == (-side * FLANK * SIZE, side * FLANK * SIZE)
    assert named == {tooth.name: "click", wall.name: "click"} and made.contacts[0].restitution == 0.3
    assert tooth.name == "click stop 0" and wall.name == "click stop 0 of the movement"


def test_a_stop_against_another_body_is_on_its_rack() -> None:
    bodies = (Body("click", inertia=1.0, angle=0.7), Body("wheel", inertia=1.0, angle=0.1))
    made, named = with_racks(Scene("t", bodies, springs=(Spring("click", 3.0, 0.9, against="wheel", stop=0.2),)), SIZE)
    tooth, wall = made.bodies[2:]
    assert wall.motion == "slide" and wall.geared == Geared("wheel", SIZE) and wall.name == "click stop 0 of wheel"
    assert line_of(wall).x0 == pytest.approx(2e-3 + 0.4 * SIZE) and named == {tooth.name: "click", wall.name: "wheel"}


def test_a_stop_of_a_slide_counts_lengths() -> None:
    made, _ = with_racks(Scene("t", (RACK_RACKS,), springs=(Spring("rack", 3.0, 0.5e-3, stop=0.2e-3),)), SIZE)
    assert made.bodies[1].geared == Geared("rack", 1.0) and line_of(made.bodies[2]).x0 == pytest.approx(2e-3 + 0.2e-3)


def test_on_a_carrier_a_stop_is_one_of_the_carrier() -> None:
    """Whatever body of the scene carries it; on a fixed one it is one of the movement."""
    for motion, other in (("pivot", "slide"), ("fixed", "fixed")):
        bodies = (Body("carriage", motion, inertia=1.0, angle=0.9), Body("click", inertia=1.0, angle=0.3, on="carriage"))
        made, _ = with_racks(Scene("t", bodies, springs=(Spring("click", 3.0, 0.9, stop=0.5),)), SIZE)
        wall = made.bodies[3]
        assert wall.motion == other and line_of(wall).x0 == pytest.approx(2e-3 + 0.2 * SIZE)
        assert wall.geared == (Geared("carriage", SIZE) if motion == "pivot" else None)


def test_without_play_and_stops_nothing_is_added() -> None:
    scene = Scene("t", (WHEEL_RACKS, PINION_RACKS), springs=(Spring("wheel", 3.0),))
    assert with_racks(scene, SIZE) == (scene, {})


# What does gravity do to a geared rack, and where do the gears of a planet roll?

RACK_GEARED_LOADS = """
[scene]
gravity = ["2 m/s²", "-9.81 m/s²"]
[bodies.wheel]
inertia = "1 g·cm²"
[bodies.rack]
motion = "slide"
axis = [3, 4]
mass = "50 g"
position = ["9 mm", "0 mm"]
[[gears]]
between = ["wheel", "rack"]
ratio = "40 mm/rad"
"""
PLANET = """
[bodies.carriage]
inertia = "20 mg·cm²"
[bodies.planet]
on = "carriage"
position = ["3 mm", "4 mm"]
mass = "10 mg"
inertia = "1 mg·cm²"
[[gears]]
between = ["carriage", "planet"]
ratio = {ratio}
backlash = "0.5°"
"""


def test_gravity_pulls_an_oblique_rack_along_its_axis(tmp_path: Path) -> None:
    """By virtual work: the weight goes 40 mm along (0.6, 0.8) for each radian of the wheel."""
    (pull,) = compile_scene(read(tmp_path, RACK_GEARED_LOADS)).model.coordinates["force"]
    assert pull == pytest.approx(50e-3 * 40e-3 * (0.6 * 2.0 - 0.8 * 9.81), rel=1e-12)


@pytest.mark.parametrize("ratio", [8.0, -3.0, 0.25])
def test_a_planet_rolls_where_its_rim_stands_still(ratio: float, tmp_path: Path) -> None:
    """Carried 5 mm from the axis at unit rate, turning at 1 + ratio: at the pitch point both speeds cancel."""
    scene = read(tmp_path, PLANET.format(ratio=ratio))
    ways = rack_ways(scene, rides(scene.bodies), scene.gears[0], 1.0)
    inwards = math.copysign(ways.reach, 1.0 + ratio)
    assert 5e-3 - (1.0 + ratio) * inwards == pytest.approx(0.0, abs=1e-15)
