"""What are the velocities after an impact?

Two phases over all closed contacts at once: compression ends when no contact approaches any more; expansion gives back
at least the share eps_N of each compression impulse (Poisson). Friction acts in both, on impulses: Coulomb's law in the
compression, the scene's tangential law in the expansion (Pfeiffer & Glocker 1996, ch. 8; docs/theory/method.md 2.6,
docs/theory/laws.md).
"""

from __future__ import annotations

from watchsim.dynamics.acceleration import gap_accelerations
from watchsim.dynamics.delassus import apply, contact_velocities, fill_delassus, inverse_mass, note_posed
from watchsim.dynamics.forces import interval
from watchsim.dynamics.friction import (
    add_element,
    element_row,
    fill_matrix,
    fill_rhs,
    keep_basis,
    read_forces,
    restore_directions,
    reverse_directions,
    solve_contacts,
)
from watchsim.dynamics.lcp import Level, Solver
from watchsim.jit import kernel
from watchsim.tolerances import NUDGE, PAINLEVE, PARALLEL, VELOCITY_ROUNDING


@kernel
def _law(model, closed, i):
    return model.laws[model.contacts[closed.ids[i]].group]


@kernel
def _begin(model, closed, m, work):
    """Coulomb friction within ± mu Lambda_N for every contact that has any; returns the number of elements."""
    elements = 0
    for i in range(m):
        work.drag[i] = _law(model, closed, i).friction
        work.tangent[i] = -1
        if work.drag[i] > 0.0:
            work.tangent[i] = elements
            elements = add_element(work, i, elements, (2.0 * work.drag[i], 0.0, 0.0))
    return elements


@kernel
def _compress(model, closed, m, u, jam, work):
    """Impulses of the compression into `work.force`, rates before it into `work.b`. Returns (solved?, elements).

    From here on until `restore_directions` some directions of friction are reversed.
    """
    for j in range(len(model.coordinates)):
        work.inverse[j] = inverse_mass(model.coordinates[j])
    elements = _begin(model, closed, m, work)
    fill_delassus(closed, m, work)
    contact_velocities(closed, m, u, work.b)
    _drop_rounding(closed, m, u, work.b)
    reverse_directions(work, m, 2 * m, elements, work.b)
    raise_friction(m, jam, work)
    fill_matrix(work, m, elements)
    fill_rhs(work, m, elements, work.b)
    nudged = perturb_approach(m, jam, work)
    nudged = _keep_sliding(m, work) or nudged
    note_posed(work, m, elements, 0, Level.COMPRESSION)
    rung = solve_contacts(work, m, elements)
    if nudged and rung != Solver.FAILED:
        fill_rhs(work, m, elements, work.b)
        keep_basis(work, m, elements, rung)
    read_forces(work, m, elements, work.force)
    return rung != Solver.FAILED, elements


@kernel
def _drop_rounding(closed, m, u, out_rates):
    """Make rates zero that are nothing but the rounding of their terms: where many contacts rest they contradict each other."""
    for i in range(m):
        terms = 0.0
        for k in range(closed.slots[i]):
            terms += (abs(closed.w_N[i, k]) + abs(closed.w_T[i, k])) * abs(u[closed.coord[i, k]])
        for row in range(2 * i, 2 * i + 2):
            if abs(out_rates[row]) <= VELOCITY_ROUNDING * terms:
                out_rates[row] = 0.0


@kernel
def raise_friction(m, jam, work):
    """Let friction grip by as little more as takes contacts that count as jammed past the bound where they are.

    They count as jammed shortly before it (`PAINLEVE`), where a force still parts their bodies, by next to nothing.
    """
    for i in range(m):
        own, both = work.G[2 * i, 2 * i], work.G[2 * i, 2 * i + 1]
        if jam > 0.0 and work.tangent[i] >= 0 and abs(own - work.drag[i] * both) <= PAINLEVE * own:
            work.drag[i] = (1.0 + PAINLEVE) * own / both
            work.width[work.tangent[i]] = 2.0 * work.drag[i]


@kernel
def perturb_approach(m, jam, work):
    """Let the contacts that slide at a standstill of their gap (|rate| <= `jam`) approach a little; True if there are any.

    The impulses of a jam do not vanish with the speed of approach; which contacts carry them is found this way.
    """
    found = False
    if not jam > 0.0:
        return found  # where something approaches, a gap that stands still needs no nudge, even one at exactly zero
    for i in range(m):
        slip = abs(work.b[2 * i + 1])
        if work.tangent[i] >= 0 and abs(work.b[2 * i]) <= jam and slip > jam:
            work.rhs[i] -= NUDGE * slip * work.unit[i]
            found = True
    return found


@kernel
def _keep_sliding(m, work):
    """Let contacts whose slip is a multiple of their gap rate end the compression still sliding a little; True if any does.

    Where w_T is parallel to w_N (one rotor or slider against the frame, sliders on parallel axes) slip and approach stop
    together, and Coulomb's law leaves the share of friction open. The contact slid all the time: friction is at its bound.
    """
    found = False
    for i in range(m):
        e = work.tangent[i]
        if e >= 0 and is_parallel(work, i):
            work.rhs[m + e] += NUDGE * work.b[2 * i + 1] * work.unit[i]
            found = True
    return found


@kernel
def is_parallel(work, i):
    """True if the directions of contact i's normal and friction force are parallel to rounding."""
    N, T, both = work.G[2 * i, 2 * i], work.G[2 * i + 1, 2 * i + 1], work.G[2 * i, 2 * i + 1]
    return both * both > (1.0 - PARALLEL) * N * T > 0.0


@kernel
def _expand(model, closed, m, restitution, elements, work):
    """Impulses of the expansion into `work.more`; True if they are found.

    Unknowns: Lambda_NP = Lambda_NE - eps_N Lambda_NC and the distance of Lambda_TE from the lower end of its interval.
    """
    for i in range(m):
        normal, tangential = work.force[2 * i], work.force[2 * i + 1]
        work.more[2 * i], work.more[2 * i + 1] = restitution[i] * normal, 0.0
        e = work.tangent[i]
        if e >= 0:
            law = _law(model, closed, i)
            low, width, span, shift, returned = interval(law, restitution[i], normal, tangential)
            work.drag[i], work.more[2 * i + 1] = low, shift
            add_element(work, i, e, (width, span, shift))
            work.offset[i] = law.nu * returned
        else:
            work.offset[i] = 0.0
    for row in range(2 * m):
        total = work.b[row]
        for j in range(2 * m):
            total += work.G[row, j] * (work.force[j] + work.more[j])
        work.rates[row] = total
    for e in range(elements):
        row = element_row(work, m, e)
        for i in range(m):
            work.rates[row] -= work.G[row, 2 * i + 1] * work.offset[i]
    fill_matrix(work, m, elements)
    fill_rhs(work, m, elements, work.rates)
    work.posed.level = Level.EXPANSION
    rung = solve_contacts(work, m, elements)
    for i in range(m):
        extra = work.unit[i] * work.x[i]
        work.more[2 * i] += extra
        e = work.tangent[i]
        if e >= 0:
            work.more[2 * i + 1] += work.unit[i] * work.x[m + e] - work.drag[i] * extra
    return rung != Solver.FAILED


@kernel
def impact(model, closed, m, restitution, jam, work, out_u):
    """Two-phase impact of the first m closed contacts; `out_u` holds the velocities before and gets those after.

    `restitution[i]` is eps_N of row i. With `jam` > 0 (m/s) contacts that slide while their gap stands still, to that
    speed, are jammed: the impulses that stop them are found although nothing approaches. Total impulses N, T are left in
    `work.force`, rates before the impact in `work.b`. True if it is solved; the velocities are changed only then.
    """
    solved, elements = _compress(model, closed, m, out_u, jam, work)
    if not solved:
        restore_directions(work, 2 * m, work.b)
        return False
    returns = False
    for i in range(m):
        if restitution[i] > 0.0 and work.force[2 * i] > 0.0:
            returns = True
    if returns:
        if not _expand(model, closed, m, restitution, elements, work):
            restore_directions(work, 2 * m, work.b)
            return False
        for row in range(2 * m):
            work.force[row] += work.more[row]
    restore_directions(work, 2 * m, work.b)
    apply(closed, m, work.force, work.inverse, out_u)
    return True


@kernel
def plastic_impact(model, closed, m, time, u, work):
    """Impulses of the compression over a time in which the forces `work.h` act on `work.inverse`, into `work.force`.

    The compression of the rates that free motion over `time` would lead to (a step of Moreau's scheme at fixed positions).
    True if they are found.
    """
    elements = _begin(model, closed, m, work)
    fill_delassus(closed, m, work)
    contact_velocities(closed, m, u, work.b)
    gap_accelerations(model, closed, m, work, work.loaded, work.size)
    for row in range(2 * m):
        work.b[row] += time * work.loaded[row]
    reverse_directions(work, m, 2 * m, elements, work.b)
    fill_matrix(work, m, elements)
    fill_rhs(work, m, elements, work.b)
    note_posed(work, m, elements, 0, Level.COMPRESSION)
    rung = solve_contacts(work, m, elements)
    read_forces(work, m, elements, work.force)
    restore_directions(work, 2 * m, work.b)
    return rung != Solver.FAILED


@kernel
def energy_change(m, work):
    """(T after minus T before of the impact just solved, sum of its terms without sign), J.

    Lambda·(rates before + half of G Lambda).
    """
    change, terms = 0.0, 0.0
    for row in range(2 * m):
        jump = 0.0
        for j in range(2 * m):
            jump += work.G[row, j] * work.force[j]
        change += work.force[row] * (work.b[row] + 0.5 * jump)
        terms += abs(work.force[row]) * (abs(work.b[row]) + 0.5 * abs(jump))
    return change, terms
