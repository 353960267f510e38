"""Which x solves y = A x + b, y >= 0, x >= 0, y.x = 0?

Lemke's method with the lexicographic ratio test, which cannot cycle (Cottle, Pang, Stone: The Linear Complementarity
Problem, ch. 4). Rows and columns are first scaled by powers of two, which changes neither the solutions nor a single
bit of rounding, so that masses of 1e-12 and forces of 1e6 look alike. The basis Lemke ends with is solved afresh from
the data. It knows no mechanics.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import by_reference, entry, kernel
from watchsim.model import blank
from watchsim.tolerances import (
    COEFFICIENT_ROUNDING,
    LCP_ENUMERATED,
    LCP_LESS,
    LCP_PERTURBED,
    LCP_PIVOT,
    LCP_RESIDUAL,
    LCP_ROUNDING,
    LOAD_ROUNDING,
    RATIO_TIE,
    SCALING_SWEEPS,
)

# What is a contact problem about, and what solved it?


class Level(IntEnum):
    """What is sought: forces, or the impulses of one phase of an impact."""

    NONE = 0
    ACCELERATION = 1
    COMPRESSION = 2
    EXPANSION = 3


class Solver(IntEnum):
    """The methods of `solve_contacts`, in their order; places in `FrictionProblem.solvers`."""

    LEMKE = 0
    COPOSITIVE = 1
    DETOUR = 2
    ENUMERATED = 3
    INEXACT = 4
    FAILED = 5  # nothing solved it


# How did a method for linear complementarity problems end?


class LcpOutcome(IntEnum):
    """Only SOLVED comes with a solution."""

    SOLVED = 0  # checked against the problem, to rounding
    RAY = 1  # Lemke's path runs to infinity, or no set of active unknowns solves the problem
    TOO_MANY_PIVOTS = 2
    INEXACT = 3  # what it ended with misses the conditions by more than rounding


# What is x if these unknowns are positive, and does it solve the problem?
#
# Works on the scaled problem of `LcpWork`, whose coefficients and largest load are of order one.


@kernel
def is_solution(n, room):
    """True when the scaled trial solves the problem to rounding; see `solves`."""
    return solves(n, 0.0, room)


@kernel
def solves(n, rough, room):
    """True when the scaled trial solves the problem; each y_i is judged by the terms it is the sum of and by rounding.

    `rough`: the share that may be missing of the load that drives the problem, or of the largest unknown.
    `room.worst` keeps the worst violation of an accepted solution, as a share of one or of its largest unknown.
    """
    largest, worst = 0.0, 0.0
    for i in range(n):
        largest = max(largest, abs(room.trial[i]))
    floor = max(1.0, largest)
    missing = LCP_ROUNDING * floor + rough * max(room.worst.driver, largest)
    for i in range(n):
        y, terms = room.load[i], abs(room.load[i])
        for j in range(n):
            term = room.matrix[i, j] * room.trial[j]
            y += term
            terms += abs(term)
        allowed = LCP_RESIDUAL * terms + missing
        if not math.isfinite(terms) or room.trial[i] < 0.0 or y < -allowed or (room.trial[i] > 0.0 and y > allowed):
            return False
        worst = max(worst, -y, abs(y) if room.trial[i] > 0.0 else 0.0)
    room.worst.violation = max(room.worst.violation, worst / floor)
    return True


@kernel
def solve_active(n, room):
    """Solve A_aa x_a = -b_a for the active indices into trial; False if singular (free unknowns are then left zero)."""
    S = room.square
    count = _gather(n, room)
    regular = True
    for step in range(count):
        if not _eliminate(count, step, room):
            regular = False
            for m in range(count + 1):
                S[step, m] = 0.0
            S[step, step] = 1.0
    for k in range(count - 1, -1, -1):
        value = S[k, count]
        for m in range(k + 1, count):
            value -= S[k, m] * room.trial[room.order[m]]
        value /= S[k, k]
        room.trial[room.order[k]] = 0.0 if -LCP_RESIDUAL < value <= 0.0 else value
    return regular


@kernel
def _gather(n, room):
    """Copy the active block and its right-hand side into `square`; returns its size."""
    count = 0
    for i in range(n):
        room.trial[i] = 0.0
        if room.is_active[i]:
            room.order[count] = i
            count += 1
    for k in range(count):
        for m in range(count):
            room.square[k, m] = room.matrix[room.order[k], room.order[m]]
        room.square[k, count] = -room.load[room.order[k]]
    return count


@kernel
def _eliminate(count, step, room):
    """One step of Gaussian elimination with complete pivoting; False when only rounding errors are left."""
    S = room.square
    row, column = step, step
    for k in range(step, count):
        for m in range(step, count):
            if abs(S[k, m]) > abs(S[row, column]):
                row, column = k, m
    if not abs(S[row, column]) > LCP_PIVOT:
        return False
    for m in range(count + 1):
        S[step, m], S[row, m] = S[row, m], S[step, m]
    for k in range(count):
        S[k, step], S[k, column] = S[k, column], S[k, step]
    room.order[step], room.order[column] = room.order[column], room.order[step]
    for k in range(step + 1, count):
        factor = S[k, step] / S[step, step]
        for m in range(step, count + 1):
            S[k, m] -= factor * S[step, m]
    return True


# In which units are the coefficients of a complementarity problem of order one?
#
# Multiplying row i of A and b by R_i > 0 and measuring x_j in units of C_j > 0 changes no solution; with powers of two it
# changes
# not a bit of rounding either. So inertias of 1e-12 and forces of 1e6 look alike to the solver.


@kernel
def scale(A, b, n, room):
    """Fill the scaled problem R A C, R b / beta, and its most negative load; returns beta.

    x = C x_scaled beta, y = y_scaled beta / R.
    """
    _scale_pairs(A, n, room)
    _balance(A, n, room)
    largest = 0.0
    for i in range(n):
        for j in range(n):
            room.matrix[i, j] = room.row_scale[i] * A[i, j] * room.column_scale[j]
        room.load[i] = room.row_scale[i] * b[i]
        largest = max(largest, abs(room.load[i]))
    magnitude, driver = _power_of_two(largest), 0.0
    for i in range(n):
        room.load[i] /= magnitude
        driver = max(driver, -room.load[i])
    room.worst.driver = driver
    return magnitude


@kernel
def _scale_pairs(A, n, room):
    """R = C with unit positive diagonals; a row without one is scaled by its mutual coefficients sqrt|A_ij A_ji|."""
    s = room.row_scale
    for i in range(n):
        s[i] = 1.0 / math.sqrt(A[i, i]) if A[i, i] > 0.0 else 0.0
        room.column_scale[i] = s[i]
    for i in range(n):
        if s[i] == 0.0:
            largest = _largest_mutual(A, i, n, s)
            if largest == 0.0:
                largest = math.sqrt(abs(A[i, i]))
            room.column_scale[i] = 1.0 / largest if largest > 0.0 else 1.0
    for i in range(n):  # a diagonal that is small only by cancellation must not blow up its row
        s[i] = room.column_scale[i] / math.sqrt(max(1.0, room.column_scale[i] * _largest_mutual(A, i, n, room.column_scale)))
    for i in range(n):
        s[i] = _power_of_two(s[i])
        room.column_scale[i] = s[i]


@kernel
def _largest_mutual(A, i, n, s):
    """Largest sqrt|A_ij A_ji| s_j; the mutual coefficient does not change with the units of x and y."""
    largest = 0.0
    for j in range(n):
        if j != i and A[i, j] != 0.0 and A[j, i] != 0.0:
            largest = max(largest, math.sqrt(abs(A[i, j])) * math.sqrt(abs(A[j, i])) * s[j])
    return largest


@kernel
def _balance(A, n, room):
    """Make the largest coefficients of row i and of column i alike, keeping R_i C_i (Osborne 1960).

    All at once in each sweep, with half the exponent: the result does not depend on the order of the unknowns. A sweep that
    changes nothing is the last one.
    """
    r, c, s = room.row_scale, room.column_scale, room.trial
    for i in range(n):
        s[i] = c[i]
    for _ in range(SCALING_SWEEPS):
        balanced = True
        for i in range(n):
            room.load[i] = _unbalance(A, n, i, room)
            balanced = balanced and room.load[i] == 1.0
        if balanced:
            return
        for i in range(n):
            r[i] *= room.load[i]
            c[i] /= room.load[i]


@kernel
def _unbalance(A, n, i, room):
    """The power of two nearest (largest of column i / largest of row i)^(1/4)."""
    r, c, s = room.row_scale, room.column_scale, room.trial
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
def unscale(n, magnitude, room, out_x):
    """x in its own units."""
    for i in range(n):
        out_x[i] = room.column_scale[i] * room.trial[i] * magnitude


@kernel
def _power_of_two(value):
    """The power of two nearest |value|; 1 for zero and for what is not a number."""
    if value == 0.0 or not math.isfinite(value):
        return 1.0
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if abs(mantissa) > 0.75 else exponent - 1)


# Which x solves y = A x + b, y >= 0, x >= 0, y.x = 0?

UNEVEN, PERIOD = 5, 7  # for unlike entries of d on other paths
PLAIN = 4  # paths that differ from the usual one by their loads alone
UNLIKE = 0.6180339887498949  # multiples of it, less the whole part, are as unlike as can be

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class Extremes:
    """What bounds the errors of a problem and of its solution, in its scaling.

    violation  the worst of any condition in an accepted solution, see `is_solution`
    driver     the most negative load without sign: what has to be pushed away, perhaps far below the other loads
    """

    violation: float
    driver: float


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
    worst: Extremes


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
        worst=blank(Extremes),
    )


@entry
def solve_lcp(A: Array, b: Array, n: int, room: LcpWork, out_x: Array) -> LcpOutcome:
    """Solve the leading n×n problem into out_x[:n]: Lemke, checked, then enumeration up to LCP_ENUMERATED unknowns.

    SOLVED: out_x solves the problem to rounding. Else why Lemke failed; enumeration found nothing.
    """
    outcome = lemke_checked(A, b, n, room, out_x)
    if outcome != LcpOutcome.SOLVED and n <= LCP_ENUMERATED and enumerate_lcp(A, b, n, room, out_x) == LcpOutcome.SOLVED:
        return LcpOutcome.SOLVED
    return outcome


@kernel
def lemke_checked(A: Array, b: Array, n: int, room: LcpWork, out_x: Array) -> LcpOutcome:
    """Lemke's method; SOLVED only if what it ended with solves the problem to rounding."""
    return lemke_on_path(A, b, n, 0, room, out_x)


@kernel
def lemke_on_path(A: Array, b: Array, n: int, path: int, room: LcpWork, out_x: Array) -> LcpOutcome:
    """The same on another path: the numbers of the paths have no meaning, but 0 is the usual one.

    The others begin with loads that are a little larger, each by another share, so that no two rows of zeros tie, and half of
    them with other multiples of z0; the basis that they end with is judged with the true loads.
    """
    outcome: LcpOutcome = _follow(A, b, n, path, room, out_x)
    if outcome == LcpOutcome.SOLVED and not (_is_trivial(b, n) or is_solution(n, room)):
        return LcpOutcome.INEXACT
    return outcome


@entry
def lemke(A: Array, b: Array, n: int, room: LcpWork, out_x: Array) -> LcpOutcome:
    """Lemke's method on the leading n×n problem; out_x[:n] is set when the outcome is SOLVED (unchecked), else zero."""
    return _follow(A, b, n, 0, room, out_x)


@kernel
def _follow(A: Array, b: Array, n: int, path: int, room: LcpWork, out_x: Array) -> LcpOutcome:
    for i in range(n):
        out_x[i], room.is_active[i] = 0.0, 0
    if _is_trivial(b, n):
        return LcpOutcome.SOLVED
    magnitude = scale(A, b, n, room)
    outcome = _pivot_to_end(n, path, room)
    if outcome == LcpOutcome.SOLVED:
        _solve_basis(n, path, room)
        unscale(n, magnitude, room, out_x)
    return outcome


@entry
def enumerate_lcp(A: Array, b: Array, n: int, room: LcpWork, out_x: Array) -> LcpOutcome:
    """Try every set of active indices, the empty one first; SOLVED with out_x[:n], or RAY when none solves the problem."""
    magnitude = scale(A, b, n, room)
    for chosen in range(1 << n):
        for i in range(n):
            room.is_active[i] = (chosen >> i) & 1
        solve_active(n, room)
        if is_solution(n, room):
            unscale(n, magnitude, room, out_x)
            return LcpOutcome.SOLVED
    for i in range(n):
        out_x[i] = 0.0
    return LcpOutcome.RAY


@kernel
def _is_trivial(b: Array, n: int) -> bool:
    """True when x = 0 solves the problem."""
    for i in range(n):
        if not b[i] >= 0.0:
            return False
    return True


@kernel
def _pivot_to_end(n: int, path: int, room: LcpWork) -> LcpOutcome:
    """Lemke's path on y - A x - d z0 = b, from z0 large enough to the basis that z0 leaves."""
    z0 = 2 * n
    row = _start(n, path, room)
    entering = z0
    for _ in range(50 + 20 * n):
        leaving = room.basis[row]
        _pivot(n, row, entering, room)
        if leaving == z0:
            return LcpOutcome.SOLVED
        entering = leaving + n if leaving < n else leaving - n
        bounded, row = _leaving_row(n, entering, room)
        if not bounded:
            return LcpOutcome.RAY
    return LcpOutcome.TOO_MANY_PIVOTS


@kernel
def _start(n: int, path: int, room: LcpWork) -> int:
    """Set up the tableau; returns the row z0 enters in: the most negative load over d, the last of equals (lexicographic).

    Any d > 0 will do (Cottle, Pang, Stone, 4.4); paths up to PLAIN take ones.
    """
    row, lowest = 0, math.inf
    uneven = path if path > PLAIN else 0
    more = 0.0
    if path > 0:
        more = room.worst.driver * LCP_PERTURBED * LCP_LESS ** ((path - 1) % PLAIN)
    for i in range(n):
        room.basis[i] = i
        for j in range(n):
            room.tableau[i, j] = 0.0
            room.tableau[i, n + j] = -room.matrix[i, j]
        room.tableau[i, i] = 1.0
        cover = 1.0 + uneven * ((UNEVEN * i + uneven) % PERIOD) / PERIOD
        room.tableau[i, 2 * n] = -cover
        load = room.load[i]
        if more > 0.0:
            load += more * (UNLIKE * (i + 1) * (path + 1) % 1.0)
        room.tableau[i, 2 * n + 1] = load
        if load / cover <= lowest:
            row, lowest = i, load / cover
    return row


@kernel
def _pivot(n: int, row: int, column: int, room: LcpWork) -> None:
    """Gauss-Jordan step: `column` becomes the unit vector of `row` and enters the basis."""
    T = room.tableau
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
    room.basis[row] = column


@kernel
def _leaving_row(n: int, column: int, room: LcpWork) -> tuple[bool, int]:
    """(found, row of the lexicographically smallest ratio, z0's row among equals); not found: the column is a ray."""
    largest = 1.0
    for i in range(n):
        largest = max(largest, room.tableau[i, column])
    found = False
    best = column  # any integer: numba would compile the comparison twice for a literal
    for i in range(n):
        if room.tableau[i, column] > LCP_PIVOT * largest and (not found or _is_smaller(n, i, best, column, room)):
            found = True
            best = i
    return found, best


@kernel
def _is_smaller(n: int, i: int, k: int, column: int, room: LcpWork) -> bool:
    """True when row i leaves before row k: compare right-hand sides over the pivots, then z0, then the inverse basis."""
    T = room.tableau
    left, right = T[i, 2 * n + 1] / T[i, column], T[k, 2 * n + 1] / T[k, column]
    # Ratios go with the load that drives the problem, which may be a billionth of the largest.
    if abs(left - right) > RATIO_TIE * max(room.worst.driver, abs(left)) + LOAD_ROUNDING:
        return left < right
    if room.basis[i] == 2 * n or room.basis[k] == 2 * n:
        return room.basis[i] == 2 * n
    for j in range(n):
        left, right = T[i, j] / T[i, column], T[k, j] / T[k, column]
        if abs(left - right) > RATIO_TIE * max(1.0, abs(left)):
            return left < right
    return False


@kernel
def _solve_basis(n: int, path: int, room: LcpWork) -> None:
    """The x of the final basis: solved afresh from the scaled data, or, if that block is singular, read off the tableau.

    The tableaus of other paths than 0 have other loads.
    """
    for i in range(n):
        room.is_active[i] = 0
    for row in range(n):
        if n <= room.basis[row] < 2 * n:
            room.is_active[room.basis[row] - n] = 1
    if solve_active(n, room) and (path > 0 or is_solution(n, room)):
        return
    for row in range(n):
        if n <= room.basis[row] < 2 * n:
            room.trial[room.basis[row] - n] = max(0.0, room.tableau[row, 2 * n + 1])
