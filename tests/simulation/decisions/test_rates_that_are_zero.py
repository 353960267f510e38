"""Which gap rates count as zero, and which contacts wait because another one is met first?"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.index_sets import FORWARD, OPEN
from watchsim.simulation.events import parallel_contacts, zero_rates

CONTRADICTING_RATE = 100.0  # times what counts as zero
HIDDEN_REBOUND = 20.0  # times the gap that is zero
RATE_FLOOR = 1e-15  # of the size per second
RATE_ROUNDING = 1e-12  # of the terms
TILT_ROUNDING = 1e-13  # rad
OPTIONS = SimpleNamespace(gap_zero=1e-13, speed_zero=1e-8, size=0.5)
W_N, W_T = np.array([[0.3, -2.0], [1.0, 0.0]]), np.array([[-4.0, 0.5], [0.0, 0.0]])
PACE = np.array([0.7, 3.0, 0.1])
COLUMNS = np.array([[2, 0], [1, 0]])


def rows(rates=(0.0, 0.0), gaps=(0.0, 0.0), ids=(5, 8)) -> SimpleNamespace:
    kin = [SimpleNamespace(gN_dot=rate, g=gap) for rate, gap in zip(rates, gaps, strict=True)]
    return SimpleNamespace(slots=[2, 1], coord=COLUMNS, w_N=W_N, w_T=W_T, kin=kin, ids=list(ids))


def rounding(i: int) -> float:
    """By whole matrices."""
    full_N, full_T = np.zeros((2, 3)), np.zeros((2, 3))
    full_N[0, COLUMNS[0]], full_T[0, COLUMNS[0]] = W_N[0], W_T[0]
    full_N[1, 1], full_T[1, 1] = W_N[1, 0], W_T[1, 0]
    every = RATE_ROUNDING * np.abs(full_N) @ PACE + TILT_ROUNDING * np.abs(full_T) @ PACE + RATE_FLOOR * OPTIONS.size
    return float(every[i])


@pytest.mark.parametrize("exactly", [True, False])
def test_rates_are_zero_below_tolerance_or_below_the_rounding_of_their_terms(exactly: bool) -> None:
    zero = np.zeros(2)
    in_python(zero_rates.set_rate_zeros)(rows(), 2, exactly, OPTIONS, PACE, zero)
    assert zero == pytest.approx([rounding(0), rounding(1)] if exactly else [OPTIONS.speed_zero] * 2, rel=1e-12, abs=0.0)


def test_the_fastest_of_an_instant_is_kept() -> None:
    pace = np.array([1.0, 2.0, 0.0])
    in_python(zero_rates.note_pace)(np.array([-1.5, 1.0, -0.0]), pace)
    assert pace.tolist() == [1.5, 2.0, 0.0]


def sinks(rate: float, gap: float, acceleration: float, touched: int = 8, mode: int = OPEN) -> bool:
    instead = {"accelerate": lambda *_: None, "gap_acceleration": lambda rest, i, a: (-1e9, acceleration)[i]}
    state = SimpleNamespace(now=SimpleNamespace(touched=touched), a=None)
    decided = {5: OPEN, 8: mode}
    event = SimpleNamespace(rest=rows((-1.0, rate), (0.0, gap)), decided=decided, pace=PACE)
    return bool(in_python(zero_rates._sinks, **instead)(None, state, 2, OPTIONS, None, event))


@pytest.mark.parametrize("gap", [0.0, 4e-13, -1e-12])
@pytest.mark.parametrize("share", [0.99, 1.01])
def test_what_goes_on_closing_sinks_in_where_its_braking_way_is_too_long(gap: float, share: float) -> None:
    """v²/2a against the gap and the rounding of one."""
    room = max(gap, 0.0) + OPTIONS.gap_zero
    rate = -math.sqrt(2.0 * 5.0 * room * share)
    assert sinks(rate, gap, 5.0) == (share > 1.0)


def test_only_the_one_that_has_just_closed_and_opens_by_more_than_rounding() -> None:
    assert sinks(-1e-3, 0.0, 5.0)
    assert not sinks(-1e-3, 0.0, 5.0, touched=7)
    assert not sinks(-1e-3, 0.0, 5.0, mode=FORWARD)
    assert not sinks(-0.9 * rounding(1), 0.0, -1.0)
    assert sinks(-1.1 * rounding(1), 0.0, -1.0)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("share", [0.99, 1.01])
def test_rates_contradict_each_other_where_no_correction_takes_all_of_them_away(share: float, sign: float) -> None:
    left = sign * share * CONTRADICTING_RATE * np.array([0.0, rounding(1)])
    instead = {"_sinks": lambda *_: False, "find_correction": lambda *_: None, "rate_left": lambda rest, r, i, work: left[i]}
    for mode, expected in ((FORWARD, share > 1.0), (OPEN, False)):
        event = SimpleNamespace(rest=rows(), decided={5: FORWARD, 8: mode}, pace=PACE)
        assert bool(in_python(zero_rates.contradicts, **instead)(None, None, 2, OPTIONS, None, event)) == expected


def left(gaps: tuple[float, float, float], modes=(OPEN, OPEN, OPEN), touched: int = -1) -> list[int]:
    """Of contacts 0 and 1 on one rotor, with arms 1 and 2, and contact 2 on a body of its own: those that do not wait."""
    arms, names = np.array([[1.0, 0.0], [2.0, 0.0], [0.0, 1.0]]), [0, 1, 2]
    kin = [SimpleNamespace(g=gap) for gap in gaps]
    closed = SimpleNamespace(kin=kin, ids=names)
    work = SimpleNamespace(rhs=np.zeros(3), G=np.zeros((6, 6)))

    def fill(closed, m, work):
        work.G[::2, ::2] = arms @ np.diag([0.25, 3.0]) @ arms.T

    def move(model, k, pose, row, closed):
        closed.ids[row] = k

    kernel = in_python(parallel_contacts.drop_later, fill_delassus=fill, contact_kinematics=move)
    state = SimpleNamespace(mode=list(modes), now=SimpleNamespace(touched=touched))
    count = kernel(None, state, 3, OPTIONS, work, SimpleNamespace(closed=closed, pose=None))
    return names[:count]


def test_a_contact_waits_until_it_is_met_itself() -> None:
    """The rotor turns by its angle: gaps over arms say which is first, and by how much the other is open then."""
    least = HIDDEN_REBOUND * OPTIONS.gap_zero
    assert left((0.0, 0.0, 0.0)) == [0, 1, 2]
    assert left((1.1 * least, 0.0, 5.0 * least)) == [1, 2]
    assert left((0.9 * least, 0.0, 0.0)) == [0, 1, 2]
    assert left((0.0, 1.1 * least, 0.0)) == [0, 2]
    assert left((2.0 * least, 4.0 * least, 0.0)) == [0, 1, 2]  # both are met at once
    assert left((2.0 * least, 4.9 * least, 0.0)) == [0, 1, 2]
    assert left((2.0 * least, 5.1 * least, 0.0)) == [0, 2]


def test_what_is_in_force_or_has_just_touched_does_not_wait() -> None:
    least = HIDDEN_REBOUND * OPTIONS.gap_zero
    assert left((9.0 * least, 0.0, 0.0), modes=(FORWARD, OPEN, OPEN)) == [0, 1, 2]
    assert left((9.0 * least, 0.0, 0.0), touched=0) == [0, 1, 2]
    assert left((9.0 * least, 0.0, 0.0), touched=1) == [1, 2]
