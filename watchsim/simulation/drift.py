"""How is drift off the contacts taken back?

Closed contacts are brought to zero gap, and their gap rates (with the slip of sticking ones) to zero, by the smallest
change in the metric of the mass matrix: dq = -M⁻¹ W (Wᵀ M⁻¹ W)⁺ g.
"""

from __future__ import annotations

from watchsim.contact.index_sets import STICK
from watchsim.dynamics.delassus import apply, fill_delassus
from watchsim.dynamics.linear import solve_small, unit_scale
from watchsim.jit import kernel


@kernel
def project_positions(closed, m, both, work, out_q):
    """Close the gaps of the first m contacts (only negative ones unless `both`); returns the deepest penetration found, m."""
    deepest, furthest = 0.0, 0.0
    for i in range(m):
        deepest = max(deepest, -closed.kin[i].g)
        furthest = max(furthest, abs(closed.kin[i].g))
    if furthest == 0.0 or (deepest == 0.0 and not both):
        return deepest
    fill_delassus(closed, m, work)
    for i in range(m):
        for j in range(m):
            work.A[i, j] = work.G[2 * i, 2 * j]
        work.rhs[i] = -closed.kin[i].g if both or closed.kin[i].g < 0.0 else 0.0
        work.scale[i] = unit_scale(work.G[2 * i, 2 * i])
    solve_small(work.A, work.rhs, m, work.scale, work.order, work.x)
    for i in range(m):
        work.more[2 * i], work.more[2 * i + 1] = work.x[i], 0.0
    apply(closed, m, work.more, work.inverse, out_q)
    return deepest


@kernel
def project_velocities(closed, m, mode, work, out_u):
    """Make the gap rates of the first m contacts, and the slip of the sticking ones, exactly zero."""
    fill_delassus(closed, m, work)
    n = 0
    for i in range(m):
        work.order[n] = 2 * i
        work.rhs[n] = -closed.kin[i].gN_dot
        n += 1
        if mode[closed.ids[i]] == STICK:
            work.order[n] = 2 * i + 1
            work.rhs[n] = -closed.kin[i].gT_dot
            n += 1
    for i in range(n):
        for j in range(n):
            work.A[i, j] = work.G[work.order[i], work.order[j]]
        work.scale[i] = unit_scale(work.G[work.order[i], work.order[i]])
    for row in range(2 * m):
        work.more[row] = 0.0
    # solve_small permutes `order`: read the rows again in the same sequence afterwards.
    solve_small(work.A, work.rhs, n, work.scale, work.order, work.x)
    n = 0
    for i in range(m):
        work.more[2 * i] = work.x[n]
        n += 1
        if mode[closed.ids[i]] == STICK:
            work.more[2 * i + 1] = work.x[n]
            n += 1
    apply(closed, m, work.more, work.inverse, out_u)
