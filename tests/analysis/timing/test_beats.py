"""Are amplitude, rate and beat error those of motions that are known exactly?"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from analysis.made_beats import DEGREE, HERTZ, INERTIA, OMEGA, PERIOD, PIN, Events, balance_only, lever_scene, steady_swings
from reference.oscillator import Oscillator, motion
from render.fake_runs import disc_run

from watchsim.analysis.timing.beats import beats
from watchsim.scene.recording import STATISTICS
from watchsim.simulation.event_kinds import EventKind


def damped_run(start: float, q_factor: float, swings: int):
    """Released at rest: turns at k pi/w, at start · (-exp(-decay pi/w))^k; passes rest where tan(w t) = -w/decay."""
    decay = 0.5 * OMEGA / q_factor
    w = math.sqrt(OMEGA**2 - decay**2)
    events = Events()
    for k in range(swings):
        crossing = (math.pi - math.atan2(w, decay) + k * math.pi) / w
        oscillator = Oscillator(INERTIA, INERTIA * OMEGA**2, 2.0 * decay * INERTIA)
        q, u = motion(oscillator, start, 0.0, crossing)
        assert abs(q) < 1e-12 * abs(start)
        events.passage(crossing, EventKind.CROSS, u)
        turn = (k + 1) * math.pi / w
        q, u = motion(oscillator, start, 0.0, turn)
        assert abs(u) < 1e-10 * abs(start) * w
        events.passage(turn, EventKind.TURN, q)
    return balance_only(events, swings * math.pi / w), decay, w


def test_a_damped_oscillator():
    run, decay, w = damped_run(-270.0 * DEGREE, 50.0, 21)
    found = beats(run)
    assert len(found) == 20 and found.body == "balance" and found.nominal_period == pytest.approx(PERIOD, rel=1e-14)
    loss = math.exp(-decay * math.pi / w)
    expected = 270.0 * loss ** np.arange(1, 21) * 0.5 * (1.0 + loss)
    assert found.amplitude_deg == pytest.approx(expected, rel=1e-12)
    assert np.isnan(found.period_s[0])
    assert found.period_s[1:] == pytest.approx(math.tau / w, rel=1e-12, abs=0.0)
    # Damping makes it slow by 1/(8 Q²), 4.3 s a day at Q = 50.
    assert found.rate_s_per_d[1:] == pytest.approx(86400.0 * (w / OMEGA - 1.0), abs=1e-7)
    assert found.rate_s_per_d[-1] == pytest.approx(-86400.0 / (8 * 50.0**2), rel=1e-3)
    assert found.beat_error_ms[3:] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_turning_points_need_not_lie_evenly_about_rest(side):
    found = beats(balance_only(steady_swings(8, side * 4.7, offset=0.3), 1.0))
    assert found.amplitude == pytest.approx(4.7) and np.abs(found.end_at[::2] - 0.3) == pytest.approx(4.7)


@pytest.mark.parametrize("off", [1.0, -1.5])
def test_beat_error_of_a_balance_that_is_out_of_beat(off):
    """The fork is met at ±26° from its own line of centres, which lies `off` degrees from the spring's rest."""
    amplitude, events = 270.0 * DEGREE, steady_swings(24, 270.0 * DEGREE)
    for k in range(24):
        way = 1.0 if k % 2 == 0 else -1.0
        entry = math.asin((way * off - 26.0) * DEGREE / amplitude) / OMEGA
        events.touch((k + 0.5) * 0.5 * PERIOD + entry, EventKind.IMPACT, PIN)
    found = beats(balance_only(events, 3.0))
    # (T1 - T2)/2 = 2 asin(off / amplitude) / w to first order in the lift: 0.295 ms for 1° at 270°, 4 Hz.
    first = 1e3 * 2.0 * math.asin(abs(off) / 270.0) / OMEGA
    exact = 1e3 * (math.asin((26.0 + off) / 270.0) - math.asin((26.0 - off) / 270.0)) / OMEGA
    assert found.beat_error_ms[2:] == pytest.approx(abs(exact), rel=1e-10)
    assert abs(exact) == pytest.approx(first, rel=0.01)
    assert found.period_s[2:] == pytest.approx(PERIOD, rel=1e-12)


def test_without_ticks_the_passages_tell_the_beat_error():
    events = Events()
    for k in range(20):
        late = 1e-4 * (k % 2)
        events.passage((k + 0.5) * 0.125 + late, EventKind.CROSS, 100.0 * (-1) ** k)
        events.passage((k + 1) * 0.125, EventKind.TURN, 4.0 * (-1) ** k)
    found = beats(balance_only(events, 2.5))
    assert np.isnan(found.tick).all() and found.beat_error_ms[2:] == pytest.approx(0.1, rel=1e-9)


def test_a_tick_is_the_first_noise_after_a_silence():
    """A knock at the turning point rings on into the next half swing; the fork's rebounds follow the first touch."""
    events = steady_swings(6, 4.7)
    for k in range(6):
        middle = (k + 0.5) * 0.125
        for late in (-4e-3, -3.9e-3, 0.0, 2e-3, 0.0625, 0.0629, 0.0632):
            events.touch(middle + late, EventKind.IMPACT, PIN)
    found = beats(balance_only(events, 0.75))
    assert found.tick == pytest.approx(found.t - 4e-3, abs=1e-12)


@pytest.mark.parametrize(("silence", "heard"), [(0.095, False), (0.105, True)])
def test_a_tenth_of_half_a_period_is_silence(silence, heard):
    """After a knock just before the turning point: what comes sooner rings on from it."""
    events = steady_swings(6, 4.7)
    for k in range(7):
        knock = k * 0.125 - 5e-3
        events.touch(knock, EventKind.IMPACT, PIN)
        events.touch(knock + silence * 0.125, EventKind.IMPACT, PIN)
    found = beats(balance_only(events, 0.75))
    expected = found.start - 5e-3 + silence * 0.125 if heard else found.end - 5e-3
    assert found.tick == pytest.approx(expected, abs=1e-12)


def test_of_several_turns_after_a_knock_the_outermost_counts():
    events = steady_swings(6, 4.7)
    for t in (0.126, 0.127):
        events.passage(t, EventKind.TURN, 4.5)
    found = beats(balance_only(events, 0.75))
    assert len(found) == 5 and found.amplitude == pytest.approx(4.7)


@pytest.mark.parametrize("turns", [0, 1, 2])
def test_too_few_turning_points_give_empty_arrays(turns):
    found = beats(balance_only(steady_swings(turns, 4.7), 1.0))
    assert len(found) == 0
    for name in ("t", "tick", "amplitude_deg", "rate_s_per_d", "beat_error_ms", "period_s"):
        assert getattr(found, name).shape == (0,), name


def test_trembling_that_never_passes_rest_is_no_beat():
    events = Events()
    for k in range(50):
        events.passage(0.01 * k, EventKind.TURN, 0.7 + 0.001 * (-1) ** k)
    assert len(beats(balance_only(events, 1.0))) == 0


def test_another_body_may_be_asked_for():
    scene = lever_scene()
    lever_spring = replace(scene.springs[0], body="lever", stiffness=1e-12 * (math.tau * 10.0) ** 2)
    scene = replace(scene, springs=(*scene.springs, lever_spring))
    events = steady_swings(6, 4.7)
    for k in range(30):
        events.passage(0.05 * k, EventKind.CROSS, 1.0 * (-1) ** k, body=1)
        events.passage(0.05 * k + 0.025, EventKind.TURN, 0.1 * (-1) ** k, body=1)
    run = balance_only(events, 1.5, scene)
    found = beats(run, "lever")
    assert found.nominal_period == pytest.approx(0.1) and found.period_s[2:] == pytest.approx(0.1)
    assert len(beats(run)) == 5
    with pytest.raises(KeyError):
        beats(run, "anchor")
    with pytest.raises(ValueError, match='neither a spring nor gravity pulls "wheel" back'):
        beats(run, "wheel")


def test_a_scene_without_springs_has_no_beats():
    with pytest.raises(ValueError, match="no body of this scene swings on a spring or by gravity"):
        beats(disc_run())


def test_a_sliding_oscillator_has_no_degrees():
    scene = lever_scene()
    balance = replace(scene.bodies[0], motion="slide", mass=INERTIA)
    found = beats(balance_only(steady_swings(6, 1e-3), 1.0, replace(scene, bodies=(balance, *scene.bodies[1:]))))
    assert not found.angular and found.amplitude == pytest.approx(1e-3) and np.isnan(found.amplitude_deg).all()
    assert found.period_s[-1] == pytest.approx(1.0 / HERTZ)


@pytest.mark.parametrize(("counted", "before"), [(70, 61), (5, 0)])
def test_where_not_all_was_kept_only_the_last_stretch_is_told(counted: int, before: int) -> None:
    """Half swings of an eighth of a second; those before the last stretch, from 2 s on, are known by their number."""
    run = balance_only(steady_swings(25, 4.7), 4.0)
    kept = replace(run, keep=STATISTICS, spans=((0.3, 1.1), (1.2, 1.6), (2.0, 3.4)), sums={"half_swings": counted})
    found = beats(kept)
    assert found.start[0] == 2.0 and len(found) == 9 and found.before == before
    assert len(beats(run)) == 24 and beats(replace(run, sums=kept.sums)).before == 0
    assert beats(kept, "balance").before == 0 and beats(replace(kept, spans=())).start[0] == pytest.approx(0.125)


@pytest.mark.parametrize(("amplitude", "count"), [(0.95e-13, 0), (1.05e-13, 7)])
def test_what_moves_by_rounding_does_not_swing(amplitude: float, count: int) -> None:
    assert len(beats(balance_only(steady_swings(8, amplitude), 1.0))) == count
