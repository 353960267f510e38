"""Are half swings and first noises those that one finds by looking at one event after another?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.simulation.event_kinds import EVENT_DTYPE
from watchsim.simulation.record.half_swings import FEWEST_TURNS, first_noises, half_swings, since_two_before, unevenness


def events(times: list[int], values: list[float]) -> np.ndarray:
    rows = np.zeros(len(times), EVENT_DTYPE)
    rows["t"], rows["value"] = times, values
    return rows


def by_looking(crossings: np.ndarray, turns: np.ndarray) -> list[tuple[int, int, int]]:
    """(passage, turning point before, turning point after): of several the one furthest out on the side swung to."""

    def between(k: int) -> int | None:
        """The turning point after passage k - 1 and before passage k."""
        since = crossings["t"][k - 1] if k else -math.inf
        until = crossings["t"][k] if k < len(crossings) else math.inf
        side = crossings["value"][k - 1] if k else -crossings["value"][0]
        own = [i for i, turn in enumerate(turns) if since <= turn["t"] < until]
        return max(own, key=lambda i: math.copysign(1.0, side) * turns["value"][i], default=None)

    found = [(k, between(k), between(k + 1)) for k in range(len(crossings))]
    return [(k, a, b) for k, a, b in found if a is not None and b is not None]


@pytest.mark.parametrize("seed", range(40))
def test_half_swings(seed: int) -> None:
    """With knocks, missing turning points, and events at the same instant."""
    rng = np.random.default_rng(seed)
    crossings = events(sorted(rng.choice(30, 8, replace=False)), list(rng.choice([-2.0, 3.0], 8)))
    turns = events(sorted(rng.integers(0, 30, 12)), list(rng.permutation(np.arange(-6.0, 6.0))))
    found = half_swings(crossings, turns)
    assert list(zip(*(column.tolist() for column in found), strict=True)) == by_looking(crossings, turns)


def test_too_few_events_make_none() -> None:
    crossing, turns = events([2], [1.0]), events([1, 3, 4], [-1.0, 1.0, 0.5])
    assert [column.tolist() for column in half_swings(crossing, turns)] == [[0], [0], [1]]
    assert len(turns) == FEWEST_TURNS
    for few in (half_swings(crossing, turns[:-1]), half_swings(crossing[:0], turns)):
        assert [len(column) for column in few] == [0, 0, 0]


@pytest.mark.parametrize("seed", range(20))
def test_the_first_noise_after_a_silence(seed: int) -> None:
    """Times in tenths of the silence: noises at its very end, at the start of a half swing and at its end occur."""
    rng = np.random.default_rng(seed)
    step = 0.1  # a quarter of the silence, which is a tenth of a half period of 4
    noises, starts = step * np.unique(rng.integers(0, 80, 25)), step * np.arange(0.0, 80.0, 10.0)
    ends = starts + 10.0 * step
    expected = []
    for start, end in zip(starts, ends, strict=True):
        after = [t for i, t in enumerate(noises) if (i == 0 or t - noises[i - 1] >= 0.4) and start < t]
        expected.append(after[0] if after and after[0] < end else math.nan)
    assert first_noises(noises, starts, ends, 4.0) == pytest.approx(np.array(expected), nan_ok=True, abs=0.0)


@pytest.mark.parametrize("count", [0, 1, 2, 3, 9])
def test_periods_and_unevenness(count: int) -> None:
    times = np.cumsum(np.random.default_rng(count).uniform(0.9, 1.1, count))
    for found, at in ((since_two_before(times), lambda i: times[i] - times[i - 2]),
                      (unevenness(times), lambda i: times[i] - 2.0 * times[i - 1] + times[i - 2])):  # fmt: skip
        expected = [math.nan if i < 2 else at(i) for i in range(count)]
        assert found == pytest.approx(np.array(expected), nan_ok=True)
