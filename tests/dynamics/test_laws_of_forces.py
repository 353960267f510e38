"""What must forces obey that the motion does not decide? Rows against the laws written out."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics import acceleration, redundant_contacts

FORCE_ZERO = 1e-10  # of a contact's force terms
LAW_SHARE = 0.25  # of that
M, UNKNOWNS = 3, 5
TANGENT = [3, -1, 4]  # contacts 0 and 2 stick, 1 slides
WIDTH, DRAG = np.array([0.4, 0.0, 0.7]), np.array([0.0, 0.3, 0.0])
W_N, W_T = np.array([[0.5, -1.0], [2.0, 0.1], [0.0, 3.0]]), np.array([[1.5, 0.2], [-1.0, 0.6], [0.0, -0.4]])
LENIENCE = 3.0


def laws(load: float, dry: float = 2.0, **bearing: float) -> SimpleNamespace:
    """The rows for three contacts on two coordinates, the second one held by dry friction unless `bearing` says otherwise."""
    held = SimpleNamespace(**{"coulomb": dry, "driven": 0, **bearing})
    model = SimpleNamespace(coordinates=[SimpleNamespace(coulomb=0.0, driven=0), held])
    closed = SimpleNamespace(slots=[2, 2, 1], coord=np.array([[0, 1], [1, 0], [1, 9]]), w_N=W_N.copy(), w_T=W_T.copy())
    closed.w_N[2, 0], closed.w_T[2, 0] = W_N[2, 1], W_T[2, 1]  # acts on the second coordinate alone
    closed.w_N[1], closed.w_T[1] = W_N[1, ::-1], W_T[1, ::-1]
    work = SimpleNamespace(tangent=TANGENT, width=WIDTH, drag=DRAG, h=np.array([9.0, load]), inverse=np.array([1.0, 0.0]))
    work.B, work.other_rhs, work.other_x = np.full((12, UNKNOWNS), np.nan), np.full(12, np.nan), np.full(12, np.nan)
    work.G = np.diag([2.0, 50.0, 3.0, 60.0, 4.0, 70.0])
    work.size = np.array([10.0, 500.0, 20.0, 600.0, 30.0, 700.0])
    work.count = in_python(redundant_contacts._fill_laws)(model, closed, M, UNKNOWNS, LENIENCE, work)
    return work


SLACK = LAW_SHARE * LENIENCE * FORCE_ZERO * np.array([10.0 / 2.0, 20.0 / 3.0, 30.0 / 4.0])


@pytest.mark.parametrize("load", [0.8, -1.7])
def test_each_row_is_what_is_left_of_a_law(load: float) -> None:
    work = laws(load)
    x = np.random.default_rng(2).normal(size=UNKNOWNS)
    N, T = x[:3], np.array([x[3], -DRAG[1] * x[1], x[4]])
    torque = float(W_N[:, 1] @ N + W_T[:, 1] @ T)
    largest = max(abs(W_N[0, 1]), abs(W_N[1, 1] - DRAG[1] * W_T[1, 1]), abs(W_N[2, 1]), abs(W_T[0, 1]), abs(W_T[2, 1]))
    left = [*N, 0.4 * N[0] - T[0], 0.4 * N[0] + T[0], 0.7 * N[2] - T[2], 0.7 * N[2] + T[2]]
    left += [(2.0 + load + torque) / largest, (2.0 - load - torque) / largest]
    assert work.count == len(left)
    found = work.B[: work.count] @ x + work.other_rhs[: work.count]
    assert found == pytest.approx(left)
    bearing = LAW_SHARE * LENIENCE * FORCE_ZERO * abs(load) / largest
    assert work.other_x[: work.count] == pytest.approx([*SLACK, *SLACK[[0, 0, 2, 2]], bearing, bearing], rel=1e-12)


@pytest.mark.parametrize("bearing", [{"coulomb": 0.0}, {"driven": 1}])
def test_a_bearing_without_dry_friction_or_choice_has_no_law(bearing: dict[str, float]) -> None:
    assert laws(1.0, **bearing).count == 7
    assert laws(1.0, dry=1e-6).count == 9


def test_a_bearing_that_no_contact_acts_on_has_no_law() -> None:
    closed = SimpleNamespace(slots=[1, 1], coord=np.zeros((2, 1), int), w_N=np.ones((2, 1)), w_T=np.ones((2, 1)))
    work = SimpleNamespace(h=np.array([9.0, 0.5]), B=np.full((4, 3), np.nan), other_rhs=np.zeros(4), other_x=np.zeros(4))
    work.tangent, work.drag = [2, -1], np.array([0.0, 0.3])
    model = SimpleNamespace(coordinates=[None, SimpleNamespace(coulomb=2.0)])
    assert in_python(redundant_contacts._hold_bearing)(model, closed, 2, 3, 1, 1, 1.0, work) == 1


def test_a_contact_that_moves_nothing_has_no_slack() -> None:
    slack = in_python(redundant_contacts._slack)
    work = SimpleNamespace(G=np.zeros((2, 2)), size=np.ones(2))
    assert slack(work, 0, 1.0) == 0.0


def test_directions_become_orthonormal_in_the_weights_of_forces() -> None:
    """A sliding contact's friction counts with its normal force; what depends on the others is left out."""
    rng = np.random.default_rng(8)
    work = SimpleNamespace(weight=np.zeros(UNKNOWNS), tangent=TANGENT, drag=DRAG)
    in_python(redundant_contacts._weigh)(M, UNKNOWNS, work)
    assert work.weight.tolist() == [1.0, 1.0 + 0.3**2, 1.0, 1.0, 1.0]
    vectors = rng.normal(size=(4, UNKNOWNS))
    vectors[2] = vectors[0] - 2.0 * vectors[1]
    span = vectors.copy()
    count = in_python(redundant_contacts._orthonormalize)(vectors, 4, UNKNOWNS, work.weight)
    assert count == 3
    assert vectors[:3] * work.weight @ vectors[:3].T == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.matrix_rank(np.concatenate([span, vectors[:3]]), tol=1e-10) == 3


@pytest.mark.parametrize("row", range(6))
def test_a_row_has_the_rounding_of_its_terms_and_of_what_other_contacts_pass_on(row: int) -> None:
    """However these cancel; a sliding contact passes on its friction, too."""
    rng = np.random.default_rng(4)
    G = rng.normal(size=(6, 6))
    G[2, 2] = -1.0  # no mobility: its own terms make no force
    G[0, 0], G[4, 4] = 2.0, 5.0
    work = SimpleNamespace(G=G, size=np.arange(1.0, 7.0), force=rng.normal(size=6), drag=np.array([0.4, -0.3, 0.0]))
    work.worth = np.zeros(3)
    in_python(acceleration._fill_worth)(work, 3)
    assert work.worth.tolist() == [1.0 / 2.0, 0.0, 5.0 / 5.0]
    work.worth[1] = 0.7
    passed_on = np.abs(G[row, ::2]) + np.abs(work.drag * G[row, 1::2])
    expected = work.size[row] + np.abs(G[row] * work.force).sum() + np.delete(passed_on * work.worth, row // 2).sum()
    assert in_python(acceleration.row_terms)(work, 3, 6, row) == pytest.approx(expected)
