"""When are two contacts one, which one follows one that ends, and which are closed at an instant? Rule by rule."""

from __future__ import annotations

import math

import numpy as np
import pytest
from made_up import named
from plain_kernels import in_python

from watchsim.candidates.cell_lookup import ALL, LISTED, UNKNOWN
from watchsim.contact.index_sets import FORWARD, OPEN, STICK
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.events import handover
from watchsim.simulation.loop_state.state import NO_CONTACT

EXTENT = 1e-9
OPTIONS = named(extent=EXTENT, gap_close=2e-10, behind=2e-8)
SMOOTH, SHARP = 1e-5, 1e-2  # rad: normals of one contact, those of different curvature at most
NEAR, FAR = 100.0, 1e4  # extents


def differ(
    bodies=(0, 1, 0, 1), radii=(0.0, 0.0), bends=(0.0, 0.0), turn: float = 0.0, apart: float = 0.0, flipped: bool = False
):
    """`room_to_differ` of contacts 1 and 0 between these bodies; `turn` and `apart`: how their normals and points differ."""
    primitives = [named(body=b, radius=99.0) for b in bodies]
    primitives[0].radius, primitives[2].radius = radii
    contacts = [named(a=2, b=3, curvature=bends[1]), named(a=0, b=1, curvature=bends[0])]
    angle, sign = 0.7, -1.0 if flipped else 1.0
    normals = {1: (math.cos(angle), math.sin(angle)), 0: (sign * math.cos(angle + turn), sign * math.sin(angle + turn))}
    points = {1: (0.3, -0.2), 0: (0.3 + 0.6 * apart, -0.2 - 0.8 * apart)}
    instead = {
        "normal_gap": lambda model, k, pose: named(nx=normals[k][0], ny=normals[k][1]),
        "contact_point": lambda model, k, pose: points[k],
    }
    return in_python(handover.room_to_differ, **instead)(named(contacts=contacts, primitives=primitives), 1, 0, OPTIONS, None)


@pytest.mark.parametrize("apart", [0.0, 0.3e-7, 2e-7])
@pytest.mark.parametrize("turn", [0.0, 4e-6, -3e-5])
def test_room_is_what_is_left_of_a_hundred_extents_and_a_hundred_thousandth_of_a_radian(turn: float, apart: float) -> None:
    way, left = differ(turn=turn, apart=apart)
    assert way == pytest.approx(NEAR * EXTENT - apart, abs=1e-15)
    assert left == pytest.approx(SMOOTH - 2.0 * math.sin(0.5 * abs(turn)), abs=1e-14)


@pytest.mark.parametrize("bends", [(-4e3, 1e3), (1e3, 4e3), (3e3, -4e3), (-4e3, 0.0)])
@pytest.mark.parametrize("radii", [(3e-3, 1e-3), (2e-3, 3e-3)])
def test_curved_ways_beyond_a_joint_leave_more_room(bends: tuple[float, float], radii: tuple[float, float]) -> None:
    """Four extents of the sharper bend, over which the larger circle rolls."""
    way, left = differ(bends=bends, radii=radii)
    turn = SMOOTH + 4.0 * EXTENT * 4e3
    assert left == pytest.approx(turn, rel=1e-12)
    assert way == pytest.approx(NEAR * EXTENT + turn * 3e-3, rel=1e-12)


def test_no_joint_is_smooth_beyond_a_hundredth_and_no_point_one_beyond_ten_thousand_extents() -> None:
    assert differ(bends=(1e7, 0.0), radii=(1e-9, 0.0))[1] == pytest.approx(SHARP)
    assert differ(bends=(1e7, 0.0), radii=(1.0, 0.0))[0] == pytest.approx(FAR * EXTENT)


def test_contacts_of_the_same_two_bodies_are_one_whichever_has_the_circle() -> None:
    assert differ((3, 5, 3, 5)) == (pytest.approx(NEAR * EXTENT), pytest.approx(SMOOTH, abs=1e-14))
    assert differ((3, 5, 5, 3), flipped=True) == (pytest.approx(NEAR * EXTENT), pytest.approx(SMOOTH, abs=1e-14))
    assert differ((3, 5, 5, 3))[1] == pytest.approx(SMOOTH - 2.0)
    assert differ((3, 5, 3, 5), flipped=True)[1] == pytest.approx(SMOOTH - 2.0)
    for other in ((3, 4), (4, 5), (4, 3), (5, 4), (3, 3), (5, 5)):
        assert differ((3, 5, *other)) == (-1.0, -1.0)


@pytest.mark.parametrize(
    ("way", "turn", "same"), [(0.0, 0.0, True), (-1e-12, 1.0, False), (1.0, -1e-12, False), (1.0, 1.0, True)]
)
def test_they_are_one_while_neither_room_is_used_up(way: float, turn: float, same: bool) -> None:
    kernel = in_python(handover.same_contact, room_to_differ=lambda *_: (way, turn))
    assert bool(kernel(None, 1, 2, None, None)) == same


def test_the_room_beside_what_is_in_force_is_that_of_the_first_contact_it_continues() -> None:
    """Also beside one of a sleeping body."""
    rooms = {7: (-1.0, 5.0), 4: (2.0, -1.0), 6: (0.0, 3.0), 8: (9.0, 9.0)}
    kernel = in_python(handover.room_beside_active, room_to_differ=lambda model, k, other, options, pose: rooms[other])

    def beside(*active: int, awake: int = 1) -> tuple[float, float]:
        state = named(active=[*active, 8], now=named(awake_contacts=awake, sleeping_contacts=len(active) - awake))
        goes_on = in_python(handover.continues_active, room_to_differ=lambda model, k, other, options, pose: rooms[other])
        found = kernel(None, state, None, 1, None)
        assert bool(goes_on(None, state, None, 1, None)) == (found[0] >= 0.0)
        return found  # type: ignore[no-any-return]

    assert beside(7, 4, 6) == beside(6) == (0.0, 3.0)
    assert beside(6, 8) == (0.0, 3.0) and beside(8, 6) == (9.0, 9.0)
    assert beside(7, 4) == (-1.0, -1.0)


@pytest.mark.parametrize(("one", "found"), [
    ((1, 4), True), ((1, 3), True), ((1, 5), False), ((4, 1), True), ((3, 1), True), ((5, 1), False),
    ((0, 2), True), ((2, 0), True), ((6, 2), True), ((2, 7), False), ((8, 2), False), ((0, 4), False), ((5, 6), False),
])  # fmt: skip
def test_a_neighbour_of_what_is_in_force_is_excluded(one: tuple[int, int], found: bool) -> None:
    """In force is primitive 1 on 2, with 4 before 2 and 3 behind it, 0 before 1 and 6 behind; asleep is 5 on 8."""
    before, after = {4: 2, 3: 9, 0: 1, 6: 9}, {3: 2, 4: 9, 6: 1, 0: 9}
    primitives = [named(before=before.get(i, -1), after=after.get(i, -1)) for i in range(9)]
    contacts = [named(a=one[0], b=one[1]), named(a=1, b=2), named(a=5, b=8)]
    state = named(active=[1, 2], now=named(awake_contacts=1))
    model = named(contacts=contacts, primitives=primitives)
    assert bool(in_python(handover.is_beside_active)(model, state, 0)) == found


def test_a_contact_belongs_to_the_pair_of_bodies_in_whose_range_it_lies() -> None:
    model = named(pairs=[named(start=0, stop=3), named(start=3, stop=4), named(start=4, stop=9)])
    assert [in_python(handover._pair_of)(model, k) for k in range(9)] == [0, 0, 0, 1, 2, 2, 2, 2, 2]


def successor(gaps=(), margins=(), modes=(), same=(), how: int = LISTED) -> tuple[tuple[bool, int], int, list[object]]:
    """((known?, contact), looks at cells, what was asked) among contacts 10, 11, ... in slots 2, 3, ... of a cell."""
    asked: list[object] = []
    n = len(gaps)
    counts = named(cells_looked_up=0)
    state = named(mode={10 + i: modes[i] for i in range(n)}, q="q", counts=counts)
    instead = {
        "_pair_of": lambda model, k: 3 if k == 5 else 99,
        "candidates": lambda model, cells, p, q: (how, 2, n) if (p, q) == (3, "q") else None,
        "candidate": lambda model, cells, how, slot: 8 + slot,
        "normal_gap": lambda model, j, pose: named(gap=gaps[j - 10]),
        "extent_margin": lambda model, j, pose: margins[j - 10],
        "same_contact": lambda model, j, k, options, pose: k == 5 and same[j - 10],
        "ask": lambda asked_of, p, q: asked.append((asked_of, p, q)),
    }
    scratch = named(asked="room", event=named(pose=None))
    return in_python(handover._successor, **instead)(None, None, state, OPTIONS, 5, scratch), counts.cells_looked_up, asked


def test_what_goes_on_is_the_closed_contact_furthest_within_its_primitives() -> None:
    close, inside = (0.0, 0.0, 0.0), (1e-6, 3e-6, 2e-6)
    assert successor(close, inside, [OPEN] * 3, [True] * 3)[:2] == ((True, 11), 1)
    assert successor(close, inside, [OPEN, FORWARD, OPEN], [True] * 3)[0] == (True, 12)
    assert successor(close, inside, [OPEN] * 3, [True, False, False])[0] == (True, 10)
    assert successor(close, inside, [OPEN] * 3, [False] * 3)[0] == (True, NO_CONTACT)
    for sign in (1.0, -1.0):
        for share, found in ((0.9, 11), (1.1, 12)):
            assert successor((0.0, sign * share * 2e-10, 0.0), inside, [OPEN] * 3, [True] * 3)[0] == (True, found)
    for share, found in ((0.9, 10), (1.1, NO_CONTACT)):
        assert successor((0.0,), (-share * EXTENT,), [OPEN], [True], how=ALL)[:2] == ((True, found), 0)


def test_an_unknown_cell_is_asked_for() -> None:
    assert successor(how=UNKNOWN) == ((False, NO_CONTACT), 0, [("room", 3, "q")])


def handed(margins: dict[int, float], successors: dict[int, tuple[bool, int]]):
    """(done?, modes, active, events, was velocity corrected?) with contacts 3 and 7 awake, 5 asleep."""
    modes = {3: FORWARD, 7: STICK, 5: FORWARD, 8: OPEN, 9: OPEN}
    state = named(
        active=[3, 7, 5, 77],
        mode=modes,
        now=named(awake_contacts=2, sleeping_contacts=1),
        clock=named(time=2.5),
        counts=named(events=0),
    )
    record = named(events=np.zeros(9, EVENT_DTYPE).view(np.recarray), used=named(events=0))
    followed = []
    instead = {
        "extent_margin": lambda model, k, pose: margins[k],
        "_successor": lambda model, cells, state, options, k, scratch: successors[k],
        "_follow": lambda *_: followed.append(1),
    }
    done = in_python(handover.hand_over, **instead)(
        None, None, state, OPTIONS, named(event=named(pose=None), work=None), record
    )
    events = [(int(e.kind), int(e.contact), int(e.body), float(e.value)) for e in record.events[: record.used.events]]
    return bool(done), modes, state.active, events, len(followed)


def test_what_has_left_its_primitive_by_an_extent_and_a_half_is_passed_on_with_its_mode() -> None:
    out, still = -1.6 * EXTENT, -1.4 * EXTENT
    done, modes, active, events, followed = handed({3: out, 7: still, 5: out}, {3: (True, 9), 5: (True, 8)})
    assert done and active == [9, 7, 8, 77] and followed == 1
    assert modes == {3: OPEN, 7: STICK, 5: OPEN, 8: FORWARD, 9: FORWARD}
    assert events == [(EventKind.HANDOVER, 9, -1, 3.0), (EventKind.HANDOVER, 8, -1, 5.0)]


def test_without_a_successor_nothing_changes() -> None:
    done, modes, active, events, followed = handed({3: 0.0, 7: -1.0, 5: 0.0}, {7: (True, NO_CONTACT)})
    assert done and (active, events, followed, modes[7]) == ([3, 7, 5, 77], [], 0, STICK)
    assert not handed({3: 0.0, 7: -1.0, 5: 0.0}, {7: (False, NO_CONTACT)})[0]
