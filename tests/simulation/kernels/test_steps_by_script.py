"""How is one step of the loop made, and one event settled? With made-up answers of what is called."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from made_up import named
from plain_kernels import in_python

from watchsim.simulation import advance as loop
from watchsim.simulation.advance import EVENTS_AT_ONCE, FLIGHT_CELLS
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.motion.contact_mode_end import NONE_FIRED
from watchsim.simulation.stops import Stop

START = 2.0


def stepped(flying: bool, **script: Any) -> SimpleNamespace:
    """What is returned and done in a step that could take 0.5 s, with 0.75 s left."""
    given: dict[str, Any] = {
        "left": 0.75, "length": 0.5, "cells": [9.0, 9.0], "leave": 9.0, "code": 6, "known": True, "touch": 9.0,
        "contact": NO_CONTACT, "made": True, "knot": 99.0, "max_step": 9.0, "accepted": None, "explained": True, **script,
    }  # fmt: skip
    calls: list[Any] = []
    span = named(start=START, length=77.0)
    step = named(span=span, bound="bound")
    state = named(
        clock=named(time=START, step=0.125), q="q", u="u", a="a", now=named(touched=77), counts=named(flights=3),
    )  # fmt: skip

    def begin_flight(model, state, length, step) -> None:
        calls.append(("begin", length))

    def coupled_step(model, state, options, longest, scratch):
        calls.append(("coupled", longest))
        span.length = min(longest, given["length"])
        state.clock.step = 0.25
        return given["made"], -0.5

    def first_touch(model, cells, state, options, upto, scratch):
        calls.append(("touch", upto))
        return given["known"], given["touch"], given["contact"]

    def accept(model, state, options, end, contact, scratch):
        calls.append(("accept", end, contact))
        return end if given["accepted"] is None else given["accepted"], given["explained"]

    instead = {
        "can_fly": lambda *_: flying,
        "flight_length": lambda *_: (given["length"], 0.0625),
        "begin_flight": begin_flight,
        "time_through_cells": lambda model, p, q, u, bound, cells: (
            given["cells"][p] if (bound, cells) == ("bound", FLIGHT_CELLS) else None
        ),
        "first_turn": lambda *_: given["leave"],
        "next_knot": lambda model, t: given["knot"] if t == START else None,
        "coupled_step": coupled_step,
        "first_leave": lambda model, state, options, smallest, scratch: (
            (given["leave"], given["code"]) if smallest == -0.5 else None
        ),
        "first_touch": first_touch,
        "add_flight_sums": lambda model, state, step, end: calls.append(("sums", end)),
        "keep_flight_rows": lambda model, state, end, spacing, step, record: calls.append(("flight rows", end, spacing)),
        "accept_coupled": accept,
        "keep_inner_rows": lambda model, options, end, step, record: calls.append(("inner rows", end)),
        "keep_row": lambda state, record, t, q, u, a: calls.append(("row", t)),
        "keep_passages": lambda model, state, step, end, record: calls.append(("passages", end)),
        "_note_end": lambda state, contact, code, ended: calls.append(("ended", contact, code)),
    }
    model, scratch = named(pairs=[None, None]), named(step=step, ended=None)
    kernel = in_python(loop._smooth_step, **instead)
    found = kernel(model, None, state, named(max_step=given["max_step"]), START + given["left"], scratch, None)
    return named(found=found, calls=calls, time=state.clock.time - START, step=state.clock.step, touched=state.now.touched,
                 flights=state.counts.flights, length=span.length)  # fmt: skip


def test_a_flight_goes_up_to_its_end() -> None:
    done = stepped(True)
    assert done.found == (Stop.RUNNING, False) and (done.time, done.touched, done.flights) == (0.5, NO_CONTACT, 4)
    assert done.calls == [("begin", 0.5), ("touch", 0.5), ("sums", 0.5), ("flight rows", 0.5, 0.0625), ("passages", 0.5)]
    assert stepped(True, left=0.375).calls[:2] == [("begin", 0.375), ("touch", 0.375)]
    for cells in ([0.25, 9.0], [9.0, 0.25]):
        assert stepped(True, cells=cells).calls[:2] == [("begin", 0.5), ("touch", 0.25)]
    assert stepped(True, left=0.125, cells=[0.25, 9.0]).length == 0.125


def test_a_flight_ends_where_a_bearing_stops_or_something_touches() -> None:
    done = stepped(True, leave=0.25)
    assert done.found == (Stop.RUNNING, True) and done.time == 0.25 and done.calls[-1] == ("ended", NO_CONTACT, NONE_FIRED)
    assert done.calls[1] == ("touch", 0.25)
    done = stepped(True, touch=0.125, contact=5)
    assert done.found == (Stop.RUNNING, True) and (done.time, done.touched) == (0.125, 5)
    assert done.calls[-2:] == [("passages", 0.125), ("ended", 5, NONE_FIRED)]
    assert stepped(True, leave=0.5).found == (Stop.RUNNING, True)


def test_a_step_waits_for_an_unknown_cell() -> None:
    """The length proposed stays, so that the same step is tried again."""
    for flying in (True, False):
        done = stepped(flying, known=False)
        assert done.found == (Stop.CELL_UNKNOWN, False) and done.calls[-1] == ("touch", 0.5)
        assert (done.time, done.step, done.touched) == (0.0, 0.125, 77)


def test_a_coupled_step_is_as_long_as_time_options_and_tables_allow() -> None:
    done = stepped(False)
    rows = [("inner rows", 0.5), ("row", START + 0.5), ("passages", 0.5)]
    assert done.found == (Stop.RUNNING, False) and (done.time, done.step, done.flights) == (0.5, 0.25, 3)
    assert done.calls == [("coupled", 0.75), ("touch", 0.5), ("accept", 0.5, NO_CONTACT), *rows]
    assert stepped(False, max_step=0.625).calls[0] == ("coupled", 0.625)
    assert stepped(False, knot=START + 0.375).calls[0] == ("coupled", 0.375)
    assert stepped(False, made=False).found == (Stop.STEP_TOO_SMALL, False)


def test_a_coupled_step_ends_with_its_mode_or_a_touch() -> None:
    done = stepped(False, leave=0.25)
    assert done.found == (Stop.RUNNING, True) and done.calls[1:3] == [("touch", 0.25), ("accept", 0.25, NO_CONTACT)]
    assert done.calls[-1] == ("ended", NO_CONTACT, 6) and done.time == 0.25
    done = stepped(False, touch=0.375, contact=0, leave=0.4375)
    assert done.found == (Stop.RUNNING, True) and done.calls[2] == ("accept", 0.375, 0) and done.time == 0.375
    done = stepped(False, touch=0.375, contact=5, accepted=0.25)
    assert done.time == 0.25 and done.calls[3:6] == [("inner rows", 0.25), ("row", START + 0.25), ("passages", 0.25)]
    assert stepped(False, explained=False).found == (Stop.UNEXPLAINED, False)


def test_the_last_step_ends_at_the_very_end_of_the_run() -> None:
    """Not at the sum of start and way, which may be rounded."""
    assert stepped(True, left=0.1, length=9.0).time + START == START + 0.1
    for left in (0.1, 0.3, 0.7):
        done = stepped(False, left=left, length=9.0)
        assert done.time + START == START + left


def settled(**script: Any) -> SimpleNamespace:
    """Code, calls and state of an event at 2 s, where the last one was 1 µs before; energies before and after it."""
    given: dict[str, Any] = {
        "ago": 1e-6, "events": 5, "code": Stop.RUNNING, "hits": 0, "touched": NO_CONTACT, "before": 3.0,
        "after": 2.0, "explained": True, "once": True, "worst": 2.5, **script,
    }  # fmt: skip
    calls: list[Any] = []
    energies = iter([given["before"], given["after"]])
    state = named(
        clock=named(time=START, event=START - given["ago"]), u="u", q="q", a="a",
        now=named(events=given["events"], touched=given["touched"]), counts=named(impacts=7, jams=9, instants=11),
        sums=named(impacts=0.75, drive=0.25), worst=named(kinetic_energy=given["worst"]),
    )  # fmt: skip

    def settle(model, cells, state, options, scratch, record) -> int:
        calls.append("settle")
        state.now.touched = 77
        state.sums.impacts += 0.625
        state.sums.drive += 0.5
        state.counts.impacts += given["hits"]
        state.counts.jams += given.get("jams", 0)
        return int(given["code"])

    def explained(model, options, before, after, highest) -> bool:
        calls.append((before, after, highest))
        return bool(given["explained"])

    instead = {
        "settle": settle, "kinetic_energy": lambda model, u: next(energies), "is_explained": explained,
        "begin_instant": lambda state: calls.append("begin"), "forget_decisions": lambda state: calls.append("forget"),
        "decide_once": lambda state: calls.append("once") or given["once"],
        "keep_passages": lambda model, state, step, end, record: calls.append(("passages", end)),
        "keep_row": lambda state, record, t, q, u, a: calls.append(("row", t, q, u, a)),
    }  # fmt: skip
    options = named(accumulation_time=1e-6)
    code = in_python(loop._settle, **instead)(None, None, state, options, named(step=None), None)
    return named(code=int(code), calls=calls, state=state)


KEPT = [("passages", 0.0), ("row", START, "q", "u", "a")]


def test_an_event_is_settled_and_written_down() -> None:
    """What impulses take is added to the energy, what drives gave taken away."""
    done = settled()
    assert done.code == Stop.RUNNING
    assert done.calls == ["begin", "settle", (3.0, 2.125, 3.0), "once", *KEPT]
    assert (done.state.now.events, done.state.clock.event, done.state.counts.instants) == (1, START, 12)
    assert done.state.worst.kinetic_energy == 3.0
    assert settled(worst=3.5).calls[2] == (3.0, 2.125, 3.5) and settled(after=3.75, worst=3.5).calls[2][2] == 3.75
    assert settled(worst=3.5).state.worst.kinetic_energy == 3.5


@pytest.mark.parametrize(("share", "fresh"), [(0.99, False), (1.01, True)])
def test_events_within_a_thousandth_of_an_accumulation_are_at_once(share: float, fresh: bool) -> None:
    done = settled(ago=share * 1e-9)
    assert ("begin" in done.calls) == fresh and done.state.now.events == (1 if fresh else 6)
    assert settled(ago=share * 1e-9, events=EVENTS_AT_ONCE).code == Stop.RUNNING
    assert settled(ago=share * 1e-9, events=EVENTS_AT_ONCE + 1).code == (Stop.RUNNING if fresh else Stop.TOO_MANY_EVENTS)


def test_after_an_impact_modes_may_be_decided_again_and_without_a_touch_only_once() -> None:
    assert settled(hits=1).calls[3:] == ["forget", *KEPT] == settled(jams=1, once=False).calls[3:]
    assert settled(touched=0).calls[3:] == KEPT
    assert settled(once=False).code == Stop.TOO_MANY_EVENTS and settled(once=False, touched=4).code == Stop.RUNNING
    assert settled(once=False).calls[3:] == ["once"]


def test_an_event_that_fails_or_is_not_explained_ends_the_run() -> None:
    done = settled(code=Stop.LCP_FAILED)
    assert done.code == Stop.LCP_FAILED and done.calls == ["begin", "settle"] and done.state.worst.kinetic_energy == 2.5
    assert settled(explained=False).code == Stop.UNEXPLAINED


def test_work_that_is_done_again_counts_once() -> None:
    names = ("steps", "rejected_steps", "evaluations", "gap_evaluations", "cells_looked_up")
    state = named(counts=named(**{name: 10 * i for i, name in enumerate(names, 1)}))
    assert in_python(loop._work_done)(state) == (10, 20, 30, 40, 50)
    for code, expected in ((Stop.BUFFER_FULL, [10, 20, 30, 40, 50]), (Stop.CELL_UNKNOWN, [1, 2, 3, 4, 5])):
        assert in_python(loop._undone)(code, state, (1, 2, 3, 4, 5)) == code
        assert [getattr(state.counts, name) for name in names] == expected
