"""Does dry friction in a bearing hold, break loose and take energy as Coulomb's law says?"""

import dataclasses
import math

import numpy as np
import pytest
from every_time import few
from moving_scenes import circle, ground, profile, tip, touching
from mpmath import mp, mpf
from reference.dry_balance import angles

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.forces import Contact, Damping, Side, Spring, Torque
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.step_path import turning_time

# Does dry friction in a bearing hold, break loose and take energy as Coulomb's law says, in flight and with contacts?

_turning_time = callable_kernel(turning_time)


def rotor(inertia: float = 2.0, stiffness: float = 50.0, viscous: float = 0.0, torque: float = 0.0, **start: float) -> Scene:
    """A sprung rotor with 3 N·m of dry friction."""
    body = Body("rotor", "pivot", angle=start.get("angle", 0.0), velocity=(start.get("rate", 0.0),), inertia=inertia)
    springs = (Spring("rotor", stiffness),) if stiffness else ()
    return Scene(
        "rotor",
        (body,),
        springs=springs,
        torques=(Torque("rotor", torque),),
        damping=(Damping("rotor", viscous, 0.0, 3.0),),
        duration=start.get("duration", 5.0),
    )


@pytest.mark.parametrize("viscous", [0.0, 1.5, 20.0, 31.0, 300.0])
@pytest.mark.parametrize("stiffness", few([50.0, 0.0], 1))
def test_the_turning_time_is_where_the_velocity_vanishes(stiffness: float, viscous: float) -> None:
    """Against the matrix exponential with 50 digits: zero there, and of one sign before."""
    coordinate = compile_scene(rotor(stiffness=stiffness, viscous=viscous)).model.coordinates[0]
    found = 0
    for q, u in ((1.0, 2.0), (-1.0, 2.0), (0.3, -5.0), (2.0, -0.1)):
        grip = int(math.copysign(1.0, u))
        turn = _turning_time(coordinate, grip, q, u)
        with mp.workdps(50):
            k, c, m, push = mpf(stiffness) / 2, mpf(viscous) / 2, 2, mpf(-3.0 * grip) / 2
            system = mp.matrix([[0, 1, 0], [-k, -c, push], [0, 0, 0]])
            speed = [float((mp.expm(system * mpf(t), method="taylor") * mp.matrix([q, u, 1]))[1]) for t in _samples(turn)]
        assert m == 2
        assert np.all(np.array(speed[:-1]) * grip > 0.0)
        if turn < math.inf:
            found += 1
            assert abs(speed[-1]) < 1e-13 * abs(u)
    assert found > 0


def _samples(turn: float) -> np.ndarray:
    return np.linspace(0.0, turn if turn < math.inf else 3.0, 12)


def test_it_stays_inside_the_dead_zone_and_moves_outside_it() -> None:
    """3 N·m hold against 50 N·m/rad up to 0.06 rad."""
    inside, outside = (simulate(rotor(angle=angle)) for angle in (0.0599, 0.0601))
    assert np.all(inside.q == 0.0599)
    assert np.all(inside.u == 0.0)
    assert np.abs(outside.u).max() > 0.0
    assert outside.q[-1, 0] == pytest.approx(0.12 - 0.0601, rel=1e-12)


def test_viscous_and_dry_friction_together_against_a_sum_of_half_swings() -> None:
    """Each half swing decays about its own middle: x -> -(x - s) e^(-d T/2) + s with s = T/k towards the side it comes from."""
    run = simulate(rotor(viscous=1.0, angle=2.0, duration=20.0))
    decay, shift = 0.5 * 1.0 / 2.0, 3.0 / 50.0
    half = math.pi / math.sqrt(50.0 / 2.0 - decay**2)
    x, turns = 2.0, []
    while abs(x) > shift:
        middle = math.copysign(shift, x)
        x = middle - (x - middle) * math.exp(-decay * half)
        turns.append(x)
    events = run.events[run.events["kind"] == EventKind.TURN]
    assert len(turns) - 1 == len(events)
    assert events["value"] == pytest.approx(turns[:-1], abs=1e-12)
    assert events["t"] == pytest.approx(half * np.arange(1, len(turns)), rel=1e-13, abs=0.0)
    assert run.q[-1, 0] == pytest.approx(turns[-1], abs=1e-12)
    assert run.u[-1, 0] == 0.0
    assert run.energy["residual_relative"] < 1e-12


def test_a_rotor_without_spring_runs_out() -> None:
    """w/a after the start, after w²/(2a), and never again."""
    run = simulate(rotor(stiffness=0.0, rate=4.0))
    assert run.q[-1, 0] == pytest.approx(0.5 * 4.0**2 / 1.5, rel=1e-13)
    assert run.u[-1, 0] == 0.0
    assert run.energy["dissipated"]["damping"] == pytest.approx(0.5 * 2.0 * 4.0**2, rel=1e-13)


def test_a_drive_below_the_friction_moves_nothing_and_one_above_does() -> None:
    weak, strong = (simulate(rotor(stiffness=0.0, torque=torque, duration=1.0)) for torque in (2.999, 3.5))
    assert np.all(weak.q == 0.0)
    assert strong.q[-1, 0] == pytest.approx(0.5 * 0.5 / 2.0, rel=1e-12)


def driven(torque: float) -> Scene:
    """A wheel presses the arm of a rotor with dry friction against nothing but that friction."""
    wheel = Body("wheel", inertia=1.0, loops=(tip(0.1),))
    arm = Body("arm", position=(0.0, 0.3), inertia=2.0, loops=(circle(0.05, (0.095, -0.245)),))
    return Scene(
        "driven",
        (wheel, arm),
        torques=(Torque("wheel", torque),),
        damping=(Damping("arm", coulomb=1.0),),
        contacts=touching("wheel", "arm"),
        duration=3.0,
    )


def test_a_held_arm_stops_what_runs_into_it_unless_pushed_too_hard() -> None:
    """An impact is stronger than any friction: the arm is knocked on, then its friction stops both."""
    run = simulate(driven(0.05))
    assert run.stop == Stop.DURATION
    assert np.any(run.events["kind"] == EventKind.IMPACT)
    assert run.u[-1] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert run.energy["dissipated"]["damping"] > 0.0
    hard = simulate(driven(5.0))
    assert abs(hard.q[-1, 1] - hard.q[0, 1]) > 1e-3
    assert hard.energy["residual_relative"] < 1e-8


def test_a_slider_with_dry_friction_is_pushed_at_the_right_force() -> None:
    """A free disc leans on a slider with twice its own mass's pull together: below the friction both stay."""
    slider = Body("slider", "slide", (0.0, 0.0), mass=1.0, loops=(circle(0.02, (0.0, 0.02)),))
    ball = Body("ball", "free", (-0.04, 0.02), mass=1.0, inertia=2e-4, loops=(circle(0.02),))
    contacts = (Contact((Side("slider"), Side("ball"))), Contact((Side("ball"), Side("ground"))))
    for friction, way in ((2.1, 0.0), (1.9, 0.5 * 0.05)):
        scene = Scene(
            "push",
            (slider, ball, ground()),
            damping=(Damping("slider", coulomb=friction),),
            contacts=contacts,
            gravity=(1.0, -9.81),
            duration=1.0,
        )
        run = simulate(scene)
        assert run.q[-1, 0] == pytest.approx(way, abs=1e-12)


def test_a_watch_with_dry_bearings_keeps_its_ledger() -> None:
    """A hundredth of the wheel's torque at every pivot: more is taken than without, and the account still closes."""
    scene = profile("bench_lever")
    dry = tuple(Damping(body.name, coulomb=2e-9) for body in scene.bodies if body.motion == "pivot")
    run = simulate(dataclasses.replace(scene, damping=(*scene.damping, *dry)), 1.0)
    plain = simulate(scene, 1.0)
    assert run.stop == Stop.DURATION
    assert run.energy["residual_relative"] < 1e-8
    assert run.energy["dissipated"]["damping"] > plain.energy["dissipated"]["damping"]
    assert run.counts["lcp_failures"] == 0


def test_a_turn_at_the_very_end_of_a_flight_is_a_turn() -> None:
    """Flights last a quarter period, half swings two of them: rounding decides in which flight the turn lies.

    The first one is a lever of the hunt, which went on against its friction for half a swing.
    """
    rng, rest = np.random.default_rng(401), 2.695
    for n in range(40):
        share = 1.0 + (0.1 * rng.uniform(-1.0, 1.0) if n else 0.0)
        stiffness, torque, dry, inertia = 0.04419 * share, -1.179e-4, 1.32e-5 * share, 1.597e-6
        half = math.pi * math.sqrt(inertia / stiffness)
        body = Body("lever", "pivot", angle=rest, velocity=(-17.41,), inertia=inertia)
        forces = {"torques": (Torque("lever", torque),), "damping": (Damping("lever", 0.0, 0.0, dry),)}
        run = simulate(Scene("lever", (body,), springs=(Spring("lever", stiffness, rest),), **forces, duration=10.0 * half))
        middle, push = rest + torque / stiffness, dry / stiffness
        first = np.hypot(rest - (middle + push), 17.41 * math.sqrt(inertia / stiffness)) - push
        turns = run.events[run.events["kind"] == EventKind.TURN]["value"]
        # Each half swing falls short of the last one by what the friction stretches the spring on either side.
        amplitudes = first - 2.0 * push * np.arange(len(turns))
        assert len(turns) == 10
        assert np.abs(turns - middle) == pytest.approx(amplitudes, abs=1e-9)
        assert run.energy["residual_relative"] < 1e-9


# Does dry friction in a bearing hold and let go where a torque over time says so?

INERTIA, DRY = 1.2e-9, 1e-7  # kg·m², N·m: a balance whose oil has dried
DURATION = 3.0


def torque_over_time(rng: np.random.Generator) -> tuple[tuple[float, float], ...]:
    """A sine about as strong as the friction, drawn with 20 to 600 knots, or knots at random."""
    strength = DRY * float(rng.choice([1.0 - 1e-9, 1.0, 1.0 + 1e-9, 10.0 ** rng.uniform(-0.5, 1.0)]))
    t = np.linspace(0.0, DURATION, int(rng.choice([20, 100, 600])))
    sine = np.sin(2.0 * math.pi * 10.0 ** rng.uniform(-0.5, 1.5) * t)
    values = strength * (sine if rng.random() < 0.6 else rng.uniform(-1.0, 1.0, len(t)))
    return tuple(zip(t.tolist(), values.tolist(), strict=True))


@pytest.mark.parametrize("number", range(24))
def test_a_bearing_holds_and_lets_go(number: int) -> None:
    rng = np.random.default_rng([11, number])
    stiffness = INERTIA * (2.0 * math.pi * float(rng.choice([2.5, 3.0, 4.0]))) ** 2
    start = float(rng.uniform(-1.5, 1.5)), float(rng.choice([0.0, rng.uniform(-60.0, 60.0)]))
    table, circle = torque_over_time(rng), Loop((Arc(0.0, 0.0, 5e-3, 0.0, 2.0 * math.pi),))
    scene = Scene(
        "dry balance",
        (Body("balance", "pivot", (0.0, 0.0), start[0], (start[1],), inertia=INERTIA, loops=(circle,)),),
        springs=(Spring("balance", stiffness),),
        damping=(Damping("balance", coulomb=DRY),),
        torques=(Torque("balance", over="time", table=table),),
        duration=DURATION,
    )
    times = np.linspace(0.0, DURATION, 301)
    truth = angles(INERTIA, stiffness, DRY, table, start, times)
    for tolerance in (1e-9, 1e-7):
        run = simulate(scene, tolerance=tolerance)
        assert run.stop == Stop.DURATION
        assert np.abs(run.sample(times)[0][:, 0] - truth).max() < 100.0 * tolerance
