"""What are the contact forces and accelerations now?

Inside a mode an equality system; at an event the acceleration-level LCP, which decides detachment and stick-slip of contacts
and of bearings with dry friction (Pfeiffer & Glocker 1996, ch. 5; docs/theory/method.md 2.4, 2.5).
"""

from __future__ import annotations

from watchsim.contact.gaps import BACKWARD, FORWARD, OPEN, STICK
from watchsim.dynamics.delassus import (
    apply,
    fill_bearings,
    fill_delassus,
    inverse_mass,
    note_posed,
    own_acceleration,
    smallest_forces,
    solve_small,
    unit_scale,
)
from watchsim.dynamics.friction import (
    add_element,
    fill_matrix,
    fill_rhs,
    is_paradox,
    keep_basis,
    press_unloaded,
    read_forces,
    restore_directions,
    reverse_directions,
    solve_contacts,
)
from watchsim.dynamics.lcp import Level, Solver
from watchsim.jit import hot_kernel, kernel
from watchsim.tolerances import ACCELERATION_ROUNDING, RANK


@kernel
def gap_accelerations(model, closed, m, work, out_b, out_size):
    """b = Wᵀ M⁻¹ h + w̄ for the first m contacts, and the sum of its terms' magnitudes.

    A term that happens to vanish, as a pendulum's weight does when it hangs straight, still has the rounding of its vectors.
    """
    for i in range(m):
        kin = closed.kin[i]
        normal, tangential = kin.bar_N, kin.bar_T
        size_N, size_T = kin.bar_size, kin.bar_size
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            free = own_acceleration(model, work, j)
            normal += closed.w_N[i, k] * free
            tangential += closed.w_T[i, k] * free
            terms = abs(free) + model.coordinates[j].load * work.inverse[j]
            size_N += abs(closed.w_N[i, k]) * terms
            size_T += abs(closed.w_T[i, k]) * terms
        out_b[2 * i], out_b[2 * i + 1] = normal, tangential
        out_size[2 * i], out_size[2 * i + 1] = size_N, size_T


@kernel
def _fill_worth(work, m):
    """The normal force that each contact's own terms make, into `work.worth`: the scale of its rounding, if they cancel."""
    for i in range(m):
        own = work.G[2 * i, 2 * i]
        work.worth[i] = work.size[2 * i] / own if own > 0.0 else 0.0


@hot_kernel
def row_terms(work, m, rows, row):
    """The sum of the magnitudes of its terms: the scale of its rounding.

    What another contact passes on has the rounding of that one's terms, even where these cancel and it passes on nothing.
    """
    total = work.size[row]
    for j in range(rows):
        total += abs(work.G[row, j] * work.force[j])
    for i in range(m):
        if i != row // 2:
            total += (abs(work.G[row, 2 * i]) + abs(work.drag[i] * work.G[row, 2 * i + 1])) * work.worth[i]
    return total


@kernel
def accelerate(model, closed, m, work, out_a):
    """u' = M⁻¹ (h + W lambda) from `work.h` and `work.force`; 0 where dry friction holds."""
    for j in range(len(out_a)):
        out_a[j] = own_acceleration(model, work, j)
    apply(closed, m, work.force, work.inverse, out_a)


@kernel
def solve_mode(model, closed, m, mode, lenience, work):
    """Forces of the first m contacts in their decided modes; `work.h`, `work.inverse` are given.

    `lenience`: what decides whether forces are unique is so many times `RANK`. Fills `work.force`, `work.b`, `work.size`,
    `work.G`; True if the forces are unique.
    """
    fill_delassus(closed, m, work)
    gap_accelerations(model, closed, m, work, work.b, work.size)
    _fill_worth(work, m)
    n = m
    for i in range(m):
        state = mode[closed.ids[i]]
        friction = model.laws[model.contacts[closed.ids[i]].group].friction
        work.tangent[i] = -1
        work.width[i] = friction
        work.drag[i] = 0.0 if state == STICK else friction * state
        work.scale[i] = unit_scale(work.G[2 * i, 2 * i])
        if state == STICK and friction > 0.0:
            work.tangent[i] = n
            work.scale[n] = unit_scale(work.G[2 * i + 1, 2 * i + 1])
            n += 1
    for i in range(m):
        _equation(work, m, 2 * i, i)
        if work.tangent[i] >= 0:
            _equation(work, m, 2 * i + 1, work.tangent[i])
    rank = solve_small(work.A, work.rhs, n, work.scale, work.order, work.x, RANK * lenience)
    if rank < n:
        smallest_forces(model, closed, m, n, rank, lenience, work)
    for i in range(m):
        work.force[2 * i] = work.x[i]
        t = work.tangent[i]
        work.force[2 * i + 1] = work.x[t] if t >= 0 else -work.drag[i] * work.x[i]
    for row in range(2 * m):
        work.size[row] = row_terms(work, m, 2 * m, row)
    return rank == n


@kernel
def _equation(work, m, row, line):
    """One row of the equality system: the acceleration of gap `row` vanishes."""
    for j in range(m):
        work.A[line, j] = work.G[row, 2 * j] - work.drag[j] * work.G[row, 2 * j + 1]
        if work.tangent[j] >= 0:
            work.A[line, work.tangent[j]] = work.G[row, 2 * j + 1]
    work.rhs[line] = -work.b[row]


@kernel
def decide_modes(model, closed, m, bearings, speed_zero, work, out_grip, out_mode):
    """Acceleration-level LCP over I_N, the first m closed contacts, and the bearings listed in `work.dry`; is it solved?

    Contacts whose |g_T_dot| is below `speed_zero` may stick; the others slide as they do. Sets modes and grips, fills
    `work.force`, `work.inverse` and adds to `work.h` the dry friction of the bearings that begin to move. False: no
    finite force keeps the bodies apart (Painlevé's paradox, if a contact slides).
    """
    for i in range(len(model.coordinates)):
        work.inverse[i] = inverse_mass(model.coordinates[i])
    fill_delassus(closed, m, work)
    fill_bearings(closed, m, bearings, work)
    gap_accelerations(model, closed, m, work, work.b, work.size)
    _fill_worth(work, m)
    elements = _elements(model, closed, m, bearings, speed_zero, work)
    _free_bearings(work, m, bearings)
    rows = 2 * m + bearings
    reverse_directions(work, m, rows, elements, work.b)
    fill_matrix(work, m, elements)
    _load(work, m, elements, bearings)
    fill_rhs(work, m, elements, work.loaded)
    pressed = press_unloaded(model, closed, m, work)
    note_posed(work, m, elements, bearings, Level.ACCELERATION)
    rung = solve_contacts(work, m, elements)
    if rung == Solver.FAILED:
        restore_directions(work, rows, work.b)
        return False
    if pressed:
        fill_rhs(work, m, elements, work.loaded)
        keep_basis(work, m, elements, rung)
    read_forces(work, m, elements, work.force)
    for i in range(m):
        if work.x[i] > 0.0 and is_paradox(work, m, i):
            restore_directions(work, rows, work.b)
            return False
    for i in range(m):
        out_mode[closed.ids[i]] = _mode_of(closed, i, m, elements, bearings, work)
    restore_directions(work, rows, work.b)
    for i in range(m):
        if out_mode[closed.ids[i]] == OPEN:
            work.force[2 * i], work.force[2 * i + 1] = 0.0, 0.0
    _decide_grips(model, m, bearings, work, out_grip)
    return True


@kernel
def _elements(model, closed, m, bearings, speed_zero, work):
    """The contacts that may stick, then the bearings; returns how many."""
    elements = 0
    for i in range(m):
        friction = model.laws[model.contacts[closed.ids[i]].group].friction
        slip = closed.kin[i].gT_dot
        work.tangent[i] = -1
        work.drag[i] = friction if slip > 0.0 else -friction
        if friction > 0.0 and abs(slip) <= speed_zero:
            work.tangent[i], work.drag[i] = elements, friction
            elements = add_element(work, i, elements, (2.0 * friction, 0.0, 0.0))
    for p in range(bearings):
        dry = model.coordinates[work.dry[p]].coulomb
        elements = add_element(work, m + p, elements, (0.0, 2.0 * dry, -dry))
    return elements


@kernel
def _free_bearings(work, m, bearings):
    """The accelerations of the bearings without friction and contact forces into `b`, their magnitudes into `size`."""
    for p in range(bearings):
        i = work.dry[p]
        work.b[2 * m + p] = work.h[i] * work.inverse[i]
        work.size[2 * m + p] = abs(work.b[2 * m + p])


@kernel
def _load(work, m, elements, bearings):
    """Accelerations without contact forces, bearings at the lower end of their friction, into `loaded`."""
    for row in range(2 * m + bearings):
        work.loaded[row] = work.b[row]
        for p in range(bearings):
            # The elements of the bearings are the last ones, in order.
            work.loaded[row] += work.G[row, 2 * m + p] * work.shift[elements - bearings + p]


@kernel
def _row_acceleration(work, rows, row):
    """g'' of row `row` under the forces just found."""
    total = work.b[row]
    for j in range(rows):
        total += work.G[row, j] * work.force[j]
    return total


@kernel
def _mode_of(closed, i, m, elements, bearings, work):
    """The mode of contact i after the LCP.

    It slides only one way if the LCP has its friction at that end of the cone: where contacts are redundant, the slip of one
    whose friction is at the other end is what the LCP may miss.
    """
    rows = 2 * m + bearings
    if work.x[i] <= 0.0 and _row_acceleration(work, rows, 2 * i) > ACCELERATION_ROUNDING * row_terms(work, m, rows, 2 * i):
        return OPEN
    if work.tangent[i] < 0:
        if work.x[i] <= 0.0 and is_paradox(work, m, i):
            return OPEN  # the least force would jam it
        return BACKWARD if closed.kin[i].gT_dot < 0.0 else FORWARD
    slip = _row_acceleration(work, rows, 2 * i + 1)
    # lambda_T is the difference of terms as large as the friction cone.
    terms = abs(work.force[2 * i + 1]) + work.drag[i] * work.force[2 * i]
    size = ACCELERATION_ROUNDING * (row_terms(work, m, rows, 2 * i + 1) + work.G[2 * i + 1, 2 * i + 1] * terms)
    e = work.tangent[i]
    is_reversed = work.hand[2 * i + 1] < 0.0
    if slip > size and work.x[m + e] == 0.0:
        return BACKWARD if is_reversed else FORWARD
    if slip < -size and work.x[m + elements + e] > 0.0:
        return FORWARD if is_reversed else BACKWARD
    return STICK


@kernel
def _decide_grips(model, m, bearings, work, out_grip):
    """The grips of the bearings that stood; those held get no inverse mass, those that begin to move their friction."""
    rows = 2 * m + bearings
    for p in range(bearings):
        i, row = work.dry[p], 2 * m + p
        moves = _row_acceleration(work, rows, row)
        terms = row_terms(work, m, rows, row) + work.inverse[i] * model.coordinates[i].coulomb
        if abs(moves) > ACCELERATION_ROUNDING * terms:
            out_grip[i] = FORWARD if moves > 0.0 else BACKWARD
            work.h[i] -= out_grip[i] * model.coordinates[i].coulomb
    for p in range(bearings):
        if out_grip[work.dry[p]] == STICK:
            work.inverse[work.dry[p]] = 0.0
