"""Which bodies do [[gears]] bind, to which of them, how fast do they turn, and what is refused?"""

from __future__ import annotations

import math

import pytest
from scene_texts import faults, read

from watchsim.scene.scene import Gear, Geared, Scene

PLACES = {"a": 0, "b": 20, "c": 50, "d": 90}
INERTIA = 'inertia = "5 g·cm²"\n'
RACK = '[bodies.r]\nmotion = "slide"\naxis = [3, 4]\nmass = "2 g"\n'
OTHER_RACK = '[bodies.s]\nmotion = "slide"\naxis = [0, 1]\nmass = "3 g"\n'


def wheels(names: str = "abcd", **more: str) -> str:
    return "".join(f'[bodies.{n}]\nposition = ["{PLACES[n]} mm", "0 mm"]\n{INERTIA}{more.get(n, "")}' for n in names)


def gear(first: str, second: str, ratio: object, more: str = "") -> str:
    shown = f'"{ratio}"' if isinstance(ratio, str) else ratio
    return f'[[gears]]\nbetween = ["{first}", "{second}"]\nratio = {shown}\n{more}'


def bound(scene: Scene) -> dict[str, tuple[str, float]]:
    return {body.name: (body.geared.to, body.geared.ratio) for body in scene.bodies if body.geared is not None}


CHAIN = gear("a", "b", -3) + gear("b", "c", -5) + gear("d", "c", 0.25)
SPRING = '[[springs]]\nbody = "{}"\nstiffness = "3 µN·m/rad"\n'
HEAVY = 'mass = "2 g"\ncentre_of_mass = ["1 mm", "0 mm"]\n'
RIDER = '[bodies.x]\non = "{}"\nmass = "1 g"\ninertia = "1 g·cm²"\nposition = ["3 mm", "0 mm"]\n'
DOWN = '[scene]\ngravity = ["0 m/s²", "-9 m/s²"]\n'
AGAINST_A = {"b": ("a", -3.0), "c": ("a", 15.0), "d": ("a", 60.0)}
AGAINST_B = {"a": ("b", -1 / 3), "c": ("b", -5.0), "d": ("b", -20.0)}
AGAINST_C = {"a": ("c", 1 / 15), "b": ("c", -0.2), "d": ("c", 4.0)}
AGAINST_D = {"a": ("d", 1 / 60), "b": ("d", -0.05), "c": ("d", 0.25)}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (wheels() + CHAIN, AGAINST_A),
        (wheels("cabd") + CHAIN, AGAINST_C),
        (wheels() + CHAIN + SPRING.format("c"), AGAINST_C),
        (wheels(d=HEAVY) + CHAIN, AGAINST_A),
        (DOWN + wheels(d=HEAVY) + CHAIN, AGAINST_D),
        (DOWN + wheels(d=HEAVY) + CHAIN + SPRING.format("b"), AGAINST_D),
        (wheels() + RIDER.format("b") + CHAIN, AGAINST_B),
        (wheels() + RIDER.format("b") + CHAIN + SPRING.format("c"), AGAINST_B),
        (wheels(c='motion = "driven"\nvelocity = "2 rad/s"\n') + CHAIN, AGAINST_C),
        (wheels() + gear("a", "b", -3) + gear("c", "d", 7) + SPRING.format("d"), {"b": ("a", -3.0), "c": ("d", 1 / 7)}),
        (wheels("a") + RACK + gear("a", "r", "6 mm/rad"), {"r": ("a", 6e-3)}),
        (RACK + wheels("a") + gear("a", "r", "6 mm/rad"), {"a": ("r", 1 / 6e-3)}),
        (RACK + wheels("a") + gear("r", "a", "500 rad/m"), {"a": ("r", 500.0)}),
        (RACK + OTHER_RACK + gear("r", "s", -2.5), {"s": ("r", -2.5)}),
    ],
)
def test_bodies_are_bound_to_the_one_that_holds_the_coordinate(text: str, expected: dict[str, tuple[str, float]]) -> None:
    """One that is driven, carries others, is turned by gravity or has a spring, else the first named."""
    found = bound(read(text))
    assert found.keys() == expected.keys()
    for name, (to, ratio) in expected.items():
        assert found[name] == (to, pytest.approx(ratio, rel=1e-14))


@pytest.mark.parametrize(("play", "loose"), [("0°", False), ("0.01°", True), ("7°", True)])
def test_any_play_leaves_both_their_coordinates(play: str, loose: bool) -> None:
    scene = read(wheels("ab") + gear("a", "b", -3, f'backlash = "{play}"\n'))
    assert (len(scene.gears), len(scene.rigid_gears), len(bound(scene))) == ((1, 0, 0) if loose else (0, 1, 1))


def test_all_that_is_said_of_gears_is_kept() -> None:
    more = 'backlash = "2°"\nrestitution = 0.3\nefficiency = 0.8\npressure_angle = "25°"\n'
    (found,) = read(wheels("ab") + gear("b", "a", -3, more)).gears
    assert found == Gear(("b", "a"), -3.0, math.radians(2), 0.3, 0.8, math.radians(25))
    (plain,) = read(wheels("ab") + gear("b", "a", 3)).rigid_gears
    assert plain == Gear(("b", "a"), 3.0, 0.0, 0.0, 1.0, math.radians(20))
    (racked,) = read(wheels("a") + RACK + gear("a", "r", "6 mm/rad", 'backlash = "0.2 mm"\n')).gears
    assert racked.backlash == 2e-4


@pytest.mark.parametrize(
    ("more", "speeds"),
    [
        ({}, (0.0, 0.0, 0.0, 0.0)),
        ({"a": 'velocity = "2 rad/s"\n'}, (2.0, -6.0, 30.0, 120.0)),
        ({"c": 'velocity = "3 rad/s"\n'}, (0.2, -0.6, 3.0, 12.0)),
        ({"a": 'velocity = "2 rad/s"\n', "d": 'velocity = "120 rad/s"\n'}, (2.0, -6.0, 30.0, 120.0)),
        ({"b": 'velocity = "-6 rad/s"\n', "d": 'velocity = "120.00000005 rad/s"\n'}, (2.0, -6.0, 30.0, 120.0)),
    ],
)
def test_a_velocity_of_one_is_that_of_all(more: dict[str, str], speeds: tuple[float, ...]) -> None:
    scene = read(wheels(**more) + CHAIN)
    assert [body.velocity[0] for body in scene.bodies] == pytest.approx(speeds, rel=1e-9)
    assert scene.body("b").geared == Geared("a", -3.0)


def test_what_is_not_geared_keeps_its_velocity() -> None:
    scene = read(wheels(c='velocity = "7 rad/s"\n', a='velocity = "2 rad/s"\n') + gear("a", "b", -3))
    assert [body.velocity[0] for body in scene.bodies] == [2.0, -6.0, 7.0, 0.0]


REFUSED = [
    (gear("a", "b", -3) + gear("b", "c", 4) + gear("c", "a", 5), ["gears.2.between: c and a are bound to each other already"]),
    (gear("a", "b", -3) + gear("a", "b", -3), ["gears.1.between: a and b are bound to each other already, through"]),
    (gear("a", "b", -3) + gear("b", "a", 4, 'backlash = "1°"\n'), ["gears.1.between: b and a are bound to each other"]),
    (gear("a", "b", -3) + gear("b", "c", 4) + gear("a", "c", 4, 'backlash = "1°"\n'), ["gears.2.between: a and c are bound"]),
    (gear("a", "a", -3), ["gears.0.between: two bodies are needed"]),
    ('[[gears]]\nbetween = ["a", "b", "c"]\nratio = 2\n', ["gears.0.between: two bodies are needed"]),
    ("[[gears]]\nratio = 2\n", ["gears.0: two bodies are needed"]),
    (gear("a", "e", -3), ['gears.0.between.1: there is no body "e"']),
    (gear("e", "a", -3), ['gears.0.between.0: there is no body "e"']),
    ('[[gears]]\nbetween = ["a", "b"]\n', ["gears.0: missing: ratio"]),
    (gear("a", "b", "6 mm/rad"), ["gears.0.ratio: "]),
    (gear("a", "b", 2, "restitution = 0.5\n"), ["gears.0.restitution: needs play"]),
    (gear("a", "b", 2, "efficiency = 0.5\n"), ["gears.0.efficiency: needs play"]),
    (gear("a", "b", 2, 'backlash = "0.1 mm"\n'), ["gears.0.backlash: "]),
]


@pytest.mark.parametrize(("text", "expected"), REFUSED)
def test_what_contradicts_is_said_once(text: str, expected: list[str]) -> None:
    said = faults(wheels() + text)
    assert len(said) == len(expected) and all(one.startswith(words) for one, words in zip(said, expected, strict=True)), said


@pytest.mark.parametrize(("speed", "said"), [("120.00000011", False), ("120.00000013", True), ("-120", True), ("119", True)])
def test_velocities_that_contradict_each_other(speed: str, said: bool) -> None:
    """To a thousand-millionth."""
    text = wheels(b='velocity = "-6 rad/s"\n', d=f'velocity = "{speed} rad/s"\n') + CHAIN
    if said:
        (fault,) = faults(text)
        assert fault.startswith("bodies.d.velocity: contradicts the velocity of another body that is geared to a")
    else:
        read(text)


@pytest.mark.parametrize(("off", "held"), [(0.9e-9, False), (1.2e-9, True)])
def test_gravity_turns_what_is_not_poised(off: float, held: bool) -> None:
    """By more than a thousand-millionth of its radius of gyration."""
    at = f'mass = "2 g"\ncentre_of_mass = ["{math.sqrt(5e-7 / 2e-3) * off!r} m", "0 m"]\n'
    assert ("a" in bound(read(DOWN + wheels("ab", b=at) + gear("a", "b", 2)))) is held


def test_a_mass_that_cannot_be_is_one_fault_under_gravity_too() -> None:
    text = DOWN + wheels("ab", b='mass = "-2 g"\ncentre_of_mass = ["1 mm", "0 mm"]\n')
    for more in (gear("a", "b", 2), SPRING.format("b") + '[[damping]]\nbody = "b"\nq_factor = 200\n'):
        assert "bodies.b.mass: must not be negative" in faults(text + more)


def test_bodies_that_do_not_turn_or_slide_have_no_gears() -> None:
    text = wheels("a") + '[bodies.f]\nmotion = "free"\nmass = "1 g"\ninertia = "1 g·cm²"\n'
    assert faults(text + gear("a", "f", 2)) == [
        'gears.0.between.1: gears bind bodies that turn or slide; motion of f is "free"'
    ]


PLAY = 'backlash = "1°"\n'
CARRIED = '[bodies.x]\non = "a"\nmass = "1 g"\ninertia = "1 g·cm²"\nposition = ["3 mm", "0 mm"]\n'


@pytest.mark.parametrize(
    ("pair", "ratio", "words"),
    [
        (("a", "x"), 2.0, ""),
        (("x", "a"), 2.0, ""),
        (("x", "b"), 2.0, "play between these would bind three angles"),
        (("b", "x"), 2.0, "play between these would bind three angles"),
        (("a", "x"), -1.0, "with play must not be -1"),
        (("x", "a"), -1.0, "with play must not be -1"),
        (("a", "b"), -1.0, ""),
        (("a", "x"), 1.0, ""),
        (("a", "x"), -1.1, ""),
    ],
)
def test_play_between_a_carrier_and_what_it_carries(pair: tuple[str, str], ratio: float, words: str) -> None:
    text = wheels("ab") + CARRIED + gear(*pair, ratio, PLAY)
    if words:
        (fault,) = faults(text)
        assert words in fault
    else:
        assert len(read(text).gears) == 1
