"""What follows an event?

At one instant: the closed contacts are gathered and fall into islands; impacts are resolved and the
acceleration-level LCP decides which contacts stay closed and which of them stick, island by island. Velocities and positions
are then exact to rounding.
"""

from __future__ import annotations

import math

from watchsim.contact.gaps import OPEN, STICK, contact_kinematics, extent_margin, place
from watchsim.dynamics.acceleration import accelerate
from watchsim.dynamics.delassus import apply, copy, fill_delassus, fill_inverse, inverse_mass
from watchsim.dynamics.forces import add_drag, forces, stop_held
from watchsim.jit import kernel
from watchsim.simulation.closed_contacts import gather, hand_over, insert, refresh
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
    contradicts,
    decide,
    hold_at_dead_centre,
    hold_gaps,
    release_pulling,
    set_rate_zeros,
    slides,
    stands_at_dead_centre,
    stop_at_dead_centre,
    stop_rounding,
    track_peak_speed,
)
from watchsim.simulation.scratch import keep_change, keep_event
from watchsim.simulation.state import NO_CONTACT, EventKind, Stop
from watchsim.tolerances import DEPENDENT_AT_EVENTS, DEPENDENT_IN_STEPS, HIDDEN_REBOUND, IMMOVABLE, LEFT_PRIMITIVE

# Can any motion change the gap of a contact?
#
# Not that of a disc about its own pivot against a bar that slides past it: the normal force has no lever arm on either body, so
# that it can neither stop nor be stopped by anything. Such a contact is left out until its lever arms are more than rounding.


# sine² of the angle between a face and the motion: drawings are rounded to a nanometre, which over a millimetre is a millionth
@kernel
def is_immovable(model, closed, i):
    """True if the gap of row i of `closed` changes by next to nothing however its bodies move."""
    across, along, _ = _mobilities(model, closed, i)
    return across <= IMMOVABLE * along


@kernel
def has_one_way(model, closed, i, depth):
    """True if faces along which the bodies of row i of `closed` move are immovable, there or where they are sunk in by `depth`.

    They are where the bodies move past each other in one direction only. A circle of reduced radius r that has sunk in meets
    the next face beside its place on the last one where that turns by up to sqrt(2 depth/r), and by so much directions differ.
    """
    across, along, both = _mobilities(model, closed, i)
    reduced = abs(model.contacts[closed.ids[i]].reduced)
    turned = IMMOVABLE + 2.0 * depth / reduced if reduced > 0.0 else IMMOVABLE
    return across * along - both * both <= turned * (across + along) ** 2


@kernel
def _mobilities(model, closed, i):
    """What a force along the normal does along it, a tangential one along its own direction, and either along the other's."""
    across, along, both = 0.0, 0.0, 0.0
    for slot in range(closed.slots[i]):
        inverse = inverse_mass(model.coordinates[closed.coord[i, slot]])
        across += closed.w_N[i, slot] ** 2 * inverse
        along += closed.w_T[i, slot] ** 2 * inverse
        both += closed.w_N[i, slot] * closed.w_T[i, slot] * inverse
    return across, along, both


@kernel
def drop_immovable(model, state, m, event, record):
    """Leave the immovable ones out of the m contacts in `event.closed`; returns how many are left."""
    closed, kept = event.closed, 0
    for i in range(m):
        k = closed.ids[i]
        if is_immovable(model, closed, i):
            if state.mode[k] != OPEN:
                state.mode[k] = OPEN
                keep_event(state, record, EventKind.OPEN, k, -1, 0.0)
            continue
        if kept < i:
            contact_kinematics(model, k, event.pose, kept, closed)
        kept += 1
    return kept


# Which contacts of an instant do the same to the bodies as one that is met first?
#
# Both corners of a flap that lands on a bar turn it about its one pivot. If its face is off by a picometre, only one of them
# can
# be closed: to close the other one, too, would press the first one in. The other one waits until it is met itself.


@kernel
def defer_parallel(model, state, m, options, work, event):
    """Leave out those of the m contacts in `event.closed` that are apart and behind a parallel one; returns how many are left.

    `work` holds the inverse masses.
    """
    closed, least = event.closed, HIDDEN_REBOUND * options.gap_zero
    waiting = False
    for i in range(m):
        waiting = waiting or _may_wait(state, closed, i, least)
    if not waiting or m < 2:
        return m
    fill_delassus(closed, m, work)
    for i in range(m):
        work.rhs[i] = closed.kin[i].g
    kept = 0
    for i in range(m):
        if _may_wait(state, closed, i, least) and _is_behind(m, i, least, work):
            continue
        if kept < i:
            contact_kinematics(model, closed.ids[i], event.pose, kept, closed)
        kept += 1
    return kept


@kernel
def _may_wait(state, closed, i, least):
    """True if row i is neither in force nor has it just touched, and its gap is more than `least` (m)."""
    k = closed.ids[i]
    return state.mode[k] == OPEN and k != state.now.touched and closed.kin[i].g > least


@kernel
def _is_behind(m, i, least, work):
    """True if closing a row that moves the bodies alike leaves row i open by more than `least`; gaps (m) are in `work.rhs`."""
    own = work.G[2 * i, 2 * i]
    for j in range(m):
        both, other = work.G[2 * i, 2 * j], work.G[2 * j, 2 * j]
        is_parallel = j != i and both > 0.0 and both * both >= (1.0 - DEPENDENT_IN_STEPS) * own * other
        if is_parallel and work.rhs[i] - work.rhs[j] * math.sqrt(own / other) > least:
            return True
    return False


# What follows an event?

ROUNDS = 16  # impacts in a row at one instant


@kernel
def handle_event(model, cells, state, options, scratch, record):
    """Handle the event that waits at the current state; returns a Stop code, RUNNING when all went well."""
    event = scratch.event
    event.pace[:] = 0.0
    place(model, state.q, state.u, event.pose)
    project_landing(model, state, options, scratch.work, event)
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
        stop = handle_island(model, state, island, (first, last), options, scratch, record)
        if stop != Stop.RUNNING:
            return stop
        first = last
    finish_event(model, state, _closed_of(state, m, event.listed, state.active), options, scratch, record)
    state.now.event_waits, state.now.touched = 0, NO_CONTACT
    return Stop.RUNNING


@kernel
def project_landing(model, state, options, work, event):
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
def handle_island(model, state, island, span, options, scratch, record):
    """Impacts and modes of one island, whose closed contacts are listed[span[0]:span[1]]; returns a Stop code."""
    work, event = scratch.work, scratch.event
    closed = event.closed
    fill_inverse(model, state.grip, work.inverse)
    m = place_contacts(model, event.listed, span[0], span[1], event.pose, closed)
    m = drop_immovable(model, state, m, event, record)
    m = defer_parallel(model, state, m, options, work, event)
    track_peak_speed(state.u, event.pace)
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
        apply_modes(state, m, r, event, record)
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
def finish_event(model, state, f, options, scratch, record):
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
        m, unique = release_pulling(model, state, m, options, work, event, record)
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
def apply_modes(state, m, r, event, record):
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
