"""How are impacts resolved in Moreau's time stepping?

In two phases: what approaches is stopped (compression, Coulomb's law), then thrown back (expansion, Poisson's law with the
scene's tangential law). Where that gains energy, less is thrown back (docs/theory/method.md 2.7).
"""

from __future__ import annotations

from watchsim.dynamics.delassus import drive_through_contacts, inverse_mass, size_class
from watchsim.dynamics.small_systems import copy
from watchsim.jit import kernel
from watchsim.model.records import PG1996, SHIFTED
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.events.impulse_check import kinetic_energy
from watchsim.simulation.moreau.mobility import fill_mobility, push, rates_of
from watchsim.simulation.moreau.percussion_laws import cone, residual
from watchsim.simulation.moreau.prox_relaxation import relax
from watchsim.simulation.record.write_buffers import keep_event
from watchsim.tolerances import ENERGY_GAIN, NO_TANGENTIAL, NUDGE, PARALLEL


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
def _law(model, work, i):
    return model.laws[model.contacts[work.closed.ids[i]].group]


@kernel
def friction_cones(model, m, work):
    """Coulomb's law for all closed contacts."""
    for i in range(m):
        work.laws.low[i] = 0.0
        cone(work.laws.ends, i, _law(model, work, i).friction)


@kernel
def _expansion_ends(law, share, N, T, ends, i):
    """Where the tangential percussion of the expansion may lie after the compression (N, T); returns what is given back."""
    mu = law.friction
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
    friction_cones(model, m, work)
    for row in range(2 * m):
        laws.b[row], laws.P[row] = work.rates[row], 0.0
    _keep_sliding(model, m, work)
    solve_percussions(state, m, 0, work)
    for row in range(2 * m):
        work.more[row] = laws.P[row]


@kernel
def _keep_sliding(model, m, work):
    """Where slip and approach stop together, their directions being parallel, friction is what it was while they lasted.

    Against a driven body slip is left when approach has stopped, and Coulomb's law says which way friction acts.
    """
    laws = work.laws
    for i in range(m):
        N, T, slip = 2 * i, 2 * i + 1, work.rates[2 * i + 1]
        if slip == 0.0 or laws.G[N, T] ** 2 <= (1.0 - PARALLEL) * laws.G[N, N] * laws.G[T, T]:
            continue
        if abs(slip - laws.G[N, T] / laws.G[N, N] * work.rates[N]) <= NUDGE * abs(slip):
            one_way = -_law(model, work, i).friction if slip > 0.0 else _law(model, work, i).friction
            laws.ends[i, 1], laws.ends[i, 3] = one_way, one_way


@kernel
def _expand(model, state, m, work):
    """Percussions of the expansion with `work.restitution` into `work.laws.P`."""
    laws = work.laws
    for row in range(2 * m):
        laws.b[row] = work.rates[row]
        for column in range(2 * m):
            laws.b[row] += laws.G[row, column] * work.more[column]
    for i in range(m):
        N, T, law = work.more[2 * i], work.more[2 * i + 1], _law(model, work, i)
        laws.low[i] = work.restitution[i] * N
        returned = law.nu * _expansion_ends(law, work.restitution[i], N, T, laws.ends, i)
        laws.P[2 * i], laws.P[2 * i + 1] = laws.low[i], 0.0
        if returned != 0.0:
            # Friction of pg1996 changes sides at the slip that nu of what is returned would make.
            for j in range(m):
                laws.b[2 * j + 1] -= laws.G[2 * j + 1, 2 * i + 1] * returned
    solve_percussions(state, m, 0, work)


@kernel
def _least_restitution(m, work):
    least = 1.0
    for i in range(m):
        least = min(least, work.restitution[i])
    return least


@kernel
def _loss(m, work):
    """Energy that the percussions take between the rates before, `work.rates`, and after, `work.laws.b`."""
    total = 0.0
    for row in range(2 * m):
        total -= 0.5 * work.laws.P[row] * (work.rates[row] + work.laws.b[row])
    return total


@kernel
def stop_approaches(model, state, options, m, work, record):
    """Impacts at the start of the step, into `work.u`; True if any is fast enough to be written down."""
    copy(state.u, work.u)
    rates_of(work, m, 0, work.u, work.rates)
    fastest = 0.0
    for i in range(m):
        fastest = max(fastest, -work.rates[2 * i])
        work.restitution[i] = _law(model, work, i).restitution
    if fastest == 0.0:
        return False
    for i in range(len(work.u)):
        work.inverse[i] = inverse_mass(model.coordinates[i])
    kinetic = kinetic_energy(model, state.u)
    fill_mobility(work, m, 0)
    _compress(model, state, m, work)
    for attempt in range(3):
        _expand(model, state, m, work)
        for row in range(2 * m):
            work.laws.P[row] += work.more[row]
        copy(state.u, work.u)
        push(work, m, 0, work.laws.P, work.u)
        rates_of(work, m, 0, work.u, work.laws.b)
        if attempt == 2 or _loss(m, work) >= -ENERGY_GAIN * kinetic:
            break
        state.counts.energy_rescues += 1
        least = _least_restitution(m, work) if attempt == 0 else 0.0
        for i in range(m):
            work.restitution[i] = least
    state.sums.drive += drive_through_contacts(model, work.closed, m, work.laws.P, work.u)
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
            row = keep_event(state, record, EventKind.IMPACT, work.closed.ids[i], -1, before[N])
            event = record.events[row]
            event.impulse_normal, event.impulse_tangential, event.energy_lost = P[N], P[T], lost
            state.counts.impacts += 1
            written = True
    return written
