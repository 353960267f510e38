"""Are small systems solved as numpy solves them, singular ones by one of their solutions, with all others beside it?"""

from __future__ import annotations

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics import small_systems

ROOM = 6
SOLVE, NULL, INDEPENDENT = (
    in_python(getattr(small_systems, name)) for name in ("solve_small", "null_vectors", "keep_independent")
)


def padded(A: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """In the corner of larger arrays."""
    big, right, n = np.full((ROOM, ROOM), np.nan), np.full(ROOM, np.nan), len(b)
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
    x, order = np.full(ROOM, np.nan), np.full(ROOM, -1)
    assert SOLVE(big, right, n, 1.0 / units, order, x, 1e-9) == rank
    assert A @ x[:n] / units == pytest.approx(b / units, abs=1e-10)
    assert sorted(order[:n]) == list(range(n)) and np.isnan(x[n:]).all()
    assert np.all(x[order[rank:n]] == 0.0)
    if rank == n:
        assert x[:n] * units == pytest.approx(truth * units, rel=1e-7)
    rows = np.full((ROOM, ROOM), np.nan)
    NULL(big, n, rank, 1.0 / units, order, rows)
    for v in range(n - rank):
        assert np.abs(A @ rows[v, :n] / units).max() < 1e-9
        assert rows[v, order[rank + v]] * units[order[rank + v]] == pytest.approx(1.0)
    assert np.isnan(rows[n - rank :]).all()


def test_pivots_are_the_largest_that_are_left() -> None:
    """Else a tiny one in the way costs all digits."""
    A = np.array([[1e-17, 1.0, 0.5], [1.0, 1e-17, 3.0], [0.25, -2.0, 1e-17]])
    big, right = padded(A, A @ [0.3, -0.7, 0.2])
    x, order = np.zeros(ROOM), np.zeros(ROOM, int)
    assert SOLVE(big, right, 3, np.ones(3), order, x, 1e-11) == 3
    assert x[:3] == pytest.approx([0.3, -0.7, 0.2], rel=1e-14, abs=0.0)
    assert order[0] == 2 and abs(big[0, 0]) == 3.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("share", "rank"), [(0.9, 1), (1.1, 2)])
def test_pivots_that_small_of_the_first_one_are_zero(share: float, rank: int, sign: float) -> None:
    big, right = padded(np.diag([40.0, sign * 40.0 * share * 1e-6]), np.ones(2))
    assert SOLVE(big, right, 2, np.ones(2), np.zeros(ROOM, int), np.zeros(ROOM), 1e-6) == rank


def test_where_nothing_acts_there_is_no_rank() -> None:
    big, right = padded(np.zeros((2, 2)), np.zeros(2))
    x = np.full(ROOM, 5.0)
    assert SOLVE(big, right, 2, np.ones(2), np.zeros(ROOM, int), x, 1e-11) == 0
    assert x[:2].tolist() == [0.0, 0.0]


@pytest.mark.parametrize(("own", "scale"), [(16.0, 0.25), (0.0, 1.0), (1e-30, 1e15), (-4.0, 1.0)])
def test_a_scale_makes_a_diagonal_one(own: float, scale: float) -> None:
    assert in_python(small_systems.unit_scale)(own) == pytest.approx(scale)


@pytest.mark.parametrize("seed", range(12))
def test_those_are_kept_that_raise_the_rank(seed: int) -> None:
    """Vectors of length one, some of which depend on earlier ones."""
    rng = np.random.default_rng(seed)
    vectors = rng.normal(size=(6, 4))
    vectors[2] = vectors[0] - 0.4 * vectors[1]
    vectors[3] *= -1.0
    vectors[5] = 0.3 * vectors[3] + vectors[0]
    vectors = vectors[rng.permutation(6)]
    vectors /= np.linalg.norm(vectors, axis=1)[:, None]
    expected: list[int] = []
    for k in range(6):
        if np.linalg.matrix_rank(vectors[[*expected, k]], tol=1e-6) > len(expected):
            expected.append(k)
    listed = np.arange(10, 17)
    count = INDEPENDENT(vectors @ vectors.T, 6, 1e-9, listed)
    assert listed[:count].tolist() == [10 + k for k in expected]


@pytest.mark.parametrize(("share", "count"), [(0.9, 1), (1.1, 2)])
def test_what_is_left_of_a_vector_counts_from_a_bound_on(share: float, count: int) -> None:
    """The square of its sine."""
    c = (1.0 - share * 1e-4) ** 0.5
    listed = np.array([3, 4])
    assert INDEPENDENT(np.array([[1.0, c], [c, 1.0]]), 2, 1e-4, listed) == count
