"""Are the marks of an anchor's beat those that loops find, event by event and row by row?"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.timing.marks.anchor_marks import Marks, anchor_marks

START, END = 2.0, 3.0


def by_loops(times: Any, held: Any, at_events: Any, rows: Any, at_rows: Any, start: float, end: float) -> Marks | None:
    """The definition: the last event before the half swing counts with those in it."""
    earlier_ones = [k for k, t in enumerate(times) if t < start]
    own = earlier_ones[-1:] + [k for k, t in enumerate(times) if start <= t < end]
    runs = {}
    for k, after in pairwise(own):
        free = held[k] == 0 and times[after] > times[k]
        runs[k] = at_events[after] - at_events[k] if free else 0.0
    before, behind = (float(np.interp(t, rows, at_rows)) for t in (start, end))
    if not runs or behind - before <= 0.1 * max(runs.values()):
        return None
    rest = behind - 0.1 * (behind - before)
    ending = {k: run if at_events[k + 1] >= rest else 0.0 for k, run in runs.items()}
    drop = next(k for k in runs if ending[k] == max(ending.values()))
    let_off = times[drop]
    inside = [k for k, t in enumerate(rows) if start <= t < let_off]
    if runs[drop] <= 0.0 or not inside:
        return None
    last = inside[-1] + 1  # a recoil ends at the row of the let-off
    way_back = [(start, before)] + [(rows[k], at_rows[k]) for k in range(inside[0], min(last + 1, len(rows)))]
    lowest = min(angle for _, angle in way_back)
    way = at_events[drop + 1] - lowest
    moved = max(t for t, angle in way_back if angle <= lowest + 1e-6 * way)
    catching = {k: run for k, run in runs.items() if k < drop and times[k] >= moved}
    furthest = max(catching.values(), default=0.0)
    if furthest <= 0.05 * way:
        return Marks(moved, None, None, let_off, times[drop + 1])
    k = next(k for k in catching if catching[k] == furthest)
    return Marks(moved, times[k], times[k + 1], let_off, times[drop + 1])


def made(seed: int) -> tuple[list[float], list[int], list[float], list[float], list[float]]:
    """Random events and rows about the half swing, many at the same instant or place, some steps tiny."""
    rng = np.random.default_rng(seed)
    number = int(rng.integers(0, 14))
    times = np.sort(np.round(rng.uniform(1.6, 3.3, number), int(rng.integers(1, 3))))
    times += np.cumsum(rng.choice([0.0, 4e-4], number))
    rows = np.sort(np.concatenate((times, rng.uniform(1.5, 3.5, int(rng.integers(0, 6))), [1.0, 4.0])))
    ahead = np.cumsum(rng.choice([0.0, 3e-4, 0.02, 0.1, -0.1, 0.4, 1.0], len(rows), p=[0.2, 0.1, 0.2, 0.2, 0.1, 0.1, 0.1]))
    at_events = ahead[np.searchsorted(rows, times)] + rng.choice([0.0, 0.03], number)
    held = rng.choice([0, 0, 1, 2], number)
    return times.tolist(), held.tolist(), at_events.tolist(), rows.tolist(), ahead.tolist()


def found(times: Any, held: Any, at_events: Any, rows: Any, at_rows: Any) -> Marks | None:
    columns = (np.array(one, float) for one in (times, at_events, rows, at_rows))
    t, angle, at, there = columns
    return anchor_marks(t, np.array(held, np.int32), angle, at, there, START, END)


@pytest.mark.parametrize("block", range(10))
def test_random_beats_as_by_loops(block: int) -> None:
    kinds = set()
    for seed in range(200 * block, 200 * (block + 1)):
        case = made(seed)
        wanted = by_loops(*case, START, END)
        assert found(*case) == wanted, seed
        kinds.add("none" if wanted is None else "slides" if wanted.freed is None else "catches up")
    assert kinds == {"none", "slides", "catches up"}


# One beat: the wheel rests at 0, comes off at 2.2 s, catches up by 1 until 2.3 s, is pushed on to 4, drops to 10 and locks.
TIMES, HELD = [1.9, 2.2, 2.3, 2.6, 2.7], [1, 0, 1, 0, 1]
PLACES = [0.0, 0.0, 1.0, 4.0, 10.0]


def beat(**changed: Any) -> Marks | None:
    case = {"times": TIMES, "held": HELD, "at_events": PLACES, "rows": [1.5, 2.0, *TIMES[1:], 3.2]}
    case |= {"at_rows": [0.0, 0.0, *PLACES[1:], 10.0]} | changed
    return found(**case)


def test_one_beat_by_hand() -> None:
    assert beat() == (2.2, 2.2, 2.3, 2.6, 2.7)


@pytest.mark.parametrize("scale", [1.0, 1e-4])
@pytest.mark.parametrize(("catch", "caught"), [(0.049, None), (0.051, 2.3)])
def test_a_twentieth_of_the_way_is_a_catching_up(catch: float, caught: float | None, scale: float) -> None:
    """However small the wheel's steps are."""
    places = [scale * place for place in (0.0, 0.0, 10.0 * catch, 4.0, 10.0)]
    marks = beat(at_events=places, at_rows=[0.0, 0.0, *places[1:], 10.0 * scale])
    assert marks is not None and (marks.caught, marks.freed) == (caught, None if caught is None else 2.2)


@pytest.mark.parametrize(("off", "moved"), [(0.9e-5, 2.2), (1.1e-5, 2.0)])
def test_a_millionth_of_the_way_is_standing(off: float, moved: float) -> None:
    marks = beat(at_rows=[0.0, 0.0, off, *PLACES[2:], 10.0])
    assert marks is not None and marks.moved == moved


@pytest.mark.parametrize(("end", "let_off"), [(8.9, 2.8), (9.1, 2.6)])
def test_a_free_run_that_ends_near_rest_is_the_drop(end: float, let_off: float) -> None:
    """Within a tenth of the beat's advance, of 10; else it is a shorter one later."""
    times, held = [1.9, 2.2, 2.6, 2.7, 2.8, 2.9], [1, 0, 0, 1, 0, 1]
    places = [0.0, 0.0, 0.0, end, 9.95, 10.0]
    marks = found(times, held, places, [1.5, 2.0, 2.1, *times[1:], 3.2], [0.0, 0.0, 0.0, *places[1:], 10.0])
    assert marks is not None and marks.let_off == let_off


@pytest.mark.parametrize(("advance", "goes_on"), [(0.59, False), (0.61, True)])
def test_a_wheel_that_falls_back_does_not_go_on(advance: float, goes_on: bool) -> None:
    """Not by a tenth of its longest free run, of 6."""
    marks = beat(at_rows=[0.0, 0.0, *PLACES[1:], advance + (advance - 10.0) * 0.2 / 0.3])
    assert (marks is not None) is goes_on
    assert math.isclose(np.interp(END, [2.7, 3.2], [10.0, advance + (advance - 10.0) * 0.2 / 0.3]), advance)
