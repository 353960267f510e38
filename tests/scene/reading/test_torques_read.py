"""How strong are torques, mainsprings and dampers, as a scene writes them?"""

from __future__ import annotations

import math

import pytest
from scene_texts import BODIES, faults, read, spring

from watchsim.scene.forces import Damping, Mainspring, Torque

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


REFUSED = [
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


@pytest.mark.parametrize(("text", "expected"), REFUSED)
def test_what_cannot_be_is_said_once(text: str, expected: list[str]) -> None:
    said = faults(BODIES + text)
    assert len(said) == len(expected) and all(one.startswith(words) for one, words in zip(said, expected, strict=True)), said
