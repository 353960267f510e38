"""What are the contact forces and accelerations now?

Inside a mode an equality system; at an event the acceleration-level LCP, which decides detachment and stick-slip
(Pfeiffer & Glocker 1996, ch. 5; docs/method.md 2.4, 2.5).
"""

from __future__ import annotations

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.dynamics.coulomb import fill_matrix, fill_rhs, read_forces
from watchsim.dynamics.delassus import apply, fill_delassus
from watchsim.dynamics.lcp import solve_lcp
from watchsim.dynamics.linear import solve_small
from watchsim.jit import kernel

ROUNDING = 1e-10  # accelerations below this share of the terms they are the sum of count as zero


@kernel
def gap_accelerations(model, closed, m, work, out_b, out_size):
    """b = Wᵀ M⁻¹ h + w̄ for the first m contacts, and the sum of its terms' magnitudes."""
    for i in range(m):
        kin = closed.kin[i]
        normal, tangential = kin.bar_N, kin.bar_T
        size_N, size_T = abs(kin.bar_N), abs(kin.bar_T)
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            free = work.h[j] / model.coordinates[j].mass
            normal += closed.w_N[i, k] * free
            tangential += closed.w_T[i, k] * free
            size_N += abs(closed.w_N[i, k] * free)
            size_T += abs(closed.w_T[i, k] * free)
        out_b[2 * i], out_b[2 * i + 1] = normal, tangential
        out_size[2 * i], out_size[2 * i + 1] = size_N, size_T


@kernel
def accelerate(model, closed, m, work, out_a):
    """u' = M⁻¹ (h + W lambda) from `work.h` and `work.force`."""
    for j in range(len(model.coordinates)):
        out_a[j] = work.h[j] / model.coordinates[j].mass
    apply(model, closed, m, work.force, out_a)


@kernel
def solve_mode(model, closed, m, mode, work):
    """Forces of the first m contacts in their decided modes; `work.h` is given. Fills `work.force`, `work.b`, `work.size`."""
    fill_delassus(model, closed, m, work)
    gap_accelerations(model, closed, m, work, work.b, work.size)
    n = m
    for i in range(m):
        state = mode[closed.ids[i]]
        friction = model.laws[model.contacts[closed.ids[i]].group].friction
        work.tangent[i] = -1
        work.drag[i] = 0.0 if state == STICK else friction * state
        if state == STICK and friction > 0.0:
            work.tangent[i] = n
            n += 1
    for i in range(m):
        _equation(work, m, 2 * i, i)
        if work.tangent[i] >= 0:
            _equation(work, m, 2 * i + 1, work.tangent[i])
    solve_small(work.A, work.rhs, n, work.order, work.x)
    for i in range(m):
        work.force[2 * i] = work.x[i]
        t = work.tangent[i]
        work.force[2 * i + 1] = work.x[t] if t >= 0 else -work.drag[i] * work.x[i]


@kernel
def _equation(work, m, row, line):
    """One row of the equality system: the acceleration of gap `row` vanishes."""
    for j in range(m):
        work.A[line, j] = work.G[row, 2 * j] - work.drag[j] * work.G[row, 2 * j + 1]
        if work.tangent[j] >= 0:
            work.A[line, work.tangent[j]] = work.G[row, 2 * j + 1]
    work.rhs[line] = -work.b[row]


@kernel
def decide_modes(model, closed, m, speed_zero, work, out_mode):
    """Acceleration-level LCP over I_N, the first m closed contacts: sets modes, fills `work.force`, returns the LCP status.

    Contacts whose |g_T_dot| is below `speed_zero` may stick; the others slide as they do.
    """
    fill_delassus(model, closed, m, work)
    gap_accelerations(model, closed, m, work, work.b, work.size)
    tangents = 0
    for i in range(m):
        friction = model.laws[model.contacts[closed.ids[i]].group].friction
        slip = closed.kin[i].gT_dot
        work.tangent[i] = -1
        work.drag[i] = friction if slip > 0.0 else -friction
        if friction > 0.0 and abs(slip) <= speed_zero:
            work.tangent[i], work.drag[i] = tangents, friction
            tangents += 1
    n = fill_matrix(work, m, tangents)
    fill_rhs(work, m, tangents, work.b)
    status = solve_lcp(work.A, work.rhs, n, work.lcp, work.x)
    if status != 0:
        return status
    read_forces(work, m, work.force)
    for i in range(m):
        out_mode[closed.ids[i]] = _mode_of(closed, i, m, work)
    for i in range(m):
        if out_mode[closed.ids[i]] == OPEN:
            work.force[2 * i], work.force[2 * i + 1] = 0.0, 0.0
    return 0


@kernel
def _gap_acceleration(work, m, row):
    """g'' of row `row` under the forces just found."""
    total = work.b[row]
    for j in range(2 * m):
        total += work.G[row, j] * work.force[j]
    return total


@kernel
def _mode_of(closed, i, m, work):
    """The mode of contact i after the LCP."""
    if work.x[i] <= 0.0 and _gap_acceleration(work, m, 2 * i) > ROUNDING * work.size[2 * i]:
        return OPEN
    if work.tangent[i] < 0:
        return BACKWARD if closed.kin[i].gT_dot < 0.0 else FORWARD
    slip = _gap_acceleration(work, m, 2 * i + 1)
    # lambda_T is the difference of terms as large as the friction cone.
    terms = abs(work.force[2 * i + 1]) + work.drag[i] * work.force[2 * i]
    size = ROUNDING * (work.size[2 * i + 1] + work.G[2 * i + 1, 2 * i + 1] * terms)
    if slip > size:
        return FORWARD
    return BACKWARD if slip < -size else STICK
