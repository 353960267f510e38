"""How are impacts resolved in Moreau's time stepping?

In two phases: what approaches is stopped (compression, Coulomb's law), then thrown back (expansion, Poisson's law with the
scene's tangential law). Where that gains energy, less is thrown back (docs/theory/method.md 2.7).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import point_of
from watchsim.dynamics.delassus import (
    apply,
    contact_velocities,
    copy,
    drive_through_contacts,
    inverse_mass,
)
from watchsim.dynamics.forces import spring_pull
from watchsim.dynamics.friction import friction_at, friction_bound, law_of, size_class
from watchsim.dynamics.moving_frame import inertial_on
from watchsim.dynamics.redundant import solve_small
from watchsim.jit import by_reference, kernel
from watchsim.model import PG1996, SHIFTED
from watchsim.simulation.closed_contacts import kinetic_energy
from watchsim.simulation.scratch import keep_event
from watchsim.simulation.state import EventKind
from watchsim.tolerances import ENERGY_GAIN, NO_TANGENTIAL, NUDGE, PARALLEL, RANK, SETTLED

# What do percussions at contacts and in bearings do to velocities, and velocities to the rates there?
#
# Rows as in `percussion_laws`: N, T of each of m closed contacts, then the bearings with dry friction.


@kernel
def rates_of(work, m, bearings, u, out_rates):
    """Rates at velocities u."""
    contact_velocities(work.closed, m, u, out_rates)
    for k in range(bearings):
        out_rates[2 * m + k] = u[work.dry[k]]


@kernel
def push(work, m, bearings, P, out_u):
    """Add what the percussions P do to the velocities; `work.inverse` is one over each coordinate's mass."""
    apply(work.closed, m, P, work.inverse, out_u)
    for k in range(bearings):
        out_u[work.dry[k]] += work.inverse[work.dry[k]] * P[2 * m + k]


@kernel
def fill_mobility(work, m, bearings):
    """G of `work.laws`: the rates that unit percussions make, one after another."""
    laws, rows = work.laws, 2 * m + bearings
    laws.trial[:] = 0.0
    for column in range(rows):
        laws.trial[column] = 1.0
        work.change[:] = 0.0
        push(work, m, bearings, laws.trial, work.change)
        rates_of(work, m, bearings, work.change, laws.step)
        for row in range(rows):
            laws.G[row, column] = laws.step[row]
        laws.trial[column] = 0.0


# What may the percussions of a step be, and how far from it are they?
#
# Rows are N, T of each of the m closed contacts, then one for each bearing with dry friction. Percussions P make rates b + G
# P. A normal percussion is at least `low`, and more only where its rate is zero. A tangential one lies within ends[i, 0] +
# ends[i, 1] N and ends[i, 2] + ends[i, 3] N, N the normal percussion of its contact, that of a bearing within ends[m + k, 0]
# and ends[m + k, 2]: at the lower end where its rate is positive, at the upper one where that is negative.

Array = NDArray[np.float64]


class Laws(NamedTuple):
    """The laws in SI units, the percussions P that obey them, and room for `projected_newton` to work in."""

    G: Array  # (rows, rows)
    b: Array
    low: Array  # (contacts,)
    ends: Array  # (contacts + bearings, 4)
    P: Array
    trial: Array
    step: Array
    right: Array
    J: Array  # (rows, rows)
    scale: Array
    order: NDArray[np.int64]


LawsRef = by_reference(Laws, __name__)


def laws(contacts: int, bearings: int) -> Laws:
    """Room for that many contacts and bearings."""
    rows = 2 * contacts + bearings
    by_row = {name: np.zeros(rows) for name in ("b", "P", "trial", "step", "right", "scale")}
    square = {name: np.zeros((rows, rows)) for name in ("G", "J")}
    low, ends, order = np.zeros(contacts), np.zeros((contacts + bearings, 4)), np.zeros(rows, np.int64)
    return Laws(low=low, ends=ends, order=order, **square, **by_row)


@kernel
def cone(ends, i, friction):
    """Coulomb's law for contact i."""
    ends[i, 0], ends[i, 1], ends[i, 2], ends[i, 3] = 0.0, -friction, 0.0, friction


@kernel
def improvement(laws, rows, row, P):
    """What P[row] would have to be to end its own rate."""
    rate = laws.b[row]
    for column in range(rows):
        rate += laws.G[row, column] * P[column]
    return P[row] - rate / laws.G[row, row]


@kernel
def bounds(laws, m, row, P):
    """Between which values P[row] may be."""
    if row >= 2 * m:
        return laws.ends[row - m, 0], laws.ends[row - m, 2]
    i = row // 2
    if row % 2 == 0:
        return laws.low[i], math.inf
    ends, normal = laws.ends, P[row - 1]
    return ends[i, 0] + ends[i, 1] * normal, ends[i, 2] + ends[i, 3] * normal


@kernel
def improved(laws, m, rows, row, P):
    """P[row] changed by what would end its own rate, and put back where it may be."""
    least, most = bounds(laws, m, row, P)
    return min(most, max(least, improvement(laws, rows, row, P)))


@kernel
def size(laws, rows, P):
    """The largest percussion, or what it takes to stop the fastest rate; each times the root of G's diagonal."""
    largest = 0.0
    for row in range(rows):
        if laws.G[row, row] > 0.0:
            root = laws.G[row, row] ** 0.5
            largest = max(largest, abs(P[row]) * root, abs(laws.b[row]) / root)
    return largest


@kernel
def residual(laws, m, rows):
    """How far P is from its own projected improvement, as a share of its size."""
    worst, scale = 0.0, size(laws, rows, laws.P)
    for row in range(rows):
        if laws.G[row, row] > 0.0:
            worst = max(worst, abs(improved(laws, m, rows, row, laws.P) - laws.P[row]) * laws.G[row, row] ** 0.5)
    return worst / scale if scale > 0.0 else 0.0


# Which percussions obey the laws, where relaxation crawls? Newton's method on the same projections.
#
# Who sticks, slips or parts is read from each row's projected improvement; in that mode the laws are linear equations, whose
# solution is the next guess (P. Alart, A. Curnier, Comput. Methods Appl. Mech. Engrg. 92, 1991). Redundant contacts make the
# equations singular: what they leave open stays as it was.

MODES = 20  # guesses of who sticks, slips or parts, before relaxation goes on


@kernel
def _equation(laws, m, rows, row):
    """The equation of one row for the change of `laws.trial`, as long as its mode; returns what the row is short of its law."""
    J, G, P = laws.J, laws.G, laws.trial
    own = G[row, row]
    for column in range(rows):
        J[row, column] = 0.0
    if own <= 0.0:
        J[row, row], laws.right[row], laws.scale[row] = 1.0, 0.0, 1.0
        return 0.0
    laws.scale[row] = 1.0 / own**0.5
    wanted = improvement(laws, rows, row, P)
    least, most = bounds(laws, m, row, P)
    if least < wanted < most:
        for column in range(rows):
            J[row, column] = G[row, column]
        laws.right[row] = own * (wanted - P[row])
        return abs(wanted - P[row]) * own**0.5
    end = least if wanted <= least else most
    J[row, row], laws.right[row] = own, own * (end - P[row])
    if row < 2 * m and row % 2 == 1:
        J[row, row - 1] = -own * laws.ends[row // 2, 1 if wanted <= least else 3]
    return abs(end - P[row]) * own**0.5


@kernel
def finish(laws, m, rows, settled):
    """Solve for the mode that `laws.P` suggests, and for those that follow; True, and a new `laws.P`, if they obey the laws.

    They do when their own projected improvements are below the share `settled` of their size.
    """
    copy(laws.P, laws.trial)
    for _ in range(MODES):
        short = 0.0
        for row in range(rows):
            short = max(short, _equation(laws, m, rows, row))
        if short <= settled * size(laws, rows, laws.trial):
            copy(laws.trial, laws.P)
            return True
        solve_small(laws.J, laws.right, rows, laws.scale, laws.order, laws.step, RANK)
        for row in range(rows):
            laws.trial[row] += laws.step[row]
    return False


# Which percussions keep the contacts apart and the friction within its bounds? Found by relaxation, one after another.
#
# Each percussion is the projection of its own improvement onto what it may be. This is the prox form of the laws of Signorini
# and Coulomb, Gauss-Seidel fashion. It shares no code with the complementarity solver of `dynamics`, so that the two can be
# held against each other.

SWEEPS = 20000  # at each pace
FIRST = 32  # sweeps before Newton's method is tried; again after twice as many
PACES = 4


# Largest change of a percussion in a sweep, as a share of the largest one or of what would stop the fastest contact.
@kernel
def _sweep(laws, m, rows, pace):
    """Each percussion once; returns the largest change that a full pace would make."""
    change = 0.0
    for row in range(rows):
        own = laws.G[row, row]
        if own > 0.0:
            step = improved(laws, m, rows, row, laws.P) - laws.P[row]
            change = max(change, abs(step) * own**0.5)
            laws.P[row] += pace * step
    return change


@kernel
def relax(laws, m, bearings):
    """Percussions that obey the laws of m contacts and of the bearings, from the first guess in `laws.P`.

    Returns (number of sweeps, have they settled?). Where friction couples contacts strongly, full improvements can go round
    in circles; smaller ones then settle.
    """
    rows, total, pace = 2 * m + bearings, 0, 1.0
    for _ in range(PACES):
        patience = FIRST
        for sweep in range(1, SWEEPS + 1):
            total += 1
            if _sweep(laws, m, rows, pace) <= SETTLED * size(laws, rows, laws.P):
                return total, True
            if sweep == patience:
                if finish(laws, m, rows, SETTLED):
                    return total, True
                patience *= 2
        pace *= 0.4
    return total, False


@kernel
def solve_percussions(state, m, bearings, work):
    """Relax, and count what it took."""
    sweeps, settled = relax(work.laws, m, bearings)
    state.counts.lcp += 1
    state.counts.lcp_sizes[size_class(2 * m + bearings)] += 1
    work.kept.sweeps += sweeps
    if not settled:
        state.counts.lcp_failures += 1
    work.kept.violation = max(work.kept.violation, residual(work.laws, m, 2 * m + bearings))


@kernel
def friction_cones(model, m, u, options, work):
    """Coulomb's law for all closed contacts: what slides at velocities u has the coefficient of its slip.

    Where that is less than at rest, friction the other way round, after a reversal, may hold as much as it does at rest.
    """
    for i in range(m):
        law, slip, closed = law_of(model, work.closed.ids[i]), 0.0, work.closed
        work.laws.low[i] = 0.0
        cone(work.laws.ends, i, law.friction)
        if law.drop == 0.0 and law.rise == 0.0:
            continue
        for k in range(closed.slots[i]):
            slip += closed.w_T[i, k] * u[closed.coord[i, k]]
        if slip > options.speed_zero:
            work.laws.ends[i, 1] = -friction_at(law, slip)
        elif slip < -options.speed_zero:
            work.laws.ends[i, 3] = friction_at(law, -slip)


# Bearings with a load are the first ones. The impulse of the force on a pivot is what its body's momentum changes by, less what
# contacts, weight and springs do; the friction there is within grip times that, and both are found in turn.

LOAD_SWEEPS, LOAD_STEADY, LOAD_PACES = 50, 1e-12, 6


@kernel
def within_loads(model, m, step, P, before, after, work):
    """Set how far the percussions of bearings with a load may go, from P; True if they went no further or less before.

    `before`, `after`: the velocities that P leads from and to; `step`: (the time at the middle of the step, its length, 0 at an
    impact), s.
    """
    steady, (time, h) = True, step
    for k in range(len(model.bearings)):
        bearing = model.bearings[k]
        j, pose = bearing.coordinate, work.pose[bearing.body]
        mx, my = point_of(pose, bearing.moment_x, bearing.moment_y)
        fx, fy = spring_pull(model, bearing.body, work.q, work.foreseen)
        ix, iy = inertial_on(model, bearing.body, time, work.q, work.foreseen)
        jump, turned = after[j] - before[j], h * (0.5 * (before[j] + after[j])) ** 2
        x = -jump * my - turned * mx - h * (bearing.weight_x + fx + ix)
        y = jump * mx - turned * my - h * (bearing.weight_y + fy + iy)
        for i in range(m):
            contact, kin = model.contacts[work.closed.ids[i]], work.closed.kin[i]
            for side, primitive in ((-1.0, contact.a), (1.0, contact.b)):
                if model.primitives[primitive].body == bearing.body:
                    x += side * (P[2 * i] * kin.nx - P[2 * i + 1] * kin.ny)
                    y += side * (P[2 * i] * kin.ny + P[2 * i + 1] * kin.nx)
        weight = (bearing.weight_x**2 + bearing.weight_y**2) ** 0.5
        most = bearing.grip * (x * x + y * y) ** 0.5 + h * (model.coordinates[j].coulomb - bearing.grip * weight)
        steady = steady and abs(most - work.laws.ends[m + k, 2]) <= LOAD_STEADY * most
        work.laws.ends[m + k, 0], work.laws.ends[m + k, 2] = -most, most
    return steady


@kernel
def _settle_impact(model, state, m, work):
    """Percussions of a phase of an impact, with those of the bearings with a load, into `work.laws.P`."""
    bearings = len(model.bearings)
    if bearings == 0:
        solve_percussions(state, m, 0, work)
        return
    for k in range(bearings):
        work.laws.ends[m + k, 0], work.laws.ends[m + k, 2], work.laws.P[2 * m + k] = 0.0, 0.0, 0.0
    work.foreseen[:] = 0.0
    for number in range(LOAD_PACES * LOAD_SWEEPS):
        solve_percussions(state, m, bearings, work)
        work.change[:] = 0.0
        push(work, m, bearings, work.laws.P, work.change)
        for k in range(bearings):
            work.bounds[k] = work.laws.ends[m + k, 2]
        if within_loads(model, m, (0.0, 0.0), work.laws.P, work.foreseen, work.change, work):
            return
        # Where a force passes within the circle of friction full changes overshoot ever further; smaller ones settle.
        pace = 0.5 ** (number // LOAD_SWEEPS)
        for k in range(bearings):
            most = work.bounds[k] + pace * (work.laws.ends[m + k, 2] - work.bounds[k])
            work.laws.ends[m + k, 0], work.laws.ends[m + k, 2] = -most, most


@kernel
def _expansion_ends(law, mu, share, N, T, ends, i):
    """Where the tangential percussion of the expansion may lie after the compression (N, T); returns what is given back."""
    if law.kind == SHIFTED:
        back = min(law.tangential, share)
        ends[i, 0], ends[i, 1] = back * (T + mu * N), -mu
        ends[i, 2], ends[i, 3] = back * (T - mu * N), mu
    elif law.kind == PG1996:
        back = share * law.tangential * T
        if abs(T) <= NO_TANGENTIAL * mu * N:
            cone(ends, i, 0.5 * mu)
        elif T > 0.0:
            ends[i, 0], ends[i, 1], ends[i, 2], ends[i, 3] = back, 0.0, 0.0, mu
        else:
            ends[i, 0], ends[i, 1], ends[i, 2], ends[i, 3] = 0.0, -mu, back, 0.0
        return back
    else:
        cone(ends, i, mu)
    return 0.0


@kernel
def _compress(model, state, m, work):
    """Percussions that stop the approach into `work.more`; rates before are in `work.rates`."""
    laws = work.laws
    for i in range(m):
        laws.low[i] = 0.0
        cone(laws.ends, i, friction_bound(law_of(model, work.closed.ids[i]), work.rates[2 * i + 1]))
    rows = 2 * m + len(model.bearings)
    for row in range(rows):
        laws.b[row], laws.P[row] = work.rates[row], 0.0
    _keep_sliding(m, work)
    _settle_impact(model, state, m, work)
    for row in range(rows):
        work.more[row] = laws.P[row]


@kernel
def _keep_sliding(m, work):
    """Where slip and approach stop together, their directions being parallel, friction is what it was while they lasted.

    Against a driven body slip is left when approach has stopped, and Coulomb's law says which way friction acts.
    """
    laws = work.laws
    for i in range(m):
        N, T, slip = 2 * i, 2 * i + 1, work.rates[2 * i + 1]
        if slip == 0.0 or laws.G[N, T] ** 2 <= (1.0 - PARALLEL) * laws.G[N, N] * laws.G[T, T]:
            continue
        if abs(slip - laws.G[N, T] / laws.G[N, N] * work.rates[N]) <= NUDGE * abs(slip):
            one_way = laws.ends[i, 1] if slip > 0.0 else laws.ends[i, 3]
            laws.ends[i, 1], laws.ends[i, 3] = one_way, one_way


@kernel
def _expand(model, state, m, work):
    """Percussions of the expansion with `work.restitution` into `work.laws.P`."""
    laws, rows = work.laws, 2 * m + len(model.bearings)
    for row in range(rows):
        laws.b[row] = work.rates[row]
        for column in range(rows):
            laws.b[row] += laws.G[row, column] * work.more[column]
    for i in range(m):
        N, T, law = work.more[2 * i], work.more[2 * i + 1], law_of(model, work.closed.ids[i])
        laws.low[i] = work.restitution[i] * N
        mu = friction_bound(law, work.rates[2 * i + 1])
        returned = law.nu * _expansion_ends(law, mu, work.restitution[i], N, T, laws.ends, i)
        laws.P[2 * i], laws.P[2 * i + 1] = laws.low[i], 0.0
        if returned != 0.0:
            # Friction of pg1996 changes sides at the slip that nu of what is returned would make.
            for j in range(m):
                laws.b[2 * j + 1] -= laws.G[2 * j + 1, 2 * i + 1] * returned
    _settle_impact(model, state, m, work)


@kernel
def _least_restitution(m, work):
    least = 1.0
    for i in range(m):
        least = min(least, work.restitution[i])
    return least


@kernel
def _loss(first, rows, work):
    """Energy that the percussions of rows take between the rates before, `work.rates`, and after, `work.laws.b`."""
    total = 0.0
    for row in range(first, rows):
        total -= 0.5 * work.laws.P[row] * (work.rates[row] + work.laws.b[row])
    return total


@kernel
def stop_approaches(model, state, options, m, work, record):
    """Impacts at the start of the step, into `work.u`; True if any is fast enough to be written down."""
    copy(state.u, work.u)
    bearings = len(model.bearings)
    rates_of(work, m, bearings, work.u, work.rates)
    fastest = 0.0
    for i in range(m):
        fastest = max(fastest, -work.rates[2 * i])
        work.restitution[i] = law_of(model, work.closed.ids[i]).restitution
    if fastest == 0.0:
        return False
    for i in range(len(work.u)):
        work.inverse[i] = inverse_mass(model.coordinates[i])
    kinetic = kinetic_energy(model, state.u)
    fill_mobility(work, m, bearings)
    _compress(model, state, m, work)
    for attempt in range(3):
        _expand(model, state, m, work)
        for row in range(2 * m + bearings):
            work.laws.P[row] += work.more[row]
        copy(state.u, work.u)
        push(work, m, bearings, work.laws.P, work.u)
        rates_of(work, m, bearings, work.u, work.laws.b)
        if attempt == 2 or _loss(0, 2 * m + bearings, work) >= -ENERGY_GAIN * kinetic:
            break
        state.counts.energy_rescues += 1
        least = _least_restitution(m, work) if attempt == 0 else 0.0
        for i in range(m):
            work.restitution[i] = least
    state.sums.drive += drive_through_contacts(model, work.closed, m, work.laws.P, work.u)
    state.sums.damping += _loss(2 * m, 2 * m + bearings, work)
    return _write_impacts(state, options, m, work, record)


@kernel
def _write_impacts(state, options, m, work, record):
    """Energy of the impacts, and events of those that are faster than creeping into contact."""
    written = False
    P, before, after = work.laws.P, work.rates, work.laws.b
    for i in range(m):
        N, T = 2 * i, 2 * i + 1
        lost = -0.5 * (P[N] * (before[N] + after[N]) + P[T] * (before[T] + after[T]))
        state.sums.impacts += lost
        if P[N] > 0.0 and before[N] < -options.accumulation_speed:
            row = keep_event(record, state.clock, state.counts, EventKind.IMPACT, work.closed.ids[i], -1, before[N])
            event = record.events[row]
            event.impulse_normal, event.impulse_tangential, event.energy_lost = P[N], P[T], lost
            state.counts.impacts += 1
            written = True
    return written
