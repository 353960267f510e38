"""Do averages come with errors that mean something?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from analysis.made_beats import DEGREE, PERIOD, Events, balance_only, steady_swings
from render.fake_runs import disc_run

from watchsim.analysis.timing.averages import averages, headline, last_window, mean_and_error, mean_over
from watchsim.analysis.timing.beats import beats
from watchsim.simulation.event_kinds import EventKind


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
