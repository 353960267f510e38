"""What follows an event, step by step? With made-up answers of what is called."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from made_up import both, closed_of, named, work_of
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.events import after_event
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.stops import Stop

EXTENT = 1e-9
OPTIONS = named(extent=EXTENT, behind=2e-8, speed_zero=1e-8)
LEFT = 1.5  # extents beyond the end of a primitive


def written() -> SimpleNamespace:
    return named(events=np.zeros(9, EVENT_DTYPE).view(np.recarray), used=named(events=0))


def kinds(record: SimpleNamespace) -> list[tuple[int, int]]:
    return [(int(e.kind), int(e.contact)) for e in record.events[: record.used.events]]


def test_the_contacts_that_are_closed_keep_their_order() -> None:
    out = [77] * 5
    state = named(mode={4: STICK, 6: OPEN, 2: BACKWARD, 9: FORWARD})
    assert in_python(after_event._closed_of)(state, 3, [4, 6, 2, 9], out) == 2 and out == [4, 2, 77, 77, 77]


@pytest.mark.parametrize(("margins", "active", "awake", "asleep", "opened"), [
    ({}, [4, 6, 2, 9, 5], 3, 2, []),
    ({4: -1.6}, [6, 2, 9, 5], 2, 2, [4]),
    ({2: -1.6, 9: -1.6}, [4, 6, 5], 2, 1, [2, 9]),
    ({4: -1.4, 9: -1.4}, [4, 6, 2, 9, 5], 3, 2, []),
    ({9: -1.6, 5: -1.6}, [4, 6, 2], 3, 0, [9, 5]),
])  # fmt: skip
def test_contacts_that_have_left_their_primitives_open(margins, active, awake: int, asleep: int, opened: list[int]) -> None:
    """By an extent and a half; three are of awake bodies, two of sleeping ones."""
    modes = {4: STICK, 6: FORWARD, 2: STICK, 9: STICK, 5: BACKWARD}
    now, record = named(awake_contacts=3, sleeping_contacts=2), written()
    state = named(active=[4, 6, 2, 9, 5], mode=modes, now=now, clock=named(time=2.5), counts=named(events=0))
    kernel = in_python(after_event._release, extent_margin=lambda model, k, pose: margins.get(k, 0.0) * EXTENT)
    kernel(None, state, OPTIONS, None, record)
    assert state.active[: len(active)] == active and (now.awake_contacts, now.sleeping_contacts) == (awake, asleep)
    assert kinds(record) == [(EventKind.OPEN, k) for k in opened]
    assert [k for k, mode in modes.items() if mode == OPEN] == opened


def test_modes_decided_take_the_place_of_the_old_ones() -> None:
    """What is not in I_N is open; each change is written down."""
    modes, changes = {4: STICK, 6: FORWARD, 2: STICK, 9: OPEN}, []
    state = named(mode=modes)
    event = named(
        closed=named(ids=[4, 6, 2, 9, 77]), rest=named(ids=[9, 2, 4, 6]), decided={9: FORWARD, 2: STICK, 6: 99, 4: 99}
    )
    kernel = in_python(after_event._take, keep_change=lambda state, record, k, old: changes.append((k, old, state.mode[k])))
    kernel(state, 4, 2, event, None)
    assert changes == [(4, STICK, OPEN), (6, FORWARD, OPEN), (2, STICK, STICK), (9, OPEN, FORWARD)]
    assert modes == {4: OPEN, 6: OPEN, 2: STICK, 9: FORWARD}


def test_contacts_of_awake_bodies_are_listed_first() -> None:
    """In their order; places of islands are those of awake ones."""
    active, sorted_ = [4, 6, 2, 9, 77, 77], []
    now = named(awake_contacts=0, sleeping_contacts=0)
    state = named(active=active, awake=[0, 1, 1, 0], now=now, upto="upto")
    event = named(in_force=[0] * 6, label="label")
    instead = {
        "island_of": lambda model, label, k: {4: 0, 6: 2, 2: 3, 9: 1}[k],
        "sort_by_island": lambda model, label, m, ids, upto: sorted_.append((label, m, ids, upto)),
    }
    in_python(after_event._list_awake_first, **instead)(None, state, 4, event)
    assert active[:4] == [6, 9, 4, 2] and (now.awake_contacts, now.sleeping_contacts) == (2, 2)
    assert sorted_ == [("label", 2, active, "upto")]


MASS = np.array([1.5, 0.4, 2.0, 0.7])
NORMAL = np.array([[1.0, 0.3, 0.2, -0.6], [0.4, -1.2, 0.5, 0.9]])
TANGENTIAL = np.array([[-0.2, 1.0, 0.3, 1.3], [0.8, 0.1, -0.4, 0.7]])


@pytest.mark.parametrize(("modes", "slips", "tried"), [
    ((FORWARD, STICK), (1e-9, 2e-9), (FORWARD, STICK)),
    ((FORWARD, STICK), (-1e-9, -2e-9), (STICK, STICK)),
    ((BACKWARD, FORWARD), (1e-9, 0.0), (STICK, FORWARD)),
    ((BACKWARD, FORWARD), (-1e-9, -3e-9), (BACKWARD, STICK)),
])  # fmt: skip
def test_what_slips_against_its_mode_is_stopped_as_gaps_and_rates_are_closed(modes, slips, tried) -> None:
    ids, gaps, rates = [6, 2], [-3e-9, 4e-9], [2e-9, -5e-9]
    rest = closed_of(NORMAL, TANGENTIAL, ids, g=gaps, gN_dot=rates, gT_dot=list(slips))
    state = named(mode={6: modes[0], 2: modes[1]}, q=np.zeros(4), u=np.zeros(4), worst=named(penetration=2e-9))
    trial, root, every = np.full(8, 77), np.sqrt(1.0 / MASS), both(NORMAL, TANGENTIAL)
    in_python(after_event._correct)(state, 2, OPTIONS, work_of(2, 1.0 / MASS), rest, trial)
    assert (trial[6], trial[2]) == tried and state.worst.penetration == 3e-9
    assert state.q == pytest.approx(root * (np.linalg.pinv(NORMAL * root) @ [3e-9, -4e-9]), rel=1e-9, abs=0.0)
    rows = [0, 2] + [2 * i + 1 for i in range(2) if tried[i] == STICK]
    wanted = -np.array([rates[0], slips[0], rates[1], slips[1]])[rows]
    assert state.u == pytest.approx(root * (np.linalg.pinv(every[rows] * root) @ wanted), rel=1e-9, abs=0.0)


def landed(touched: int = 8, margins=(0.0, -1.6), room: int = 3) -> list[object]:
    """What is done where contact 8 has just closed beside 3 and 9 in force, which are that many extents within."""
    calls: list[object] = []
    state = named(active=[9, 3, 77], now=named(awake_contacts=2, touched=touched), q="q", u="u", grip="grip")
    event = named(closed=named(ids=[0] * room), listed=[77] * 4, pose="pose")
    instead = {
        "extent_margin": lambda model, k, pose: dict(zip((9, 3), margins, strict=True))[k] * EXTENT,
        "fill_inverse": lambda model, grip, inverse: calls.append((grip, inverse)),
        "place_contacts": lambda model, ids, first, last, pose, closed: calls.append((ids[first:last], pose)),
        "project_positions": lambda closed, m, both, behind, work, q: calls.append((m, both, behind, q)),
        "place": lambda model, q, u, pose: calls.append("place"),
    }
    in_python(after_event._land, **instead)(None, state, OPTIONS, named(inverse="inverse"), event)
    return calls


def test_where_something_lands_while_another_seems_to_leave_drift_of_both_is_taken_back() -> None:
    # `insert` keeps ascending order among what stands in the list.
    done = landed()
    assert done[0] == ("grip", "inverse") and done[2:] == [(3, True, OPTIONS.behind, "q"), "place"]
    assert sorted(done[1][0]) == [3, 8, 9] and done[1][1] == "pose"  # type: ignore[index]
    assert landed(margins=(-1.6, 0.0)) == done
    assert landed(margins=(0.0, -1.4)) == landed(touched=NO_CONTACT) == landed(room=2) == []


def settled(**changed: object) -> tuple[int, list[object], SimpleNamespace]:
    """(code, calls, now) of an instant with contacts 9, 4, 7 in islands 0, 0, 2 of four coordinates."""
    given: dict[str, Any] = {"handed": True, "gathered": Stop.RUNNING, "stops": {}, **changed}
    calls: list[object] = []
    now = named(event_waits=1, touched=4)
    state = named(q="q", u="u", now=now, active="active")
    event = named(pace=np.full(4, 77.0), pose="pose", label=[0, 0, 2, 3], listed=[9, 4, 7], upto=[2, 2, 3])

    def island(model, state, island, span, options, scratch, record) -> int:
        calls.append((island, span))
        return int(given["stops"].get(island, Stop.RUNNING))

    instead = {
        "place": lambda model, q, u, pose: calls.append("place"),
        "_land": lambda *_: calls.append("land"),
        "hand_over": lambda *_: calls.append("hand over") or given["handed"],
        "_release": lambda *_: calls.append("release"),
        "gather": lambda *_: (given["gathered"], 3),
        "label_islands": lambda model, ids, m, label: calls.append(("label", m)),
        "sort_by_island": lambda model, label, m, ids, upto: calls.append(("sort", m)),
        "island_of": lambda model, label, k: {9: 0, 4: 0, 7: 2}[k],
        "_settle_island": island,
        "_closed_of": lambda state, m, ids, out: 10 * m,
        "_go_on": lambda model, state, f, options, scratch, record: calls.append(("go on", f)),
    }
    code = in_python(after_event.settle, **instead)(None, None, state, OPTIONS, named(event=event, work=None), None)
    assert event.pace.tolist() == [0.0] * 4
    return int(code), calls, now


def test_an_instant_is_settled_island_by_island() -> None:
    """Also those without a contact: their bearings may stand."""
    begin = ["place", "land", "hand over", "release", ("label", 3), ("sort", 3)]
    code, calls, now = settled()
    assert code == Stop.RUNNING and (now.event_waits, now.touched) == (0, NO_CONTACT)
    assert calls == [*begin, (0, (0, 2)), (2, (2, 3)), (3, (3, 3)), ("go on", 30)]
    code, calls, now = settled(stops={2: Stop.LCP_FAILED})
    assert (code, calls[6:]) == (Stop.LCP_FAILED, [(0, (0, 2)), (2, (2, 3))]) and (now.event_waits, now.touched) == (1, 4)


def test_an_instant_waits_where_a_cell_is_unknown() -> None:
    assert settled(handed=False)[:2] == (Stop.CELL_UNKNOWN, ["place", "land", "hand over"])
    assert settled(gathered=Stop.TOO_MANY_CONTACTS)[:2] == (Stop.TOO_MANY_CONTACTS, ["place", "land", "hand over", "release"])


def island(deepest: float = 0.0, stop: Stop = Stop.RUNNING) -> tuple[int, list[object], float]:
    """(code, calls, worst penetration) of an island with the contacts at places 2 to 4, of which two and then one are left."""
    calls: list[object] = []
    instead = {
        "fill_inverse": lambda model, grip, inverse: calls.append("inverse"),
        "place_contacts": lambda model, ids, first, last, pose, closed: calls.append((ids, first, last)) or last - first,
        "drop_immovable": lambda model, state, m, event, record: calls.append(("immovable", m)) or m - 1,
        "drop_later": lambda model, state, m, options, work, event: calls.append(("later", m)) or m - 1,
        "note_pace": lambda u, pace: calls.append((u, pace)),
        "project_positions": lambda closed, m, both, behind, work, q: calls.append((m, both, behind, q)) or deepest,
        "place": lambda *_: calls.append("place"),
        "refresh": lambda model, m, closed, pose: calls.append(("refresh", m)),
        "project_velocities": lambda closed, m, mode, independent, work, u: calls.append((m, mode, independent, u)),
        "_resolve": lambda model, state, island, m, options, scratch, record: calls.append((island, m)) or (stop, 5),
        "_take": lambda state, m, r, event, record: calls.append(("take", m, r)),
    }
    state = named(grip=None, u="u", q="q", mode="mode", worst=named(penetration=3e-9))
    scratch = named(work=named(inverse=None), event=named(closed=None, listed="listed", pose=None, pace="pace"))
    code = in_python(after_event._settle_island, **instead)(None, state, 7, (2, 5), OPTIONS, scratch, None)
    return int(code), calls, state.worst.penetration


def test_an_island_is_settled_with_what_can_move_and_is_met_now() -> None:
    begin = ["inverse", ("listed", 2, 5), ("immovable", 3), ("later", 2), ("u", "pace"), (1, False, OPTIONS.behind, "q")]
    assert island() == (Stop.RUNNING, [*begin, (7, 1), ("take", 1, 5)], 3e-9)
    again = ["place", ("refresh", 1), (1, "mode", 1e-6, "u"), "place", ("refresh", 1)]
    assert island(1e-12) == (Stop.RUNNING, [*begin, *again, (7, 1), ("take", 1, 5)], 3e-9)
    assert island(4e-9)[2] == 4e-9
    assert island(stop=Stop.LCP_FAILED) == (Stop.LCP_FAILED, [*begin, (7, 1)], 3e-9)


def resolved(**script: list[Any]) -> tuple[tuple[int, int], list[object], int]:
    """((code, contacts in I_N), calls, failures counted); what is called answers in turn, the last answer for ever."""
    calls: list[object] = []
    usual: dict[str, list[Any]] = {
        "approaching": [False], "collide": [True], "decide": [(2, True)], "stop_at_dead_centre": [False],
        "stands_at_dead_centre": [False], "contradicts": [False], "stop_rounding": [True], "slides": [True],
    }  # fmt: skip
    answers = {name: list(script.get(name, usual[name])) for name in usual}

    def told(name: str, value: object = None) -> Any:
        calls.append(name if value is None else (name, value))
        left = answers[name]
        return left.pop(0) if len(left) > 1 else left[0]

    instead = {
        "set_rate_zeros": lambda closed, m, exactly, options, pace, zero: calls.append("exactly") if exactly else None,
        "approaching": lambda m, closed, zero: told("approaching"),
        "collide": lambda model, state, island, m, options, jam, scratch, record: told("collide", jam),
        "decide": lambda *_: told("decide"),
        "stop_at_dead_centre": lambda *_: told("stop_at_dead_centre"),
        "stands_at_dead_centre": lambda *_: told("stands_at_dead_centre"),
        "contradicts": lambda *_: told("contradicts"),
        "stop_rounding": lambda *_: told("stop_rounding"),
        "slides": lambda r, speed, rest: told("slides"),
        "stop_held": lambda *_: calls.append("held"),
        "hold_gaps": lambda *_: calls.append("hold gaps"),
        "place": lambda *_: calls.append("place"),
        "refresh": lambda *_: calls.append("refresh"),
    }
    counts = named(lcp_failures=0)
    state = named(q=None, u=None, grip=None, counts=counts)
    event = named(closed=None, rest=None, pace=None, zero=None, pose=None, label=None)
    found = in_python(after_event._resolve, **instead)(None, state, 7, 3, OPTIONS, named(work=None, event=event), None)
    return found, calls, counts.lcp_failures


ASKED = ["decide", "stop_at_dead_centre", "stands_at_dead_centre"]


def test_impacts_are_resolved_until_nothing_approaches_then_modes_are_decided() -> None:
    found, calls, _ = resolved(approaching=[True, True, False])
    assert found == (Stop.RUNNING, 2)
    assert calls == ["approaching", ("collide", 0.0)] * 2 + ["approaching", *ASKED, "contradicts", "held"]
    assert resolved(approaching=[True], collide=[False])[0] == (Stop.LCP_FAILED, 0)
    found, calls, _ = resolved(approaching=[True])
    assert found == (Stop.TOO_MANY_EVENTS, 0) and calls == ["approaching", ("collide", 0.0)] * 16


def test_rates_that_contradict_modes_are_taken_exactly_once() -> None:
    found, calls, _ = resolved(contradicts=[True])
    assert found == (Stop.RUNNING, 2)
    assert calls == ["approaching", *ASKED, "contradicts", "exactly", "approaching", *ASKED, "held"]


def test_on_the_line_of_centres_bodies_are_stopped_or_stand() -> None:
    found, calls, _ = resolved(stop_at_dead_centre=[True, False])
    assert calls[:6] == ["approaching", "decide", "stop_at_dead_centre", "place", "refresh", "approaching"]
    found, calls, _ = resolved(stands_at_dead_centre=[True], decide=[(3, False)])
    assert found == (Stop.RUNNING, 3) and calls == ["approaching", *ASKED]


def test_where_no_forces_exist_what_slides_is_jammed_and_stopped_by_impulses() -> None:
    """Not before rounding of an impact has been taken away; what does not slide is a failure."""
    found, calls, failures = resolved(decide=[(2, False), (2, True)])
    assert found == (Stop.RUNNING, 2) and failures == 0
    assert calls == [
        "approaching",
        *ASKED,
        "slides",
        "hold gaps",
        "refresh",
        ("collide", 1e-8),
        "approaching",
        *ASKED,
        "contradicts",
        "held",
    ]
    assert resolved(decide=[(2, False)], slides=[False])[::2] == ((Stop.LCP_FAILED, 0), 1)
    found, calls, _ = resolved(approaching=[True, False], decide=[(2, False), (2, False), (2, True)])
    assert calls[:7] == ["approaching", ("collide", 0.0), "approaching", *ASKED, "stop_rounding"]
    assert calls[7:14] == ["approaching", *ASKED, "slides", "hold gaps", "refresh"]
    found, calls, _ = resolved(approaching=[True, False], decide=[(2, False), (2, True)], stop_rounding=[False])
    assert calls[6:10] == ["stop_rounding", "slides", "hold gaps", "refresh"]
    found, calls, _ = resolved(decide=[(2, False), (2, False), (2, True)])
    assert "stop_rounding" not in calls  # a jam is no impact that left rounding
    assert calls.count("slides") == 2


def gone_on(unique: bool = True) -> tuple[list[object], SimpleNamespace]:
    """What is done with contacts 9 and 4 in one island, 7 in another one; the first loses one as it is looked at."""
    calls: list[object] = []
    state = named(
        active=[9, 4, 7, 77], upto=[2, 2, 3], clock=named(time=2.5), q="q", u="u", grip="grip", a="a",
        counts=named(redundant_sets=4), mode={9: STICK, 4: OPEN, 7: FORWARD},
    )  # fmt: skip
    work = named(h="h", inverse="inverse", force="force")
    event = named(rest="rest", label="label", pose="pose", terms="terms", trial="trial")
    instead = {
        "label_islands": lambda model, ids, m, label: calls.append(("label", m)),
        "sort_by_island": lambda model, label, m, ids, upto: calls.append(("sort", m)),
        "place": lambda *_: calls.append("place"),
        "forces": lambda model, t, q, u, h: calls.append(("forces", t)),
        "add_drag": lambda *_: calls.append("drag"),
        "fill_inverse": lambda *_: calls.append("inverse"),
        "accelerate": lambda model, rest, m, work, a: calls.append(("accelerate", m)),
        "begin_terms": lambda h, terms: calls.append("terms"),
        "place_contacts": lambda model, ids, first, last, pose, rest: last - first,
        "_correct": lambda state, m, options, work, rest, trial: calls.append(("correct", m)),
        "let_go": lambda model, state, m, options, work, event, record: (m - 1 if m == 2 else m, unique),
        "apply": lambda rest, m, force, inverse, a: calls.append(("apply", m, force, inverse, a)),
        "hold_at_dead_centre": lambda model, state, m, work, rest: calls.append(("hold", m)),
        "add_terms": lambda rest, m, force, terms: calls.append(("add terms", m)),
        "find_sleepers": lambda model, state, options, event, f: calls.append(("sleepers", f)),
        "_list_awake_first": lambda model, state, f, event: calls.append(("list", f)),
    }
    in_python(after_event._go_on, **instead)(None, state, 3, OPTIONS, named(work=work, event=event), None)
    return calls, state


def test_what_is_in_force_gets_exact_gaps_forces_and_accelerations_and_may_sleep() -> None:
    calls, state = gone_on()
    start = [("label", 3), ("sort", 3), "place", ("forces", 2.5), "drag", "inverse", ("accelerate", 0), "terms"]
    acts = ("force", "inverse", "a")
    first = [("correct", 2), ("apply", 1, *acts), ("hold", 1), ("add terms", 1)]
    second = [("correct", 1), ("apply", 1, *acts), ("hold", 1), ("add terms", 1)]
    assert calls == [*start, *first, *second, ("sleepers", 2), ("list", 2)]
    assert state.active[:2] == [9, 7] and state.counts.redundant_sets == 4
    assert gone_on(unique=False)[1].counts.redundant_sets == 6
