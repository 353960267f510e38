"""What follows an event?

At one instant, in this order: the closed contacts are gathered and fall into islands; of each island gaps and rates are closed
(`close_gaps`), then impacts and decisions about modes follow each other until the modes hold (`resolve`) and are taken over
(`apply_modes`); at last positions and velocities are exact to rounding, and all contacts in force get their accelerations
(`finish_event`). Impacts are in impacts.py, decisions in modes.py, what counts as closed in closed_contacts.py.
"""

from __future__ import annotations

from watchsim.contact.gaps import OPEN, STICK, extent_margin, place
from watchsim.dynamics.acceleration import accelerate
from watchsim.dynamics.delassus import apply, copy, fill_inverse
from watchsim.dynamics.forces import add_drag, forces
from watchsim.jit import kernel
from watchsim.simulation.closed_contacts import defer_parallel, drop_immovable, gather, hand_over, insert, release_left
from watchsim.simulation.coupled_motion import (
    add_terms,
    begin_terms,
    find_sleepers,
    island_of,
    label_islands,
    place_contacts,
    project_positions,
    project_velocities,
    sort_by_island,
)
from watchsim.simulation.impacts import approaching, collide
from watchsim.simulation.modes import (
    Verdict,
    decide,
    hold_at_dead_centre,
    judge,
    release_pulling,
    replace,
    set_rate_zeros,
    track_peak_speed,
)
from watchsim.simulation.scratch import keep_change
from watchsim.simulation.state import NO_CONTACT, Stop
from watchsim.tolerances import DEPENDENT_AT_EVENTS, DEPENDENT_IN_STEPS, LEFT_PRIMITIVE

ROUNDS = 16  # impacts and decisions in a row at one instant


@kernel
def handle_event(model, cells, state, options, scratch, record):
    """Handle the event that waits at the current state; returns a Stop code, RUNNING when all went well."""
    event = scratch.event
    listed, label, upto = event.listed, event.label, event.upto
    event.peak_speed[:] = 0.0
    place(model, state.q, state.u, event.pose)
    project_landing(model, state, options, scratch)
    if not hand_over(model, cells, state, options, scratch, record):
        return Stop.CELL_UNKNOWN
    release_left(model, state, options, event.pose, record)
    code, m = gather(model, cells, state, options, scratch.asked, event.pose, listed)
    if code != Stop.RUNNING:
        return code
    label_islands(model, listed, m, label)
    sort_by_island(model, label, m, listed, upto)
    first = 0
    for island in range(len(label)):
        if label[island] != island:
            continue
        last = upto[first] if first < m and island_of(model, label, listed[first]) == island else first
        fill_inverse(model, state.regime.grip, scratch.work.system.inverse)
        closed = close_gaps(model, state, (first, last), options, scratch, record)
        code, r = resolve(model, state, island, closed, options, scratch, record)
        if code != Stop.RUNNING:
            return code
        apply_modes(state, closed, r, event, record)
        first = last
    in_force = _closed_of(state.regime.mode, m, listed, state.regime.active)
    finish_event(model, state, in_force, options, scratch, record)
    state.instant.event_waits, state.instant.touched = 0, NO_CONTACT
    return Stop.RUNNING


@kernel
def project_landing(model, state, options, scratch):
    """Where a contact has just closed and one in force seems to have left its primitive, take back the drift of both.

    A body that lands on a face rests on one corner when the other one meets it. Drift of the first gap turns the body, by more
    than the joint of its fan of normals: it would be let go in the moment in which both are pressed.
    """
    event, inverse, m = scratch.event, scratch.work.system.inverse, state.instant.awake_contacts
    if state.instant.touched == NO_CONTACT or m + 1 > len(event.closed.ids):
        return
    left = False
    for j in range(m):
        left = left or extent_margin(model, state.regime.active[j], event.pose) < -LEFT_PRIMITIVE * options.extent
    if not left:
        return
    fill_inverse(model, state.regime.grip, inverse)
    for j in range(m):
        event.listed[j] = state.regime.active[j]
    m = insert(event.listed, m, state.instant.touched)
    place_contacts(model, event.listed, 0, m, event.pose, event.closed)
    project_positions(event.closed, m, True, options.behind, inverse, scratch.projection, state.q)
    place(model, state.q, state.u, event.pose)


@kernel
def close_gaps(model, state, span, options, scratch, record):
    """Take back what gaps and rates have drifted of the contacts `event.listed[span[0]:span[1]]`, of one island.

    They are left in `event.closed`, without those that cannot count; returns how many.
    """
    work, event, projection = scratch.work, scratch.event, scratch.projection
    closed, inverse = event.closed, work.system.inverse
    m = place_contacts(model, event.listed, span[0], span[1], event.pose, closed)
    m = drop_immovable(model, state, m, event, record)
    m = defer_parallel(model, state.regime.mode, state.instant.touched, m, options, work.system, event)
    track_peak_speed(state.u, event.peak_speed)
    deepest = project_positions(closed, m, False, options.behind, inverse, projection, state.q)
    if deepest > 0.0:
        state.worst.penetration = max(state.worst.penetration, deepest)
        replace(model, state.q, state.u, m, event)
        # Rates of the contacts in force have changed with the places, by the gaps times how fast bodies turn.
        project_velocities(closed, m, state.regime.mode, DEPENDENT_IN_STEPS, inverse, projection, state.u)
        replace(model, state.q, state.u, m, event)
    return m


@kernel
def resolve(model, state, island, m, options, scratch, record):
    """Impacts and decisions of the island's m closed contacts until the modes hold; returns (Stop code, contacts in I_N).

    An impact wherever a contact approaches or is jammed, else a decision, which holds, or says what is to be done before the
    next one: see `Verdict`.
    """
    work, event, exactly, jammed, hit = scratch.work, scratch.event, False, False, False
    for _ in range(ROUNDS):
        set_rate_zeros(event.closed, m, exactly, options, event.peak_speed, event.zero)
        if jammed or approaching(m, event.closed, event.zero):
            jam_speed = options.speed_zero if jammed else 0.0
            if not collide(model, state, island, m, options, jam_speed, scratch, record):
                return Stop.LCP_FAILED, 0
            jammed, hit = False, not jammed
        else:
            decision = decide(model, state, island, m, options, work.system, work.problem, event, state.regime.grip)
            verdict = judge(model, state, island, m, decision, (exactly, hit), options, scratch, record)
            if verdict == Verdict.HOLDS:
                return Stop.RUNNING, decision[0]
            if verdict == Verdict.FAILED:
                return Stop.LCP_FAILED, 0
            exactly = exactly or verdict == Verdict.EXACTLY
            jammed, hit = verdict == Verdict.JAMMED, hit and verdict != Verdict.ROUNDING
    return Stop.TOO_MANY_EVENTS, 0


@kernel
def apply_modes(state, m, r, event, record):
    """Replace the modes of the m closed contacts by the decided ones, `event.decided` for the r in I_N, and record changes."""
    closed, rest = event.closed, event.rest
    for i in range(m):
        k, new = closed.ids[i], OPEN
        for j in range(r):
            if rest.ids[j] == k:
                new = event.decided[k]
        keep_change(record, state.clock, state.counts, k, state.regime.mode[k], new)
        state.regime.mode[k] = new


@kernel
def _closed_of(mode, m, ids, out_ids):
    """Those of the m contacts that are closed; returns their number."""
    f = 0
    for j in range(m):
        if mode[ids[j]] != OPEN:
            out_ids[f] = ids[j]
            f += 1
    return f


@kernel
def finish_event(model, state, f, options, scratch, record):
    """Exact positions and velocities, accelerations and sleep with the f contacts in force, `state.regime.active[:f]`."""
    work, event, rest = scratch.work, scratch.event, scratch.event.rest
    system = work.system
    label_islands(model, state.regime.active, f, event.label)
    sort_by_island(model, event.label, f, state.regime.active, state.regime.upto)
    place(model, state.q, state.u, event.pose)
    forces(model, state.clock.time, state.q, state.u, system.h)
    add_drag(model, state.regime.grip, system.h)
    fill_inverse(model, state.regime.grip, system.inverse)
    accelerate(model, rest, 0, system, state.a)
    begin_terms(system.h, event.terms)
    first = 0
    while first < f:
        m = place_contacts(model, state.regime.active, first, state.regime.upto[first], event.pose, rest)
        _correct(state, m, options, system.inverse, scratch.projection, rest, event.trial)
        first += m
        m, unique = release_pulling(model, state, m, options, system, work.modes, event, record)
        if not unique:
            state.counts.redundant_sets += 1
        apply(rest, m, system.force, system.inverse, state.a)
        hold_at_dead_centre(model, state.regime.mode, state.u, m, system, rest, state.a)
        add_terms(rest, m, system.force, event.terms)
    f = _closed_of(state.regime.mode, f, state.regime.active, state.regime.active)
    find_sleepers(model, state.regime, options, state.clock.time, event, f, state.u, state.a)
    _list_awake_first(model, state.regime, f, event, state.instant)


@kernel
def _correct(state, m, options, inverse, projection, rest, out_trial):
    """Exact zero gaps and rates of an island's m contacts in force; no slip against the mode where it was too slow to count."""
    deepest = project_positions(rest, m, True, options.behind, inverse, projection, state.q)
    state.worst.penetration = max(state.worst.penetration, deepest)
    for i in range(m):
        k = rest.ids[i]
        out_trial[k] = STICK if state.regime.mode[k] * rest.kin[i].gT_dot < 0.0 else state.regime.mode[k]
    project_velocities(rest, m, out_trial, DEPENDENT_AT_EVENTS, inverse, projection, state.u)


@kernel
def _list_awake_first(model, regime, f, event, out_instant):
    """Put the contacts of awake bodies first among the f in force."""
    copy(regime.active, event.in_force)
    count = 0
    for awake in (True, False):
        if not awake:
            out_instant.awake_contacts, out_instant.sleeping_contacts = count, f - count
        for j in range(f):
            k = event.in_force[j]
            if (regime.awake[island_of(model, event.label, k)] != 0) == awake:
                regime.active[count] = k
                count += 1
    sort_by_island(model, event.label, out_instant.awake_contacts, regime.active, regime.upto)
