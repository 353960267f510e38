"""Which coordinates have forces and joints, and with what numbers?"""

from __future__ import annotations

import math

import pytest

from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Damping, Spring, Torque
from watchsim.scene.prescribed import Prescribed
from watchsim.scene.scene import Scene

DOWN = (2.0, -9.0)


def test_a_carried_body_is_poised_to_the_last_digit() -> None:
    """On the first body of the scene or on another: what rounding leaves of its moment pulls at nothing."""
    carrier = Body("c", inertia=3.0, mass=1.0)
    load = Body("b", inertia=1.0, mass=2.0, centre_of_mass=(1e-12, 0.0), position=(0.5, 0.0), on="c")
    for bodies in ((carrier, load), (Body("x", inertia=1.0), carrier, load)):
        rows = compile_scene(Scene("poised", bodies, gravity=DOWN)).model.coordinates
        assert rows.weight_x[-1] == rows.weight_y[-1] == 0.0 and rows.weight_x[-2] == pytest.approx(2.0 * 0.5 * 2.0)
        assert rows.weight_y[-2] == pytest.approx(2.0 * 0.5 * -9.0) and rows.linear[-1] == 1


def test_gravity_on_each_kind_of_body() -> None:
    """A pendulum's moment, turned a quarter, is its torque; along the axis of a slide; on both places of a free body."""
    bodies = (
        Body("p", inertia=7.0, mass=3.0, centre_of_mass=(0.25, -0.5)),
        Body("s", "slide", axis=(0.6, 0.8), mass=5.0),
        Body("f", "free", mass=4.0, inertia=6.0),
        Body("d", "pivot", inertia=7.0, mass=3.0, centre_of_mass=(0.25, -0.5)),
    )
    rows = compile_scene(Scene("heavy", bodies, gravity=DOWN)).model.coordinates
    assert rows.mass.tolist() == [7.0, 5.0, 4.0, 4.0, 6.0, 7.0]
    assert rows.force.tolist() == pytest.approx([0.0, 5.0 * (0.6 * 2.0 - 0.8 * 9.0), 8.0, -36.0, 0.0, 0.0])
    sx, sy = 0.75, -1.5
    assert (rows.weight_x[0], rows.weight_y[0]) == pytest.approx((sx * 2.0 + sy * -9.0, sx * -9.0 - sy * 2.0))
    for q in (0.0, 0.7, -2.0):  # the torque of the weight at the angle q
        x, y = sx * math.cos(q) - sy * math.sin(q), sx * math.sin(q) + sy * math.cos(q)
        torque = x * -9.0 - y * 2.0
        assert math.cos(q) * rows.weight_y[0] - math.sin(q) * rows.weight_x[0] == pytest.approx(torque)


@pytest.mark.parametrize("first", ["free", "pivot"])
def test_a_joint_with_a_free_carrier_acts_on_its_angle(first: str) -> None:
    """The third coordinate of the free body, the only one of the pivoted; the load's comes behind."""
    carrier = Body("c", first, mass=5.0, inertia=3.0, angle=0.4)
    load = Body("b", inertia=2.0, on="c", angle=0.3)
    forces = {"springs": (Spring("b", 8.0, 0.25),), "damping": (Damping("b", 3.0, 5.0),), "torques": (Torque("b", 7.0),)}
    compiled = compile_scene(Scene("joint", (Body("x", inertia=1.0), carrier, load), **forces))  # type: ignore[arg-type]
    (joint,) = compiled.model.joints
    number = 3 if first == "free" else 1
    assert (joint.coordinate, joint.on, joint.watched) == (number + 1, number, 1)
    assert (joint.stiffness, joint.rest, joint.viscous, joint.quadratic, joint.force) == (8.0, 0.25, 3.0, 5.0, 7.0)
    assert compiled.fastest == pytest.approx(math.sqrt(8.0 * (1.0 / 3.0 + 1.0 / 2.0)))


def test_several_springs_on_one_coordinate_are_one() -> None:
    springs = (Spring("a", 3.0, 0.5), Spring("b", 1.0, 9.0), Spring("a", 5.0, -0.75), Spring("a", 2.0, 4.0))
    rows = compile_scene(Scene("sprung", (Body("b", inertia=4.0), Body("a", inertia=0.5)), springs=springs)).model.coordinates
    assert rows.stiffness.tolist() == [1.0, 10.0]
    assert rows.rest.tolist() == pytest.approx([9.0, (1.5 - 3.75 + 8.0) / 10.0])
    assert rows.rate.tolist() == [pytest.approx(math.sqrt(20.0))] * 2


def test_without_springs_the_rate_is_that_of_the_strongest_push() -> None:
    bodies = (Body("a", inertia=4.0), Body("s", "slide", axis=(1.0, 0.0), mass=0.5))
    torques = (Torque("a", 12.0), Torque("a", -3.0), Torque("s", 2e-3))
    compiled = compile_scene(Scene("pushed", bodies, torques=torques))
    assert compiled.size == 1e-3 and compiled.fastest == 0.0
    assert compiled.model.coordinates.force.tolist() == [9.0, 2e-3]
    assert compiled.model.coordinates.rate.tolist() == [pytest.approx(math.sqrt(2e-3 / (0.5 * 1e-3)))] * 2
    assert compile_scene(Scene("idle", bodies)).model.coordinates.rate.tolist() == [1.0, 1.0]


def test_between_two_bodies_a_joint_takes_the_difference() -> None:
    """Of the angles as the scene gives them; its rest as well."""
    bodies = (Body("c", inertia=3.0, angle=0.4), Body("e", inertia=6.0, angle=-0.1))
    scene = Scene("two", bodies, springs=(Spring("e", 8.0, 0.25, against="c"),), damping=(Damping("e", 3.0, against="c"),))
    compiled = compile_scene(scene)
    (joint,) = compiled.model.joints
    assert (joint.coordinate, joint.on, joint.stiffness, joint.rest, joint.viscous) == (1, 0, 8.0, 0.25, 3.0)
    assert compiled.fastest == pytest.approx(math.sqrt(8.0 * (1.0 / 3.0 + 1.0 / 6.0)))


def test_a_driven_body_gives_way_to_nothing() -> None:
    """A spring between it and another swings that one alone; so does a torque, without springs."""
    bodies = (Body("c", inertia=3.0, prescribed=Prescribed()), Body("e", inertia=6.0))
    sprung = compile_scene(Scene("two", bodies, springs=(Spring("e", 8.0, against="c"),)))
    assert sprung.fastest == pytest.approx(math.sqrt(8.0 / 6.0), rel=1e-12)
    pushed = compile_scene(Scene("two", bodies, torques=(Torque("e", 12.0, against="c"),)))
    assert pushed.fastest == 0.0 and pushed.model.coordinates.rate.tolist() == [pytest.approx(math.sqrt(2.0))] * 2


@pytest.mark.parametrize("over", ["angle", "time"])
def test_tables_follow_one_another(over: str) -> None:
    """With their coordinates; abscissae of an angle in the movement, on a plate that is turned."""
    tables = (((1.0, 3.0), (2.0, 5.0)), ((0.5, -1.0), (4.0, 2.0), (9.0, 3.0)))
    torques = (Torque("a", over=over, table=tables[0]), Torque("b", over=over, table=tables[1], period=None))
    bodies = (Body("plate", "fixed", angle=0.25), Body("b", inertia=4.0), Body("a", inertia=0.5, on="plate"))
    model = compile_scene(Scene("tables", bodies, torques=torques)).model
    assert [(row.coordinate, row.on, row.start, row.count) for row in model.tables] == [(1, -1, 0, 2), (0, -1, 2, 3)]
    shift = 0.25 if over == "angle" else 0.0
    expected = [(1.0 + shift, 3.0), (2.0 + shift, 5.0), (0.5, -1.0), (4.0, 2.0), (9.0, 3.0)]
    assert [tuple(knot) for knot in model.knots.tolist()] == [pytest.approx(knot) for knot in expected]
    assert model.coordinates.linear.tolist() == [0, 0]
