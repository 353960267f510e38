"""What swings, how fast, and which parts of an escapement follow from it? Made-up scenes with unequal numbers."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.roles import (
    Roles,
    drive_direction,
    frequency,
    hinged_pallets,
    is_driven,
    keeps_time,
    nominal_frequency,
    only_presses,
    oscillator,
    oscillators,
    partners,
    roles,
    swings,
    with_anchor,
)
from watchsim.scene.scene import Body, Gear, Geared, Prescribed, Scene

DOWN = (0.0, -9.0)


def touch(*pairs: str) -> tuple[Contact, ...]:
    return tuple(Contact((Side(pair[0]), Side(pair[1]))) for pair in pairs)


def bodies(names: str, **more: dict[str, object]) -> tuple[Body, ...]:
    return tuple(replace(Body(name, inertia=2.0), **more.get(name, {})) for name in names)  # type: ignore[arg-type]


def hung(name: str, mass: float, away: tuple[float, float], **more: object) -> Body:
    return replace(Body(name, inertia=3.0, mass=mass, centre_of_mass=away), **more)  # type: ignore[arg-type]


@pytest.mark.parametrize("axis", [(0.6, 0.8), (-0.8, 0.6)])
def test_a_slide_sinks_on_its_springs(axis: tuple[float, float]) -> None:
    """By its weight along the slide over all their stiffness."""
    slide = Body("s", "slide", mass=0.5, axis=axis)
    springs = (Spring("s", 30.0, 0.02), Spring("x", 7.0), Spring("s", 10.0, -0.01), Spring("s", 5.0, against="x"))
    found = oscillator((slide, Body("x", inertia=1.0)), springs, (2.0, -9.0), "s")
    assert found is not None
    middle, pull = (30.0 * 0.02 - 10.0 * 0.01) / 40.0, 0.5 * (2.0 * axis[0] - 9.0 * axis[1])
    assert (found.inertia, found.spring, found.gravity, found.weight) == (0.5, 40.0, 0.0, 0.0)
    assert found.rest == pytest.approx(middle + pull / 40.0, rel=1e-12)
    assert found.hertz == pytest.approx(math.sqrt(80.0) / math.tau, rel=1e-12)
    assert oscillator((slide,), (), DOWN, "s") is None and oscillator((slide,), (), DOWN, "none") is None


@pytest.mark.parametrize("name", ["free", "fixed"])
def test_what_neither_turns_nor_slides_does_not_swing(name: str) -> None:
    body = hung("b", 2.0, (0.1, 0.0), motion=name)
    assert oscillator((body,), (Spring("b", 3.0),), DOWN, "b") is None


def test_springs_without_stiffness_stand_where_the_first_does() -> None:
    found = oscillator(bodies("a"), (Spring("a", 0.0, 0.4), Spring("a", 0.0, 0.9)), (0.0, 0.0), "a")
    assert found is not None and (found.rest, found.spring, found.hertz) == (0.4, 0.0, None)


@pytest.mark.parametrize(("angle", "turns"), [(0.0, 0.0), (5.0, 1.0), (-9.0, -1.0)])
def test_a_pendulum_hangs_within_half_a_turn_of_where_it_stands(angle: float, turns: float) -> None:
    """Its mass lies 0.3 to the right and 0.4 up in its frame: it hangs turned by -(90° + 53.13°), or turns later."""
    (found,) = oscillators(Scene("p", (hung("p", 2.0, (0.3, 0.4), angle=angle),), gravity=DOWN))
    assert found.rest == pytest.approx(math.tau * turns - math.pi / 2 - math.atan2(0.4, 0.3), rel=1e-12)
    assert (found.spring, found.gravity, found.weight) == pytest.approx((0.0, 9.0, 9.0)) and found.inertia == 3.0
    assert found.hertz == pytest.approx(math.sqrt(3.0) / math.tau)


def test_gravity_alone_moves_the_heaviest_that_is_not_driven() -> None:
    """Where anything has a spring only sprung bodies count, in the order of their springs."""
    three = (hung("a", 2.0, (0.1, 0.0)), hung("b", 1.0, (0.0, -0.5)), hung("c", 9.0, (0.01, 0.0)), hung("d", 9.0, (0.5, 0.0)))
    torques = (Torque("d", 1.0),)
    assert [one.body for one in oscillators(Scene("t", three, torques=torques, gravity=DOWN))] == ["b"]
    assert oscillators(Scene("t", three, torques=torques)) == ()
    springs = (Spring("c", 1.0, against="a"), Spring("d", 1.0), Spring("a", 2.0), Spring("d", 4.0))
    assert [(one.body, one.spring) for one in oscillators(Scene("t", three, springs, gravity=DOWN))] == [("d", 5.0), ("a", 2.0)]


@pytest.mark.parametrize(("off", "swinging"), [(0.9e-9, False), (1.1e-9, True)])
def test_a_centre_of_mass_off_by_rounding_does_not_swing(off: float, swinging: bool) -> None:
    """A thousand-millionth of the radius of gyration, 0.5 here."""
    body = Body("b", mass=8.0, inertia=2.0, centre_of_mass=(0.3 * off, -0.4 * off))
    assert swings(Scene("t", (body,), gravity=DOWN)) is swinging


def test_the_rate_is_measured_against_what_is_said_first() -> None:
    spring = Spring("a", 8.0, frequency=0.25)
    scene = Scene("t", bodies("ab"), (spring,))
    assert frequency(scene) == pytest.approx(2.0 / math.tau) and nominal_frequency(scene) == 0.25
    assert nominal_frequency(replace(scene, nominal=0.7)) == 0.7 and nominal_frequency(Scene("t", bodies("ab"))) is None
    two = replace(scene, springs=(spring, Spring("a", 24.0, frequency=9.0)))
    assert nominal_frequency(two) == frequency(two) == pytest.approx(4.0 / math.tau)
    joined = replace(scene, springs=(spring, Spring("a", 24.0, frequency=9.0, against="b")))
    assert nominal_frequency(joined) == 0.25
    assert nominal_frequency(replace(scene, springs=(Spring("a", 8.0),))) == pytest.approx(2.0 / math.tau)


LEVER = {"springs": (Spring("b", 8.0),), "torques": (Torque("w", -2.0),), "contacts": touch("wl", "bl")}


def test_roles_of_a_lever_escapement() -> None:
    scene = Scene("t", bodies("xwlb"), **LEVER)  # type: ignore[arg-type]
    assert roles(scene) == with_anchor(scene) == Roles("b", "w", "l") and keeps_time(scene) and not only_presses(scene)
    slid = replace(scene, bodies=(*bodies("xlb", l={"motion": "fixed"}), Body("w", "pivot", inertia=2.0)))
    assert roles(slid) == Roles("b", "w", None)
    geared = replace(
        scene, bodies=(*bodies("xlb"), Body("w", inertia=2.0, geared=Geared("x", 3.0))), torques=(Torque("x", 2.0),)
    )
    assert roles(geared) == Roles("b", "w", "l")
    loose = replace(scene, torques=(Torque("x", 2.0),), gears=(Gear(("x", "w"), 3.0, 0.1),))
    assert roles(loose) == Roles("b", "w", "l")
    pushed = replace(scene, bodies=(*bodies("xlb"), Body("w", "slide", mass=2.0)))
    assert roles(pushed) == Roles("b", None, None)
    assert roles(replace(scene, torques=(Torque("b", 2.0),))) == Roles("b", None, None)


def test_a_carried_spring_touches_for_its_detent() -> None:
    """Both by way of what the lever carries; not what carries the wheel or the balance."""
    scene = Scene("t", bodies("xwlbs", s={"on": "l"}), **{**LEVER, "contacts": touch("sw", "sb")})  # type: ignore[arg-type]
    assert roles(scene) == Roles("b", "w", "s")
    apart = replace(scene, contacts=touch("sw", "lb"))
    assert roles(apart) == Roles("b", "w", "l")
    on_wheel = replace(scene, bodies=bodies("xwlbs", s={"on": "x"}, w={"on": "x"}), contacts=touch("sw", "xb"))
    assert roles(on_wheel) == Roles("b", "w", None)


def test_an_anchor_is_its_own_lever_where_it_keeps_time() -> None:
    scene = Scene("t", bodies("wb"), **{**LEVER, "contacts": touch("wb")})  # type: ignore[arg-type]
    assert roles(scene) == Roles("b", "w", None) and not keeps_time(scene) and only_presses(scene)
    timed = replace(scene, lift_angle=0.5)
    assert keeps_time(timed) and with_anchor(timed) == Roles("b", "w", "b") and not only_presses(timed)
    assert with_anchor(scene) == Roles("b", "w", None)
    assert with_anchor(replace(timed, contacts=())) == Roles("b", "w", None)


def test_two_hinged_pallets_make_a_grasshopper() -> None:
    on = {"on": "b"}
    scene = Scene("t", bodies("wbpqr", p=on, q=on, r=on), **{**LEVER, "contacts": touch("wp", "qw")}, lift_angle=0.5)  # type: ignore[arg-type]
    assert hinged_pallets(scene) == ("p", "q") and with_anchor(scene) == Roles("b", "w", "b")
    assert hinged_pallets(replace(scene, contacts=touch("wp", "qr"))) == ()
    assert hinged_pallets(replace(scene, bodies=bodies("wbpqr", p=on, q={**on, "motion": "fixed"}, r=on))) == ()
    assert hinged_pallets(replace(scene, lift_angle=None)) == ()
    assert hinged_pallets(replace(scene, torques=())) == () and hinged_pallets(replace(scene, springs=())) == ()
    three = replace(scene, contacts=touch("wp", "qw", "rw"))
    assert hinged_pallets(three) == ("p", "q", "r")


def test_what_only_presses() -> None:
    """A jumper under a driven wheel, or a follower on a cam that is moved as the scene says."""
    follower = Scene("t", (*bodies("f"), Body("c", inertia=1.0, prescribed=Prescribed())), (Spring("f", 3.0),))
    assert only_presses(follower) and not only_presses(replace(follower, torques=(Torque("f", 1.0),)))
    assert not only_presses(replace(follower, springs=())) and not only_presses(replace(follower, bodies=bodies("f")))
    assert not is_driven(follower) and is_driven(replace(follower, torques=(Torque("f", table=((0.0, 1.0), (1.0, 0.0))),)))


def test_partners_and_the_way_of_the_drive() -> None:
    scene = Scene("t", bodies("abc", c={"geared": Geared("a", -3.0)}), contacts=touch("ab", "cb"))
    assert (partners(scene, "b"), partners(scene, "a"), partners(scene, "x")) == ({"a", "c"}, {"b"}, set())
    table = Torque("c", table=((0.0, -1.0), (1.0, 2.5)))
    for torques, way in (
        ((), 1.0),
        ((Torque("a", -2.0),), -1.0),
        ((Torque("a", 2.0), Torque("c", 1.0)), -1.0),
        ((Torque("a", 2.0), table), -1.0),
        ((Torque("a", 2.5), table), 1.0),
        ((Torque("b", -9.0), Torque("a", 2.5)), 1.0),
    ):
        assert drive_direction(replace(scene, torques=torques), "a") == way
    assert drive_direction(replace(scene, torques=(Torque("a", 2.0),)), "c") == -1.0
