"""Does the paper of the timegrapher show what the beats are?"""

from __future__ import annotations

import numpy as np
import pytest
from analysis.made_beats import PERIOD, PIN, balance_only, steady_swings
from analysis.made_faults import swiss
from render.figures.read_back import faults

from watchsim.analysis.timegrapher import tape
from watchsim.render.timing_plot import PAPER, plot_tape
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind


def ticking(period: float, late: float = 0.0, count: int = 80):
    """Beats of a period of its own, every other one late (s)."""
    events = steady_swings(count, 4.7, period=period)
    for k in range(count):
        if k % 10 != 3:  # one in ten is not heard
            events.touch((k + 0.5) * 0.5 * period - 4e-3 + late * (k % 2), EventKind.IMPACT, PIN, 1e-9)
    return balance_only(events, count * 0.5 * period)


def test_a_dot_for_each_beat_that_is_heard():
    rate, late = 60.0, 3e-4
    written = tape(ticking(PERIOD / (1.0 + rate / 86400.0), late))
    assert len(written.t) == 71  # of 79 whole half swings
    slope = np.polyfit(written.t[written.forward], written.gain_ms[written.forward], 1)[0]
    assert 86.4 * slope == pytest.approx(rate, rel=1e-3)
    known = np.isfinite(written.rate_s_per_d)
    assert written.rate_s_per_d[known] == pytest.approx(rate, abs=1e-6) and 50 < known.sum() < 60
    assert written.beat_error_ms[np.isfinite(written.beat_error_ms)] == pytest.approx(1e3 * late, abs=1e-9)
    # Two lines, apart by the delay.
    apart = np.interp(written.t, written.t[written.forward], written.gain_ms[written.forward]) - written.gain_ms
    assert apart[~written.forward][1:-1] == pytest.approx(1e3 * late, abs=1e-3)


def test_the_picture_holds_both_traces_and_three_curves():
    run = simulate(swiss(springs_0_rest="1.5°"), 5.0)
    figure = plot_tape(run)
    paper, rate, amplitude, beat_error = figure.axes
    ticks, tocks = (line.get_ydata() for line in paper.get_lines()[:2])
    assert abs(len(ticks) - len(tocks)) <= 1 and np.mean(ticks) - np.mean(tocks) == pytest.approx(0.43, abs=0.01)
    assert "not settled" in figure.texts[-1].get_text()
    assert amplitude.get_lines()[0].get_ydata()[-1] == pytest.approx(275.0, abs=1.5)
    assert rate.get_ylabel() == "rate (s/d)" and beat_error.get_ylabel() == "beat error (ms)"
    few = plot_tape(run, (2.0, 3.0))
    assert sum(len(line.get_xdata()) for line in few.axes[0].get_lines()[:2]) == 8


def test_what_leaves_the_paper_comes_back_on_the_other_side():
    figure = plot_tape(ticking(PERIOD / (1.0 + 100.0 / 86400.0)))
    assert figure.axes[0].get_ylim() != (-0.5 * PAPER, 0.5 * PAPER)
    figure = plot_tape(ticking(PERIOD / (1.0 + 6000.0 / 86400.0)), width=85.0)
    assert figure.axes[0].get_ylim() == (-0.5 * PAPER, 0.5 * PAPER)
    for line in figure.axes[0].get_lines()[:2]:
        assert np.abs(line.get_ydata()).max() <= 0.5 * PAPER
    assert "wrapped" in figure.axes[0].get_title(loc="left")
    assert faults(figure) == []


def test_without_beats_there_is_no_paper():
    with pytest.raises(ValueError, match="no beat of balance is heard"):
        plot_tape(balance_only(steady_swings(20, 4.7), 2.5))
    with pytest.raises(ValueError, match="no beat is heard from 8 s to 9 s"):
        plot_tape(ticking(PERIOD, count=20), (8.0, 9.0))
