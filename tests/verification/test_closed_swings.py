"""Do the exact swings agree with their independent twins?"""

from __future__ import annotations

import pytest
from reference import oscillator, pendulum

from watchsim.verification.closed_swings import Damped, Stopped, damped_state, stopped_state, touch_times, turning_time

BALANCE = Damped(inertia=1.2e-9, stiffness=7.58e-7, viscous=6e-10, torque=2e-8, angle=4.7, rate=10.0)
PENDULUM = Stopped(w=22.1, angle=1.3, restitution=0.7)


@pytest.mark.parametrize("t", [0.0, 0.01, 0.13, 0.7, 2.0])
def test_damped_balance(t: float) -> None:
    twin = oscillator.Oscillator(BALANCE.inertia, BALANCE.stiffness, BALANCE.viscous, BALANCE.torque)
    assert damped_state(BALANCE, t) == pytest.approx(oscillator.motion(twin, BALANCE.angle, BALANCE.rate, t), rel=1e-12)


@pytest.mark.parametrize("rate", [10.0, 0.0, -10.0])
def test_turning_points(rate: float) -> None:
    case = Damped(1.2e-9, 7.58e-7, 6e-10, 2e-8, 4.7, rate)
    swings = [damped_state(case, turning_time(case, k)) for k in (1, 2, 3, 8)]
    assert [u for _, u in swings] == pytest.approx([0.0] * 4, abs=1e-11)
    assert swings[0][0] * swings[1][0] < 0.0
    assert 0.0 < turning_time(case, 1) < turning_time(case, 2) - turning_time(case, 1) + 1e-9


def test_what_is_let_go_has_no_rate() -> None:
    case = Damped(inertia=2.0, stiffness=9.0, viscous=0.3, torque=0.7, angle=1.5)
    assert damped_state(case, 0.0) == (pytest.approx(1.5, rel=1e-15), 0.0)


@pytest.mark.parametrize("t", [0.0, 0.05, 0.08, 0.2, 0.31, 0.5, 1.0, 3.0])
def test_pendulum_against_a_stop(t: float) -> None:
    truth = pendulum.against_stop(t, PENDULUM.angle, PENDULUM.w, PENDULUM.restitution)
    assert stopped_state(PENDULUM, t) == pytest.approx(truth, rel=1e-10, abs=1e-12)


def test_touches() -> None:
    truth = pendulum.touches(6, PENDULUM.angle, PENDULUM.w, PENDULUM.restitution)
    assert touch_times(PENDULUM, 6) == pytest.approx(truth, rel=1e-14, abs=0.0)
