"""Do the closed forms solve the equations they claim to solve? Checked by integrating those equations."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from reference import block, oscillator, pendulum, rolling
from reference.oscillator import Oscillator
from reference.rolling import Disc
from reference.single_impact import single_impact
from scipy.integrate import solve_ivp

OSCILLATORS = {
    "underdamped": Oscillator(2.0, 50.0, 1.5, 3.0, 0.2),
    "undamped": Oscillator(2.0, 50.0),
    "critical": Oscillator(2.0, 50.0, 20.0, -4.0),
    "overdamped": Oscillator(2.0, 50.0, 31.0, 3.0, 0.2),
}


def integrate(acceleration, start: tuple[float, float], t: float) -> np.ndarray:
    done = solve_ivp(lambda _, y: (y[1], acceleration(y[0], y[1])), (0.0, t), start, method="DOP853", rtol=1e-12, atol=1e-13)
    return done.y[:, -1]


@pytest.mark.parametrize("name", OSCILLATORS)
def test_oscillator(name: str) -> None:
    o = OSCILLATORS[name]
    truth = integrate(lambda q, u: (o.torque - o.viscous * u - o.stiffness * (q - o.rest)) / o.inertia, (0.7, -1.1), 1.7)
    assert oscillator.motion(o, 0.7, -1.1, 1.7) == pytest.approx(tuple(truth), abs=1e-10)
    assert oscillator.motion(o, 0.7, -1.1, 0.0) == pytest.approx((0.7, -1.1), abs=1e-15)


def test_pendulum_swings() -> None:
    truth = integrate(lambda q, _: -9.0 * math.sin(q), (2.5, 0.0), 4.0)
    assert pendulum.swing(4.0, 2.5, 3.0) == pytest.approx(tuple(truth), abs=1e-10)


def test_pendulum_against_stop() -> None:
    """From one touch to the next with the integrated equation."""
    times = pendulum.touches(4, 1.2, 3.0, 0.6)
    state = integrate(lambda q, _: -9.0 * math.sin(q), (1.2, 0.0), times[0])
    for left, right in pairwise(times):
        assert state[0] == pytest.approx(0.0, abs=1e-10)
        half = integrate(lambda q, _: -9.0 * math.sin(q), (0.0, -0.6 * state[1]), 0.5 * (right - left))
        assert pendulum.against_stop(0.5 * (left + right), 1.2, 3.0, 0.6) == pytest.approx(tuple(half), abs=1e-10)
        state = integrate(lambda q, _: -9.0 * math.sin(q), (0.0, -0.6 * state[1]), right - left)


def test_block_slides_back_only_on_a_steep_incline() -> None:
    slope, stop = math.radians(20.0), block.stops_at(2.0, 0.5, math.radians(20.0))
    assert block.block(stop, 2.0, 0.5, slope)[1] == pytest.approx(0.0, abs=1e-15)
    assert block.block(5.0, 2.0, 0.5, slope) == (block.block(stop, 2.0, 0.5, slope)[0], 0.0)
    assert block.block(5.0, 2.0, 0.3, slope)[1] < 0.0
    energy = 0.5 * 2.0**2 - 9.81 * math.sin(slope) * block.block(stop, 2.0, 0.5, slope)[0]
    assert energy == pytest.approx(0.5 * 9.81 * math.cos(slope) * block.block(stop, 2.0, 0.5, slope)[0])


@pytest.mark.parametrize(("v0", "spin0"), [(2.0, 0.0), (0.0, 60.0), (-1.0, 10.0), (0.5, 10.0)])
def test_disc_ends_rolling(v0: float, spin0: float) -> None:
    """Momentum about the line of contact is conserved on the level, and the slip is gone at the end."""
    disc = Disc(0.05, 0.2)
    end = rolling.slip_ends(disc, v0, spin0)
    state = rolling.motion(disc, v0, spin0, end + 1.0)
    assert state.v == pytest.approx(disc.radius * state.spin, abs=1e-14)
    assert state.v + 0.5 * disc.radius * state.spin == pytest.approx(v0 + 0.5 * disc.radius * spin0, abs=1e-14)


def test_disc_needs_grip_to_roll_downhill() -> None:
    """Rolling needs mu >= tan(slope) kappa / (1 + kappa) = 0.1213."""
    for mu, rolls in ((0.13, True), (0.11, False)):
        state = rolling.motion(Disc(0.05, mu, math.radians(20.0)), 0.0, 0.0, 2.0)
        assert (abs(state.v - 0.05 * state.spin) < 1e-12) is rolls


def test_impact_keeps_its_promises() -> None:
    """Poisson: the normal impulse is (1 + eps) that of compression; friction stays in its cone and opposes slip."""
    rng = np.random.default_rng(3)
    regimes = set()
    for _ in range(500):
        W = rng.normal(size=(3, 2))
        G = W.T @ W
        mu, eps = rng.uniform(0.0, 0.9) * min(1.0, G[0, 0] / abs(G[0, 1])), rng.uniform()
        v = (-rng.uniform(0.1, 2.0), rng.normal())
        hit = single_impact((G[0, 0], G[0, 1], G[1, 1]), v, mu, eps)
        regimes.add(hit.regime)
        assert hit.v_n >= -1e-12
        assert abs(hit.tangential) <= mu * hit.normal * (1.0 + 1e-12)
        before = np.linalg.solve(G, v) @ v
        after = np.linalg.solve(G, (hit.v_n, hit.v_t)) @ (hit.v_n, hit.v_t)
        assert after <= before * (1.0 + 1e-9)
    assert regimes == {"stick", "slip"}
