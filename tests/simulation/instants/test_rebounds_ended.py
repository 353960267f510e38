"""Which rebounds are ended by rule, and what is left when a row of impacts is? From throws and by whole matrices."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from made_up import both, closed_of, named, work_of
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, STICK
from watchsim.simulation.events import chatter, collision

TIME = 2.5
OPTIONS = named(accumulation_time=1e-6, accumulation_speed=0.1, gap_zero=1e-13, gap_close=1e-9)


def event(rates: list[float], zero: list[float] | None = None) -> SimpleNamespace:
    kin = [named(gN_dot=rate) for rate in rates]
    return named(closed=named(kin=kin, ids=list(range(len(rates)))), zero=zero or [1e-9] * len(rates), pace=None)


def room(restitution: list[float], impulse: list[float]) -> SimpleNamespace:
    return named(restitution=list(restitution), impulse=[part for one in impulse for part in (one, 77.0)], grip="grip")


@pytest.mark.parametrize(("rates", "found"), [((0.1, -0.9e-9), False), ((0.1, -1.1e-9), True), ((-2e-8, 0.0), True)])
def test_what_approaches_faster_than_zero_will_penetrate(rates: tuple[float, float], found: bool) -> None:
    assert in_python(collision.approaching)(2, named(kin=[named(gN_dot=rate) for rate in rates]), [1e-9, 1e-9]) == found


def test_restitutions_are_those_of_the_laws_and_the_least_counts() -> None:
    model = named(contacts=[named(group=g) for g in (2, 0, 1)], laws=[named(restitution=e) for e in (0.3, 0.9, 0.6)])
    found = [0.0] * 3
    in_python(collision._law_restitution)(model, named(ids=[1, 2, 0]), 3, found)
    assert found == [0.3, 0.9, 0.6]
    least = in_python(collision._least_restitution)
    assert least(3, found) == 0.3 and least(2, [0.9, 0.7, 0.1]) == 0.7 and least(0, found) == 1.0


@pytest.mark.parametrize(("rate", "share", "impulse", "found"), [
    (0.05, 0.5, 1.0, True), (0.1, 0.5, 1.0, True), (0.11, 0.5, 1.0, False), (0.9e-9, 0.5, 1.0, False),
    (1.1e-9, 0.5, 1.0, True), (0.05, 0.0, 1.0, False), (0.05, 0.5, 0.0, False),
])  # fmt: skip
def test_a_slow_rebound(rate: float, share: float, impulse: float, found: bool) -> None:
    one = event([9.0, rate])
    assert in_python(collision._rebounds)(1, OPTIONS, one, room([0.0, share], [0.0, impulse])) == found


def rounded(rates: list[float], restitution: list[float], impulse: list[float]) -> list[float]:
    """What counts as zero afterwards, where the rounding of contact i is (1 + i) nm/s and a ten billionth of its jump."""
    work = named(G=np.diag([4.0, 99.0, 2.0, 99.0]))
    one = event(rates, [1e-8, 1e-8])
    instead = {"rounding_of": lambda closed, i, options, pace: 1e-9 * (1 + i)}
    in_python(collision._see_rebounds, **instead)(2, OPTIONS, one, work, room(restitution, impulse))
    return one.zero


def test_rebounds_slower_than_zero_are_seen_where_they_are_more_than_rounding() -> None:
    """Then for all contacts of the instant nothing but rounding is zero."""
    fine = [pytest.approx(1e-9 + 1e-10 * 4.0 * 3.0), pytest.approx(2e-9 + 1e-10 * 2.0 * 5.0)]
    assert rounded([2.3e-9, 0.0], [0.5, 0.5], [3.0, 5.0]) == fine
    assert rounded([2.1e-9, 0.0], [0.5, 0.5], [3.0, 5.0]) == [1e-8, 1e-8]
    assert rounded([0.0, 3.1e-9], [0.5, 0.5], [3.0, 5.0]) == fine
    assert rounded([0.0, 1e-8], [0.5, 0.5], [3.0, 5.0]) == fine
    assert rounded([0.0, 1.1e-8], [0.5, 0.5], [3.0, 5.0]) == [1e-8, 1e-8]  # seen without that
    assert rounded([5e-9, 0.0], [1e-4, 0.5], [1e-4, 0.0])[1] == pytest.approx(2e-9)
    assert rounded([5e-9, 0.0], [0.0, 0.5], [3.0, 5.0]) == [1e-8, 1e-8]
    assert rounded([5e-9, 0.0], [0.5, 0.5], [0.0, 5.0]) == [1e-8, 1e-8]


def ended(rates, restitution, back, *, solved: bool = True, impulse=(1.0, 1.0, 1.0)):
    """(any?, the latest end, restitutions left) of contacts that are back after these times."""
    m = len(rates)
    given = room(list(restitution), list(impulse[:m]))
    instead = {
        "_see_rebounds": lambda *_: None,
        "_accelerations": lambda *_: solved,
        "return_time": lambda closed, i, a: back[i],
    }
    state = named(clock=named(time=TIME), a=None)
    scratch = named(event=event(list(rates)), impact=given, work=None)
    found, latest = in_python(collision._end_rebounds, **instead)(None, state, 0, m, OPTIONS, scratch)
    return found, latest, given.restitution


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_rebounds_that_would_end_soon_are_ended(share: float) -> None:
    """A geometric row: the first flight over one less the restitution."""
    back = share * 1e-6 * (1.0 - 0.25)
    found, latest, left = ended([0.05], [0.25], [back])
    assert (found, left) == ((True, [0.0]) if share < 1.0 else (False, [0.25]))
    assert latest == (pytest.approx(TIME + share * 1e-6, rel=1e-15) if found else 0.0)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_rebounds_too_low_to_be_seen_are_ended_however_long_they_take(share: float) -> None:
    """A throw rises by a quarter of its speed times its time: twenty gaps that are zero, in all rebounds together."""
    low = share * 20.0 * 1e-13 / (1.0 - 0.25)
    assert ended([1e-8], [0.25], [4.0 * low / 1e-8])[2] == ([0.0] if share < 1.0 else [0.25])


@pytest.mark.parametrize("share", [0.9, 1.1])
@pytest.mark.parametrize("restitution", [1.0, 1.0 - 1e-5])
def test_rebounds_that_lose_next_to_nothing_are_ended_where_they_stay_closed(restitution: float, share: float) -> None:
    found, latest, left = ended([1e-8], [restitution], [4.0 * share * 1e-9 / 1e-8])
    assert (found, left) == ((True, [0.0]) if share < 1.0 else (False, [restitution]))
    if found:
        assert latest == pytest.approx(TIME + 0.36 / (1.0 if restitution == 1.0 else 1e-5))


def test_each_rebound_is_ended_by_itself_and_the_latest_end_is_told() -> None:
    found = ended([0.05, 0.05, 0.05], [0.5, 0.2, 0.5], [1e-7, 6e-7, 1e-6])
    assert found == (True, pytest.approx(TIME + 7.5e-7, rel=1e-15), [0.0, 0.0, 0.5])
    assert ended([0.05, 0.05], [0.5, 0.5], [3e-7, 1e-7])[1] == pytest.approx(TIME + 6e-7, rel=1e-15)
    assert ended([0.05, 0.05], [0.5, 0.5], [math.inf, 1e-7])[2] == [0.5, 0.0]  # never back
    assert ended([0.2, 0.05], [0.5, 0.5], [1e-7, 1e-7])[2] == [0.5, 0.0]  # too fast
    assert ended([0.05], [0.5], [1e-7], solved=False) == (False, 0.0, [0.5])
    assert ended([0.2], [0.5], [1e-7]) == (False, 0.0, [0.5])


def test_accelerations_after_an_impact_are_those_of_what_is_in_force_then() -> None:
    asked = []
    instead = {
        "decide": lambda model, state, island, m, options, work, event, grip: asked.append((island, m, grip)) or (2, solved),
        "accelerate": lambda model, rest, r, work, a: asked.append((rest, r, a)),
    }
    scratch = named(work=None, event=named(rest="rest"), impact=named(grip="grip"))
    for solved in (False, True):
        assert in_python(collision._accelerations, **instead)(None, named(a="a"), 4, 3, None, scratch) == solved
    assert asked == [(4, 3, "grip"), (4, 3, "grip"), ("rest", 2, "a")]


MASS = np.array([1.5, 0.4, 2.0, 0.8])
U = np.array([0.02, -0.01, 0.03, -0.02])
NORMAL = np.array([[1.0, 0.3, 0.0, 0.2], [0.4, -1.2, 0.5, 0.0], [0.0, 0.7, 0.9, -0.6]])
TANGENTIAL = np.array([[-0.2, 1.0, 0.3, 0.0], [0.8, 0.1, -0.4, 0.0], [0.5, 0.0, 0.6, 1.1]])
FRICTION = (0.5, 0.2, 0.0)


def chatter_ends(plastic: list[float], forces: list[float], slips=(0.0, 0.0, 0.0), *, found: bool = True, taken: float = 1e9):
    """((found?, in force), velocities, modes, impulses, contacts that are asked for forces) of three contacts 4, 6 and 2."""
    ids = [4, 6, 2]
    closed = closed_of(NORMAL, TANGENTIAL, ids, gT_dot=list(slips))
    work, asked = work_of(3, 1.0 / MASS), []
    rest = closed_of(NORMAL, TANGENTIAL)

    def plastic_impact(model, closed, m, time, u, work) -> bool:
        assert (m, time) == (3, 0.01)
        work.force[:6] = plastic
        return found

    def put(model, k, pose, row, out) -> None:
        own = closed_of(NORMAL[[ids.index(k)]], TANGENTIAL[[ids.index(k)]], [k])
        for name in ("ids", "slots", "coord", "w_N", "w_T"):
            getattr(out, name)[row] = getattr(own, name)[0]

    def solve(model, rest, r, mode, lenience, work) -> None:
        asked.append((rest.ids[:r].tolist(), [int(mode[k]) for k in rest.ids[:r]], lenience))
        work.force[: 2 * r] = forces[: 2 * r]
        rows = both(NORMAL, TANGENTIAL)[[2 * ids.index(k) + j for k in rest.ids[:r] for j in (0, 1)]]
        work.G[: 2 * r, : 2 * r] = rows @ (rows / MASS).T

    model = named(
        contacts=[named(group=0), None, named(group=2), None, named(group=0), None, named(group=1)],
        laws=[named(friction=mu) for mu in FRICTION],
        coordinates=[named(mass=m, driven=0) for m in MASS],
    )
    state = named(u=U.copy(), now=named(lenience=3.0))
    made = named(ending=np.full(6, 77.0), mode=np.full(8, 9))
    instead = {"plastic_impact": plastic_impact, "contact_kinematics": put, "solve_mode": solve}
    one = named(closed=closed, rest=rest, pose=None)
    answer = in_python(chatter.end_chatter, **instead)(model, state, 3, (0.01, taken), work, one, made)
    return answer, state.u, made.mode, made.ending, asked


def test_what_presses_at_the_end_of_a_chatter_gets_its_impulse_less_what_forces_do_by_then() -> None:
    """Contacts 4 and 2: the other one leaves."""
    plastic, forces = [2e-5, 3e-6, -1e-6, 5e-6, 4e-5, 0.0], [1e-3, 2e-4, 5e-3, -1e-4]
    answer, u, mode, ending, asked = chatter_ends(plastic, forces, (0.0, 0.0, 0.3))
    impulse = np.array([2e-5, 3e-6, 4e-5, 0.0]) - 0.01 * np.array(forces)
    rows = both(NORMAL, TANGENTIAL)[[0, 1, 4, 5]]
    assert answer == (True, 2)
    assert u == pytest.approx(U + rows.T @ impulse / MASS, rel=1e-14, abs=0.0)
    assert ending[:4] == pytest.approx(impulse) and (mode[4], mode[2], mode[6]) == (STICK, FORWARD, 9)
    assert asked == [([4, 2], [STICK, FORWARD], 3.0)]


@pytest.mark.parametrize(("tangential", "slip", "mode"), [
    (1.0 - 1.1e-9, 1.0, STICK), (1.0 - 0.9e-9, 1.0, BACKWARD), (-1.0 + 0.9e-9, -1.0, FORWARD), (-1.0 + 1.1e-9, 1.0, STICK),
])  # fmt: skip
def test_what_sticks_is_within_half_of_its_normal_impulse(tangential: float, slip: float, mode: int) -> None:
    plastic = [2e-11, 1e-11 * tangential, 0.0, 0.0, 0.0, 0.0]
    answer, _, modes, _, _ = chatter_ends(plastic, [0.0] * 6, (slip, 0.0, 0.0))
    assert answer == (True, 1) and modes[4] == mode


@pytest.mark.parametrize(("slip", "mode"), [(0.1, FORWARD), (0.0, FORWARD), (-0.1, BACKWARD)])
def test_without_friction_it_slides_as_it_does(slip: float, mode: int) -> None:
    assert chatter_ends([0.0, 0.0, 0.0, 0.0, 3e-5, 0.0], [0.0] * 6, (0.0, 0.0, slip))[2][2] == mode


def test_velocities_stay_where_there_is_no_end_or_it_would_gain_energy() -> None:
    """More than a millionth of it."""
    plastic = [2e-5, 3e-6, 1e-6, 0.0, 4e-5, 0.0]
    assert chatter_ends(plastic, [0.0] * 6, found=False)[:2] == ((False, 0), pytest.approx(U, rel=0.0, abs=0.0))
    answer, u, *_ = chatter_ends([2.0, 0.3, 1.0, 0.0, 4.0, 0.0], [0.0] * 6)
    assert answer == (False, 0) and u.tolist() == U.tolist()
