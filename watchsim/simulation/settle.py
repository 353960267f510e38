"""What follows an event?

At one instant: the closed contacts are gathered, impacts resolved, and the acceleration-level LCP decides which contacts
stay closed and which of them stick. Velocities and positions are then exact to rounding.
"""

from __future__ import annotations

from watchsim.contact.gaps import extent_margin
from watchsim.contact.index_sets import OPEN, STICK
from watchsim.contact.poses import place
from watchsim.dynamics.acceleration import accelerate, decide_modes, solve_mode
from watchsim.dynamics.delassus import fill_inverse
from watchsim.dynamics.dry import add_drag, set_grips, stop_held
from watchsim.dynamics.forces import forces
from watchsim.jit import kernel
from watchsim.simulation.chatter import stand_still
from watchsim.simulation.closed import gather, refresh, resting
from watchsim.simulation.collide import approaching, collide, count_rungs
from watchsim.simulation.drift import project_positions, project_velocities
from watchsim.simulation.handover import LEFT, hand_over
from watchsim.simulation.keep import keep_event
from watchsim.simulation.sleep import find_sleepers
from watchsim.simulation.state import N_LCP_FAILED, N_REDUNDANT
from watchsim.simulation.stops import Stop

RUNNING, CELL_UNKNOWN = int(Stop.RUNNING), int(Stop.CELL_UNKNOWN)
LCP_FAILED, TOO_MANY_CONTACTS, TOO_MANY_EVENTS = int(Stop.LCP_FAILED), int(Stop.TOO_MANY_CONTACTS), int(Stop.TOO_MANY_EVENTS)
CLOSE_EVENT, OPEN_EVENT, STICK_EVENT, SLIDE_EVENT = 2, 3, 4, 5
ROUNDS = 16  # impacts in a row at one instant


@kernel
def _keep_change(state, record, k, old):
    """Write down how contact k's mode changed."""
    new = state.mode[k]
    if new == old:
        return
    if old == OPEN:
        keep_event(state, record, CLOSE_EVENT, k, -1, float(new))
    elif new == OPEN:
        keep_event(state, record, OPEN_EVENT, k, -1, 0.0)
    elif new == STICK:
        keep_event(state, record, STICK_EVENT, k, -1, 0.0)
    else:
        keep_event(state, record, SLIDE_EVENT, k, -1, float(new))


@kernel
def _in_force(state, r, scratch):
    """Keep only the rows of `rest` that are closed; returns their number."""
    rest = scratch.rest
    kept = 0
    for i in range(r):
        if state.mode[rest.ids[i]] != OPEN:
            rest.ids[kept] = rest.ids[i]
            kept += 1
    return kept


@kernel
def _list_active(model, state, f, scratch):
    """Fill `state.active` from the f contacts in force: those of awake bodies first."""
    rest = scratch.rest
    awake = 0
    for i in range(f):
        if state.awake[rest.coord[i, 0]]:
            state.active[awake] = rest.ids[i]
            awake += 1
    asleep = 0
    for i in range(f):
        if not state.awake[rest.coord[i, 0]]:
            state.active[awake + asleep] = rest.ids[i]
            asleep += 1
    state.numbers[0], state.numbers[1] = awake, asleep


@kernel
def settle(model, cells, state, options, scratch, record):
    """Handle the event that waits at the current state; returns a Stop code, RUNNING when all went well."""
    place(model, state.q, state.u, scratch.pose)
    if not hand_over(model, cells, state, options, scratch, record):
        return CELL_UNKNOWN
    _release(model, state, options, scratch, record)
    m = gather(model, cells, state, options, scratch)
    if m < 0:
        return CELL_UNKNOWN if m == -1 else TOO_MANY_CONTACTS
    closed, work = scratch.closed, scratch.work
    refresh(model, m, closed, scratch.pose)
    deepest = project_positions(closed, m, False, work, state.q)
    if deepest > 0.0:
        state.worst[0] = max(state.worst[0], deepest)
        place(model, state.q, state.u, scratch.pose)
        refresh(model, m, closed, scratch.pose)
    stop, r = _resolve(model, state, m, options, scratch, record)
    if stop != RUNNING:
        return stop
    _take(model, state, m, r, scratch, record)
    f = _in_force(state, r, scratch)
    refresh(model, f, scratch.rest, scratch.pose)
    _correct(model, state, f, scratch)
    if f > 0 and not solve_mode(model, scratch.rest, f, state.mode, work):
        state.counts[N_REDUNDANT] += 1
    accelerate(scratch.rest, f, work, state.a)
    find_sleepers(model, state, options, scratch, f)
    _list_active(model, state, f, scratch)
    state.numbers[2], state.numbers[4] = 0, -1
    return RUNNING


@kernel
def _resolve(model, state, m, options, scratch, record):
    """Impacts until nothing approaches, then the modes; returns (Stop code, number of contacts in I_N).

    Where no finite forces exist although nothing approaches, sliding contacts are jammed (Painlevé): their impulses are
    found, and the modes asked for again.
    """
    jam = 0.0
    for _ in range(ROUNDS):
        if jam > 0.0 or approaching(m, scratch.closed, options.speed_zero):
            if collide(model, state, m, options, jam, scratch, record) != 0:
                return LCP_FAILED, 0
            jam = 0.0
            continue
        r, status = _decide(model, state, m, options, scratch)
        if status == 0:
            return RUNNING, r
        if not _slides(r, options.speed_zero, scratch.rest):
            state.counts[N_LCP_FAILED] += 1
            return LCP_FAILED, 0
        # Their gaps must not open, however slowly, or there is nothing to stop.
        stand_still(model, state, scratch.rest, r, options, scratch)
        refresh(model, m, scratch.closed, scratch.pose)
        jam = options.speed_zero
    return TOO_MANY_EVENTS, 0


@kernel
def _decide(model, state, m, options, scratch):
    """Modes of the contacts in I_N and grips of the bearings; (number of contacts in I_N, status)."""
    work = scratch.work
    r = resting(model, m, scratch.closed, scratch.pose, options.speed_zero, scratch.rest)
    forces(model, state.clock[0], state.q, state.u, work.h)
    standing = set_grips(model, state.u, options.speed_zero, options.size, state.grip)
    add_drag(model, state.grip, work.h)
    status = 0
    if r > 0 or standing > 0:
        status = decide_modes(model, scratch.rest, r, options.speed_zero, work, state.grip, scratch.trial)
        count_rungs(state, work)
    else:
        fill_inverse(model, state.grip, work.inverse)
    if status == 0:
        stop_held(model, state.grip, state.u)
    return r, status


@kernel
def _slides(r, speed_zero, rest):
    """True if one of the r contacts in I_N slides."""
    for i in range(r):
        if abs(rest.kin[i].gT_dot) > speed_zero:
            return True
    return False


@kernel
def _release(model, state, options, scratch, record):
    """Open the contacts that have left their primitives without a successor."""
    kept, awake = 0, 0
    for j in range(state.numbers[0] + state.numbers[1]):
        k = state.active[j]
        if extent_margin(model, k, scratch.pose) < -LEFT * options.extent:
            state.mode[k] = OPEN
            keep_event(state, record, OPEN_EVENT, k, -1, 0.0)
            continue
        state.active[kept] = k
        kept += 1
        if j < state.numbers[0]:
            awake += 1
    state.numbers[0], state.numbers[1] = awake, kept - awake


@kernel
def _take(model, state, m, r, scratch, record):
    """Replace the modes of the closed contacts by the decided ones (in `scratch.trial` for I_N) and write down changes."""
    closed, rest = scratch.closed, scratch.rest
    for i in range(m):
        k = closed.ids[i]
        new = OPEN
        for j in range(r):
            if rest.ids[j] == k:
                new = scratch.trial[k]
        old = state.mode[k]
        state.mode[k] = new
        _keep_change(state, record, k, old)


@kernel
def _correct(model, state, f, scratch):
    """Exact zero gaps and rates for the f contacts in force; no slip against the mode where it was too slow to count."""
    if f == 0:
        return
    rest, work = scratch.rest, scratch.work
    deepest = project_positions(rest, f, True, work, state.q)
    state.worst[0] = max(state.worst[0], deepest)
    for i in range(f):
        k = rest.ids[i]
        scratch.trial[k] = STICK if state.mode[k] * rest.kin[i].gT_dot < 0.0 else state.mode[k]
    project_velocities(rest, f, scratch.trial, work, state.u)
