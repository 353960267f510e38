"""Where a tooth rests on the oscillator: is the limit cycle that of a long run, and its rate that of Airy's rule?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from dead_beat_scenes import one_wheel
from every_time import few
from scipy.optimize import brentq

import watchsim as ws
from watchsim.analysis.timing import mean_over
from watchsim.studies.steady import steady

TIP, DROP, LIFT, LOCK = 0.1, 1.5, 0.5, 0.4  # degrees, as drawn in dead_beat_scenes.py
HALF_SPAN, PITCH = 45.0, 12.0


@pytest.mark.parametrize("profile", few(["recoil_anchor", "graham"], 1))
def test_against_a_long_run(profile):
    scene = ws.load(ws.profiles_dir() / profile)
    cycle, rest = steady(scene), mean_over(ws.simulate(scene, 800.0, record="statistics"))
    assert cycle.found
    assert cycle.verdict == "ticks"
    assert cycle.amplitude_deg == pytest.approx(rest.amplitude_deg, abs=1e-8)
    assert cycle.rate_s_per_d == pytest.approx(rest.rate_s_per_d, abs=1e-6)
    assert cycle.beat_error_ms == pytest.approx(rest.beat_error_ms, abs=1e-6)
    assert cycle.simulated_s < 60.0


def test_too_little_torque_stops_it():
    cycle = steady(ws.load(ws.profiles_dir() / "graham").set("torques.0.value", "-1 µN·m"))
    assert (cycle.found, cycle.verdict) == (False, "stops")


def impulse_angles(lock):
    """Angles (rad) of the oscillator after the middle while a tooth drives it, at equal steps of the wheel; both pallets.

    A tip on a circle slides down a straight face that turns about a point. Geometry by itself: no part of watchsim.
    """
    width = PITCH / 2.0 - DROP - TIP
    pivot = np.array([0.0, 1.0 / math.cos(math.radians(HALF_SPAN))])
    begin, end = math.radians(lock - LIFT) / 2.0, math.radians(lock + LIFT) / 2.0

    def tip(bearing):
        return np.array([math.cos(bearing), math.sin(bearing)])

    def turned(point, angle):
        c, s = math.cos(angle), math.sin(angle)
        return np.array([[c, -s], [s, c]]) @ (point - pivot)

    found = []
    for side in (1, -1):  # the entry pallet goes out clockwise, the exit pallet the other way
        middle = 90.0 + side * HALF_SPAN
        bearings = np.radians(np.linspace(middle + width / 2.0, middle - width / 2.0, 201))
        first, last = turned(tip(bearings[0]), side * begin), turned(tip(bearings[-1]), side * end)
        normal = np.array([first[1] - last[1], last[0] - first[0]])

        def off(angle, bearing, side=side, first=first, normal=normal):
            return float(np.dot(turned(tip(bearing), side * angle) - first, normal))

        found += [brentq(off, begin - 1e-3, end + 1e-3, args=(bearing,)) for bearing in bearings]
    return np.array(found)


@pytest.mark.parametrize(
    "lock, quality", few([(0.1, 1000), (0.4, 1000), (0.4, 250)], lambda one: sum(one) < 1000.4, several=True)
)
def test_rate_of_a_short_impulse_that_comes_late(tmp_path, lock, quality):
    """-86400 θ̄/(2QA), with θ̄ the centre of the impulse, in s/d; beside it damping costs 86400/(8Q²)."""
    scene = one_wheel(tmp_path, lock=lock, quality=quality, torque=500.0 / quality, start=6.0, tolerance=1e-12)
    cycle = steady(scene)
    assert cycle.found
    amplitude, angles = math.radians(cycle.amplitude_deg), impulse_angles(lock)
    late = cycle.rate_s_per_d + 86400.0 / (8.0 * quality**2)
    assert late == pytest.approx(-86400.0 * angles.mean() / (2.0 * quality * amplitude), rel=0.01)
    # Airy's integral over the whole impulse; what is left is of second order in 1/Q.
    airy = -86400.0 / (2.0 * quality) * np.tan(np.arcsin(angles / amplitude)).mean()
    assert late == pytest.approx(airy, rel=1.5 / quality)


@pytest.mark.slow
def test_the_same_rate_by_a_run(tmp_path):
    """0.15° of more delay, from 0.3° of more lock, in two runs of 150 s."""
    rates, amplitude = [], 0.0
    for lock in (0.1, 0.4):
        run = ws.simulate(one_wheel(tmp_path, lock=lock, quality=250, torque=2.0, start=4.0), 150.0, record="statistics")
        found = mean_over(run)
        rates.append(found.rate_s_per_d)
        amplitude = found.amplitude_deg
    assert rates[1] - rates[0] == pytest.approx(-86400.0 * 0.15 / (2.0 * 250.0 * amplitude), rel=0.01)


def test_parts_that_rest_on_the_oscillator_follow_it():
    """A recoiling tooth: other amplitudes from the same section are those of a run that begins there."""
    scene = ws.load(ws.profiles_dir() / "recoil_anchor")
    usual = steady(scene)
    for amplitude in (1.7, 2.8):
        assert steady(scene, amplitude=math.radians(amplitude)).amplitude_deg == pytest.approx(usual.amplitude_deg, abs=1e-8)
