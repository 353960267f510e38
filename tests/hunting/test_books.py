"""Does the judge's bookkeeping see what is wrong with a run, and nothing where all is right?

The runs are true ones, falsified here by hand.
"""

from __future__ import annotations

import math
from dataclasses import replace

import hunt_path
import numpy as np
import pytest
from hunt.books import faults, potential, pulls
from hunt.generator.material import Material
from hunt.generator.parts import GRAVITY, fixed, free, pivoted, sliding
from hunt.generator.shapes import box, circle

from watchsim.scene.file.load import load
from watchsim.scene.force import Contact, Side, Spring
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop


def two_discs() -> Scene:
    bodies = (
        sliding("a", circle(5e-3), (0.0, 0.0), 0.0, 0.5, 0.02),
        sliding("b", circle(5e-3), (20e-3, 1e-3), 0.0, 0.0, 0.03),
    )
    return Scene("discs", bodies, (Spring("b", 20.0),), contacts=(Contact((Side("a"), Side("b")), 0.0, 0.7),), duration=0.04)


def falling_block() -> Scene:
    floor = fixed("floor", box(0.1, 0.01, (0.0, -0.005)))
    block = free("block", box(0.01, 0.01), (0.0, 0.02), 0.05, 0.3, (0.1, 0.0, 3.0))
    return Scene(
        "block", (floor, block), contacts=(Contact((Side("floor"), Side("block")), 0.4, 0.3),), gravity=GRAVITY, duration=0.15
    )


def pendulum() -> Scene:
    hung = pivoted("p", box(0.02, 0.02, (0.0, -0.1)), (0.0, 0.0), 0.5, mass=0.1)
    stop = fixed("stop", box(0.02, 0.02, (-0.021, -0.1)))
    return Scene(
        "pendulum", (hung, stop), contacts=(Contact((Side("p"), Side("stop")), 0.2, 0.9),), gravity=GRAVITY, duration=0.5
    )


@pytest.mark.parametrize("make", [two_discs, falling_block, pendulum])
def test_nothing_wrong(make):
    scene = make()
    run = simulate(scene)
    assert (run.events["energy_lost"] > 0.0).any()
    assert list(faults(run, Material(scene))) == []


def classes(run):
    return {fault.split(":")[0] for fault in faults(run, Material(run.scene))}


def last_impact(run):
    """The rows before and after the last jump of velocity."""
    row = int(np.flatnonzero(np.diff(run.t) == 0.0)[-1])
    return row, row + 1


def test_dead_stop_at_an_impact():
    """All motion set to zero where bodies touch takes energy, as impacts may, but no pushing impulse does it."""
    run = simulate(two_discs())
    row, _ = last_impact(run)
    u = run.u.copy()
    u[row + 1 :] = 0.0
    assert "impulse" in classes(replace(run, u=u))


def test_stop_without_an_event():
    run = simulate(two_discs())
    row, _ = last_impact(run)
    gone = run.events[run.events["t"] != run.t[row]]
    assert "jump" in classes(replace(run, events=gone))


def test_energy_from_nowhere():
    run = simulate(pendulum())
    row, _ = last_impact(run)
    u = run.u.copy()
    u[row + 1 :] *= 1.5
    assert "energy" in classes(replace(run, u=u))


def test_ledger_that_does_not_close():
    run = simulate(pendulum())
    assert "residual" in classes(replace(run, energy={**run.energy, "residual_J": 1e-3}))


def test_material_in_material():
    run = simulate(falling_block())
    q = run.q.copy()
    q[:, 1] -= 1e-5
    assert "overlap" in classes(replace(run, q=q))


def test_bodies_that_are_moved():
    run = simulate(falling_block())
    row, _ = last_impact(run)
    q = run.q.copy()
    q[row + 1 :, 0] += 1e-7
    assert "shift" in classes(replace(run, q=q))


def test_giving_up():
    assert "gave up" in classes(replace(simulate(pendulum()), stop=Stop.TOO_MANY_EVENTS))


def test_energy_of_a_pendulum_is_that_of_its_fall():
    """From rest at 0.5 rad to the bottom: J ω²/2 = m g l (1 - cos 0.5)."""
    scene = pendulum()
    scene = replace(scene, bodies=scene.bodies[:1], contacts=())
    run = simulate(scene)
    inertia = 0.1 * (0.1**2 + (0.02**2 + 0.02**2) / 12.0)
    fastest = np.abs(run.sample(np.linspace(0.0, 0.5, 20001))[1]).max()
    assert math.isclose(0.5 * inertia * fastest**2, 0.1 * 9.81 * 0.1 * (1.0 - math.cos(0.5)), rel_tol=1e-6)
    assert list(faults(run, Material(scene))) == []


@pytest.mark.parametrize("make", [two_discs, falling_block, pendulum])
def test_pulls_are_the_slope_of_the_potential(make):
    scene = make()
    run = simulate(scene)
    row, step = len(run.t) // 2, 1e-6
    for k in range(run.q.shape[1]):
        q = np.repeat(run.q[:1], 2, axis=0)
        q[:] = run.q[row]
        q[0, k] -= step
        q[1, k] += step
        low, high = potential(scene, replace(run, q=q, t=run.t[:2]))
        assert pulls(scene, run, row)[k] == pytest.approx((low - high) / (2.0 * step), rel=1e-6, abs=1e-9)


def test_dead_stop_at_the_end_of_impacts():
    """What the contact forces do until then explains a small jump, never a fast body's stop."""
    run = simulate(load(hunt_path.ROOT / "tests" / "data" / "hunt" / "blocks-801-570.toml"))
    assert "impulse" not in classes(run)
    ended = run.events[run.events["kind"] == EventKind.ACCUMULATION]
    (row,) = np.flatnonzero((run.t[:-1] == ended["t"][0]) & (np.diff(run.t) == 0.0))
    u = run.u.copy()
    u[: row + 1] *= 10.0
    assert "impulse" in classes(replace(run, u=u))
