"""Are oscillator, escape wheel and lever found by what they do, in whatever order a scene names them?"""

from __future__ import annotations

from itertools import permutations

import pytest

from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.roles import Roles, is_driven, roles, with_anchor
from watchsim.scene.scene import Body, Scene

BODIES = tuple(Body(name, "pivot", inertia=1.0) for name in ("third", "wheel", "fork", "balance"))
TOUCHES = tuple(Contact((Side(a), Side(b))) for a, b in (("wheel", "fork"), ("fork", "balance"), ("third", "wheel")))
LEVER = Roles("balance", "wheel", "fork")


@pytest.mark.parametrize("bodies", list(permutations(BODIES)), ids=lambda bodies: "-".join(body.name for body in bodies))
def test_the_lever_touches_both(bodies: tuple[Body, ...]) -> None:
    """The third wheel touches one of them; a torque on the fork itself makes it no wheel."""
    torques = (Torque("fork", 1.0), Torque("wheel", 1.0))
    for order in (torques, torques[::-1], torques[1:]):
        assert roles(Scene("", bodies, (Spring("balance", 1.0),), order, contacts=TOUCHES)) == LEVER


def test_a_lever_may_touch_by_way_of_what_it_carries() -> None:
    bodies = (*BODIES, Body("spring", "pivot", inertia=1.0, on="fork"))
    touches = (TOUCHES[0], Contact((Side("spring"), Side("balance"))))
    assert roles(Scene("", bodies, (Spring("balance", 1.0),), (Torque("wheel", 1.0),), contacts=touches)) == LEVER


def test_what_is_not_there_is_not_found() -> None:
    torques = (Torque("wheel", 1.0),)
    assert roles(Scene("", BODIES, (Spring("balance", 1.0),), torques, contacts=TOUCHES[:1])) == Roles("balance", "wheel", None)
    assert roles(Scene("", BODIES, (), torques, contacts=TOUCHES)) == Roles(None, "wheel", None)
    assert roles(Scene("", BODIES, (Spring("balance", 1.0),), contacts=TOUCHES)) == Roles("balance", None, None)


def test_a_scene_is_driven_where_any_torque_puts_work_in() -> None:
    nothing, value, table = Torque("fork", 0.0), Torque("wheel", -1.0), Torque("wheel", table=((0.0, 1.0), (1.0, 2.0)))
    for torques, driven in (((), False), ((nothing,), False), ((nothing, value), True), ((nothing, table), True)):
        assert is_driven(Scene("", BODIES, torques=torques)) is driven


@pytest.mark.parametrize("touches", [TOUCHES, TOUCHES[:1]])
def test_only_a_pendulum_that_touches_the_wheel_itself_is_its_own_lever(touches: tuple[Contact, ...]) -> None:
    direct = Contact((Side("wheel"), Side("balance")))
    springs, torques = (Spring("balance", 1.0),), (Torque("wheel", 1.0),)
    swing = Scene("", BODIES, springs, torques, contacts=(*touches, direct), lift_angle=1.0)
    assert with_anchor(swing) == (LEVER if len(touches) > 1 else Roles("balance", "wheel", "balance"))
