"""How are modes decided and remembered, what locks, and what is stopped before a jam? With made-up answers of the solver."""

from __future__ import annotations

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from made_up import named
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.dynamics.problem_kinds import Rung
from watchsim.simulation.events import mode_decision, mode_recurrence

MASS = np.array([1.5, 0.4, 2.0])


def test_bearings_that_stand_are_those_of_the_island() -> None:
    dry = [77] * 5
    label, grip = [0, 1, 1, 0, 1], [STICK, STICK, FORWARD, STICK, STICK]
    assert in_python(mode_decision.standing_bearings)(label, 1, grip, dry) == 2 and dry == [1, 4, 77, 77, 77]


def decided(r: int, grips: list[int], solved: bool = True) -> tuple[tuple[int, bool], list[str], np.ndarray, list[float]]:
    """(what is returned, calls in order, forces, inverse masses) with r contacts in I_N and these grips."""
    calls: list[str] = []
    work = named(h=np.zeros(3), dry=[77] * 3, inverse=[77.0] * 3)
    coordinates = [named(mass=m, driven=0, coulomb=0.25) for m in MASS]
    grip = [77] * 3

    def resting(model, m, closed, pose, zero, rest) -> int:
        assert (m, closed, pose, zero, rest) == (4, "closed", "pose", "zero", "rest")
        return r

    def forces(model, t, q, u, h) -> None:
        assert (t, q, u) == (2.5, "q", "u")
        h[:] = 1.0, 2.0, 3.0

    def set_grips(model, u, label, island, options, out) -> None:
        assert (u, label, island, options) == ("u", [0, 0, 0], 0, named(speed_zero=0.5))
        out[:] = grips

    def decide_modes(model, rest, count, bearings, speed_zero, work, out_grip, modes) -> bool:
        assert (rest, count, speed_zero, out_grip, modes) == ("rest", r, 0.5, grip, "decided")
        calls.append(f"decide with {bearings} bearings {work.dry[:bearings]}")
        return solved

    instead = {
        "resting": resting, "forces": forces, "set_grips": set_grips, "decide_modes": decide_modes,
        "count_problems": lambda state, work: calls.append("count"),
    }  # fmt: skip
    event = named(closed="closed", pose="pose", zero="zero", rest="rest", label=[0, 0, 0], decided="decided")
    state = named(clock=named(time=2.5), q="q", u="u")
    found = in_python(mode_decision.decide, **instead)(
        named(coordinates=coordinates), state, 0, 4, named(speed_zero=0.5), work, event, grip
    )
    return found, calls, work.h, work.inverse


def test_modes_are_decided_from_forces_with_the_drag_of_moving_bearings() -> None:
    found, calls, h, inverse = decided(2, [FORWARD, STICK, BACKWARD])
    assert found == (2, True) and calls == ["decide with 1 bearings [1]", "count"]
    assert h.tolist() == [0.75, 2.0, 3.25] and inverse == [77.0] * 3
    assert decided(2, [OPEN, OPEN, OPEN], solved=False)[:2] == ((2, False), ["decide with 0 bearings []", "count"])
    assert decided(0, [OPEN, OPEN, STICK])[1] == ["decide with 1 bearings [2]", "count"]


def test_where_nothing_touches_or_stands_nothing_is_decided() -> None:
    found, calls, _, inverse = decided(0, [FORWARD, OPEN, BACKWARD])
    assert found == (0, True) and calls == [] and inverse == pytest.approx((1.0 / MASS).tolist())


def test_problems_are_counted_once_by_what_solved_them_and_by_their_size() -> None:
    work = named(rungs=np.array([1, 2, 4, 8, 16, 32]), sizes=np.array([3, 5, 7, 11, 13, 17]))
    names = ("lcp_lemke", "lcp_copositive", "lcp_detours", "lcp_enumerated", "lcp_inexact")
    counts = named(lcp=100, lcp_sizes=np.full(6, 10), **dict.fromkeys(names, 1000))
    for _ in range(2):  # the second time nothing is left to count
        in_python(mode_decision.count_problems)(named(counts=counts), work)
        assert counts.lcp == 163 and counts.lcp_sizes.tolist() == [13, 15, 17, 21, 23, 27]
        assert [getattr(counts, name) for name in names] == [1001, 1002, 1004, 1008, 1016]
    assert len(Rung) == 6


def a_state(**changed: object) -> SimpleNamespace:
    now = named(awake_contacts=2, sleeping_contacts=1, decisions=0, lenience=1.0)
    given = {"active": [4, 1, 6, 7], "mode": [OPEN, STICK, 0, 0, FORWARD, 0, BACKWARD, OPEN], "grip": [OPEN, STICK], **changed}
    return named(now=now, decided=np.zeros(3, np.int64), **given)


def key_of(state: SimpleNamespace) -> int:
    """The number of a word whose letters are modes and grips, in a prime's arithmetic."""
    letters = [4 * k + state.mode[k] + 1 for k in state.active[: state.now.awake_contacts + state.now.sleeping_contacts]]
    key = 1
    for letter in [*letters, *(grip + 1 for grip in state.grip)]:
        key = (key * 1000003 + letter) % (2**31 - 1)
    return key


def test_sets_of_modes_have_numbers_of_their_own() -> None:
    """All modes of three contacts in force, awake or asleep, and of two bearings."""
    keys = set()
    for modes in itertools.product((BACKWARD, OPEN, FORWARD, STICK), repeat=5):
        state = a_state()
        for k, mode in zip((4, 1, 6), modes[:3], strict=True):
            state.mode[k] = mode
        state.grip = list(modes[3:])
        keys.add(in_python(mode_recurrence.key_of_modes)(state))
        assert in_python(mode_recurrence.key_of_modes)(state) == key_of(state)
    assert len(keys) == 4**5
    assert in_python(mode_recurrence.key_of_modes)(a_state(active=[4, 1, 7, 7])) not in keys


def test_modes_that_come_back_are_decided_on_more_lenient_terms_up_to_the_most_lenient() -> None:
    """Ten times each, up to ten million; what was decided before is forgotten."""
    decide = in_python(mode_recurrence.decide_once)
    state = a_state()
    for power in range(1, 8):
        assert decide(state) and state.now.decisions == 1 and state.decided[0] == key_of(state)
        assert decide(state) and state.now.decisions == 0 and state.now.lenience == 10.0**power
    assert decide(state) and not decide(state)


def test_as_many_sets_are_remembered_as_there_is_room_for() -> None:
    decide, state = in_python(mode_recurrence.decide_once), a_state()
    for mode, grip in ((STICK, OPEN), (FORWARD, OPEN), (STICK, STICK), (FORWARD, STICK)):
        state.mode[4], state.grip[0] = mode, grip
        assert decide(state) and state.now.lenience == 1.0
    assert state.now.decisions == 3 and decide(state) and state.now.lenience == 1.0  # the fourth was not remembered
    state.mode[4] = FORWARD
    state.grip[0] = OPEN
    assert decide(state) and (state.now.decisions, state.now.lenience) == (0, 10.0)


def test_a_new_instant_begins_on_the_usual_terms_and_an_impact_keeps_them() -> None:
    state = a_state()
    state.now.decisions, state.now.lenience = 2, 100.0
    in_python(mode_recurrence.forget_decisions)(state)
    assert (state.now.decisions, state.now.lenience) == (0, 100.0)
    state.now.decisions = 2
    in_python(mode_recurrence.begin_instant)(state)
    assert (state.now.decisions, state.now.lenience) == (0, 1.0)
