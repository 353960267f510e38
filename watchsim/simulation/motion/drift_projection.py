"""How is drift off the contacts taken back?

Closed contacts are brought to zero gap, and their gap rates (with the slip of sticking ones) to zero, by the smallest
change in the metric of the mass matrix: dq = -M⁻¹ W (Wᵀ M⁻¹ W)⁺ g.

What is taken back is rounding, so the change must be of its size. Where two force directions are nearly parallel, or one has
next to no lever arm (friction on the line of centres), zeroing both rates would move the bodies by far more than the rates
themselves: directions that the others nearly determine are left as they are (docs/theory/method.md 2.10).
"""

from __future__ import annotations

from watchsim.contact.index_sets import OPEN, STICK
from watchsim.dynamics.delassus import apply, fill_delassus
from watchsim.dynamics.small_systems import keep_independent, solve_small, unit_scale
from watchsim.jit import kernel
from watchsim.tolerances import DEPENDENT_IN_STEPS, SLIP_WEIGHT, TAKEN_BACK_ALONG

# sine² of the angle below which a direction counts as one of the others, or as immovable


@kernel
def project_positions(closed, m, both, behind, work, out_q):
    """Close the gaps of the first m contacts (only negative ones unless `both`); returns the deepest penetration found, m.

    What is no drift but what flat faces have let bodies sink in (events/immovable.py) stays. `behind`: see `_has_drifted`.
    """
    deepest = 0.0
    for i in range(m):
        deepest = max(deepest, -closed.kin[i].g)
    if deepest == 0.0 and not both:
        return deepest
    fill_delassus(closed, m, work)
    for i in range(m):
        work.row[i] = 2 * i
    n = m
    if not _close(closed, n, both, behind, work):
        n = _choose(closed, m, both, behind, work)
        _close(closed, n, both, behind, work)
    for row in range(2 * m):
        work.correction[row] = 0.0
    for i in range(n):
        work.correction[work.row[i]] = work.x[i]
    apply(closed, m, work.correction, work.inverse, out_q)
    return deepest


@kernel
def _wanted(closed, row, both, behind, work):
    """By how much the gap of this row shall change, m."""
    gap = closed.kin[row // 2].g
    return -gap if (both or gap < 0.0) and _has_drifted(work, row, gap, behind) else 0.0


@kernel
def _has_drifted(work, row, gap, behind):
    """False if a contact is deeper than `behind` (m), or so deep that taking it back would move it far along its face.

    Bodies that have sunk in meet a face at its joint. On the way back to where it has no gap they would leave that face.
    """
    along = abs(work.G[row, row + 1]) * -gap
    return gap >= -behind and along <= TAKEN_BACK_ALONG * behind * work.G[row, row]


@kernel
def _close(closed, n, both, behind, work):
    """What closes the gaps of the n rows in `work.row` into `work.x`; False where their directions depend on each other."""
    for i in range(n):
        for j in range(n):
            work.A[i, j] = work.G[work.row[i], work.row[j]]
        work.rhs[i] = _wanted(closed, work.row[i], both, behind, work)
        work.scale[i] = _scale_of(work, work.row[i], DEPENDENT_IN_STEPS)
    return solve_small(work.A, work.rhs, n, work.scale, work.order, work.x, DEPENDENT_IN_STEPS) == n


@kernel
def _choose(closed, m, both, behind, work):
    """Leave in `work.row` gaps whose directions do not depend on each other, of m; returns their number.

    Not all can be closed: those are that the bodies meet first on the way there, so that none of the others is pressed in.
    """
    for i in range(m):
        wanted, place = _scale_of(work, 2 * i, DEPENDENT_IN_STEPS) * _wanted(closed, 2 * i, both, behind, work), i
        while place > 0 and work.rhs[place - 1] < wanted:
            work.rhs[place], work.row[place] = work.rhs[place - 1], work.row[place - 1]
            place -= 1
        work.rhs[place], work.row[place] = wanted, 2 * i
    for i in range(m):
        work.scale[i] = _scale_of(work, work.row[i], DEPENDENT_IN_STEPS)
    for i in range(m):
        for j in range(m):
            work.A[i, j] = work.scale[i] * work.G[work.row[i], work.row[j]] * work.scale[j]
    return keep_independent(work.A, m, DEPENDENT_IN_STEPS, work.row)


@kernel
def project_velocities(closed, m, mode, independent, work, out_u):
    """Make the gap rates of the first m contacts in force, and the slip of the sticking ones, zero.

    `independent`: DEPENDENT_IN_STEPS or DEPENDENT_AT_EVENTS.
    """
    find_correction(closed, m, mode, independent, work)
    apply(closed, m, work.correction, work.inverse, out_u)


@kernel
def find_correction(closed, m, mode, independent, work):
    """The impulses of `project_velocities` into `work.correction`; fills `work.G`."""
    fill_delassus(closed, m, work)
    n = 0
    for i in range(m):
        state = mode[closed.ids[i]]
        work.correction[2 * i], work.correction[2 * i + 1] = 0.0, 0.0
        if state != OPEN:
            n = _add_row(work, 2 * i, -closed.kin[i].gN_dot, n, independent)
        if state == STICK:
            n = _add_row(work, 2 * i + 1, -closed.kin[i].gT_dot, n, independent)
    for i in range(n):
        for j in range(n):
            work.A[i, j] = work.G[work.row[i], work.row[j]]
    solve_small(work.A, work.rhs, n, work.scale, work.order, work.x, independent)
    for i in range(n):
        work.correction[work.row[i]] = work.x[i]


@kernel
def rate_left(closed, m, i, work):
    """Gap rate of contact i after the correction just found."""
    rate = closed.kin[i].gN_dot
    for row in range(2 * m):
        rate += work.G[2 * i, row] * work.correction[row]
    return rate


@kernel
def _add_row(work, row, rate, n, independent):
    """Append the row of G with what its rate shall change by; returns the new number of rows."""
    work.row[n], work.rhs[n], work.scale[n] = row, rate, _scale_of(work, row, independent)
    return n + 1


@kernel
def _scale_of(work, row, independent):
    """Unit diagonal for what can be moved, less for slips; zero for what next to no impulse along its direction moves."""
    normal = row - row % 2
    easiest = work.G[normal, normal] + work.G[normal + 1, normal + 1]
    own = work.G[row, row]
    if own <= independent * easiest:
        return 0.0
    return unit_scale(own) if row == normal else SLIP_WEIGHT * unit_scale(own)
