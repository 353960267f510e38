"""Are the events of the woodpecker's linear systems found where closed forms have them, and is one step what its law says?"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from reference.single_impact import single_impact

from watchsim.contact.index_sets import OPEN, STICK
from watchsim.verification.woodpecker import exact_motion
from watchsim.verification.woodpecker.exact_motion import AT_ONCE, FORCE, GAP, SLIP, Phase, next_event, settle
from watchsim.verification.woodpecker.toy import BEAK, LOWER, UPPER, Modal, Toy, modal
from watchsim.verification.woodpecker.toy_stepping import step_to

SWING = 100.0  # 1/s
STILL_SWING = np.array([[0.0, 1.0, 0.0], [-(SWING**2), 0.0, 0.0], [0.0, 0.0, 0.0]])  # of (x, x', 1)
FALL = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, -9.81], [0.0, 0.0, 0.0]])
START = np.array([1.0, 0.0, 1.0])
SLACK = 1e-5


def phase(flow: np.ndarray, *rows: tuple[list[float], str], slack: float = SLACK) -> Phase:
    return Phase(
        flow, np.array([row for row, _ in rows]), np.full(len(rows), slack), [(why, k) for k, (_, why) in enumerate(rows)]
    )


@pytest.mark.parametrize("cause", ["impact", "reverse"])
@pytest.mark.parametrize("height", [0.999, 0.6, 0.0, -0.5, -0.999])
def test_gaps_and_slips_end_a_mode_where_they_are_zero(cause: str, height: float) -> None:
    """cos(w t) comes down to a height, after one stride or after hundreds."""
    t, row = next_event(phase(STILL_SWING, ([1.0, 0.0, -height], cause)), START, 1.0)
    assert row == 0 and t == pytest.approx(math.acos(height) / SWING, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("cause", ["open", "slip"])
@pytest.mark.parametrize("height", [0.999, 0.6, -0.5])
def test_forces_end_it_where_they_are_beyond_their_bound(cause: str, height: float) -> None:
    t, row = next_event(phase(STILL_SWING, ([1.0, 0.0, -height], cause)), START, 1.0)
    assert row == 0 and t == pytest.approx(math.acos(height - SLACK) / SWING, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("begin", [0.0, -0.4 * SLACK])
def test_a_gap_that_begins_within_its_slack_ends_it_beyond_the_slack(begin: float) -> None:
    """Closed already: only what goes further into the other counts."""
    t, row = next_event(phase(FALL, ([1.0, 0.0, begin], "impact")), np.array([0.0, 0.0, 1.0]), 1.0)
    assert row == 0 and t == pytest.approx(math.sqrt(2.0 * (SLACK + begin) / 9.81), rel=1e-9)


def test_what_has_lost_its_sign_at_the_start_ends_it_at_once() -> None:
    assert next_event(phase(FALL, ([1.0, 0.0, 0.0], "open")), np.array([-2.0 * SLACK, 0.0, 1.0]), 1.0) == (0.0, 0)


@pytest.mark.parametrize("first", [0, 1, 2])
def test_the_first_of_several_ends_it(first: int) -> None:
    heights = [0.3, 0.2, 0.1]
    heights[first] = 0.5
    rows = [([1.0, 0.0, -height], "impact") for height in heights]
    t, row = next_event(phase(STILL_SWING, *rows), START, 1.0)
    assert row == first and t == pytest.approx(math.acos(0.5) / SWING, rel=1e-12)


@pytest.mark.parametrize("first", [0, 1])
def test_within_one_stride_too(first: int) -> None:
    heights = [0.5, 0.5]
    heights[first] += 1e-4  # a microsecond earlier, of a stride of fifty
    t, row = next_event(phase(STILL_SWING, *(([1.0, 0.0, -h], "impact") for h in heights)), START, 1.0)
    assert row == first and t == pytest.approx(math.acos(0.5001) / SWING, rel=1e-12)


@pytest.mark.parametrize("at", [1.3e-5, 1.7e-4, 3.21e-3, 0.0131])
@pytest.mark.parametrize(("depth", "found"), [(1e-9, True), (-1e-9, False)])
def test_a_dip_between_two_samples_is_found(at: float, depth: float, found: bool) -> None:
    """A parabola that is below zero for two microseconds, or that turns just above it."""
    speed = 9.81 * at
    throw = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 9.81], [0.0, 0.0, 0.0]])
    begin = np.array([0.5 * 9.81 * at**2 - depth - 1e-12, -speed, 1.0])
    t, row = next_event(phase(throw, ([1.0, 0.0, 0.0], "open"), slack=1e-12), begin, 0.05)
    width = math.sqrt(2.0 * abs(depth) / 9.81)
    if not found:
        assert (t, row) == (0.05, -1)
    elif width > at:
        assert t == 0.0 or row == 0
    else:
        assert row == 0 and t == pytest.approx(at - width, abs=1e-9)


@pytest.mark.parametrize("until", [1e-6, 4.9e-5, 5.1e-5, 0.0031, 0.0033, 0.01])
def test_nothing_ends_it_before_the_time_asked_for(until: float) -> None:
    one = phase(STILL_SWING, ([1.0, 0.0, -0.5], "impact"))  # at 10.47 ms
    assert next_event(one, START, until) == (until, -1)
    assert next_event(one, START, 0.010473)[1] == 0 and next_event(one, START, 0.010471) == (0.010471, -1)


def test_slack_by_cause() -> None:
    """A gap's is of a length, a slip's of a speed, a force's of a force."""
    made = exact_motion.phase_of(modal(Toy()), np.array([OPEN, STICK, 1], np.int8), [LOWER, UPPER])
    wanted = {"impact": GAP, "reverse": SLIP, "open": FORCE, "slip": FORCE}
    assert [cause for cause, _ in made.causes] == ["impact", "open", "slip", "slip", "open", "reverse"]
    assert list(made.slack) == [wanted[cause] for cause, _ in made.causes]


def alone(contact: int) -> Modal:
    """The toy, of which only one contact is near."""
    model = modal(Toy())
    return Modal(model.basis, model.spring, model.load, model.contacts, np.where(np.arange(3) == contact, model.gaps, 1.0))


def touching(model: Modal, contact: int, rate: float, slip: float) -> tuple[np.ndarray, np.ndarray]:
    """A state with one contact closed, the others far open."""
    N, T = model.contacts.W[2 * contact], model.contacts.W[2 * contact + 1]
    e = -np.linalg.pinv(N[None]) @ model.gaps[[contact]]
    return e, np.linalg.lstsq(np.vstack([N, T]), np.array([rate, slip]), rcond=None)[0]


CONTACTS = [BEAK, LOWER, UPPER]


@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("slip", [0.3, -0.3, 1e-3])
def test_what_approaches_is_thrown_back(contact: int, slip: float) -> None:
    model = alone(contact)
    e, v = touching(model, contact, -0.2, slip)
    rows = model.contacts.W[2 * contact : 2 * contact + 2]
    G = rows @ rows.T
    found = single_impact((G[0, 0], G[0, 1], G[1, 1]), (-0.2, slip), 0.3, [0.5, 0.0, 0.0][contact])
    after = settle(model, e, v)
    assert after[4] is True
    assert rows @ after[1] == pytest.approx([found.v_n, found.v_t], abs=1e-12)


@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize(("gap", "rate", "hit"), [(0.9, -1.1, True), (1.1, -1.1, False), (0.9, -0.9, False), (0.9, 1.1, False)])
def test_only_what_is_closed_and_approaches_is_hit(contact: int, gap: float, rate: float, hit: bool) -> None:
    """Within a billionth of a millimetre, faster than a tenth of a nanometre a second."""
    model = alone(contact)
    e, v = touching(model, contact, 1e-10 * rate, 0.1)
    N = model.contacts.W[2 * contact]
    e = e + 1e-12 * gap * N / (N @ N)
    assert settle(model, e, v)[4] is hit


def force_of(model: Modal, contact: int, sign: float) -> Modal:
    """With a load that presses one contact, or pulls it open."""
    N = model.contacts.W[2 * contact]
    return Modal(model.basis, np.zeros(3), -sign * N, model.contacts, model.gaps)


@pytest.mark.parametrize("contact", CONTACTS)
def test_what_rests_is_held_exactly_and_what_is_pulled_comes_off(contact: int) -> None:
    model = alone(contact)
    rows = model.contacts.W[2 * contact : 2 * contact + 2]
    e, v = touching(model, contact, 0.9e-10, 0.0)
    e_held, v_held, mode, taken, hit = settle(force_of(model, contact, 1.0), e + 0.9e-12 * rows[0] / (rows[0] @ rows[0]), v)
    assert taken == [contact] and not hit and [k for k in range(3) if mode[k] != OPEN] == [contact]
    assert abs(rows[0] @ e_held + model.gaps[contact]) < 1e-17
    assert np.abs(rows @ v_held)[: 2 if mode[contact] == STICK else 1].max() < 1e-24
    e_free, v_free, mode, taken, hit = settle(force_of(model, contact, -1.0), e, v)
    assert taken == [] and not hit and list(mode) == [OPEN] * 3 and np.array_equal(e_free, e) and np.array_equal(v_free, v)


def test_standing_still_in_time_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """After forty events at one instant."""
    model, seen = alone(LOWER), []
    monkeypatch.setattr(exact_motion, "next_event", lambda phase, z, until: (0.0, 0))
    with pytest.raises(RuntimeError, match="stands still in time"):
        for moment in exact_motion.moments(model, *touching(model, LOWER, 0.1, 0.0), 1.0):
            seen.append(moment)
    assert len(seen) == AT_ONCE + 1


@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("h", [1e-3, 4e-3])
@pytest.mark.parametrize("rate", [0.0, -0.2])
def test_a_step_of_moreau_is_its_law(contact: int, h: float, rate: float) -> None:
    """Long steps, in which the spring's part counts: what the midpoint rule lacks is an impulse within the cone of friction."""
    model = alone(contact)
    rows = model.contacts.W[2 * contact : 2 * contact + 2]
    e, v = touching(model, contact, rate, 0.05)
    e = e - (0.5 * h * (rows[0] @ v) + 1e-5) * rows[0] / (rows[0] @ rows[0])  # closed at the middle of the step
    model = force_of(model, contact, 3.0)
    model = Modal(model.basis, np.array([0.0, 0.0, 2e5]), model.load, model.contacts, model.gaps)
    w = v
    if rate < 0.0:
        G = rows @ rows.T
        hit = single_impact((G[0, 0], G[0, 1], G[1, 1]), tuple(rows @ v), 0.3, [0.5, 0.0, 0.0][contact])
        w = v + rows.T @ np.array([hit.normal, hit.tangential])
    new_e, new_v = step_to(model, e, v, h, h)
    assert new_e == pytest.approx(e + 0.5 * h * (w + new_v), abs=1e-9)
    lacking = new_v - w - h * (model.load - model.spring * (0.5 * (e + new_e)))
    (normal, tangential), error = np.linalg.lstsq(rows.T, lacking, rcond=None)[:2]
    assert error < 1e-16 and normal > -1e-10 and abs(tangential) <= 0.3 * normal + 1e-9
    assert rows[0] @ new_v > -1e-9 and abs(normal * (rows[0] @ new_v)) < 1e-9


def test_steps_follow_each_other_and_end_at_the_time_asked_for() -> None:
    """In free fall: about h each, so many that the time comes out; halves of steps are the midpoint rule."""
    toy = Toy()
    model = modal(toy)
    far = Modal(model.basis, np.array([0.0, 0.0, 900.0]), model.load, model.contacts, model.gaps + 1e3)
    e, v = np.array([0.1, -0.2, 0.3]), np.array([1.0, -2.0, 3.0])
    got_e, got_v = step_to(far, e, v, 0.01, 0.0031)  # three steps
    w = 30.0
    for h in np.diff(np.linspace(0.0, 0.01, 4)):
        turn = 2.0 * math.atan(0.5 * w * h) / w  # the midpoint rule turns a swing about so long
        middle = far.load[2] / w**2
        x, y = e[2] - middle, v[2] / w
        c, s = math.cos(w * turn), math.sin(w * turn)
        e = np.array([*(e[:2] + h * v[:2] + 0.5 * h * h * far.load[:2]), middle + c * x + s * y])
        v = np.array([*(v[:2] + h * far.load[:2]), w * (c * y - s * x)])
    assert got_e == pytest.approx(e, abs=1e-12) and got_v == pytest.approx(v, abs=1e-11)


def test_moments_are_in_order_and_say_what_was_before() -> None:
    model = modal(Toy())
    seen = list(exact_motion.moments(model, *touching(model, LOWER, 0.05, -0.3), 0.05))
    assert seen[0].t == 0.0 and seen[-1].t == 0.05 and all(a.t <= b.t for a, b in pairwise(seen))
    assert seen[0].contact == seen[-1].contact == -1 and seen[-1].cause == "end"
