"""When does time stepping stop, how long is a step, when is a row written, and what happens within a step in which order?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation.moreau import steps
from watchsim.simulation.stops import Stop

PACE = 0.25
ROUNDING = 1e-9  # of a step
Looped = tuple[Stop, list[tuple[float, float]], list[float]]


def looped(
    end: float, *, time: float = 0.0, row: float = 0.6, **given: Any
) -> tuple[Stop, list[tuple[float, float]], list[float]]:
    """(why it stopped, (time, length) of every step, times of rows)."""
    taken: list[tuple[float, float]] = []
    rows: list[float] = []
    used = SimpleNamespace(rows=given.get("rows", 0), events=given.get("events", 0))
    record = SimpleNamespace(used=used, rows=[None] * 1000, events=[None] * 1000)
    state = SimpleNamespace(
        clock=SimpleNamespace(time=time), now=SimpleNamespace(event_waits=given.get("waits", 0)), q=None, u=None, a=None
    )
    until = SimpleNamespace(end=end, slice_end=given.get("slice_end", end), may_cut=given.get("may_cut", 1))
    work = SimpleNamespace(closed=SimpleNamespace(ids=[0] * 7), kept=SimpleNamespace(row_time=time))

    def step(model, cells, state, options, h, whole, work, record):
        assert whole == PACE
        if len(taken) == given.get("broken", -1):
            return Stop.NOT_FINITE
        taken.append((state.clock.time, h))
        state.clock.time += h
        return Stop.RUNNING

    def keep_row(state, record, t, q, u, a):
        rows.append(t)

    pace = SimpleNamespace(step=PACE, row=row)
    stop = in_python(steps._loop, _step=step, keep_row=keep_row)(None, None, state, None, until, pace, work, record)
    assert work.kept.row_time == (rows[-1] if rows and rows != [0.0] else time)
    assert state.now.event_waits == 0 and (state.clock.time == end) == (stop == Stop.DURATION)
    return Stop(stop), taken, rows


def test_the_last_step_is_shorter_and_ends_on_time_with_a_row() -> None:
    stop, taken, rows = looped(1.1)
    assert stop == Stop.DURATION
    assert [h for _, h in taken] == pytest.approx([PACE, PACE, PACE, PACE, 0.1])
    assert rows == [0.75, 1.1]


def test_rows_are_no_further_apart_than_asked() -> None:
    """But for rounding of time."""
    assert looped(2.0, row=0.5)[2] == [0.5, 1.0, 1.5, 2.0]
    assert looped(2.0, row=0.5 * (1.0 + 0.9 * ROUNDING))[2] == [0.5, 1.0, 1.5, 2.0]
    assert looped(2.0, row=0.5 * (1.0 + 1.1 * ROUNDING))[2] == [0.75, 1.5, 2.0]


@pytest.mark.parametrize(("left", "lengths"), [(0.9, [0.5]), (1.1, [0.5, 0.5])])
def test_what_is_left_but_rounding_is_part_of_the_last_step(left: float, lengths: list[float]) -> None:
    end = 2.0 * PACE + left * PACE * ROUNDING
    _, taken, rows = looped(end)
    assert len(taken) == (2 if left < 1.0 else 3) and rows == [end]
    assert [h for _, h in taken[:2]] == [PACE, PACE]


@pytest.mark.parametrize(("short", "whole"), [(0.9, True), (1.1, False)])
def test_a_step_shorter_by_rounding_is_a_whole_one(short: float, whole: bool) -> None:
    end = PACE * (1.0 - short * ROUNDING)
    assert looped(end)[1] == [(0.0, PACE if whole else end)]


def test_a_run_that_is_to_go_on_stops_before_its_last_step() -> None:
    assert looped(0.75, may_cut=0)[:2] == (Stop.LAST_STEP, [(0.0, PACE), (PACE, PACE)])


def test_at_its_end_nothing_is_done() -> None:
    assert looped(2.0, time=2.0) == (Stop.DURATION, [], [])
    assert looped(0.0, waits=1) == (Stop.DURATION, [], [0.0])


def test_a_slice_ends_with_the_step_that_reaches_it() -> None:
    assert looped(9.0, slice_end=0.5)[:2] == (Stop.SLICE, [(0.0, PACE), (PACE, PACE)])
    assert looped(9.0, slice_end=0.51)[1][-1] == (0.5, PACE)
    assert looped(0.5, slice_end=0.5)[0] == Stop.DURATION


@pytest.mark.parametrize(
    ("used", "full"), [({"rows": 996}, False), ({"rows": 997}, True), ({"events": 985}, False), ({"events": 986}, True)]
)
def test_before_every_step_there_is_room_for_three_rows_and_two_events_a_contact(used: dict[str, int], full: bool) -> None:
    assert looped(PACE, **used)[0] == (Stop.BUFFER_FULL if full else Stop.DURATION)


def test_what_stops_a_step_stops_the_loop() -> None:
    assert looped(9.0, broken=2)[:2] == (Stop.NOT_FINITE, [(0.0, PACE), (PACE, PACE)])


def stepped(h: float, jump: bool = False, after: tuple[float, float] = (5.0, 6.0), code: Stop = Stop.RUNNING) -> Any:
    """(why it stops, what was done, state) of the step from 2 to 5, whose velocities go from 3 by 4 to 6."""
    done: list[Any] = []
    state = SimpleNamespace(
        q=np.array([2.0]),
        u=np.array([3.0]),
        a=np.array([7.0]),
        clock=SimpleNamespace(time=1.5),
        counts=SimpleNamespace(steps=9),
    )
    work = SimpleNamespace(q=np.zeros(1), u=np.array([np.nan]), start=np.zeros(1))

    def stop_approaches(model, state, options, m, work, record):
        assert m == 4
        work.u[0] = 4.0
        return jump

    def act(model, state, m, length, work, out_u):
        assert (m, length) == (4, h) and out_u is state.u
        out_u[0] = after[1]

    def move(model, state, options, m, length, work, u):
        assert work.start[0] == 2.0 and u[0] == after[1]
        state.q[0] = after[0]

    def passages(model, state, length, work, q, u, record):
        done.append((float(state.q[0]), float(work.u[0]), float(q[0]), float(u[0])))

    instead = {
        "closed_at_middle": lambda *_: (code, 4),
        "stop_approaches": stop_approaches,
        "keep_row": lambda state, record, t, q, u, a: done.append(("row", t, float(u[0]))),
        "act": act,
        "move": move,
        "_passages": passages,
    }
    stop = in_python(steps._step, **instead)(None, None, state, None, h, PACE, work, None)
    return Stop(stop), done, state


@pytest.mark.parametrize("jump", [False, True])
def test_impacts_come_first_then_forces_and_way_then_what_was_passed(jump: bool) -> None:
    """Two rows where velocities jump; passages are looked for from the start of the step to its end."""
    stop, done, state = stepped(PACE, jump)
    assert stop == Stop.RUNNING
    assert done == ([("row", 1.5, 3.0), ("row", 1.5, 4.0)] if jump else []) + [(2.0, 4.0, 5.0, 6.0)]
    assert state.q[0] == 5.0 and state.u[0] == 6.0


@pytest.mark.parametrize("h", [PACE, 0.1])
def test_time_is_the_number_of_whole_steps_or_goes_on_by_another_length(h: float) -> None:
    _, _, state = stepped(h)
    assert state.counts.steps == 10
    assert state.clock.time == (10 * PACE if h == PACE else 1.5 + 0.1)


@pytest.mark.parametrize("after", [(math.nan, 6.0), (5.0, math.inf), (5.0, -math.inf)])
def test_what_is_no_number_stops_the_step(after: tuple[float, float]) -> None:
    stop, done, state = stepped(PACE, after=after)
    assert stop == Stop.NOT_FINITE and done == [] and state.counts.steps == 9


def test_a_cell_that_nobody_has_asked_about_stops_it_before_anything_is_done() -> None:
    stop, done, state = stepped(PACE, code=Stop.CELL_UNKNOWN)
    assert stop == Stop.CELL_UNKNOWN and done == [] and state.u[0] == 3.0


def test_watched_coordinates_and_joints_are_looked_at() -> None:
    """A coordinate by the place where it stands in balance, a joint by its rest angle against the carrier."""
    found: list[Any] = []

    def keep_of(model, state, h, spring, ends, record):
        found.append((h, spring, [float(one[0]) for one in ends]))

    coordinates = [SimpleNamespace(watched=w, level=0.5 + i, rest=9.0) for i, w in enumerate((1, 0, 1))]
    joints = [SimpleNamespace(watched=w, coordinate=2 * w, on=w, rest=0.25) for w in (0, 1)]
    state, work = SimpleNamespace(q=np.array([1.0])), SimpleNamespace(u=np.array([2.0]))
    u = np.array([4.0, 0.0, 0.0])
    in_python(steps._passages, _keep_of=keep_of)(
        SimpleNamespace(coordinates=coordinates, joints=joints), state, 0.1, work, np.array([3.0]), u, None
    )
    ends = [1.0, 2.0, 3.0, 4.0]
    assert found == [(0.1, (0, -1, 0.5), ends), (0.1, (2, -1, 2.5), ends), (0.1, (2, 1, 0.25), ends)]
