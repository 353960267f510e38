"""Has the integrator its order, do paths and brackets hold, and is drift taken back by the smallest change?"""

import dataclasses
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from every_time import few
from moving_scenes import both, bowl, circle, closed_of, named, polygon, profile, projection_of, touching
from numpy.polynomial import Polynomial
from plain_kernels import in_python
from reference import pendulum
from scipy.integrate import DOP853, solve_ivp

from watchsim.contact.gaps import BACKWARD, FORWARD, OPEN, STICK
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.forces import Damping, Torque
from watchsim.scene.scene import Body, Scene
from watchsim.simulation import coupled_motion as drift_projection
from watchsim.simulation import integrator, step_path
from watchsim.simulation.scratch import COUPLED
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop
from watchsim.simulation.trajectory import Trajectory

# Has the integrator the order it claims, in steps and between them, where contacts couple bodies?

R, r, M, G = 1.0, 0.2, 2.0, 9.81
J = 0.5 * M * r * r
START = 0.8


def test_coefficients() -> None:
    """Entered by hand from the book; scipy has them from the authors' own program."""
    n = integrator.STAGES
    assert np.array_equal(integrator.C[:n], DOP853.C[:n])
    assert np.array_equal(integrator.A[:n, :n], DOP853.A)
    assert np.array_equal(integrator.A[n, :n], DOP853.B)
    assert integrator.C[n] == 1.0
    assert np.array_equal(
        integrator.A[n + 1 : n + 4, : n + 4], np.pad(DOP853.A_EXTRA, ((0, 0), (0, n + 4 - DOP853.A_EXTRA.shape[1])))
    )
    assert np.array_equal(integrator.C[n + 1 : n + 4], DOP853.C_EXTRA)
    assert np.array_equal(integrator.E3, DOP853.E3)
    assert np.array_equal(integrator.E5, DOP853.E5)
    assert np.array_equal(integrator.D, DOP853.D)


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


# Are gaps and rates taken back by the smallest change in the metric of the masses? Against pseudo-inverses.

BEHIND = 1e-6
INDEPENDENT = 1e-6  # sine² of the angle


def directions(seed: int, m: int = 3, n: int = 7) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normal and tangential directions, far from parallel, and inverse masses; one coordinate is held."""
    rng = np.random.default_rng(seed)
    normal, tangential = rng.normal(size=(2, m, n))
    normal[0, 2] = tangential[0, 2] = normal[-1, 0] = tangential[-1, 0] = 0.0
    inverse = rng.uniform(0.2, 3.0, n)
    inverse[4] = 0.0
    return normal, tangential, inverse


def least(ways: np.ndarray, wanted: np.ndarray, inverse: np.ndarray) -> np.ndarray:
    """Of all changes x with ways x = wanted the one with the smallest x M x: by the pseudo-inverse."""
    root = np.sqrt(inverse)
    return np.asarray(root * (np.linalg.pinv(ways * root) @ wanted))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("all_of_them", [True, False])
@pytest.mark.parametrize("m", [2, 3])
def test_gaps_are_closed_by_the_smallest_change(seed: int, m: int, all_of_them: bool) -> None:
    """Only negative ones where not all are wanted: the others stay as they are."""
    normal, tangential, inverse = directions(seed, m)
    gaps = np.array([5e-8, -7e-8, -3e-8])[:m]
    q = np.random.default_rng(seed).normal(size=7)
    moved = q.copy()
    closed, work = closed_of(normal, tangential, g=gaps.tolist()), projection_of(m, len(inverse))
    deepest = in_python(drift_projection.project_positions)(closed, m, all_of_them, BEHIND, inverse, work, moved)
    wanted = -gaps if all_of_them else np.where(gaps < 0.0, -gaps, 0.0)
    assert deepest == 7e-8
    assert moved - q == pytest.approx(least(normal, wanted, inverse), rel=1e-6, abs=1e-14)


def test_of_gaps_that_depend_on_each_other_those_met_first_are_closed() -> None:
    """Three on two coordinates: the one whose own force moves it least for its depth waits."""
    normal = 1e-4 * np.array([[1.0, 0.0], [0.0, 2.0], [0.6, 0.8]])
    inverse = np.array([1.0, 1.0])
    gaps = [-3e-8, -2e-8, -9e-8]  # over the lengths of their directions: 3, 1, 9
    q = np.zeros(2)
    closed, work = closed_of(normal, 0.01 * normal[:, ::-1], g=gaps), projection_of(3, len(inverse))
    assert in_python(drift_projection.project_positions)(closed, 3, True, BEHIND, inverse, work, q) == 9e-8
    assert q == pytest.approx(np.linalg.solve(normal[[0, 2]], [3e-8, 9e-8]), rel=1e-9, abs=0.0)
    assert work.correction[:6] == pytest.approx([work.correction[0], 0.0, 0.0, 0.0, work.correction[4], 0.0])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("modes", [(STICK, OPEN, FORWARD), (BACKWARD, STICK, STICK), (OPEN, FORWARD, BACKWARD)])
def test_rates_of_what_is_in_force_and_slips_of_what_sticks_vanish(seed: int, modes: tuple[int, ...]) -> None:
    normal, tangential, inverse = directions(seed)
    rng = np.random.default_rng(seed + 9)
    rates, slips, u = rng.normal(size=3), rng.normal(size=3), rng.normal(size=7)
    ids = [6, 2, 4]
    closed = closed_of(normal, tangential, ids, gN_dot=rates.tolist(), gT_dot=slips.tolist())
    mode = np.zeros(8, np.int8)
    mode[ids] = modes
    work, changed = projection_of(3, len(inverse)), u.copy()
    in_python(drift_projection.project_velocities)(closed, 3, mode, INDEPENDENT, inverse, work, changed)
    rows = [2 * i for i in range(3) if modes[i] != OPEN] + [2 * i + 1 for i in range(3) if modes[i] == STICK]
    every = np.stack([rates, slips], axis=1).ravel()
    whole = both(normal, tangential)
    assert changed - u == pytest.approx(least(whole[rows], -every[rows], inverse), rel=1e-6, abs=1e-9)
    assert [i for i in range(6) if work.correction[i] != 0.0] == sorted(rows)
    left = in_python(drift_projection.remaining_rate)
    for i in range(3):
        assert left(closed, 3, i, work) == pytest.approx(rates[i] + normal[i] @ (changed - u), abs=1e-12)


# How is a root closed in, evaluation by evaluation, and where is everything on the path of a step? By hand and by numpy.


def polynomial(d: np.ndarray) -> Polynomial:
    """Of the share of the step, from the start value and seven coefficients of the extension."""
    x = Polynomial([0.0, 1.0])
    w = 1.0 - x
    return d[0] + x * (d[1] + w * (d[2] + x * (d[3] + w * (d[4] + x * (d[5] + w * (d[6] + x * d[7]))))))


LENGTH = 0.3


def a_step(kind: int, n: int, seed: int = 1) -> tuple[SimpleNamespace, list[Polynomial]]:
    """A step of n coordinates, and its places and velocities as polynomials of the share."""
    d = np.random.default_rng(seed).normal(size=(8, 2 * n))
    step = named(
        span=named(kind=kind, start=5.0, length=LENGTH), y0=d[0], dense=d[1:], q=np.arange(1.0, n + 1.0), awake=[1] * n,
        u=np.arange(11.0, n + 11.0), bound=np.zeros(n),
    )  # fmt: skip
    return step, [polynomial(column) for column in d.T]


@pytest.mark.parametrize("tau", [0.0, 0.07, 0.21, 0.3])
def test_values_slopes_and_bends_are_those_of_the_polynomial(tau: float) -> None:
    step, wanted = a_step(COUPLED, 2)
    for i in range(4):
        value, slope, bend = (wanted[i].deriv(k)(tau / LENGTH) / LENGTH**k for k in range(3))
        assert in_python(step_path.dense)(step, i, tau) == pytest.approx((value, slope), rel=1e-12, abs=0.0)
        assert in_python(step_path.dense_value)(step, i, tau) == pytest.approx(value, rel=1e-12, abs=0.0)
        assert in_python(step_path.dense_bend)(step, i, tau) == pytest.approx(bend, rel=1e-11, abs=1e-10)


def moved(coordinate: Any, grip: int, q: float, u: float, t: float) -> tuple[float, float]:
    return 100.0 * coordinate.number + q + u * t, 1000.0 * grip + u


MODEL = named(coordinates=[named(number=i) for i in range(5)])


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("seed", range(3))
def test_bounds_are_the_largest_bernstein_coefficients_of_a_derivative(order: int, seed: int) -> None:
    """Against the coefficients from those of powers: b_k = sum of C(k, i)/C(n, i) a_i."""
    step, wanted = a_step(COUPLED, 2, seed)
    for i in range(2):
        powers = wanted[i].deriv(order).coef
        degree = 7 - order
        powers = np.append(powers, np.zeros(degree + 1 - len(powers)))
        bernstein = [sum(math.comb(k, j) / math.comb(degree, j) * powers[j] for j in range(k + 1)) for k in range(degree + 1)]
        bound = max(abs(b) for b in bernstein) / LENGTH**order
        if order == 2:
            in_python(step_path.bound_accelerations)(step, 2)
            assert step.bound[i] == pytest.approx(bound, rel=1e-9)
        else:
            assert in_python(step_path.jerk_bound)(MODEL, step, i) == pytest.approx(bound, rel=1e-9)


# Does a recorded motion tell where everything is at any time, not only at its rows?

RATE = 25.0  # 1/s, of the balance, which swings through some radians: slower speeds are compared with it


def middles(run: Trajectory, many: int) -> np.ndarray:
    """Times between rows, in the longest gaps and all over; none where an event has cut a step to nothing."""
    gaps = np.diff(run.t)
    wide, everywhere = np.argsort(gaps)[-many:], np.linspace(0, len(gaps) - 1, 4 * many).astype(int)
    chosen = np.unique([k for k in (*wide, *everywhere) if gaps[k] > 1e-7])
    return run.t[chosen] + np.random.default_rng(3).uniform(0.2, 0.8, len(chosen)) * gaps[chosen]


@pytest.mark.parametrize("tolerance", few([1e-8, 1e-10, 1e-12], lambda tolerance: tolerance == 1e-10))
def test_between_rows_the_motion_is_that_of_a_run_which_ends_there(tolerance: float) -> None:
    """A run that ends at that time gets there by a step of its own: its end is the integrator's answer."""
    scene = profile("bench_lever")
    whole = simulate(scene, 0.2, tolerance)
    times = middles(whole, 8)
    assert len(times) > 20
    compared = 0
    for t in times:
        there = simulate(scene, float(t), tolerance)
        # Whether a rebound of 1e-15 m/s is ended by rule is a matter of rounding, and decides about what follows.
        if not np.array_equal(there.events["kind"], whole.events["kind"][whole.events["t"] <= t]):
            continue
        compared += 1
        q, u = whole.at(float(t))
        assert q == pytest.approx(there.end_q, rel=3.0 * tolerance, abs=3.0 * tolerance)
        # An event may lie a tolerance earlier in one of the runs: what accelerates there differs by that much.
        allowed = tolerance * (60.0 * np.maximum(np.abs(u), RATE) + 3.0 * np.abs(there.a[-1]) / RATE)
        assert np.all(np.abs(u - there.end_u) <= allowed)
    assert compared > 0.8 * len(times)
