"""What swings, how fast, and which parts of an escapement follow from it? Made-up scenes with unequal numbers."""

import cmath
import math
from dataclasses import replace
from pathlib import Path

import pytest
from every_time import few
from scipy.optimize import brentq
from scipy.special import j1

import watchsim as ws
from watchsim.cli import main
from watchsim.commands.console import FINE
from watchsim.mechanism.check import notes
from watchsim.paths import profiles_dir
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.load import load
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
    touching,
    with_anchor,
)
from watchsim.scene.scene import Body, Gear, Geared, Prescribed, Scene
from watchsim.studies.steady import steady

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


GRAVITY = (3.0, -9.0)
DOWN_PENDULUMS = math.atan2(-9.0, 3.0)
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
    lowest = (-1e-3 + 3e-3j) * cmath.exp(1j * one.rest) / cmath.exp(1j * DOWN_PENDULUMS)
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
    hanging = DOWN_PENDULUMS - cmath.phase(-1e-3 + 3e-3j)
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


G_OSCILLATION = 9.81
HEAD = f'[scene]\nschema = 1\ngravity = ["0 m/s²", "-{G_OSCILLATION} m/s²"]\n'
# A disc of 50 mm and 2 kg, 1 m below the pivot, on a rod without weight: J = m (l² + r²/2).
PENDULUM = """
[bodies.pendulum]
inertia = "1e-9 kg·m²"
[bodies.bob]
on = "pendulum"
motion = "fixed"
position = ["0 mm", "-1000 mm"]
circle = "50 mm"
mass = "2 kg"
"""
J = 2.0 * (1.0 + 0.5 * 0.05**2) + 1e-9


def scene_of(folder: Path, text: str):
    (folder / "scene.toml").write_text(HEAD + text, encoding="utf-8")
    return load(folder)


def test_fixed_loads_count(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = scene_of(tmp_path, PENDULUM)
    assert frequency(scene) == pytest.approx(math.sqrt(2.0 * G_OSCILLATION / J) / math.tau, rel=1e-12)
    assert roles(scene).oscillator == "pendulum" and keeps_time(scene)
    assert main(["check", str(tmp_path)]) == FINE
    said = capsys.readouterr().out
    assert "pendulum makes small swings at 0.498" in said and "by gravity alone, 19.62 N·m/rad" in said
    assert "with bob: mass 2 kg" in said and "has no mass" not in said


def test_a_pendulum_hangs_where_gravity_pulls_it(tmp_path: Path) -> None:
    turned = PENDULUM.replace('["0 mm", "-1000 mm"]', '["600 mm", "-800 mm"]')
    (one,) = oscillators(scene_of(tmp_path, turned))
    assert one.rest == pytest.approx(-math.atan2(600.0, 800.0), rel=1e-12) and one.gravity == pytest.approx(2.0 * G_OSCILLATION)
    wound = turned.replace("inertia", 'angle = "700°"\ninertia', 1)
    (one,) = oscillators(scene_of(tmp_path, wound))
    assert one.rest == pytest.approx(2.0 * math.tau - math.atan2(600.0, 800.0), rel=1e-12)


@pytest.mark.parametrize("stiffness", [0.5, 15.0, 60.0])
def test_spring_and_gravity_add(stiffness: float, tmp_path: Path) -> None:
    """A spring at rest at 40° and gravity share the rest position; found by another root finder."""
    text = PENDULUM + f'[[springs]]\nbody = "pendulum"\nstiffness = "{stiffness} N·m/rad"\nrest = "40°"\n'
    (one,) = oscillators(scene_of(tmp_path, text))
    rest = brentq(lambda q: stiffness * (q - math.radians(40.0)) + 2.0 * G_OSCILLATION * math.sin(q), -0.1, 1.0, xtol=1e-15)
    assert one.rest == pytest.approx(rest, abs=1e-12)
    assert one.hertz == pytest.approx(math.sqrt((stiffness + 2.0 * G_OSCILLATION * math.cos(rest)) / J) / math.tau, rel=1e-12)


def test_an_inverted_pendulum_stands_on_a_strong_spring_only(tmp_path: Path) -> None:
    upright = PENDULUM.replace("-1000 mm", "1000 mm")
    spring = '[[springs]]\nbody = "pendulum"\nstiffness = "{} N·m/rad"\n'
    strong = scene_of(tmp_path, upright + spring.format(30.0))
    assert frequency(strong) == pytest.approx(math.sqrt((30.0 - 2.0 * G_OSCILLATION) / J) / math.tau, rel=1e-9)
    (weak,) = oscillators(scene_of(tmp_path, upright + spring.format(10.0)))
    assert 1.0 < abs(weak.rest) < math.pi and weak.hertz  # it leans over to where the two balance


def test_quality_is_that_of_weight_and_loads(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, PENDULUM + '[[damping]]\nbody = "pendulum"\nq_factor = 400\n')
    assert scene.damping[0].viscous == pytest.approx(math.sqrt(2.0 * G_OSCILLATION * J) / 400.0, rel=1e-12)


def test_a_frequency_is_that_of_the_loaded_body(tmp_path: Path) -> None:
    flat = PENDULUM + '[[springs]]\nbody = "pendulum"\nfrequency = "3 Hz"\n'
    (tmp_path / "scene.toml").write_text("[scene]\nschema = 1\n" + flat, encoding="utf-8")
    scene = load(tmp_path)
    assert scene.springs[0].stiffness == pytest.approx(J * (math.tau * 3.0) ** 2, rel=1e-12)
    assert frequency(scene) == pytest.approx(3.0, rel=1e-12)


def test_the_rate_is_measured_against_what_the_scene_says(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, PENDULUM + '[timegrapher]\nfrequency = "3600 vph"\n')
    assert nominal_frequency(scene) == 0.5 and frequency(scene) != 0.5
    with pytest.raises(SceneError, match=r"small swings at 0\.498.* Hz .* more than 10 % off"):
        scene_of(tmp_path, PENDULUM + '[timegrapher]\nfrequency = "28800 vph"\n')
    with pytest.raises(SceneError, match="more than 10 % off"):
        scene_of(tmp_path, PENDULUM + '[timegrapher]\nfrequency = "3200 vph"\n')
    # A vertical watch whose balance is not poised: the spring's own frequency, so that the poise error shows in the rate.
    sprung = scene_of(tmp_path, PENDULUM + '[[springs]]\nbody = "pendulum"\nfrequency = "4 Hz"\n')
    assert nominal_frequency(sprung) == pytest.approx(4.0, rel=1e-12) and frequency(sprung) > 4.01


@pytest.mark.parametrize("extra", ['[[torques]]\nbody = "pendulum"\nvalue = "1 N·m"\n', ""])
def test_what_is_driven_or_does_not_hang_is_no_pendulum(extra: str, tmp_path: Path) -> None:
    text = PENDULUM + extra if extra else PENDULUM.replace("-1000 mm", "0 mm")
    assert oscillators(scene_of(tmp_path, text)) == ()


BALANCE = """
[scene]
schema  = 1
gravity = ["0 m/s²", "-9.81 m/s²"]

[bodies.balance]
circle         = "4.5 mm"
pivot          = ["1 mm", "0 mm"]
position       = ["0 mm", "3 mm"]
angle          = "-90°"
mass           = "50 mg"
inertia        = "12 mg·cm²"
centre_of_mass = ["0.3 µm", "0.4 µm"]
"""


def loaded(tmp_path, text):
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    return ws.load(tmp_path)


def test_it_stands_instead_of_that_of_the_outline(tmp_path):
    scene = loaded(tmp_path, BALANCE)
    body = scene.body("balance")
    assert body.centre_of_mass == pytest.approx((0.3e-6, 0.4e-6), rel=1e-6, abs=0.0)
    assert (body.mass, body.inertia) == pytest.approx((50e-6, 12e-10))
    assert not any(note.code == "centre-of-mass" for note in notes(scene))


def test_without_it_the_outline_says_where(tmp_path):
    text = BALANCE.replace('centre_of_mass = ["0.3 µm", "0.4 µm"]', "")
    scene = loaded(tmp_path, text)
    assert scene.body("balance").centre_of_mass == pytest.approx((-1e-3, 0.0))
    assert any(note.code == "centre-of-mass" for note in notes(scene))


def test_it_is_a_path_like_any_other(tmp_path):
    scene = loaded(tmp_path, BALANCE).set("bodies.balance.centre_of_mass.1", "5 µm")
    assert scene.body("balance").centre_of_mass == pytest.approx((0.3e-6, 5e-6), rel=1e-6, abs=0.0)


@pytest.mark.parametrize(
    "old, new, why",
    [
        ('mass           = "50 mg"\n', "", "needs mass and inertia"),
        ('inertia        = "12 mg·cm²"\n', "", "needs mass and inertia"),
        ('"0.4 µm"]', '"0.4 mg"]', "mass"),
        ('["0.3 µm", "0.4 µm"]', '"0.3 µm"', "two values"),
        ("pivot          = ", 'motion = "free"\npivot = ', "a free body turns about its centre of mass"),
        ("pivot          = ", 'motion = "fixed"\npivot = ', "cannot turn"),
        ("centre_of_mass", "center_of_mass", "centre_of_mass"),
    ],
)
def test_what_does_not_go_with_it_is_refused(tmp_path, old, new, why):
    assert old in BALANCE
    with pytest.raises(SceneError, match=why):
        loaded(tmp_path, BALANCE.replace(old, new))


def test_beside_solids_it_is_refused(tmp_path):
    solids = '\n[[bodies.balance.solids]]\nlayer = "circle"\nthickness = "0.1 mm"\ndensity = "8 g/cm³"\n'
    text = BALANCE.replace('mass           = "50 mg"\n', "").replace('inertia        = "12 mg·cm²"\n', "")
    with pytest.raises(SceneError, match="solids already give the centre of mass"):
        loaded(tmp_path, text + solids)


@pytest.mark.parametrize("down", few([(0.0, 1.0), (1.0, 0.0), (-1.0, 0.0), (0.0, -1.0)], 1))
def test_poise_error_in_four_positions(down):
    """(m g r / k) J₁(A)/A, times the cosine between the heavy place at rest and down; a harmonic swing about rest, in s/d."""
    watch = ws.load(ws.profiles_dir() / "bench_lever")
    inertia, stiffness = watch.body("balance").inertia, watch.springs[0].stiffness
    watch = watch.set("bodies.balance.mass", "50 mg").set("bodies.balance.inertia", inertia)
    poised = steady(watch.set("bodies.balance.centre_of_mass", ["0 µm", "0 µm"]))
    x, y = 0.2e-6, -0.35e-6
    hanging = watch.set("bodies.balance.centre_of_mass", (x, y)).set("scene.gravity", tuple(9.81 * one for one in down))
    cycle = steady(hanging)
    swing = math.radians(cycle.amplitude_deg)
    law = 86400.0 * 50e-6 * 9.81 * (x * down[0] + y * down[1]) / stiffness * j1(swing) / swing
    assert abs(law) > 0.3
    assert cycle.rate_s_per_d - poised.rate_s_per_d == pytest.approx(law, rel=0.01)


def test_what_a_coaxial_escapement_touches_itself_with_is_named_by_roles() -> None:
    scene = ws.load(ws.profiles_dir() / "coaxial")
    assert set(touching(scene, with_anchor(scene))) == {
        ("balance", "IMPULSE_STONE", "impulse stone"),
        ("lever", "IMPULSE_STONE", "impulse stone"),
        ("balance", "PIN", "roller jewel"),
        ("lever", "FORK", "fork"),
        ("balance", "SAFETY", "safety roller"),
        ("lever", "GUARD", "guard pin"),
        ("banking", "PINS", "banking"),
        ("lever", "ARMS", "lever"),
    }


def test_only_what_a_detent_carries_is_a_passing_spring() -> None:
    """Pallets that are hinged on a pendulum also lie on what carries them."""
    named = {}
    for profile in ("detent", "grasshopper"):
        scene = load(profiles_dir() / profile)
        named[profile] = {text for _, _, text in touching(scene, with_anchor(scene))}
    assert {"passing spring", "discharging jewel"} <= named["detent"]
    assert not {"passing spring", "discharging jewel"} & named["grasshopper"]
