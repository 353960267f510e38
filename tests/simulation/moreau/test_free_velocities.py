"""What are the velocities after a step without contacts? Against the midpoint rule, solved as a matrix."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation.moreau import one_step, percussions

NUDGE = 1e-6  # of the slip
STEP = 0.1
MASS, STIFFNESS, VISCOUS, QUADRATIC = np.array([2.0, 0.5]), np.array([30.0, 4.0]), np.array([0.3, 0.0]), np.array([0.1, 0.7])
REST, FORCE = np.array([0.2, -0.4]), np.array([1.5, -0.25])
Q, U = np.array([0.5, 0.1]), np.array([-1.0, 2.0])


def stepped(tables: list[SimpleNamespace], driven: tuple[int, int] = (0, 0)) -> SimpleNamespace:
    """The room of the step after it, of two sprung coordinates under constant forces and these tables of 3 N·m each."""
    rows = zip(MASS, STIFFNESS, VISCOUS, QUADRATIC, REST, driven, strict=True)
    names = ("mass", "stiffness", "viscous", "quadratic", "rest", "driven")
    coordinates = [SimpleNamespace(**dict(zip(names, row, strict=True))) for row in rows]
    model = SimpleNamespace(coordinates=coordinates, tables=tables, joints=[], lines=[])
    state = SimpleNamespace(clock=SimpleNamespace(time=7.0), q=Q, a=np.zeros(2))
    names = ("force", "damping", "mass", "inverse", "free", "foreseen")
    work = SimpleNamespace(q=Q + 0.5 * STEP * U, u=U, **{name: np.full(2, np.nan) for name in names})

    def table_force(model, j, t, q):
        assert t == 7.0 + 0.5 * STEP and q is work.q
        return 3.0

    def push_back(model, on, force, out):
        out[on] -= force

    instead = {"driving_force": lambda model, i, q: FORCE[i], "table_force": table_force, "push_back": push_back}
    in_python(one_step._free_velocity, **instead)(model, state, STEP, work)
    return work


@pytest.mark.parametrize("on", [-1, 0])
def test_springs_and_damping_act_at_the_middle_and_what_carries_is_pushed_back(on: int) -> None:
    """m (v - u) = h (F - k (q + h (u + v)/4 - rest) - c (u + v)/2), with c at the velocity before."""
    work = stepped([SimpleNamespace(coordinate=1, on=on)])
    force = FORCE + np.array([-3.0 if on == 0 else 0.0, 3.0])
    damping = VISCOUS + QUADRATIC * np.abs(U)
    matrix = np.diag(MASS / STEP + 0.25 * STEP * STIFFNESS + 0.5 * damping)
    right = MASS / STEP * U + force - STIFFNESS * (Q + 0.25 * STEP * U - REST) - 0.5 * damping * U
    assert work.free == pytest.approx(np.linalg.solve(matrix, right))
    assert work.inverse == pytest.approx(1.0 / (STEP * np.diag(matrix)))


def test_what_is_driven_feels_no_percussion() -> None:
    assert stepped([], driven=(1, 0)).inverse[0] == 0.0 < stepped([], driven=(1, 0)).inverse[1]


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("share", [0.9e-10, 1.1e-10])
def test_a_tangential_percussion_that_small_in_its_cone_has_no_sign(size: float, share: float) -> None:
    """In any unit of impulse: then the expansion has a whole cone, else what is given back ends it on one side."""
    from watchsim.model.records import TANGENTIAL_CODE

    mu, ends = 0.4, np.full((1, 4), np.nan)
    law = SimpleNamespace(kind=TANGENTIAL_CODE["pg1996"], friction=mu, tangential=0.5, nu=0.0)
    for sign in (1.0, -1.0):
        T = sign * share * mu * size
        in_python(percussions._expansion_ends)(law, 0.8, size, T, ends, 0)
        low, low_slope, high, high_slope = ends[0]
        if share < 1e-10:
            assert (low, high) == (0.0, 0.0) and (low_slope, high_slope) == pytest.approx((-0.5 * mu, 0.5 * mu))
        else:
            back = 0.8 * 0.5 * T
            expected = (back, 0.0, 0.0, mu) if sign > 0.0 else (0.0, -mu, back, 0.0)
            assert (low, low_slope, high, high_slope) == pytest.approx(expected, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("unit", [1.0, 1e-6])
@pytest.mark.parametrize("beside", [-1.1, -0.9, 0.0, 0.9, 1.1])
def test_friction_goes_one_way_where_slip_and_approach_stop_together(sign: float, beside: float, unit: float) -> None:
    """By `NUDGE` of the slip at most may they miss each other; the second contact's directions are not parallel."""
    slip = sign * 0.3 * unit
    G = np.array([[4.0, 2.0, 0.0, 0.0], [2.0, 1.0, 0.0, 0.0], [0.0, 0.0, 4.0, 2.0], [0.0, 0.0, 2.0, 1.1]])
    normal = (slip - beside * NUDGE * abs(slip)) / 0.5
    laws = SimpleNamespace(G=G, ends=np.full((2, 4), 9.0))
    work = SimpleNamespace(laws=laws, rates=np.array([normal, slip, 0.7 * normal, 0.7 * slip]))
    instead = {"_law": lambda model, work, i: SimpleNamespace(friction=0.4)}
    in_python(percussions._keep_sliding, **instead)(None, 2, work)
    still = SimpleNamespace(laws=SimpleNamespace(G=G, ends=np.full((2, 4), 9.0)), rates=np.zeros(4))
    in_python(percussions._keep_sliding, **instead)(None, 2, still)
    assert still.laws.ends.tolist() == [[9.0] * 4] * 2
    one_way = [9.0, -0.4 * sign, 9.0, -0.4 * sign]
    assert laws.ends.tolist() == [one_way if abs(beside) < 1.0 else [9.0] * 4, [9.0] * 4]
