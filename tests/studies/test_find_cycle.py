"""Is the limit cycle the one that a long run comes to rest on?"""

from __future__ import annotations

import math

import numpy as np
import pytest

import watchsim as ws
from watchsim.analysis.timing import mean_over
from watchsim.simulation.recording import unevenness
from watchsim.studies.steady import steady


@pytest.fixture(scope="module")
def bench():
    return ws.load(ws.profiles_dir() / "bench_lever")


@pytest.fixture(scope="module")
def swiss():
    return ws.load(ws.profiles_dir() / "swiss_lever")


def compared(scene, duration):
    """The cycle agrees with the end of a run that has come to rest, by far more closely than is asked."""
    cycle, rest = steady(scene), mean_over(ws.simulate(scene, duration, record="statistics"))
    assert cycle.found
    assert cycle.verdict == "ticks"
    assert rest.amplitude_deg_error < 1e-7
    assert cycle.amplitude_deg == pytest.approx(rest.amplitude_deg, abs=1e-6)
    assert cycle.rate_s_per_d == pytest.approx(rest.rate_s_per_d, abs=1e-4)
    assert cycle.beat_error_ms == pytest.approx(rest.beat_error_ms, abs=1e-6)
    assert cycle.simulated_s < 12.0
    return cycle


def test_against_a_run_to_rest(bench):
    cycle = compared(bench, 50.0)
    assert cycle.oscillations == 1
    assert cycle.amplitude_deg_error < 1e-6
    assert cycle.rate_s_per_d_error < 1e-4
    # What is left of a disturbance after one oscillation, as the run shows it.
    amplitude = ws.beats(ws.simulate(bench, 6.0)).amplitude_deg
    away = amplitude[20:40:2] - cycle.amplitude_deg
    assert away[1:] / away[:-1] == pytest.approx(cycle.multipliers[0], abs=0.002)


def test_out_of_beat(bench):
    """(T1 - T2)/2 = 2 asin(β/A)/ω, but for what the escapement adds."""
    cycle = compared(bench.set("springs.0.rest", "1.5°"), 50.0)
    expected = 2e3 * math.asin(1.5 / cycle.amplitude_deg) / (2.0 * math.pi * 4.0)
    assert cycle.beat_error_ms == pytest.approx(expected, rel=0.1)
    mirrored = steady(bench.set("springs.0.rest", "-1.5°"))
    assert cycle.uneven_ms * mirrored.uneven_ms < 0.0


@pytest.mark.slow
def test_a_watch_that_settles_slowly(swiss):
    compared(swiss, 320.0)


def test_unequal_teeth(bench):
    """An eccentric wheel: the cycle is one turn of it, fifteen oscillations of different amplitudes."""
    scene = bench.set("bodies.wheel.pivot", ["0.004 mm", "0 mm"])
    cycle = steady(scene)
    assert cycle.oscillations == 15
    assert cycle.tooth_spread_deg > 0.4
    run = ws.simulate(scene, 50.0, record="events")
    found = ws.beats(run)
    assert found.amplitude_deg[-30:].mean() == pytest.approx(cycle.amplitude_deg, abs=1e-6)
    assert found.period_s[-30:].mean() == pytest.approx(cycle.period_s, abs=1e-11)
    uneven = 500.0 * unevenness(found.mark) * np.sign(found.end_at - found.start_at)
    assert abs(uneven[-30:].mean()) == pytest.approx(cycle.beat_error_ms, abs=1e-6)
    assert cycle.multipliers[0] == pytest.approx(steady(bench).multipliers[0] ** 15, rel=0.1)


@pytest.mark.parametrize("start", ["-200°", "-330°", "-60°"])
def test_the_start_does_not_matter(bench, start):
    usual, other = steady(bench), steady(bench.set("bodies.balance.angle", start))
    assert other.found
    assert other.amplitude_deg == pytest.approx(usual.amplitude_deg, abs=1e-6)
    assert other.rate_s_per_d == pytest.approx(usual.rate_s_per_d, abs=1e-4)


@pytest.mark.parametrize(
    "profile, torque, verdict",
    [("swiss_lever", "-1.5 µN·m", "knocks"), ("swiss_lever", "1 µN·m", "backwards"), ("bench_lever", "-0.01 µN·m", "stops")],
)
def test_where_there_is_no_cycle(profile, torque, verdict):
    scene = ws.load(ws.profiles_dir() / profile).set("run.duration", "8 s")
    cycle = steady(scene.set("torques.0.value", torque))
    assert not cycle.found
    assert cycle.verdict == verdict
    assert cycle.message
    assert cycle.amplitude_deg is None


def test_a_balance_alone(bench):
    """Its swing dies away by exp(-π / √(Q² - 1/4)) in an oscillation."""
    cycle = steady(ws.load(ws.profiles_dir() / "balance"))
    assert (cycle.found, cycle.verdict) == (False, None)
    assert cycle.multipliers[0] == pytest.approx(math.exp(-math.pi / math.sqrt(250.0**2 - 0.25)), rel=1e-9)
    assert "dies" in cycle.message or "comes to rest" in cycle.message


@pytest.mark.parametrize(
    ("name", "key", "seen"),
    [
        ("incline", "springs", "no body swings on a spring or by gravity"),
        ("jumper", "springs", "jumper is sprung, finger moves as the scene says, and no torque acts"),
        ("cam", "springs", "follower is sprung"),
        ("ratchet", "torques", "wheel is driven, click is sprung and rests on it, and did not swing"),
    ],
)
def test_what_is_no_watch_has_no_cycle_to_ask_for(name, key, seen):
    with pytest.raises(ws.SceneError, match="nothing keeps an oscillator going") as refused:
        steady(ws.load(ws.profiles_dir() / name))
    (fault,) = refused.value.faults
    assert fault.key == key
    assert seen in fault.message
    assert "scene.toml" in fault.place


def test_on_a_carriage():
    """Where there is no section an ordinary run stands in, and says so."""
    cycle = steady(ws.load(ws.profiles_dir() / "carriage"))
    assert cycle.found
    assert "run of 20 s" in cycle.message
    assert abs(cycle.amplitude_deg - 290.73) < 0.05


def test_a_shifted_pivot_takes_the_start_back(bench):
    """A wheel half a micrometre nearer overlaps the stones at the start; the cycle hardly changes."""
    moved = steady(bench.set("bodies.lever.position.1", "2.886251346 mm"))
    assert moved.found
    assert 0.0 < abs(moved.amplitude_deg - steady(bench).amplitude_deg) < 0.2


def test_a_start_deep_in_each_other_is_refused(bench):
    with pytest.raises(ws.SceneError, match="overlap"):
        steady(bench.set("bodies.lever.angle", "0°"))


def test_the_error_bar_holds(bench):
    """The amplitude of a much finer solver lies within a few errors."""
    coarse = steady(bench, tolerance=1e-6)
    fine = steady(bench, tolerance=1e-11)
    assert 0.0 < abs(coarse.amplitude_deg - fine.amplitude_deg) < 3.0 * coarse.amplitude_deg_error
    assert coarse.amplitude_deg_error < 0.1


def test_brief(bench):
    whole, brief = steady(bench), steady(bench, brief=True)
    assert brief.amplitude_deg == pytest.approx(whole.amplitude_deg, abs=1e-6)
    assert brief.multipliers == ()
    assert brief.simulated_s < whole.simulated_s


@pytest.mark.parametrize("argument", [{"tolerance": 1.0}, {"amplitude": -1.0}, {"amplitude": math.nan}])
def test_bad_arguments(bench, argument):
    with pytest.raises(ValueError, match="must"):
        steady(bench, **argument)
