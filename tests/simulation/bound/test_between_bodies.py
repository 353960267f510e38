"""Do springs, dampers and torques between two bodies act on both? Against closed forms and the other method."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scene.made_gears import read

import watchsim as ws
from watchsim.mechanism.static_check import check_report, check_text
from watchsim.scene.errors import SceneError

J1, J2, K = 1e-7, 3e-7, 2e-5
TWO = """
[scene]
title = "two discs on a torsion wire"

[bodies.one]
inertia = "1 g·cm²"
angle = "40°"
{one}

[bodies.two]
position = ["9 mm", "0 mm"]
inertia = "3 g·cm²"
{two}

[[springs]]
body = "one"
against = "two"
stiffness = "20 µN·m/rad"
rest = "10°"

{more}

[run]
duration = "3 s"
tolerance = 1e-11
"""


def two(folder, more: str = "", one: str = "", other: str = ""):
    return read(folder, TWO.format(one=one, two=other, more=more))


def test_two_discs_swing_against_each_other(tmp_path) -> None:
    """w² = k (1/J1 + 1/J2), amplitudes as J2 to J1, the common angle at rest."""
    scene = two(tmp_path)
    run = ws.simulate(scene)
    w, start = math.sqrt(K * (1.0 / J1 + 1.0 / J2)), math.radians(30.0)
    wound = start * math.cos(w * 3.0)
    middle = J1 * math.radians(40.0) / (J1 + J2)
    rest = math.radians(10.0) * J2 / (J1 + J2)
    one = middle + rest + wound * J2 / (J1 + J2)
    assert run.end_q[0] == pytest.approx(one, abs=1e-8)
    assert run.end_q[0] - run.end_q[1] == pytest.approx(math.radians(10.0) + wound, abs=1e-8)
    assert run.energy["residual_relative"] < 1e-9
    text = check_text(check_report(scene, ()), scene)
    assert f"spring on one against two: 20 µN·m/rad, {w / math.tau:.6g}"[:45] in text


def test_damping_between_them_brings_both_to_one_speed(tmp_path) -> None:
    """Momentum is kept, the difference decays as a damped oscillator; what damping takes is booked."""
    c = 1e-6
    more = '[[damping]]\nbody = "two"\nagainst = "one"\nviscous = "1 µN·m·s/rad"'
    run = ws.simulate(two(tmp_path, more, one='velocity = "100 °/s"'))
    m = 1.0 / (1.0 / J1 + 1.0 / J2)
    assert J1 * run.u[:, 0] + J2 * run.u[:, 1] == pytest.approx(
        np.full(len(run.t), J1 * math.radians(100.0)), rel=1e-9, abs=0.0
    )
    decay = 0.5 * c / m
    w = math.sqrt(K / m - decay**2)
    x0, v0, t = math.radians(30.0), math.radians(100.0), np.array([0.05, 0.2, 0.7, 3.0])
    x = np.exp(-decay * t) * (x0 * np.cos(w * t) + (v0 + decay * x0) / w * np.sin(w * t))
    q = run.sample(t)[0]
    assert np.abs(x[:3]).min() > 1e-4
    assert q[:, 0] - q[:, 1] - math.radians(10.0) == pytest.approx(x, abs=1e-8)
    assert run.energy["residual_relative"] < 1e-9


def test_a_torque_between_two_bodies_turns_them_apart(tmp_path) -> None:
    """Both speeds grow as one over their inertias; the motor's work is the torque times the angle between them."""
    more = '[[torques]]\nbody = "one"\nagainst = "two"\nvalue = "1 µN·m"'
    scene = two(tmp_path, more).set("springs.0.stiffness", "1e-30 N·m/rad")
    run = ws.simulate(scene)
    assert run.end_u == pytest.approx([1e-6 * 3.0 / J1, -1e-6 * 3.0 / J2], rel=1e-9)
    assert run.energy["in_J"] == pytest.approx(0.5 * 1e-12 * 9.0 * (1.0 / J1 + 1.0 / J2), rel=1e-9, abs=0.0)


def test_the_other_method_agrees_at_its_order(tmp_path) -> None:
    more = '[[damping]]\nbody = "one"\nagainst = "two"\nviscous = "0.2 µN·m·s/rad"\nquadratic = "10 nN·m·s²/rad²"'
    scene = two(tmp_path, more)
    exact = ws.simulate(scene, duration=0.5).end_q
    errors = [np.abs(ws.simulate(scene, duration=0.5, method="moreau", step=h).end_q - exact).max() for h in (2e-3, 1e-3)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.3)


def test_a_driven_body_drags_another_by_a_spring(tmp_path) -> None:
    """The other end turns evenly: the body swings about it, and the drive's work is the torque times that speed."""
    scene = two(tmp_path, other='motion = "driven"\nvelocity = "200 °/s"')
    run = ws.simulate(scene)
    w, speed, start = math.sqrt(K / J1), math.radians(200.0), math.radians(30.0)
    wound = start * math.cos(w * 3.0) - speed / w * math.sin(w * 3.0)
    assert run.end_q == pytest.approx([wound + math.radians(10.0) + 3.0 * speed, 3.0 * speed], abs=1e-8)
    work = -K * speed * (start * math.sin(w * 3.0) / w + speed / w**2 * (math.cos(w * 3.0) - 1.0))
    assert run.energy["in_J"] == pytest.approx(work, rel=1e-8, abs=0.0)
    assert run.energy["residual_relative"] < 1e-9
    twin = ws.simulate(scene, method="moreau", step=1e-4)
    assert twin.end_q[0] == pytest.approx(run.end_q[0], abs=1e-4)
    assert twin.energy["in_J"] == pytest.approx(work, rel=1e-3)


CARRIED = """
[scene]
title = "a balance on a driven carriage"

[bodies.carriage]
motion = "driven"
velocity = "36 °/s"

[bodies.balance]
on = "carriage"
position = ["3 mm", "0 mm"]
angle = "200°"
mass = "40 mg"
inertia = "12 mg·cm²"

[[springs]]
body = "balance"
frequency = "3 Hz"

[[damping]]
body = "balance"
q_factor = 50

[run]
duration = "2 s"
"""


def test_a_balance_on_a_driven_carriage_swings_as_at_rest(tmp_path) -> None:
    """Turning evenly changes nothing but the start of its own speed; the drive pays for nothing but damping and swing."""
    run = ws.simulate(read(tmp_path, CARRIED))
    decay = 6.0 * math.pi / 100.0
    w = math.sqrt((6.0 * math.pi) ** 2 - decay**2)
    x = math.radians(200.0) * math.exp(-decay * 2.0) * (math.cos(2.0 * w) + decay / w * math.sin(2.0 * w))
    assert run.end_q == pytest.approx([math.radians(72.0), x], abs=1e-8)
    assert run.energy["residual_relative"] < 1e-9


def test_what_cannot_act_between_two_bodies_is_a_fault(tmp_path) -> None:
    def faults(more: str, **parts) -> dict[str, str]:
        with pytest.raises(SceneError) as caught:
            two(tmp_path, more, **parts)
        return {fault.key: fault.message for fault in caught.value.faults}

    assert (
        "there is no such body"
        in faults('[[springs]]\nbody = "one"\nagainst = "too"\nstiffness = "1 N·m/rad"')["springs.1.against"]
    )
    assert "stiffness" in faults('[[springs]]\nbody = "one"\nagainst = "two"\nfrequency = "1 Hz"')["springs.1.frequency"]
    assert "itself" in faults('[[springs]]\nbody = "one"\nagainst = "one"\nstiffness = "1 N·m/rad"')["springs.1.against"]
    assert "viscous" in faults('[[damping]]\nbody = "one"\nagainst = "two"\ncoulomb = "1 N·m"')["damping.0.coulomb"]
    found = faults("", other='motion = "slide"\naxis = [1, 0]\nmass = "1 g"')
    assert "line spring" in found["springs.0.against"]
