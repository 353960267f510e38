"""Which x solves y = A x + b, y >= 0, x >= 0, y.x = 0?

Lemke's method with the lexicographic ratio test, which cannot cycle (Cottle, Pang, Stone: The Linear Complementarity
Problem, ch. 4). Rows and columns are first scaled by powers of two, which changes neither the solutions nor a single
bit of rounding, so that masses of 1e-12 and forces of 1e6 look alike. The basis Lemke ends with is solved afresh from
the data. It knows no mechanics.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import by_reference, entry, kernel

OK, RAY, MAX_ITER, INEXACT = 0, 1, 2, 3

ENUMERATED_SIZE = 12  # 2^12 small eliminations: some milliseconds
# All of these compare numbers of a scaled problem, where coefficients and the largest load are of order one.
PIVOT = 1e-11  # smaller pivots are rounding errors of a zero
TIE = 1e-10  # ratios closer than this are equal; 1e-12 sends 1 in 1000 singular problems down a ray
RESIDUAL = 1e-9  # a y this much smaller than the terms it is the sum of is zero
ROUNDING = 1e-13  # so is one this much smaller than the largest x, or than one
SWEEPS = 3

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class LcpWork(NamedTuple):
    """Scratch for problems up to a size; see `lcp_work`."""

    matrix: Array  # scaled A
    load: Array  # scaled b
    row_scale: Array
    column_scale: Array
    tableau: Array  # columns: y, x, z0, right-hand side
    basis: Integers  # variable of each row: y_i is i, x_i is n + i, z0 is 2 n
    is_active: Integers  # 1 where x_i may be positive
    square: Array  # elimination of the active block, right-hand side last
    order: Integers  # the unknown of each of its columns
    trial: Array  # scaled x


LcpWorkRef = by_reference(LcpWork, __name__)


def lcp_work(size: int) -> LcpWork:
    """Scratch for problems of up to `size` unknowns."""
    return LcpWork(
        matrix=np.zeros((size, size)),
        load=np.zeros(size),
        row_scale=np.ones(size),
        column_scale=np.ones(size),
        tableau=np.zeros((size, 2 * size + 2)),
        basis=np.zeros(size, np.int64),
        is_active=np.zeros(size, np.int64),
        square=np.zeros((size, size + 1)),
        order=np.zeros(size, np.int64),
        trial=np.zeros(size),
    )


@entry
def solve_lcp(A: Array, b: Array, n: int, work: LcpWork, out_x: Array) -> int:
    """Solve the leading n×n problem into out_x[:n]: Lemke, checked, then enumeration up to ENUMERATED_SIZE unknowns.

    OK: out_x solves the problem to rounding. RAY, MAX_ITER, INEXACT: why Lemke failed, and enumeration found nothing.
    """
    status = lemke(A, b, n, work, out_x)
    if status == OK:
        if _is_trivial(b, n) or _is_solution(n, work):
            return OK
        status = INEXACT
    if n <= ENUMERATED_SIZE and enumerate_lcp(A, b, n, work, out_x) == OK:
        return OK
    return status


@entry
def lemke(A: Array, b: Array, n: int, work: LcpWork, out_x: Array) -> int:
    """Lemke's method on the leading n×n problem; out_x[:n] is set when the status is OK (unchecked), else zero."""
    for i in range(n):
        out_x[i] = 0.0
    if _is_trivial(b, n):
        return OK
    magnitude = _scale(A, b, n, work)
    status = _pivot_to_end(n, work)
    if status == OK:
        _solve_basis(n, work)
        _unscale(n, magnitude, work, out_x)
    return status


@entry
def enumerate_lcp(A: Array, b: Array, n: int, work: LcpWork, out_x: Array) -> int:
    """Try every set of active indices, the empty one first; OK with out_x[:n], or RAY when none solves the problem."""
    magnitude = _scale(A, b, n, work)
    for chosen in range(1 << n):
        for i in range(n):
            work.is_active[i] = (chosen >> i) & 1
        _solve_active(n, work)
        if _is_solution(n, work):
            _unscale(n, magnitude, work, out_x)
            return OK
    for i in range(n):
        out_x[i] = 0.0
    return RAY


@kernel
def _is_trivial(b: Array, n: int) -> bool:
    """True when x = 0 solves the problem."""
    for i in range(n):
        if not b[i] >= 0.0:
            return False
    return True


@kernel
def _power_of_two(value: float) -> float:
    """The power of two nearest |value|; 1 for zero and for what is not a number."""
    if value == 0.0 or not math.isfinite(value):
        return 1.0
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if abs(mantissa) > 0.75 else exponent - 1)


@kernel
def _scale(A: Array, b: Array, n: int, work: LcpWork) -> float:
    """Fill the scaled problem R A C, R b / beta; returns beta. x = C x_scaled beta, y = y_scaled beta / R."""
    _scale_pairs(A, n, work)
    _balance(A, n, work)
    largest = 0.0
    for i in range(n):
        for j in range(n):
            work.matrix[i, j] = work.row_scale[i] * A[i, j] * work.column_scale[j]
        work.load[i] = work.row_scale[i] * b[i]
        largest = max(largest, abs(work.load[i]))
    magnitude = _power_of_two(largest)
    for i in range(n):
        work.load[i] /= magnitude
    return magnitude


@kernel
def _scale_pairs(A: Array, n: int, work: LcpWork) -> None:
    """R = C with unit positive diagonals; a row without one is scaled by its mutual coefficients sqrt|A_ij A_ji|."""
    s = work.row_scale
    for i in range(n):
        s[i] = 1.0 / math.sqrt(A[i, i]) if A[i, i] > 0.0 else 0.0
        work.column_scale[i] = s[i]
    for i in range(n):
        if s[i] == 0.0:
            largest = _largest_mutual(A, i, n, s)
            if largest == 0.0:
                largest = math.sqrt(abs(A[i, i]))
            work.column_scale[i] = 1.0 / largest if largest > 0.0 else 1.0
    for i in range(n):  # a diagonal that is small only by cancellation must not blow up its row
        s[i] = work.column_scale[i] / math.sqrt(max(1.0, work.column_scale[i] * _largest_mutual(A, i, n, work.column_scale)))
    for i in range(n):
        s[i] = _power_of_two(s[i])
        work.column_scale[i] = s[i]


@kernel
def _largest_mutual(A: Array, i: int, n: int, s: Array) -> float:
    """Largest sqrt|A_ij A_ji| s_j; the mutual coefficient does not change with the units of x and y."""
    largest = 0.0
    for j in range(n):
        if j != i:
            largest = max(largest, math.sqrt(abs(A[i, j])) * math.sqrt(abs(A[j, i])) * s[j])
    return largest


@kernel
def _balance(A: Array, n: int, work: LcpWork) -> None:
    """Make the largest coefficients of row i and of column i alike, keeping R_i C_i (Osborne 1960)."""
    r, c = work.row_scale, work.column_scale
    for _ in range(SWEEPS):
        for i in range(n):
            row = column = 0.0
            for j in range(n):
                if j != i:
                    row = max(row, abs(A[i, j]) * c[j])
                    column = max(column, abs(A[j, i]) * r[j])
            row, column = row * r[i], column * c[i]
            if row > 0.0 and column > 0.0:
                factor = _power_of_two(math.sqrt(column / row))
                r[i] *= factor
                c[i] /= factor


@kernel
def _unscale(n: int, magnitude: float, work: LcpWork, out_x: Array) -> None:
    for i in range(n):
        out_x[i] = work.column_scale[i] * work.trial[i] * magnitude


@kernel
def _is_solution(n: int, work: LcpWork) -> bool:
    """True when the scaled trial solves the problem; each y_i is judged by the terms it is the sum of."""
    floor = 1.0
    for i in range(n):
        floor = max(floor, abs(work.trial[i]))
    for i in range(n):
        y, terms = work.load[i], abs(work.load[i])
        for j in range(n):
            term = work.matrix[i, j] * work.trial[j]
            y += term
            terms += abs(term)
        allowed = RESIDUAL * terms + ROUNDING * floor
        if not math.isfinite(terms) or work.trial[i] < 0.0 or y < -allowed or (work.trial[i] > 0.0 and y > allowed):
            return False
    return True


@kernel
def _pivot_to_end(n: int, work: LcpWork) -> int:
    """Lemke's path on y - A x - e z0 = b, from z0 large enough to the basis that z0 leaves."""
    z0 = 2 * n
    row = _start(n, work)
    entering = z0
    for _ in range(50 + 20 * n):
        leaving = work.basis[row]
        _pivot(n, row, entering, work)
        if leaving == z0:
            return OK
        entering = leaving + n if leaving < n else leaving - n
        row = _leaving_row(n, entering, work)
        if row < 0:
            return RAY
    return MAX_ITER


@kernel
def _start(n: int, work: LcpWork) -> int:
    """Set up the tableau; returns the row z0 enters in: the most negative load, the last of equals (lexicographic)."""
    row = 0
    for i in range(n):
        work.basis[i] = i
        for j in range(n):
            work.tableau[i, j] = 0.0
            work.tableau[i, n + j] = -work.matrix[i, j]
        work.tableau[i, i] = 1.0
        work.tableau[i, 2 * n] = -1.0
        work.tableau[i, 2 * n + 1] = work.load[i]
        if work.load[i] <= work.load[row]:
            row = i
    return row


@kernel
def _pivot(n: int, row: int, column: int, work: LcpWork) -> None:
    """Gauss-Jordan step: `column` becomes the unit vector of `row` and enters the basis."""
    T = work.tableau
    factor = 1.0 / T[row, column]
    for j in range(2 * n + 2):
        T[row, j] *= factor
    T[row, column] = 1.0
    for i in range(n):
        factor = T[i, column]
        if i != row and factor != 0.0:
            for j in range(2 * n + 2):
                T[i, j] -= factor * T[row, j]
            T[i, column] = 0.0
    work.basis[row] = column


@kernel
def _leaving_row(n: int, column: int, work: LcpWork) -> int:
    """Row of the lexicographically smallest ratio, z0's row among equals; -1 when the column bounds nothing (a ray)."""
    largest = 1.0
    for i in range(n):
        largest = max(largest, work.tableau[i, column])
    found = False
    best = column  # any integer: numba would compile the comparison twice for a literal
    for i in range(n):
        if work.tableau[i, column] > PIVOT * largest and (not found or _is_smaller(n, i, best, column, work)):
            found = True
            best = i
    return best if found else -1


@kernel
def _is_smaller(n: int, i: int, k: int, column: int, work: LcpWork) -> bool:
    """True when row i leaves before row k: compare right-hand sides over the pivots, then z0, then the inverse basis."""
    T = work.tableau
    left, right = T[i, 2 * n + 1] / T[i, column], T[k, 2 * n + 1] / T[k, column]
    if abs(left - right) > TIE * max(1.0, abs(left)):
        return left < right
    if work.basis[i] == 2 * n or work.basis[k] == 2 * n:
        return work.basis[i] == 2 * n
    for j in range(n):
        left, right = T[i, j] / T[i, column], T[k, j] / T[k, column]
        if abs(left - right) > TIE * max(1.0, abs(left)):
            return left < right
    return False


@kernel
def _solve_basis(n: int, work: LcpWork) -> None:
    """The x of the final basis: solved afresh from the scaled data, or, if that block is singular, read off the tableau."""
    for i in range(n):
        work.is_active[i] = 0
    for row in range(n):
        if n <= work.basis[row] < 2 * n:
            work.is_active[work.basis[row] - n] = 1
    if _solve_active(n, work) and _is_solution(n, work):
        return
    for row in range(n):
        if n <= work.basis[row] < 2 * n:
            work.trial[work.basis[row] - n] = max(0.0, work.tableau[row, 2 * n + 1])


@kernel
def _solve_active(n: int, work: LcpWork) -> bool:
    """Solve A_aa x_a = -b_a for the active indices into trial; False if singular (free unknowns are then left zero)."""
    S = work.square
    count = _gather(n, work)
    regular = True
    for step in range(count):
        if not _eliminate(count, step, work):
            regular = False
            for m in range(count + 1):
                S[step, m] = 0.0
            S[step, step] = 1.0
    for k in range(count - 1, -1, -1):
        value = S[k, count]
        for m in range(k + 1, count):
            value -= S[k, m] * work.trial[work.order[m]]
        value /= S[k, k]
        work.trial[work.order[k]] = 0.0 if -RESIDUAL < value <= 0.0 else value
    return regular


@kernel
def _gather(n: int, work: LcpWork) -> int:
    """Copy the active block and its right-hand side into `square`; returns its size."""
    count = 0
    for i in range(n):
        work.trial[i] = 0.0
        if work.is_active[i]:
            work.order[count] = i
            count += 1
    for k in range(count):
        for m in range(count):
            work.square[k, m] = work.matrix[work.order[k], work.order[m]]
        work.square[k, count] = -work.load[work.order[k]]
    return count


@kernel
def _eliminate(count: int, step: int, work: LcpWork) -> bool:
    """One step of Gaussian elimination with complete pivoting; False when only rounding errors are left."""
    S = work.square
    row, column = step, step
    for k in range(step, count):
        for m in range(step, count):
            if abs(S[k, m]) > abs(S[row, column]):
                row, column = k, m
    if not abs(S[row, column]) > PIVOT:
        return False
    for m in range(count + 1):
        S[step, m], S[row, m] = S[row, m], S[step, m]
    for k in range(count):
        S[k, step], S[k, column] = S[k, column], S[k, step]
    work.order[step], work.order[column] = work.order[column], work.order[step]
    for k in range(step + 1, count):
        factor = S[k, step] / S[step, step]
        for m in range(step, count + 1):
            S[k, m] -= factor * S[step, m]
    return True
