"""Which outlines may touch by [[contacts]], and what does nothing or is declared twice?"""

from __future__ import annotations

from typing import Any

import pytest
from made_scenes import circle, drawing, square

from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Contact, Side
from watchsim.scene.load import load

INERTIA = 'inertia = "5 g·cm²"\nmass = "2 g"\n'
BODIES = f"""
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
    return BODIES + "".join(f"[[contacts]]\nbetween = [{pair}]\n{more}" for pair in pairs)


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


def faults(desk: Any, text: str) -> list[str]:
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
    (said,) = faults(plate, contacts(pair))
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
    said = [one.replace(one.partition(".between")[2].partition(":")[0], "", 1) for one in faults(plate, contacts(*pairs))]
    assert len(said) == len(words) and all(one.startswith(what) for one, what in zip(said, words, strict=True))


def test_layers_of_one_body_are_pairs_of_their_own(plate: Any) -> None:
    assert len(load(plate.scene(contacts('"a.A", "b"', '"a.B.C", "b"', '"a.A", "c"'))).contacts) == 3


def test_a_layer_taken_out_as_a_bore_is_told(plate: Any) -> None:
    solid = '[[bodies.a.solids]]\nlayer = "A"\nthickness = "1 mm"\ndensity = "8 g/cm³"\nbores = ["E"]\n'
    loops = (square(20e-3, layer="A"), square(1e-3, (5e-3, 0.0), "E"), square(1e-3, (30e-3, 0.0), "B.C"))
    plate.put(drawing("plate.dxf", loops))
    text = BODIES.replace('inertia = "5 g·cm²"\n[bodies.b]', f"{solid}[bodies.b]")
    (said,) = faults(plate, f'{text}[[contacts]]\nbetween = ["a.E", "b"]\n')
    assert said.startswith('contacts.0.between.0 = "a.E": this layer is taken out as a bore; to be touched')


DAMPED = '[[damping]]\nbody = "{}"\ncoulomb = "3 nN·m"\n'


def test_dry_friction_on_a_carrier_that_turns_is_refused(plate: Any) -> None:
    (said,) = faults(plate, BODIES + DAMPED.format("turns"))
    assert said.startswith("damping.0.coulomb: dry friction between turns and a carrier that turns")
    for free in (DAMPED.format("b"), DAMPED.format("turns").replace("coulomb", "viscous").replace("N·m", "N·m·s/rad")):
        assert len(load(plate.scene(BODIES + free)).damping) == 1


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
    text = BODIES + AGAINST.format(one, other, "N/m" if one == "s" else "N·m/rad", "") + more
    if words:
        (said,) = faults(plate, text)
        assert words in said
    else:
        assert load(plate.scene(text)).springs[0].against == other
