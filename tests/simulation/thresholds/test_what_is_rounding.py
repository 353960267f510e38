"""Up to where is it rounding, in steps, at the ends of modes, in impacts and at knots? Each threshold from either side."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, STICK
from watchsim.dynamics import applied_forces
from watchsim.model.records import OVER_TIME
from watchsim.simulation import accepted_step
from watchsim.simulation.events import chatter, collision, impulse_check, shrinking_play
from watchsim.simulation.motion import contact_mode_end, coupled_motion, drift_projection

BOTH_SIDES = pytest.mark.parametrize("share", [0.9, 1.1])
SIGNS = pytest.mark.parametrize("sign", [1.0, -1.0])


@BOTH_SIDES
@SIGNS
def test_rates_are_looked_at_again_where_taking_back_gaps_turns_them(share: float, sign: float) -> None:
    """By a tenth of what counts as zero: the deepest gap times the fastest turn."""
    kin = [SimpleNamespace(g=1e-9), SimpleNamespace(g=-sign * 4e-9), SimpleNamespace(g=0.0), SimpleNamespace(g=9.0)]
    coordinates = [SimpleNamespace(scale=0.5), SimpleNamespace(scale=2.0)]
    state = SimpleNamespace(u=np.array([0.1, sign * 5.0]))
    options = SimpleNamespace(speed_zero=share * 4e-9 * 2.5 / 0.1)
    asked = in_python(accepted_step._turns_rates)
    turns = asked(SimpleNamespace(coordinates=coordinates), state, options, 3, SimpleNamespace(kin=kin))
    assert bool(turns) == (share < 1.0)


@SIGNS
def test_only_what_has_drifted_is_taken_back(sign: float) -> None:
    """No deeper than `behind`, and by a way along the face of fifty times that at most."""
    asked, behind = in_python(drift_projection._has_drifted), 1e-8
    G = np.zeros((4, 4))
    G[2, 2] = 2.0
    work = SimpleNamespace(G=G)
    assert asked(work, 2, -0.9e-8, behind) and not asked(work, 2, -1.1e-8, behind) and asked(work, 2, 1.0, behind)
    for share in (0.9, 1.1):
        G[2, 3] = sign * share * 50.0 * behind * 2.0 / 0.5e-8
        assert bool(asked(work, 2, -0.5e-8, behind)) == (share < 1.0)


def test_slips_weigh_half_and_what_next_to_nothing_moves_not_at_all() -> None:
    asked = in_python(drift_projection._scale_of)
    work = SimpleNamespace(G=np.diag([9.0, 9.0, 16.0, 4.0]))
    assert (asked(work, 2, 0.1), asked(work, 3, 0.1)) == (0.25, 0.25)
    for share in (0.9, 1.1):
        assert asked(work, 3, share * 0.2) == (0.25 if share < 1.0 else 0.0)
        assert asked(work, 2, share * 0.8) == (0.25 if share < 1.0 else 0.0)


def test_a_step_ends_nine_tenths_of_the_way_to_a_jam() -> None:
    """The monitors of two contacts: press, grip, end, jam."""
    asked: list[tuple[int, float]] = []
    kin = [SimpleNamespace(margin=0.3), SimpleNamespace(margin=-0.4)]
    smooth = SimpleNamespace(closed=SimpleNamespace(kin=kin), monitors=np.full(40, np.nan))
    instead = {
        "press_left": lambda work, i, zero: zero * (i + 1),
        "_tangential_monitor": lambda model, state, options, i, work, closed: 5.0 + i,
        "is_paradox": lambda work, m, i, near: (asked.append((i, near)), i == 1)[1],  # type: ignore[func-returns-value]
    }
    state, options = SimpleNamespace(now=SimpleNamespace(lenience=3.0)), SimpleNamespace(force_zero=0.5, extent=0.25)
    smallest = in_python(coupled_motion._watch, **instead)(None, state, options, 2, 2, None, smooth)
    kinds = coupled_motion
    values = smooth.monitors[2 * kinds.MONITORS :]
    for i, (press, grip, end, jam) in enumerate(((1.5, 5.0, 0.8, 1.0), (3.0, 6.0, 0.1, -1.0))):
        own = values[kinds.MONITORS * i :]
        assert own[[kinds.NORMAL, kinds.TANGENTIAL, kinds.EXTENT, kinds.PARADOX]] == pytest.approx([press, grip, end, jam])
    assert smallest == -1.0 and asked == [
        (0, pytest.approx(0.9e-9, abs=0.0, rel=1e-9)),
        (1, pytest.approx(0.9e-9, rel=1e-9, abs=0.0)),
    ]


@pytest.mark.parametrize(("nearest", "share"), [(3e-8, 8.0 / 30.0), (0.9e-8, 0.5)])
def test_forces_are_read_again_eight_extents_before_the_end_of_a_primitive(nearest: float, share: float) -> None:
    """Of the contact that was nearest to it, but no more than half of the way back."""
    before = np.full(60, 9.0)
    before[contact_mode_end.EXTENT + contact_mode_end.MONITORS] = nearest
    before[contact_mode_end.EXTENT + 2 * contact_mode_end.MONITORS] = 1e-12
    scratch, state = (
        SimpleNamespace(smooth=SimpleNamespace(before=before)),
        SimpleNamespace(now=SimpleNamespace(awake_contacts=2)),
    )
    found = in_python(contact_mode_end._while_within)(state, SimpleNamespace(extent=1e-9), 1.0, 3.0, scratch)
    assert found == pytest.approx(3.0 - share * 2.0)


@SIGNS
@pytest.mark.parametrize(("inside", "sticks"), [(0.9e-9, False), (1.1e-9, True)])
def test_at_the_end_of_a_chatter_what_is_within_its_cone_sticks(inside: float, sticks: bool, sign: float) -> None:
    """By a billionth of the cone; without friction it slides as it does, and what is not pressed is left out."""
    T = sign * (1.0 - inside) * 0.4 * 2.0
    kin = [SimpleNamespace(gT_dot=v) for v in (9.0, 9.0, -0.1, 0.1)]
    closed = SimpleNamespace(ids=[3, 0, 2, 1], kin=kin)
    work = SimpleNamespace(force=np.array([2.0, T, 0.0, 0.0, 1.0, 0.0, 3.0, 0.0]))
    ending, mode = np.full(8, np.nan), np.full(4, 77)
    event, room = SimpleNamespace(closed=closed, rest=None, pose=None), SimpleNamespace(ending=ending, mode=mode)
    contacts = [SimpleNamespace(group=int(k != 3)) for k in range(4)]
    model = SimpleNamespace(contacts=contacts, laws=[SimpleNamespace(friction=0.4), SimpleNamespace(friction=0.0)])
    kept: list[tuple[int, int]] = []

    class Read(Exception):
        """All is known that is asked here."""

    def solve_mode(*given: object) -> None:
        raise Read

    instead = {
        "plastic_impact": lambda *_: True,
        "contact_kinematics": lambda model, k, pose, r, rest: kept.append((k, r)),
        "solve_mode": solve_mode,
    }
    state = SimpleNamespace(u=None, now=SimpleNamespace(lenience=1.0))
    with pytest.raises(Read):
        in_python(chatter.end_chatter, **instead)(model, state, 4, (0.1, 0.0), work, event, room)
    assert kept == [(3, 0), (2, 1), (1, 2)] and ending[:6].tolist() == [2.0, T, 1.0, 0.0, 3.0, 0.0]
    slides = BACKWARD if sign > 0.0 else FORWARD
    assert mode.tolist() == [77, FORWARD, BACKWARD, STICK if sticks else slides]


def test_what_an_impulse_has_changed_is_rounded_to_a_ten_billionth() -> None:
    """Beside the rounding of speeds."""
    work, room = SimpleNamespace(G=np.diag([9.0, 9.0, 5.0, 9.0])), SimpleNamespace(impulse=[9.0, 9.0, 0.3, 9.0])
    event = SimpleNamespace(closed=None, pace=None)
    asked = in_python(collision._rounding, rounding_of=lambda closed, i, options, pace: 2e-10 * i)
    assert asked(1, None, event, work, room) == pytest.approx(2e-10 + 1e-10 * 0.3 * 5.0, rel=1e-12, abs=0.0)


@BOTH_SIDES
@SIGNS
def test_a_change_of_energy_is_rounding_of_what_there_is_and_was(share: float, sign: float) -> None:
    """A millionth, and a trillionth of the highest; or what speeds that may be stopped hold, but of driven bodies."""
    names = ("mass", "scale", "driven")
    rows = [SimpleNamespace(**dict(zip(names, row, strict=True))) for row in ((2.0, 0.5, 0), (3.0, 4.0, 0), (9.0, 9.0, 1))]
    model, options = SimpleNamespace(coordinates=rows), SimpleNamespace(speed_zero=1e-9, size=4.0)
    asked = in_python(impulse_check.is_explained)
    allowed = 1e-6 * 0.5 + 1e-12 * 7e5
    assert asked(SimpleNamespace(coordinates=[]), options, 0.5, 0.5 + sign * share * allowed, 7e5) == (share < 1.0)
    slow = 30.0 * 1e-9 / 4.0 * np.array([0.5, 4.0])
    held = 0.5 * (2.0 * slow[0] ** 2 + 3.0 * slow[1] ** 2)
    assert asked(model, options, 0.0, share * held, 0.0) == (share < 1.0)


@pytest.mark.parametrize(("off", "same"), [(0.9, True), (1.1, False), (-0.9, True), (-1.1, False)])
def test_rates_within_a_tenth_are_the_same(off: float, same: bool) -> None:
    seen = SimpleNamespace(contact=2, last=1.0, hits=7, away=0.5, rate=-3.0)
    state = SimpleNamespace(returning=seen, clock=SimpleNamespace(time=1.25))
    options = SimpleNamespace(accumulation_time=1.0)
    assert not in_python(shrinking_play._comes_back_endlessly)(state, options, 2, -3.0 + 0.3 * off)
    assert (seen.hits, seen.away) == ((8, 0.5) if same else (1, 0.25)) and seen.last == 1.25


@pytest.mark.parametrize(("away", "endless"), [(0.249, True), (0.251, False)])
def test_play_has_shrunk_where_it_takes_half_the_time(away: float, endless: bool) -> None:
    seen = SimpleNamespace(contact=2, last=1.0, hits=1000, away=0.5, rate=-3.0)
    state = SimpleNamespace(returning=seen, clock=SimpleNamespace(time=1.0 + away))
    asked = in_python(shrinking_play._comes_back_endlessly)
    assert bool(asked(state, SimpleNamespace(accumulation_time=1.0), 2, -3.0)) == endless


@pytest.mark.parametrize(("ahead", "passed"), [(0.8e-15, True), (11 * 2.0**-53, False)])
def test_a_knot_that_close_ahead_has_been_passed(ahead: float, passed: bool) -> None:
    table = SimpleNamespace(over=OVER_TIME, start=1, count=2)
    model = SimpleNamespace(tables=[table], knots=np.array([[9.0, 9.0], [1.0, 5.0], [3.0, 5.0]]))
    assert in_python(applied_forces.next_knot)(model, 1.0 - ahead) == (3.0 if passed else 1.0)
