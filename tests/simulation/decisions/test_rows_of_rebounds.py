"""Which rows of rebounds may be endless, and when would their contacts be back? From throws, in closed form."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation.events import chatter, jammed_contacts

VELOCITY_ROUNDING = 4e-15  # of its terms
FASTEST, CLOSE = 0.1, 1e-9


def event(rates: list[float], zero: float = 1e-9) -> SimpleNamespace:
    kin = [SimpleNamespace(gN_dot=rate) for rate in rates]
    return SimpleNamespace(closed=SimpleNamespace(kin=kin), zero=[zero] * len(rates), label=None)


@pytest.mark.parametrize(
    ("rates", "impulse", "restitution", "expected"),
    [
        ([0.05], [0.0], [0.0], True),
        ([0.1], [0.0], [0.0], True),
        ([0.11], [0.0], [0.0], False),  # too fast
        ([1e-9], [0.0], [0.0], False),  # does not leave
        ([0.05], [1.0], [0.5], False),  # rebounds: another rule
        ([0.05], [0.0], [0.5], True),  # was not hit: the others lift it
        ([0.05], [1.0], [0.0], True),  # hit without restitution, and lifted
        ([0.05, -1.0], [0.0, 1.0], [0.0, 1.0], False),  # nothing is lost
        ([0.05, -1.0], [0.0, 0.0], [0.0, 1.0], True),
        ([-0.2, 0.05], [1.0, 0.0], [0.3, 0.0], True),
    ],
)
def test_what_may_be_chatter(rates: list[float], impulse: list[float], restitution: list[float], expected: bool) -> None:
    room = SimpleNamespace(impulse=np.column_stack([impulse, np.full(len(rates), 7.0)]).ravel(), restitution=restitution)
    options = SimpleNamespace(accumulation_speed=FASTEST)
    assert bool(in_python(chatter.may_be_chatter)(len(rates), options, event(rates), room)) == expected


def asked(rates: list[float], accelerations: list[float]) -> tuple[float, bool]:
    instead = {"gap_acceleration": lambda closed, i, a: a[i]}
    state, options = SimpleNamespace(a=accelerations), SimpleNamespace(gap_close=CLOSE)
    return in_python(chatter.chatter_time, **instead)(state, len(rates), options, event(rates))


def test_thrown_up_a_contact_is_back_after_twice_its_speed_over_its_weight() -> None:
    assert asked([1e-6, 3e-6, 0.0], [-9.81, -2.0, -1.0]) == (pytest.approx(3e-6), False)


def test_what_is_not_pulled_back_stays_apart() -> None:
    assert asked([1e-6, 3e-6], [-9.81, 0.0]) == (pytest.approx(2e-6 / 9.81), True)


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_no_row_of_rebounds_goes_higher_than_contacts_count_as_closed(share: float) -> None:
    """A throw rises to v²/2g."""
    rate = math.sqrt(2.0 * 9.81 * share * CLOSE)
    assert (asked([rate], [-9.81])[0] == math.inf) == (share > 1.0)


def pressed(rates: list[float], force: list[float], back: list[float], solved: bool = True) -> float:
    """With `back` the accelerations of their gaps; what presses is the force over a mobility of 4 (1/kg)."""
    work = SimpleNamespace(
        force=np.column_stack([force, np.full(len(force), 9.0)]).ravel(), G=4.0 * np.eye(2 * len(force)), dry=None
    )
    instead = {
        "standing_bearings": lambda *_: 0,
        "decide_modes": lambda *_: solved,
        "gap_acceleration": lambda closed, i, a: a[i],
    }
    options, state = SimpleNamespace(gap_close=CLOSE, speed_zero=0.0), SimpleNamespace(a=back)
    room = SimpleNamespace(grip=None, mode=None)
    return in_python(chatter.pressed_time, **instead)(None, state, None, len(rates), options, work, event(rates), room)


def test_what_others_press_back_is_back_after_twice_its_speed_over_that_pressure() -> None:
    assert pressed([1e-6, 2e-6], [0.5, 0.25], [1.0, 1.0]) == pytest.approx(4e-6)
    assert pressed([1e-6, 2e-6], [0.5, 0.25], [1.0, -1.0]) == pytest.approx(1e-6)  # the other comes by itself
    assert pressed([0.0, 0.0], [0.5, 0.25], [1.0, 1.0]) == 0.0
    assert pressed([1e-6], [0.5], [1.0], solved=False) == math.inf
    assert pressed([1e-6], [0.0], [1.0]) == math.inf


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_pressed_back_it_must_not_have_gone_further_than_contacts_count_as_closed(share: float) -> None:
    """Against a pressure of 2 m/s² a speed reaches v²/4."""
    rate = math.sqrt(2.0 * 2.0 * share * CLOSE)
    assert (pressed([rate], [0.5], [1.0]) == math.inf) == (share > 1.0)


def test_velocities_that_are_rounding_of_what_they_were_are_stopped_for_good() -> None:
    pace = np.array([1.0, 100.0, 1.0, 1.0])
    u = VELOCITY_ROUNDING * np.array([0.9, -99.0, 1.1, 0.5])
    rest = SimpleNamespace(slots=[2, 1], coord=np.array([[0, 1], [2, 0]]))  # the last coordinate touches nothing
    kernel = in_python(jammed_contacts._stop_bodies)
    assert kernel(2, SimpleNamespace(rest=rest, pace=pace), u)
    assert u.tolist() == [0.0, 0.0, 1.1 * VELOCITY_ROUNDING, 0.5 * VELOCITY_ROUNDING]
    assert not kernel(2, SimpleNamespace(rest=rest, pace=pace), u)


@pytest.mark.parametrize("slips", [(0.0, 1e-8), (1.1e-8, -1e-8), (-1e-9, -1.1e-8)])
def test_a_contact_slides_faster_than_zero_whichever_way(slips: tuple[float, float]) -> None:
    rest = SimpleNamespace(kin=[SimpleNamespace(gT_dot=slip) for slip in slips])
    assert bool(in_python(jammed_contacts.slides)(2, 1e-8, rest)) == (max(map(abs, slips)) > 1e-8)
