"""How stiff are springs on a coordinate, and where do they rest, as a scene writes them?"""

from __future__ import annotations

import math

import pytest
import tomllib

from watchsim.scene.errors import SceneError
from watchsim.scene.file.read_scene import from_mapping
from watchsim.scene.force import Spring
from watchsim.scene.scene import Scene

BODIES = """
[bodies.a]
position = ["3 mm", "-2 mm"]
angle = "30°"
inertia = "5 g·cm²"
[bodies.b]
motion = "fixed"
position = ["11 mm", "6 mm"]
angle = "-50°"
[bodies.s]
motion = "slide"
axis = [3, 4]
mass = "2 g"
position = ["0 mm", "30 mm"]
[bodies.t]
motion = "slide"
axis = [3, 4]
mass = "7 g"
[bodies.d]
motion = "driven"
velocity = "2 rad/s"
position = ["50 mm", "0 mm"]
"""
TURN = math.radians


def read(text: str) -> Scene:
    return from_mapping(tomllib.loads(BODIES + text), None)


def faults(text: str) -> list[str]:
    with pytest.raises(SceneError) as caught:
        read(text)
    return [f"{fault.key}: {fault.message}" for fault in caught.value.faults]


def spring(body: str, more: str) -> str:
    return f'[[springs]]\nbody = "{body}"\n{more}'


LEAF = 'leaf = { modulus = "200 GPa", length = "5 mm", width = "2 mm", thickness = "0.1 mm"%s }\n'
BENT = 3.0 * 200e9 * (2e-3 * 1e-12 / 12.0) / 125e-9  # N/m
SPRINGS = [
    (spring("a", 'frequency = "3 Hz"\nrest = "20°"\n'), Spring("a", 5e-7 * (6 * math.pi) ** 2, TURN(20), 3.0)),
    (spring("s", 'frequency = "3 Hz"\n'), Spring("s", 2e-3 * (6 * math.pi) ** 2, 0.0, 3.0)),
    (spring("a", 'stiffness = "4 µN·m/rad"\npreload = "1 µN·m"\n'), Spring("a", 4e-6, TURN(30) + 0.25)),
    (spring("a", 'stiffness = "4 µN·m/rad"\npreload = "1 µN·m"\nstop = "10°"\nrestitution = 0\n'), None),
    (spring("s", 'stiffness = "4 N/m"\npreload = "3 mN"\nstop = "-1 mm"\n'), None),
    (
        spring("s", 'stiffness = "4 N/m"\npreload = "-3 mN"\nstop = "-1 mm"\nrestitution = 0.4\n'),
        Spring("s", 4.0, -1.75e-3, stop=-1e-3, restitution=0.4),
    ),
    (
        spring("a", 'stiffness = "4 µN·m/rad"\npreload = "-1 µN·m"\nstop = "10°"\nrestitution = 0.4\n'),
        Spring("a", 4e-6, TURN(10) - 0.25, stop=TURN(10), restitution=0.4),
    ),
    (spring("a", LEAF % ', arm = "3 mm"'), Spring("a", BENT * 9e-6)),
    (spring("s", LEAF % ""), Spring("s", BENT)),
    (spring("s", 'against = "t"\nstiffness = "4 N/m"\npreload = "2 N"\n'), Spring("s", 4.0, 0.5, against="t")),
    (spring("a", 'against = "d"\nstiffness = "4 N·m/rad"\npreload = "2 N·m"\n'), Spring("a", 4.0, 0.5 + TURN(30), against="d")),
    (spring("d", 'stiffness = "4 N·m/rad"\n'), None),
    (spring("b", 'stiffness = "4 N·m/rad"\n'), None),
    (spring("a", 'against = "s"\nstiffness = "4 N·m/rad"\n'), None),
    (spring("a", LEAF % ""), None),
    (spring("s", LEAF % ', arm = "3 mm"'), None),
]


@pytest.mark.parametrize(("text", "expected"), SPRINGS)
def test_a_spring_on_a_coordinate(text: str, expected: Spring | None) -> None:
    if expected is None:
        assert len(faults(text)) == 1
        return
    (found,) = read(text).springs
    for name in ("body", "against", "coil"):
        assert getattr(found, name) == getattr(expected, name)
    for name in ("stiffness", "rest", "frequency", "stop", "restitution"):
        one, other = getattr(found, name), getattr(expected, name)
        assert one is None if other is None else one == pytest.approx(other, rel=1e-12, abs=0.0), name
