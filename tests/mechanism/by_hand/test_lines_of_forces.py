"""What does `watchsim check` say of forces, contacts and what swings, line by line? Numbers worked by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from watchsim.mechanism.scene_in_words import force_lines, law_words
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Damping, LineSpring, Mainspring, Side, Spring, Torque
from watchsim.scene.prescribed import Prescribed
from watchsim.scene.scene import Scene

A, B = Body("a", inertia=2e-9), Body("b", inertia=8e-9)
S, T = Body("s", "slide", mass=2e-3), Body("t", "slide", mass=8e-3)
DRIVEN = Body("d", prescribed=Prescribed())
TABLE = ((0.0, 1.0), (1.0, 2.0), (3.0, 1.0))
FORCES: list[tuple[dict[str, Any], str]] = [
    ({"springs": (Spring("a", 8e-7, 0.5),)}, "  spring on a: 800 nN·m/rad, 3.1831 Hz = 22918.3 vph, at rest at 28.6479°"),
    ({"springs": (Spring("s", 8.0, -3e-3),)}, "  spring on s: 8 N/m, 10.0658 Hz = 72474.1 vph, at rest at -3 mm"),
    (
        {"springs": (Spring("a", 8e-7, 0.5, against="b"),)},
        ("  spring on a against b: 800 nN·m/rad, 3.55881 Hz while they touch nothing, at rest at 28.6479°"),
    ),
    (
        {"springs": (Spring("a", 8e-7, 0.5, against="d"),)},
        ("  spring on a against d: 800 nN·m/rad, 3.1831 Hz while they touch nothing, at rest at 28.6479°"),
    ),
    (
        {"springs": (Spring("s", 8.0, 1e-3, against="t"),)},
        "  spring on s against t: 8 N/m, 11.254 Hz while they touch nothing, at rest at 1 mm",
    ),
    (
        {"springs": (Spring("a", 8e-7, 0.5, stop=0.25, restitution=0.3),)},
        (
            "  spring on a: 800 nN·m/rad, 3.1831 Hz = 22918.3 vph"
            ", at rest at 28.6479°, pressed on its stop at 14.3239° with 200 nN·m, restitution 0.3"
        ),
    ),
    (
        {"springs": (Spring("s", 8.0, -3e-3, stop=-1e-3),)},
        (
            "  spring on s: 8 N/m, 10.0658 Hz = 72474.1 vph"
            ", at rest at -3 mm, pressed on its stop at -1 mm with 16 mN, restitution 0"
        ),
    ),
    ({"torques": (Torque("a", -3e-6),)}, "  drive on a: -3 µN·m"),
    ({"torques": (Torque("s", 4e-3, against="t"),)}, "  drive on s against t: 4 mN"),
    ({"torques": (Torque("a", over="angle", table=TABLE),)}, "  drive on a: 3 values over angle"),
    ({"torques": (Torque("a", over="time", table=TABLE, period=3.0),)}, "  drive on a: 2 values over time, again after 3 s"),
    (
        {"torques": (Torque("a", 4e-6, "angle", TABLE, Mainspring(80.0, 0.75, 3.0 * math.pi, 5e-3, 3e-10)),)},
        (
            "  drive on a: 4 µN·m, from 5 mN·m at the barrel 1.5 turns from full wind"
            ", ratio 80, efficiency 75 %, train felt as 3 mg·cm²"
        ),
    ),
    (
        {"torques": (Torque("a", 4e-6, "angle", TABLE, Mainspring(80.0, 0.75, math.pi, 5e-3, 0.0)),)},
        ("  drive on a: 4 µN·m, from 5 mN·m at the barrel 0.5 turns from full wind, ratio 80, efficiency 75 %"),
    ),
    ({"damping": (Damping("a", 3e-9, 5e-9, 7e-9),)}, "  damping on a: 3 nN·m·s/rad, 5 nN·m·s²/rad², dry friction 7 nN·m"),
    ({"damping": (Damping("s", 3e-3, 5e-3, 7e-3, "t"),)}, "  damping on s against t: 3 mN·s/m, 5 mN·s²/m², dry friction 7 mN"),
    ({"damping": (Damping("a"),)}, "  damping on a: none"),
    ({"springs": (Spring("a", 8e-7),), "damping": (Damping("a", 2e-9),)}, "  damping on a: 2 nN·m·s/rad, Q = 20"),
    (
        {"springs": (Spring("a", 8e-7),), "damping": (Damping("a", 2e-9, against="b"),)},
        "  damping on a against b: 2 nN·m·s/rad",
    ),
    (
        {"line_springs": (LineSpring(("a", "b"), ((0.0, 0.0), (1.0, 0.0)), 20.0, 3e-3, 0.5),)},
        "  spring from a point of a to one of b: 20 N/m, 3 mm long without force, damping 500 mN·s/m",
    ),
    (
        {"line_springs": (LineSpring(("a", None), ((0.0, 0.0), (1.0, 0.0)), 20.0, 3e-3),)},
        "  spring from a point of a to one of the movement: 20 N/m, 3 mm long without force",
    ),
    ({"contacts": (Contact((Side("a", "X"), Side("b")), 0.2, 0.3),)}, "  contact a.X - b: friction 0.2, restitution 0.3"),
    (
        {"contacts": (Contact((Side("a", "X"), Side("b")), 0.2, 0.3, 0.1),), "tangential_law": "pg1996"},
        "  contact a.X - b: friction 0.2, restitution 0.3, tangential 0.1 (pg1996)",
    ),
    (
        {"contacts": (Contact((Side("a"), Side("b"))), Contact((Side("b"), Side("a"))))},
        "  contact b - a: friction 0, restitution 0",
    ),
]


@pytest.mark.parametrize(("forces", "last"), FORCES)
def test_forces_one_by_one(forces: dict[str, Any], last: str) -> None:
    assert [line.replace("−", "-") for line in force_lines(Scene("t", (A, B, S, T, DRIVEN), **forces))][-1] == last


def test_a_spring_that_presses_has_no_beats() -> None:
    """Its body rests on a driven wheel; of a spring without stiffness there is no frequency."""
    pressed = Scene("t", (A, B), (Spring("a", 8e-7),), (Torque("b", 1.0),), contacts=(Contact((Side("a"), Side("b"))),))
    (line,) = (line for line in force_lines(pressed) if "spring" in line)
    assert line == "  spring on a: 800 nN·m/rad, 3.1831 Hz while it touches nothing, at rest at 0°"
    assert "nan Hz" in next(iter(force_lines(Scene("t", (A,), (Spring("a", 0.0),)))))


def test_centre_distances_are_those_of_pivots_that_may_touch_once_each() -> None:
    a, b, s = replace(A, position=(1e-3, 2e-3)), replace(B, position=(4e-3, 6e-3)), replace(S, position=(9e-3, 0.0))
    contacts = tuple(Contact((Side(x), Side(y))) for x, y in (("a", "b"), ("b", "a"), ("a", "s"), ("s", "b")))
    found = [line for line in force_lines(Scene("t", (a, b, s), contacts=contacts)) if "centre distance" in line]
    assert found == ["  centre distance a - b: 5 mm"]


def test_what_swings_by_its_weight() -> None:
    down = {"gravity": (0.0, -9.0)}
    heavy = Body("p", mass=2.0, inertia=3.0, centre_of_mass=(0.0, -0.5))
    spring = (Spring("p", 27.0),)
    alone, both = Scene("t", (heavy,), **down), Scene("t", (heavy,), spring, **down)  # type: ignore[arg-type]
    up = replace(both, bodies=(replace(heavy, centre_of_mass=(0.0, 0.5)),), springs=(Spring("p", 9.0),))
    assert list(force_lines(alone)) == [
        "  p makes small swings at 0.275664 Hz = 1984.78 vph about 0° by gravity alone, 9 N·m/rad"
    ]
    expected = (
        "  p makes small swings at 0.551329 Hz = 3969.57 vph about 0°"
        " by its springs and gravity together, 9 N·m/rad of it from gravity"
    )
    assert list(force_lines(both))[1] == expected
    assert "0.477465 Hz" in next(iter(force_lines(both)))  # of the spring alone
    weak = replace(up, springs=(Spring("p", 9.0 - 1e-9, 0.0),), gravity=(0.0, -9.0))
    assert "p " in list(force_lines(weak))[1]


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (Body("d", prescribed=Prescribed(table=((0.0, 0.0), (2.5, 1.0)))), "driven along a path of 2.5 s"),
        (Body("d", prescribed=Prescribed(square=(3.0 * math.tau) ** 2)), "driven, swings at 3 Hz"),
        (Body("d", prescribed=Prescribed(), velocity=(math.pi,)), "driven at 180 °/s"),
        (Body("d", prescribed=Prescribed()), "driven at 0 °/s"),
        (Body("d", "slide", prescribed=Prescribed(), velocity=(3e-3,)), "driven at 3 mm/s"),
    ],
)
def test_how_a_driven_body_moves(body: Body, words: str) -> None:
    assert law_words(body) == words
