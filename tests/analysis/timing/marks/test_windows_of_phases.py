"""Are the phases of a window those of its beats, and only where rows lie close enough?"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import lever_run, lever_scene
from render.fake_runs import disc_run

from watchsim.analysis.timing import rows_at_hand
from watchsim.analysis.timing.beats import beats
from watchsim.analysis.timing.marks.stretches import Stretch, in_columns
from watchsim.analysis.timing.phases import Phases, _beginning, _told, phase_columns, phases, phases_within, stretches
from watchsim.analysis.timing.rows_at_hand import is_recorded


@pytest.mark.parametrize("at_once", [4, 4096])
@pytest.mark.parametrize("seed", range(10))
def test_between_rows_close_enough_the_motion_is_known(seed: int, at_once: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows no further apart than 0.26 of the shortest period; at a row it is known in any case."""
    monkeypatch.setattr(rows_at_hand, "AT_ONCE", at_once)
    swinging = [SimpleNamespace(hertz=hertz) for hertz in (2.0, None, 5.0, 4.0)]
    monkeypatch.setattr(rows_at_hand, "oscillators", lambda scene: swinging)
    rng = np.random.default_rng(seed)
    steps = rng.choice([0.0, 0.01, 0.2 * 0.255, 0.2 * 0.265, 0.2 * 0.3, 0.4], 30, p=[0.1, 0.2, 0.3, 0.2, 0.1, 0.1])
    t = 1.3 + np.concatenate(([0.0], np.cumsum(steps)))
    times = np.concatenate((rng.permutation(t), 0.5 * (t[1:] + t[:-1]), [t[0] - 1e-9, t[-1] + 1e-9, np.nan]))
    run: Any = SimpleNamespace(t=t, scene=None)
    wanted = []
    for time in times.tolist():
        before, after = [row for row in t.tolist() if row <= time], [row for row in t.tolist() if row >= time]
        wanted.append(bool(before and after) and min(after) - max(before) <= 0.26 / 5.0)
    assert is_recorded(run, times).tolist() == wanted
    assert is_recorded(run, times[:0]).tolist() == []
    monkeypatch.setattr(rows_at_hand, "oscillators", lambda scene: swinging[1:2])
    assert is_recorded(run, times).tolist() == [t[0] <= time <= t[-1] for time in times.tolist()]
    nothing: Any = SimpleNamespace(t=t[:0], scene=None)
    assert is_recorded(nothing, times).tolist() == [False] * len(times)


def test_a_beat_is_told_that_was_heard_and_recorded_from_there_to_its_end() -> None:
    whole = lever_run(12)
    found = beats(whole)
    tick = found.tick.copy()
    tick[[2, 7]] = np.nan
    lost = [(found.tick[4] - 0.02, found.tick[4] + 0.02), (found.end[8] - 0.02, found.end[8] + 0.02)]
    kept = np.array([not any(low < t < high for low, high in lost) for t in whole.t.tolist()])
    cut = {name: getattr(whole, name)[kept] for name in ("t", "q", "u", "a")}
    scene = lever_scene()
    fast = replace(scene, springs=(replace(scene.springs[0], stiffness=9.0 * scene.springs[0].stiffness),))
    run = replace(whole, scene=fast, **cut)
    assert np.flatnonzero(~_told(run, replace(found, tick=tick))).tolist() == [2, 4, 7, 8]


def test_beats_that_begin_in_a_window_count_with_all_their_phases() -> None:
    starts = [(3, 1.0), (3, 1.4), (4, 2.0), (4, 2.5), (4, 2.75), (6, 3.0), (7, 4.0), (7, 4.5)]
    rows = in_columns([Stretch(beat, "drop", t, t + 0.1) for beat, t in starts])
    angles = np.arange(24.0).reshape(8, 3)
    for window, beats_there in (((1.2, 3.9), {4, 6}), ((1.0, 3.0), {3, 4, 6}), ((2.0, 4.0), {4, 6, 7}), ((2.1, 2.9), set())):
        some = _beginning(Phases(rows, angles, 2.0 * angles), window)
        chosen = [k for k, (beat, _) in enumerate(starts) if beat in beats_there]
        assert some.rows.start.tolist() == [starts[k][1] for k in chosen]
        assert some.angles.tolist() == angles[chosen].tolist() and some.turns.tolist() == (2.0 * angles[chosen]).tolist()


@pytest.mark.parametrize(("first", "last"), [(3, 6), (0, 2), (8, 10)])
@pytest.mark.parametrize("off", [-1e-6, 0.0, 1e-6])
def test_beats_that_lie_in_part_within_a_window(first: int, last: int, off: float) -> None:
    """From the one that ends as it begins to the one that begins as it ends."""
    run = lever_run(12)
    found = beats(run)
    window = (found.end[first] + off, found.start[last] - off)
    there = {row for part in stretches(run, found, window) for row in part.beat.tolist()}
    wanted = {k + 1 for k in range(len(found)) if found.end[k] >= window[0] and found.start[k] <= window[1]}
    assert there == wanted and (len(wanted) == last - first + 1) is (off <= 0.0)
    begun = [one for some in phase_columns(run, found, window) for one in some.each()]
    assert {one.beat for one in begun} == {k for k in wanted if window[0] <= found.tick[k - 1] <= window[1]}


def test_of_a_window_the_beats_and_one_on_either_side() -> None:
    """Half swings begin every eighth of a second, the first that counts at 0.125 s."""
    run = lever_run(16)
    told = phases_within(run, (0.8, 1.1))  # the sixth to the eighth, numbered from one
    every = [one for one in phases(run) if one.beat in range(5, 10)]
    assert {one.beat for one in told} == set(range(5, 10))
    assert [(one.beat, one.name, one.start) for one in told] == [
        (one.beat, one.name, one.start) for one in every if (one.beat, one.name) != (9, "locked")
    ]
    assert {one.beat for one in phases_within(run, (9.0, 9.5))} == {15} and phases_within(disc_run(), (0.8, 1.1)) == []


def test_without_rows_there_are_no_phases() -> None:
    run = lever_run(6)
    nothing = {name: getattr(run, name)[:0] for name in ("t", "q", "u", "a")}
    assert list(stretches(replace(run, **nothing))) == []
