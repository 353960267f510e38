"""Is it foretold where the amplitude settles?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from analysis.made_beats import DEGREE, PERIOD, Events, balance_only

from watchsim.analysis.timing.beats import beats
from watchsim.analysis.verdicts.settling import unsettled
from watchsim.analysis.verdicts.watch import watch_of
from watchsim.simulation.event_kinds import EventKind


def swung(amplitude, count=160):
    return told(amplitude, count)[1]


def told(amplitude, count=160):
    """Half swings of amplitude(t) degrees, and what is said of them."""
    events = Events()
    for k in range(count):
        way = 1.0 if k % 2 == 0 else -1.0
        middle, end = (k + 0.5) * 0.5 * PERIOD, (k + 1) * 0.5 * PERIOD
        events.passage(middle, EventKind.CROSS, way)
        events.passage(end, EventKind.TURN, way * amplitude(end) * DEGREE)
    run = balance_only(events, count * 0.5 * PERIOD)
    return run, unsettled(watch_of(run, beats(run)))


@pytest.mark.parametrize(("start", "goal", "constant"), [(200.0, 280.0, 8.0), (300.0, 260.0, 20.0), (100.0, 240.0, 5.0)])
def test_an_exponential_is_followed_to_its_end(start, goal, constant):
    said = swung(lambda t: goal + (start - goal) * math.exp(-t / constant))
    word = "rises" if goal > start else "falls"
    assert said.name == "unsettled" and said.works and word in said.message
    told = float(said.message.split("about ")[1].split("°")[0])
    assert told == pytest.approx(goal, abs=0.6)


def test_what_has_settled_has_settled():
    assert swung(lambda t: 280.0 + 80.0 * math.exp(-t / 2.0)) is None
    assert swung(lambda t: 280.0) is None


def test_a_wheel_out_of_round_is_no_drift():
    """Fifteen oscillations to a turn: the amplitude goes up and down for ever."""
    assert swung(lambda t: 280.0 + 2.0 * math.sin(math.tau * t / (15.0 * PERIOD)), 480) is None


def test_chance_is_no_drift():
    rng = np.random.default_rng(3)
    assert sum(swung(lambda t: 280.0 + rng.normal(0.0, 1.0)) is not None for _ in range(40)) <= 2


def test_a_steady_loss_has_no_end_foretold():
    said = swung(lambda t: 280.0 - 3.0 * t)
    assert "falls by 3° per second" in said.message and "on its way" not in said.message


@pytest.mark.parametrize(("start", "goal", "said"), [(2.0, 2.12, "about 2.12°"), (200.0, 280.0, "about 280°")])
def test_where_it_goes_is_said_as_exactly_as_it_differs(start, goal, said):
    found = swung(lambda t: goal + (start - goal) * math.exp(-t / 8.0), 80)
    assert said in found.message, found.message


def test_a_drift_counts_beyond_three_standard_errors():
    """Told by a regression of another make: of means over an oscillation about the straight line through each stretch."""
    known, noise = {}, np.random.default_rng(5).normal(0.0, 1.0, 161)
    for scatter in np.linspace(1.5, 5.0, 36):
        run, said = told(lambda t, by=scatter: 280.0 - 0.02 * t * t + by * noise[round(2.0 * t / PERIOD)])
        stretches = np.split(beats(run).amplitude_deg[-120:].reshape(-1, 2).mean(axis=1), 3)
        off = np.concatenate([part - np.polyval(np.polyfit(range(20), part, 1), range(20)) for part in stretches])
        error = math.sqrt(2.0 / 20.0 * np.mean(off**2))
        known[abs(stretches[2].mean() - stretches[1].mean()) / error] = said is not None
    assert [drifts for errors, drifts in known.items() if 2.4 < errors < 3.0].count(False) > 2
    assert [drifts for errors, drifts in known.items() if 3.0 < errors < 3.6].count(True) > 2
    assert all(drifts == (errors > 3.0) for errors, drifts in known.items())
