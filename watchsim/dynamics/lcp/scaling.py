"""In which units are the coefficients of a complementarity problem of order one?

Multiplying row i of A and b by R_i > 0 and measuring x_j in units of C_j > 0 changes no solution; with powers of two it changes
not a bit of rounding either. So inertias of 1e-12 and forces of 1e6 look alike to the solver.
"""

from __future__ import annotations

import math

from watchsim.jit import kernel
from watchsim.tolerances import COEFFICIENT_ROUNDING

SWEEPS = 3


@kernel
def scale(A, b, n, work):
    """Fill the scaled problem R A C, R b / beta, and its most negative load; returns beta.

    x = C x_scaled beta, y = y_scaled beta / R.
    """
    _scale_pairs(A, n, work)
    _balance(A, n, work)
    largest = 0.0
    for i in range(n):
        for j in range(n):
            work.matrix[i, j] = work.row_scale[i] * A[i, j] * work.column_scale[j]
        work.load[i] = work.row_scale[i] * b[i]
        largest = max(largest, abs(work.load[i]))
    magnitude, driver = _power_of_two(largest), 0.0
    for i in range(n):
        work.load[i] /= magnitude
        driver = max(driver, -work.load[i])
    work.worst.driver = driver
    return magnitude


@kernel
def _scale_pairs(A, n, work):
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
def _largest_mutual(A, i, n, s):
    """Largest sqrt|A_ij A_ji| s_j; the mutual coefficient does not change with the units of x and y."""
    largest = 0.0
    for j in range(n):
        if j != i and A[i, j] != 0.0 and A[j, i] != 0.0:
            largest = max(largest, math.sqrt(abs(A[i, j])) * math.sqrt(abs(A[j, i])) * s[j])
    return largest


@kernel
def _balance(A, n, work):
    """Make the largest coefficients of row i and of column i alike, keeping R_i C_i (Osborne 1960).

    All at once in each sweep, with half the exponent: the result does not depend on the order of the unknowns. A sweep that
    changes nothing is the last one.
    """
    r, c, s = work.row_scale, work.column_scale, work.trial
    for i in range(n):
        s[i] = c[i]
    for _ in range(SWEEPS):
        balanced = True
        for i in range(n):
            work.load[i] = _unbalance(A, n, i, work)
            balanced = balanced and work.load[i] == 1.0
        if balanced:
            return
        for i in range(n):
            r[i] *= work.load[i]
            c[i] /= work.load[i]


@kernel
def _unbalance(A, n, i, work):
    """The power of two nearest (largest of column i / largest of row i)^(1/4)."""
    r, c, s = work.row_scale, work.column_scale, work.trial
    row = column = 0.0
    for j in range(n):
        # What rounding leaves of a zero says nothing about units; the mutual coefficient does not depend on them.
        mutual = abs(A[i, j]) * abs(A[j, i]) * (s[i] * s[j]) ** 2
        if j == i or 0.0 < mutual < COEFFICIENT_ROUNDING * COEFFICIENT_ROUNDING:
            continue
        row = max(row, abs(A[i, j]) * c[j])
        column = max(column, abs(A[j, i]) * r[j])
    row, column = row * r[i], column * c[i]
    return _power_of_two(math.sqrt(math.sqrt(column / row))) if row > 0.0 and column > 0.0 else 1.0


@kernel
def unscale(n, magnitude, work, out_x):
    """x in its own units."""
    for i in range(n):
        out_x[i] = work.column_scale[i] * work.trial[i] * magnitude


@kernel
def _power_of_two(value):
    """The power of two nearest |value|; 1 for zero and for what is not a number."""
    if value == 0.0 or not math.isfinite(value):
        return 1.0
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if abs(mantissa) > 0.75 else exponent - 1)
