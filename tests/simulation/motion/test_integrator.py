"""Has the integrator the order it claims, in steps and between them, where contacts couple bodies?"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from moving_scenes import bowl, circle, polygon, touching
from reference import pendulum
from scipy.integrate import DOP853, solve_ivp

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Damping, Torque
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation import runner as running
from watchsim.simulation.loop_state.buffers import new_until
from watchsim.simulation.motion import dop853
from watchsim.simulation.motion.dense_output import dense_value
from watchsim.simulation.options import options_for
from watchsim.simulation.runner import Run
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

R, r, M, G = 1.0, 0.2, 2.0, 9.81
J = 0.5 * M * r * r
START = 0.8
_dense_value = callable_kernel(dense_value)


def test_coefficients() -> None:
    """Entered by hand from the book; scipy has them from the authors' own program."""
    n = dop853.STAGES
    assert np.array_equal(dop853.C[:n], DOP853.C[:n])
    assert np.array_equal(dop853.A[:n, :n], DOP853.A)
    assert np.array_equal(dop853.A[n, :n], DOP853.B)
    assert dop853.C[n] == 1.0
    assert np.array_equal(
        dop853.A[n + 1 : n + 4, : n + 4], np.pad(DOP853.A_EXTRA, ((0, 0), (0, n + 4 - DOP853.A_EXTRA.shape[1])))
    )
    assert np.array_equal(dop853.C[n + 1 : n + 4], DOP853.C_EXTRA)
    assert np.array_equal(dop853.E3, DOP853.E3)
    assert np.array_equal(dop853.E5, DOP853.E5)
    assert np.array_equal(dop853.D, DOP853.D)


def rolling_in_a_bowl() -> Scene:
    """A disc that rolls without slip in a round hole is a pendulum: (1 + 1/2)(R - r) angle'' = -g sin(angle)."""
    s, c = math.sin(START), math.cos(START)
    disc = Body("disc", "free", ((R - r) * s, -(R - r) * c), 0.0, mass=M, inertia=J, loops=(circle(r),))
    hole = Body("bowl", "fixed", loops=(bowl(R),))
    contacts = touching("disc", "bowl", friction=5.0)
    return Scene("bowl", (disc, hole), contacts=contacts, gravity=(0.0, -G))


def swung(t: float) -> np.ndarray:
    """x, y, angle and their rates of the disc at time t; released at rest."""
    angle, rate = pendulum.swing(t, START, math.sqrt(G / (1.5 * (R - r))))
    x, y = (R - r) * math.sin(angle), -(R - r) * math.cos(angle)
    # Rolling: the disc turns backwards by (R - r)/r for every turn of its centre about the bowl's.
    turn = -(R - r) / r
    return np.array([x, y, turn * (angle - START), -y * rate, x * rate, turn * rate])


def with_steps(h: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps of length h, whatever their error."""

    def loose(size: float, _tolerance: float, _max_step: float):
        return options_for(size, 1e30, h)

    monkeypatch.setattr(running, "options_for", loose)


def errors(h: float, monkeypatch: pytest.MonkeyPatch) -> tuple[float, float]:
    """Errors at the end of the run, and inside a step by the continuous extension."""
    with_steps(h, monkeypatch)
    done = simulate(rolling_in_a_bowl(), 0.9)
    assert done.stop == Stop.DURATION
    assert done.counts["steps"] >= 0.9 / h
    end = np.concatenate([done.q[-1], done.u[-1]])
    return float(np.abs(end - swung(0.9)).max()), middle_error(h)


def middle_error(h: float) -> float:
    scene = dataclasses.replace(rolling_in_a_bowl(), duration=1.0)
    run = Run(scene, compile_scene(scene), 1e-9, Recording())
    until = new_until(0.4, 0.9, True, 1e9)
    while run._advance(until, run.record) != Stop.SLICE:
        run.flush()
    step = run.scratch.step
    start, length = step.span.start, step.span.length
    assert length == pytest.approx(h)
    exact = swung(float(start))
    worst = 0.0
    for share in (0.3, 0.5, 0.8):
        value = np.array([_dense_value(step, i, share * length) for i in range(6)])
        # The error made in this step alone: the step did not begin exactly on the exact motion.
        worst = max(worst, float(np.abs(value - swung(float(start) + share * length) - (step.y0[:6] - exact)).max()))
    return worst


def test_orders(monkeypatch: pytest.MonkeyPatch) -> None:
    """Order 8 at the end; between steps the local error is of order 8 (an extension of order 7). Both from both sides."""
    coarse, fine = errors(0.09, monkeypatch), errors(0.045, monkeypatch)
    assert fine[0] > 1e-13  # not yet rounding
    assert 7.2 < math.log2(coarse[0] / fine[0]) < 9.5
    assert 6.8 < math.log2(coarse[1] / fine[1]) < 9.5


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
def test_tolerance_is_kept(tolerance: float) -> None:
    done = simulate(rolling_in_a_bowl(), 3.0, tolerance)
    assert np.concatenate([done.q[-1], done.u[-1]]) == pytest.approx(swung(3.0), abs=100.0 * tolerance + 1e-12)
    assert done.worst_penetration < 0.1 * tolerance * R
    assert done.energy["residual_relative"] < 100.0 * tolerance + 1e-12
    assert not [event for event in done.events if event["t"] > 0.0]


MU, J1, J2, DRIVE = 0.25, 0.3, 0.7, -2.0
O2, LONG = np.array([2.0, 0.3]), 1.6


def corner_on_turning_line() -> Scene:
    """A rotor at O2 presses its corner down on the upper edge of a driven beam, which lies along the beam's radius."""
    beam = Loop((Line(4.0, 0.0, 0.1, 0.0),), closed=False)
    angle = math.asin(0.3 / LONG)
    x, y = -LONG * math.cos(angle), -LONG * math.sin(angle)
    thorn = polygon((x, y), (x + 0.3, y + 0.15), (x + 0.1, y + 0.3))
    bodies = (
        Body("beam", "pivot", (0.0, 0.0), 0.0, (0.4,), inertia=J1, loops=(beam,)),
        Body("rotor", "pivot", (float(O2[0]), float(O2[1])), 0.0, (0.0,), inertia=J2, loops=(thorn,)),
    )
    torques = (Torque("rotor", 3.0), Torque("beam", DRIVE))
    contacts = touching("beam", "rotor", friction=MU)
    return Scene("corner", bodies, torques=torques, contacts=contacts, damping=(Damping("beam", 0.1),))


def two_rotors(t: float, q2: float, u2: float) -> np.ndarray:
    """The same by one equation: the line passes through its own axis, so that q1 is the polar angle of the corner.

    Lagrange: with r the corner's distance from O1, q1' = k(q2) q2', normal force N and friction mu N along the line act on
    the corner; their moments about both axes give two equations for q2'' and N.
    """
    angle = math.asin(0.3 / LONG)
    start = np.array([-LONG * math.cos(angle), -LONG * math.sin(angle)])

    def corner(q: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        c, s = math.cos(q), math.sin(q)
        arm = np.array([c * start[0] - s * start[1], s * start[0] + c * start[1]])
        return O2 + arm, np.array([-arm[1], arm[0]]), -arm

    def right(_: float, y: np.ndarray) -> list[float]:
        q, u = y
        p, dp, ddp = corner(q)
        square = p @ p
        r = math.sqrt(square)
        e, n = p / r, np.array([-p[1], p[0]]) / r
        k = (p[0] * dp[1] - p[1] * dp[0]) / square
        dk = (p[0] * ddp[1] - p[1] * ddp[0]) / square - k * 2.0 * (p @ dp) / square
        slip = (e @ dp) * u
        push = n - MU * math.copysign(1.0, slip) * e  # per unit of N, on the corner
        arm = p - O2
        moment2 = arm[0] * push[1] - arm[1] * push[0]
        # J2 u' = 3 + moment2 N ;  J1 (k u' + dk u²) = DRIVE - 0.1 k u - r N
        A = np.array([[J2, -moment2], [J1 * k, r]])
        a, N = np.linalg.solve(A, [3.0, DRIVE - 0.1 * k * u - J1 * dk * u * u])
        assert N > 0.0
        return [u, a]

    return solve_ivp(right, (0.0, t), (q2, u2), method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]


def test_a_corner_sliding_on_a_turning_line() -> None:
    """Two coordinates, friction, both bodies turn: against the one-coordinate equation and scipy."""
    scene = corner_on_turning_line()
    # A start speed of the rotor that keeps the corner on the line.
    done = simulate(scene, 0.3, 1e-11)
    first = done.u[np.searchsorted(done.t, 0.0, side="right") - 1]
    truth = two_rotors(0.3, 0.0, float(first[1]))
    assert done.stop == Stop.DURATION
    # The slip reverses on the way; that is found when it has reached about 1e-8 of the scene's size (4 m) per second.
    assert done.q[-1][1] == pytest.approx(truth[0], abs=5e-9)
    assert done.u[-1][1] == pytest.approx(truth[1], abs=5e-9)
    assert done.worst_penetration < 1e-9
    tighter = simulate(dataclasses.replace(scene, tolerance=1e-13), 0.3)
    assert tighter.q[-1] == pytest.approx(done.q[-1], abs=1e-10)
