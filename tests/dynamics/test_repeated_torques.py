"""Does a torque over time that repeats act, at any time, as the table says?"""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.dynamics.applied_forces import forces
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Torque
from watchsim.scene.scene import Scene

_forces = callable_kernel(forces)


@pytest.mark.parametrize("begins", [0.0, 0.4, -1.3])
def test_the_value_is_that_of_the_first_period(begins: float) -> None:
    """Against numpy's interpolation of the table written out nine times over; knots and times before it, too."""
    rng = np.random.default_rng(4)
    at = begins + np.append(np.cumsum(rng.uniform(0.1, 0.5, 6)) - 0.1, [])
    values = rng.uniform(-1.0, 1.0, 6)
    values[-1] = values[0]
    period = float(at[-1] - at[0])
    table = tuple(zip(at.tolist(), values.tolist(), strict=True))
    torque = Torque("wheel", over="time", table=table, period=period)
    model = compile_scene(Scene("repeated", (Body("wheel", inertia=1.0),), torques=(torque,))).model
    long = np.concatenate([at[:-1] + k * period for k in range(-4, 5)])
    told = np.tile(values[:-1], 9)
    for t in (*rng.uniform(at[0] - 2.0 * period, at[0] + 4.0 * period, 40), *(at[2] + period * np.arange(-1, 3))):
        h = np.zeros(1)
        _forces(model, float(t), np.zeros(1), np.zeros(1), h)
        assert h[0] == pytest.approx(np.interp(t, long, told), abs=1e-12)
