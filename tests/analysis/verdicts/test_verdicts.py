"""Is a watch that fails told from one that ticks, and is it said how it fails?"""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from analysis.made_beats import lever_run
from analysis.made_faults import chipped, knocked, renamed, swiss, toothless, turned_over, unguarded
from every_time import few

from watchsim.analysis.timing.beats import Beats, beats
from watchsim.analysis.verdicts.backwards import _against_teeth
from watchsim.analysis.verdicts.equilibrium.in_force import in_force
from watchsim.analysis.verdicts.equilibrium.lever_arms import arms
from watchsim.analysis.verdicts.equilibrium.statics import at_lever
from watchsim.analysis.verdicts.faces import face
from watchsim.analysis.verdicts.knocking import _angles, knocks
from watchsim.analysis.verdicts.overbanking import overbanking
from watchsim.analysis.verdicts.tripping import tripping
from watchsim.analysis.verdicts.unlocked import _engaged, unlocked
from watchsim.analysis.verdicts.verdict import verdict
from watchsim.analysis.verdicts.verdict_kinds import Verdict
from watchsim.analysis.verdicts.watch import watch_of
from watchsim.profiles_path import profiles_dir
from watchsim.scene.body import Body
from watchsim.scene.file.load import load
from watchsim.scene.force import Damping, Spring, Torque
from watchsim.scene.roles import roles
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate

STRONG = "-10 µN·m"

# What fails, how long it takes to show, and what is said: name, body, words of the pair, drive (N·m), words of the message.
FAULTS = {
    "too strong": (
        *(swiss(torques_0_value=STRONG), 3.0, "knocks", "balance", ("PIN", "FORK"), 1e-5),
        ("strikes lever from outside at 338°", "gallops"),
    ),
    "reversed": (
        *(swiss(torques_0_value="1 µN·m"), 3.0, "backwards", "wheel", ("TEETH", "STONES"), 1e-6),
        ("against the lean of its teeth",),
    ),
    "shallow lock": (
        *(swiss(bodies_wheel_position_1="-0.04 mm"), 3.0, "trips", "wheel", ("TEETH", "STONES"), 1e-6),
        ("impulse face", "while balance is away"),
    ),
    "a tooth gone": (
        *(toothless(unguarded(swiss()), 7), 3.0, "trips", "wheel", ("TEETH", "STONES"), 1e-6),
        ("ran past lever",),
    ),
    "a locking chipped": (
        *(chipped(swiss(), 7, 1e-4), 6.0, "trips", "wheel", ("TEETH", "STONES"), 1e-6),
        ("tooth 8 rests on",),
    ),
    "no guard pin": (
        *(knocked(unguarded(swiss()), 2.05, -2e-6), 4.0, "overbanks", "lever", ("PIN", "FORK"), 1e-6),
        ("t = 2.05", "from outside at −21.8°", "guard pin"),
    ),
    "set on lock": (
        *(swiss(torques_0_value="-20 µN·m", bodies_balance_angle="-30°"), 2.0, "stops", "wheel", ("TEETH", "STONES"), 2e-5),
        ("tooth 6 rests on the entry locking face", "1.6 µN·m, is below the 4.3 µN·m needed to unlock"),
    ),
}
DRY = replace(swiss(contacts_0_friction="0.6"), damping=(*swiss().damping, Damping("balance", coulomb=5e-8)))
FAULTS["set on impulse"] = (
    *(DRY, 7.0, "stops", "wheel", ("TEETH", "STONES"), 1e-6),
    ("on the exit impulse face", "is below the 2 µN·m needed to move balance (set on impulse). Last amplitude 24.5°"),
)


def judged(scene: Scene, duration: float) -> Verdict:
    return verdict(simulate(scene, duration))


@pytest.mark.parametrize("fault", FAULTS)
def test_each_fault_is_recognised_and_named(fault):
    scene, duration, name, body, layers, drive, words = FAULTS[fault]
    found = judged(scene, duration)
    assert (found.name, found.body) == (name, body) and not found.works
    assert all(layer in found.pair for layer in layers) and abs(found.torque) == pytest.approx(drive)
    assert 0.0 <= found.t <= duration
    assert all(part in found.message for part in words), found.message


@pytest.mark.parametrize("fault", few(FAULTS, 4))
def test_in_a_mirror_and_under_other_names_it_is_the_same_fault(fault):
    scene, duration, name, body, _, drive, _ = FAULTS[fault]
    found = judged(renamed(turned_over(scene)), duration)
    assert (found.name, found.body) == (name, {"wheel": "rad", "lever": "anker", "balance": "unruh"}[body])
    assert abs(found.torque) == pytest.approx(drive) and "anker" in found.message


def test_a_balance_at_rest_beside_the_fork_is_named():
    """Its spring holds it at 90°, where its pin is far from the fork."""
    scene = swiss(springs_0_rest="90°", bodies_balance_angle="90°", bodies_balance_velocity="0 °/s")
    found = judged(scene, 3.0)
    assert found.name == "stops" and "rests on" in found.message
    assert "balance is at rest at 0° and does not touch lever" in found.message


def test_a_guard_pin_keeps_the_lever_from_going_over():
    """The same knock on the lever with the dart in place."""
    assert judged(knocked(swiss(), 2.05, -2e-6), 4.0).name == "unsettled"


def test_the_first_strike_from_outside_shows_that_it_overbanks():
    """Before it the same half swing saw the pin inside the fork, with the lever on its way to the banking."""
    run = simulate(knocked(unguarded(swiss()), 2.05, -2e-6), 4.0)
    struck = replace(run, events=run.events[run.events["t"] < 2.1])
    found = overbanking(watch_of(struck, beats(run)))
    assert found is not None and found.t == pytest.approx(2.05, abs=1e-3) and "outside at −21.8°" in found.message
    before = replace(run, events=run.events[run.events["t"] < 2.05])
    assert overbanking(watch_of(before, beats(run))) is None


@pytest.mark.parametrize("way", [0.0, 40.0, 90.0, 200.0, 270.0])
@pytest.mark.parametrize(("slope", "engaged"), [(2.0, False), (-2.0, False), (4.0, True), (-4.0, True), (90.0, True)])
def test_a_pin_in_the_fork_has_an_arm_a_dart_on_its_roller_has_none(way, slope, engaged):
    """The arm about the staff of a force that leans from the radius by an angle is the radius times its sine, wherever."""
    staff, radius = np.array([3e-3, -2e-3]), 0.5e-3
    out = np.array([math.cos(math.radians(way)), math.sin(math.radians(way))])
    arm = radius * math.sin(math.radians(slope))
    told = SimpleNamespace(
        places={"balance": (*staff, 1.0)},
        point=np.array([(7.0, 7.0), staff + radius * out]),
        of=lambda row, body: (arm, 9.0) if (row, body) == (1, "balance") else (9.0, 9.0),
    )
    assert _engaged(SimpleNamespace(oscillator="balance"), told, 1) == engaged


def test_a_watch_that_ticks_and_one_that_will():
    run = simulate(swiss(), 40.0)
    early = simulate(swiss(), 3.0)
    assert verdict(run).name == "ticks" and verdict(run).message == "the watch ticks"
    told = verdict(early)
    assert told.name == "unsettled" and told.works and "on its way to about 279°" in told.message
    assert beats(run).amplitude_deg[-1] == pytest.approx(279.2, abs=0.3)
    assert "too few" in judged(swiss(), 0.5).message


def test_knocks_of_the_past_are_mentioned_not_judged():
    """Started too far, a light drive: it knocks until its swing has died down."""
    scene = swiss(torques_0_value="-0.5 µN·m", bodies_balance_velocity="-7000 °/s")
    found = judged(scene.set("damping.0.q_factor", 60.0), 20.0)
    assert found.name == "ticks" and "after it knocked until t = " in found.message


def test_the_angle_of_a_knock_is_that_of_the_balance_then():
    run = simulate(swiss(torques_0_value=STRONG), 3.0)
    watch = watch_of(run, beats(run))
    times = knocks(watch)["t"]
    true = run.sample(times)[0][:, run.slices["balance"].start]
    assert len(times) > 10 and np.degrees(np.abs(_angles(watch, times) - true)).max() < 15.0
    assert np.degrees(np.abs(true)).min() > 330.0


def test_angles_are_those_from_rest_wherever_that_is():
    """Half swings of 2 s that are true sines of 3 rad about 0.4 rad."""
    passages = np.array([1.0, 3.0, 5.0])
    ends = 0.4 + 3.0 * np.array([-1.0, 1.0, -1.0, 1.0])
    found = Beats("balance", True, 4.0, passages, passages - 1.0, passages + 1.0, ends[:-1], ends[1:], passages, passages)
    times = np.linspace(0.1, 5.9, 30)
    got = _angles(SimpleNamespace(found=found, rest=0.4), times)
    assert got == pytest.approx(-3.0 * np.cos(0.5 * math.pi * times), abs=1e-12)


@pytest.mark.parametrize("share", [0.995, 1.005])
def test_the_torque_needed_to_unlock_is_where_it_unlocks(share):
    """From rest on the lock, the simulation moves the lever just below the drive at which statics says that the torques are
    equal, and leaves it alone just above."""
    held = simulate(swiss(torques_0_value="-20 µN·m", bodies_balance_angle="-30°"), 2.0)
    watch = watch_of(held, beats(held))
    sides = {number: {held.pairs[number].body_a, held.pairs[number].body_b} for number in in_force(held, [2.0])[0]}
    tooth, pin = (next(k for k, both in sides.items() if both == {other, "lever"}) for other in ("wheel", "balance"))
    found = arms(held, watch.compiled, 2.0, [tooth, pin])
    out = face(watch, found, 0).out
    given, needed = at_lever(found, 1, "balance", "lever", out), at_lever(found, 0, "wheel", "lever", out)
    assert given == pytest.approx(1.60e-6, rel=0.01) and needed == pytest.approx(-4.28e-6, rel=0.01)
    equal = 20.0 * given / -needed
    angles = {body: f"{float(held.end[0][held.slices[body].start])!r} rad" for body in ("wheel", "lever", "balance")}
    start = {f"bodies_{body}_angle": angle for body, angle in angles.items()}
    run = simulate(swiss(torques_0_value=f"{-share * equal} µN·m", **start), 0.05)
    lever = np.degrees(run.q[:, run.slices["lever"].start])
    assert (abs(lever - lever[0]).max() > 0.001) == (share < 1.0)


def test_without_rows_events_alone_say_that_it_knocks():
    run = simulate(swiss(torques_0_value=STRONG), 5.0, record="statistics")
    assert verdict(run).name == "knocks"


def test_the_last_rows_that_were_kept_say_that_nothing_locks():
    scene = swiss(bodies_wheel_position_1="-0.04 mm")
    assert verdict(simulate(scene, 4.0, record=[(1.0, 1.5)])).name == "trips"


def test_a_lever_without_banking_need_not_lock():
    run = simulate(swiss(bodies_wheel_position_1="-0.04 mm"), 3.0)
    free = replace(run.scene, contacts=tuple(one for one in run.scene.contacts if all(s.body != "banking" for s in one.sides)))
    watch = watch_of(replace(run, scene=free), beats(run))
    assert unlocked(watch_of(run, beats(run))) and not unlocked(watch)


def test_a_reversed_wheel_that_nothing_holds_runs_through():
    bench = load(profiles_dir() / "bench_lever").set("torques.0.value", "1 µN·m")
    run = simulate(bench, 2.0)
    found = verdict(run)
    assert found.name == "backwards" and "wheel runs through, " in found.message
    # Teeth without a lean have no wrong way: then it is a lever that stops nothing.
    upright = watch_of(run, beats(run))
    upright.__dict__["teeth"] = None
    assert _against_teeth(upright) is None and "nothing locks it" in tripping(upright).message


def test_a_wheel_that_the_balance_drives_back_runs_backwards():
    """A drive of next to nothing, a lever that pushes: made by hand, since real wheels are held by their lever."""
    run = lever_run(40)
    back = replace(run, q=run.q * np.array([1.0, 1.0, -1.0]))
    found = verdict(back)
    assert found.name == "backwards" and "against its drive of 1 µN·m" in found.message


def test_the_wheel_is_the_body_whose_lever_meets_the_balance():
    """Whatever torque is listed first."""
    shaken = knocked(swiss(), 2.05, -2e-6)
    assert roles(replace(shaken, torques=shaken.torques[::-1])) == roles(swiss())


def test_made_runs_have_no_shapes_to_ask():
    assert verdict(lever_run(40)).name == "ticks"
    stands = verdict(lever_run(20, missed=range(10, 20)))
    assert stands.name == "stops" and "the escape wheel has stood still since t = 1.19" in stands.message


def pendulum() -> Scene:
    bob = Body("bob", angle=0.1, mass=1.0, inertia=1.0, centre_of_mass=(0.0, -1.0))
    return Scene("pendulum", (bob,), gravity=(0.0, -9.81))


def driven_spring() -> Scene:
    """A motor beside a flywheel on a spring: nothing lies between them."""
    bodies = (Body("motor", inertia=1e-9), Body("fly", inertia=1e-9, angle=1.0))
    return Scene("no escapement", bodies, (Spring("fly", 1e-6),), (Torque("motor", 1e-9),))


@pytest.mark.parametrize(
    "scene", [load(profiles_dir() / "balance"), load(profiles_dir() / "incline"), pendulum(), driven_spring()]
)
def test_what_is_no_watch_has_no_verdict(scene):
    found = judged(scene, 1.0)
    assert found.name is None and found.message is None and found.works


@pytest.mark.parametrize("profile", ["bench_lever", "carriage"])
def test_other_watches_tick(profile):
    assert judged(replace(load(profiles_dir() / profile), expect=()), 6.0).works
