"""What are the velocities after an impact?

Two phases over all closed contacts at once: compression ends when no contact approaches any more; expansion gives back
at least the share eps_N of each compression impulse (Poisson). Friction acts in both, on impulses: Coulomb's law in the
compression, the scene's tangential law in the expansion (Pfeiffer & Glocker 1996, ch. 8; docs/theory/method.md 2.6,
docs/theory/laws.md).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.dynamics.acceleration import gap_accelerations
from watchsim.dynamics.delassus import apply, contact_velocities, fill_delassus, inverse_mass
from watchsim.dynamics.friction import (
    add_element,
    choose_signs,
    element_row,
    fill_matrix,
    fill_rhs,
    friction_bound,
    keep_basis,
    law_of,
    read_forces,
    solve_contacts,
)
from watchsim.dynamics.lcp import Level, Solver
from watchsim.jit import by_reference, kernel
from watchsim.model import PG1996, SHIFTED
from watchsim.tolerances import NO_TANGENTIAL, NUDGE, PAINLEVE, PARALLEL, VELOCITY_ROUNDING

Array = NDArray[np.float64]


class ImpactPhases(NamedTuple):
    """The two phases of an impact; rows N, T of each contact, m/s and N·s."""

    rates: Array  # before the compression
    impulse: Array  # of the compression, then of both phases
    more: Array  # of the expansion
    between: Array  # rates at the start of the expansion, its least impulses included
    offset: Array  # by contact: tangential impulse whose slip moves the corner of the law pg1996


ImpactPhasesRef = by_reference(ImpactPhases, __name__)


def impact_phases(room: int) -> ImpactPhases:
    """For `room` closed contacts."""
    rates, impulse, more, between = np.zeros((4, 2 * room))
    return ImpactPhases(rates, impulse, more, between, np.zeros(room))


@kernel
def interval(law, mu, restitution, normal, tangential):
    """Where the friction impulse of the expansion may lie: (L, l, l_0, c, returned), see friction.py and docs/theory/laws.md.

    From c - L Lambda_NP to c - L Lambda_NP + l Lambda_NP + l_0, where Lambda_NP is what the normal impulse has beyond eps_N
    times that of the compression. `restitution` is eps_N as used, the impulses are those of the compression; `returned` is the
    tangential impulse eps_N eps_T Lambda_TC, whose slip pg1996 may offset by nu.
    """
    back = restitution * normal
    if law.kind == SHIFTED:
        # A smaller eps_N (after an energy gain, at an accumulation) takes eps_T with it.
        share = min(law.tangential, restitution)
        radius = mu * (restitution - share) * normal
        return mu, 2.0 * mu, 2.0 * radius, share * tangential - radius, 0.0
    if law.kind != PG1996:
        return mu, 2.0 * mu, 2.0 * mu * back, -mu * back, 0.0
    returned = restitution * law.tangential * tangential
    least = abs(returned)
    span = max(0.0, mu * back - least)
    if normal <= 0.0 or abs(tangential) <= NO_TANGENTIAL * mu * normal:
        return 0.5 * mu, mu, span, -0.5 * span, returned
    if tangential > 0.0:
        return 0.0, mu, span, least, returned
    return mu, mu, span, -mu * back, returned


@kernel
def impact(model, closed, m, restitution, jam_speed, system, problem, phases, out_u):
    """Two-phase impact of the first m closed contacts; `out_u` holds the velocities before and gets those after.

    `restitution[i]` is eps_N of row i. With `jam_speed` > 0 (m/s) contacts that slide while their gap stands still, to that
    speed, are jammed: the impulses that stop them are found although nothing approaches. Total impulses are left in
    `phases.impulse`, rates before the impact in `phases.rates`. True if it is solved; the velocities are changed only then.
    """
    for j in range(len(model.coordinates)):
        system.inverse[j] = inverse_mass(model.coordinates[j])
    fill_delassus(closed, m, system.inverse, system.G)
    contact_velocities(closed, m, out_u, phases.rates)
    _drop_rounding(closed, m, out_u, phases.rates)
    elements = _elements(model, closed, m, phases.rates, problem)
    if not _compress(m, elements, jam_speed, system.G, problem, phases):
        return False
    returns = False
    for i in range(m):
        returns = returns or (restitution[i] > 0.0 and phases.impulse[2 * i] > 0.0)
    if returns:
        if not _expand(model, closed, m, restitution, elements, system.G, problem, phases):
            return False
        for row in range(2 * m):
            phases.impulse[row] += phases.more[row]
    apply(closed, m, phases.impulse, system.inverse, out_u)
    return True


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
def _elements(model, closed, m, rates, problem):
    """Coulomb friction within ± mu Lambda_N for every contact that has any; returns the number of elements.

    mu is that of the slip before the impact.
    """
    elements = 0
    for i in range(m):
        problem.drag[i] = friction_bound(law_of(model, closed.ids[i]), rates[2 * i + 1])
        problem.element[i] = -1
        if problem.drag[i] > 0.0:
            problem.element[i] = elements
            elements = add_element(problem, i, elements, (2.0 * problem.drag[i], 0.0, 0.0))
    return elements


@kernel
def _compress(m, elements, jam_speed, G, problem, phases):
    """Impulses of the compression into `phases.impulse`; True if they are found."""
    choose_signs(G, phases.rates, m, 2 * m, elements, problem)
    if jam_speed > 0.0:
        raise_friction(G, m, problem)
    fill_matrix(G, m, elements, problem)
    fill_rhs(phases.rates, m, elements, problem)
    # Where something approaches, a gap that stands still needs no perturbation, even one at exactly zero.
    perturbed = jam_speed > 0.0 and perturb_approach(phases.rates, m, jam_speed, problem)
    perturbed = _keep_sliding(G, phases.rates, m, problem) or perturbed
    solver = solve_contacts(m, elements, 0, Level.COMPRESSION, problem)
    if perturbed and solver != Solver.FAILED:
        keep_basis(phases.rates, m, elements, solver, problem)
    read_forces(m, elements, problem, phases.impulse)
    return solver != Solver.FAILED


@kernel
def raise_friction(G, m, problem):
    """Let friction grip by as little more as takes contacts that count as jammed past the bound where they are.

    They count as jammed shortly before it (`PAINLEVE`), where a force still parts their bodies, by next to nothing.
    """
    for i in range(m):
        own, both = G[2 * i, 2 * i], problem.friction_sign[2 * i + 1] * G[2 * i, 2 * i + 1]
        if problem.element[i] >= 0 and abs(own - problem.drag[i] * both) <= PAINLEVE * own:
            problem.drag[i] = (1.0 + PAINLEVE) * own / both
            problem.width[problem.element[i]] = 2.0 * problem.drag[i]


@kernel
def perturb_approach(rates, m, jam_speed, problem):
    """Let the contacts that slide at a standstill of their gap (|rate| <= `jam_speed`) approach a little; True if any does.

    The impulses of a jam do not vanish with the speed of approach; which contacts carry them is found this way.
    """
    found = False
    for i in range(m):
        slip = abs(rates[2 * i + 1])
        if problem.element[i] >= 0 and abs(rates[2 * i]) <= jam_speed < slip:
            problem.rhs[i] -= NUDGE * slip * problem.unit[i]
            found = True
    return found


@kernel
def _keep_sliding(G, rates, m, problem):
    """Let contacts whose slip is a multiple of their gap rate end the compression still sliding a little; True if any does.

    Where w_T is parallel to w_N (one rotor or slider against the frame, sliders on parallel axes) slip and approach stop
    together, and Coulomb's law leaves the share of friction open. The contact slid all the time: friction is at its bound.
    """
    found = False
    for i in range(m):
        e, T = problem.element[i], 2 * i + 1
        if e >= 0 and is_parallel(G, i):
            problem.rhs[m + e] += NUDGE * (problem.friction_sign[T] * rates[T]) * problem.unit[i]
            found = True
    return found


@kernel
def is_parallel(G, i):
    """True if the directions of contact i's normal and friction force are parallel to rounding."""
    N, T, both = G[2 * i, 2 * i], G[2 * i + 1, 2 * i + 1], G[2 * i, 2 * i + 1]
    return both * both > (1.0 - PARALLEL) * N * T > 0.0


@kernel
def _expand(model, closed, m, restitution, elements, G, problem, phases):
    """Impulses of the expansion into `phases.more`; True if they are found.

    Unknowns: Lambda_NP = Lambda_NE - eps_N Lambda_NC and the distance of Lambda_TE from the lower end of its interval.
    """
    sign = problem.friction_sign
    for i in range(m):
        N, T, e = 2 * i, 2 * i + 1, problem.element[i]
        normal, tangential = phases.impulse[N], sign[T] * phases.impulse[T]
        phases.more[N], phases.more[T], phases.offset[i] = restitution[i] * normal, 0.0, 0.0
        if e >= 0:
            law = law_of(model, closed.ids[i])
            mu = friction_bound(law, phases.rates[T])
            low, width, span, shift, returned = interval(law, mu, restitution[i], normal, tangential)
            problem.drag[i], phases.more[T], phases.offset[i] = low, sign[T] * shift, sign[T] * (law.nu * returned)
            add_element(problem, i, e, (width, span, shift))
    for row in range(2 * m):
        total = phases.rates[row]
        for j in range(2 * m):
            total += G[row, j] * (phases.impulse[j] + phases.more[j])
        phases.between[row] = total
    for e in range(elements):
        row = element_row(problem, m, e)
        for i in range(m):
            phases.between[row] -= G[row, 2 * i + 1] * phases.offset[i]
    fill_matrix(G, m, elements, problem)
    fill_rhs(phases.between, m, elements, problem)
    solver = solve_contacts(m, elements, 0, Level.EXPANSION, problem)
    for i in range(m):
        N, T, e = 2 * i, 2 * i + 1, problem.element[i]
        extra = problem.unit[i] * problem.x[i]
        phases.more[N] += extra
        if e >= 0:
            phases.more[T] += sign[T] * (problem.unit[i] * problem.x[m + e] - problem.drag[i] * extra)
    return solver != Solver.FAILED


@kernel
def plastic_impact(model, closed, m, time, u, system, problem, phases):
    """Impulses of the compression over a time in which the forces `system.h` act, into `phases.impulse`; True if found.

    The compression of the rates that free motion over `time` (s) would lead to (a step of Moreau's scheme at fixed positions).
    """
    fill_delassus(closed, m, system.inverse, system.G)
    contact_velocities(closed, m, u, phases.rates)
    elements = _elements(model, closed, m, phases.rates, problem)
    gap_accelerations(model, closed, m, system)
    for row in range(2 * m):
        phases.rates[row] += time * system.b[row]
    choose_signs(system.G, phases.rates, m, 2 * m, elements, problem)
    fill_matrix(system.G, m, elements, problem)
    fill_rhs(phases.rates, m, elements, problem)
    solver = solve_contacts(m, elements, 0, Level.COMPRESSION, problem)
    read_forces(m, elements, problem, phases.impulse)
    return solver != Solver.FAILED


@kernel
def energy_gain(m, G, rates, impulse):
    """(kinetic energy that m contacts' impulses add to motion at these rates, sum of its terms without sign), J.

    Lambda·(rates before + half of G Lambda).
    """
    gain, terms = 0.0, 0.0
    for row in range(2 * m):
        jump = 0.0
        for j in range(2 * m):
            jump += G[row, j] * impulse[j]
        gain += impulse[row] * (rates[row] + 0.5 * jump)
        terms += abs(impulse[row]) * (abs(rates[row]) + 0.5 * abs(jump))
    return gain, terms
