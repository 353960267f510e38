"""What is x if these unknowns are positive, and does it solve the problem?

Works on the scaled problem of `LcpWork`, whose coefficients and largest load are of order one.
"""

from __future__ import annotations

import math

from watchsim.jit import kernel
from watchsim.tolerances import LCP_PIVOT, LCP_RESIDUAL, LCP_ROUNDING


@kernel
def is_solution(n, work):
    """True when the scaled trial solves the problem to rounding; see `solves`."""
    return solves(n, 0.0, work)


@kernel
def solves(n, rough, work):
    """True when the scaled trial solves the problem; each y_i is judged by the terms it is the sum of and by rounding.

    `rough`: the share that may be missing of the load that drives the problem, or of the largest unknown.
    `work.worst` keeps the worst violation of an accepted solution, as a share of one or of its largest unknown.
    """
    largest, worst = 0.0, 0.0
    for i in range(n):
        largest = max(largest, abs(work.trial[i]))
    floor = max(1.0, largest)
    missing = LCP_ROUNDING * floor + rough * max(work.worst.driver, largest)
    for i in range(n):
        y, terms = work.load[i], abs(work.load[i])
        for j in range(n):
            term = work.matrix[i, j] * work.trial[j]
            y += term
            terms += abs(term)
        allowed = LCP_RESIDUAL * terms + missing
        if not math.isfinite(terms) or work.trial[i] < 0.0 or y < -allowed or (work.trial[i] > 0.0 and y > allowed):
            return False
        worst = max(worst, -y, abs(y) if work.trial[i] > 0.0 else 0.0)
    work.worst.violation = max(work.worst.violation, worst / floor)
    return True


@kernel
def solve_active(n, work):
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
        work.trial[work.order[k]] = 0.0 if -LCP_RESIDUAL < value <= 0.0 else value
    return regular


@kernel
def _gather(n, work):
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
def _eliminate(count, step, work):
    """One step of Gaussian elimination with complete pivoting; False when only rounding errors are left."""
    S = work.square
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
    work.order[step], work.order[column] = work.order[column], work.order[step]
    for k in range(step + 1, count):
        factor = S[k, step] / S[step, step]
        for m in range(step, count + 1):
            S[k, m] -= factor * S[step, m]
    return True
