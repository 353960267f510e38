"""Would the checks of random impacts and complementarity problems notice a wrong answer, and what do they ask?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from reference.single_impact import single_impact as truth
from scipy.optimize import linprog

from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.verification import random_problems as problems

Array = np.ndarray
RNG = np.random.default_rng(4711)


def test_the_impact_of_one_contact_is_that_of_the_reference() -> None:
    """In all its cases: it sticks, or slips either way, in the compression, and again in the expansion."""
    regimes = set()
    for _ in range(400):
        W, mu, eps = RNG.normal(size=(2, 3)), RNG.uniform(0.0, 1.5), RNG.uniform()
        G, rates = W @ W.T, np.array([-RNG.uniform(0.1, 2.0), RNG.normal()])
        if mu * abs(G[0, 1]) >= 0.95 * G[0, 0]:
            continue
        found = truth((G[0, 0], G[0, 1], G[1, 1]), tuple(rates), mu, eps)
        regimes.add((found.regime, math.copysign(1.0, found.tangential), abs(found.v_t) < 1e-12))
        got = problems.single_impact(G, rates, mu, eps)
        scale = np.abs((found.normal, found.tangential)).max()
        assert got == pytest.approx([found.normal, found.tangential], abs=1e-11 * scale)
    assert len(regimes) == 8


class Recorder:
    """Takes the place of the contacts: what it was given, and one answer that is off by a share of its scale."""

    def __init__(self, off: float = 0.0, in_velocity: bool = False, cancelling: bool = False, solved: bool = True) -> None:
        self.cases: list[SimpleNamespace] = []
        self.off, self.in_velocity, self.cancelling, self.solved = off, in_velocity, cancelling, solved
        self.left = bool(off)

    def __call__(self, mass: Array, W: Array, friction: Array, restitution: Array) -> SimpleNamespace:
        case = SimpleNamespace(mass=mass, W=W, mu=friction[0], eps=restitution[0])
        self.cases.append(case)

        def impact(u: Array) -> tuple[bool, Array, Array]:
            G, rates = W / mass @ W.T, W @ u
            found = truth((G[0, 0], G[0, 1], G[1, 1]), tuple(rates), case.mu, case.eps)
            force = np.array([found.normal, found.tangential])
            case.u, case.rate, case.G, after = u, rates[0], G, u + W.T @ force / mass
            # What would stop the parts of the approach: where they cancel, the impulse is the small difference of large ones.
            parts = float(sum(abs(w * v) for w, v in zip(W[0], u, strict=True)) / G[0, 0])
            cancels = bool(parts > 3.0 * force[0])
            if self.left and cancels is self.cancelling:
                self.left = False
                if self.in_velocity:
                    after = after + self.off * np.abs(after).max() * np.array([0.0, 1.0, 0.0])
                else:
                    force = force - self.off * (parts if cancels else max(force[0], parts)) * np.array([0.0, 1.0])
            return self.solved, after, force

        case.impact = impact
        return case


def rows(monkeypatch: pytest.MonkeyPatch, recorder: Recorder, count: int = 200) -> list[dict[str, Any]]:
    monkeypatch.setattr(problems, "BareContacts", recorder)
    return problems.impact_rows(count)


def test_impacts_of_every_kind_are_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    """All approach, none is near jamming; masses over two decades, friction up to 0.8, any restitution."""
    recorder = Recorder()
    left, error = rows(monkeypatch, recorder, 2000)
    cases = recorder.cases
    assert left["ok"] and error["ok"] and left["got"] == 0.0
    assert 900 < len(cases) < 1000  # half of 2000 approach, some of them near jamming
    assert all(case.rate < 0.0 and case.mu * abs(case.G[0, 1]) < 0.99 * case.G[0, 0] for case in cases)
    assert max(case.mu * abs(case.G[0, 1]) / case.G[0, 0] for case in cases) > 0.96
    assert max(abs(case.rate) for case in cases) > 3.0 and min(abs(case.rate) for case in cases) < 0.01
    masses = np.concatenate([case.mass for case in cases])
    assert masses.min() == pytest.approx(0.1, rel=0.02) and masses.max() == pytest.approx(10.0, rel=0.02)
    assert np.median(masses) == pytest.approx(1.0, rel=0.15)
    for name, most in (("mu", 0.8), ("eps", 1.0)):
        values = np.array([getattr(case, name) for case in cases])
        assert values.min() < 0.01 and 0.98 * most < values.max() <= most
    assert {case.W.shape for case in cases} == {(2, 3)} and {case.u.shape for case in cases} == {(3,)}


@pytest.mark.parametrize("cancelling", [True, False])
@pytest.mark.parametrize("in_velocity", [True, False], ids=["velocity", "impulse"])
@pytest.mark.parametrize(("off", "ok"), [(0.9e-12, True), (1.1e-12, False), (-1.1e-12, False)])
def test_one_wrong_impact_among_many_is_noticed(
    monkeypatch: pytest.MonkeyPatch, off: float, ok: bool, in_velocity: bool, cancelling: bool
) -> None:
    """Off by a billionth of a thousandth of the largest impulse, or velocity, of that case."""
    left, error = rows(monkeypatch, Recorder(off, in_velocity, cancelling))
    assert left["ok"] and error["ok"] is ok
    assert error["got"] == pytest.approx(abs(off), rel=0.02, abs=0.0) and error["expected"] == 0.0


def test_impacts_left_unsolved_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    recorder = Recorder(solved=False)
    left, error = rows(monkeypatch, recorder)
    assert left["got"] == len(recorder.cases) and not left["ok"] and left["expected"] == 0.0 and error["ok"]


@pytest.mark.parametrize("n", range(1, 6))
def test_solutions_are_told_from_what_is_none(n: int) -> None:
    """Conditions broken by 0.9 and 1.1 billionths of the largest term, in every row."""
    for k in range(n):
        x, slack = np.zeros(n), RNG.uniform(1.0, 2.0, n)
        x[::2], slack[::2] = RNG.uniform(1.0, 2.0, len(x[::2])), 0.0
        A = RNG.uniform(-0.5, 0.5, (n, n)) + np.eye(n)
        b = slack - A @ x
        largest = (np.abs(A) @ x + np.abs(b)).max()
        assert problems.is_solution(A, b, x)
        for shift in (1e-9 * largest * np.eye(n)[k], -1e-9 * largest * np.eye(n)[k]):
            assert problems.is_solution(A, b + 0.9 * shift, x)
            assert problems.is_solution(A, b + 1.1 * shift, x) is bool(slack[k] > 0.0)  # where x is zero slack may change
    assert not problems.is_solution(np.eye(n), np.ones(n), np.full(n, np.nan))


@pytest.mark.parametrize(
    ("x", "b", "ok"), [(-0.9e-9, 0.5, True), (-1.1e-9, 0.5, False), (1e-3, 0.5, False), (0.0, -0.5, False)]
)
def test_of_small_terms_a_billionth_is_allowed(x: float, b: float, ok: bool) -> None:
    """Below zero, or both members of the pair above it."""
    assert problems.is_solution(np.eye(1), np.array([b]), np.array([x])) is ok


def test_large_terms_of_either_sign_widen_what_counts_as_zero() -> None:
    """Where terms of 700 cancel, a millionth is rounding: 7e-7 below zero, or of slack."""
    assert problems.is_solution(np.array([[1e9]]), np.array([700.0]), np.array([-7e-7]))
    for slack, ok in ((1.3e-6, True), (-1.3e-6, True), (1.5e-6, False), (-1.5e-6, False)):
        assert problems.is_solution(np.array([[7.0]]), np.array([slack - 700.0]), np.array([100.0])) is ok
        assert problems.is_solution(np.array([[-7.0]]), np.array([slack + 700.0]), np.array([100.0])) is ok


@pytest.mark.parametrize("n", range(1, 6))
def test_what_has_a_solution_is_found(n: int) -> None:
    """Matrices with a positive definite symmetric part always have one; where no x >= 0 makes A x + b >= 0, there is none."""
    for _ in range(8):
        M, K = RNG.normal(size=(2, n, n))
        assert problems.has_solution(M @ M.T + 0.1 * np.eye(n) + K - K.T, RNG.normal(size=n))
        A, b = RNG.normal(size=(n, n)), RNG.normal(size=n)
        feasible = linprog(np.zeros(n), A_ub=-A, b_ub=b, bounds=[(0.0, None)] * n).status == 0
        assert feasible or not problems.has_solution(A, b)
    assert not problems.has_solution(-np.eye(n), np.full(n, -1.0))
    assert problems.has_solution(-np.eye(n), np.full(n, 1.0))
    assert not problems.has_solution(np.zeros((n, n)), np.full(n, -1.0))  # no regular basis but the empty one


@pytest.mark.parametrize(("entry", "there"), [(0.9e-9, False), (1.1e-9, True), (-1.1e-9, False)])
def test_bases_whose_determinant_is_no_billionth_are_singular(entry: float, there: bool) -> None:
    assert problems.has_solution(np.array([[entry]]), np.array([-1.0])) is there


def test_a_regular_basis_with_a_negative_determinant_counts() -> None:
    """x = (1, 1) solves it; no basis with one of them alone does."""
    A, b = np.array([[0.0, 1.0], [1.0, 0.0]]), np.array([-1.0, -1.0])
    assert np.linalg.det(A) < 0.0 and problems.has_solution(A, b)


def test_badly_scaled_matrices_come_to_order_one() -> None:
    """By powers of two, which round nothing; others are left as they are."""
    A = np.diag([1e12, -3.0, 1e-12])
    s = problems.scales(A)
    assert np.all(np.log2(s) == np.round(np.log2(s)))
    assert np.all((np.abs(np.diag(A)) * s * s >= 0.5) & (np.abs(np.diag(A)) * s * s <= 2.0))
    assert list(problems.scales(np.diag([1.0, 1.1e3]))) == [1.0, 2.0**-5]
    for well in (np.diag([2.0, 0.9 * 2e3]), np.diag([1e9, 0.0]), np.diag([1e9, 1e9])):
        assert list(problems.scales(well)) == [1.0, 1.0]


def test_a_solution_in_other_units_is_one_still() -> None:
    unit = np.array([1e6, 1e-6])
    A, x, slack = np.array([[2.0, 0.5], [-0.5, 2.0]]), np.array([0.5, 0.0]), np.array([0.0, 3.0])
    for units in (np.ones(2), unit):
        scaled, b = A * np.outer(units, units), (slack - A @ x) * units
        assert problems.is_solution(scaled, b, x / units)
        for k in (0, 1):
            off = 2.0 * 4e-9 * np.eye(2)[k]
            assert not problems.is_solution(scaled, b, (x - off) / units)


def test_the_families_are_what_they_are_called() -> None:
    rng = np.random.default_rng(5)
    drawn = [problems.degenerate(rng, 4) for _ in range(50)]
    assert {float(one) for A, b in drawn for one in (*A.ravel(), *b)} == {-1.0, 0.0, 1.0}
    for A, b in (problems.badly_scaled(rng, 3) for _ in range(100)):
        root = np.sqrt(np.diag(A))
        scaled = A / np.outer(root, root)
        assert np.linalg.eigvalsh(scaled + scaled.T).min() > 0.0 and not np.allclose(scaled, scaled.T)
        assert b.shape == (3,)
    sizes = np.array([np.diag(problems.badly_scaled(rng, 1)[0])[0] for _ in range(3000)])
    assert 1e-13 < sizes.min() < 1e-11 and 1e11 < sizes.max() < 1e14
    hopeless = set()
    for A, b in (problems.infeasible(rng, 4) for _ in range(100)):
        rows = [k for k in range(4) if np.all(A[k] < 0.0) and b[k] < 0.0]
        assert rows
        hopeless |= set(rows) if len(rows) == 1 else set()
    assert hopeless == {0, 1, 2, 3}
    A, b = problems.anything(rng, 5)
    assert A.shape == (5, 5) and b.shape == (5,)


def solver(answer: float, outcome: int, sizes: list[int]) -> Any:
    def solve(A: Array, b: Array, n: int, work: object, x: Array) -> int:
        sizes.append(n)
        assert A.shape == (n, n) and b.shape == x.shape == (n,)
        x[:] = answer
        return outcome

    return solve


def test_wrong_claims_and_missed_solutions_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of problems of one to five unknowns in four families."""
    sizes: list[int] = []
    monkeypatch.setattr(problems, "solve_lcp", solver(-1.0, int(LcpOutcome.SOLVED), sizes))
    claimed = problems.lcp_rows(40)
    assert [row["got"] for row in claimed[::2]] == [40.0] * 4 and not any(row["ok"] for row in claimed[::2])
    assert [row["got"] for row in claimed[1::2]] == [0.0] * 4
    assert all("of 0 given up" in row["quantity"] for row in claimed[1::2])
    assert set(sizes) == {1, 2, 3, 4, 5} and len(sizes) == 160
    failed = next(int(one) for one in LcpOutcome if one != LcpOutcome.SOLVED)
    monkeypatch.setattr(problems, "solve_lcp", solver(0.0, failed, sizes))
    given_up = problems.lcp_rows(40)
    assert all("of 40 given up" in row["quantity"] for row in given_up[1::2])
    assert [row["got"] for row in given_up[::2]] == [0.0] * 4
    missed = [row["got"] for row in given_up[1::2]]
    assert missed[2] > 20.0 and missed[3] == 0.0 and 0.0 < missed[1] < 40.0 and 0.0 < missed[0] < 40.0
    assert [row["ok"] for row in given_up[1::2]] == [False, False, False, True]
    assert all(row["expected"] == 0.0 and row["tolerance"] == 0.0 for row in (*claimed, *given_up))
