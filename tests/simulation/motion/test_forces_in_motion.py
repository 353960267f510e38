"""Do torque tables, quadratic damping, and gravity on an excentric rotor move a body as scipy says?"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from moving_scenes import circle, of_kind, tip, touching
from reference import pendulum
from scipy.integrate import solve_ivp

from watchsim.scene.body import Body
from watchsim.scene.force import Damping, Spring, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import EventKind
from watchsim.simulation.simulate import simulate

J = 0.4
ANGLES = ((-1.0, 0.5), (0.0, -1.0), (0.7, 2.0), (3.0, -2.5))
TIMES = ((0.2, 1.0), (0.9, -2.0), (1.6, 0.5))


def truth(force: Callable[[float, float, float], float], start: tuple[float, float], t: float) -> np.ndarray:
    """Integrated in many pieces, so that no kink of a table is stepped over."""
    y = np.array(start)
    for a, b in zip(np.linspace(0.0, t, 401)[:-1], np.linspace(0.0, t, 401)[1:], strict=True):
        y = solve_ivp(lambda s, z: (z[1], force(s, *z) / J), (a, b), y, method="DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
    return y


def run(start: tuple[float, float], t: float, **forces):
    body = Body("rotor", "pivot", (0.0, 0.0), start[0], (start[1],), inertia=J)
    return simulate(Scene("rotor", (body,), **forces), t, 1e-11)


def table(points: tuple[tuple[float, float], ...], x: float) -> float:
    return float(np.interp(x, *zip(*points, strict=True)))


def test_table_over_angle() -> None:
    done = run((-1.4, 2.0), 2.0, torques=(Torque("rotor", over="angle", table=ANGLES),))
    expected = truth(lambda t, q, u: table(ANGLES, q), (-1.4, 2.0), 2.0)
    assert (done.q[-1][0], done.u[-1][0]) == pytest.approx(tuple(expected), abs=1e-8)
    assert done.energy["residual_relative"] < 1e-8


def test_table_over_time() -> None:
    done = run((0.3, 0.0), 2.0, torques=(Torque("rotor", over="time", table=TIMES),), springs=(Spring("rotor", 3.0, 0.1),))
    expected = truth(lambda t, q, u: table(TIMES, t) - 3.0 * (q - 0.1), (0.3, 0.0), 2.0)
    assert (done.q[-1][0], done.u[-1][0]) == pytest.approx(tuple(expected), abs=1e-8)
    assert done.energy["residual_relative"] < 1e-8


def test_a_short_pulse_is_not_stepped_over() -> None:
    """A rotor at rest gets one pulse of a millisecond in the middle of a long run."""
    pulse = ((0.0, 0.0), (7.3, 0.0), (7.3005, 100.0), (7.301, 0.0), (20.0, 0.0))
    done = run((0.0, 0.0), 10.0, torques=(Torque("rotor", over="time", table=pulse),))
    assert done.u[-1][0] == pytest.approx(0.05 / J, rel=1e-6)


def test_quadratic_damping() -> None:
    """Without anything else u = u0 / (1 + c u0 t / J), q its integral; both ways."""
    for u0 in (5.0, -5.0):
        done = run((0.0, u0), 3.0, damping=(Damping("rotor", 0.0, 0.7),))
        k = 0.7 * abs(u0) / J
        assert done.u[-1][0] == pytest.approx(u0 / (1.0 + 3.0 * k), rel=1e-9)
        assert done.q[-1][0] == pytest.approx(math.copysign(J / 0.7, u0) * math.log1p(3.0 * k), rel=1e-9)
        assert done.energy["dissipated"]["damping"] == pytest.approx(0.5 * J * (25.0 - done.u[-1][0] ** 2), rel=1e-9)


def test_all_kinds_of_damping_on_a_spring() -> None:
    done = run((1.0, 0.0), 3.0, damping=(Damping("rotor", 0.05, 0.1),), springs=(Spring("rotor", 9.0),))
    expected = truth(lambda t, q, u: -9.0 * q - 0.05 * u - 0.1 * u * abs(u), (1.0, 0.0), 3.0)
    assert (done.q[-1][0], done.u[-1][0]) == pytest.approx(tuple(expected), abs=1e-8)


def hanging(**more) -> Body:
    """A pendulum along -y at angle 0: its centre of mass lies 0.3 m below the pivot. w² = m g l / J = 9."""
    return Body("rotor", "pivot", (0.2, 0.1), mass=2.0, inertia=2.0 * 9.81 * 0.3 / 9.0, centre_of_mass=(0.0, -0.3), **more)


@pytest.mark.parametrize("amplitude", [0.1, 1.5, 3.0])
def test_gravity_pendulum(amplitude: float) -> None:
    done = simulate(Scene("pendulum", (hanging(angle=amplitude),), gravity=(0.0, -9.81)), 5.0, 1e-12)
    assert (done.q[-1][0], done.u[-1][0]) == pytest.approx(pendulum.swing(5.0, amplitude, 3.0), abs=1e-8)
    assert abs(done.energy["residual_J"]) < 1e-10


def test_gravity_from_another_side() -> None:
    """Gravity along +x: the pendulum swings about +90 degrees."""
    done = simulate(Scene("pendulum", (hanging(angle=0.5 * math.pi + 1.0),), gravity=(9.81, 0.0)), 3.0, 1e-12)
    angle, rate = pendulum.swing(3.0, 1.0, 3.0)
    assert (done.q[-1][0] - 0.5 * math.pi, done.u[-1][0]) == pytest.approx((angle, rate), abs=1e-8)


def test_pendulum_against_a_stop() -> None:
    """Elliptic functions between impacts at the lowest point."""
    loop = tip(0.5)
    # The thorn points along +x at angle 0; a thin post stands where its flank is when the pendulum hangs down.
    flank = math.atan2(0.1, 0.7)
    radius, arm = 0.01, 0.5 * math.hypot(0.7, 0.1)
    body = hanging(angle=1.2, loops=(loop,))
    x, y = arm * math.cos(-flank), arm * math.sin(-flank)
    # Corner (0.7, -0.1) of the thorn meets the post from above at angle 0, where the corner moves along the tangent.
    post = Body("post", "fixed", (0.2 + x + radius * y / arm, 0.1 + y - radius * x / arm), loops=(circle(radius),))
    scene = Scene("pendulum", (body, post), contacts=touching("rotor", "post", restitution=0.6), gravity=(0.0, -9.81))
    done = simulate(scene, 2.5, 1e-12)
    times = [t for t in pendulum.touches(6, 1.2, 3.0, 0.6) if t < 2.5]
    assert [event["t"] for event in of_kind(done, EventKind.IMPACT)] == pytest.approx(times, abs=1e-8)
    assert (done.q[-1][0], done.u[-1][0]) == pytest.approx(pendulum.against_stop(2.5, 1.2, 3.0, 0.6), abs=1e-8)
