"""What counts as a solution of a contact problem, and is its other form the same problem?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics.delassus import fill_bearings
from watchsim.dynamics.lcp import basis, lemke_pivoting
from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.dynamics.solver_fallbacks import _solve_copositive, fill_copositive

LCP_RESIDUAL = 1e-9  # of its terms
LCP_ROUNDING = 1e-13  # of the largest unknown, or of one


def judged(trial: list[float], y: list[float], rough: float = 0.0, driver: float = 0.0) -> tuple[bool, float]:
    """Do unknowns solve a problem whose matrix is the identity, with these y = x + load; and the worst violation kept?"""
    x = np.array(trial)
    worst = SimpleNamespace(driver=driver, violation=0.0)
    work = SimpleNamespace(trial=x, load=np.array(y) - x, matrix=np.eye(len(x)), worst=worst)
    return bool(in_python(basis.solves)(len(x), rough, work)), worst.violation


@pytest.mark.parametrize(
    ("trial", "y", "is_one"),
    [
        ([1.0, 0.0], [0.0, 0.5], True),
        ([0.0, 0.0], [0.0, 0.0], True),
        ([1.0, -1e-18], [0.0, 0.5], False),  # unknowns must not be negative at all
        ([1e-5, 1.0], [1e-6, 0.0], False),  # however small: where it is positive, y is zero
        ([1e-5, 1.0], [1e-13, 0.0], True),
        ([1.0, 0.0], [0.0, -1e-6], False),
        ([1.0, 0.0], [0.0, -0.9 * LCP_ROUNDING], True),
        ([1.0, 0.0], [0.0, -1.1 * LCP_ROUNDING], False),
        ([1.0, np.nan], [0.0, 0.0], False),
    ],
)
def test_what_solves_a_problem_to_rounding(trial: list[float], y: list[float], is_one: bool) -> None:
    assert judged(trial, y)[0] == is_one


@pytest.mark.parametrize("size", [1.0, 0.01, 100.0])
def test_a_residual_is_judged_by_its_terms_and_kept_as_a_share_of_the_largest_unknown(size: float) -> None:
    """The terms of y are x and the load, of size `size` both."""
    allowed = 2.0 * LCP_RESIDUAL * size + LCP_ROUNDING * max(1.0, size)
    good, violation = judged([size, 0.0], [0.9 * allowed, 0.0])
    assert good and violation == pytest.approx(0.9 * allowed / max(1.0, size), rel=1e-5, abs=0.0)
    assert judged([size, 0.0], [1.1 * allowed, 0.0]) == (False, 0.0)


def test_as_a_last_resort_a_share_of_the_load_that_drives_it_may_be_missed() -> None:
    assert judged([1.0, 0.0], [0.0, -1e-7], 1e-6, 0.5)[0]
    assert judged([0.1, 0.0], [0.0, -4.9e-7], 1e-6, 0.5)[0]
    assert not judged([0.1, 0.0], [0.0, -5.1e-7], 1e-6, 0.5)[0]


@pytest.mark.parametrize("blocks", [(0,), (0, 1), (2, 0, 1), (7, 1, 7)])
def test_the_copositive_form_is_the_same_problem_in_other_unknowns(blocks: tuple[int, ...]) -> None:
    """x_T = middle + beta_+ - beta_-, by substitution; a block beyond the contacts has an interval of its own length."""
    m, elements = 3, len(blocks)
    rng = np.random.default_rng(elements)
    first, other = m + 2 * elements, m + 3 * elements
    work = SimpleNamespace(
        A=rng.normal(size=(first, first)),
        rhs=rng.normal(size=first),
        B=np.full((other, other), np.nan),
        other_rhs=np.full(other, np.nan),
        block=np.array(blocks),
        width=rng.uniform(0.2, 1.0, elements),
    )
    assert in_python(fill_copositive)(work, m, elements) == other
    N, plus, minus, slip = (rng.uniform(0.0, 1.0, size) for size in (m, elements, elements, elements))
    half = np.array([
        0.5 * (work.rhs[m + elements + e] + (work.width[e] * N[block] if block < m else 0.0)) for e, block in enumerate(blocks)
    ])  # fmt: skip
    lines = work.A[: m + elements, : m + elements] @ np.append(N, half + plus - minus) + work.rhs[: m + elements]
    found = work.B @ np.concatenate([N, plus, minus, slip]) + work.other_rhs
    np.testing.assert_allclose(found[:m], lines[:m], atol=1e-13)
    np.testing.assert_allclose(found[m : m + elements], slip + lines[m:], atol=1e-13)
    np.testing.assert_allclose(found[m + elements : m + 2 * elements], slip - lines[m:], atol=1e-13)
    np.testing.assert_allclose(found[m + 2 * elements :], half - plus - minus, atol=1e-13)


def test_bearings_and_contacts_share_the_rows_of_what_forces_do() -> None:
    """W M⁻¹ Wᵀ with a row of one for each bearing, by whole matrices."""
    rng = np.random.default_rng(9)
    w_N, w_T, coord = rng.normal(size=(3, 2)), rng.normal(size=(3, 2)), np.array([[0, 2], [3, 1], [1, 0]])
    inverse, dry = np.array([0.5, 2.0, 4.0, 0.25]), [2, 0]
    W = np.zeros((8, 4))
    for j in range(3):
        W[2 * j, coord[j]], W[2 * j + 1, coord[j]] = w_N[j], w_T[j]
    W[[6, 7], dry] = 1.0
    expected = W * inverse @ W.T
    work = SimpleNamespace(G=np.full((8, 8), np.nan), inverse=inverse, dry=dry)
    work.G[:6, :6] = expected[:6, :6]
    closed = SimpleNamespace(slots=[2, 2, 2], coord=coord, w_N=w_N, w_T=w_T)
    in_python(fill_bearings)(closed, 3, 2, work)
    np.testing.assert_allclose(work.G, expected, atol=1e-14)


def test_an_answer_of_the_copositive_form_is_checked_as_one_of_the_first_form() -> None:
    """All of its unknowns: forces, places in the intervals of friction, and speeds of slip."""
    m, elements, asked = 2, 2, []
    work = SimpleNamespace(
        A=np.arange(16.0).reshape(4, 4) / 10.0, rhs=np.array([0.0, 0.0, -1.0, 5.0, 1.0, 2.0]), x=np.full(6, np.nan),
        other_x=np.array([0.5, 0.25, 0.1, 0.3, 0.2, 0.0, 9.0, 9.0]), block=np.array([0, 1]), width=np.array([0.8, 0.4]),
        B=None, other_rhs=None, lcp=None,
    )  # fmt: skip
    instead = {
        "fill_copositive": lambda *_: 8,
        "lemke_checked": lambda *_: LcpOutcome.SOLVED,
        "_is_solved": lambda work, n: asked.append(n) or True,
    }
    assert in_python(_solve_copositive, **instead)(work, m, elements)
    assert asked == [m + 2 * elements]
    half = [0.5 * (1.0 + 0.8 * 0.5), 0.5 * (2.0 + 0.4 * 0.25)]
    friction = [half[0] + 0.1 - 0.2, half[1] + 0.3]
    slip = work.rhs[2:4] + work.A[2:4] @ [0.5, 0.25, *friction]
    assert work.x == pytest.approx([0.5, 0.25, *friction, *np.maximum(0.0, -slip)])


@pytest.mark.parametrize(("path", "solved", "good"), [(0, True, True), (0, True, False), (1, True, False), (0, False, True)])
def test_where_a_basis_cannot_be_solved_afresh_its_loads_are_read_off_the_tableau(path: int, solved: bool, good: bool) -> None:
    """Only of the first path is the fresh solution checked; the tableau's last column holds the loads, in the order of rows."""
    n, rng = 3, np.random.default_rng(1)
    tableau = rng.uniform(1.0, 2.0, (n, 2 * n + 2))
    tableau[1, -1] = -0.5
    work = SimpleNamespace(is_active=np.full(n, 7), basis=np.array([n + 2, n + 0, 1]), tableau=tableau, trial=np.zeros(n))
    fresh = {"solve_active": lambda n, work: solved, "is_solution": lambda n, work: good}
    in_python(lemke_pivoting._solve_basis, **fresh)(n, path, work)
    assert work.is_active.tolist() == [1, 0, 1]
    kept = solved and (path > 0 or good)
    assert work.trial.tolist() == ([0.0] * 3 if kept else [0.0, 0.0, tableau[0, -1]])
