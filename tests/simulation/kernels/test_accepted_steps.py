"""Where is everything at the end of a coupled step, and what has it cost? With made-up extensions and contacts."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from made_up import both, closed_of, named, work_of
from plain_kernels import in_python

from watchsim.contact.index_sets import FORWARD, OPEN, STICK
from watchsim.simulation import accepted_step
from watchsim.simulation.loop_state.state import NO_CONTACT

MASS = np.array([1.5, 0.4, 2.0, 0.7])
NORMAL = np.array([[1.0, 0.3, 0.0, 0.0], [0.4, -1.2, 0.0, 0.0], [0.0, 0.0, 0.9, 0.5]])
TANGENTIAL = np.array([[-0.2, 1.0, 0.0, 0.0], [0.8, 0.1, 0.0, 0.0], [0.0, 0.0, -0.6, 1.1]])
GAPS = np.array([3e-9, -2e-9, -5e-9])
Q, U, SUMS = np.array([0.1, 0.2, 0.3, 0.4]), np.array([1.0, -2.0, 3.0, -4.0]), np.array([7.0, 8.0, 9.0])
LENGTH, TIME = 0.5, 2.5
OPTIONS = named(behind=2e-8, speed_zero=1e-8)


def accepted(end: float, *, driven: tuple[int, int] = (0, 0), turns: bool = False) -> SimpleNamespace:
    """State, room and calls after following a step with islands of contacts 0 and 1, and of 2, to `end`."""
    calls: list[Any] = []
    y1 = np.concatenate([Q, U, SUMS])
    smooth = named(y=np.full(11, 77.0), dy=np.arange(11.0), pose="pose", closed=closed_of(NORMAL, TANGENTIAL))
    step = named(span=named(start=TIME, length=LENGTH), y0=y1 + 100.0, y1=y1)
    coordinates = [named(mass=m, driven=0, linear=0, number=i) for i, m in enumerate(MASS)]
    coordinates[3].driven, coordinates[3].linear = driven
    state = named(
        q=np.full(4, 77.0), u=np.full(4, 77.0), a=np.full(4, 77.0),
        active=[0, 1, 2, 9], upto=[2, 2, 3], mode=[STICK, FORWARD, OPEN],
        now=named(awake_contacts=3), worst=named(penetration=1e-10, kinetic_energy=3.0),
        sums=named(drive=0.5, damping=0.25, friction=0.125),
    )  # fmt: skip

    def place_contacts(model, ids, first, last, pose, closed) -> int:
        rows = slice(first, last)
        own = closed_of(
            NORMAL[rows], TANGENTIAL[rows], list(range(first, last)), g=GAPS[rows].tolist(),
            gN_dot=(NORMAL[rows] @ state.u).tolist(), gT_dot=(TANGENTIAL[rows] @ state.u).tolist(),
        )  # fmt: skip
        for name in ("ids", "slots", "coord", "w_N", "w_T", "kin"):
            getattr(closed, name)[: len(own.ids)] = getattr(own, name)
        return last - first

    def motion(model, state, options, t, work, smooth) -> None:
        calls.append(("motion", t, smooth.y.tolist()))

    instead = {
        "dense_value": lambda step, i, tau: y1[i] + 10.0 * tau,
        "flow": lambda coordinate, grip, q, u, t: (q + u * t, grip + t) if coordinate.number == 3 else None,
        "motion": motion,
        "place_contacts": place_contacts,
        "_turns_rates": lambda model, state, options, m, closed: calls.append(("turns", m)) or turns,
        "place": lambda model, q, u, pose: calls.append("place"),
        "refresh": lambda model, m, closed, pose: calls.append(("refresh", m)),
    }
    model = named(coordinates=coordinates)
    scratch = named(step=step, work=work_of(3, 1.0 / MASS), smooth=smooth)
    before = in_python(accepted_step._follow_step, **instead)(model, state, OPTIONS, end, scratch)
    return named(state=state, smooth=smooth, calls=calls, before=before)


@pytest.mark.parametrize("end", [0.2, 0.5, 0.6])
def test_a_step_is_followed_and_drift_taken_back_island_by_island(end: float) -> None:
    """By its extension, or to its end; energy is that before drift is taken back."""
    done = accepted(end)
    more = 10.0 * end if end < LENGTH else 0.0
    q, u = Q + more, U + more
    assert done.calls[0] == ("motion", TIME + end, pytest.approx([*q, *u, *(SUMS + more)]))
    assert done.before == pytest.approx(0.5 * float(MASS @ u**2))
    root = np.sqrt(1.0 / MASS)
    assert done.state.q - q == pytest.approx(root * (np.linalg.pinv(NORMAL * root) @ -GAPS), rel=1e-6, abs=0.0)
    rows = both(NORMAL, TANGENTIAL)[[0, 1, 2]]  # N and T of the one that sticks, N of the one that slides
    changed = u.copy()
    changed[:2] += root[:2] * (np.linalg.pinv(rows[:, :2] * root[:2]) @ -(rows[:, :2] @ u[:2]))
    # Two coordinates cannot obey three rows: gap rates and slips that depend on others are left as they are.
    assert NORMAL[:2] @ done.state.u == pytest.approx([0.0, 0.0], abs=1e-12)
    assert done.state.u[2:] == pytest.approx(u[2:])
    assert done.state.worst.penetration == 5e-9
    assert done.calls[1:] == [("turns", 2), ("turns", 1)]


def test_rates_are_read_again_where_places_have_turned_them() -> None:
    calls = accepted(0.2, turns=True).calls
    assert calls[1:] == [("turns", 2), "place", ("refresh", 2), ("turns", 1), "place", ("refresh", 1)]


@pytest.mark.parametrize(("driven", "exact"), [((1, 1), True), ((1, 0), False), ((0, 1), False)])
def test_a_prescribed_motion_in_closed_form_is_exact(driven: tuple[int, int], exact: bool) -> None:
    done = accepted(0.2, driven=driven)
    told = done.calls[0][2]
    wanted = (100.4 + 0.2 * 96.0, OPEN + 0.2) if exact else (0.4 + 2.0, -4.0 + 2.0)
    assert (told[3], told[7]) == pytest.approx(wanted)
    assert told[:3] == pytest.approx((Q + 2.0).tolist()[:3])


def finished(touched: int, explained: bool = True) -> tuple[tuple[float, bool], SimpleNamespace, list[Any]]:
    """What `accept_coupled` answers, the state, and what it asked."""
    asked: list[Any] = []
    state = named(u="u", a=np.zeros(2), sums=named(drive=0.5, damping=0.25, friction=0.125), worst=named(kinetic_energy=3.0))
    smooth = named(y=np.arange(7.0), dy=np.arange(10.0, 17.0))
    instead = {
        "_follow_step": lambda model, state, options, end, scratch: asked.append(end) or 2.0,
        "_follow_to_touch": lambda model, state, options, followed, k, scratch: asked.append((followed, k)) or (0.3, 4.0),
        "kinetic_energy": lambda model, u: 1.75,
        "is_explained": lambda model, options, before, after, highest: asked.append((before, after, highest)) or explained,
    }
    model = named(coordinates=[None, None])
    kernel = in_python(accepted_step.accept_coupled, **instead)
    return kernel(model, state, OPTIONS, 0.4, touched, named(smooth=smooth)), state, asked


def test_sums_accelerations_and_the_highest_energy_are_those_at_the_end() -> None:
    found, state, asked = finished(NO_CONTACT)
    assert found == (0.4, True) and asked == [0.4, (2.0, 1.75, 3.0)]
    assert vars(state.sums) == {"drive": 4.5, "damping": 5.25, "friction": 6.125}
    assert state.a.tolist() == [12.0, 13.0] and state.worst.kinetic_energy == 3.0


@pytest.mark.parametrize("explained", [True, False])
def test_what_touches_ends_the_step_where_it_does(explained: bool) -> None:
    found, state, asked = finished(0, explained)
    assert found == (0.3, explained) and asked == [0.4, ((0.4, 2.0), 0), (4.0, 1.75, 4.0)]
    assert state.worst.kinetic_energy == 4.0
