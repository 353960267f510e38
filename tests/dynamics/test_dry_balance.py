"""Does dry friction in a bearing hold and let go where a torque over time says so?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from reference.dry_balance import angles

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc
from watchsim.scene.body import Body
from watchsim.scene.force import Damping, Spring, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

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
