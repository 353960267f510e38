"""Does a duplex escapement tick once in an oscillation, and is its rate set by where the tooth is let go?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from profiles.running import check_running, of_profile, stepping_errors

import watchsim as ws
from watchsim import designs
from watchsim.construction.duplex import Duplex, DuplexPoints
from watchsim.construction.registry import design


def test_twenty_seconds():
    check_running(of_profile("duplex", 20.0), 24.0, 100.0)


@pytest.mark.slow
def test_five_minutes():
    check_running(of_profile("duplex", 300.0), 24.0, 1500.0)


@pytest.fixture(scope="module")
def ticking() -> ws.Trajectory:
    return of_profile("duplex", 4.0)


def test_one_tooth_in_an_oscillation_and_a_dip_on_the_way_back(ticking):
    """Counter-clockwise the wheel goes on by a pitch; clockwise the tooth dips into the notch and is put back."""
    t = np.linspace(2.0, 4.0, 200001)
    q, u = ticking.sample(t)
    wheel, balance = (ticking.slices[name].start for name in ("wheel", "balance"))
    turns = np.flatnonzero(np.diff(np.sign(u[:, balance])))
    gone = -np.degrees(np.diff(q[turns, wheel]))
    way = np.sign(np.diff(q[turns, balance]))
    assert gone[way > 0] == pytest.approx(24.0, abs=1e-6)
    assert gone[way < 0] == pytest.approx(0.0, abs=1e-6)
    back = [np.degrees(q[a:b, wheel]) for a, b, one in zip(turns, turns[1:], way, strict=False) if one < 0]
    dips = [float(np.ptp(one)) for one in back]
    # No deeper than the notch is broad, along the circle of the points.
    points = DuplexPoints(Duplex())
    broad = math.degrees(2.0 * points.roller * math.sin(math.radians(Duplex().notch / 2.0)) / Duplex().tip_radius)
    assert all(0.1 < dip < broad for dip in dips)


def test_the_tooth_is_let_go_where_the_notch_says(ticking):
    """The tip leaves the notch on the right of the roller, as far from the line of centres as it came in on the left."""
    t = np.linspace(2.0, 2.4, 400001)
    q, u = ticking.sample(t)
    wheel, balance = (ticking.slices[name].start for name in ("wheel", "balance"))
    points = DuplexPoints(Duplex())
    at_rest = q[np.argmin(q[:, balance]), wheel]  # before the impulse the balance is far clockwise
    turned = np.degrees(at_rest - q[:, wheel])
    passing = (u[:, balance] > 0.0) & (turned < 2.0 * points.rests)
    last = np.flatnonzero(passing)[-1]
    assert math.degrees(q[last, balance]) == pytest.approx(Duplex().letting_go, abs=0.3)


@pytest.mark.slow
def test_its_rate_is_set_by_where_the_tooth_is_let_go():
    """Airy: what is given near the middle of a swing, and what is taken there on the way back, loses where it comes later.

    Both works together are k (A+² - A-²), from the turning points: between them the balance gains half of what is given and
    taken, the rest is damping. Shifted by δ the rate changes by 86400 δ (A+² - A-²) / (2 π A³).
    """
    rates, swings = [], []
    for at in (6.0, -2.0):
        scene = designs.duplex(letting_go=f"{at} °", friction=0.0, torque="2 µN·m").scene()
        rates.append(ws.steady(scene).rate_s_per_d)
        ends = ws.beats(ws.simulate(scene, duration=100.0)).end_at[-2:]
        swings.append((float(ends.max()), float(-ends.min())))
    (far, near), shift = np.mean(swings, axis=0), math.radians(8.0)
    airy = 86400.0 * shift * (far**2 - near**2) / (2.0 * math.pi * (0.5 * (far + near)) ** 3)
    assert rates[1] - rates[0] == pytest.approx(airy, rel=0.03)


def test_friction_at_rest_holds_the_amplitude_down():
    """Twice the drive gives less than √2 of the amplitude; the tooth presses the roller twice as hard."""
    weak, strong = (ws.steady(designs.duplex(torque=f"{torque} µN·m").scene()) for torque in (2.8, 5.6))
    assert 1.1 < strong.amplitude_deg / weak.amplitude_deg < 1.3


@pytest.mark.parametrize(
    ("chosen", "blamed"),
    [
        ({"reach": 10.0}, "reach"),
        ({"drop": 3.0, "reach": 6.0}, "drop"),
        ({"drop": 16.0, "reach": 6.0, "intersection": 30.0}, "drop"),
        ({"intersection": 12.0, "friction": 0.2}, "intersection"),
        ({"notch": 40.0}, "undercut"),
        ({"teeth": 16, "reach": 7.0}, "undercut"),
        ({"start": 280.0, "letting_go": -30.0}, "start"),
    ],
)
def test_conflicts_name_what_to_change_first(chosen, blamed):
    assert blamed in [one.dimension for one in design("duplex").refusals(chosen)]


@pytest.mark.slow
def test_time_stepping_comes_to_the_same():
    coarse, fine = stepping_errors(designs.duplex().scene(), 2.0, (1.6e-5, 4e-6))
    assert fine < 8e-3 and fine < 0.5 * coarse
