"""Do the closed forms solve the equations they claim to solve? Checked by integrating those equations."""

import math
from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import block, oscillator, pendulum, rolling
from reference.incline_closed_form import (
    GRAVITY,
    HEIGHT,
    RADIUS,
    RESTITUTION,
    accumulation,
    gravity,
    reference,
    rolling_begins,
    settled,
)
from reference.oscillator import Oscillator
from reference.rolling import Disc
from reference.single_impact import single_impact
from scipy.integrate import solve_ivp

# Do the closed forms solve the equations they claim to solve? Checked by integrating those equations.

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


# Do the closed forms of the incline agree with each other, with the two-phase law and with published digits?

PUBLISHED = {  # friction 0.3: time, x, angle, spin
    "0.5": ("0.307910263167217", "4.45967750343539", "22.3681173734987"),
    "1": ("1.14671466467342", "21.2357655335594", "44.7362347469975"),
    "2": ("4.50193227069823", "88.3401176540557", "89.4724694939949"),
    "3": ("10.0939616140729", "200.180704521549", "134.208704240992"),
}


@pytest.mark.parametrize("t", PUBLISHED)
def test_published_digits(t: str) -> None:
    state = reference(t, "0.3")
    for value, digits in zip((state.x, state.theta, state.spin), PUBLISHED[t], strict=True):
        assert abs(value - mpf(digits)) <= unit_in_the_last_place(digits)


def unit_in_the_last_place(digits: str) -> mpf:
    return mpf(10) ** -len(digits.partition(".")[2])


def test_published_times() -> None:
    assert abs(accumulation() - mpf("0.441884573843764")) <= mpf("1e-15")
    assert abs(rolling_begins(settled(mpf("0.13")), mpf("0.13")) - mpf("1.250743025464493")) <= mpf("1e-15")
    assert rolling_begins(settled(mpf("0.10")), mpf("0.10")) == mp.inf


@pytest.mark.parametrize("mu", ["0.3", "0.13", "0.10", "0.02"])
def test_bouncing_agrees_with_compression_and_expansion(mu: str) -> None:
    """Event by event with the two-phase law, in the coordinates of the scene: angle counter-clockwise."""
    pull, press = gravity()
    direct, cross, tangential = mpf(1), mpf(0), mpf(1) + RADIUS**2 / (RADIUS**2 / 2)
    t, x, angle, v, spin = mpf(0), mpf(0), mpf(0), mpf(0), mpf(0)
    flight, regimes = mp.sqrt(2 * HEIGHT / press), []
    v_n = -press * flight
    for _ in range(60):
        t, x, angle, v = t + flight, x + v * flight + pull * flight**2 / 2, angle + spin * flight, v + pull * flight
        hit = single_impact((direct, cross, tangential), (v_n, v + RADIUS * spin), mpf(mu), RESTITUTION)
        v, spin = v + hit.tangential, spin + 2 * hit.tangential / RADIUS
        regimes.append("stick" if abs(hit.v_t) < mpf("1e-50") else "slip")
        flight, v_n = 2 * hit.v_n / press, -hit.v_n
        between = reference(mp.nstr(t + flight / 3, 55), mu)
        assert abs(between.x - (x + v * flight / 3 + pull * flight**2 / 18)) < mpf("1e-45")
        assert abs(between.theta + angle + spin * flight / 3) < mpf("1e-45")
        assert abs(between.spin + spin) < mpf("1e-45")
    assert abs(t + 2 * flight - accumulation()) < mpf("1e-15")
    pattern = {"0.3": ("stick", "stick"), "0.13": ("stick", "slip"), "0.10": ("stick", "slip"), "0.02": ("slip", "slip")}
    assert (regimes[0], *set(regimes[1:])) == pattern[mu]


def test_angular_momentum_about_the_plane() -> None:
    """m R v + J spin = m R g sin(slope) t, whatever the contact does."""
    for t in ("0.1", "0.3", "0.43", "0.6", "2"):
        for mu in ("0.3", "0.13", "0.10"):
            state = reference(t, mu)
            momentum = RADIUS * state.v + RADIUS**2 / 2 * state.spin
            assert abs(momentum - RADIUS * GRAVITY * mp.sin(mp.pi / 9) * mpf(t)) < mpf("1e-45")
