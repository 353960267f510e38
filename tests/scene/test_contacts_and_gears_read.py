"""Which outlines may touch by [[contacts]], and what does nothing or is declared twice?"""

import math
from typing import Any

import pytest
from made_scenes import circle, drawing, square
from scene_texts import BODIES, faults, read, spring

from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Contact, Damping, Mainspring, Side, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Gear, Geared, Scene

INERTIA = 'inertia = "5 g·cm²"\nmass = "2 g"\n'
BODIES_CONTACTS_READ = f"""
[bodies.a]
drawing = "plate.dxf"
layers = ["A", "B.C"]
pivot = ["0 mm", "0 mm"]
inertia = "5 g·cm²"
[bodies.b]
circle = "1 mm"
{INERTIA}position = ["30 mm", "0 mm"]
[bodies.c]
circle = "2 mm"
{INERTIA}position = ["60 mm", "0 mm"]
[bodies.none]
inertia = "5 g·cm²"
position = ["80 mm", "0 mm"]
[bodies.f]
circle = "1 mm"
motion = "fixed"
position = ["90 mm", "0 mm"]
[bodies.g]
circle = "1 mm"
motion = "fixed"
position = ["95 mm", "0 mm"]
[bodies.driven]
circle = "1 mm"
motion = "driven"
velocity = "2 rad/s"
position = ["120 mm", "0 mm"]
[bodies.driver]
circle = "1 mm"
motion = "driven"
velocity = "3 rad/s"
position = ["140 mm", "0 mm"]
[bodies.onb]
on = "b"
motion = "fixed"
circle = "0.5 mm"
position = ["5 mm", "0 mm"]
[bodies.onb2]
on = "b"
motion = "fixed"
circle = "0.5 mm"
position = ["-5 mm", "0 mm"]
[bodies.onf]
on = "f"
motion = "fixed"
circle = "0.5 mm"
position = ["0 mm", "20 mm"]
[bodies.turns]
on = "b"
circle = "0.5 mm"
inertia = "1 g·cm²"
position = ["0 mm", "9 mm"]
"""


def contacts(*pairs: str, more: str = "") -> str:
    return BODIES_CONTACTS_READ + "".join(f"[[contacts]]\nbetween = [{pair}]\n{more}" for pair in pairs)


@pytest.fixture
def plate(desk: Any) -> Any:
    loops = (
        square(2e-3, layer="A"),
        square(1e-3, (5e-3, 0.0), "B.C"),
        square(1e-3, (9e-3, 0.0), "D"),
        circle(1e-3, (20e-3, 0.0), "H"),
    )
    desk.put(drawing("plate.dxf", loops))
    return desk


def told_of(desk: Any, text: str) -> list[str]:
    with pytest.raises(SceneError) as caught:
        load(desk.scene(text))
    return [f"{fault.key}{fault.shown}: {fault.message}" for fault in caught.value.faults]


def test_sides_are_bodies_or_layers(plate: Any) -> None:
    more = "friction = 0.3\nrestitution = 0.4\n"
    scene = load(plate.scene(contacts('"a", "b"', '"a.B.C", "c"', '"onb", "f"', '"turns", "onb"', more=more)))
    sides = [(Side("a"), Side("b")), (Side("a", "B.C"), Side("c")), (Side("onb"), Side("f")), (Side("turns"), Side("onb"))]
    assert scene.contacts == tuple(Contact(pair, 0.3, 0.4, 0.0) for pair in sides)


ONE = [
    ('"b"', 'contacts.0.between = ["b"]: two sides are needed'),
    ('"b", "c", "f"', 'contacts.0.between = ["b", "c", "f"]: two sides are needed'),
    ('"b", "d"', 'contacts.0.between.1 = "d": there is no body "d". '),
    ('"d.X", "b"', 'contacts.0.between.0 = "d.X": there is no body "d". '),
    ('"b", "none"', 'contacts.0.between.1 = "none": none has no outline that could touch'),
    ('"a.X", "b"', 'contacts.0.between.0 = "a.X": a has no such layer. Known here: A, B.C.'),
    ('"a.a", "b"', 'contacts.0.between.0 = "a.a": a has no such layer. Did you mean "A"? Layers of a: A, B.C.'),
    ('"a.D", "b"', 'contacts.0.between.0 = "a.D": layer D is left out by layers under [bodies.a]: add "D" there'),
    ('"a.A", "a.B.C"', 'contacts.0.between = ["a.A", "a.B.C"]: a cannot touch itself: a body is rigid'),
    ('"f", "g"', 'contacts.0.between = ["f", "g"]: f and g are both fixed, so this contact does nothing'),
    ('"f", "driven"', 'contacts.0.between = ["f", "driven"]: f and driven are driven or fixed: neither can give way'),
    ('"driver", "driven"', 'contacts.0.between = ["driver", "driven"]: driver and driven are driven or fixed'),
    ('"b", "onb"', "contacts.0.between: b and onb are rigid with each other, so this contact does nothing"),
    ('"onb2", "onb"', "contacts.0.between: onb2 and onb are rigid with each other"),
    ('"g", "onf"', "contacts.0.between: g and onf are both fixed, so this contact does nothing"),
]


@pytest.mark.parametrize(("pair", "words"), ONE)
def test_what_cannot_touch_is_said_once(plate: Any, pair: str, words: str) -> None:
    (said,) = told_of(plate, contacts(pair))
    assert said.startswith(words)


@pytest.mark.parametrize("pair", ['"f", "b"', '"driven", "b"', '"onb", "c"', '"onf", "c"', '"onb", "driven"', '"turns", "b"'])
def test_what_can_give_way_on_one_side_is_taken(plate: Any, pair: str) -> None:
    assert len(load(plate.scene(contacts(pair))).contacts) == 1


@pytest.mark.parametrize(
    ("pairs", "words"),
    [
        (['"a", "b"', '"b", "a"'], ["contacts.1.between: contacts.0 declares this pair already"]),
        (['"a", "b"', '"b", "a.A"'], ["contacts.1.between: contacts.0 declares this pair already"]),
        (['"a.A", "b"', '"c", "b"', '"b", "a"'], ["contacts.2.between: contacts.0 declares this pair already"]),
        (['"a.A", "b"', '"a.B.C", "b"', '"b", "a"'], ["contacts.2.between: contacts.0 declares this pair already"]),
        (
            ['"a.A", "b"', '"c", "b"', '"b", "c"', '"c", "b"'],
            ["contacts.2.between: contacts.1", "contacts.3.between: contacts.1"],
        ),
    ],
)
def test_a_pair_declared_again_is_told_with_the_first(plate: Any, pairs: list[str], words: list[str]) -> None:
    said = [one.replace(one.partition(".between")[2].partition(":")[0], "", 1) for one in told_of(plate, contacts(*pairs))]
    assert len(said) == len(words) and all(one.startswith(what) for one, what in zip(said, words, strict=True))


def test_layers_of_one_body_are_pairs_of_their_own(plate: Any) -> None:
    assert len(load(plate.scene(contacts('"a.A", "b"', '"a.B.C", "b"', '"a.A", "c"'))).contacts) == 3


def test_a_layer_taken_out_as_a_bore_is_told(plate: Any) -> None:
    solid = '[[bodies.a.solids]]\nlayer = "A"\nthickness = "1 mm"\ndensity = "8 g/cm³"\nbores = ["E"]\n'
    loops = (square(20e-3, layer="A"), square(1e-3, (5e-3, 0.0), "E"), square(1e-3, (30e-3, 0.0), "B.C"))
    plate.put(drawing("plate.dxf", loops))
    text = BODIES_CONTACTS_READ.replace('inertia = "5 g·cm²"\n[bodies.b]', f"{solid}[bodies.b]")
    (said,) = told_of(plate, f'{text}[[contacts]]\nbetween = ["a.E", "b"]\n')
    assert said.startswith('contacts.0.between.0 = "a.E": this layer is taken out as a bore; to be touched')


DAMPED = '[[damping]]\nbody = "{}"\ncoulomb = "3 nN·m"\n'


def test_dry_friction_on_a_carrier_that_turns_is_refused(plate: Any) -> None:
    (said,) = told_of(plate, BODIES_CONTACTS_READ + DAMPED.format("turns"))
    assert said.startswith("damping.0.coulomb: dry friction between turns and a carrier that turns")
    for free in (DAMPED.format("b"), DAMPED.format("turns").replace("coulomb", "viscous").replace("N·m", "N·m·s/rad")):
        assert len(load(plate.scene(BODIES_CONTACTS_READ + free)).damping) == 1


AGAINST = """
[bodies.s]
motion = "slide"
axis = [3, 4]
mass = "2 g"
[bodies.t]
motion = "slide"
axis = [6, 8]
mass = "7 g"
[bodies.u]
motion = "slide"
axis = [4, 3]
mass = "7 g"
[[springs]]
body = "{}"
against = "{}"
stiffness = "1 {}"
{}"""


@pytest.mark.parametrize(
    ("one", "other", "more", "words"),
    [
        ("s", "t", "", ""),
        ("b", "c", "", ""),
        ("b", "driven", "", ""),
        ("s", "u", "", "acts between two bodies that turn, or two that slide in the same direction"),
        ("b", "s", "", "acts between two bodies that turn, or two that slide"),
        ("b", "b", "", "is the same body"),
        ("b", "x", "", "there is no such body"),
        ("b", "turns", "", "turns is carried by b"),
        ("turns", "c", "", "turns is carried by b"),
        ("b", "c", '[[gears]]\nbetween = ["a", "c"]\nratio = 3\n', "c is geared to a"),
    ],
)
def test_who_acts_against_whom(plate: Any, one: str, other: str, more: str, words: str) -> None:
    text = BODIES_CONTACTS_READ + AGAINST.format(one, other, "N/m" if one == "s" else "N·m/rad", "") + more
    if words:
        (said,) = told_of(plate, text)
        assert words in said
    else:
        assert load(plate.scene(text)).springs[0].against == other


PLACES = {"a": 0, "b": 20, "c": 50, "d": 90}
INERTIA_GEARS_READ = 'inertia = "5 g·cm²"\n'
RACK = '[bodies.r]\nmotion = "slide"\naxis = [3, 4]\nmass = "2 g"\n'
OTHER_RACK = '[bodies.s]\nmotion = "slide"\naxis = [0, 1]\nmass = "3 g"\n'


def wheels(names: str = "abcd", **more: str) -> str:
    return "".join(f'[bodies.{n}]\nposition = ["{PLACES[n]} mm", "0 mm"]\n{INERTIA_GEARS_READ}{more.get(n, "")}' for n in names)


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


TURN = math.radians


def torque(body: str, more: str) -> str:
    return f'[[torques]]\nbody = "{body}"\n{more}'


ROWS = 'table = [["1 rev", "8 mN·m"], ["3 rev", "6 mN·m"], ["7 rev", "-2 mN·m"]]\n'
TRAIN = 'train = [{ ratio = 10, inertia = "3 g·cm²" }, { ratio = -4, inertia = "5 g·cm²" }]\n'


def test_a_mainspring_drives_through_a_train() -> None:
    """Half of the work is lost; 4 turns run down; a turn of the barrel is five of the body the other way."""
    scene = read(BODIES + torque("a", f'over = "barrel"\nratio = -5\nefficiency = 0.5\nrun_down = "4 rev"\n{ROWS}{TRAIN}'))
    (found,) = scene.torques
    train = 3e-7 / 100.0 + 5e-7 / 16.0
    assert scene.body("a").inertia == pytest.approx(5e-7 + train, rel=1e-12)
    made = found.mainspring
    assert isinstance(made, Mainspring) and (made.ratio, made.efficiency) == (-5.0, 0.5)
    assert (made.run_down, made.torque, made.inertia) == pytest.approx((8 * math.pi, 4e-3, train), rel=1e-12)
    assert found.value == pytest.approx(-0.4e-3)
    angles = [TURN(30) + (turned - 4.0) * math.tau * -5.0 for turned in (7.0, 3.0, 1.0)]
    assert found.over == "angle" and [x for x, _ in found.table] == pytest.approx(angles)
    assert [y for _, y in found.table] == pytest.approx([0.2e-3, -0.6e-3, -0.8e-3])


@pytest.mark.parametrize(
    ("turns", "torque_at"), [(0.5, 8.0), (1.0, 8.0), (2.0, 7.0), (3.0, 6.0), (6.0, 0.0), (7.0, -2.0), (9.0, -2.0)]
)
def test_beyond_its_table_a_mainspring_stays_as_strong(turns: float, torque_at: float) -> None:
    (found,) = read(BODIES + torque("a", f'over = "barrel"\nratio = 2\nrun_down = "{turns} rev"\n{ROWS}')).torques
    assert found.mainspring is not None and found.mainspring.efficiency == 1.0 and found.mainspring.inertia == 0.0
    assert found.mainspring.torque == pytest.approx(1e-3 * torque_at, abs=1e-18)
    assert found.value == pytest.approx(0.5e-3 * torque_at, abs=1e-18)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (torque("a", 'value = "-3 µN·m"\n'), Torque("a", -3e-6)),
        (torque("s", 'value = "-3 µN"\nagainst = "t"\n'), Torque("s", -3e-6, against="t")),
        (
            torque("s", 'over = "travel"\ntable = [["1 mm", "2 N"], ["3 mm", "5 N"]]\n'),
            Torque("s", over="angle", table=((1e-3, 2.0), (3e-3, 5.0))),
        ),
        (
            torque("a", 'over = "angle"\ntable = [["1 rad", "2 N·m"], ["3 rad", "5 N·m"]]\n'),
            Torque("a", over="angle", table=((1.0, 2.0), (3.0, 5.0))),
        ),
        (
            torque("a", 'over = "time"\ntable = [["1 s", "2 N·m"], ["3 s", "5 N·m"]]\n'),
            Torque("a", over="time", table=((1.0, 2.0), (3.0, 5.0))),
        ),
        (
            torque("s", 'over = "time"\nperiod = "7 s"\ntable = [["1 s", "2 N"], ["3 s", "5 N"]]\n'),
            Torque("s", over="time", table=((1.0, 2.0), (3.0, 5.0), (8.0, 2.0)), period=7.0),
        ),
    ],
)
def test_a_torque_or_a_force(text: str, expected: Torque) -> None:
    assert read(BODIES + text).torques == (expected,)


def damping(body: str, more: str) -> str:
    return f'[[damping]]\nbody = "{body}"\n{more}'


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            damping("a", 'viscous = "3 N·m·s/rad"\nquadratic = "5 N·m·s²/rad²"\ncoulomb = "7 N·m"\n'),
            Damping("a", 3.0, 5.0, 7.0),
        ),
        (damping("s", 'viscous = "3 N·s/m"\nquadratic = "5 N·s²/m²"\ncoulomb = "7 N"\n'), Damping("s", 3.0, 5.0, 7.0)),
        (damping("s", 'quadratic = "5 N·s²/m²"\nagainst = "t"\n'), Damping("s", 0.0, 5.0, 0.0, "t")),
        (
            spring("a", 'stiffness = "0.8 N·m/rad"\n') + damping("a", "q_factor = 40\n"),
            Damping("a", math.sqrt(0.8 * 5e-7) / 40),
        ),
        (spring("s", 'stiffness = "0.8 N/m"\n') + damping("s", "q_factor = 40\n"), Damping("s", math.sqrt(0.8 * 2e-3) / 40)),
    ],
)
def test_a_damper(text: str, expected: Damping) -> None:
    (found,) = read(BODIES + text).damping
    assert (found.body, found.against) == (expected.body, expected.against)
    assert (found.viscous, found.quadratic, found.coulomb) == pytest.approx(
        (expected.viscous, expected.quadratic, expected.coulomb), rel=1e-12, abs=0.0
    )


REFUSED_TORQUES_READ = [
    (torque("a", 'value = "1 N·m"\nratio = 3\n'), ['torques.0.ratio: belongs to a table with over = "barrel"']),
    (torque("a", 'value = "1 N·m"\nperiod = "3 s"\n'), ["torques.0.period: belongs to a table; a value is constant"]),
    (
        torque("a", 'value = "1 N·m"\nover = "time"\ntable = [["1 s", "2 N·m"], ["3 s", "5 N·m"]]\n'),
        ["torques.0.value: a torque"],
    ),
    (
        torque("a", 'over = "travel"\ntable = [["1 rad", "2 N·m"], ["3 rad", "5 N·m"]]\n'),
        ["torques.0.over: not one of angle, time,"],
    ),
    (torque("s", 'over = "barrel"\ntable = [["1 mm", "2 N"], ["3 mm", "5 N"]]\n'), ["torques.0.over: not one of travel, time"]),
    (
        torque("s", 'table = [["1 mm", "2 N"], ["3 mm", "5 N"]]\n'),
        ['torques.0: a table needs over = "travel" or over = "time"'],
    ),
    (
        torque("a", 'over = "angle"\nperiod = "3 s"\ntable = [["1 rad", "2 N·m"], ["3 rad", "5 N·m"]]\n'),
        ["torques.0.period: belongs"],
    ),
    (torque("a", 'over = "barrel"\n' + ROWS), ["torques.0: missing: ratio"]),
    (torque("a", 'over = "barrel"\nratio = 3\ntrain = 4\n' + ROWS), ["torques.0.train: write a list such as"]),
    (torque("a", 'over = "barrel"\nratio = 3\ntrain = [{ ratio = 4 }]\n' + ROWS), ["torques.0.train.0: missing: inertia"]),
    (damping("a", ""), ["damping.0: missing: q_factor = 250"]),
    (damping("a", "q_factor = 40\n"), ["damping.0.q_factor: neither a spring nor gravity pulls a back"]),
    ("[[damping]]\nviscous = '1 N·m·s/rad'\n", ['damping.0.body: missing. Write e.g. body = "a"']),
]


@pytest.mark.parametrize(("text", "expected"), REFUSED_TORQUES_READ)
def test_what_cannot_be_is_said_once(text: str, expected: list[str]) -> None:
    said = faults(BODIES + text)
    assert len(said) == len(expected) and all(one.startswith(words) for one, words in zip(said, expected, strict=True)), said
