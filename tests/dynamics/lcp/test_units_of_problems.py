"""Which units do rows and unknowns of a complementarity problem get? Worked out by hand in powers of two."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics.lcp import scaling


def units(A: list[list[float]]) -> list[float]:
    """Before rows are balanced against columns: the same for both."""
    n = len(A)
    work = SimpleNamespace(row_scale=np.full(n, np.nan), column_scale=np.full(n, np.nan))
    in_python(scaling._scale_pairs)(np.array(A), n, work)
    assert np.array_equal(work.row_scale, work.column_scale)
    return [float(unit) for unit in work.row_scale]


def test_a_diagonal_becomes_one() -> None:
    assert units([[16.0, 0.0], [0.0, 2.0**-6]]) == [0.25, 8.0]


def test_a_row_without_a_diagonal_has_the_unit_of_its_largest_mutual_coefficient() -> None:
    """sqrt|A_ij A_ji| in the units of the other unknown; what is coupled one way only does not count."""
    A = [[16.0, 0.0, 2.0**9, 0.0], [0.0, 2.0**-6, 2.0**4, 0.0], [-(2.0**1), 2.0**2, 0.0, 99.0], [0.0, 0.0, 0.0, 4.0]]
    # 32 / 4 = 8 with the first, 8 · 8 = 64 with the second.
    assert units(A)[2] == 2.0**-6


@pytest.mark.parametrize(("own", "unit"), [(-64.0, 0.125), (0.0, 1.0)])
def test_a_row_that_nothing_is_coupled_with_has_the_unit_of_its_own_size(own: float, unit: float) -> None:
    assert units([[16.0, 5.0], [0.0, own]]) == [0.25, unit]


def test_a_negative_diagonal_counts_only_where_nothing_is_coupled() -> None:
    assert units([[16.0, 2.0], [2.0, -64.0]]) == [0.25, 2.0]


def test_a_diagonal_left_by_cancellation_does_not_blow_up_its_row() -> None:
    """Its unit goes down by the root of what mutual coefficients would become: here 2^10 · 2^-2 · 2^2 = 2^10."""
    assert units([[2.0**-20, 4.0], [4.0, 16.0]]) == [2.0**5, 2.0**-7]
    assert units([[2.0**-2, 0.25], [0.25, 16.0]]) == [2.0, 0.25]


def unbalance(A: np.ndarray, i: int, r: list[float], c: list[float]) -> float:
    n = len(A)
    work = SimpleNamespace(row_scale=np.array(r), column_scale=np.array(c), trial=np.ones(n))
    return float(in_python(scaling._unbalance)(A, n, i, work))


def test_rows_and_columns_are_balanced_by_the_fourth_root_of_what_they_differ_by() -> None:
    """Largest of column 0: 2^9 · 2 · 4, of row 0: 2^-4 · 8 · 2; the diagonal does not count."""
    A = np.array([[1e9, 2.0**-4, 2.0**-9], [2.0**9, 1.0, 0.0], [2.0**-9, 0.0, 1.0]])
    assert unbalance(A, 0, [2.0, 2.0, 1.0], [4.0, 8.0, 1.0]) == 2.0 ** ((12 - 0) // 4)
    assert unbalance(A.T, 0, [4.0, 8.0, 1.0], [2.0, 2.0, 1.0]) == 2.0**-3


@pytest.mark.parametrize(("share", "counts"), [(0.9, False), (1.1, True)])
def test_mutual_coefficients_are_judged_in_units_of_unit_diagonals(share: float, counts: bool) -> None:
    """The root of their product, here 16 times as large as in units of 2^3 and 2^-7."""
    A = np.array([[1.0, share * 1e-14 * 16.0 * 64.0], [share * 1e-14 * 16.0 / 64.0, 1.0]])
    work = SimpleNamespace(row_scale=np.ones(2), column_scale=np.ones(2), trial=np.array([2.0**3, 2.0**-7]))
    assert (float(in_python(scaling._unbalance)(A, 2, 0, work)) != 1.0) == counts


@pytest.mark.parametrize("A", [np.diag([1.0, 2.0]), np.array([[1.0, 0.0], [3.0, 1.0]]), np.array([[1.0, 3.0], [0.0, 1.0]])])
def test_what_is_coupled_one_way_or_not_at_all_is_balanced(A: np.ndarray) -> None:
    assert unbalance(A, 0, [1.0, 1.0], [1.0, 1.0]) == unbalance(A, 1, [1.0, 1.0], [1.0, 1.0]) == 1.0


def swept(steps: list[list[float]]) -> tuple[list[float], list[float], int]:
    """Units of rows and columns, and how many sweeps, where unknown i is out of balance by steps[sweep][i]."""
    asked: list[int] = []
    n = len(steps[0])

    def unbalance(A: object, n: int, i: int, work: SimpleNamespace) -> float:
        assert work.trial.tolist() == [5.0, 6.0]
        asked.append(i)
        return steps[(len(asked) - 1) // n][i]

    work = SimpleNamespace(
        row_scale=np.array([3.0, 4.0]), column_scale=np.array([5.0, 6.0]), trial=np.zeros(n), load=np.zeros(n)
    )
    in_python(scaling._balance, _unbalance=unbalance)(None, n, work)
    return work.row_scale.tolist(), work.column_scale.tolist(), len(asked) // n


def test_balance_is_swept_three_times_or_until_nothing_changes() -> None:
    """What multiplies a row divides the column."""
    assert swept([[2.0, 1.0], [1.0, 1.0], [4.0, 4.0]]) == ([6.0, 4.0], [2.5, 6.0], 2)
    assert swept([[1.0, 2.0], [1.0, 4.0], [2.0, 1.0], [8.0, 8.0]]) == ([6.0, 32.0], [2.5, 0.75], 3)
    assert swept([[1.0, 1.0]]) == ([3.0, 4.0], [5.0, 6.0], 1)


@pytest.mark.parametrize("seed", range(4))
def test_a_scaled_problem_is_the_same_in_its_units(seed: int) -> None:
    """The largest load is of order one; what drives the problem is the most negative one."""
    rng = np.random.default_rng(seed)
    n = 4
    A, b = rng.normal(size=(n, n)), 300.0 * rng.normal(size=n) + (0.0 if seed else 1e4)
    rows = {name: np.full(n, np.nan) for name in ("row_scale", "column_scale", "load", "trial")}
    work = SimpleNamespace(matrix=np.full((n, n), np.nan), worst=SimpleNamespace(driver=9.0), **rows)
    magnitude = in_python(scaling.scale)(A, b, n, work)
    assert np.array_equal(work.matrix, work.row_scale[:, None] * A * work.column_scale)
    assert np.array_equal(work.load, work.row_scale * b / magnitude)
    assert 0.75 <= np.abs(work.load).max() <= 1.5
    assert work.worst.driver == max(0.0, -work.load.min())
    work.trial[:] = rng.normal(size=n)
    x = np.full(n, np.nan)
    in_python(scaling.unscale)(n, magnitude, work, x)
    assert (A @ x + b) * work.row_scale / magnitude == pytest.approx(work.matrix @ work.trial + work.load)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("power", [-70, -3, 0, 1, 12])
@pytest.mark.parametrize(("mantissa", "up"), [(1.0, 0), (1.01, 0), (1.499, 0), (1.501, 1), (1.99, 1)])
def test_units_are_the_nearest_powers_of_two(mantissa: float, up: int, power: int, sign: float) -> None:
    assert in_python(scaling._power_of_two)(sign * mantissa * 2.0**power) == 2.0 ** (power + up)


@pytest.mark.parametrize("value", [0.0, math.nan, math.inf, -math.inf])
def test_what_has_no_size_has_the_unit_one(value: float) -> None:
    assert in_python(scaling._power_of_two)(value) == 1.0
