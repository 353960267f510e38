"""What locks on the line of centres, and what is stopped before contacts are taken for jammed? With made-up answers."""

from __future__ import annotations

import numpy as np
import pytest
from made_up import both, closed_of, named, work_of
from plain_kernels import in_python

from watchsim.contact.index_sets import FORWARD, OPEN, STICK
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.events import dead_centre, jammed_contacts, released_contacts

MASS = np.array([1.5, 0.4, 2.0])


def stopped(solved: bool = False, decided=(OPEN, OPEN), locked=(False, True), bars=((0.0, 0.0), (-0.5, 0.2))):
    """(stopped?, velocities, events, work taken, jams) of two contacts; the second one moves coordinates 2 and 0."""
    state = named(u=np.array([3.0, -2.0, 0.5]), sums=named(impacts=0.25), counts=named(jams=4, events=0), clock=named(time=2.5))
    kin = [named(bar_N=n, bar_T=t, gT_dot=0.125 + i) for i, (n, t) in enumerate(bars)]
    rest = named(ids=[5, 3], kin=kin, slots=[1, 2], coord=np.array([[1, 77], [2, 0]]))
    record = named(events=np.zeros(9, EVENT_DTYPE).view(np.recarray), used=named(events=0))
    G = np.full((4, 4), 77.0)
    G[0, 0], G[0, 1], G[2, 2], G[2, 3] = 9.0, 7.0, 3.0, -1.5
    model = named(coordinates=[named(mass=m, driven=0) for m in MASS])
    kernel = in_python(dead_centre.stop_at_dead_centre, _locks=lambda model, rest, i, work: locked[i])
    event = named(rest=rest, decided={5: decided[0], 3: decided[1]})
    found = kernel(model, state, 2, solved, named(G=G), event, record)
    return bool(found), state.u.tolist(), record.events[: record.used.events], state.sums.impacts - 0.25, state.counts.jams - 4


def test_what_locks_on_the_line_of_centres_is_stopped() -> None:
    """All of the contact's coordinates; the energy goes to the impacts, and the slip is told."""
    found, u, events, lost, jams = stopped()
    taken = 0.5 * (1.5 * 9.0 + 2.0 * 0.25)
    assert (found, u, jams) == (True, [0.0, -2.0, 0.0], 1)
    assert lost == pytest.approx(taken) == events[0].energy_lost
    assert [(int(e.kind), int(e.contact), int(e.body), float(e.value)) for e in events] == [(EventKind.JAM, 3, -1, 1.125)]


@pytest.mark.parametrize(("bar_N", "bar_T", "found"), [
    (-0.5, 0.2, True), (-0.5, 0.3, False), (0.5, -0.3, True), (0.5, -0.2, False), (0.5, -0.25, False),
])  # fmt: skip
def test_only_where_the_motion_would_close_the_gap(bar_N: float, bar_T: float, found: bool) -> None:
    """Forces without effect are as 1 to 2 against each other: they would have to make up for bar_N and twice bar_T."""
    assert stopped(bars=((0.0, 0.0), (bar_N, bar_T)))[0] == found


def test_a_solved_problem_locks_only_what_sticks() -> None:
    assert stopped(solved=True, decided=(STICK, STICK))[0]
    assert not stopped(solved=True, decided=(STICK, FORWARD))[0] and stopped(solved=False, decided=(STICK, FORWARD))[0]
    assert not stopped(locked=(True, False))[0]
    assert stopped(locked=(True, True), bars=((-1.0, 0.0), (-0.5, 0.0)))[1] == [0.0, 0.0, 0.0]


NORMAL = np.array([[1.0, 0.3, 0.2], [0.4, -1.2, 0.5]])
TANGENTIAL = np.array([[-0.2, 1.0, 0.3], [0.8, 0.1, -0.4]])


def held(friction: tuple[float, float], slips: list[float], rates: list[float]) -> np.ndarray:
    """By how much velocities change before contacts are taken for jammed."""
    work, u = work_of(2, np.full(3, 77.0)), np.array([0.3, -0.2, 0.1])
    model = named(
        contacts=[None, named(group=1), None, None, named(group=0)], laws=[named(friction=mu) for mu in friction],
        coordinates=[named(mass=m, driven=0) for m in MASS],
    )  # fmt: skip
    event = named(rest=closed_of(NORMAL, TANGENTIAL, [4, 1], gN_dot=rates, gT_dot=slips), trial=np.full(6, 77), pose=None)
    placed = []
    kernel = in_python(jammed_contacts.hold_gaps, place=lambda *_: placed.append(1))
    kernel(model, named(q=None, u=u), 2, named(speed_zero=1e-8), work, event)
    assert placed == [1]
    return u - [0.3, -0.2, 0.1]


def test_gaps_of_what_may_jam_are_held_and_slips_of_what_holds() -> None:
    """As slow as zero, and with friction; the rest slides on. Inverse masses are those without bearings."""
    rates, every = [0.02, -0.03], both(NORMAL, TANGENTIAL)
    root = np.sqrt(1.0 / MASS)
    for slips, friction, rows in (
        ([0.9e-8, 1.1e-8], (4e-4, 4e-4), [0, 1, 2]),
        ([1.1e-8, -1e-8], (0.4, 0.4), [0, 2, 3]),
        ([1e-9, -1e-9], (0.0, 0.4), [0, 2, 3]),
        ([0.2, -0.3], (0.4, 0.4), [0, 2]),
    ):
        wanted = -np.array([rates[0], slips[0], rates[1], slips[1]])[rows]
        expected = root * (np.linalg.pinv(every[rows] * root) @ wanted)
        assert held(friction, slips, rates) == pytest.approx(expected, rel=1e-9, abs=1e-13)


def stop(slip: float, impulse: float = 5.0, friction: float = 0.5, bodies: bool = False) -> tuple[bool, list[int], list[str]]:
    """(stopped?, modes tried, calls) of rest contact 6 after an impact of contacts 4 and 6."""
    calls: list[str] = []
    work = named(G=np.diag([77.0, 77.0, 77.0, 4.0]))
    kin = [named(gT_dot=1e-3), named(gT_dot=slip)]
    event = named(closed=named(ids=[4, 6]), rest=named(ids=[5, 6], kin=kin), trial=[77] * 8, pose=None)
    scratch = named(work=work, event=event, impact=named(impulse=[99.0, 77.0, impulse, 77.0]))
    model = named(contacts=[named(group=int(k == 6)) for k in range(8)], laws=[named(friction=9.0), named(friction=friction)])
    instead = {
        "_stop_bodies": lambda r, event, u: bodies, "place": lambda *_: calls.append("place"),
        "project_velocities": lambda closed, m, mode, independent, work, u: calls.append(f"project {m} {independent}"),
        "refresh": lambda model, m, closed, pose: calls.append(f"refresh {m}"),
    }  # fmt: skip
    kernel = in_python(jammed_contacts.stop_rounding, **instead)
    found = kernel(model, named(q=None, u=None), 2, 2, named(speed_zero=1e-18), scratch)
    return bool(found), event.trial[5:7], calls


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_slips_that_are_rounding_of_the_friction_impulse_are_stopped(sign: float) -> None:
    """What all of friction would do to them, times the rounding of velocities."""
    rounding = 4e-15 * 0.5 * 5.0 * 4.0
    changed = ["project 2 0.01", "place", "refresh 2"]
    assert stop(sign * 0.9 * rounding) == (True, [OPEN, STICK], changed)
    assert stop(sign * 1.1 * rounding) == (False, [OPEN, OPEN], [])
    assert stop(sign * 0.9e-18) == (False, [OPEN, OPEN], []) and stop(sign * 1.1e-18)[0]
    assert stop(sign * 1.1 * rounding, bodies=True) == (True, [OPEN, OPEN], changed)


@pytest.mark.parametrize("unit", [1.0, 1e-18])
def test_no_force_is_small_but_beside_larger_ones(unit: float) -> None:
    """Forces that press hold in any unit; what presses by a share of rounding beside another one does not."""
    model = named(contacts=[named(group=0)] * 2, laws=[named(friction=0.0)])
    state = named(mode=[FORWARD] * 2, now=named(lenience=1.0))
    kernel = in_python(released_contacts._weakest)
    for normal, found in (([5.0, 3.0], (False, 0, False)), ([3e14, 2.9], (True, 1, True)), ([3e14, 3.1], (False, 0, False))):
        force = [unit * normal[0], 77.0 * unit, unit * normal[1], 77.0 * unit]
        work = named(force=force, size=[1e-3 * unit] * 4, G=np.eye(4))
        assert kernel(model, state, 2, named(force_zero=1e-9), work, named(ids=[0, 1])) == found
