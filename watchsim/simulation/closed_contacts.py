"""Which contacts are closed at this instant?

Those in force pass to neighbouring primitives (`hand_over`) or end (`release_left`); those without a gap are gathered
(`gather`), island by island placed (`place_contacts`) and relieved of what cannot count (`drop_immovable`, `defer_parallel`).
"""

from __future__ import annotations

import math

from watchsim.contact.cell_lookup import LISTED, UNKNOWN, candidate, candidates
from watchsim.contact.gaps import OPEN, are_apart, contact_kinematics, contact_point, extent_margin, normal_gap, place
from watchsim.dynamics.delassus import fill_delassus, inverse_mass
from watchsim.jit import kernel
from watchsim.simulation.coupled_motion import is_at_rest, place_contacts, project_velocities
from watchsim.simulation.scratch import keep_event, request_cell
from watchsim.simulation.state import NO_CONTACT, EventKind, Stop
from watchsim.tolerances import (
    DEPENDENT_IN_STEPS,
    EXPLAINED_OF_HIGHEST,
    EXPLAINED_SHARE,
    FAR_POINTS,
    HIDDEN_REBOUND,
    IMMOVABLE,
    LEFT_PRIMITIVE,
    NEAR_POINTS,
    SHARP_TURN,
    SMOOTH_TURN,
    STOPPABLE_SPEED,
)

# Handover: where two primitives join smoothly, or an arc of the touching body ends in its corner, both sides have the same
# contact point and the same normal. Then the contact goes on with its mode: no impact, no release.


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
def is_beside_active(model, active, in_force, k):
    """True if open contact k is beside one of active[:in_force] that excludes it: one primitive shared, the others neighbours.

    What touches an outline from outside near a convex corner, or near a smooth joint of lines and convex arcs, does so in
    one point. The contact in force ends, with an event, before its neighbour can begin.
    """
    one = model.contacts[k]
    for j in range(in_force):
        two = model.contacts[active[j]]
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
def room_beside_active(model, active, in_force, options, k, pose):
    """`room_to_differ` from that of active[:in_force] which open contact k continues; negative where it continues none."""
    for j in range(in_force):
        way, turn = room_to_differ(model, k, active[j], options, pose)
        if way >= 0.0 and turn >= 0.0:
            return way, turn
    return -1.0, -1.0


@kernel
def _successor(model, cells, q, mode, options, k, pose, out_request, out_counts):
    """The open contact that goes on where contact k ends: (known, its number or NO_CONTACT).

    `known` is False where the cell is unknown.
    """
    p = 0
    while not model.pairs[p].start <= k < model.pairs[p].stop:
        p += 1
    how, start, count = candidates(model, cells, p, q)
    if how == UNKNOWN:
        request_cell(out_request, p, q)
        return False, NO_CONTACT
    if how == LISTED:
        out_counts.cells_looked_up += 1
    best, deepest = NO_CONTACT, -options.extent
    for slot in range(start, start + count):
        j = candidate(model, cells, how, slot)
        if mode[j] != OPEN or abs(normal_gap(model, j, pose).gap) > options.gap_close:
            continue
        margin = extent_margin(model, j, pose)
        if margin >= deepest and same_contact(model, j, k, options, pose):
            best, deepest = j, margin
    return True, best


@kernel
def hand_over(model, cells, state, options, scratch, record):
    """Pass contacts that left their primitives to their neighbours. Poses must be current; False where a cell is unknown."""
    moved, event, mode = False, scratch.event, state.regime.mode
    for j in range(state.instant.awake_contacts + state.instant.sleeping_contacts):
        k = state.regime.active[j]
        if extent_margin(model, k, event.pose) >= -LEFT_PRIMITIVE * options.extent:
            continue
        known, successor = _successor(model, cells, state.q, mode, options, k, event.pose, scratch.requested, state.counts)
        if not known:
            return False
        if successor != NO_CONTACT:
            mode[successor], mode[k] = mode[k], OPEN
            state.regime.active[j] = successor
            keep_event(record, state.clock, state.counts, EventKind.HANDOVER, successor, -1, float(k))
            moved = True
    if moved:
        state.instant.struck = 0
        # Take back what the way beyond the primitive's end has done to the velocities: normals differ by the turn there.
        m = place_contacts(model, state.regime.active, 0, state.instant.awake_contacts, event.pose, event.closed)
        inverse = scratch.work.system.inverse
        project_velocities(event.closed, m, mode, DEPENDENT_IN_STEPS, inverse, scratch.projection, state.u)
        place(model, state.q, state.u, event.pose)
    return True


@kernel
def release_left(model, state, options, pose, record):
    """Open the contacts that have left their primitives without a successor."""
    kept, awake, instant = 0, 0, state.instant
    for j in range(instant.awake_contacts + instant.sleeping_contacts):
        k = state.regime.active[j]
        if extent_margin(model, k, pose) < -LEFT_PRIMITIVE * options.extent:
            state.regime.mode[k] = OPEN
            instant.struck = 0
            keep_event(record, state.clock, state.counts, EventKind.OPEN, k, -1, 0.0)
            continue
        state.regime.active[kept] = k
        kept += 1
        if j < instant.awake_contacts:
            awake += 1
    instant.awake_contacts, instant.sleeping_contacts = awake, kept - awake


@kernel
def beyond_ends(options):
    """How far apart the primitives of a contact can be, as far as they count, that is closed or has sunk in, m."""
    return 2.0 * options.sunk + 4.0 * options.extent


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
def gather(model, cells, state, options, path, out_request, pose, out_ids):
    """Ids of I_C, ascending: contacts in force and those with a gap of zero.

    What a contact in force will touch next on the same smooth outline is left out. Poses must be current. Of `state` only
    counts are written; `path` holds the circles around primitives. Returns (Stop code: RUNNING, CELL_UNKNOWN or
    TOO_MANY_CONTACTS; their number).
    """
    m, in_force = 0, state.instant.awake_contacts + state.instant.sleeping_contacts
    for j in range(in_force):
        m = insert(out_ids, m, state.regime.active[j])
    # The contact that has just touched is closed, even where taking back drift has moved its gap since.
    if state.instant.touched != NO_CONTACT:
        m = insert(out_ids, m, state.instant.touched)
    for p in range(len(model.pairs)):
        pair = model.pairs[p]
        if (
            is_at_rest(model, state.regime.awake, pair.a)
            and is_at_rest(model, state.regime.awake, pair.b)
            and state.clock.time > 0.0
        ):
            continue
        how, start, count = candidates(model, cells, p, state.q)
        if how == UNKNOWN:
            request_cell(out_request, p, state.q)
            return Stop.CELL_UNKNOWN, m
        if how == LISTED:
            state.counts.cells_looked_up += 1
        pa, pb, beyond = pose[pair.a], pose[pair.b], beyond_ends(options)
        for row in range(start, start + count):
            k = candidate(model, cells, how, row)
            contact = model.contacts[k]
            in_order = model.primitives[contact.a].body == pair.a
            if state.regime.mode[k] != OPEN or are_apart(
                contact, path.around, pa if in_order else pb, pb if in_order else pa, beyond
            ):
                continue
            gap = normal_gap(model, k, pose).gap
            if -options.behind <= gap <= options.gap_close and extent_margin(model, k, pose) >= -options.extent:
                if room_beside_active(model, state.regime.active, in_force, options, k, pose)[0] >= 0.0:
                    continue
                if m == len(out_ids):
                    return Stop.TOO_MANY_CONTACTS, m
                m = insert(out_ids, m, k)
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


# Immovable contacts: no motion changes the gap of a disc about its own pivot against a bar that slides past it, since the
# normal force has no lever arm on either body, so that it can neither stop nor be stopped by anything. Such a contact is left
# out until its lever arms are more than rounding.


@kernel
def is_immovable(model, closed, i):
    """True if the gap of row i of `closed` changes by next to nothing however its bodies move, driven ones among them."""
    for slot in range(closed.slots[i]):
        is_driven = model.coordinates[closed.coord[i, slot]].driven
        if is_driven and closed.w_N[i, slot] ** 2 > IMMOVABLE * closed.w_T[i, slot] ** 2:
            return False
    return gives_no_way(model, closed, i)


@kernel
def gives_no_way(model, closed, i):
    """True if no force opens the gap of row i of `closed`, whatever drives a body into it."""
    across, along, _ = _mobilities(model, closed, i)
    return across <= IMMOVABLE * along


@kernel
def blocked_at(model, m, event):
    """The one of the m contacts in `event.closed` at which a driven body runs into what cannot give way, or NO_CONTACT."""
    for i in range(m):
        if event.closed.kin[i].gN_dot < -event.zero[i] and gives_no_way(model, event.closed, i):
            return event.closed.ids[i]
    return NO_CONTACT


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
            if state.regime.mode[k] != OPEN:
                state.regime.mode[k] = OPEN
                keep_event(record, state.clock, state.counts, EventKind.OPEN, k, -1, 0.0)
            continue
        if kept < i:
            contact_kinematics(model, k, event.pose, kept, closed)
        kept += 1
    return kept


# Parallel contacts: both corners of a flap that lands on a bar turn it about its one pivot. If its face is off by a picometre,
# only one of them can be closed: to close the other one, too, would press the first one in. The other one waits until it is met
# itself.


@kernel
def defer_parallel(model, mode, touched, m, options, system, event):
    """Leave out those of the m contacts in `event.closed` that are apart and behind a parallel one; returns how many are left.

    Those in force do not wait, nor does the contact that has just `touched`. Fills `system.G`.
    """
    closed, waits, least, some = event.closed, event.waits, HIDDEN_REBOUND * options.gap_zero, False
    for i in range(m):
        k = closed.ids[i]
        waits[i] = 1 if mode[k] == OPEN and k != touched and closed.kin[i].g > least else 0
        some = some or waits[i] == 1
    if not some or m < 2:
        return m
    fill_delassus(closed, m, system.inverse, system.G)
    for i in range(m):
        if waits[i] and not _is_behind(closed, m, i, least, system.G):
            waits[i] = 0
    kept = 0
    for i in range(m):
        if waits[i]:
            continue
        if kept < i:
            contact_kinematics(model, closed.ids[i], event.pose, kept, closed)
        kept += 1
    return kept


@kernel
def _is_behind(closed, m, i, least, G):
    """True if closing a row that moves the bodies alike leaves row i open by more than `least` (m)."""
    own = G[2 * i, 2 * i]
    for j in range(m):
        both, other = G[2 * i, 2 * j], G[2 * j, 2 * j]
        is_parallel = j != i and both > 0.0 and both * both >= (1.0 - DEPENDENT_IN_STEPS) * own * other
        if is_parallel and closed.kin[i].g - closed.kin[j].g * math.sqrt(own / other) > least:
            return True
    return False


# Is every change of velocities at an instant explained by its impulses? These account for what they take. What else moves
# velocities at an instant are corrections of rounding size: drift taken back, slips and speeds that count as zero. The kinetic
# energy that such a change takes or gives must be next to nothing.


@kernel
def kinetic_energy(model, u):
    """J."""
    total = 0.0
    for i in range(len(u)):
        if not model.coordinates[i].driven:
            total += 0.5 * model.coordinates[i].mass * u[i] * u[i]
    return total


@kernel
def is_explained(model, options, energy, change, highest):
    """True if a `change` of the kinetic `energy` (J, impulses taken out) is of the size of rounding.

    `energy`: the larger of that before and after, since a driven body that strikes what is at rest brings all of it.
    """
    allowed = EXPLAINED_SHARE * energy + EXPLAINED_OF_HIGHEST * highest
    if abs(change) <= allowed:
        return True
    drift = 0.0
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if not coordinate.driven:
            drift += 0.5 * coordinate.mass * (options.speed_drift / options.size * coordinate.scale) ** 2
    # Of a body that is nearly at rest, its drift is a large share: by so much it may be off on top of its speed.
    return abs(change) <= allowed + 2.0 * math.sqrt(energy * drift) + STOPPABLE_SPEED**2 * drift
