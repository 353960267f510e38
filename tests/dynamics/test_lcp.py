"""Does the complementarity solver find what all complementary bases, tried one by one, say there is?"""

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
from naive.lcp_oracle import residual, solutions
from plain_kernels import in_python

from watchsim.dynamics import lcp as basis
from watchsim.dynamics import lcp as lemke_pivoting
from watchsim.dynamics import redundant as small_systems
from watchsim.dynamics.lcp import LcpOutcome, LcpWork, enumerate_lcp, lcp_work, lemke, solve_lcp

# Does the complementarity solver find what all complementary bases, tried one by one, say there is?

SIZE = 12
WORK = lcp_work(SIZE)
Problem = tuple[np.ndarray, np.ndarray]
Solver = Callable[..., int]


def run(A: np.ndarray, b: np.ndarray, solver: Solver = solve_lcp) -> tuple[int, np.ndarray]:
    """Status and x; the problem stands in the corner of larger arrays full of nan, which nobody may read."""
    n = len(b)
    big_A, big_b, x = np.full((SIZE, SIZE), np.nan), np.full(SIZE, np.nan), np.full(SIZE, np.nan)
    big_A[:n, :n], big_b[:n] = A, b
    status = solver(big_A, big_b, n, WORK, x)
    assert np.all(np.isnan(x[n:]))
    return status, x[:n]


def psd(rng: np.random.Generator, n: int) -> Problem:
    """Positive semidefinite of full rank."""
    M = rng.normal(size=(n, n))
    return M @ M.T, rng.normal(size=n)


def singular_psd(rng: np.random.Generator, n: int) -> Problem:
    """Positive semidefinite of lower rank, solvable: redundant contacts without friction."""
    M = rng.normal(size=(n, rng.integers(1, n + 1)))
    return M @ M.T, M @ rng.normal(size=M.shape[1])


def p_matrix(rng: np.random.Generator, n: int) -> Problem:
    """Unsymmetric with positive principal minors: exactly one solution for every b."""
    M, K = rng.normal(size=(n, n)), rng.normal(size=(n, n))
    return M @ M.T + 0.1 * np.eye(n) + (K - K.T), rng.normal(size=n)


def degenerate(rng: np.random.Generator, n: int) -> Problem:
    """Small integers, a P-matrix by diagonal dominance: ties everywhere."""
    A = rng.integers(-1, 2, size=(n, n)).astype(float)
    np.fill_diagonal(A, n)
    return A, rng.integers(-1, 2, size=n).astype(float)


def anything(rng: np.random.Generator, n: int) -> Problem:
    """No structure: none, one or many solutions."""
    return rng.normal(size=(n, n)), rng.normal(size=n)


def impact_with_friction(rng: np.random.Generator, contacts: int) -> Problem:
    """Compression of 1 or 2 frictional contacts on 3 coordinates: size 3 or 6, not positive definite, zero diagonals."""
    contacts = 1 + contacts % 2
    W = rng.normal(size=(3, 2 * contacts))
    G, k = W.T @ W, contacts
    mu, one = np.diag(rng.uniform(0.0, 0.6, k)), np.eye(k)
    A = np.block(
        [
            [G[:k, :k] - G[:k, k:] @ mu, G[:k, k:], 0.0 * one],
            [G[k:, :k] - G[k:, k:] @ mu, G[k:, k:], one],
            [2.0 * mu, -one, 0.0 * one],
        ]
    )
    return A, np.concatenate([W.T @ rng.normal(size=3), np.zeros(k)])


FAMILIES = (psd, singular_psd, p_matrix, degenerate)


@pytest.mark.parametrize(("solver", "seed", "trials", "largest"), [(solve_lcp, 20, 1500, SIZE), (lemke, 21, 500, 8)])
@pytest.mark.parametrize("family", FAMILIES)
def test_solvable_families_are_solved_by_lemke_alone(
    family: Callable[..., Problem], solver: Solver, seed: int, trials: int, largest: int
) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(trials):
        A, b = family(rng, rng.integers(1, largest + 1))
        status, x = run(A, b, solver)
        assert status == LcpOutcome.SOLVED
        assert residual(A, b, x) < 1e-12
        assert np.all(x >= 0.0)


@pytest.mark.parametrize("family", [p_matrix, degenerate])
def test_the_only_solution_of_a_p_matrix(family: Callable[..., Problem]) -> None:
    rng = np.random.default_rng(22)
    for _ in range(200):
        A, b = family(rng, rng.integers(1, 5))
        truth = solutions(A, b)
        status, x = run(A, b)
        assert status == LcpOutcome.SOLVED
        np.testing.assert_allclose(x, truth[0], rtol=1e-10, atol=1e-12)
        for other in truth[1:]:  # other bases of the same degenerate solution
            np.testing.assert_allclose(other, truth[0], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("family", [anything, impact_with_friction])
def test_finds_a_solution_exactly_when_there_is_one(family: Callable[..., Problem]) -> None:
    rng = np.random.default_rng(23)
    unsolvable = 0
    for _ in range(400):
        A, b = family(rng, rng.integers(1, 5))
        truth = solutions(A, b)
        status, x = run(A, b)
        assert (status == LcpOutcome.SOLVED) == bool(truth)
        if truth:
            assert min(np.abs(x - other).max() for other in truth) < 1e-7 * max(1.0, x.max())
        unsolvable += not truth
    assert family is not anything or unsolvable > 50


@pytest.mark.parametrize("family", [*FAMILIES, impact_with_friction])
def test_units_do_not_matter(family: Callable[..., Problem]) -> None:
    """Rows, columns and loads multiplied by 1e-12 to 1e12: the same solution in other units."""
    rng = np.random.default_rng(24)
    for trial in range(600):
        A, b = family(rng, rng.integers(1, 9))
        n = len(b)
        row, load = 10.0 ** rng.uniform(-12, 12, n), 10.0 ** rng.uniform(-12, 12)
        column = row if trial % 2 else 10.0 ** rng.uniform(-12, 12, n)
        plain, _ = run(A, b)
        status, x = run(row[:, None] * A * column, row * b * load)
        assert status == plain
        if status == LcpOutcome.SOLVED:
            assert residual(A, b, x * column / load) < 1e-11


@pytest.mark.parametrize("family", [psd, p_matrix, anything])
def test_enumeration_agrees_with_the_oracle(family: Callable[..., Problem]) -> None:
    rng = np.random.default_rng(25)
    for _ in range(150):
        A, b = family(rng, rng.integers(1, 6))
        status, x = run(A, b, enumerate_lcp)
        assert (status == LcpOutcome.SOLVED) == bool(solutions(A, b))
        assert status != LcpOutcome.SOLVED or residual(A, b, x) < 1e-9


def test_nothing_to_do_gives_exact_zeros() -> None:
    status, x = run(-np.eye(3), np.array([0.0, 2.0, 1e-300]))
    assert status == LcpOutcome.SOLVED
    assert list(x) == [0.0, 0.0, 0.0]


def test_infeasible_ends_in_a_ray_with_zeros() -> None:
    status, x = run(np.array([[0.0, -1.0], [-1.0, 0.0]]), np.array([-1.0, 1.0]))
    assert status == LcpOutcome.RAY
    assert list(x) == [0.0, 0.0]


def test_enumeration_rescues_what_lemke_loses() -> None:
    """Without structure Lemke may end in a ray although a solution exists."""
    rng = np.random.default_rng(26)
    rescued = 0
    for _ in range(500):
        A, b = anything(rng, 5)
        if run(A, b, lemke)[0] != LcpOutcome.SOLVED and run(A, b)[0] == LcpOutcome.SOLVED:
            assert residual(A, b, run(A, b)[1]) < 1e-9
            rescued += 1
    assert rescued > 10


def test_one_contact_by_hand() -> None:
    """G = 4 kg^-1, approach 2 m/s: impulse 0.5 N·s."""
    status, x = run(np.array([[4.0]]), np.array([-2.0]))
    assert status == LcpOutcome.SOLVED
    assert x[0] == 0.5


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_not_a_number_is_refused(bad: float) -> None:
    with np.errstate(invalid="ignore"):
        assert run(np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([bad, -1.0]))[0] != LcpOutcome.SOLVED
        assert run(np.array([[bad, 0.0], [0.0, 1.0]]), np.array([-1.0, -1.0]))[0] != LcpOutcome.SOLVED


# Does every part of Lemke's method, as plain Python, do what linear algebra and trying all bases say?

ROOM = 7
LEMKE, ENUMERATE, SOLVE = (in_python(getattr(lemke_pivoting, name)) for name in ("lemke_on_path", "enumerate_lcp", "solve_lcp"))


def room() -> LcpWork:
    """All of it not a number, so that what nobody has written is not read."""
    work = lcp_work(ROOM)
    for name in ("matrix", "load", "row_scale", "column_scale", "tableau", "square", "trial"):
        getattr(work, name)[:] = np.nan
    return work


def p_matrix_lemke_by_trial(seed: int) -> tuple[np.ndarray, np.ndarray]:
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
    A, b = p_matrix_lemke_by_trial(seed)
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


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("off", "solves"), [(0.9, True), (1.1, False)])
def test_terms_that_cancel_count_without_their_sign(off: float, solves: bool, sign: float) -> None:
    """3 - 3 and a load: a residual of a billionth of six."""
    worst = SimpleNamespace(driver=0.0, violation=0.0)
    work = SimpleNamespace(trial=np.array([1.0, 1.0]), matrix=np.array([[3.0, -3.0], [0.0, 1.0]]), worst=worst)
    work.load = np.array([sign * off * 6e-9, -1.0])
    assert bool(in_python(basis.is_solution)(2, work)) == solves


# Are small systems solved as numpy solves them, singular ones by one of their solutions, with all others beside it?

ROOM_SMALL_LINEAR_SYSTEMS = 6
SOLVE_SMALL_LINEAR_SYSTEMS, NULL, INDEPENDENT = (
    in_python(getattr(small_systems, name)) for name in ("solve_small", "null_vectors", "keep_independent")
)


def padded(A: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """In the corner of larger arrays."""
    big, right, n = (
        np.full((ROOM_SMALL_LINEAR_SYSTEMS, ROOM_SMALL_LINEAR_SYSTEMS), np.nan),
        np.full(ROOM_SMALL_LINEAR_SYSTEMS, np.nan),
        len(b),
    )
    big[:n, :n], right[:n] = A, b
    return big, right


@pytest.mark.parametrize("seed", range(20))
def test_a_system_of_any_rank_is_solved(seed: int) -> None:
    """Beyond the rank unknowns are zero; what may be added is orthogonal to every row."""
    rng = np.random.default_rng(seed)
    n, lost = 2 + seed % 5, seed % 3 if seed % 5 else 0
    rank = max(1, n - lost)
    A = rng.normal(size=(n, rank)) @ rng.normal(size=(rank, n)) if lost else rng.normal(size=(n, n))
    rank = min(rank, n)
    units = 10.0 ** rng.uniform(-3.0, 3.0, n)
    A = A * np.outer(units, units)
    truth = rng.normal(size=n) / units
    b = A @ truth
    big, right = padded(A, b)
    x, order = np.full(ROOM_SMALL_LINEAR_SYSTEMS, np.nan), np.full(ROOM_SMALL_LINEAR_SYSTEMS, -1)
    assert SOLVE_SMALL_LINEAR_SYSTEMS(big, right, n, 1.0 / units, order, x, 1e-9) == rank
    assert A @ x[:n] / units == pytest.approx(b / units, abs=1e-10)
    assert sorted(order[:n]) == list(range(n)) and np.isnan(x[n:]).all()
    assert np.all(x[order[rank:n]] == 0.0)
    if rank == n:
        assert x[:n] * units == pytest.approx(truth * units, rel=1e-7)
    rows = np.full((ROOM_SMALL_LINEAR_SYSTEMS, ROOM_SMALL_LINEAR_SYSTEMS), np.nan)
    NULL(big, n, rank, 1.0 / units, order, rows)
    for v in range(n - rank):
        assert np.abs(A @ rows[v, :n] / units).max() < 1e-9
        assert rows[v, order[rank + v]] * units[order[rank + v]] == pytest.approx(1.0)
    assert np.isnan(rows[n - rank :]).all()


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("share", "rank"), [(0.9, 1), (1.1, 2)])
def test_pivots_that_small_of_the_first_one_are_zero(share: float, rank: int, sign: float) -> None:
    big, right = padded(np.diag([40.0, sign * 40.0 * share * 1e-6]), np.ones(2))
    assert (
        SOLVE_SMALL_LINEAR_SYSTEMS(
            big, right, 2, np.ones(2), np.zeros(ROOM_SMALL_LINEAR_SYSTEMS, int), np.zeros(ROOM_SMALL_LINEAR_SYSTEMS), 1e-6
        )
        == rank
    )
