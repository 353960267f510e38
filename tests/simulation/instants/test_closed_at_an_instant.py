"""Which contacts are closed at an instant, and which of them rest? Rule by rule."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from made_up import named
from plain_kernels import in_python

from watchsim.candidates.cell_lookup import ALL, LISTED, UNKNOWN
from watchsim.contact.index_sets import FORWARD, OPEN, STICK
from watchsim.simulation.events import closed_contacts
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.stops import Stop

EXTENT = 1e-9
OPTIONS = named(extent=EXTENT, gap_close=2e-10, behind=2e-8)


@pytest.mark.parametrize("seed", range(20))
def test_numbers_are_inserted_in_order_and_once(seed: int) -> None:
    rng = np.random.default_rng(seed)
    ids, count, kept = [77] * 12, 0, set()
    for k in rng.integers(0, 9, 20).tolist():
        kept.add(k)
        count = in_python(closed_contacts.insert)(ids, count, k)
        assert ids[:count] == sorted(kept)


def gathered(**changed: object) -> tuple[tuple[int, int], list[int], list[object], int]:
    """((code, number), contacts, cells asked for, cells looked up): 4 in force awake, 9 asleep; 2, 3, 7 candidates of the
    second of two pairs, 11 of the first."""
    given: dict[str, object] = {
        "gaps": {2: 1e-10, 3: 0.0, 7: -1e-8, 11: 0.0}, "margins": {}, "rest": (False, False), "time": 1.0,
        "touched": NO_CONTACT, "how": [ALL, LISTED], "same": (), "room": 9, "modes": {}, **changed,
    }  # fmt: skip
    g = SimpleNamespace(**given)
    listed, asked = np.full(g.room, 77), []
    slots = [[11], [2, 3, 7]]
    state = named(
        active=[9, 4, 77], now=named(awake_contacts=1, sleeping_contacts=1, touched=g.touched), q="q",
        clock=named(time=g.time), counts=named(cells_looked_up=5), mode={k: g.modes.get(k, OPEN) for k in (2, 3, 7, 11)},
    )  # fmt: skip
    instead = {
        "is_at_rest": lambda model, state, b: g.rest[b % 2] if b < 2 else True,
        "candidates": lambda model, cells, p, q: (g.how[p], 10 * (p + 1), len(slots[p])),
        "candidate": lambda model, cells, how, place: slots[place // 10 - 1][place % 10],
        "normal_gap": lambda model, k, pose: named(gap=g.gaps[k]),
        "extent_margin": lambda model, k, pose: g.margins.get(k, 0.0),
        "continues_active": lambda model, state, options, k, pose: k in g.same,
        "ask": lambda room, p, q: asked.append((room, p, q)),
    }
    model = named(pairs=[named(a=0, b=1), named(a=0, b=1)])
    scratch = named(event=named(listed=listed, pose=None), asked="room")
    code, m = in_python(closed_contacts.gather, **instead)(model, None, state, OPTIONS, scratch)
    return (code, m), listed[:m].tolist(), asked, state.counts.cells_looked_up


def test_closed_are_those_in_force_and_those_whose_gap_counts_as_zero_within_their_primitives() -> None:
    assert gathered() == ((Stop.RUNNING, 6), [2, 3, 4, 7, 9, 11], [], 6)
    assert gathered(gaps={2: 2.1e-10, 3: 1.9e-10, 7: -1.9e-8, 11: -2.1e-8})[1] == [3, 4, 7, 9]
    assert gathered(margins={2: -1.1 * EXTENT, 3: -0.9 * EXTENT})[1] == [3, 4, 7, 9, 11]
    assert gathered(same=(3,))[1] == [2, 4, 7, 9, 11]
    assert gathered(modes={2: STICK, 7: FORWARD})[1] == [3, 4, 9, 11]


def test_what_has_just_touched_is_closed_whatever_its_gap() -> None:
    assert gathered(touched=5)[1] == [2, 3, 4, 5, 7, 9, 11]
    assert gathered(touched=0)[1] == [0, 2, 3, 4, 7, 9, 11]


def test_pairs_that_both_rest_are_not_looked_at_after_the_start() -> None:
    assert gathered(rest=(True, True))[1] == gathered(rest=(True, True), time=1e-9)[1] == [4, 9]
    assert gathered(rest=(True, False))[1] == gathered(rest=(False, True))[1] == [2, 3, 4, 7, 9, 11]
    assert gathered(rest=(True, True), time=0.0)[1] == [2, 3, 4, 7, 9, 11]


def test_unknown_cells_and_want_of_room_are_told() -> None:
    assert gathered(how=[ALL, UNKNOWN]) == ((Stop.CELL_UNKNOWN, 3), [4, 9, 11], [("room", 1, "q")], 5)
    assert gathered(room=6)[0] == (Stop.RUNNING, 6)
    assert gathered(room=5)[0] == (Stop.TOO_MANY_CONTACTS, 5)


def test_those_rest_whose_gap_rate_is_zero() -> None:
    placed = []
    kin = [named(gN_dot=rate) for rate in (1e-9, -2.1e-9, -1.9e-9, 1.1e-9)]
    instead = {"contact_kinematics": lambda model, k, pose, row, out: placed.append((k, row, out))}
    kernel = in_python(closed_contacts.resting, **instead)
    assert kernel(None, 4, named(kin=kin, ids=[5, 3, 8, 2]), None, [1e-9, 2e-9, 2e-9, 1e-9], "rest") == 2
    assert placed == [(5, 0, "rest"), (8, 1, "rest")]
    in_python(closed_contacts.refresh, **instead)(None, 2, named(ids=[5, 3, 8]), None)
    assert [(k, row) for k, row, _ in placed[2:]] == [(5, 0), (3, 1)]
