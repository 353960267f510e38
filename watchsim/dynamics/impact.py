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
from watchsim.dynamics.bearings import LOAD_ROUNDS, has_settled, lay_on, load_on, press_contacts, settled_share
from watchsim.dynamics.coupled_loads import (
    aim_first,
    approach_seized,
    fill_coupled,
    keep_turning,
    read_coupled,
    starts,
    trace_loads,
    turn_to_loads,
)
from watchsim.dynamics.delassus import apply, contact_velocities, fill_bearings, fill_delassus, inverse_mass
from watchsim.dynamics.friction import (
    add_element,
    choose_signs,
    element_row,
    fill_matrix,
    fill_rhs,
    friction_bound,
    keep_basis,
    law_of,
    load_bearings,
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

    bearing: Array  # by coordinate: impulse of friction in a bearing with a load, N·m·s, of both phases
    limit: Array  # the same, of bearings that the contacts strike: its largest magnitude in the phase
    rates: Array  # before the compression; rows of bearings behind those of the contacts
    impulse: Array  # of the compression, then of both phases
    more: Array  # of the expansion
    between: Array  # rates at the start of the expansion, its least impulses included
    friction: Array  # by contact: coefficient at its slip before the impact
    offset: Array  # by contact: tangential impulse whose slip moves the corner of the law pg1996


ImpactPhasesRef = by_reference(ImpactPhases, __name__)


def impact_phases(room: int, coordinates: int) -> ImpactPhases:
    """For `room` closed contacts and as many bearings as coordinates."""
    rates, impulse, more, between = np.zeros((4, 2 * room + coordinates))
    return ImpactPhases(np.zeros(coordinates), np.zeros(coordinates), rates, impulse, more, between, *np.zeros((2, room)))


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
def impact(model, closed, m, restitution, speeds, system, problem, phases, out_u):
    """Two-phase impact of the first m closed contacts; `out_u` holds the velocities before and gets those after.

    `restitution[i]` is eps_N of row i. `speeds`, m/s: (`jam_speed`, slips up to this are rest). With `jam_speed` > 0 contacts
    that slide while their gap stands still, to that speed, are jammed: the impulses that stop them are found although nothing
    approaches. Total impulses are left in `phases.impulse`, rates before the impact in `phases.rates`. True if it is solved;
    the velocities are changed only then.
    """
    jam_speed, still = speeds
    for j in range(len(model.coordinates)):
        system.inverse[j] = inverse_mass(model.coordinates[j])
    fill_delassus(closed, m, system.inverse, system.G)
    contact_velocities(closed, m, out_u, phases.rates)
    _drop_rounding(closed, m, out_u, phases.rates)
    bearings = _struck_bearings(model, closed, m, out_u, system, problem, phases)
    elements, last = _elements(model, closed, m, still, problem, phases), problem.last
    sizes, last.coupled = (elements, bearings), 0
    if not last.seized:
        for number in range(LOAD_ROUNDS):
            _bear(m, elements, bearings, problem, phases)
            if not _compress(m, sizes, jam_speed, system.G, problem, phases):
                return False
            if _bearings_settle(model, closed, m, bearings, phases.impulse, number, system, problem, phases):
                break
    if last.seized or last.jammed:
        trace_loads(model, closed, m, bearings, 0.0, system, problem)
        for p in range(bearings if last.seized else 0):
            problem.pivots.grip[p] *= 1.0 + RAISED * last.near
        _couple(model, closed, m, (False, restitution, jam_speed), sizes, system.G, problem, phases)
    returns = False
    for i in range(m):
        returns = returns or (restitution[i] > 0.0 and phases.impulse[2 * i] > 0.0)
    if returns and not last.jammed:
        last.coupled = 0
        for number in range(LOAD_ROUNDS):
            if not _expand(model, closed, m, restitution, sizes, system.G, problem, phases):
                return False
            if _bearings_settle(model, closed, m, bearings, phases.more, number, system, problem, phases):
                break
        if last.jammed:
            trace_loads(model, closed, m, bearings, 0.0, system, problem)
            _couple(model, closed, m, (True, restitution, jam_speed), sizes, system.G, problem, phases)
        for row in range(2 * m + bearings):
            phases.impulse[row] += phases.more[row]
    last.coupled = 0
    if last.jammed:
        return False
    apply(closed, m, phases.impulse, system.inverse, out_u)
    for p in range(bearings):
        i = problem.bearing[p]
        phases.bearing[i] = phases.impulse[2 * m + p]
        out_u[i] += system.inverse[i] * phases.bearing[i]
    return True


# Bearings with a load: an impulse on a body is one on its pivot, and makes an impulse of friction there, within grip |R| of
# each phase. As with forces (bearings.py) the load goes with the friction, and both are found in turn.


@kernel
def _struck_bearings(model, closed, m, u, system, problem, phases):
    """List the bearings with a load on whose bodies the m contacts act, with their rows of G and of the rates; how many?"""
    bearings, problem.last.jammed = 0, 0
    for p in range(len(model.bearings)):
        j, struck = model.bearings[p].coordinate, False
        phases.bearing[j], phases.limit[j] = 0.0, 0.0
        for i in range(m):
            for k in range(closed.slots[i]):
                struck = struck or closed.coord[i, k] == j
        if struck:
            problem.bearing[bearings], phases.rates[2 * m + bearings] = j, u[j]
            bearings += 1
    fill_bearings(closed, m, problem.bearing, bearings, system.inverse, system.G)
    return bearings


@kernel
def _bear(m, elements, bearings, problem, phases):
    """Make elements, behind those of the contacts, of the bearings within their limits."""
    for p in range(bearings):
        limit = phases.limit[problem.bearing[p]]
        add_element(problem, m + p, elements + p, (0.0, 2.0 * limit, -limit))


@kernel
def _bearings_settle(model, closed, m, bearings, impulse, number, system, problem, phases):
    """Set the limits to what the impulses of a phase press on the pivots; True if they were that before.

    After the last round without that `problem.last.jammed` is 1.
    """
    if bearings == 0:
        return True
    lay_on(model, 0.0, system)
    press_contacts(model, closed, m, impulse, system)
    worst = 0.0
    for p in range(len(model.bearings)):
        for k in range(bearings):
            j = model.bearings[p].coordinate
            if problem.bearing[k] == j:
                jump = impulse[2 * m + k]
                for i in range(m):
                    for slot in range(closed.slots[i]):
                        if closed.coord[i, slot] == j:
                            jump += closed.w_N[i, slot] * impulse[2 * i] + closed.w_T[i, slot] * impulse[2 * i + 1]
                limit = model.bearings[p].grip * load_on(system, p, jump * system.inverse[j])
                worst = max(worst, settled_share(limit - phases.limit[j], max(limit, phases.limit[j])))
                phases.limit[j] = limit
    settled = has_settled(worst, number)
    problem.last.jammed = 1 if number == LOAD_ROUNDS - 1 and not settled else 0
    return settled


@kernel
def _couple(model, closed, m, phase, sizes, G, problem, phases):
    """Find the impulses of a phase and the loads that they make as one; `problem.last.jammed` is 1 where there are none.

    `phase`: (is it the expansion?, restitution, `jam_speed`).
    """
    (expands, restitution, jam_speed), (elements, bearings) = phase, sizes
    last, found = problem.last, phases.more if expands else phases.impulse
    last.coupled, last.jammed = 1, 1
    for p in range(bearings):
        problem.pivots.slides[p] = 0.0
        add_element(problem, m + p, elements + p, (0.0, 0.0, 0.0))
    turn_to_loads(m, bearings, found, problem)
    for start in range(starts(m)):
        aim_first(closed, m, bearings, start, problem)
        for number in range(LOAD_ROUNDS):
            if expands:
                solved = _expand(model, closed, m, restitution, sizes, G, problem, phases)
            else:
                solved = _compress(m, sizes, jam_speed, G, problem, phases)
            if not solved:
                break
            if has_settled(turn_to_loads(m, bearings, found, problem), number):
                last.jammed = 0
                return


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
def _elements(model, closed, m, still, problem, phases):
    """Coulomb friction within ± mu Lambda_N for every contact that has any; returns the number of elements.

    mu is that of the slip before the impact: of rest up to `still` (m/s), where rounding would choose.
    """
    elements = 0
    for i in range(m):
        slip = phases.rates[2 * i + 1]
        phases.friction[i] = friction_bound(law_of(model, closed.ids[i]), slip if abs(slip) > still else 0.0)
        problem.drag[i] = phases.friction[i]
        problem.element[i] = -1
        if problem.drag[i] > 0.0:
            problem.element[i] = elements
            elements = add_element(problem, i, elements, (2.0 * problem.drag[i], 0.0, 0.0))
    return elements


@kernel
def _compress(m, sizes, jam_speed, G, problem, phases):
    """Impulses of the compression into `phases.impulse`; True if they are found. `sizes`: elements of contacts, bearings."""
    bearings, elements = sizes[1], sizes[0] + sizes[1]
    coupled, all_sizes = problem.last.coupled == 1, (elements, bearings, bearings)
    choose_signs(G, phases.rates, m, 2 * m + bearings, elements, problem)
    if jam_speed > 0.0:
        raise_friction(G, m, problem)
    if coupled:
        problem.pivots.base[:] = 0.0
        fill_coupled(G, phases.rates, m, all_sizes, problem)
    else:
        fill_matrix(G, m, elements, problem)
        load_bearings(G, phases.rates, m, elements, bearings, problem)
        fill_rhs(problem.loaded, m, elements, problem)
    # Where something approaches, a gap that stands still needs no perturbation, even one at exactly zero.
    perturbed = jam_speed > 0.0 and perturb_approach(phases.rates, m, jam_speed, problem)
    perturbed = _keep_sliding(G, phases.rates, m, problem) or perturbed
    if coupled:
        perturbed = keep_turning(G, phases.rates, m, all_sizes, problem) or perturbed
        perturbed = (jam_speed > 0.0 and approach_seized(G, phases.rates, m, bearings, jam_speed, problem)) or perturbed
    solver = solve_contacts(m, elements, bearings, Level.COMPRESSION, problem)
    if perturbed and solver != Solver.FAILED:
        keep_basis(problem.loaded, m, elements, solver, problem)
    if coupled:
        read_coupled(m, all_sizes, problem, phases.impulse)
    else:
        read_forces(m, elements, problem, phases.impulse)
    return solver != Solver.FAILED


RAISED = 3.0  # times `near`: what takes contacts past a bound that depends on the friction of all of them


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
        elif problem.element[i] >= 0 and (problem.last.together == 1 or problem.last.seized == 1):
            problem.drag[i] *= 1.0 + RAISED * problem.last.near
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
def _expand(model, closed, m, restitution, sizes, G, problem, phases):
    """Impulses of the expansion into `phases.more`; True if they are found. `sizes`: elements of contacts, bearings.

    Unknowns: Lambda_NP = Lambda_NE - eps_N Lambda_NC and the distance of Lambda_TE from the lower end of its interval.
    """
    sign, bearings, elements = problem.friction_sign, sizes[1], sizes[0] + sizes[1]
    rows, coupled, all_sizes = 2 * m + bearings, problem.last.coupled == 1, (elements, bearings, bearings)
    if not coupled:
        _bear(m, sizes[0], bearings, problem, phases)
    for p in range(bearings):
        phases.more[2 * m + p] = sign[2 * m + p] * problem.shift[sizes[0] + p]
    for i in range(m):
        N, T, e = 2 * i, 2 * i + 1, problem.element[i]
        normal, tangential = phases.impulse[N], sign[T] * phases.impulse[T]
        phases.more[N], phases.more[T], phases.offset[i] = restitution[i] * normal, 0.0, 0.0
        if e >= 0:
            law = law_of(model, closed.ids[i])
            low, width, span, shift, returned = interval(law, phases.friction[i], restitution[i], normal, tangential)
            problem.drag[i], phases.more[T], phases.offset[i] = low, sign[T] * shift, sign[T] * (law.nu * returned)
            add_element(problem, i, e, (width, span, shift))
    for row in range(rows):
        total = phases.rates[row]
        for j in range(rows):
            total += G[row, j] * (phases.impulse[j] + phases.more[j])
        phases.between[row] = total
    for e in range(sizes[0]):
        row = element_row(problem, m, e)
        for i in range(m):
            phases.between[row] -= G[row, 2 * i + 1] * phases.offset[i]
    if coupled:
        for row in range(2 * m):
            problem.pivots.base[row] = phases.more[row]
        fill_coupled(G, phases.between, m, all_sizes, problem)
        solver = solve_contacts(m, elements, bearings, Level.EXPANSION, problem)
        read_coupled(m, all_sizes, problem, phases.more)
        return solver != Solver.FAILED
    fill_matrix(G, m, elements, problem)
    fill_rhs(phases.between, m, elements, problem)
    solver = solve_contacts(m, elements, bearings, Level.EXPANSION, problem)
    for e in range(sizes[0], elements):
        row = element_row(problem, m, e)
        phases.more[row] += sign[row] * (problem.unit[problem.block[e]] * problem.x[m + e])
    for i in range(m):
        N, T, e = 2 * i, 2 * i + 1, problem.element[i]
        extra = problem.unit[i] * problem.x[i]
        phases.more[N] += extra
        if e >= 0:
            phases.more[T] += sign[T] * (problem.unit[i] * problem.x[m + e] - problem.drag[i] * extra)
    return solver != Solver.FAILED


@kernel
def plastic_impact(model, closed, m, time, still, u, system, problem, phases):
    """Impulses of the compression over a time in which the forces `system.h` act, into `phases.impulse`; True if found.

    The compression of the rates that free motion over `time` (s) would lead to (a step of Moreau's scheme at fixed positions).
    Slips up to `still` (m/s) are rest.
    """
    fill_delassus(closed, m, system.inverse, system.G)
    contact_velocities(closed, m, u, phases.rates)
    elements = _elements(model, closed, m, still, problem, phases)
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
def energy_gain(rows, G, rates, impulse):
    """(kinetic energy that impulses by row of G add to motion at these rates, sum of its terms without sign), J.

    Lambda·(rates before + half of G Lambda).
    """
    gain, terms = 0.0, 0.0
    for row in range(rows):
        jump = 0.0
        for j in range(rows):
            jump += G[row, j] * impulse[j]
        gain += impulse[row] * (rates[row] + 0.5 * jump)
        terms += abs(impulse[row]) * (abs(rates[row]) + 0.5 * abs(jump))
    return gain, terms
