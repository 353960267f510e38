"""How do forces on geared bodies act on the coordinate that they share? By virtual work."""

from __future__ import annotations

import pytest

from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Damping, Spring, Torque
from watchsim.scene.gearing import Geared
from watchsim.scene.prescribed import Prescribed
from watchsim.scene.scene import Scene

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
