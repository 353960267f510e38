"""From which amplitudes is a drift told, and where does it end? Made-up half swings, and limits on both sides."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.verdicts import settling as module
from watchsim.analysis.verdicts.settling import unsettled

PERIOD = 0.25


@pytest.fixture(autouse=True)
def surroundings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "last_window", lambda run, period: (0.0, 1.0))
    monkeypatch.setattr(module, "averages", lambda found, window: SimpleNamespace(rate_s_per_d=None))


def told(amplitudes: np.ndarray) -> Any:
    found = SimpleNamespace(amplitude_deg=amplitudes, t=0.5 * PERIOD * np.arange(len(amplitudes)), nominal_period=PERIOD)
    sized: Any = type("Found", (SimpleNamespace,), {"__len__": lambda self: len(self.t)})(**vars(found))
    return unsettled(SimpleNamespace(found=sized, run=SimpleNamespace(simulated=9.0), drive=lambda t: 1e-6 * t, oscillator="b"))  # type: ignore[arg-type]


def towards(goal: float, far: float, ratio: float, count: int = 120) -> np.ndarray:
    """What is still missing shrinks by `ratio` from one third of the last 120 half swings to the next."""
    stretch = 2 * (min(count, 120) // 6)
    return goal - far * ratio ** (np.arange(count) / stretch)


def test_fewer_than_twelve_half_swings_say_nothing_else() -> None:
    assert told(np.full(11, 200.0)).message == "not settled yet: 11 half swings are too few to tell how the watch goes"
    assert told(np.full(12, 200.0)) is None


@pytest.mark.parametrize(("share", "settled"), [(1.98e-3, True), (2.01e-3, False), (-1.99e-3, True), (-2.02e-3, False)])
def test_a_five_hundredth_of_the_amplitude_may_be_missing(share: float, settled: bool) -> None:
    """Of an exponential: what is still to come after the last half swing."""
    ratio, goal = 0.5, 250.0
    last = ratio ** (119 / 40)
    assert (told(towards(goal, share * goal / last, ratio)) is None) is settled


@pytest.mark.parametrize(("ratio", "foretold"), [(0.5, True), (0.9, True), (0.97, True), (0.99, False), (1.1, False)])
def test_beyond_a_slow_approach_no_end_is_foretold(ratio: float, foretold: bool) -> None:
    """Of steps of which each is nearly as large as the one before, or larger."""
    amplitudes = 200.0 + 100.0 * ratio ** (np.arange(120) / 40.0) * (-1.0 if ratio < 1.0 else 1.0)
    message = told(amplitudes).message
    assert ("on its way to about 200" in message) is foretold and "rises by" in message


@pytest.mark.parametrize("count", [12, 17, 60, 119, 120, 121, 200])
def test_thirds_of_the_last_half_swings(count: int) -> None:
    """Of at most 120, in stretches of whole oscillations; the drift is that of the last two thirds."""
    stretch = 2 * (min(count, 120) // 6)
    amplitudes = np.concatenate((np.full(count, 50.0), 200.0 + 0.5 * np.arange(3 * stretch)))[-count:]
    found = told(amplitudes)
    per_second = 0.5 / (0.5 * PERIOD)
    assert f"rises by {per_second:.2g}° per second" in found.message
    assert (found.t, found.body, found.torque) == (0.5 * PERIOD * (count - 1), "b", pytest.approx(9e-6))
    falling = told(amplitudes[::-1].copy() if count in (12, 60, 120) else 400.0 - amplitudes)
    assert "falls by" in falling.message


def test_an_end_below_nothing_is_not_told() -> None:
    amplitudes = -5.0 + 60.0 * 0.9 ** (np.arange(120) / 40.0)
    assert "on its way" not in told(amplitudes).message
    assert "on its way to about 5" in told(amplitudes + 10.0).message


@pytest.mark.parametrize(("share", "drifts"), [(0.97, True), (1.03, False)])
def test_a_drift_beyond_three_standard_errors(share: float, drifts: bool) -> None:
    """Means of two half swings scatter to and fro about straight lines; steps are 1° from third to third."""
    pattern, place = np.resize([1.0, -1.0, -1.0, 1.0], 20), np.arange(20.0)
    rest = pattern - np.polyval(np.polyfit(place, pattern, 1), place)
    error = math.sqrt(2.0 * float((rest**2).mean()) / 20.0)
    scatter = np.repeat(share / (3.0 * error) * (pattern - pattern.mean()), 2)
    amplitudes = 200.0 + np.concatenate([level + scatter for level in (0.0, 1.0, 2.0)])
    assert (told(amplitudes) is not None) is drifts


@pytest.mark.parametrize(("share", "drifts"), [(0.97, True), (1.03, False)])
def test_of_stretches_of_three_oscillations_the_scatter_is_known(share: float, drifts: bool) -> None:
    """Off a straight line by 1, -2, 1: the mean square is 2."""
    scatter = np.repeat(share / (3.0 * math.sqrt(2.0 * 2.0 / 3.0)) * np.array([1.0, -2.0, 1.0]), 2)
    amplitudes = 200.0 + np.concatenate([level + scatter for level in (0.0, 1.0, 2.0)])
    assert (told(amplitudes) is not None) is drifts


def test_what_begins_to_drift_has_no_end_foretold() -> None:
    """The first two thirds are alike; nothing is divided by zero."""
    with np.errstate(all="raise"):
        said = told(200.0 + np.repeat([0.0, 0.0, 2.0], 40))
    assert "on its way" not in said.message and "rises by" in said.message


def test_of_stretches_of_two_oscillations_no_scatter_is_known() -> None:
    """Then every step counts."""
    amplitudes = np.array([200.0, 210.0, 190.0, 200.0] * 3) + np.repeat([0.0, 1.0, 2.0], 4)
    assert "rises" in told(amplitudes).message


def test_words_about_the_rate(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "of this moment" not in told(towards(250.0, 50.0, 0.5)).message
    monkeypatch.setattr(module, "averages", lambda found, window: SimpleNamespace(rate_s_per_d=1.0))
    assert told(towards(250.0, 50.0, 0.5)).message.endswith("; amplitude and rate are those of this moment, not of the watch")


@pytest.mark.parametrize(("way", "goal"), [(20.0, "250"), (2.0, "250"), (0.7, "250.0")])
def test_the_end_has_as_many_digits_as_the_way(way: float, goal: str) -> None:
    amplitudes = towards(250.0, way / 0.5 ** (119 / 40), 0.5)
    assert f"about {goal}°" in told(amplitudes).message
