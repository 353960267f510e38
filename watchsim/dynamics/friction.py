"""How is a contact problem solved, and what if the first method fails?

Rung after rung: Lemke's method on the form of coulomb.py; on the copositive form, which always has a solution for
impacts (Stewart & Trinkle 1996; Anitescu & Potra 1997); Lemke's method on other paths; enumeration of the modes of
small sets. What solves the problem is checked against the first form. Where many contacts are redundant their loads are
rounding errors that may contradict each other: then an end of Lemke's method is taken that misses by no more than a billionth
of the load that drives the problem. If nothing helps, the caller stops and keeps the problem.
"""

from __future__ import annotations

from watchsim.dynamics.delassus import size_class, unit_scale
from watchsim.dynamics.lcp import (
    LcpOutcome,
    Solver,
    is_solution,
    lemke_checked,
    lemke_on_path,
    scale,
    solve_active,
    solves,
    unscale,
)
from watchsim.jit import kernel
from watchsim.tolerances import ACCELERATION_ROUNDING, LCP_ROUGH, LCP_ROUNDING, NO_HAND, NUDGE, PAINLEVE

# What do the three complementarity problems with Coulomb friction have in common?
#
# Their matrix. Every friction force lies in an interval from c - L x_N to c - L x_N + l x_N + l_0, where x_N is the normal
# force of its contact: L = mu, l = 2 mu, c = l_0 = 0 for a contact at the acceleration level and in the compression; c = -T,
# l_0 = 2 T for a bearing with dry friction T; the laws of the expansion are in expansion_friction.py. With x_+ the distance
# from
# the lower end, the law turns into complementarity with a slip measure (docs/theory/method.md 2.5, 2.6):
#
#     [ y_N ]   [ G_NN - G_NT L   G_NT   0 ] [ x_N  ]
#     [ y_+ ] = [ G_TN - G_TT L   G_TT   1 ] [ x_+  ] + b
#     [ x_- ]   [ l                -1    0 ] [ y_-  ]
#
# For contacts known to slide L is mu times the direction of slip, and they have no element.


@kernel
def add_element(work, block, element, interval):
    """Element number `element` belongs to `block`; interval: (width, span, shift). Returns the next number."""
    work.block[element] = block
    work.width[element], work.span[element], work.shift[element] = interval
    return element + 1


@kernel
def element_row(work, m, element):
    """Row of G of an element."""
    block = work.block[element]
    return 2 * block + 1 if block < m else m + block


@kernel
def _fill_units(work, m, elements):
    for i in range(m):
        work.unit[i] = unit_scale(max(work.G[2 * i, 2 * i], work.G[2 * i + 1, 2 * i + 1]))
    for e in range(elements):
        block = work.block[e]
        if block >= m:
            work.unit[block] = unit_scale(work.G[m + block, m + block])


@kernel
def fill_matrix(work, m, elements):
    """The matrix above in unit-diagonal scaling, size m + 2 elements; needs G, drag and the elements. Fills `unit` too."""
    n = m + 2 * elements
    for i in range(n):
        for j in range(n):
            work.A[i, j] = 0.0
    _fill_units(work, m, elements)
    for line in range(m + elements):
        e = line - m
        row = 2 * line if e < 0 else element_row(work, m, e)
        unit = work.unit[line if e < 0 else work.block[e]]
        for j in range(m):
            work.A[line, j] = unit * work.unit[j] * (work.G[row, 2 * j] - work.drag[j] * work.G[row, 2 * j + 1])
        for f in range(elements):
            work.A[line, m + f] = unit * work.unit[work.block[f]] * work.G[row, element_row(work, m, f)]
    for e in range(elements):
        work.A[m + e, m + elements + e] = 1.0
        work.A[m + elements + e, m + e] = -1.0
        if work.block[e] < m:
            work.A[m + elements + e, work.block[e]] = work.width[e]
    return n


@kernel
def fill_rhs(work, m, elements, b):
    """Right-hand side from the rows `b`: accelerations or velocities with each force at the constant part of its lower end."""
    for i in range(m):
        work.rhs[i] = work.unit[i] * b[2 * i]
    for e in range(elements):
        unit = work.unit[work.block[e]]
        work.rhs[m + e] = unit * b[element_row(work, m, e)]
        work.rhs[m + elements + e] = work.span[e] / unit


@kernel
def read_forces(work, m, elements, out_force):
    """Forces by row of G from the solution `work.x` of the scaled problem."""
    for i in range(m):
        normal = work.unit[i] * work.x[i]
        out_force[2 * i], out_force[2 * i + 1] = normal, -work.drag[i] * normal
    for e in range(elements):
        block = work.block[e]
        above = work.shift[e] + work.unit[block] * work.x[m + e]
        out_force[element_row(work, m, e)] = above - work.drag[block] * out_force[2 * block] if block < m else above


# Which way round are the directions of friction taken, so that a mechanism and its mirror image have the same problem?
#
# The complementarity form of friction treats the two ends of the cone differently (coulomb.py). Where friction leaves more than
# one solution, Lemke's method ends in another one when a direction is reversed: the mechanism in a mirror would move otherwise.
# So each direction is reversed, for the time of the solution, such that what the contact does without friction is positive: its
# slip (rate or acceleration), or, if that is zero, what a normal force does to it. Both change sign with the direction, and
# neither depends on where the drawing came from.


@kernel
def reverse_directions(work, m, rows, elements, slip):
    """Reverse G and `slip` in the rows of elements whose slip without friction is negative.

    What was reversed is noted in `work.hand` (-1), for `restore_directions`.
    """
    largest = 0.0
    for e in range(elements):
        row = element_row(work, m, e)
        largest = max(largest, _share(work, row, slip))
    for row in range(rows):
        work.hand[row] = 1.0
    for e in range(elements):
        row, block = element_row(work, m, e), work.block[e]
        direction = slip[row]
        if _share(work, row, slip) <= NO_HAND * NO_HAND * largest and block < m:
            direction = work.G[row, 2 * block]
        if direction < 0.0:
            work.hand[row] = -1.0
    _turn(work, rows, slip)


@kernel
def restore_directions(work, rows, slip):
    """Undo `reverse_directions` in G, `slip` and the forces found."""
    _turn(work, rows, slip)
    for row in range(rows):
        work.force[row] *= work.hand[row]


@kernel
def _share(work, row, slip):
    """What the row alone would cost to stop: the same in all units, and in a mirror."""
    return slip[row] * slip[row] / work.G[row, row] if work.G[row, row] > 0.0 else 0.0


@kernel
def _turn(work, rows, slip):
    for row in range(rows):
        if work.hand[row] < 0.0:
            slip[row] = -slip[row]
            for column in range(rows):
                work.G[row, column], work.G[column, row] = -work.G[row, column], -work.G[column, row]
            work.G[row, row] = -work.G[row, row]


# Which contacts jam: slide such that a normal force on them pulls their bodies together (Painlevé)?
#
# Where nothing presses such a contact, the laws have several solutions (docs/theory/method.md 2.6).


@kernel
def press_unloaded(model, closed, m, work):
    """Settle what happens where nothing presses a contact in whose direction of slip it would jam; True if any is pressed.

    There the laws have more than one solution, and the rounding of a load that is zero would choose between them. Without
    slip the contact holds, as it would under any load however small: it is pressed by next to nothing. With slip it goes
    on without a force.
    """
    pressed = False
    for i in range(m):
        if not _jams(work, m, i, PAINLEVE) or not _is_unloaded(model, closed, i, work):
            continue
        if work.tangent[i] < 0:
            work.rhs[i] = max(0.0, work.rhs[i])
        elif work.loaded[2 * i + 1] != 0.0:
            work.rhs[i] -= NUDGE * abs(work.loaded[2 * i + 1]) * work.unit[i]
            pressed = True
    return pressed


@kernel
def _is_unloaded(model, closed, i, work):
    """True if the gap of contact i does not accelerate without its force, but for rounding, that of its lever arms among it."""
    terms = closed.kin[i].bar_size
    for k in range(closed.slots[i]):
        j = closed.coord[i, k]
        arm = abs(closed.w_N[i, k]) + abs(closed.w_T[i, k])
        terms += arm * (abs(work.h[j]) + model.coordinates[j].load) * work.inverse[j]
    return abs(work.loaded[2 * i]) <= ACCELERATION_ROUNDING * terms


@kernel
def is_paradox(work, m, i, near=PAINLEVE):
    """True if contact i, all by itself, slides such that a normal force on it pulls its bodies together, or nearly so.

    Works with the G and drag of `solve_mode` and `decide_modes`. `near`: the share of G_N by which it may still part them.
    """
    return work.tangent[i] < 0 and _jams(work, m, i, near)


@kernel
def _jams(work, m, i, near):
    """The same of a contact without slip, in the direction in which it would begin to slide."""
    own = work.G[2 * i, 2 * i]
    if own == 0.0:
        return False
    if own - work.drag[i] * work.G[2 * i, 2 * i + 1] > near * own:
        return False
    for j in range(m):
        if j != i and (work.G[2 * i, 2 * j] != 0.0 or work.G[2 * i, 2 * j + 1] != 0.0 or work.G[2 * i + 1, 2 * j] != 0.0):
            return False
    return True


# How is a contact problem solved, and what if the first method fails?

PATHS = 8  # other ones that Lemke tries
MODES = 50000  # sets of modes tried at most: some tenths of a second


@kernel
def solve_contacts(work, m, elements):
    """Solve the problem in `work.A`, `work.rhs` into `work.x`; returns the rung that did, FAILED if none."""
    n = m + 2 * elements
    outcome = lemke_checked(work.A, work.rhs, n, work.lcp, work.x)
    work.posed.lemke = outcome
    rung = Solver.LEMKE
    if outcome != LcpOutcome.SOLVED:
        rung = Solver.FAILED
        if elements > 0 and _solve_copositive(work, m, elements):
            rung = Solver.COPOSITIVE
        elif _detour(work, n, False):
            rung = Solver.DETOUR
        elif enumerate_modes(work, m, elements):
            rung = Solver.ENUMERATED
        elif _detour(work, n, True):
            rung = Solver.INEXACT
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
    if rung != Solver.LEMKE:
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
