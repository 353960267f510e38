"""What are the velocities after an impact?

Two phases over all closed contacts at once: compression ends when no contact approaches any more; expansion gives back
at least the share eps_N of each compression impulse (Poisson). Coulomb friction acts in both, on impulses
(Pfeiffer & Glocker 1996, ch. 8; docs/method.md 2.6, law `coulomb`).
"""

from __future__ import annotations

from watchsim.dynamics.coulomb import fill_matrix, fill_rhs, read_forces
from watchsim.dynamics.delassus import apply, contact_velocities, fill_delassus
from watchsim.dynamics.lcp import solve_lcp
from watchsim.jit import kernel


@kernel
def _prepare(model, closed, m, work):
    """Tangential unknowns wherever there is friction; returns their number."""
    tangents = 0
    for i in range(m):
        work.drag[i] = model.laws[model.contacts[closed.ids[i]].group].friction
        work.tangent[i] = -1
        if work.drag[i] > 0.0:
            work.tangent[i] = tangents
            tangents += 1
    return tangents


@kernel
def _compress(model, closed, m, u, work):
    """Impulses of the compression into `work.force`; rates before it are in `work.b`. Returns the LCP status."""
    fill_delassus(model, closed, m, work)
    contact_velocities(model, closed, m, u, work.b)
    tangents = _prepare(model, closed, m, work)
    n = fill_matrix(work, m, tangents)
    fill_rhs(work, m, tangents, work.b)
    status = solve_lcp(work.A, work.rhs, n, work.lcp, work.x)
    read_forces(work, m, work.force)
    return status


@kernel
def _expand(m, restitution, work):
    """Impulses of the expansion into `work.more`. Returns the LCP status.

    Shifted unknowns: Lambda_NP = Lambda_NE - eps Lambda_NC, and Lambda_TE = Lambda_V - mu (eps Lambda_NC + Lambda_NP), with the
    friction interval 2 mu (eps Lambda_NC + Lambda_NP).
    """
    tangents = 0
    for i in range(m):
        returned = restitution[i] * work.force[2 * i]
        work.more[2 * i], work.more[2 * i + 1] = returned, 0.0
        if work.tangent[i] >= 0:
            work.more[2 * i + 1] = -work.drag[i] * returned
            tangents += 1
    for row in range(2 * m):
        total = work.b[row]
        for j in range(2 * m):
            total += work.G[row, j] * (work.force[j] + work.more[j])
        work.size[row] = total
    n = fill_matrix(work, m, tangents)
    fill_rhs(work, m, tangents, work.size)
    for i in range(m):
        t = work.tangent[i]
        if t >= 0:
            work.rhs[m + tangents + t] = 2.0 * work.drag[i] * work.more[2 * i] / work.unit[i]
    status = solve_lcp(work.A, work.rhs, n, work.lcp, work.x)
    for i in range(m):
        extra = work.unit[i] * work.x[i]
        work.more[2 * i] += extra
        t = work.tangent[i]
        if t >= 0:
            work.more[2 * i + 1] += work.unit[i] * work.x[m + t] - work.drag[i] * extra
    return status


@kernel
def impact(model, closed, m, restitution, work, out_u):
    """Two-phase impact of the first m closed contacts; `out_u` holds the velocities before and gets those after.

    `restitution[i]` is eps_N of row i. Total impulses N, T are left in `work.force`, rates before the impact in `work.b`.
    Returns the LCP status (0: solved); the velocities are changed only then.
    """
    status = _compress(model, closed, m, out_u, work)
    if status != 0:
        return status
    returns = False
    for i in range(m):
        if restitution[i] > 0.0 and work.force[2 * i] > 0.0:
            returns = True
    if returns:
        status = _expand(m, restitution, work)
        if status != 0:
            return status
        for row in range(2 * m):
            work.force[row] += work.more[row]
    apply(model, closed, m, work.force, out_u)
    return 0


@kernel
def energy_change(m, work):
    """T after minus T before of the impact just solved: Lambda·(rates before + half of G Lambda), J."""
    change = 0.0
    for row in range(2 * m):
        jump = 0.0
        for j in range(2 * m):
            jump += work.G[row, j] * work.force[j]
        change += work.force[row] * (work.b[row] + 0.5 * jump)
    return change
