"""Does every part of Lemke's method, as plain Python, do what linear algebra and trying all bases say?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from naive.lcp_oracle import residual, solutions
from plain_kernels import in_python

from watchsim.dynamics.lcp import basis, lemke_pivoting
from watchsim.dynamics.lcp.lemke_pivoting import LcpWork, lcp_work
from watchsim.dynamics.lcp.outcome import LcpOutcome

ROOM = 7
LEMKE, ENUMERATE, SOLVE = (in_python(getattr(lemke_pivoting, name)) for name in ("lemke_on_path", "enumerate_lcp", "solve_lcp"))


def room() -> LcpWork:
    """All of it not a number, so that what nobody has written is not read."""
    work = lcp_work(ROOM)
    for name in ("matrix", "load", "row_scale", "column_scale", "tableau", "square", "trial"):
        getattr(work, name)[:] = np.nan
    return work


def p_matrix(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Unsymmetric with positive principal minors: exactly one solution. Every third has small whole numbers, with ties."""
    rng = np.random.default_rng(seed)
    n = 2 + seed % 4
    if seed % 3 == 0:
        A = rng.integers(-1, 2, size=(n, n)).astype(float)
        np.fill_diagonal(A, n)
        return A, rng.integers(-2, 2, size=n).astype(float)
    half, turn = rng.normal(size=(2, n, n))
    units = 10.0 ** rng.uniform(-3.0, 3.0, (2, n))
    return units[0][:, None] * (half @ half.T + 0.1 * np.eye(n) + turn - turn.T) * units[1], units[0] * rng.normal(size=n)


def in_corner(A: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The problem in larger arrays, and room for x."""
    big, loads, n = np.full((ROOM, ROOM), np.nan), np.full(ROOM, np.nan), len(b)
    big[:n, :n], loads[:n] = A, b
    return big, loads, np.full(ROOM, np.nan)


@pytest.mark.parametrize("seed", range(30))
def test_the_only_solution_is_found_on_every_path_and_by_trial(seed: int) -> None:
    A, b = p_matrix(seed)
    n = len(b)
    units = 1.0 / np.sqrt(np.abs(np.diag(A)))
    truth = solutions(A * units[:, None] * units, b * units)[0] * units
    big, loads, x = in_corner(A, b)
    for path in range(9):
        work = room()
        assert LEMKE(big, loads, n, path, work, x) == LcpOutcome.SOLVED
        assert x[:n] == pytest.approx(truth, rel=1e-8, abs=1e-12 * np.abs(truth).max())
        assert work.worst.violation < 1e-13 * n
    x[:n] = np.nan
    assert ENUMERATE(big, loads, n, room(), x) == LcpOutcome.SOLVED
    assert x[:n] == pytest.approx(truth, rel=1e-8, abs=1e-12 * np.abs(truth).max())


@pytest.mark.parametrize("seed", range(20))
def test_problems_without_structure_are_solved_exactly_when_they_can_be(seed: int) -> None:
    rng = np.random.default_rng(seed)
    A, b = rng.normal(size=(3, 3)), rng.normal(size=3)
    big, loads, x = in_corner(A, b)
    there_are = bool(solutions(A, b))
    assert (SOLVE(big, loads, 3, room(), x) == LcpOutcome.SOLVED) == there_are
    assert residual(A, b, x[:3]) < 1e-10 if there_are else x[:3].tolist() == [0.0] * 3
    x[:3] = 7.0
    assert (ENUMERATE(big, loads, 3, room(), x) == LcpOutcome.SOLVED) == there_are
    assert there_are or x[:3].tolist() == [0.0] * 3


@pytest.mark.parametrize(("n", "asked"), [(2, True), (12, True), (13, False)])
def test_all_sets_are_tried_of_up_to_twelve_unknowns(n: int, asked: bool) -> None:
    tried = []

    def enumerate_lcp(A: object, b: object, n: int, work: object, x: object) -> LcpOutcome:
        tried.append(n)
        return LcpOutcome.SOLVED

    instead = {"lemke_checked": lambda *_: LcpOutcome.INEXACT, "enumerate_lcp": enumerate_lcp}
    outcome = in_python(lemke_pivoting.solve_lcp, **instead)(None, None, n, None, None)
    assert (tried == [n]) == asked and outcome == (LcpOutcome.SOLVED if asked else LcpOutcome.INEXACT)
    instead["enumerate_lcp"] = lambda *_: LcpOutcome.RAY
    assert in_python(lemke_pivoting.solve_lcp, **instead)(None, None, 2, None, None) == LcpOutcome.INEXACT


def test_what_is_no_solution_is_inexact_but_nothing_to_do_is_no_question() -> None:
    for loads, good, expected in (
        ([1.0, -1.0], False, LcpOutcome.INEXACT),
        ([1.0, -1.0], True, LcpOutcome.SOLVED),
        ([1.0, 0.0], False, LcpOutcome.SOLVED),
    ):
        instead = {"_follow": lambda *_: LcpOutcome.SOLVED, "is_solution": lambda n, work, good=good: good}
        assert in_python(lemke_pivoting.lemke_on_path, **instead)(None, np.array(loads), 2, 0, None, None) == expected
    instead = {"_follow": lambda *_: LcpOutcome.RAY, "is_solution": lambda *_: False}
    assert in_python(lemke_pivoting.lemke_on_path, **instead)(None, np.array([1.0, -1.0]), 2, 0, None, None) == LcpOutcome.RAY


def test_the_usual_path_is_the_first_one() -> None:
    """Whose loads are as they are given."""
    asked = in_python(lemke_pivoting.lemke_checked, lemke_on_path=lambda A, b, n, path, work, x: (n, path))
    assert asked(None, None, 3, None, None) == (3, 0)
    asked = in_python(lemke_pivoting.lemke, _follow=lambda A, b, n, path, work, x: (n, path))
    assert asked(None, None, 3, None, None) == (3, 0)


@pytest.mark.parametrize("path", range(9))
def test_a_path_begins_in_the_row_of_the_most_negative_load_over_its_multiple_of_z0(path: int) -> None:
    """The last of equal ones. Paths up to the fourth have equal multiples, the others unlike ones."""
    n, rng = 6, np.random.default_rng(path)
    work = lcp_work(n)
    work.matrix[:] = rng.normal(size=(n, n))
    work.load[:] = [0.3, -0.5, 0.2, -0.5, -0.1, -0.499]
    work.worst.driver = 0.5
    row = in_python(lemke_pivoting._start)(n, path, work)
    T = work.tableau
    assert np.array_equal(T[:, :n], np.eye(n)) and np.array_equal(T[:, n : 2 * n], -work.matrix)
    assert work.basis.tolist() == list(range(n))
    cover, ratios = -T[:, 2 * n], -T[:, -1] / T[:, 2 * n]
    assert ratios[row] == ratios.min() and row == np.flatnonzero(ratios == ratios.min())[-1]
    assert np.all(cover == 1.0) if path <= 4 else np.all(cover >= 1.0) and len(np.unique(np.round(cover, 9))) == n
    assert path or row == 3


@pytest.mark.parametrize(("row", "column"), [(0, 2), (2, 5), (1, 7)])
def test_a_pivot_makes_a_unit_vector_of_its_column(row: int, column: int) -> None:
    n, rng = 3, np.random.default_rng(column)
    work = SimpleNamespace(tableau=rng.normal(size=(n, 2 * n + 2)), basis=np.array([4, 5, 6]))
    before, columns = work.tableau.copy(), [j for j in range(2 * n + 2) if j != column]
    in_python(lemke_pivoting._pivot)(n, row, column, work)
    assert work.basis.tolist() == [column if i == row else 4 + i for i in range(n)]
    assert work.tableau[:, column].tolist() == [float(i == row) for i in range(n)]
    change = np.eye(n)
    change[:, row] = before[:, column]
    assert work.tableau[:, columns] == pytest.approx(np.linalg.solve(change, before[:, columns]))


@pytest.mark.parametrize("seed", range(12))
def test_active_unknowns_solve_their_equations(seed: int) -> None:
    """Pivots may lie anywhere; those that rounding leaves free are zero."""
    rng = np.random.default_rng(seed)
    n = 5
    work = lcp_work(n)
    active = rng.random(n) < 0.7
    work.matrix[:] = rng.normal(size=(n, n)) * 10.0 ** rng.uniform(-2.0, 0.0, n)
    work.load[:], work.is_active[:], work.trial[:] = rng.normal(size=n), active, np.nan
    assert in_python(basis.solve_active)(n, work)
    expected = np.zeros(n)
    expected[active] = np.linalg.solve(work.matrix[np.ix_(active, active)], -work.load[active])
    assert work.trial == pytest.approx(expected)


def test_where_active_rows_depend_on_others_the_free_unknown_is_zero() -> None:
    work = lcp_work(4)
    work.matrix[:] = [[9, 9, 9, 9], [9, 2, 1, 3], [9, 4, 5, 9], [9, 6, 6, 12]]
    work.load[:], work.is_active[:] = [9, -5, -13, -18], [0, 1, 1, 1]
    assert not in_python(basis.solve_active)(4, work)
    assert work.trial[0] == 0.0 and np.count_nonzero(work.trial) == 2
    assert work.matrix[1:] @ work.trial == pytest.approx([5.0, 13.0, 18.0])


def test_there_is_room_for_the_elimination_of_all_unknowns() -> None:
    """Dependent rows among them."""
    work = lcp_work(3)
    work.matrix[:], work.load[:], work.is_active[:] = [[2, 1, 3], [4, 5, 9], [6, 6, 12]], [-5, -13, -18], 1
    assert not in_python(basis.solve_active)(3, work)
    assert work.matrix @ work.trial == pytest.approx([5.0, 13.0, 18.0])


def test_a_solution_misses_nothing_and_its_worst_condition_is_kept() -> None:
    """Where an unknown is positive, however small, both ways; else only below zero."""
    ask = in_python(basis.is_solution)

    def judged(trial: list[float], y: list[float]) -> tuple[bool, float]:
        x = np.array(trial)
        worst = SimpleNamespace(driver=1.0, violation=0.0)
        work = SimpleNamespace(trial=x, load=np.array(y) - x, matrix=np.eye(2), worst=worst)
        return bool(ask(2, work)), worst.violation

    assert judged([1.0, 0.0], [0.0, -1e-6]) == (False, 0.0)
    assert judged([100.0, 0.0], [0.0, -0.9e-11])[0] and not judged([100.0, 0.0], [0.0, -1.1e-11])[0]
    assert judged([1.0, 0.0], [0.0, 0.5]) == (True, 0.0)
    assert judged([2.0**-12, 0.0], [2.0**-46, 0.5]) == (True, 2.0**-46)
    assert judged([2.0**-12, 0.0], [-(2.0**-46), 0.5]) == (True, 2.0**-46)
    assert judged([0.0, 0.0], [-(2.0**-46), 0.5]) == (True, 2.0**-46)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("off", "solves"), [(0.9, True), (1.1, False)])
def test_terms_that_cancel_count_without_their_sign(off: float, solves: bool, sign: float) -> None:
    """3 - 3 and a load: a residual of a billionth of six."""
    worst = SimpleNamespace(driver=0.0, violation=0.0)
    work = SimpleNamespace(trial=np.array([1.0, 1.0]), matrix=np.array([[3.0, -3.0], [0.0, 1.0]]), worst=worst)
    work.load = np.array([sign * off * 6e-9, -1.0])
    assert bool(in_python(basis.is_solution)(2, work)) == solves


@pytest.mark.parametrize(("left", "found"), [(-0.9e-9, 0.0), (-1.1e-9, -1.1e-9), (1e-12, 1e-12), (0.0, 0.0)])
def test_unknowns_negative_by_rounding_are_zero(left: float, found: float) -> None:
    work = lcp_work(1)
    work.matrix[0, 0], work.load[0], work.is_active[0] = 2.0, -2.0 * left, 1
    in_python(basis.solve_active)(1, work)
    assert work.trial[0] == pytest.approx(found, rel=1e-12, abs=0.0)
