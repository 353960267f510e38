"""Which coordinates act on each other, and which of them sleep? Against connected components of a graph, and rule by rule."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from made_up import named
from plain_kernels import in_python
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from watchsim.contact.index_sets import FORWARD, OPEN, STICK
from watchsim.model.records import FIXED, FREE, OVER_TIME, PIVOT, REPEATED, SLIDE
from watchsim.simulation.motion import contact_islands, sleeping


def body(motion: int, first: int, carrier: int = -1) -> SimpleNamespace:
    return named(motion=motion, first=first, carrier=carrier)


# Coordinates: 0 pivot on the body of 5, 1 to 3 free, 4 slide, 6 to 8 free, 9, 10 and 11 pivots.
BODIES = [
    body(PIVOT, 5),
    body(FREE, 1),
    body(SLIDE, 4),
    body(PIVOT, 0, 0),
    body(FIXED, -1),
    body(FREE, 6),
    body(PIVOT, 9),
    body(FIXED, -1, 0),
    body(PIVOT, 10),
    body(PIVOT, 11),
]
N = 12


def moved_by(b: int) -> int:
    """A coordinate that moves a body, -1 for none."""
    carrier = BODIES[b].carrier
    return BODIES[b].first if BODIES[b].first >= 0 or carrier < 0 else BODIES[carrier].first


def components(pairs: list[tuple[int, int]]) -> list[int]:
    """By coordinate, the smallest one that it is joined to."""
    rows, columns = zip(*pairs, strict=True)
    _, part = connected_components(coo_matrix((np.ones(len(pairs)), (rows, columns)), (N, N)), directed=False)
    return [int(np.flatnonzero(part == own)[0]) for own in part]


@pytest.mark.parametrize("seed", range(25))
def test_contacts_carriers_free_bodies_joints_and_springs_make_islands(seed: int) -> None:
    rng = np.random.default_rng(seed)
    ends = rng.permuted(np.tile(np.arange(len(BODIES)), (6, 1)), axis=1)[:, :2].tolist()
    joints = [named(coordinate=int(i), on=int(j)) for i, j in rng.choice(N, (seed % 2, 2), replace=False)]
    lines = [named(a=int(a), b=int(b)) for a, b in rng.choice(len(BODIES), (seed % 3, 2), replace=False)]
    lines += [named(a=2, b=-1), named(a=4, b=8), named(a=9, b=4), named(a=3, b=8)]
    model = named(
        bodies=BODIES,
        joints=joints,
        lines=lines,
        contacts=[named(a=2 * k, b=2 * k + 1) for k in range(6)],
        primitives=[named(body=b) for pair in ends for b in pair],
    )
    ids = rng.permutation(6)[: seed % 4].tolist()
    label = np.full(N, 77)
    in_python(contact_islands.label_islands)(model, [*ids, 5], len(ids), label)
    pairs = [(1, 2), (1, 3), (5, 0), (6, 7), (6, 8)] + [(one.coordinate, one.on) for one in joints]
    pairs += [(BODIES[one.a].first, BODIES[one.b].first) for one in lines if one.b >= 0]
    pairs += [(moved_by(ends[k][0]), moved_by(ends[k][1])) for k in ids]
    wanted = components([pair for pair in pairs if min(pair) >= 0])
    assert label.tolist() == wanted
    for k in range(6):
        movers = [moved_by(b) for b in ends[k] if moved_by(b) >= 0]
        if k in ids and movers:
            assert in_python(contact_islands.island_of)(model, label, k) == wanted[movers[0]]


def test_a_contact_belongs_to_the_island_of_whatever_of_it_moves() -> None:
    model = named(
        bodies=BODIES,
        contacts=[named(a=0, b=1), named(a=1, b=0), named(a=0, b=2)],
        primitives=[named(body=b) for b in (3, 4, 2)],
    )
    label = [40 + i for i in range(N)]
    assert [in_python(contact_islands.island_of)(model, label, k) for k in range(3)] == [40, 40, 40]


def test_contacts_of_one_island_stand_side_by_side_in_the_order_found() -> None:
    """Islands ascending; behind each contact the end of its island."""
    island = {3: 7, 9: 2, 4: 7, 1: 5, 8: 2, 6: 2, 0: 1}
    ids, upto = np.array([3, 9, 4, 1, 8, 6, 0, 77]), np.full(8, 99)
    in_python(contact_islands.sort_by_island, island_of=lambda model, label, k: island[int(k)])(None, None, 7, ids, upto)
    assert ids.tolist() == [0, 9, 8, 6, 1, 3, 4, 77]
    assert upto.tolist() == [1, 4, 4, 4, 5, 7, 7, 99]


def test_contacts_are_placed_from_the_first_row_on() -> None:
    placed = []
    instead = {"contact_kinematics": lambda model, k, pose, row, closed: placed.append((k, row))}
    assert in_python(contact_islands.place_contacts, **instead)(None, [8, 3, 7, 5, 2], 1, 4, None, None) == 3
    assert placed == [(3, 0), (7, 1), (5, 2)]


LABEL = [0, 0, 2, 3, 3, 5]  # islands of coordinates


def awake(**changed: object) -> tuple[list[int], list[float], list[float]]:
    """(awake?, velocities, accelerations) by coordinate, with contacts in force in islands 0 and 3, all still."""
    given: dict[str, object] = {"still": [True] * 6, "grip": [OPEN] * 6, "driven": [0] * 6, "tables": [], "in_force": [0, 3]}
    given |= changed
    state = named(
        awake=[7] * 6,
        active=[0, 1, 9],
        grip=given["grip"],
        u=np.arange(1.0, 7.0),
        a=np.arange(11.0, 17.0),
        clock=named(time=0.5),
    )
    event = named(label=LABEL, touched=np.full(6, 9), terms=[0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    model = named(
        coordinates=[named(driven=one) for one in given["driven"]], tables=given["tables"], knots=np.array([[0.4], [0.6]])
    )
    shared = []
    instead = {
        "_share_terms": lambda model, terms: shared.append(terms),
        "island_of": lambda model, label, k: given["in_force"][k] if label is LABEL else None,
        "_is_still": lambda model, state, options, i, terms: given["still"][i] and terms == event.terms[i],
    }
    in_python(sleeping.find_sleepers, **instead)(model, state, None, event, len(given["in_force"]))
    assert shared == [event.terms]
    return [int(one) for one in state.awake], state.u.tolist(), state.a.tolist()


def test_islands_that_something_holds_sleep_where_all_of_them_is_still() -> None:
    assert awake() == ([0, 0, 1, 0, 0, 1], [0.0, 0.0, 3.0, 0.0, 0.0, 6.0], [0.0, 0.0, 13.0, 0.0, 0.0, 16.0])
    assert awake(in_force=[0])[0] == [0, 0, 1, 1, 1, 1]
    assert awake(in_force=[5, 2])[0] == [1, 1, 0, 1, 1, 0]
    assert awake(still=[True, False, True, True, True, True])[0] == [1, 1, 1, 0, 0, 1]
    assert awake(still=[True, True, True, True, False, True])[0] == [0, 0, 1, 1, 1, 1]


def test_a_bearing_that_holds_lets_its_island_sleep_too() -> None:
    assert awake(grip=[OPEN, OPEN, STICK, OPEN, OPEN, FORWARD])[0] == [0, 0, 0, 0, 0, 1]
    assert awake(grip=[OPEN, FORWARD, OPEN, OPEN, OPEN, STICK], in_force=[3])[0] == [1, 1, 1, 0, 0, 0]


def test_what_is_driven_or_will_be_pushed_otherwise_does_not_sleep() -> None:
    assert awake(driven=[0, 1, 0, 0, 0, 0])[0] == [1, 1, 1, 0, 0, 1]
    assert awake(driven=[0, 0, 0, 0, 1, 0])[0] == [0, 0, 1, 1, 1, 1]
    for over, count, expected in ((REPEATED, 1, 1), (OVER_TIME, 1, 0), (OVER_TIME, 2, 1)):
        tables = [named(over=OVER_TIME, start=0, count=1, coordinate=0), named(over=over, start=0, count=count, coordinate=4)]
        assert awake(tables=tables)[0] == [0, 0, 1, expected, expected, 1]


def test_a_body_rests_where_its_coordinate_sleeps_and_its_carrier_too() -> None:
    model = named(bodies=[body(FIXED, -1), body(PIVOT, 1), body(PIVOT, 2, 1), body(FIXED, -1, 1), body(PIVOT, 0)])
    for flags, expected in (
        ((1, 0, 0), [True, True, True, True, False]),
        ((0, 1, 0), [True, False, False, False, True]),
        ((0, 0, 1), [True, True, False, True, True]),
    ):
        asked = [in_python(sleeping.is_at_rest)(model, named(awake=list(flags)), b) for b in range(5)]
        assert asked == expected
