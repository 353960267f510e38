"""How stiff are springs on a coordinate, and where do they rest, as a scene writes them?"""

from __future__ import annotations

import math

import pytest
from scene_texts import BODIES, faults, read, spring

from watchsim.scene.forces import Spring

TURN = math.radians


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
        assert len(faults(BODIES + text)) == 1
        return
    (found,) = read(BODIES + text).springs
    for name in ("body", "against", "coil"):
        assert getattr(found, name) == getattr(expected, name)
    for name in ("stiffness", "rest", "frequency", "stop", "restitution"):
        one, other = getattr(found, name), getattr(expected, name)
        assert one is None if other is None else one == pytest.approx(other, rel=1e-12, abs=0.0), name
