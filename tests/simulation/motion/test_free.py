"""Is the motion between contacts exact: with and without springs, from no damping to strong damping?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import oscillator
from reference.oscillator import Oscillator

from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Damping, Spring, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.motion.free_motion import acceleration_bound, flow
from watchsim.simulation.record.trajectory import EventKind
from watchsim.simulation.simulate import simulate

_flow, _bound = callable_kernel(flow), callable_kernel(acceleration_bound)


def exact(o: Oscillator, q0: float, u0: float, t: float) -> tuple[float, float]:
    """The linear equation solved with 60 digits by the matrix exponential."""
    with mp.workdps(60):
        k, c, m = mpf(o.stiffness), mpf(o.viscous), mpf(o.inertia)
        push = (mpf(o.torque) + k * mpf(o.rest)) / m
        system = mp.matrix([[0, 1, 0], [-k / m, -c / m, push], [0, 0, 0]])
        q, u, _ = mp.expm(system * mpf(t), method="taylor") * mp.matrix([mpf(q0), mpf(u0), 1])
        return float(q), float(u)


def scene_of(o: Oscillator, q0: float, u0: float) -> Scene:
    return Scene(
        "free",
        (Body("rotor", "pivot", angle=q0, velocity=(u0,), inertia=o.inertia),),
        springs=(Spring("rotor", o.stiffness, o.rest),) if o.stiffness else (),
        torques=(Torque("rotor", o.torque),),
        damping=(Damping("rotor", o.viscous),),
    )


CASES = {
    "undamped": Oscillator(2.0, 50.0, 0.0, 3.0, 0.2),
    "underdamped": Oscillator(2.0, 50.0, 1.5, 3.0, 0.2),
    "hardly damped": Oscillator(2.0, 50.0, 1e-9),
    "nearly critical": Oscillator(2.0, 50.0, 20.0 * (1.0 - 1e-9), -4.0),
    "critical": Oscillator(2.0, 50.0, 20.0, -4.0),
    "just beyond critical": Oscillator(2.0, 50.0, 20.0 * (1.0 + 1e-9), -4.0),
    "overdamped": Oscillator(2.0, 50.0, 31.0, 3.0, 0.2),
    "strongly overdamped": Oscillator(2.0, 50.0, 900.0, 3.0, 0.2),
    "no spring": Oscillator(2.0, 0.0, 1.5, 3.0),
    "no spring, tiny damping": Oscillator(2.0, 0.0, 1e-10, 3.0),
    "no spring, strong damping": Oscillator(2.0, 0.0, 500.0, 3.0),
    "nothing": Oscillator(2.0, 0.0),
    "watch balance": Oscillator(1.2e-9, 1.2e-9 * (8.0 * math.pi) ** 2, 1.2e-9 * 8.0 * math.pi / 250.0),
}


@pytest.mark.parametrize("name", CASES)
def test_one_flight(name: str) -> None:
    o = CASES[name]
    coordinate = compile_scene(scene_of(o, 0.7, -1.1)).model.coordinates[0]
    natural = math.sqrt(o.inertia / o.stiffness) if o.stiffness else 1.0
    for t in (1e-9, 1e-4, 0.03, 0.3, 1.5):
        assert _flow(coordinate, 0, 0.7, -1.1, t * natural) == pytest.approx(
            exact(o, 0.7, -1.1, t * natural), rel=1e-13, abs=3e-14
        )


@pytest.mark.parametrize("name", CASES)
def test_acceleration_never_exceeds_its_bound(name: str) -> None:
    """What the search for contacts relies on."""
    o = CASES[name]
    coordinate = compile_scene(scene_of(o, 0.7, -1.1)).model.coordinates[0]
    for q0, u0 in ((0.7, -1.1), (0.0, 9.0), (-3.0, 0.0), (0.26, 0.001)):
        bound = _bound(coordinate, 0, q0, u0)
        for t in np.linspace(0.0, 3.0, 60):
            q, u = _flow(coordinate, 0, q0, u0, t)
            a = (o.torque - o.viscous * u - o.stiffness * (q - o.rest)) / o.inertia
            assert abs(a) <= bound * (1.0 + 1e-12) + 1e-12


@pytest.mark.parametrize("name", CASES)
def test_a_whole_run(name: str) -> None:
    """Many flights in a row, sampled between the rows as well."""
    o = CASES[name]
    done = simulate(scene_of(o, 0.7, -1.1), 2.0)
    for t in (0.0137, 0.5, 1.234, 2.0):
        truth = exact(o, 0.7, -1.1, t) if o.stiffness < 1e-3 else oscillator.motion(o, 0.7, -1.1, t)
        if name.startswith("strongly"):
            truth = exact(o, 0.7, -1.1, t)
        q, u = done.at(t)
        speed = 1.0 + math.sqrt(o.stiffness / o.inertia)
        row = float(np.min(np.abs(done.t - t))) == 0.0
        # Where the way between two rows says no more than the positions' own error, the cubic is off by as much: that error,
        # half a tolerance, times 30/16 over the distance of rows, 0.1 of the coordinate's own time.
        between = 10.0 * done.tolerance
        assert (q[0], u[0]) == pytest.approx(truth, abs=(1e-12 if row else between) * speed)
    at_start = 0.5 * (o.inertia * 1.1**2 + o.stiffness * (0.7 - o.rest) ** 2)
    assert abs(done.energy["residual_J"]) <= 1e-12 * (at_start + abs(done.energy["in_J"]))


def test_turning_points_and_passages() -> None:
    """A balance: every turn and every passage of the rest position, at the times and places of the closed form."""
    o = CASES["watch balance"]
    done = simulate(scene_of(o, 4.7, 0.0), 1.0)
    decay = 0.5 * o.viscous / o.inertia
    w = math.sqrt(o.stiffness / o.inertia - decay**2)
    turns = [event for event in done.events if event["kind"] == EventKind.TURN]
    crossings = [event for event in done.events if event["kind"] == EventKind.CROSS]
    assert [event["t"] for event in turns] == pytest.approx([k * math.pi / w for k in range(1, 8)], abs=1e-13)
    swings = [4.7 * (-1.0) ** k * math.exp(-decay * k * math.pi / w) for k in range(1, 8)]
    assert [event["value"] for event in turns] == pytest.approx(swings, rel=1e-12)
    first = (math.pi - math.atan2(w, decay)) / w
    assert [event["t"] for event in crossings] == pytest.approx([first + k * math.pi / w for k in range(8)], abs=1e-13)
