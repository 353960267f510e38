"""Are amplitude, rate and beat error those of motions that are known exactly?"""

import json
import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import (
    DEGREE,
    HERTZ,
    IMPULSE,
    INERTIA,
    LOCKING,
    OMEGA,
    PERIOD,
    PIN,
    Events,
    balance_only,
    lever_run,
    lever_scene,
    steady_swings,
)
from reference.oscillator import Oscillator, motion
from render.fake_runs import disc_run
from scipy.special import ellipk

from watchsim.analysis.summary import summary, summary_text
from watchsim.analysis.timegrapher import amplitude_deg, intervals, timegrapher
from watchsim.analysis.timing import DAY, averages, beats, headline, last_window, mean_and_error, mean_over, whole_run
from watchsim.cli import main
from watchsim.commands.console import FINE
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.scene import STATISTICS
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind

# Are amplitude, rate and beat error those of motions that are known exactly?


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


# Do averages come with errors that mean something?


def test_a_steady_watch():
    period = PERIOD * (1.0 + 10.0 / 86400.0)
    means = headline(balance_only(steady_swings(80, 290.0 * DEGREE, period=period), 10.0))
    assert (means.start_s, means.end_s, means.beats) == (8.0, 10.0, 16)
    assert means.amplitude_deg == pytest.approx(290.0, rel=1e-12) and means.amplitude_deg_error < 1e-9
    assert means.period_s == pytest.approx(period, rel=1e-12, abs=0.0) and means.period_s_error < 1e-13
    assert means.rate_s_per_d == pytest.approx(-10.0, abs=2e-3) and means.beat_error_ms == pytest.approx(0.0, abs=1e-9)


def test_both_directions_may_differ_without_counting_as_scatter():
    """Half periods of 124.9 and 125.1 ms: that is a beat error, not an uncertainty of the period."""
    events = Events()
    for k in range(80):
        events.passage(0.125 * k + 1e-4 * (k % 2), EventKind.CROSS, 100.0 * (-1) ** k)
        events.passage(0.125 * k + 0.0625, EventKind.TURN, 5.0 * (-1) ** k)
    means = mean_over(balance_only(events, 10.0), (4.0, 9.0))
    assert means.beat_error_ms == pytest.approx(0.1, rel=1e-9) and means.beat_error_ms_error < 1e-9
    assert means.period_s == pytest.approx(0.25) and means.period_s_error < 1e-12


def test_chance_is_no_beat_error_and_its_error_is_the_standard_error():
    """Ticks scattered by 0.1 ms: (T1 - T2)/2 averages out, and the errors have the size statistics gives."""
    random, spread = np.random.default_rng(5), 1e-4
    events, jitter = Events(), spread * random.standard_normal(4000)
    for k in range(4000):
        events.passage(0.125 * k + jitter[k], EventKind.CROSS, 100.0 * (-1) ** k)
        events.passage(0.125 * k + 0.0625, EventKind.TURN, (5.0 + 0.01 * random.standard_normal()) * (-1) ** k)
    means = mean_over(balance_only(events, 500.0), (0.0, 500.0))
    assert means.beat_error_ms < 4e-3
    assert abs(means.amplitude_deg - math.degrees(5.0)) < 4.0 * means.amplitude_deg_error
    # Neighbouring beats share a turning point, which the pairing does not undo wholly: a factor below 2.
    standard = math.degrees(0.01) / math.sqrt(4000)
    assert 0.5 * standard < means.amplitude_deg_error < 3.0 * standard


def test_a_drift_shows_in_the_error():
    values = np.linspace(0.0, 1.0, 100)
    mean, error = mean_and_error(values)
    assert mean == pytest.approx(0.5) and error == pytest.approx(0.5, rel=0.05)


def test_too_few_values():
    assert mean_and_error(np.array([np.nan])) == (None, None)
    assert mean_and_error(np.array([1.0, np.nan, 3.0])) == (2.0, None)
    means = averages(beats(balance_only(Events(), 1.0)), (0.0, 1.0))
    assert means.beats == 0 and means.amplitude_deg is None and means.rate_s_per_d_error is None


def test_a_window_takes_the_beats_inside_it():
    events = steady_swings(80, 290.0 * DEGREE)
    later = [row for row in steady_swings(80, 250.0 * DEGREE).rows if row[0] > 5.0]
    events.rows = [row for row in events.rows if row[0] <= 5.0] + later
    run = balance_only(events, 10.0)
    assert mean_over(run, (1.0, 4.9)).amplitude_deg == pytest.approx(290.0)
    assert mean_over(run, (5.5, 9.0)).amplitude_deg == pytest.approx(250.0)


@pytest.mark.parametrize(
    ("duration", "period", "window"),
    [
        (60.0, 0.25, (58.0, 60.0)),  # usual
        (3.0, 0.25, (2.0, 3.0)),  # a third
        (1.2, 0.25, (0.45, 1.2)),  # three periods
        (0.5, 0.25, (0.0, 0.5)),  # all there is
        (300.0, 2.0, (284.0, 300.0)),  # eight periods of a pendulum
    ],
)
def test_the_last_window(duration, period, window):
    assert last_window(balance_only(Events(), duration), period) == pytest.approx(window)


def test_nothing_that_swings_has_no_headline():
    assert headline(disc_run()) is None


# Would the timegrapher of a watchmaker show this?


def heard_run(amplitude: float, lock_at: float, noises=()):
    """A at -26°, B, C at `lock_at` degrees of the balance, and more noises (place in degrees, energy)."""
    events = steady_swings(40, amplitude * DEGREE)
    for k in range(40):
        middle = (k + 0.5) * 0.5 * PERIOD
        for pair, place, lost in ((PIN, -26.0, 1e-9), (IMPULSE, -8.0, 5e-9), (LOCKING, lock_at, 2e-8), *noises):
            events.touch(middle + math.asin(place / amplitude) / OMEGA, EventKind.IMPACT, pair, lost)
    return balance_only(events, 5.0)


@pytest.mark.parametrize("amplitude", [180.0, 270.0, 310.0])
def test_a_lock_at_the_end_of_the_lift_gives_the_true_amplitude(amplitude):
    """Δt = 2 asin(λ/2A)/ω makes λ/(2 sin(π f Δt)) the amplitude itself."""
    run = heard_run(amplitude, 26.0)
    read = timegrapher(run, beats(run))
    assert read["lift_angle_deg"] == pytest.approx(52.0)
    assert read["amplitude_deg"] == pytest.approx(amplitude, rel=1e-9)
    assert read["rate_s_per_d"] == pytest.approx(0.0, abs=1e-6) and read["beat_error_ms"] == pytest.approx(0.0, abs=1e-9)


def test_intervals_of_the_watchmakers_table():
    """4 Hz, lift 52°, 270°: 7.67 ms; 3.5 Hz, lift 38°, 220°: 7.86 ms."""
    run = heard_run(270.0, 26.0)
    assert timegrapher(run, beats(run))["interval_ms"] == pytest.approx(7.67, abs=0.006)
    assert amplitude_deg(38.0 * DEGREE, 7.86e-3, 1.0 / 3.5) == pytest.approx(220.0, abs=0.2)


def test_an_early_lock_reads_high():
    """Lock at 20.8° instead of 26°: a published model reads 12 % high for the same reason."""
    run = heard_run(270.0, 20.8)
    assert timegrapher(run, beats(run))["amplitude_deg"] == pytest.approx(300.0, abs=3.0)


def test_rebounds_and_knocks_do_not_count_as_lock():
    clean, noisy = (
        heard_run(270.0, 22.0),
        heard_run(270.0, 22.0, ((LOCKING, 22.2, 5e-9), (LOCKING, 23.0, 8e-10), (PIN, 269.0, 1e-7))),
    )
    assert intervals(noisy, beats(noisy)) == pytest.approx(intervals(clean, beats(clean)), rel=1e-12)


def test_what_cannot_be_heard():
    run = balance_only(steady_swings(40, 4.7), 5.0)
    assert timegrapher(run, beats(run)) is None
    assert amplitude_deg(None, 1e-3, 0.25) is None and amplitude_deg(0.9, None, 0.25) is None
    assert amplitude_deg(0.9, 0.2, 0.25) is None


def test_one_noise_per_beat_gives_a_rate_but_no_amplitude():
    events = steady_swings(40, 4.7)
    for k in range(40):
        events.touch((k + 0.5) * 0.125 - 4e-3, EventKind.IMPACT, PIN, 1e-9)
    run = balance_only(events, 5.0)
    read = timegrapher(run, beats(run))
    assert (
        read["amplitude_deg"] is None and read["interval_ms"] is None and read["rate_s_per_d"] == pytest.approx(0.0, abs=1e-6)
    )


def test_the_made_lever():
    run = lever_run(24)
    found = beats(run)
    expected = [(math.asin(22.5 / 270.0) + math.asin(26.0 / 270.0)) / OMEGA] * len(found)
    assert intervals(run, found) == pytest.approx(expected, rel=1e-9) and np.isfinite(found.tick).all()


@pytest.mark.parametrize(("share", "heard"), [(0.9, True), (0.4, True), (0.3, False)])
def test_a_noise_counts_from_a_third_of_the_loudest_on(share, heard):
    """A second knock after the lock: from one third of its energy on it is the last loud noise of the beat."""
    run = heard_run(270.0, 20.0, ((IMPULSE, 24.0, share * 2e-8),))
    last = 24.0 if heard else 20.0
    expected = (math.asin(26.0 / 270.0) + math.asin(last / 270.0)) / OMEGA
    assert intervals(run, beats(run)) == pytest.approx(expected, rel=1e-9)


def test_a_swing_that_hardly_leaves_the_lift_has_no_reading():
    """Instruments show nothing below some 80°; λ = 52°."""
    for amplitude, shown in ((77.0, False), (79.0, True)):
        run = heard_run(amplitude, 26.0)
        read = timegrapher(run, beats(run))
        assert (read["amplitude_deg"] is not None) == shown
        assert shown or "barely larger than the lift angle of 52°" in read["message"]


def test_a_last_noise_that_wanders_gives_no_amplitude():
    steady, wandering = heard_run(270.0, 22.0), steady_swings(40, 270.0 * DEGREE)
    for k in range(40):
        middle = (k + 0.5) * 0.5 * PERIOD
        for pair, place, lost in ((PIN, -26.0, 1e-9), (LOCKING, (-10.0, 26.0)[k % 3 == 0], 2e-8)):
            wandering.touch(middle + math.asin(place / 270.0) / OMEGA, EventKind.IMPACT, pair, lost)
    read = timegrapher(balance_only(wandering, 5.0), beats(balance_only(wandering, 5.0)))
    assert read["amplitude_deg"] is None and "at another time in each beat" in read["message"]
    assert "so it reads high" in timegrapher(steady, beats(steady))["message"]
    exact = heard_run(270.0, 26.0)
    assert timegrapher(exact, beats(exact))["message"] is None


def test_intervals_of_chosen_beats_need_no_others() -> None:
    """Also where a chosen one was not heard."""
    run = heard_run(270.0, 20.8)
    found = beats(run)
    tick = found.tick.copy()
    tick[[3, 11]] = np.nan
    chosen = np.isin(np.arange(len(found)), [2, 3, 5, 6])
    every = intervals(run, replace(found, tick=tick))
    assert np.flatnonzero(np.isnan(every)).tolist() == [3, 11]
    assert np.array_equal(intervals(run, replace(found, tick=tick), chosen), every[chosen], equal_nan=True)


# Are the statistics of a whole run those of its half swings, made from sums alone?

NOMINAL = 0.25


def sums(values: np.ndarray) -> dict[str, float]:
    """What is kept of a row of values; `squares` are those of the distances from the mean."""
    squares = float(np.sum((values - values.mean()) ** 2))
    return {
        **{"number": float(len(values)), "mean": float(values.mean()), "squares": squares},
        **{"least": float(values.min()), "largest": float(values.max())},
    }


def told(kept: dict[str, object], angular: bool = True) -> dict[str, Any] | None:
    run: Any = SimpleNamespace(sums=kept)
    found: Any = SimpleNamespace(angular=angular, nominal_period=NOMINAL)
    return whole_run(run, found)


@pytest.mark.parametrize("count", [2, 3, 40])
def test_means_and_standard_deviations(count: int) -> None:
    rng = np.random.default_rng(count)
    amplitude, period = rng.uniform(4.0, 5.0, count), rng.uniform(0.2499, 0.2502, count)
    kept = {"half_swings": count, "ticks": 0, "amplitude": sums(amplitude), "period": sums(period), "uneven_passages": None}
    found = told(kept)
    assert found is not None and found["beats"] == count and found["beat_error_ms"] is None
    for key, values in (("amplitude_deg", np.degrees(amplitude)), ("period_s", period)):
        expected = {"mean": values.mean(), "spread": values.std(ddof=1), "least": values.min(), "largest": values.max()}
        assert found[key] == pytest.approx(expected, rel=1e-12)
    assert found["rate_s_per_d"] == pytest.approx(86400.0 * (NOMINAL / period.mean() - 1.0), rel=1e-9)
    slides = told(kept, angular=False)
    assert slides is not None and slides["amplitude_deg"] is None and slides["period_s"] == found["period_s"]


@pytest.mark.parametrize(("ticks", "expected"), [(80, 3.0), (79, 1.5)])
def test_the_beat_error_is_heard_where_most_beats_tick(ticks: int, expected: float) -> None:
    """Half of the mean difference of the two half periods, whatever its sign; where less than 80 % tick, of the passages."""
    uneven = {"uneven_ticks": {"mean": -6e-3}, "uneven_passages": {"mean": 3e-3}}
    found = told({"half_swings": 100, "ticks": ticks, "amplitude": None, "period": None, **uneven})
    assert found is not None and found["beat_error_ms"] == pytest.approx(expected)
    assert found["amplitude_deg"] is found["period_s"] is found["rate_s_per_d"] is None


def test_a_single_half_swing_has_no_spread_and_none_no_statistics() -> None:
    one = told({"half_swings": 1, "ticks": 0, "amplitude": sums(np.array([math.pi])), "period": None, "uneven_passages": None})
    assert one is not None and one["amplitude_deg"] == pytest.approx({"mean": 180, "spread": 0, "least": 180, "largest": 180})
    assert told({}) is None and told({"half_swings": 0}) is None


# Is a pendulum told of as a clock's: amplitude, circular error, decay, beat error, against exact solutions?

TEXT = """
[scene]
schema = 1
gravity = ["0 m/s²", "-9.81 m/s²"]
[bodies.pendulum]
circle = "20 mm"
pivot = ["0 mm", "250 mm"]
mass = "0.5 kg"
angle = "{angle}°"
{more}
[run]
duration = "{duration} s"
"""
LENGTH, RADIUS = 0.25, 0.02
SMALL = math.tau * math.sqrt((LENGTH**2 + 0.5 * RADIUS**2) / (9.81 * LENGTH))


def pendulum(folder: Path, angle: float, duration: float = 12.0, more: str = ""):
    (folder / "scene.toml").write_text(TEXT.format(angle=angle, duration=duration, more=more), encoding="utf-8")
    return load(folder)


@pytest.mark.parametrize("method, allowed", [("pfeiffer-glocker", 1e-3), ("moreau", 0.3)])
@pytest.mark.parametrize("angle", [3.0, 40.0])
def test_circular_error(angle: float, method: str, allowed: float, tmp_path: Path) -> None:
    """T = 4 K(sin(A/2)) / w: the complete elliptic integral."""
    step = 1e-4 if method == "moreau" else None
    numbers = summary(simulate(pendulum(tmp_path, angle), method=method, step=step))
    period = SMALL * 2.0 / math.pi * float(ellipk(math.sin(0.5 * math.radians(angle)) ** 2))
    assert numbers["amplitude_deg"] == pytest.approx(angle, rel=1e-6 if method != "moreau" else 1e-4)
    assert numbers["rate_s_per_d"] == pytest.approx(DAY * (SMALL / period - 1.0), abs=allowed)
    assert numbers["beat_error_ms"] == pytest.approx(0.0, abs=1e-2)
    assert numbers["timing_message"] is None


def test_decay_by_the_quality_factor(tmp_path: Path) -> None:
    more = '[[damping]]\nbody = "pendulum"\nq_factor = 100\n'
    found = beats(simulate(pendulum(tmp_path, 1.0, 12.0, more)))
    ratio = math.exp(-0.5 * math.pi / 100.0)  # from one half swing to the next, at small angles
    assert found.amplitude[1:] / found.amplitude[:-1] == pytest.approx(ratio, rel=1e-5)


def test_out_of_beat_against_a_stop_of_its_own(tmp_path: Path) -> None:
    """Hung askew, its rest position is where gravity pulls it, not the angle zero of the drawing."""
    more = ""
    scene = pendulum(tmp_path, 10.0, 12.0, more).set("bodies.pendulum.pivot", [0.15, 0.2])
    run = simulate(scene)
    found = beats(run)
    rest = math.atan2(0.15, 0.2)  # the centre of mass lies at (-150, -200) mm from the pivot
    assert found.amplitude_deg == pytest.approx(abs(10.0 - math.degrees(rest)), rel=1e-6)
    assert found.beat_error_ms[3:] == pytest.approx(0.0, abs=1e-4)


def test_spring_and_gravity_together(tmp_path: Path) -> None:
    more = '[[springs]]\nbody = "pendulum"\nstiffness = "2 N·m/rad"\nrest = "0°"\n'
    found = beats(simulate(pendulum(tmp_path, 0.05, 6.0, more)))
    inertia = 0.5 * (LENGTH**2 + 0.5 * RADIUS**2)
    assert found.period_s[2:] == pytest.approx(math.tau * math.sqrt(inertia / (2.0 + 0.5 * 9.81 * LENGTH)), rel=1e-6)


@pytest.mark.parametrize(
    ("angle", "duration", "change", "words"),
    [
        (3.0, 0.4, "", "no amplitude and rate: the run of 0.4 s is too short: pendulum needs 2.0"),
        (3.0, 12.0, "damped", "no amplitude and rate: pendulum never passed its rest position"),
        (3.0, 5.0, "gravity", "no amplitude and rate: no body has a spring, and there is no gravity"),
        (3.0, 5.0, "inertia", "no body has a spring, and none that is not driven hangs beside its pivot"),
    ],
)
def test_without_amplitude_or_rate_it_says_why(angle: float, duration: float, change: str, words: str, tmp_path: Path) -> None:
    more = '[[damping]]\nbody = "pendulum"\nq_factor = 0.3\n' if change == "damped" else ""
    scene = pendulum(tmp_path, angle, duration, more)
    if change == "gravity":
        scene = scene.set("scene.gravity", [0.0, 0.0])
    if change == "inertia":
        text = (tmp_path / "scene.toml").read_text(encoding="utf-8")
        (tmp_path / "scene.toml").write_text(text.replace('mass = "0.5 kg"', 'inertia = "1 g·cm²"'), encoding="utf-8")
        scene = load(tmp_path)
    run = simulate(scene)
    assert words in summary(run)["timing_message"] and words in summary_text(run)


def test_the_commands_tell_of_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pendulum(tmp_path, 3.0)
    assert main(["run", str(tmp_path), "--no-plots", "-o", str(tmp_path / "out")]) == FINE
    said = capsys.readouterr()
    assert "amplitude    3.000" in said.out and "rate         −14.8" in said.out
    assert "frequency" in said.out and "Note:" not in said.err
    assert (tmp_path / "out" / "beats.csv").is_file()
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["notes"] == []


def test_a_clock_that_hangs_still_has_no_rate(tmp_path: Path) -> None:
    """Gravity's rounding makes it swing by less than can be told."""
    place = tmp_path / "scene.toml"
    place.write_text(TEXT.format(angle=0, duration=10, more=""), encoding="utf-8")
    run = simulate(load(place))
    numbers = summary(run)
    assert len(beats(run)) == 0 and numbers["amplitude_deg"] is None and numbers["rate_s_per_d"] is None
    assert "pendulum stays in its rest position" in summary_text(run) or "never passed its rest position" in summary_text(run)


def test_what_is_not_read_causes_no_second_complaint(tmp_path: Path) -> None:
    place = tmp_path / "scene.toml"
    more = '[[damping]]\nbody = "pendulum"\nq_factor = 100'
    text = TEXT.format(angle=5, duration=1, more=more).replace('pivot = ["0 mm", "250 mm"]', 'pivot = ["0", "250 mm"]')
    place.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as told:
        load(place)
    assert "a bare number needs a unit here" in str(told.value) and "quality factor" not in str(told.value)
