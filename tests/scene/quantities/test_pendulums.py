"""What swings about which rest position, and how fast, among several bodies, springs and weights? By hand and by scipy."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import pytest
from scipy.optimize import brentq

from watchsim.scene.forces import Spring, Torque
from watchsim.scene.placing import _about, _moved
from watchsim.scene.roles import _weight, frequency, nominal_frequency, oscillator, oscillators
from watchsim.scene.scene import Body, Scene
from watchsim.scene.trains import Ride, Weighed

GRAVITY = (3.0, -9.0)
DOWN = math.atan2(-9.0, 3.0)
G = math.hypot(*GRAVITY)


def pendulum(name: str, mass: float, centre: complex, angle: float = 0.2) -> Body:
    return Body(name, angle=angle, mass=mass, inertia=3.0 * mass * abs(centre) ** 2, centre_of_mass=(centre.real, centre.imag))


LIGHT, HEAVY = pendulum("light", 1e-3, 2e-3 + 1e-3j), pendulum("heavy", 2e-3, -1e-3 + 3e-3j)


@pytest.mark.parametrize(
    "bodies", [(LIGHT, HEAVY), (HEAVY, LIGHT), (replace(HEAVY, name="flies", motion="free"), LIGHT, HEAVY)]
)
def test_without_springs_the_heaviest_that_hangs_swings(bodies: tuple[Body, ...]) -> None:
    """By the torque of its weight; what is driven does not."""
    scene = Scene("two", bodies, gravity=GRAVITY)
    (one,) = oscillators(scene)
    assert one.body == "heavy" and one.weight == pytest.approx(2e-3 * G * abs(-1e-3 + 3e-3j), rel=1e-12, abs=0.0)
    (other,) = oscillators(replace(scene, torques=(Torque("heavy", 1e-9),)))
    assert other.body == "light" and oscillators(replace(scene, gravity=(0.0, 0.0))) == ()
    assert oscillators(replace(scene, torques=(Torque("heavy", 1e-9), Torque("light", 1e-9)))) == ()


@pytest.mark.parametrize("angle", [0.2, 3.0, -9.0, 40.0])
def test_it_hangs_where_its_centre_of_mass_is_lowest(angle: float) -> None:
    """Within half a turn of where it starts; the frequency is the root of weight over inertia."""
    scene = Scene("one", (replace(HEAVY, angle=angle),), gravity=GRAVITY)
    (one,) = oscillators(scene)
    lowest = (-1e-3 + 3e-3j) * cmath.exp(1j * one.rest) / cmath.exp(1j * DOWN)
    assert lowest.imag == pytest.approx(0.0, abs=1e-15) and lowest.real > 0.0
    assert abs(one.rest - angle) <= math.pi and one.gravity == one.weight
    assert frequency(scene) == pytest.approx(math.sqrt(one.weight / HEAVY.inertia) / math.tau, rel=1e-12)
    assert one.spring == 0.0 and one.inertia == HEAVY.inertia


@pytest.mark.parametrize("stiffness", [(1e-6, 3e-6), (2e-4, 1e-4), (5e-5, 5e-5)])
@pytest.mark.parametrize("rests", [(0.0, 1.0), (-2.0, 0.5), (8.0, 9.0)])
def test_springs_and_weight_balance(stiffness: tuple[float, float], rests: tuple[float, float]) -> None:
    """Springs add; between their middle and where the body would hang their torques cancel."""
    springs = tuple(Spring("heavy", k, rest) for k, rest in zip(stiffness, rests, strict=True))
    scene = Scene("sprung", (LIGHT, HEAVY), springs, gravity=GRAVITY)
    (one,) = oscillators(scene)
    whole = sum(stiffness)
    middle = sum(k * rest for k, rest in zip(stiffness, rests, strict=True)) / whole
    hanging = DOWN - cmath.phase(-1e-3 + 3e-3j)
    hanging = middle + math.remainder(hanging - middle, math.tau)

    def torque(q: float) -> float:
        return whole * (q - middle) + one.weight * math.sin(q - hanging)

    assert one.rest == pytest.approx(brentq(torque, *sorted((middle, hanging)), xtol=1e-15), abs=1e-12)
    slope = (torque(one.rest + 1e-5) - torque(one.rest - 1e-5)) / 2e-5
    assert one.stiffness == pytest.approx(slope, rel=1e-6) and one.spring == pytest.approx(whole)
    hertz = one.hertz
    assert hertz is None if slope <= 0.0 else hertz == pytest.approx(math.sqrt(slope / HEAVY.inertia) / math.tau, rel=1e-6)
    still = oscillators(replace(scene, gravity=(0.0, 0.0)))[0]
    assert (still.rest, still.weight, still.gravity) == (pytest.approx(middle), 0.0, 0.0)


def test_sprung_bodies_come_in_the_order_of_their_springs() -> None:
    springs = (Spring("heavy", 1.0), Spring("light", 1.0), Spring("heavy", 2.0), Spring("other", 1.0, against="light"))
    scene = Scene("order", (LIGHT, Body("other", inertia=1.0), HEAVY), springs)
    assert [(one.body, one.spring) for one in oscillators(scene)] == [("heavy", 3.0), ("light", 1.0)]
    assert oscillator(scene.bodies, springs, GRAVITY, "nobody") is None
    assert oscillator((replace(HEAVY, motion="free"),), springs, GRAVITY, "heavy") is None
    assert oscillator((Body("slide", "slide", mass=1.0),), (), GRAVITY, "slide") is None


@pytest.mark.parametrize("axis", [(1.0, 0.0), (0.6, -0.8), (0.0, 1.0)])
def test_what_slides_sags_by_its_weight(axis: tuple[float, float]) -> None:
    slide = Body("slide", "slide", axis=axis, mass=2e-3)
    (one,) = oscillators(Scene("sag", (slide,), (Spring("slide", 5.0, 1e-3),), gravity=GRAVITY))
    pull = 2e-3 * (GRAVITY[0] * axis[0] + GRAVITY[1] * axis[1])
    assert one.rest == pytest.approx(1e-3 + pull / 5.0, rel=1e-12) and one.gravity == 0.0
    assert one.hertz == pytest.approx(math.sqrt(5.0 / 2e-3) / math.tau, rel=1e-12)


@pytest.mark.parametrize(("off", "hangs"), [(0.9e-9, False), (1.1e-9, True)])
def test_a_billionth_of_the_radius_of_gyration_is_rounding(off: float, hangs: bool) -> None:
    gyration = 4e-3
    body = Body("b", mass=1e-3, inertia=1e-3 * gyration**2, centre_of_mass=(0.6 * off * gyration, 0.8 * off * gyration))
    assert bool(oscillators(Scene("poised", (body,), gravity=GRAVITY))) is hangs


def test_what_a_rate_is_measured_against() -> None:
    """What [timegrapher] says, the frequency of the only spring, or that of small swings."""
    given = Spring("light", 1.0, frequency=4.0)
    scene = Scene("rate", (LIGHT, HEAVY), (given,))
    small = math.sqrt(1.0 / LIGHT.inertia) / math.tau
    assert nominal_frequency(scene) == 4.0 and frequency(scene) == pytest.approx(small)
    assert nominal_frequency(replace(scene, nominal=3.0)) == 3.0
    assert nominal_frequency(replace(scene, springs=(given, Spring("heavy", 1.0, frequency=9.0)))) == 4.0
    assert nominal_frequency(replace(scene, springs=(given, Spring("light", 1.0, against="heavy", frequency=9.0)))) == 4.0
    twice = replace(scene, springs=(given, given))
    assert nominal_frequency(twice) == pytest.approx(small * math.sqrt(2.0)) == frequency(twice)
    assert nominal_frequency(replace(scene, springs=(replace(given, frequency=None),))) == pytest.approx(small)
    still = Scene("still", (Body("a", inertia=1.0),))
    assert (
        nominal_frequency(still) is None and frequency(still) is None and nominal_frequency(replace(still, nominal=2.0)) == 2.0
    )


@pytest.mark.parametrize("turn", [0.0, 0.7, -2.0])
def test_adjusted_parts_are_turned_about_a_point_and_shifted(turn: float) -> None:
    point, about, shift = 1.0 + 2.0j, -0.5 + 0.25j, 0.125 - 0.375j
    wanted = cmath.exp(1j * turn) * (point - about) + about + shift
    found = _moved((1.0, 2.0), turn, _about((-0.5, 0.25), turn, (0.125, -0.375)))
    assert complex(*found) == pytest.approx(wanted, abs=1e-15)


@pytest.mark.parametrize("share", [0.8, 1.25])
def test_a_centre_of_mass_on_the_pivot_makes_no_torque(share: float) -> None:
    """Nearer than a thousand millionth of the radius of gyration; nor does what rides on a moving body."""
    mass, inertia = 2e-3, 5e-9
    moment = share * 1e-9 * math.sqrt(mass * inertia) * 0.6, -share * 1e-9 * math.sqrt(mass * inertia) * 0.8
    torque, angle = _weight(Weighed(mass, moment, inertia), Ride(0, angle=0.4), GRAVITY)
    if share < 1.0:
        assert (torque, angle) == (0.0, 0.0)
    else:
        assert torque == pytest.approx(math.hypot(*moment) * G, rel=1e-12, abs=0.0)
        hanging = angle + 0.4 + math.atan2(moment[1], moment[0])
        assert math.remainder(hanging - DOWN, math.tau) == pytest.approx(0.0, abs=1e-12)
    assert _weight(Weighed(mass, (1e-3, 2e-3), inertia), Ride(0, host=1), GRAVITY) == (0.0, 0.0)
