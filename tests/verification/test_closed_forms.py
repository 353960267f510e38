"""Does the incline in doubles agree with sixty digits?"""

from __future__ import annotations

import math

import pytest
from mpmath import mpf
from reference.incline_closed_form import accumulation, first_impact, reference, rolling_begins, settled

from watchsim.verification.benchmarks import _energy_lost
from watchsim.verification.closed_forms import Incline, incline_state

FRICTIONS = ("0.3", "0.13", "0.10", "0.02", "0")
TIMES = (
    *("0", "0.05", "0.14", "0.15", "0.2", "0.29", "0.3", "0.4", "0.43", "0.44", "0.4418", "0.4418845"),
    *("0.5", "1", "1.25", "1.3", "2", "3"),
)


def near(got: float, expected: mpf, size: float = 1.0) -> bool:
    """Equal to 1e-14, relative, or absolute in units of `size` where the value is small."""
    return abs(got - expected) <= 1e-14 * max(abs(float(expected)), size)


@pytest.mark.parametrize("mu", FRICTIONS)
@pytest.mark.parametrize("t", TIMES)
def test_state(t: str, mu: str) -> None:
    truth, got = reference(t, mu), incline_state(Incline(float(mu)), float(t))
    assert near(got.x, truth.x, 0.1)
    assert near(-got.angle, truth.theta)
    assert near(got.v_x, truth.v)
    assert near(-got.spin, truth.spin, 20.0)


@pytest.mark.parametrize("mu", FRICTIONS)
def test_times(mu: str) -> None:
    case = Incline(float(mu))
    assert near(case.first_impact, first_impact())
    assert near(case.accumulation, accumulation())
    begins = rolling_begins(settled(mpf(mu)), mpf(mu))
    if begins == mpf("inf"):
        assert case.rolling_begins == math.inf
    else:
        assert near(case.rolling_begins, begins)


@pytest.mark.parametrize(("mu", "rolls"), [("0.12132", False), ("0.12133", True)])
def test_it_rolls_in_the_end_where_friction_is_a_third_of_the_slope(mu: str, rolls: bool) -> None:
    """tan(20°)/3 is 0.1213234: from either side of it."""
    begins = rolling_begins(settled(mpf(mu)), mpf(mu))
    assert (Incline(float(mu)).rolling_begins < math.inf) is rolls is (begins < math.inf)
    assert not rolls or Incline(float(mu)).rolling_begins == pytest.approx(float(begins), rel=1e-9)


def test_published_digits() -> None:
    state = incline_state(Incline(0.3), 3.0)
    assert state.x == pytest.approx(10.0939616140729, rel=1e-14, abs=0.0)
    assert state.angle == pytest.approx(-200.180704521549, rel=1e-14)
    assert state.spin == pytest.approx(-134.208704240992, rel=1e-14)
    assert Incline(0.13).rolling_begins == pytest.approx(1.250743025464493, rel=1e-15, abs=0.0)


def test_height_bounces_between_impacts() -> None:
    case = Incline(0.3)
    for k in range(1, 12):
        ground = case.first_impact * (1.0 + 2.0 * 0.5 * (1.0 - 0.5 ** (k - 1)) / 0.5)
        below, above = incline_state(case, ground - 1e-13), incline_state(case, ground + 1e-13)
        assert below.y == pytest.approx(case.radius, abs=1e-12)
        assert above.v_y == pytest.approx(-0.5 * below.v_y, abs=1e-11)
        top = incline_state(case, ground + above.v_y / case.press)
        assert top.v_y == pytest.approx(0.0, abs=1e-11)
        assert top.y - case.radius == pytest.approx(case.drop * 0.25**k, rel=1e-9, abs=0.0)
    assert incline_state(case, 0.6).y == case.radius
    assert incline_state(case, 0.0).y == case.radius + case.drop


@pytest.mark.parametrize("restitution", [0.1, 0.3, 0.77, 0.97])
def test_impacts_are_counted_up_to_their_end(restitution: float) -> None:
    """The height after each of the first ones, and a rounding before they accumulate."""
    case = Incline(0.3, restitution)
    t, speed = case.first_impact, case.press * case.first_impact
    for _ in range(6):
        speed *= restitution
        rise = speed / case.press
        height = incline_state(case, t + rise).y - case.radius
        assert height == pytest.approx(0.5 * speed * rise, rel=1e-8, abs=math.ulp(case.radius))
        assert incline_state(case, t + 0.7 * rise).v_y == pytest.approx(0.3 * speed, rel=1e-8, abs=0.0)
        t += 2.0 * rise
    assert case.accumulation == pytest.approx(case.first_impact * (1.0 + restitution) / (1.0 - restitution), rel=1e-14, abs=0.0)
    last = incline_state(case, math.nextafter(case.accumulation, 0.0))
    assert last.y == pytest.approx(case.radius, abs=1e-14)


@pytest.mark.parametrize("kappa", [0.4, 0.9])
def test_energy_goes_at_impacts_alone_while_it_bounces(kappa: float) -> None:
    """Nothing before the first; then, without friction, what is not given back; with it, what gripping takes from the slip."""
    for friction in (0.0, 5.0):
        case = Incline(friction, restitution=0.6, radius=0.07, kappa=kappa)
        fall, touch = case.press * case.first_impact, case.first_impact
        assert _energy_lost(case, 0.7 * touch) == pytest.approx(0.0, abs=1e-15)
        lost = 0.5 * (1.0 - 0.36) * fall**2
        if friction:
            lost += 0.5 * (case.pull * touch) ** 2 * kappa / (1.0 + kappa)
        for later in (1.1, 1.9):
            assert _energy_lost(case, later * touch) == pytest.approx(lost, rel=1e-12, abs=0.0)


def test_without_restitution_one_impact_is_all() -> None:
    case = Incline(0.3, restitution=0.0)
    assert case.accumulation == case.first_impact
    state = incline_state(case, 1.0)
    assert state.v_x == pytest.approx(case.pull * case.first_impact / 1.5 + case.pull / 1.5 * (1.0 - case.first_impact))
    assert state.v_x == pytest.approx(-case.radius * state.spin)
