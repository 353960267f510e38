"""Are missed beats those that are counted half swing by half swing, also where only every other one gives the wheel a step?"""

from __future__ import annotations

import math
import statistics
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timing import escape_wheel as module
from watchsim.analysis.timing.escape_wheel import Advance, _giving, _of_parity, advance, missed_beats, progress

HALF = 0.3  # rad, half a pitch


def missed(monkeypatch: pytest.MonkeyPatch, half_swings: list[int], steps: list[float]) -> int | None:
    """`steps`: half pitches the wheel has come at each of these turning points."""
    came = Advance(HALF, np.array(half_swings, float), HALF * np.array(steps))
    monkeypatch.setattr(module, "advance", lambda *_: came)
    unused: Any = None
    return missed_beats(unused, "wheel", unused)


def steps_of(rng: np.random.Generator, giving: int | None, count: int) -> np.ndarray:
    """Half pitches by which the wheel goes on in each half swing, a few of them wrong, none of them exact."""
    due = np.array([1 if giving is None else 2 * (k % 2 == giving) for k in range(count)])
    wrong = rng.random(count) < 0.15
    return due + np.where(wrong, rng.integers(-2, 3, count), 0) + rng.uniform(-0.4, 0.4, count) / count


@pytest.mark.parametrize("giving", [None, 0, 1])
@pytest.mark.parametrize("seed", range(30))
def test_missed_beats_one_by_one(monkeypatch: pytest.MonkeyPatch, seed: int, giving: int | None) -> None:
    """Some turning points are not recorded: between them half swings and half pitches are only counted."""
    rng = np.random.default_rng(seed)
    count = 40
    steps = steps_of(rng, giving, count)
    came = np.concatenate(([0.0], np.cumsum(steps)))
    kept = sorted({0, *np.flatnonzero(rng.random(count + 1) < 0.9).tolist()})
    wrong, one = 0, 1 if giving is None else 2
    for low, high in pairwise(kept):
        due = sum(1 if giving is None else 2 * (k % 2 == giving) for k in range(low, high))
        wrong += abs(round(came[high] - came[low]) - due)
    assert missed(monkeypatch, kept, came[kept].tolist()) == wrong // one


@pytest.mark.parametrize("giving", [0, 1])
@pytest.mark.parametrize("first", [1, 4, 7])
@pytest.mark.parametrize("ahead", range(-9, 10))
def test_before_the_first_window_of_a_detent(monkeypatch: pytest.MonkeyPatch, giving: int, first: int, ahead: int) -> None:
    """At turning point h the wheel has come h + 1 half pitches: a step (of two) more or less is no matter, the next one is."""
    half_swings = list(range(first, first + 9))
    steps = np.cumsum([first + 1.0 + ahead, *(2.0 * (h % 2 == giving) for h in half_swings[:-1])])
    assert missed(monkeypatch, half_swings, steps.tolist()) == max(0, abs(ahead) - 2) // 2


@pytest.mark.parametrize("seed", range(60))
def test_which_half_swings_give_a_step(seed: int) -> None:
    """Those of a parity whose median is a whole pitch, the others' nothing; those between gaps do not count."""
    rng = np.random.default_rng(seed)
    half_swings = np.flatnonzero(rng.random(14) < 0.85) + seed % 2
    if len(half_swings) < 2:
        return
    usual = [(0, 2), (2, 0), (1, 1), (2, 2), (0, 1), (1, 3)][seed % 6]
    steps = np.array([usual[h % 2] for h in half_swings]) + rng.choice([0, 0, 0, 1, -2], len(half_swings))
    came = Advance(HALF, half_swings.astype(float), HALF * (7.0 + np.cumsum(steps)))
    by: dict[int, list[int]] = {0: [], 1: []}
    for i, (h, after) in enumerate(pairwise(half_swings.tolist())):
        if after == h + 1:
            by[h % 2].append(int(steps[i + 1]))
    found = [statistics.median(by[k]) if by[k] else math.nan for k in (0, 1)]
    wanted = {(2.0, 0.0): 0, (0.0, 2.0): 1}.get((float(found[0]), float(found[1])))
    assert _giving(came) == wanted


@pytest.mark.parametrize("parity", [0, 1])
def test_how_many_of_a_parity_came_before(parity: int) -> None:
    half_swings = np.arange(12.0)
    assert _of_parity(half_swings, parity).tolist() == [sum(h % 2 == parity for h in range(k)) for k in range(12)]


@pytest.mark.parametrize("kept", ["all", "some", "none"])
def test_the_wheel_at_turning_points(monkeypatch: pytest.MonkeyPatch, kept: str) -> None:
    """From the first beat's beginning on, counted from the run's first turning point, at those that were recorded."""
    turns = np.array([1.0, 1.7, 2.9, 3.1])
    unknown = {"all": [], "some": [1.7], "none": turns.tolist()}[kept]
    monkeypatch.setattr(module, "pitch", lambda scene, wheel: {"wheel": 2.0 * HALF}[wheel])
    monkeypatch.setattr(module, "is_recorded", lambda run, times: ~np.isin(times, unknown))
    monkeypatch.setattr(module, "progress", lambda run, wheel, times: {"wheel": times**2}[wheel])
    run: Any = SimpleNamespace(scene=None)

    class Found(SimpleNamespace):
        def __len__(self) -> int:
            return len(self.end)

    found: Any = Found(start=turns[:-1], end=turns[1:], before=6)
    got = advance(run, "wheel", found)
    if kept == "none":
        assert got is None
        return
    assert got is not None and got.half_pitch == HALF
    places = [0, 1, 2, 3] if kept == "all" else [0, 2, 3]
    assert got.half_swings.tolist() == [6.0 + k for k in places] and got.angle == pytest.approx(turns[places] ** 2)
    assert got.steps == pytest.approx(np.diff(turns[places] ** 2) / HALF, rel=1e-14)
    monkeypatch.setattr(module, "pitch", lambda scene, wheel: None)
    assert advance(run, "wheel", found) is None


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_how_far_the_wheel_has_come(monkeypatch: pytest.MonkeyPatch, way: float) -> None:
    """From where the scene puts it, in the sense of its drive."""
    monkeypatch.setattr(module, "drive_direction", lambda scene, wheel: way)
    scene = SimpleNamespace(body=lambda name: SimpleNamespace(angle={"wheel": 0.7}[name]))
    run: Any = SimpleNamespace(scene=scene, slices={"wheel": slice(2, 3)})
    places = {0: 1.0, 1: 3.0, 2: way * 0.25}
    run.positions = lambda times, columns: np.column_stack([0.7 + places[column] * times for column in columns])
    times = np.array([2.0, 0.5, 8.0])
    assert progress(run, "wheel", times) == pytest.approx(0.25 * times, rel=1e-12)


def test_a_single_half_swing_has_an_advance(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "pitch", lambda scene, wheel: 2.0 * HALF)
    monkeypatch.setattr(module, "is_recorded", lambda run, times: np.ones(len(times), bool))
    monkeypatch.setattr(module, "progress", lambda run, wheel, times: 4.0 * times)
    run: Any = SimpleNamespace(scene=None)
    found: Any = type("Found", (SimpleNamespace,), {"__len__": lambda self: len(self.end)})
    got = advance(run, "wheel", found(start=np.array([1.0]), end=np.array([1.5]), before=3))
    assert got is not None and got.half_swings.tolist() == [3.0, 4.0] and got.angle.tolist() == [4.0, 6.0]
    assert advance(run, "wheel", found(start=np.zeros(0), end=np.zeros(0), before=3)) is None
