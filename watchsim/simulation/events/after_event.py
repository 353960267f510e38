"""What follows an event?

At one instant: the closed contacts are gathered and fall into islands; impacts are resolved and the
acceleration-level LCP decides which contacts stay closed and which of them stick, island by island. Velocities and positions
are then exact to rounding.
"""

from __future__ import annotations

from watchsim.contact.gaps import extent_margin
from watchsim.contact.index_sets import OPEN, STICK
from watchsim.contact.poses import place
from watchsim.dynamics.acceleration import accelerate
from watchsim.dynamics.applied_forces import forces
from watchsim.dynamics.bearing_friction import add_drag, stop_held
from watchsim.dynamics.delassus import apply, fill_inverse
from watchsim.dynamics.small_systems import copy
from watchsim.jit import kernel
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.events.closed_contacts import gather, insert, refresh
from watchsim.simulation.events.collision import approaching, collide
from watchsim.simulation.events.dead_centre import hold_at_dead_centre, stands_at_dead_centre, stop_at_dead_centre
from watchsim.simulation.events.handover import hand_over
from watchsim.simulation.events.immovable import drop_immovable
from watchsim.simulation.events.jammed_contacts import hold_gaps, slides, stop_rounding
from watchsim.simulation.events.mode_decision import decide
from watchsim.simulation.events.parallel_contacts import drop_later
from watchsim.simulation.events.released_contacts import let_go
from watchsim.simulation.events.zero_rates import contradicts, note_pace, set_rate_zeros
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.motion.contact_islands import island_of, label_islands, place_contacts, sort_by_island
from watchsim.simulation.motion.drift_projection import project_positions, project_velocities
from watchsim.simulation.motion.sleeping import add_terms, begin_terms, find_sleepers
from watchsim.simulation.record.write_buffers import keep_change, keep_event
from watchsim.simulation.stops import Stop
from watchsim.tolerances import DEPENDENT_AT_EVENTS, DEPENDENT_IN_STEPS, LEFT_PRIMITIVE

ROUNDS = 16  # impacts in a row at one instant


@kernel
def settle(model, cells, state, options, scratch, record):
    """Handle the event that waits at the current state; returns a Stop code, RUNNING when all went well."""
    event = scratch.event
    event.pace[:] = 0.0
    place(model, state.q, state.u, event.pose)
    _land(model, state, options, scratch.work, event)
    if not hand_over(model, cells, state, options, scratch, record):
        return Stop.CELL_UNKNOWN
    _release(model, state, options, event.pose, record)
    code, m = gather(model, cells, state, options, scratch)
    if code != Stop.RUNNING:
        return code
    label_islands(model, event.listed, m, event.label)
    sort_by_island(model, event.label, m, event.listed, event.upto)
    first = 0
    for island in range(len(event.label)):
        if event.label[island] != island:
            continue
        last = first
        if first < m and island_of(model, event.label, event.listed[first]) == island:
            last = event.upto[first]
        stop = _settle_island(model, state, island, (first, last), options, scratch, record)
        if stop != Stop.RUNNING:
            return stop
        first = last
    _go_on(model, state, _closed_of(state, m, event.listed, state.active), options, scratch, record)
    state.now.event_waits, state.now.touched = 0, NO_CONTACT
    return Stop.RUNNING


@kernel
def _land(model, state, options, work, event):
    """Where a contact has just closed and one in force seems to have left its primitive, take back the drift of both.

    A body that lands on a face rests on one corner when the other one meets it. Drift of the first gap turns the body, by more
    than the joint of its fan of normals: it would be let go in the moment in which both are pressed.
    """
    m = state.now.awake_contacts
    if state.now.touched == NO_CONTACT or m + 1 > len(event.closed.ids):
        return
    left = False
    for j in range(m):
        left = left or extent_margin(model, state.active[j], event.pose) < -LEFT_PRIMITIVE * options.extent
    if not left:
        return
    fill_inverse(model, state.grip, work.inverse)
    for j in range(m):
        event.listed[j] = state.active[j]
    m = insert(event.listed, m, state.now.touched)
    place_contacts(model, event.listed, 0, m, event.pose, event.closed)
    project_positions(event.closed, m, True, options.behind, work, state.q)
    place(model, state.q, state.u, event.pose)


@kernel
def _settle_island(model, state, island, span, options, scratch, record):
    """Impacts and modes of one island, whose closed contacts are listed[span[0]:span[1]]; returns a Stop code."""
    work, event = scratch.work, scratch.event
    closed = event.closed
    fill_inverse(model, state.grip, work.inverse)
    m = place_contacts(model, event.listed, span[0], span[1], event.pose, closed)
    m = drop_immovable(model, state, m, event, record)
    m = drop_later(model, state, m, options, work, event)
    note_pace(state.u, event.pace)
    deepest = project_positions(closed, m, False, options.behind, work, state.q)
    if deepest > 0.0:
        state.worst.penetration = max(state.worst.penetration, deepest)
        place(model, state.q, state.u, event.pose)
        refresh(model, m, closed, event.pose)
        # Rates of the contacts in force have changed with the places, by the gaps times how fast bodies turn.
        project_velocities(closed, m, state.mode, DEPENDENT_IN_STEPS, work, state.u)
        place(model, state.q, state.u, event.pose)
        refresh(model, m, closed, event.pose)
    stop, r = _resolve(model, state, island, m, options, scratch, record)
    if stop == Stop.RUNNING:
        _take(state, m, r, event, record)
    return stop


@kernel
def _closed_of(state, m, ids, out_ids):
    """Those of the m contacts that are closed; returns their number."""
    f = 0
    for j in range(m):
        if state.mode[ids[j]] != OPEN:
            out_ids[f] = ids[j]
            f += 1
    return f


@kernel
def _go_on(model, state, f, options, scratch, record):
    """Exact positions and velocities, accelerations and sleep with the f contacts in force."""
    work, event = scratch.work, scratch.event
    rest = event.rest
    label_islands(model, state.active, f, event.label)
    sort_by_island(model, event.label, f, state.active, state.upto)
    place(model, state.q, state.u, event.pose)
    forces(model, state.clock.time, state.q, state.u, work.h)
    add_drag(model, state.grip, work.h)
    fill_inverse(model, state.grip, work.inverse)
    accelerate(model, rest, 0, work, state.a)
    begin_terms(work.h, event.terms)
    first = 0
    while first < f:
        m = place_contacts(model, state.active, first, state.upto[first], event.pose, rest)
        _correct(state, m, options, work, rest, event.trial)
        first += m
        m, unique = let_go(model, state, m, options, work, event, record)
        if not unique:
            state.counts.redundant_sets += 1
        apply(rest, m, work.force, work.inverse, state.a)
        hold_at_dead_centre(model, state, m, work, rest)
        add_terms(rest, m, work.force, event.terms)
    f = _closed_of(state, f, state.active, state.active)
    find_sleepers(model, state, options, event, f)
    _list_awake_first(model, state, f, event)


@kernel
def _correct(state, m, options, work, rest, out_trial):
    """Exact zero gaps and rates of an island's m contacts in force; no slip against the mode where it was too slow to count."""
    deepest = project_positions(rest, m, True, options.behind, work, state.q)
    state.worst.penetration = max(state.worst.penetration, deepest)
    for i in range(m):
        k = rest.ids[i]
        out_trial[k] = STICK if state.mode[k] * rest.kin[i].gT_dot < 0.0 else state.mode[k]
    project_velocities(rest, m, out_trial, DEPENDENT_AT_EVENTS, work, state.u)


@kernel
def _list_awake_first(model, state, f, event):
    """Put the contacts of awake bodies first among the f in force."""
    copy(state.active, event.in_force)
    count = 0
    for awake in (True, False):
        if not awake:
            state.now.awake_contacts, state.now.sleeping_contacts = count, f - count
        for j in range(f):
            k = event.in_force[j]
            if (state.awake[island_of(model, event.label, k)] != 0) == awake:
                state.active[count] = k
                count += 1
    sort_by_island(model, event.label, state.now.awake_contacts, state.active, state.upto)


@kernel
def _resolve(model, state, island, m, options, scratch, record):
    """Impacts of the island until nothing approaches, then the modes; returns (Stop code, number of contacts in I_N).

    Where no finite forces exist although nothing approaches, sliding contacts are jammed (Painlevé): their impulses are
    found, and the modes asked for again.
    """
    work, event = scratch.work, scratch.event
    jam, exactly, hit = 0.0, False, False
    for _ in range(ROUNDS):
        set_rate_zeros(event.closed, m, exactly, options, event.pace, event.zero)
        if jam > 0.0 or approaching(m, event.closed, event.zero):
            if not collide(model, state, island, m, options, jam, scratch, record):
                return Stop.LCP_FAILED, 0
            jam, hit = 0.0, jam == 0.0
            continue
        r, solved = decide(model, state, island, m, options, work, event, state.grip)
        if stop_at_dead_centre(model, state, r, solved, work, event, record):
            place(model, state.q, state.u, event.pose)
            refresh(model, m, event.closed, event.pose)
            continue
        if stands_at_dead_centre(model, state, island, r, solved, work, event):
            return Stop.RUNNING, r
        if solved:
            if not exactly and contradicts(model, state, r, options, work, event):
                exactly = True
                continue
            stop_held(event.label, island, state.grip, state.u)
            return Stop.RUNNING, r
        if hit and stop_rounding(model, state, m, r, options, scratch):
            hit = False
            continue
        if not slides(r, options.speed_zero, event.rest):
            state.counts.lcp_failures += 1
            return Stop.LCP_FAILED, 0
        hold_gaps(model, state, r, options, work, event)
        refresh(model, m, event.closed, event.pose)
        jam = options.speed_zero
    return Stop.TOO_MANY_EVENTS, 0


@kernel
def _release(model, state, options, pose, record):
    """Open the contacts that have left their primitives without a successor."""
    kept, awake = 0, 0
    for j in range(state.now.awake_contacts + state.now.sleeping_contacts):
        k = state.active[j]
        if extent_margin(model, k, pose) < -LEFT_PRIMITIVE * options.extent:
            state.mode[k] = OPEN
            keep_event(state, record, EventKind.OPEN, k, -1, 0.0)
            continue
        state.active[kept] = k
        kept += 1
        if j < state.now.awake_contacts:
            awake += 1
    state.now.awake_contacts, state.now.sleeping_contacts = awake, kept - awake


@kernel
def _take(state, m, r, event, record):
    """Replace the modes of the closed contacts by the decided ones (`event.decided` for I_N) and write down changes."""
    closed, rest = event.closed, event.rest
    for i in range(m):
        k = closed.ids[i]
        new = OPEN
        for j in range(r):
            if rest.ids[j] == k:
                new = event.decided[k]
        old = state.mode[k]
        state.mode[k] = new
        keep_change(state, record, k, old)
