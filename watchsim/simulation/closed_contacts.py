"""Which contacts are closed at this instant?"""

from __future__ import annotations

import math

from watchsim.contact.cell_lookup import LISTED, UNKNOWN, candidate, candidates
from watchsim.contact.gaps import OPEN, contact_kinematics, contact_point, extent_margin, normal_gap, place
from watchsim.jit import kernel
from watchsim.simulation.coupled_motion import is_at_rest, project_velocities
from watchsim.simulation.scratch import keep_event, request_cell
from watchsim.simulation.state import NO_CONTACT, EventKind, Stop
from watchsim.tolerances import (
    DEPENDENT_IN_STEPS,
    EXPLAINED_OF_HIGHEST,
    EXPLAINED_SHARE,
    FAR_POINTS,
    LEFT_PRIMITIVE,
    NEAR_POINTS,
    SHARP_TURN,
    SMOOTH_TURN,
    STOPPABLE_SPEED,
)

# Is every change of velocities at an instant explained by its impulses?
#
# Impulses account for what they take. What else moves velocities at an instant are corrections of rounding size: drift
# taken back, slips and speeds that count as zero. The kinetic energy that such a change takes or gives must be next to nothing.


@kernel
def kinetic_energy(model, u):
    """J."""
    total = 0.0
    for i in range(len(u)):
        if not model.coordinates[i].driven:
            total += 0.5 * model.coordinates[i].mass * u[i] * u[i]
    return total


@kernel
def is_explained(model, options, before, after, highest):
    """True if a change of kinetic energy from `before` to `after` (J, impulses taken out) is of the size of rounding."""
    allowed = EXPLAINED_SHARE * before + EXPLAINED_OF_HIGHEST * highest
    change = abs(after - before)
    if change <= allowed:
        return True
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if coordinate.driven:
            continue
        slow = STOPPABLE_SPEED * options.speed_zero / options.size * coordinate.scale
        allowed += 0.5 * coordinate.mass * slow * slow
    return change <= allowed


# Is this the same contact on a neighbouring primitive, and how does a contact pass from one to the next?
#
# Where two primitives join smoothly, or an arc of the touching body ends in its corner, both sides have the same contact point
# and the same normal. Then the contact goes on with its mode: no impact, no release.


@kernel
def same_contact(model, k, other, options, pose):
    """True if contacts k and `other` touch the same two bodies at one point with one normal."""
    way, turn = room_to_differ(model, k, other, options, pose)
    return way >= 0.0 and turn >= 0.0


@kernel
def room_to_differ(model, k, other, options, pose):
    """How much further apart the points of two contacts may come (m), their normals turn (rad), before they are no longer one.

    Negative where they are two already.
    """
    one, two = model.contacts[k], model.contacts[other]
    a, b = model.primitives[one.a].body, model.primitives[one.b].body
    c, d = model.primitives[two.a].body, model.primitives[two.b].body
    if not ((a == c and b == d) or (a == d and b == c)):
        return -1.0, -1.0
    # The circle may be on either body: normals point out of the other one.
    sign = 1.0 if a == c else -1.0
    here, there = normal_gap(model, k, pose), normal_gap(model, other, pose)
    # One of them may be beyond its joint by some extents, and its normal turned by the curvature of that way.
    turn = min(SMOOTH_TURN + 4.0 * options.extent * max(abs(one.curvature), abs(two.curvature)), SHARP_TURN)
    turned = math.sqrt((here.nx - sign * there.nx) ** 2 + (here.ny - sign * there.ny) ** 2)
    x, y = contact_point(model, k, pose)
    X, Y = contact_point(model, other, pose)
    radius = max(model.primitives[one.a].radius, model.primitives[two.a].radius)
    near = min(NEAR_POINTS * options.extent + turn * radius, FAR_POINTS * options.extent)
    return near - math.sqrt((x - X) ** 2 + (y - Y) ** 2), turn - turned


@kernel
def is_beside_active(model, state, k):
    """True if open contact k is beside a contact in force that excludes it: one primitive the same, the others neighbours.

    What touches an outline from outside near a convex corner, or near a smooth joint of lines and convex arcs, does so in
    one point. The contact in force ends, with an event, before its neighbour can begin.
    """
    one = model.contacts[k]
    for j in range(state.now.awake_contacts):
        two = model.contacts[state.active[j]]
        if one.a == two.a:
            mine, its = one.b, two.b
        elif one.b == two.b:
            mine, its = one.a, two.a
        elif one.a == two.b:
            mine, its = one.b, two.a
        elif one.b == two.a:
            mine, its = one.a, two.b
        else:
            continue
        if model.primitives[mine].before == its or model.primitives[mine].after == its:
            return True
    return False


@kernel
def continues_active(model, state, options, k, pose):
    """True if open contact k is a contact in force, seen from a neighbouring primitive."""
    way, _ = room_beside_active(model, state, options, k, pose)
    return way >= 0.0


@kernel
def room_beside_active(model, state, options, k, pose):
    """`room_to_differ` from the contact in force that open contact k continues; negative where it continues none."""
    for j in range(state.now.awake_contacts + state.now.sleeping_contacts):
        way, turn = room_to_differ(model, k, state.active[j], options, pose)
        if way >= 0.0 and turn >= 0.0:
            return way, turn
    return -1.0, -1.0


@kernel
def _pair_of(model, k):
    p = 0
    while not model.pairs[p].start <= k < model.pairs[p].stop:
        p += 1
    return p


@kernel
def _successor(model, cells, state, options, k, scratch):
    """The open contact that goes on where contact k ends: (known, its number or NO_CONTACT).

    `known` is False where the cell is unknown.
    """
    p = _pair_of(model, k)
    how, start, count = candidates(model, cells, p, state.q)
    if how == UNKNOWN:
        request_cell(scratch.asked, p, state.q)
        return False, NO_CONTACT
    if how == LISTED:
        state.counts.cells_looked_up += 1
    best, deepest = NO_CONTACT, -options.extent
    for slot in range(start, start + count):
        j = candidate(model, cells, how, slot)
        if state.mode[j] != OPEN:
            continue
        if abs(normal_gap(model, j, scratch.event.pose).gap) > options.gap_close:
            continue
        margin = extent_margin(model, j, scratch.event.pose)
        if margin >= deepest and same_contact(model, j, k, options, scratch.event.pose):
            best, deepest = j, margin
    return True, best


@kernel
def hand_over(model, cells, state, options, scratch, record):
    """Pass contacts that left their primitives to their neighbours. Poses must be current; False where a cell is unknown."""
    moved = False
    for j in range(state.now.awake_contacts + state.now.sleeping_contacts):
        k = state.active[j]
        if extent_margin(model, k, scratch.event.pose) >= -LEFT_PRIMITIVE * options.extent:
            continue
        known, successor = _successor(model, cells, state, options, k, scratch)
        if not known:
            return False
        if successor != NO_CONTACT:
            state.mode[successor], state.mode[k] = state.mode[k], OPEN
            state.active[j] = successor
            keep_event(state, record, EventKind.HANDOVER, successor, -1, float(k))
            moved = True
    if moved:
        _follow(model, state, scratch.work, scratch.event)
    return True


@kernel
def _follow(model, state, work, event):
    """Take back what the way beyond the primitive's end has done to the velocities: normals differ by the turn there."""
    m = state.now.awake_contacts
    for i in range(m):
        contact_kinematics(model, state.active[i], event.pose, i, event.closed)
    project_velocities(event.closed, m, state.mode, DEPENDENT_IN_STEPS, work, state.u)
    place(model, state.q, state.u, event.pose)


# Which contacts are closed at this instant?


@kernel
def insert(ids, count, k):
    """Insert k into the ascending list ids[:count]; returns the new count (unchanged if k is there)."""
    place = count
    while place > 0 and ids[place - 1] > k:
        place -= 1
    if place > 0 and ids[place - 1] == k:
        return count
    for j in range(count, place, -1):
        ids[j] = ids[j - 1]
    ids[place] = k
    return count + 1


@kernel
def gather(model, cells, state, options, scratch):
    """Ids of I_C, ascending, into `event.listed` of `scratch`: contacts in force and those with a gap of zero.

    What a contact in force will touch next on the same smooth outline is left out.

    Poses must be current. Returns (Stop code: RUNNING, CELL_UNKNOWN or TOO_MANY_CONTACTS; their number).
    """
    ids, pose = scratch.event.listed, scratch.event.pose
    m = 0
    for j in range(state.now.awake_contacts + state.now.sleeping_contacts):
        m = insert(ids, m, state.active[j])
    # The contact that has just touched is closed, even where taking back drift has moved its gap since.
    if state.now.touched != NO_CONTACT:
        m = insert(ids, m, state.now.touched)
    for p in range(len(model.pairs)):
        pair = model.pairs[p]
        if is_at_rest(model, state, pair.a) and is_at_rest(model, state, pair.b) and state.clock.time > 0.0:
            continue
        how, start, count = candidates(model, cells, p, state.q)
        if how == UNKNOWN:
            request_cell(scratch.asked, p, state.q)
            return Stop.CELL_UNKNOWN, m
        if how == LISTED:
            state.counts.cells_looked_up += 1
        for row in range(start, start + count):
            k = candidate(model, cells, how, row)
            if state.mode[k] != OPEN:
                continue
            gap = normal_gap(model, k, pose).gap
            if -options.behind <= gap <= options.gap_close and extent_margin(model, k, pose) >= -options.extent:
                if continues_active(model, state, options, k, pose):
                    continue
                if m == len(ids):
                    return Stop.TOO_MANY_CONTACTS, m
                m = insert(ids, m, k)
    return Stop.RUNNING, m


@kernel
def refresh(model, m, closed, pose):
    """Kinematics of the first m contacts of `closed` at the given poses."""
    for row in range(m):
        contact_kinematics(model, closed.ids[row], pose, row, closed)


@kernel
def resting(model, m, closed, pose, zero, out_rest):
    """I_N: the contacts of `closed` that neither approach nor separate, with kinematics, into `out_rest`; returns how many.

    `zero[i]` is the magnitude up to which the gap rate of row i counts as zero.
    """
    r = 0
    for i in range(m):
        if abs(closed.kin[i].gN_dot) <= zero[i]:
            contact_kinematics(model, closed.ids[i], pose, r, out_rest)
            r += 1
    return r
