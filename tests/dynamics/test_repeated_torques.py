"""Does a torque over time that repeats act, at any time, as the table says, and when is its next knot?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics.applied_forces import forces, next_knot
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


TIMES = {"over time": (0.5, 1.25, 2.0, 4.0), "repeated": (-0.25, 0.75, 1.0, 2.75), "over an angle": (0.1, 0.2, 0.3)}


def following(t: float, *names: str) -> float:
    """The first knot of these tables after t, by looking through three hundred periods of each."""
    knots = [TIMES[name] for name in names if name == "over time"]
    knots += [tuple(one + 3.0 * k for one in TIMES["repeated"]) for k in range(-3, 300) if "repeated" in names]
    return min((knot for some in knots for knot in some if knot > t * (1.0 + 2e-15)), default=math.inf)


@pytest.mark.parametrize("names", [("over time",), ("repeated",), ("over an angle", "repeated"), ("repeated", "over time")])
def test_the_next_knot_is_the_first_one_after_now(names: tuple[str, ...]) -> None:
    """Also at knots, which have been passed, to rounding; of a repeated table in any of its periods."""
    over = {"over time": "time", "repeated": "time", "over an angle": "angle"}
    torques = tuple(
        Torque("wheel", over=over[name], table=tuple((t, 0.0) for t in TIMES[name]), period=3.0 if name == "repeated" else None)
        for name in names
    )
    model = compile_scene(Scene("knots", (Body("wheel", inertia=1.0),), torques=torques)).model
    after = in_python(next_knot)
    times = [
        *np.linspace(0.0, 9.0, 37),
        *(1e2 + np.linspace(0.0, 3.0, 25)),
        *(TIMES["repeated"][1] + 3.0 * np.arange(0, 200, 7)),
    ]
    for t in times:
        for now in (t, float(np.nextafter(t, 0.0)), float(np.nextafter(t, 1e9))):
            assert after(model, now) == pytest.approx(following(now, *names), rel=1e-14)
