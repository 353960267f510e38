"""Do springs, gears and torques between bodies act as closed forms and the other method say?"""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomllib
from scene.made_gears import read, wheels

import watchsim as ws
from watchsim.mechanism.check import check_report, check_text
from watchsim.scene.errors import SceneError
from watchsim.scene.load import from_mapping
from watchsim.scene.scene import Scene
from watchsim.simulation.state import EventKind

# Do springs, dampers and torques between two bodies act on both? Against closed forms and the other method.

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


# Do geared bodies move as one coordinate, and gears with play as two? Against closed forms and the other method.

J_A, J_B = 1e-7, 1e-8
SWISS = Path("profiles/swiss_lever/scene.toml")


def test_inertia_and_torques_of_the_second_count_with_the_ratio(tmp_path) -> None:
    """(J_A + r² J_B) q'' = M_A + r M_B."""
    r = -8.0
    more = '[[torques]]\nbody = "wheel"\nvalue = "1 mN·m"\n[[torques]]\nbody = "pinion"\nvalue = "0.05 mN·m"'
    run = ws.simulate(wheels(tmp_path, r, more=more))
    gained = (1e-3 + r * 5e-5) / (J_A + r * r * J_B)
    assert run.end_u == pytest.approx([0.5 * gained, 0.5 * r * gained], rel=1e-12)
    assert run.end_q == pytest.approx([0.125 * gained, 0.125 * r * gained], rel=1e-12)
    assert run.energy["residual_relative"] < 1e-12


def test_a_spring_and_dampers_on_the_second_act_through_the_gears(tmp_path) -> None:
    """A damped oscillator of stiffness k r², damping c r² and inertia J_A + r² J_B about the wheel's angle rest / r."""
    r, k, c = -2.0, 1e-5, 1e-7
    more = '[[springs]]\nbody = "pinion"\nstiffness = "10 µN·m/rad"\nrest = "30°"\n'
    more += '[[damping]]\nbody = "pinion"\nviscous = "0.1 µN·m·s/rad"'
    run = ws.simulate(wheels(tmp_path, r, wheel='angle = "10°"', more=more))
    J = J_A + r * r * J_B
    decay, w0 = 0.5 * c * r * r / J, math.sqrt(k * r * r / J)
    w = math.sqrt(w0 * w0 - decay * decay)
    # The pinion starts at its angle 0 and ends at 30°.
    x0, t = math.radians(-30.0), 0.5
    x = math.exp(-decay * t) * x0 * (math.cos(w * t) + decay / w * math.sin(w * t))
    where = {name: run.end_q[part][0] for name, part in run.slices.items()}
    assert where["pinion"] == pytest.approx(math.radians(30.0) + x, rel=1e-10)
    assert where["wheel"] == pytest.approx(math.radians(10.0) + where["pinion"] / r, rel=1e-10)


def test_the_frequency_of_a_spring_is_that_with_all_that_is_geared(tmp_path) -> None:
    scene = wheels(tmp_path, -8.0, more='[[springs]]\nbody = "pinion"\nfrequency = "3 Hz"')
    run = ws.simulate(scene.set("bodies.pinion.angle", "20°").set("springs.0.rest", "0°"), duration=1.0)
    assert run.end_q[run.slices["pinion"]] == pytest.approx([math.radians(20.0)], rel=1e-9)


def test_drag_and_dry_friction_of_the_second_brake_the_first(tmp_path) -> None:
    """J q'' = M - |r| T - |r|³ c q'²: q' = w tanh(t w |r|³ c / J) with w² = (M - |r| T) / (|r|³ c)."""
    r, M, T, c = -3.0, 1e-3, 5e-5, 1e-8
    more = '[[torques]]\nbody = "wheel"\nvalue = "1 mN·m"\n'
    more += '[[damping]]\nbody = "pinion"\ncoulomb = "50 µN·m"\nquadratic = "10 nN·m·s²/rad²"'
    run = ws.simulate(wheels(tmp_path, r, more=more))
    drag, J = abs(r) ** 3 * c, J_A + r * r * J_B
    w = math.sqrt((M - abs(r) * T) / drag)
    assert run.end_u[0] == pytest.approx(w * math.tanh(0.5 * w * drag / J), rel=1e-9)
    assert run.energy["residual_relative"] < 1e-9


def test_a_table_over_the_angle_of_the_second_is_read_there(tmp_path) -> None:
    """A torque that falls linearly with the pinion's angle is a spring."""
    more = '[[torques]]\nbody = "pinion"\nover = "angle"\ntable = [["-100 rad", "1 mN·m"], ["100 rad", "-1 mN·m"]]'
    run = ws.simulate(wheels(tmp_path, -2.0, pinion='angle = "1 rad"', more=more))
    w = math.sqrt(1e-5 / (J_B + J_A / 4.0))
    assert run.end_q[run.slices["pinion"]] == pytest.approx([math.cos(0.5 * w)], abs=1e-8)


RACKS = """
[scene]
title = "crown wheel"
gravity = ["-9.81 m/s²", "0 m/s²"]

[bodies.wheel]
inertia = "1 g·cm²"

[bodies.near]
motion = "slide"
axis = [1.0, 0.0]
mass = "2 g"

[bodies.far]
motion = "slide"
axis = [1.0, 0.0]
mass = "1 g"
circle = "1 mm"

[bodies.wall]
motion = "fixed"
line = [["-2 mm", "-5 mm"], ["-2 mm", "5 mm"]]

[[gears]]
between = ["wheel", "near"]
ratio = "10 mm/rad"

[[gears]]
between = ["wheel", "far"]
ratio = "-62.83185307179586 mm/rev"

[[contacts]]
between = ["far", "wall"]
restitution = 0.5

[[torques]]
body = "wheel"
value = "150 µN·m"

[run]
duration = "0.1 s"
"""


def test_two_racks_run_against_each_other_on_one_rotation(tmp_path) -> None:
    """x = ±R q: q'' = (M - (m1 - m2) g R) / (J + (m1 + m2) R²) until one meets a wall and all rebound by its restitution."""
    scene = read(tmp_path, RACKS)
    run = ws.simulate(scene)
    R, m1, m2 = 0.01, 2e-3, 1e-3
    bend = (1.5e-4 - (m1 - m2) * 9.81 * R) / (J_A + (m1 + m2) * R * R)
    where = {name: part.start for name, part in run.slices.items()}
    hit = math.sqrt(2.0 * 1e-3 / (R * bend))  # the disc of 1 mm is 1 mm from the wall
    found = run.events[run.events["kind"] == EventKind.IMPACT][0]
    assert found["t"] == pytest.approx(hit, rel=1e-12, abs=0.0)
    q, u = run.at(found["t"])
    assert q[where["near"]] == pytest.approx(-q[where["far"]], rel=1e-12, abs=0.0)
    assert u == pytest.approx(-0.5 * bend * hit * np.array([1.0, R, -R]), rel=1e-9)
    assert run.energy["residual_relative"] < 1e-12


PLANET = """
[scene]
title = "planet"

[bodies.carriage]
position = ["1 mm", "0 mm"]
angle = "30°"
velocity = "100 °/s"
inertia = "1 g·cm²"

[bodies.planet]
on = "carriage"
position = ["5 mm", "0 mm"]
angle = "20°"
mass = "2 g"
inertia = "0.1 g·cm²"

[[gears]]
between = ["carriage", "planet"]
ratio = 8.0

[[torques]]
body = "planet"
value = "0.2 mN·m"

[run]
duration = "0.5 s"
"""


def test_a_planet_rolls_round_a_fixed_wheel(tmp_path) -> None:
    """It turns 1 + r times as fast as the carriage; a torque against that acts r-fold: J = J_c + m d² + (1 + r)² J_p."""
    run = ws.simulate(read(tmp_path, PLANET))
    r, t = 8.0, 0.5
    bend = r * 2e-4 / (J_A + 2e-3 * 25e-6 + (1.0 + r) ** 2 * J_B)
    turned = math.radians(100.0) * t + 0.5 * bend * t * t
    assert run.end_q == pytest.approx([math.radians(30.0) + turned, math.radians(20.0) + r * turned], rel=1e-12)
    x, y, angle = run.pose("planet", t)
    assert angle == pytest.approx(math.radians(50.0) + (1.0 + r) * turned, rel=1e-12)
    assert (x, y) == pytest.approx((1e-3 + 5e-3 * math.cos(run.end_q[0]), 5e-3 * math.sin(run.end_q[0])), rel=1e-12, abs=0.0)


def _train_before(ratio: float, holds: bool) -> tuple[Scene, Scene]:
    """The Swiss lever, and the same with half of the wheel's inertia and its drive on a body geared to it."""
    plain = ws.load(SWISS)
    inertia, drive = plain.body("wheel").inertia, plain.torques[0].value
    mapping: dict[str, Any] = tomllib.loads(SWISS.read_text(encoding="utf-8"))
    train = {"position": ["20 mm", "0 mm"], "inertia": f"{0.5 * inertia * ratio**2!r} kg·m²"}
    bodies = mapping["bodies"]
    bodies["wheel"]["inertia"] = f"{0.5 * inertia!r} kg·m²"
    mapping["bodies"] = {"train": train, **bodies} if holds else {**bodies, "train": train}
    mapping["gears"] = [{"between": ["train", "wheel"], "ratio": ratio}]
    mapping["torques"] = [{"body": "train", "value": f"{drive * ratio!r} N·m"}]
    mapping.pop("expect", None)
    return plain, from_mapping(mapping, SWISS.resolve())


@pytest.mark.parametrize(("ratio", "holds"), [(-8.0, True), (-8.0, False), (6.5, True)])
def test_an_escape_wheel_may_be_geared_to_its_train(ratio, holds) -> None:
    """Contacts, cells and their symmetry are the same whichever body holds the coordinate, and whichever way it turns."""
    plain, geared = _train_before(ratio, holds)
    assert (geared.body("wheel").geared is None) != holds
    one, other = ws.simulate(plain, duration=1.0), ws.simulate(geared, duration=1.0)
    assert one.counts["impacts"] == other.counts["impacts"]
    for name in one.slices:
        assert other.end_q[other.slices[name]] == pytest.approx(one.end_q[one.slices[name]], abs=1e-7)
    train = other.q[:, other.slices["train"].start] * ratio
    wheel = other.q[:, other.slices["wheel"].start]
    assert np.ptp(train - wheel) < 1e-12


def test_forces_are_those_without_the_gears() -> None:
    plain, geared = _train_before(-8.0, True)
    one, other = (ws.simulate(scene, duration=0.2) for scene in (plain, geared))
    times = np.linspace(0.11, 0.19, 9)
    here, there = ws.forces(one, times), ws.forces(other, times)
    assert np.sort(here.normal.ravel()) == pytest.approx(np.sort(there.normal.ravel()), rel=1e-4, abs=1e-9)
    wheel, train = geared.body("wheel"), geared.body("train")
    way = np.subtract(wheel.position, train.position)
    radius = float(np.hypot(*way)) / 9.0  # of the wheel's pitch circle: it turns eight times as fast
    out, across = way / np.hypot(*way), np.array([-way[1], way[0]]) / np.hypot(*way)
    torque = plain.torques[0].value - wheel.inertia * other.acceleration(times)[:, other.slices["wheel"].start]
    meshing = there.pivots["wheel"] - here.pivots["wheel"]  # the bearing holds against the tooth
    assert meshing @ across == pytest.approx(torque / radius, rel=1e-4)
    assert np.abs(meshing @ out) == pytest.approx(np.abs(torque) / radius * math.tan(math.radians(20.0)), rel=1e-4)


def test_gears_with_play_rebound_by_their_restitution(tmp_path) -> None:
    """The angle of the pinion against r times the wheel's bounces within the play, and slows by e at each impact."""
    e, r = 0.5, -8.0
    parts = {"wheel": 'velocity = "-100 °/s"', "gears": f'backlash = "2°"\nrestitution = {e}'}
    run = ws.simulate(wheels(tmp_path, r, **parts))
    relative = run.u[:, run.slices["pinion"].start] - r * run.u[:, run.slices["wheel"].start]
    start, play = math.radians(-800.0), math.radians(2.0)
    closes = run.events[run.events["kind"] == EventKind.IMPACT]["t"]
    whole = 0.5 * play / abs(start)
    expected = [whole + play / abs(start) * sum(e**-k for k in range(1, n + 1)) for n in range(7)]
    assert closes == pytest.approx([t for t in expected if t < 0.5], rel=1e-9)
    assert relative[-1] == pytest.approx(start * (-e) ** len(closes), rel=1e-9)
    # An impulse on the pinion is r times as large, and opposite, on the wheel: J_A u_A + r J_B u_B is kept.
    u = {name: run.end_u[part][0] for name, part in run.slices.items()}
    assert J_A * u["wheel"] + r * J_B * u["pinion"] == pytest.approx(J_A * math.radians(-100.0), rel=1e-12, abs=0.0)
    assert run.energy["dissipated"]["impacts"] == pytest.approx(-run.energy["stored_J"], rel=1e-12, abs=0.0)


@pytest.mark.parametrize("efficiency", [0.9, 0.35])
def test_the_share_lost_is_that_of_the_efficiency(tmp_path, efficiency) -> None:
    """(J_A + r² J_B / η) q'' = M_A + r M_B / η while the wheel drives: closed form, and by the other method."""
    more = '[[torques]]\nbody = "wheel"\nvalue = "1 mN·m"\n[[torques]]\nbody = "pinion"\nvalue = "0.03 mN·m"'
    scene = wheels(tmp_path, -8.0, gears=f'backlash = "1°"\nefficiency = {efficiency}', more=more)
    run = ws.simulate(scene)
    bend = (1e-3 - 8.0 * 3e-5 / efficiency) / (J_A + 64.0 * J_B / efficiency)
    assert run.a[-1, 0] == pytest.approx(bend, rel=1e-9)
    assert run.energy["residual_relative"] < 1e-12
    twin = ws.simulate(scene, method="moreau", step=1e-5)
    assert twin.end_u[0] == pytest.approx(run.end_u[0], rel=1e-6)


def test_what_a_pinion_gives_back_is_the_same_share(tmp_path) -> None:
    """The pinion drives: (J_B + J_A / (r² η)) times its acceleration = M_B + M_A / (r η)."""
    eta, r = 0.8, -8.0
    more = '[[torques]]\nbody = "wheel"\nvalue = "0.1 mN·m"\n[[torques]]\nbody = "pinion"\nvalue = "0.2 mN·m"'
    run = ws.simulate(wheels(tmp_path, r, gears=f'backlash = "1°"\nefficiency = {eta}', more=more))
    bend = (2e-4 + 1e-4 / (r * eta)) / (J_B + J_A / (r * r * eta))
    assert run.a[-1, 1] == pytest.approx(bend, rel=1e-9)


def test_between_the_two_limits_friction_holds_gears_at_rest(tmp_path) -> None:
    """A load of 0.95 of what would balance without friction is neither lifted nor comes down at 90 %."""
    more = '[[torques]]\nbody = "wheel"\nvalue = "1 mN·m"\n[[torques]]\nbody = "pinion"\nvalue = "0.11875 mN·m"'
    run = ws.simulate(wheels(tmp_path, -8.0, gears='backlash = "1°"\nefficiency = 0.9', more=more))
    assert run.end_u == pytest.approx([0.0, 0.0], abs=1e-12)


def test_a_run_of_gears_with_play_can_be_read_back(tmp_path) -> None:
    run = ws.simulate(wheels(tmp_path, -8.0, gears='backlash = "1°"'), duration=0.05)
    ws.write_results(run, tmp_path / "run")
    assert (ws.read_results(tmp_path / "run").q == run.q).all()
