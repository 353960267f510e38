"""Which contacts are closed at this instant?"""

from __future__ import annotations

from watchsim.candidates.cell_lookup import LISTED, UNKNOWN, candidate, candidates
from watchsim.contact.gaps import extent_margin, normal_gap
from watchsim.contact.index_sets import OPEN
from watchsim.contact.kinematics import contact_kinematics
from watchsim.jit import kernel
from watchsim.simulation.events.handover import continues_active
from watchsim.simulation.loop_state.scratch import ask
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.motion.sleeping import is_at_rest
from watchsim.simulation.stops import Stop


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
            ask(scratch.asked, p, state.q)
            return Stop.CELL_UNKNOWN, m
        if how == LISTED:
            state.counts.cells_looked_up += 1
        for place in range(start, start + count):
            k = candidate(model, cells, how, place)
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
