"""Are the rates of coupled bodies those of all forces on them, island by island? Against whole matrices."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from made_up import both, closed_of, named
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.simulation.motion import coupled_motion

N = 4
MASS = np.array([2.0, 0.5, 3.0, 1.25])
COULOMB = [0.3, 0.0, 0.0, 0.4]
GRIP = [FORWARD, OPEN, STICK, BACKWARD]
AWAKE = [1, 1, 1, 0]
NORMAL = np.array([[1.0, -0.4, 0.0, 0.0], [0.0, 0.7, 0.6, 0.0], [0.0, 0.0, 0.0, 2.0]])
TANGENTIAL = np.array([[0.3, 0.8, 0.0, 0.0], [0.0, -1.1, 0.2, 0.0], [0.0, 0.0, 0.0, -0.9]])
FORCE = np.array([5.0, -1.5, 4.0, 0.75, 3.0, -2.5])  # N and T of three contacts
Y = np.array([0.1, 0.2, 0.3, 0.4, 1.5, -2.5, 3.5, -4.5, 9.0, 9.0, 9.0])  # q, u, sums
U = Y[N : 2 * N]
H = np.array([0.6, -0.7, 0.8, 0.9])


def ask(watched: list[float], bearings: float = 2.0) -> tuple[float, SimpleNamespace, SimpleNamespace, list[object]]:
    """(the smallest monitor, room of the motion, counts, calls) with contacts 0 and 1 in one island, 2 in another one.

    `watched`: the smallest monitor of the first island and of the second one.
    """
    every = both(NORMAL, TANGENTIAL)
    calls: list[object] = []
    islands = {0: (0, 2), 2: (2, 3)}
    inverse = np.where(np.array(GRIP) == STICK, 0.0, 1.0 / MASS)
    work = named(h=np.zeros(N), force=np.zeros(6), inverse=inverse)
    smooth = named(
        y=Y, dy=np.full(11, 77.0), pose="pose", closed=closed_of(NORMAL, TANGENTIAL), engaged=[1, 0, 2], load=np.zeros(N),
        terms=np.zeros(N),
    )  # fmt: skip
    coordinates = [named(coulomb=c, driven=int(i == 1)) for i, c in enumerate(COULOMB)]
    model = named(coordinates=coordinates, bodies=[None] * 3)
    counts = named(evaluations=3)
    state = named(
        grip=GRIP, awake=AWAKE, mode="modes", active=[0, 1, 2, 7], upto=[2, 2, 3], counts=counts,
        now=named(awake_contacts=3, lenience=5.0),
    )  # fmt: skip

    def forces(model, t, q, u, out) -> None:
        assert (t, q.tolist(), u.tolist()) == (2.5, Y[:N].tolist(), U.tolist())
        out[:] = H

    def place_contacts(model, ids, first, last, pose, closed) -> int:
        assert (ids, pose, last) == (state.active, "pose", islands[first][1])
        rows = slice(2 * first, 2 * last)
        own = closed_of(NORMAL[first:last], TANGENTIAL[first:last], gT_dot=(every[rows] @ U)[1::2].tolist())
        for name in ("ids", "slots", "coord", "w_N", "w_T", "kin"):
            getattr(closed, name)[: len(own.ids)] = getattr(own, name)
        calls.append((first, last))
        return last - first

    def solve_mode(model, closed, m, mode, lenience, work) -> None:
        assert (mode, lenience) == ("modes", 5.0)
        first = calls[-1][0]
        work.force[: 2 * m] = FORCE[2 * first : 2 * (first + m)]

    def watch(model, state, options, first, m, work, smooth) -> float:
        assert (first, first + m) == calls[-1]
        return watched[0 if first == 0 else 1]

    instead = {
        "forces": forces,
        "place_body": lambda model, b, q, u, pose: calls.append(b),
        "place_contacts": place_contacts,
        "solve_mode": solve_mode,
        "_watch": watch,
        "_watch_bearings": lambda *_: bearings,
        "drive_power": lambda model, t, q, u: 10.0 * t,
        "damping_power": lambda model, q, u: float(u.sum()),
    }
    smallest = in_python(coupled_motion.motion, **instead)(model, state, None, 2.5, work, smooth)
    return smallest, smooth, counts, calls


def test_accelerations_are_those_of_all_forces_on_what_is_awake_and_not_held() -> None:
    """Of a driven coordinate the force is its acceleration, whatever else acts."""
    _, smooth, counts, calls = ask([1.0, 1.0])
    pushed = both(NORMAL, TANGENTIAL).T @ FORCE
    drag = np.array([-0.3, 0.0, 0.0, 0.4])
    expected = (H + drag + pushed) / MASS
    expected[1] = H[1] + pushed[1] / MASS[1]  # here its inverse mass is not zero
    expected[2] = 0.0
    expected[3] = 0.0
    assert smooth.dy[: 2 * N] == pytest.approx([*U, *expected], rel=1e-13)
    assert counts.evaluations == 4
    assert calls == [0, 2, (0, 2), (2, 3)]


def test_what_friction_in_a_bearing_must_hold_is_all_that_acts_there() -> None:
    _, smooth, _, _ = ask([1.0, 1.0])
    held = both(NORMAL, TANGENTIAL)[:, 2] * FORCE
    drag = np.array([-0.3, 0.0, 0.0, 0.4])
    assert smooth.load == pytest.approx(H + drag + [0.0, 0.0, held.sum(), 0.0])
    assert smooth.terms == pytest.approx(np.abs(H + drag) + np.array([0.0, 0.0, np.abs(held).sum(), 0.0]))


def test_sums_are_work_put_in_and_what_damping_bearings_and_slips_take() -> None:
    _, smooth, _, _ = ask([1.0, 1.0])
    whole = both(NORMAL, TANGENTIAL)
    driven = -float((whole[:, 1] * FORCE).sum()) * U[1]
    slips = (whole @ U)[1::2]
    assert smooth.dy[2 * N :] == pytest.approx(
        [25.0 + driven, U.sum() + 0.3 * U[0] - 0.4 * U[3], -float(FORCE[1::2] @ slips)], rel=1e-13, abs=0.0
    )


@pytest.mark.parametrize(
    ("watched", "bearings", "smallest"), [([3.0, 4.0], 5.0, 3.0), ([4.0, 3.0], 5.0, 3.0), ([4.0, 5.0], -3.0, -3.0)]
)
def test_the_smallest_monitor_is_that_of_all_islands_and_bearings(
    watched: list[float], bearings: float, smallest: float
) -> None:
    assert ask(watched, bearings)[0] == smallest


def test_bearings_are_watched_behind_all_contacts() -> None:
    """Four monitors a contact come before them."""
    values = [0.4, 0.1, 0.3]
    instead = {"bearing_monitor": lambda model, state, options, j, smooth: values[j]}
    smooth = named(monitors=np.full(12, np.nan))
    found = in_python(coupled_motion._watch_bearings, **instead)(
        named(coordinates=[None] * 3), named(now=named(awake_contacts=2)), None, smooth
    )
    assert found == 0.1 and smooth.monitors[8:11].tolist() == values
    assert np.isnan(smooth.monitors[:8]).all() and math.isnan(smooth.monitors[11])


def test_bodies_in_contact_are_engaged_and_no_others() -> None:
    """Of contacts of awake bodies alone."""
    model = named(
        contacts=[named(a=3, b=0), named(a=1, b=2), named(a=4, b=4)], primitives=[named(body=b) for b in (5, 1, 3, 0, 2)]
    )
    smooth = named(engaged=np.full(6, 7))
    in_python(coupled_motion.engage)(model, named(active=[1, 0, 2], now=named(awake_contacts=2)), smooth)
    assert smooth.engaged.tolist() == [1, 1, 0, 1, 0, 1]
