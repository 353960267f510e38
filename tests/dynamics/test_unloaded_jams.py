"""What becomes of contacts that would jam and that nothing presses, and which grip a little more in an impact?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics import impact, jamming

ACCELERATION_ROUNDING = 1e-11  # of its terms
NUDGE = 1e-6  # of the slip
PAINLEVE = 1e-9  # of G_N
UNIT, LOAD = 4.0, 0.3
OWN, BOTH = 3.0, 4.0  # G_N and G_NT: the bound of friction is 0.75
BOUND = OWN / BOTH


def settled(tangent: int, rhs: float, slip: float = -2.0, jams: bool = True, unloaded: bool = True) -> tuple[bool, float]:
    """(is anything pressed?, right-hand side of its normal row) of the second of two contacts; the first does not jam."""
    work = SimpleNamespace(
        tangent=[0, tangent], rhs=np.array([9.0, rhs]), loaded=np.array([0.0, 5.0, 0.0, slip]), unit=[1.0, UNIT]
    )
    instead = {
        "_jams": lambda work, m, i, near: i == 1 and jams,
        "_is_unloaded": lambda model, closed, i, work: i == 1 and unloaded,
    }
    pressed = in_python(jamming.press_unloaded, **instead)(None, None, 2, work)
    assert work.rhs[0] == 9.0
    return bool(pressed), float(work.rhs[1])


def test_one_that_slides_goes_on_without_a_force() -> None:
    """Its load is rounding, which must not pull it in."""
    assert settled(-1, -1e-17) == (False, 0.0)
    assert settled(-1, 1e-17) == (False, 1e-17)


@pytest.mark.parametrize("slip", [-2.0, 2.0])
def test_one_without_slip_is_pressed_by_next_to_nothing(slip: float) -> None:
    for tangent in (0, 3):
        assert settled(tangent, 1e-17, slip) == (True, pytest.approx(1e-17 - NUDGE * 2.0 * UNIT, rel=1e-12))


def test_what_nothing_would_move_or_what_is_pressed_or_does_not_jam_is_left_alone() -> None:
    assert settled(3, 1e-17, slip=0.0) == (False, 1e-17)
    assert settled(3, 1e-17, jams=False) == (False, 1e-17)
    assert settled(-1, -1e-17, unloaded=False) == (False, -1e-17)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("share", [0.9, -0.9, 1.1, -1.1])
def test_unloaded_is_what_is_rounding_of_all_that_acts(scale: float, share: float) -> None:
    """In any unit of force; the rounding of lever arms goes with the load of a bearing."""
    h, inverse, load = scale * np.array([0.5, -3.0]), np.array([2.0, 0.25]), scale * LOAD
    w_N, w_T = np.array([1.0, -0.2]), np.array([0.3, 0.7])
    terms = 0.1 * scale + float(((np.abs(w_N) + np.abs(w_T)) * (np.abs(h) + load) * inverse).sum())
    closed = SimpleNamespace(
        kin=[SimpleNamespace(bar_size=0.1 * scale)], slots=[2], coord=np.array([[0, 1]]), w_N=w_N[None], w_T=w_T[None]
    )
    work = SimpleNamespace(h=h, inverse=inverse, loaded=[share * ACCELERATION_ROUNDING * terms, 7.0])
    model = SimpleNamespace(coordinates=[SimpleNamespace(load=load)] * 2)
    assert bool(in_python(jamming._is_unloaded)(model, closed, 0, work)) == (abs(share) < 1.0)


@pytest.mark.parametrize("drag", [0.99, 1.01])
def test_a_contact_jams_by_itself_where_friction_outweighs_its_mobility(drag: float) -> None:
    """G_N - mu G_NT below zero, and no other contact has a say."""
    G = np.zeros((4, 4))
    G[:2, :2], G[2:, 2:] = [[2.0, 2.0], [2.0, 5.0]], np.eye(2)
    ask = in_python(jamming.is_paradox)
    work = SimpleNamespace(G=G, drag=np.array([drag, 0.0]), tangent=[-1, -1])
    assert bool(ask(work, 2, 0, 0.0)) == (drag > 1.0)
    assert bool(ask(work, 2, 0, 0.5))  # not half of it is left
    assert not ask(SimpleNamespace(**{**vars(work), "tangent": [2, -1]}), 2, 0, 0.0)
    for place in ((0, 2), (0, 3), (1, 2)):
        G[place] = 1e-9
        assert not ask(work, 2, 0, 0.5)
        G[place] = 0.0
    G[0, 0] = 0.0
    assert not ask(work, 2, 0, 0.5)


def gripped(share: float, jam: float = 1e-9, tangent: int = 1) -> tuple[float, float]:
    """Friction and width of its interval of the second of two contacts whose friction is `share` of the bound."""
    G = np.zeros((4, 4))
    G[0, 0], G[2, 2], G[2, 3] = 1.0, OWN, BOTH
    drag = np.array([0.5, share * BOUND])
    work = SimpleNamespace(G=G, drag=drag, tangent=[0, tangent], width=2.0 * drag)
    in_python(impact._grip_more)(2, jam, work)
    assert (work.drag[0], work.width[0]) == (0.5, 1.0)  # the first is far from jamming
    return float(work.drag[1]), float(work.width[1])


@pytest.mark.parametrize("off", [-0.9, -0.3, 0.0, 0.3, 0.9])
def test_near_the_bound_friction_is_taken_past_it(off: float) -> None:
    """By `PAINLEVE` of it, from either side: a normal force then pulls the bodies together."""
    drag, width = gripped(1.0 + off * PAINLEVE)
    assert OWN - drag * BOTH == pytest.approx(-PAINLEVE * OWN, rel=1e-6, abs=0.0)
    assert width == 2.0 * drag


@pytest.mark.parametrize("share", [0.5, 1.0 - 1.1 * PAINLEVE, 1.0 + 1.1 * PAINLEVE, 1.5, 4.0])
def test_friction_short_of_the_bound_or_past_it_stays_what_it_is(share: float) -> None:
    assert gripped(share) == (share * BOUND, 2.0 * share * BOUND)


def test_where_something_approaches_or_without_friction_nothing_grips_more() -> None:
    assert gripped(1.0, jam=0.0) == gripped(1.0, tangent=-1) == (BOUND, 2.0 * BOUND)
