"""Are averages, errors and readings those of the numbers that made-up half swings have?"""

from __future__ import annotations

import math
import statistics
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timing import averages as averaging
from watchsim.analysis.timing import timegrapher as hearing
from watchsim.analysis.timing.averages import averages, last_window, mean_and_error, mean_over
from watchsim.analysis.timing.beats import Beats, beats_within
from watchsim.analysis.timing.timegrapher import amplitude_deg, intervals, noises, timegrapher
from watchsim.simulation.event_kinds import EventKind

RNG = np.random.default_rng(12)
NOMINAL = 0.4


def made(count: int = 24, **changed: Any) -> Beats:
    """Half swings that differ in length, size and direction, from 1 s on; the first has no period."""
    t = 1.0 + 0.5 * NOMINAL * np.arange(count) + 1e-3 * RNG.uniform(-1.0, 1.0, count)
    turns: Any = 0.9 + 0.5 * NOMINAL * np.arange(count + 1)
    places = np.array([1.0, -1.0] * count)[: count + 1] * (2.0 + 0.1 * RNG.uniform(-1.0, 1.0, count + 1))
    two_before = np.concatenate(([np.nan, np.nan], t))[:count]
    whole = Beats("balance", True, NOMINAL, t, turns[:-1], turns[1:], places[:-1], places[1:], t - 1e-3, t - two_before)
    return replace(whole, **changed)


def by_hand(values: list[float]) -> tuple[float, float]:
    """Mean and its error: the scatter of the means of two neighbours, the odd first left out, and their drift."""
    pairs = [(a + b) / 2.0 for a, b in zip(values[len(values) % 2 :: 2], values[len(values) % 2 + 1 :: 2], strict=True)]
    half = len(pairs) // 2
    drift = statistics.fmean(pairs[len(pairs) - half :]) - statistics.fmean(pairs[:half])
    return statistics.fmean(values), math.sqrt(statistics.variance(pairs) / len(pairs) + drift**2)


@pytest.mark.parametrize("count", [4, 5, 6, 7, 8, 11])
def test_means_and_their_errors(count: int) -> None:
    values = RNG.normal(3.0, 1.0, count)
    assert mean_and_error(values) == pytest.approx(by_hand(values.tolist()), rel=1e-12, abs=0.0)
    gaps = np.insert(values, [0, 2, count], [np.nan, np.inf, np.nan])
    assert mean_and_error(gaps) == mean_and_error(values)
    assert mean_and_error(values[:3]) == (pytest.approx(values[:3].mean()), None)
    assert mean_and_error(values[:1]) == (values[0], None) and mean_and_error(values[:0]) == (None, None)


def test_averages_over_a_window() -> None:
    found = made()
    start, end = float(found.t[3]), float(found.t[17])  # both count
    means = averages(found, (start, end))
    swings = [0.5 * abs(a - b) * 180.0 / math.pi for a, b in zip(found.end_at[3:18], found.start_at[3:18], strict=True)]
    assert (means.start_s, means.end_s, means.beats) == (start, end, 15)
    assert (means.amplitude_deg, means.amplitude_deg_error) == pytest.approx(by_hand(swings), rel=1e-11)
    # A period is known from its second passage on, and both must lie in the window.
    periods = [float(found.t[k] - found.t[k - 2]) for k in range(5, 18)]
    period, error = by_hand(periods)
    assert (means.period_s, means.period_s_error) == pytest.approx((period, error), rel=1e-9, abs=0.0)
    rates = [86400.0 * (NOMINAL - one) / one for one in (period, period + 1e-6, period - 1e-6)]
    assert means.rate_s_per_d == pytest.approx(rates[0], rel=1e-9)
    assert means.rate_s_per_d_error == pytest.approx(abs(rates[2] - rates[1]) / 2e-6 * error, rel=1e-6)
    # Half the difference of two half periods, ms, by the ticks, as seen from one direction of swing.
    ticks = found.tick.tolist()
    uneven = [500.0 * ((ticks[k] - ticks[k - 1]) - (ticks[k - 1] - ticks[k - 2])) * (-1.0) ** k for k in range(3, 18)]
    mean, error = by_hand(uneven)
    assert means.beat_error_ms == pytest.approx(abs(mean), rel=1e-9)
    assert means.beat_error_ms_error == pytest.approx(error, rel=1e-9)


def test_a_window_that_holds_too_little() -> None:
    found = made()
    nothing = averages(found, (90.0, 99.0))
    assert nothing.beats == 0 and nothing.amplitude_deg is None and nothing.rate_s_per_d is None
    assert nothing.period_s_error is None and nothing.rate_s_per_d_error is None and nothing.beat_error_ms is None
    few = averages(found, (found.t[3] - 1e-6, found.t[6] + 1e-6))
    assert few.beats == 4 and few.amplitude_deg_error is not None
    assert few.period_s == pytest.approx(np.mean(found.period_s[5:7])) and few.period_s_error is few.rate_s_per_d_error is None
    sliding = averages(replace(found, angular=False), (0.0, 99.0))
    assert sliding.amplitude_deg is None and sliding.rate_s_per_d is not None


@pytest.mark.parametrize(
    ("simulated", "period", "start"),
    [
        (60.0, 0.1, 58.0), (60.0, 0.25, 58.0), (60.0, 0.3, 57.6), (60.0, 1.0, 52.0), (3.0, 0.25, 2.0),
        (1.5, 0.25, 0.75), (0.7, 0.25, 0.0), (9.0, 1.0, 6.0), (6.0, 0.25, 4.0), (5.7, 0.25, 3.8),
    ],
)  # fmt: skip
def test_the_last_window(simulated: float, period: float, start: float) -> None:
    """2 s or eight periods, a third of a short run, three periods in any case."""
    run: Any = SimpleNamespace(simulated=simulated)
    assert last_window(run, period) == pytest.approx((start, simulated), abs=1e-12)


def test_a_window_may_be_named(monkeypatch: pytest.MonkeyPatch) -> None:
    found = made()
    monkeypatch.setattr(averaging, "beats", lambda run, body=None: found)
    run: Any = SimpleNamespace(simulated=5.6)
    assert mean_over(run, (2.0, 3.0)) == averages(found, (2.0, 3.0))
    assert mean_over(run) == averages(found, last_window(run, NOMINAL))


def test_what_beats_say_of_themselves() -> None:
    found = made(6)
    assert found.amplitude == pytest.approx(0.5 * (np.abs(found.end_at) + np.abs(found.start_at)))
    assert found.half_period_s[1:] == pytest.approx(found.tick[1:] - found.tick[:-1]) and np.isnan(found.half_period_s[0])
    halves = np.diff(found.tick)
    assert found.beat_error_ms[2:] == pytest.approx(500.0 * np.abs(halves[1:] - halves[:-1]))
    assert np.isnan(found.beat_error_ms[:2]).all()
    angle, rate, error = found.amplitude_deg[-1], found.rate_s_per_d[-1], found.beat_error_ms[-1]
    ends = f"{found.start[0]:.6g} s to {found.end[-1]:.6g} s"
    tail = f"{rate:.2f} s/d, beat error {error:.2g} ms>"
    assert repr(found) == f"<Beats of 'balance': 6 half swings from {ends}; the last one {angle:.2f}°, {tail}"
    sliding = repr(replace(found, angular=False))
    assert f"the last one {1e3 * found.amplitude[-1]:.4g} mm" in sliding
    assert "1 half swing from" in repr(beats_within(made(1), (0.0, 9.0)))
    empty = beats_within(found, (90.0, 99.0))
    nothing = np.zeros(0)
    assert repr(replace(empty, t=nothing, start=nothing, end=nothing, tick=nothing)) == "<Beats of 'balance': 0 half swings>"


@pytest.mark.parametrize(("silent", "heard"), [(4, True), (5, False)])
def test_beat_errors_are_those_of_ticks_where_four_of_five_are_heard(silent: int, heard: bool) -> None:
    found = made(20)
    tick = found.tick.copy()
    tick[:silent] = np.nan
    assert np.array_equal(replace(found, tick=tick).mark, tick if heard else found.t, equal_nan=True)


WINDOWS = [((1.45, 1.95), (1, 7)), ((0.0, 0.8), (0, 1)), ((1.15, 1.25), (0, 3)), ((5.0, 9.0), (19, 20))]


@pytest.mark.parametrize(("window", "kept"), WINDOWS)
def test_half_swings_of_a_window_and_one_beside_it(window: tuple[float, float], kept: tuple[int, int]) -> None:
    """Half swings begin at 0.9, 1.1, ... s."""
    found = replace(made(20), before=5)
    part = beats_within(found, window)
    assert part.t.tolist() == found.t[slice(*kept)].tolist() and part.before == 5 + kept[0]
    assert beats_within(made(20), window).before == kept[0]


def heard(monkeypatch: pytest.MonkeyPatch, found: Beats, after: list[float], **changed: Any) -> Any:
    """The reading where a loud noise follows each tick after so long, and 5 ms later one that has less than a third of it."""
    late, share = np.resize(after, len(found)), changed.pop("share", 0.099)
    times = np.concatenate([found.tick, found.tick + late, found.tick + late + 5e-3])
    energies = np.repeat([1.0, 0.3, share], len(found))
    order = np.argsort(times)
    monkeypatch.setattr(hearing, "noises", lambda run, start=-np.inf, end=np.inf: (times[order], energies[order]))
    scene = SimpleNamespace(lift_angle=changed.pop("lift_angle", math.radians(52.0)))
    run: Any = SimpleNamespace(scene=scene, simulated=5.6, **changed)
    return timegrapher(run, found, (1.5, 5.0))


def test_what_an_instrument_reads(monkeypatch: pytest.MonkeyPatch) -> None:
    """λ / (2 sin(π Δt / T)), from the first noise to the last that has a third of the energy of the loudest after it."""
    found = made()
    told = heard(monkeypatch, found, [0.011, 0.013])
    inside = (found.tick >= 1.5) & (found.tick <= 5.0)
    interval = float(np.mean(np.resize([0.011, 0.013], len(found))[inside]))
    assert told["interval_ms"] == pytest.approx(1e3 * interval, rel=1e-6) and told["lift_angle_deg"] == pytest.approx(52.0)
    assert told["amplitude_deg"] == pytest.approx(26.0 / math.sin(math.pi * interval / NOMINAL), rel=1e-6)
    first = int(np.flatnonzero(inside)[0])
    last = int(np.flatnonzero(inside)[-1])
    periods = [found.tick[k] - found.tick[k - 2] for k in range(first + 2, last + 1)]
    assert told["rate_s_per_d"] == pytest.approx(86400.0 * (NOMINAL / float(np.mean(periods)) - 1.0), rel=1e-6)
    assert told["beat_error_ms"] == averages(found, (1.5, 5.0)).beat_error_ms
    later = heard(monkeypatch, found, [0.011, 0.013], share=0.101)
    assert later["interval_ms"] == pytest.approx(1e3 * interval + 5.0, rel=1e-6)
    assert told["message"].endswith(
        "after the lift is over, so it reads low" if told["amplitude_deg"] < 114.0 else "reads high"
    )


def test_why_it_reads_something_else(monkeypatch: pytest.MonkeyPatch) -> None:
    found = made()
    true = averages(found, (1.5, 5.0)).amplitude_deg
    assert true is not None
    for shift, words in ((0.6, "so it reads high"), (-0.6, "so it reads low"), (0.4, None), (-0.4, None)):
        after = NOMINAL / math.pi * math.asin(26.0 / (true + shift))
        message = heard(monkeypatch, found, [after])["message"]
        assert message is None if words is None else message.endswith(words)
    unknown = heard(monkeypatch, found, [0.01], lift_angle=None)
    assert unknown["amplitude_deg"] is unknown["lift_angle_deg"] is unknown["message"] is None


@pytest.mark.parametrize(("lifts", "refused"), [(1.49, True), (1.51, False)])
def test_a_swing_that_hardly_leaves_the_lift(monkeypatch: pytest.MonkeyPatch, lifts: float, refused: bool) -> None:
    found = made()
    true = averages(found, (1.5, 5.0)).amplitude_deg
    assert true is not None
    told = heard(monkeypatch, found, [0.05], lift_angle=math.radians(true / lifts))
    assert (told["amplitude_deg"] is None) is refused and ("hardly leaves the lift" in str(told["message"])) is refused


@pytest.mark.parametrize(("spread", "refused"), [(0.19, False), (0.21, True)])
def test_noises_that_come_at_another_time_each(monkeypatch: pytest.MonkeyPatch, spread: float, refused: bool) -> None:
    """A scatter beyond a fifth."""
    found = made(18)
    told = heard(monkeypatch, found, [0.02 * (1.0 - spread), 0.02 * (1.0 + spread)])
    assert ("at another time in each beat" in str(told["message"])) is refused and (told["amplitude_deg"] is None) is refused


@pytest.mark.parametrize(("interval", "known"), [(0.0, False), (1e-6, True), (0.199, True), (0.2, False)])
def test_intervals_that_a_swing_may_have(interval: float, known: bool) -> None:
    assert (amplitude_deg(1.0, interval, NOMINAL) is not None) is known
    assert amplitude_deg(None, 0.1, NOMINAL) is None and amplitude_deg(1.0, None, NOMINAL) is None


def test_which_noise_ends_a_beat(monkeypatch: pytest.MonkeyPatch) -> None:
    """None beyond a third of half a period, or the half swing's end; a beat without a tick, or without more, has none."""
    found = made(5)
    tick = found.tick.copy()
    tick[1] = np.nan
    end = found.end.copy()
    end[4] = tick[4] + 0.03
    found = replace(found, tick=tick, end=end)
    late = NOMINAL / 6.0
    times = [tick[0], tick[0] + late - 1e-6, tick[2], tick[2] + 0.01, tick[2] + late + 1e-6, tick[3], tick[4], tick[4] + 0.031]
    monkeypatch.setattr(hearing, "noises", lambda run, start, end: (np.array(times), np.ones(len(times))))
    run: Any = None
    got = intervals(run, found)
    assert got == pytest.approx([late - 1e-6, np.nan, 0.01, np.nan, np.nan], abs=1e-12, nan_ok=True)
    chosen = np.array([True, True, False, False, True])
    assert intervals(run, found, chosen) == pytest.approx(got[chosen], nan_ok=True)
    assert np.isnan(intervals(run, found, np.zeros(5, bool))).all() and len(intervals(run, found, np.zeros(5, bool))) == 0


def test_noises_are_impacts_by_their_instants() -> None:
    events = np.zeros(7, [("kind", np.int8), ("t", float), ("energy_lost", float)])
    events["t"], events["energy_lost"] = [0.1, 0.1, 0.2, 0.3, 0.3, 0.4, 0.5], [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0]
    events["kind"] = EventKind.IMPACT
    events["kind"][[1, 2]] = EventKind.CLOSE
    run: Any = SimpleNamespace(events=events)
    for (start, end), times, energies in (
        ((-np.inf, np.inf), [0.1, 0.3, 0.4, 0.5], [1.0, 24.0, 32.0, 64.0]),
        ((0.3, 0.4), [0.3, 0.4], [24.0, 32.0]),
    ):
        got = noises(run, start, end)
        assert got[0].tolist() == times and got[1].tolist() == energies
    assert noises(run)[0].tolist() == [0.1, 0.3, 0.4, 0.5] and noises(run, 0.35)[0].tolist() == [0.4, 0.5]
