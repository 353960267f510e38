"""How do gears with play and stops of springs become racks, a tooth and flanks? By hand, with unequal numbers."""

from __future__ import annotations

import math

import pytest

from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.backlash import FLANK, TOOTH, pitch_radius, rack_ways, with_racks
from watchsim.scene.body import Body
from watchsim.scene.carriers import rides
from watchsim.scene.force import Spring
from watchsim.scene.gearing import Gear, Geared
from watchsim.scene.scene import Scene

SIZE = 0.02
WHEEL, PINION = Body("wheel", position=(1e-3, 2e-3), inertia=1.0), Body("pinion", position=(4e-3, 6e-3), inertia=1.0)
RACK = Body("rack", "slide", mass=1.0, position=(5e-3, 0.0))


def line_of(body: Body, k: int = 0) -> Line:
    edge = body.loops[k].edges[0]
    assert isinstance(edge, Line) and not body.loops[k].closed
    return edge


@pytest.mark.parametrize(
    ("first", "second", "ratio", "radius"),
    [
        (WHEEL, PINION, -3.0, 5e-3 / 4.0),
        (WHEEL, PINION, 3.0, 5e-3 / 2.0),
        (WHEEL, PINION, 0.25, 5e-3 / 0.75),
        (WHEEL, PINION, 1.0, SIZE),
        (WHEEL, WHEEL, -3.0, SIZE),
        (RACK, PINION, 400.0, SIZE),
        (WHEEL, RACK, 0.4, 1.0),
        (RACK, RACK, 0.4, 1.0),
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
    made, named = with_racks(Scene("t", (WHEEL, PINION), gears=(gear,)), SIZE)
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
    made, _ = with_racks(Scene("t", (WHEEL, PINION, third), gears=(Gear(("third", "pinion"), -3.0, 0.08),)), SIZE)
    radius = math.dist(third.position, PINION.position) / 4.0
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
    made, _ = with_racks(Scene("t", (RACK,), springs=(Spring("rack", 3.0, 0.5e-3, stop=0.2e-3),)), SIZE)
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
    scene = Scene("t", (WHEEL, PINION), springs=(Spring("wheel", 3.0),))
    assert with_racks(scene, SIZE) == (scene, {})
