"""What follows an event, step by step? With made-up answers of what is called."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from made_up import both, closed_of, named, work_of
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.events import after_event, immovable
from watchsim.simulation.loop_state.state import NO_CONTACT

EXTENT = 1e-9
OPTIONS = named(extent=EXTENT, behind=2e-8, speed_zero=1e-8)


def written() -> SimpleNamespace:
    return named(events=np.zeros(9, EVENT_DTYPE).view(np.recarray), used=named(events=0))


def kinds(record: SimpleNamespace) -> list[tuple[int, int]]:
    """Of what happened to contacts: no body is named, and there is no value."""
    assert {(int(e.body), float(e.value)) for e in record.events[: record.used.events]} <= {(-1, 0.0)}
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


@pytest.mark.parametrize(("fixed", "left", "opened"), [
    ((), [4, 6, 2, 9], []), ((4,), [6, 2, 9], [4]), ((6, 9), [4, 2], [9]), ((2,), [4, 6, 9], [2]),
    ((4, 6, 2, 9), [], [4, 2, 9]),
])  # fmt: skip
def test_contacts_whose_gap_nothing_moves_are_left_out_and_open(
    fixed: tuple[int, ...], left: list[int], opened: list[int]
) -> None:
    """Contact 6 is open already."""
    modes, record = {4: STICK, 6: OPEN, 2: FORWARD, 9: BACKWARD}, written()
    closed = named(ids=[4, 6, 2, 9])

    def move(model, k, pose, row, out) -> None:
        out.ids[row] = k

    state = named(mode=modes, clock=named(time=2.5), counts=named(events=0))
    instead = {"is_immovable": lambda model, closed, i: closed.ids[i] in fixed, "contact_kinematics": move}
    kept = in_python(immovable.drop_immovable, **instead)(None, state, 4, named(closed=closed, pose=None), record)
    assert closed.ids[:kept] == left and kinds(record) == [(EventKind.OPEN, k) for k in opened]
    assert all(modes[k] == OPEN for k in opened) and all(modes[k] != OPEN for k in left if k != 6)


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
