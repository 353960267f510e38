"""Would the timegrapher of a watchmaker show this?"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from analysis.made_beats import DEGREE, IMPULSE, LOCKING, OMEGA, PERIOD, PIN, balance_only, lever_run, steady_swings

from watchsim.analysis.timing.beats import beats
from watchsim.analysis.timing.timegrapher import amplitude_deg, intervals, timegrapher
from watchsim.simulation.event_kinds import EventKind


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
        assert shown or "hardly leaves the lift of 52°" in read["message"]


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
