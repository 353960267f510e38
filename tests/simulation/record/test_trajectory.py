"""Is the motion between rows interpolated with the promised order, and right at both sides of an impact?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.scene.body import Body
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import EVENT_DTYPE, Trajectory
from watchsim.simulation.stops import Stop

BODIES = (
    Body("rotor", "pivot", (1.0, 2.0)),
    Body("post", "fixed", (3.0, 4.0), 0.5),
    Body("slider", "slide", (5.0, 6.0), 0.25, axis=(0.6, 0.8)),
    Body("puck", "free"),
)
SLICES = {"rotor": slice(0, 1), "slider": slice(1, 2), "puck": slice(2, 5)}


def made(t: np.ndarray, q: np.ndarray, u: np.ndarray, a: np.ndarray) -> Trajectory:
    """Rows that are exact to rounding, as the tolerance says."""
    return Trajectory(Scene("made", BODIES), t, q, u, a, SLICES, np.zeros(0, EVENT_DTYPE), (), Stop.DURATION, tolerance=1e-16)


def wave(spacing: float) -> Trajectory:
    t = np.arange(0.0, 1.0 + 1e-9, spacing)
    phase = 3.0 * t[:, None] + np.arange(5.0)
    return made(t, np.sin(phase), 3.0 * np.cos(phase), -9.0 * np.sin(phase))


def errors(spacing: float) -> tuple[float, float]:
    times = np.linspace(0.0, 0.999, 400)
    phase = 3.0 * times[:, None] + np.arange(5.0)
    q, u = wave(spacing).sample(times)
    return float(np.abs(q - np.sin(phase)).max()), float(np.abs(u - 3.0 * np.cos(phase)).max())


def test_orders_of_interpolation() -> None:
    """Coordinates of order 6, velocities of order 5, from both sides."""
    coarse, fine = errors(0.1), errors(0.05)
    assert 5.7 < math.log2(coarse[0] / fine[0]) < 6.3
    assert 4.7 < math.log2(coarse[1] / fine[1]) < 5.3
    assert fine[0] < 1e-9


def test_quintics_are_reproduced() -> None:
    """Uneven rows, all derivatives."""
    t = np.array([0.0, 0.1, 0.35, 1.0])
    p = np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0, -1.0, 0.7])
    column = [f(t)[:, None] * np.ones(5) for f in (p, p.deriv(), p.deriv(2))]
    done = made(t, *column)
    for x in (0.0, 0.05, 0.2, 0.77, 1.0):
        q, u = done.at(x)
        assert q == pytest.approx(np.full(5, p(x)), abs=1e-14)
        assert u == pytest.approx(np.full(5, p.deriv()(x)), abs=1e-13)


def test_at_an_impact_the_later_row_counts() -> None:
    t = np.array([0.0, 1.0, 1.0, 2.0])
    q = np.array([0.0, 2.0, 2.0, 1.0])[:, None] * np.ones(5)
    u = np.array([2.0, 2.0, -1.0, -1.0])[:, None] * np.ones(5)
    done = made(t, q, u, np.zeros((4, 5)))
    assert done.at(1.0)[1] == pytest.approx(-np.ones(5))
    assert done.at(1.0 - 1e-12)[1] == pytest.approx(2.0 * np.ones(5))
    assert done.at(1.5)[0] == pytest.approx(1.5 * np.ones(5), abs=1e-14)


def test_an_impact_in_the_last_row() -> None:
    done = made(np.array([0.0, 1.0, 1.0]), np.ones((3, 5)), np.array([0.0, 0.0, 7.0])[:, None] * np.ones(5), np.zeros((3, 5)))
    assert done.at(1.0)[1] == pytest.approx(7.0 * np.ones(5))
    assert done.at(0.5)[1] == pytest.approx(np.zeros(5))


def test_times_outside_are_clamped() -> None:
    done = wave(0.1)
    assert np.array_equal(done.at(-5.0)[0], done.q[0])
    assert done.at(7.0)[0] == pytest.approx(done.q[-1], abs=1e-15)


def test_poses() -> None:
    done = wave(0.1)
    q = done.q[3]
    assert done.pose("rotor", 0.3) == pytest.approx((1.0, 2.0, q[0]))
    assert done.pose("post", 0.3) == (3.0, 4.0, 0.5)
    assert done.pose("slider", 0.3) == pytest.approx((5.0 + 0.6 * q[1], 6.0 + 0.8 * q[1], 0.25))
    assert done.pose("puck", 0.3) == pytest.approx(tuple(q[2:]))
