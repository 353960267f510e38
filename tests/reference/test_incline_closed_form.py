"""Do the closed forms of the incline agree with each other, with the two-phase law and with published digits?"""

from __future__ import annotations

import pytest
from mpmath import mp, mpf
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
from reference.single_impact import single_impact

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
