"""How is a contact problem solved, and what if the first method fails?

Rung after rung: Lemke's method on the form of coulomb.py; on the copositive form, which always has a solution for
impacts (Stewart & Trinkle 1996; Anitescu & Potra 1997); Lemke's method on other paths; enumeration of the modes of
small sets. What solves the problem is checked against the first form. Where many contacts are redundant their loads are
rounding errors that may contradict each other: then an end of Lemke's method is taken that misses by no more than a billionth
of the load that drives the problem. If nothing helps, the caller stops and keeps the problem.
"""

from __future__ import annotations

from watchsim.dynamics.delassus import size_class
from watchsim.dynamics.lcp.basis import is_solution, solve_active, solves
from watchsim.dynamics.lcp.lemke_pivoting import lemke_checked, lemke_on_path
from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.dynamics.lcp.scaling import scale, unscale
from watchsim.dynamics.problem_kinds import Rung
from watchsim.jit import kernel
from watchsim.tolerances import LCP_ROUGH, LCP_ROUNDING

PATHS = 8  # other ones that Lemke tries
MODES = 50000  # sets of modes tried at most: some tenths of a second


@kernel
def solve_contacts(work, m, elements):
    """Solve the problem in `work.A`, `work.rhs` into `work.x`; returns the rung that did, FAILED if none."""
    n = m + 2 * elements
    outcome = lemke_checked(work.A, work.rhs, n, work.lcp, work.x)
    work.posed.lemke = outcome
    rung = Rung.LEMKE
    if outcome != LcpOutcome.SOLVED:
        rung = Rung.FAILED
        if elements > 0 and _solve_copositive(work, m, elements):
            rung = Rung.COPOSITIVE
        elif _detour(work, n, False):
            rung = Rung.DETOUR
        elif enumerate_modes(work, m, elements):
            rung = Rung.ENUMERATED
        elif _detour(work, n, True):
            rung = Rung.INEXACT
    work.rungs[rung.value] += 1
    work.sizes[size_class(n)] += 1
    return rung


@kernel
def _detour(work, n, rough):
    """True if Lemke's method reaches a solution from another start, then in `work.x`: ties and rounding fall otherwise.

    `rough`: the usual start counts, too, and so does what misses the conditions by next to nothing.
    """
    for path in range(0 if rough else 1, PATHS + 1):
        outcome = lemke_on_path(work.A, work.rhs, n, path, work.lcp, work.x)
        if outcome == LcpOutcome.SOLVED or (rough and outcome == LcpOutcome.INEXACT and solves(n, LCP_ROUGH, work.lcp)):
            return True
    return False


@kernel
def keep_basis(work, m, elements, rung):
    """After a small change of `work.rhs`: the solution with the same active unknowns, if it still is one.

    `rung`: the one that solved the problem; only Lemke's method on its first path leaves what is active.
    """
    n = m + 2 * elements
    if rung != Rung.LEMKE:
        for i in range(n):
            work.lcp.is_active[i] = 1 if work.x[i] > 0.0 else 0
    magnitude = scale(work.A, work.rhs, n, work.lcp)
    solve_active(n, work.lcp)
    if is_solution(n, work.lcp):
        unscale(n, magnitude, work.lcp, work.x)


@kernel
def fill_copositive(work, m, elements):
    """The problem in `A`, `rhs` with unknowns x_N, beta_+, beta_-, sigma into `B`, `other_rhs`; returns its size.

    The friction force is the middle of its interval plus beta_+ - beta_-, beta_+ + beta_- within half the length, sigma the
    speed of slip.
    """
    n = m + 3 * elements
    plus, minus, sigma = m, m + elements, m + 2 * elements
    for i in range(n):
        work.other_rhs[i] = 0.0
        for j in range(n):
            work.B[i, j] = 0.0
    for line in range(m + elements):
        work.other_rhs[line] = work.rhs[line]
        for j in range(m):
            work.B[line, j] = work.A[line, j]
        for e in range(elements):
            effect = work.A[line, m + e]
            work.B[line, plus + e], work.B[line, minus + e] = effect, -effect
            work.other_rhs[line] += 0.5 * work.rhs[m + elements + e] * effect
            if work.block[e] < m:
                work.B[line, work.block[e]] += 0.5 * work.width[e] * effect
    for e in range(elements):
        work.other_rhs[minus + e] = -work.other_rhs[plus + e]
        for j in range(n):
            work.B[minus + e, j] = -work.B[plus + e, j]
        work.B[plus + e, sigma + e], work.B[minus + e, sigma + e] = 1.0, 1.0
        work.B[sigma + e, plus + e], work.B[sigma + e, minus + e] = -1.0, -1.0
        work.other_rhs[sigma + e] = 0.5 * work.rhs[m + elements + e]
        if work.block[e] < m:
            work.B[sigma + e, work.block[e]] = 0.5 * work.width[e]
    return n


@kernel
def _solve_copositive(work, m, elements):
    """True if the copositive form gives a solution of the first form, then in `work.x`."""
    n = fill_copositive(work, m, elements)
    if lemke_checked(work.B, work.other_rhs, n, work.lcp, work.other_x) != LcpOutcome.SOLVED:
        return False
    for i in range(m):
        work.x[i] = work.other_x[i]
    for e in range(elements):
        half = 0.5 * work.rhs[m + elements + e]
        if work.block[e] < m:
            half += 0.5 * work.width[e] * work.x[work.block[e]]
        above = half + work.other_x[m + e] - work.other_x[m + elements + e]
        work.x[m + e] = above if above > LCP_ROUNDING * half else 0.0
    for e in range(elements):
        slip = work.rhs[m + e]
        for j in range(m + elements):
            slip += work.A[m + e, j] * work.x[j]
        work.x[m + elements + e] = max(0.0, -slip)
    return _is_solved(work, m + 2 * elements)


@kernel
def _is_solved(work, n):
    """True if `work.x` solves the first form, rounding errors in the place of zeros forgiven."""
    magnitude = scale(work.A, work.rhs, n, work.lcp)
    for i in range(n):
        value = work.x[i] / (work.lcp.column_scale[i] * magnitude)
        work.lcp.trial[i] = value if value > LCP_ROUNDING else 0.0
    return is_solution(n, work.lcp)


@kernel
def enumerate_modes(work, m, elements):
    """Try every set of modes (contact pressed or not; friction at one end, within, at the other end); True with `work.x`."""
    n = m + 2 * elements
    sets = 1.0
    for _ in range(m):
        sets *= 2.0
    for _ in range(elements):
        sets *= 3.0
    if sets > MODES:
        return False
    magnitude = scale(work.A, work.rhs, n, work.lcp)
    active = work.lcp.is_active
    for number in range(int(sets)):
        rest = number
        for i in range(m):
            active[i] = rest % 2
            rest //= 2
        for e in range(elements):
            digit = rest % 3
            rest //= 3
            active[m + e] = 1 if digit > 0 else 0
            active[m + elements + e] = 1 if digit == 2 else 0
        solve_active(n, work.lcp)
        if is_solution(n, work.lcp):
            unscale(n, magnitude, work.lcp, work.x)
            return True
    return False
