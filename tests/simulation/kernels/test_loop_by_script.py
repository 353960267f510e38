"""How does the loop go from step to step and event to event? With made-up steps and events."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from made_up import named
from plain_kernels import in_python

from watchsim.simulation import advance as loop
from watchsim.simulation.advance import BEARING, EVENTS_PER_CONTACT, KINDS, ROWS_PER_STEP, TOUCHED
from watchsim.simulation.loop_state.scratch import MONITORS, RECENT
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.motion.contact_mode_end import NONE_FIRED
from watchsim.simulation.motion.free_flight import FLIGHT_PHASE
from watchsim.simulation.stops import Stop
from watchsim.tolerances import FINEST_ROWS


def test_kinds_of_ends_and_room_for_rows_follow_from_what_they_count() -> None:
    """The monitors of a contact, a touch and a bearing; all rows of the longest flight at the finest spacing, and some."""
    assert (TOUCHED, BEARING, KINDS) == (MONITORS, MONITORS + 1, MONITORS + 2)
    assert ROWS_PER_STEP - 8 == math.ceil(FLIGHT_PHASE / FINEST_ROWS) == 128


@pytest.mark.parametrize(("q", "u", "found"), [
    ([0.1, -0.2], [3.0, 4.0], Stop.RUNNING),
    ([0.1, math.nan], [3.0, 4.0], Stop.NOT_FINITE),
    ([0.1, 0.2], [-math.inf, 4.0], Stop.NOT_FINITE),
    ([0.99e10 * 0.5, 0.0], [0.0, 0.0], Stop.RUNNING),
    ([0.0, -0.99e10 * 3.0], [0.0, 0.0], Stop.RUNNING),
    ([1.01e10 * 0.5, 0.0], [0.0, 0.0], Stop.FAR_AWAY),
    ([0.0, -1.01e10 * 3.0], [0.0, 0.0], Stop.FAR_AWAY),
])  # fmt: skip
def test_a_run_ends_where_numbers_do_or_places_are_lost_in_rounding(q: list[float], u: list[float], found: Stop) -> None:
    """Ten thousand million sizes, or radians, away."""
    assert in_python(loop.where_it_is)(named(coordinates=[named(scale=0.5), named(scale=3.0)]), q, u) == found


@pytest.mark.parametrize(("rows", "events", "fits"), [(0, 0, True), (1, 0, False), (0, 1, False)])
def test_a_step_needs_room_for_its_rows_and_for_the_events_of_all_contacts(rows: int, events: int, fits: bool) -> None:
    """More than it can need is left beside what is used."""
    record = named(
        used=named(rows=4 + rows, events=7 + events), rows=[0] * (5 + ROWS_PER_STEP), events=[0] * (8 + 3 * EVENTS_PER_CONTACT)
    )
    assert in_python(loop._room_left)(record, 3) == fits


@pytest.mark.parametrize(("contact", "code", "what"), [
    (5, 99, KINDS * 5 + TOUCHED),
    (0, 99, TOUCHED),
    (NO_CONTACT, NONE_FIRED, BEARING),
    (NO_CONTACT, MONITORS * 2 + 3, KINDS * 3 + BEARING),
    (NO_CONTACT, MONITORS * 2, BEARING),
    (NO_CONTACT, MONITORS + 2, KINDS * 8 + 2),
    (NO_CONTACT, 3, KINDS * 6 + 3),
])  # fmt: skip
def test_what_ended_a_step_is_remembered_by_its_contact_or_bearing(contact: int, code: int, what: int) -> None:
    """Contacts 6 and 8 of awake bodies are in force; the newest takes the place of the oldest."""
    state = named(now=named(awake_contacts=2), active=[6, 8, 77])
    for number in (3, RECENT - 1, RECENT + 3):
        ended = named(number=number, by=[77] * RECENT)
        in_python(loop._note_end)(state, contact, code, ended)
        assert ended.number == number + 1 and ended.by[number % RECENT] == what and ended.by.count(77) == RECENT - 1


@pytest.mark.parametrize(("flying", "left", "reaches"), [
    (True, 0.3, True), (True, 0.31, False), (False, 0.2, True), (False, 0.21, False),
])  # fmt: skip
def test_the_next_step_might_come_as_far_as_the_end(flying: bool, left: float, reaches: bool) -> None:
    """A flight by its length, a coupled step by what is proposed, or the longest."""
    instead = {"can_fly": lambda *_: flying, "flight_length": lambda *_: (0.3, 99.0)}
    for step, longest in ((0.2, 0.9), (0.9, 0.2)):
        state = named(clock=named(step=step, time=0.0))
        assert in_python(loop._reaches, **instead)(None, state, named(max_step=longest), left) == reaches
    assert not in_python(loop._reaches, **instead)(None, named(clock=named(step=0.2, time=-0.2)), named(max_step=0.9), 0.15)


def run(**script: Any) -> tuple[int, list[Any], SimpleNamespace]:
    """(code, calls, until) of a loop whose steps take 0.25 s; the run ends at 2 s, its slice at 1 s."""
    given: dict[str, Any] = {
        "waits": 0, "time": 0.5, "end": 2.0, "slice": 1.0, "steps": 9.0, "cut": 0, "room": True, "events": [False],
        "settles": [Stop.RUNNING], "codes": [Stop.RUNNING], "where": Stop.RUNNING, **script,
    }  # fmt: skip
    calls: list[Any] = []
    state = named(
        now=named(event_waits=given["waits"]), clock=named(time=given["time"]), active=[0] * 7, grip="grip", q="q", u="u"
    )
    until = named(end=given["end"], slice_end=given["slice"], may_cut=given["cut"], steps=given["steps"])

    def next_of(name: str) -> Any:
        return given[name].pop(0) if len(given[name]) > 1 else given[name][0]

    def settle(model, cells, state, *_: object) -> int:
        calls.append("settle")
        state.now.event_waits = 0
        return int(next_of("settles"))

    def smooth(model, cells, state, options, end, scratch, record) -> tuple[int, bool]:
        calls.append(("step", end))
        state.clock.time += 0.25
        return int(next_of("codes")), bool(next_of("events"))

    instead = {
        "fill_inverse": lambda model, grip, inverse: calls.append((grip, inverse)),
        "_room_left": lambda record, contacts: given["room"] if contacts == 7 else None,
        "_work_done": lambda state: "before",
        "_settle": settle,
        "_reaches": lambda model, state, options, end: state.clock.time + 0.25 >= end,
        "_smooth_step": smooth,
        "where_it_is": lambda model, q, u: given["where"],
        "_undone": lambda code, state, before: calls.append((code, before)) or code,
    }
    scratch = named(work=named(inverse="inverse"))
    code = in_python(loop._loop, **instead)(None, None, state, None, until, scratch, None)
    assert calls[0] == ("grip", "inverse")
    until.waits = state.now.event_waits
    return int(code), calls[1:], until


STEP = ("step", 2.0)


def test_the_loop_comes_back_at_the_end_of_its_slice() -> None:
    code, calls, until = run()
    assert (code, calls, until.steps) == (Stop.SLICE, [STEP] * 2, 7.0)
    code, calls, until = run(steps=1.0)
    assert (code, calls, until.steps) == (Stop.SLICE, [STEP], 0.0) and run(steps=0.5)[1] == [STEP]
    assert run(slice=0.5)[1] == [] and run(slice=0.51)[1] == [STEP]


def test_the_loop_comes_back_once_before_the_last_step_and_at_the_end() -> None:
    assert run(slice=9.0)[:2] == (Stop.LAST_STEP, [STEP] * 5)
    assert run(slice=9.0, cut=1)[:2] == (Stop.DURATION, [STEP] * 6)
    assert run(time=2.0)[0] == Stop.DURATION == run(time=2.1, steps=0.0)[0]


def test_events_come_before_time_goes_on() -> None:
    assert run(waits=1)[:2] == (Stop.SLICE, ["settle", STEP, STEP])
    assert run(events=[True, False])[1] == [STEP, "settle", STEP]
    assert run(time=2.0, waits=1)[:2] == (Stop.DURATION, ["settle"])
    assert run(events=[True], steps=1.0)[:2] == (Stop.SLICE, [STEP, "settle"])


def test_the_loop_comes_back_for_what_it_cannot_go_on_with() -> None:
    assert run(room=False)[:2] == (Stop.BUFFER_FULL, []) == run(room=False, waits=1)[:2]
    assert run(codes=[Stop.CELL_UNKNOWN])[1] == [STEP, (Stop.CELL_UNKNOWN, "before")]
    code, calls, until = run(waits=1, settles=[Stop.CELL_UNKNOWN])
    assert (code, calls) == (Stop.CELL_UNKNOWN, ["settle", (Stop.CELL_UNKNOWN, "before")])
    code, calls, until = run(where=Stop.FAR_AWAY, events=[True])
    assert (code, calls, until.waits) == (Stop.FAR_AWAY, [STEP], 0)
    assert np.isfinite(until.steps)
