"""How does a simulation go from event to event?

The event loop (`advance`): one smooth step (an exact flight where nothing couples the moving bodies), the first event in it,
the step up to that event, and what follows the event (`handle_event`). It is left only for a reason that `Stop` names.
"""

from __future__ import annotations

import math

from watchsim.contact.cell_lookup import time_through_cells
from watchsim.contact.gaps import OPEN, STICK, extent_margin, place
from watchsim.dynamics.acceleration import accelerate
from watchsim.dynamics.bearings import begin_loads
from watchsim.dynamics.delassus import apply, copy, fill_inverse
from watchsim.dynamics.forces import add_drag, forces, next_knot
from watchsim.jit import entry, kernel
from watchsim.model import CellsRef, ModelRef
from watchsim.simulation.closed_contacts import (
    blocked_at,
    defer_parallel,
    drop_immovable,
    gather,
    hand_over,
    insert,
    is_explained,
    kinetic_energy,
    release_left,
)
from watchsim.simulation.coupled_motion import (
    add_terms,
    begin_terms,
    find_sleepers,
    island_of,
    label_islands,
    mark_loose,
    place_contacts,
    project_positions,
    project_velocities,
    settle_loads,
    sort_by_island,
)
from watchsim.simulation.curb_pins import first_pin
from watchsim.simulation.first_closing import closing_expected, first_touch
from watchsim.simulation.impacts import approaching, collide
from watchsim.simulation.integrator import NONE_FIRED, SOON, accept_coupled, coupled_step, first_leave, first_turn
from watchsim.simulation.modes import (
    Verdict,
    begin_instant,
    decide,
    decide_once,
    hold_at_dead_centre,
    judge,
    key_of_modes,
    release_pulling,
    replace,
    set_rate_zeros,
    stop_locked,
    track_peak_speed,
)
from watchsim.simulation.options import OptionsRef, longest_step
from watchsim.simulation.scratch import (
    MONITORS,
    RECENT,
    RecordRef,
    keep_change,
    keep_row,
    scratch_by_reference,
    state_by_reference,
)
from watchsim.simulation.standing import first_fall, stands_shaken, step_while_standing
from watchsim.simulation.state import NO_CONTACT, Stop
from watchsim.simulation.step_path import (
    add_flight_sums,
    begin_flight,
    can_fly,
    flight_length,
    keep_flight_rows,
    keep_inner_rows,
    keep_passages,
)
from watchsim.tolerances import (
    DEPENDENT_AT_EVENTS,
    DEPENDENT_IN_STEPS,
    EVENTS_AT_ONCE,
    FINEST_ROWS,
    FLIGHT_PHASE,
    FURTHEST_SIZES,
    LEFT_PRIMITIVE,
    LENIENCE_STEP,
    NEARLY_SEIZED,
    ROUNDS,
    SAME_INSTANT,
)

TOUCHED, BEARING, KINDS = MONITORS, MONITORS + 1, MONITORS + 2  # what ends a step, besides the monitors of a contact
FLIGHT_CELLS = 128
ROWS_PER_STEP = math.ceil(FLIGHT_PHASE / FINEST_ROWS) + 8
EVENTS_PER_CONTACT = 20

# What follows an event?
#
# At one instant, in this order: the closed contacts are gathered and fall into islands; gaps and rates of each are closed
# (`close_gaps`), then impacts and decisions about modes follow each other until the modes hold (`resolve`) and are taken over
# (`apply_modes`); at last positions and velocities are exact to rounding, and all contacts in force get their accelerations
# (`finish_event`). Impacts are in impacts.py, decisions in modes.py, what counts as closed in closed_contacts.py.


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
    code, m = gather(model, cells, state, options, scratch.path, scratch.requested, event.pose, listed)
    if code != Stop.RUNNING:
        return code
    label_islands(model, listed, m, label)
    sort_by_island(model, label, m, listed, upto)
    mark_disturbed(model, state, m, event)
    first = 0
    for island in range(len(label)):
        if label[island] != island:
            continue
        last = upto[first] if first < m and island_of(model, label, listed[first]) == island else first
        if not event.disturbed[island]:
            first = last
            continue
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
def mark_disturbed(model, state, m, event):
    """Mark in `event.disturbed` the islands to decide anew: of the awake, of the contact that ended the step, of new contacts.

    What sleeping bodies have decided holds until something touches them. The m closed contacts are in `event.listed`.
    """
    struck, label = state.instant.struck - 1, event.label
    event.disturbed[:] = 1 if struck < 0 else 0
    for i in range(len(label)):
        if state.regime.awake[i] != 0:
            event.disturbed[label[i]] = 1
    for j in range(m):
        k = event.listed[j]
        if k == struck or state.regime.mode[k] == OPEN:
            event.disturbed[island_of(model, label, k)] = 1


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
    last, seizures = work.problem.last, 0
    last.seized = 0
    for _ in range(ROUNDS):
        set_rate_zeros(event.closed, m, exactly, options, event.peak_speed, event.zero)
        if jammed or approaching(m, event.closed, event.zero):
            blocked = blocked_at(model, m, event)
            if blocked != NO_CONTACT:
                state.instant.touched = blocked
                return Stop.BLOCKED, 0
            jam_speed = options.speed_zero if jammed else 0.0
            if not collide(model, state, island, m, options, jam_speed, scratch, record):
                if stop_locked(model, state, m, work.system, event, record):
                    state.counts.lcp_failures -= 1  # there is no solution to be found
                    replace(model, state.q, state.u, m, event)
                    continue
                return Stop.BEARING_JAMS if last.jammed else Stop.LCP_FAILED, 0
            jammed, hit, last.seized = False, not jammed, 0
        else:
            decision = decide(model, state, island, m, options, work.system, work.problem, event, state.regime.grip)
            seizures += last.jammed
            if seizures > m + 1:  # impulses stop at least one bearing or contact each time, or nothing does
                return Stop.BEARING_JAMS, 0
            verdict = judge(model, state, island, m, decision, (exactly, hit), options, scratch, record)
            if verdict == Verdict.HOLDS:
                return Stop.RUNNING, decision[0]
            if verdict == Verdict.FAILED:
                return Stop.LCP_FAILED, 0
            exactly = exactly or verdict == Verdict.EXACTLY
            last.seized = 1 if verdict == Verdict.SEIZED else 0
            jammed, hit = verdict in (Verdict.JAMMED, Verdict.SEIZED), hit and verdict != Verdict.ROUNDING
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
    fill_inverse(model, state.regime.grip, system.inverse)
    begin_loads(model, state.clock.time, state.q, state.u, system)
    add_drag(system.dry, state.regime.grip, system.h)
    if len(model.bearings) > 0:
        settle_loads(model, state.regime, (f, state.instant.lenience), event.pose, rest, system, work.modes)
    accelerate(model, rest, 0, system, state.a)
    begin_terms(system.h, event.terms)
    event.loose[:] = 0
    stands = state.instant.lenience > 1.0  # their modes came back at this instant
    first = 0
    while first < f:
        m = place_contacts(model, state.regime.active, first, state.regime.upto[first], event.pose, rest)
        _correct(state, m, options, system.inverse, scratch.projection, rest, event.trial)
        first += m
        m, unique = release_pulling(model, state, m, options, system, work.modes, event, record)
        if not unique:
            state.counts.redundant_sets += 1
        apply(rest, m, system.force, system.inverse, state.a)
        stands = hold_at_dead_centre(model, state.regime.mode, state.u, m, system, rest, state.a) or stands
        add_terms(rest, m, system.force, event.terms)
        if m > 0:
            mark_loose(model, rest, m, state.regime.mode, event.label, state.a, event.loose)
    f = _closed_of(state.regime.mode, f, state.regime.active, state.regime.active)
    find_sleepers(model, state.regime, options, state.clock.time, stands, event, f, state.u, state.a)
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


# How does time go on to the next event?


@kernel
def check_state(model, q, u):
    """Stop.RUNNING where all coordinates and velocities are numbers and contacts can be resolved at them, or else why not."""
    for i in range(len(q)):
        if not math.isfinite(q[i] + u[i]):
            return Stop.NOT_FINITE
        if abs(q[i]) > FURTHEST_SIZES * model.coordinates[i].scale:
            return Stop.FAR_AWAY
    return Stop.RUNNING


@kernel
def _room_left(record, contacts):
    events = EVENTS_PER_CONTACT * contacts
    return record.used.rows + ROWS_PER_STEP < len(record.rows) and record.used.events + events < len(record.events)


@kernel
def _without_step(model, state, options, jammed):
    """What follows where steps get too small; returns (Stop code, event?).

    A bearing at the limit of its friction that contacts hold as well may be held below it from here on, and one whose load
    grows without bound seizes: decide anew.
    """
    if state.clock.time - state.clock.event <= SAME_INSTANT * options.accumulation_time or len(model.bearings) == 0:
        state.instant.lenience *= LENIENCE_STEP  # what is nearly so seizes, too
        if not jammed or state.instant.lenience > NEARLY_SEIZED:
            return Stop.BEARING_JAMS if jammed else Stop.STEP_TOO_SMALL, False
    state.instant.touched, state.instant.struck = NO_CONTACT, 0
    return Stop.RUNNING, True


@kernel
def _smooth_step(model, cells, state, options, end_time, scratch, record):
    """One smooth step up to its first event; returns (Stop code, event?)."""
    left = remaining = end_time - state.clock.time
    flying, spacing, code = can_fly(model, state.regime.awake, state.instant.awake_contacts), math.inf, NONE_FIRED
    proposed, standing = state.clock.step, stands_shaken(model, state.regime, state.clock.time)
    if standing:
        left = min(left, step_while_standing(model, options, state.clock.time))
    if flying:
        length, spacing = flight_length(model, state.regime, state.q, state.u, options, state.clock.time)
        begin_flight(model, state.regime, state.q, state.u, state.clock.time, min(length, left), scratch.step)
        # A long flight would ask about cells far behind the first event.
        for p in range(len(model.pairs)):
            length = min(length, time_through_cells(model, p, state.q, state.u, scratch.step.bound, FLIGHT_CELLS))
        scratch.step.span.length = min(length, left)
        leave = first_turn(model, state.regime, state.q, state.u)
    else:
        longest = min(left, longest_step(options, state.clock.time), next_knot(model, state.clock.time) - state.clock.time)
        known, soonest = closing_expected(model, cells, state, options, min(longest, SOON * proposed), scratch)
        if not known:
            return Stop.CELL_UNKNOWN, False
        made, smallest = coupled_step(model, state, options, longest, soonest, scratch.smooth)
        if not made:
            return _without_step(model, state, options, scratch.smooth.held.jammed)
        leave, code = first_leave(model, state.regime, options, smallest, scratch.smooth, state.counts)
    step = scratch.step
    length = step.span.length
    if not flying and scratch.smooth.held.pinned:
        pin = first_pin(model, step)
        length, leave = min(length, pin), leave if leave <= pin else math.inf
    known, touch, contact = first_touch(model, cells, state, options, min(length, leave), scratch)
    if not known:
        state.clock.step = proposed
        return Stop.CELL_UNKNOWN, False
    fall = first_fall(model, state, min(length, touch, leave), options, scratch) if standing else math.inf
    if fall < math.inf:
        contact, leave, code = NO_CONTACT, fall, NONE_FIRED
    end = min(length, touch, leave)
    state.clock.time = end_time if end == remaining else step.span.start + end
    if flying:
        state.counts.flights += 1
        add_flight_sums(model, step, end, state.sums)
        keep_flight_rows(model, end, spacing, step, record, state.q, state.u, state.a)
    else:
        end, explained = accept_coupled(model, state, options, end, contact, scratch)
        if not explained:
            return Stop.UNEXPLAINED, False
        if end < min(length, touch, leave):
            state.clock.time = step.span.start + end
        keep_inner_rows(model, options, end, scratch.step, record)
        keep_row(record, state.clock.time, state.q, state.u, state.a)
    keep_passages(model, state, options, step, end, record)
    state.instant.touched = contact
    event = contact >= 0 or leave <= length
    if event:
        state.instant.struck = 1 + _note_end(state.regime.active, state.instant.awake_contacts, contact, code, scratch.ended)
    return Stop.RUNNING, event


@kernel
def _note_end(active, awake_contacts, contact, code, out_ended):
    """Remember what ended the step: `KINDS` times the contact (or bearing) that did, plus the kind of its monitor.

    Returns the contact, or NO_CONTACT where a bearing did.
    TOUCHED: it closed; BEARING: dry friction in the bearing of a coordinate holds or lets go. `code`: of the monitor that
    ended a coupled step.
    """
    if contact >= 0:
        what = KINDS * contact + TOUCHED
    elif code == NONE_FIRED:
        what = BEARING
    elif code >= MONITORS * awake_contacts:
        what = KINDS * (code - MONITORS * awake_contacts) + BEARING
    else:
        contact = active[code // MONITORS]
        what = KINDS * contact + code % MONITORS
    out_ended.by[out_ended.number % RECENT] = what
    out_ended.number += 1
    return contact


@kernel
def _reaches(model, state, options, end_time):
    """True if the next step, taken freely, might come as far as `end_time`."""
    longest = min(state.clock.step, longest_step(options, state.clock.time))
    if can_fly(model, state.regime.awake, state.instant.awake_contacts):
        longest, _ = flight_length(model, state.regime, state.q, state.u, options, state.clock.time)
    return longest >= end_time - state.clock.time


@kernel
def handle_waiting_event(model, cells, state, options, scratch, record):
    """Handle the waiting event; counts events that hardly let time advance."""
    if state.clock.time - state.clock.event > SAME_INSTANT * options.accumulation_time:
        state.instant.events, state.clock.event = 0, state.clock.time
        begin_instant(state.instant)
    elif state.instant.events > EVENTS_AT_ONCE:
        return Stop.TOO_MANY_EVENTS
    touched, blows = state.instant.touched, state.counts.impacts + state.counts.jams
    lost, rubbed = state.sums.impacts - state.sums.drive, state.sums.damping
    before = kinetic_energy(model, state.u)
    code = handle_event(model, cells, state, options, scratch, record)
    if code != Stop.RUNNING:
        return code
    state.worst.kinetic_energy = max(state.worst.kinetic_energy, before)
    moving = kinetic_energy(model, state.u)
    change = moving - before + (state.sums.impacts - state.sums.drive - lost) + (state.sums.damping - rubbed)
    if not is_explained(model, options, max(before, moving), change, max(state.worst.kinetic_energy, moving)):
        return Stop.UNEXPLAINED
    if state.counts.impacts + state.counts.jams > blows:
        state.instant.decisions = 0  # the same modes may be decided again: the velocities are others
    elif touched < 0 and not decide_once(key_of_modes(state.regime, state.instant), state.decided, state.instant):
        return Stop.TOO_MANY_EVENTS
    state.instant.events += 1
    state.counts.instants += 1
    keep_passages(model, state, options, scratch.step, 0.0, record)
    keep_row(record, state.clock.time, state.q, state.u, state.a)
    return Stop.RUNNING


@kernel
def _counted(counts):
    """Counts of what is done again once a cell is known."""
    return counts.steps, counts.rejected_steps, counts.evaluations, counts.gap_evaluations, counts.cells_looked_up


@kernel
def _undone(code, before, counts):
    """What is done again with the cell known counts once: work must not depend on what earlier runs have learnt."""
    if code == Stop.CELL_UNKNOWN:
        counts.steps, counts.rejected_steps, counts.evaluations, counts.gap_evaluations, counts.cells_looked_up = before
    return code


@kernel
def _loop(model, cells, state, options, until, scratch, record):
    """From step to step and event to event; see `advance`."""
    fill_inverse(model, state.regime.grip, scratch.work.system.inverse)
    while True:
        if not _room_left(record, len(state.regime.active)):
            return Stop.BUFFER_FULL
        before = _counted(state.counts)
        if state.instant.event_waits == 1:
            code = handle_waiting_event(model, cells, state, options, scratch, record)
            if code != Stop.RUNNING:
                return _undone(code, before, state.counts)
            continue
        if state.clock.time >= until.end:
            return Stop.DURATION
        if state.clock.time >= until.slice_end or until.steps <= 0.0:
            return Stop.SLICE
        if until.may_cut == 0 and _reaches(model, state, options, until.end):
            return Stop.LAST_STEP
        until.steps -= 1.0
        code, event = _smooth_step(model, cells, state, options, until.end, scratch, record)
        if code != Stop.RUNNING:
            return _undone(code, before, state.counts)
        code = check_state(model, state.q, state.u)
        if code != Stop.RUNNING:
            return code
        state.instant.event_waits = 1 if event else 0


@entry
def advance(model, cells, state, options, until, scratch, record):
    """Run to the time `until.end`, or return at the end of a slice: see `Until`; returns a Stop code.

    Before a step that the end might cut short it returns once, unless `until.may_cut` is set.

    All arguments but `until`, a record, are NamedTuples; `until.steps`, `state`, `scratch` and `record` are written to.
    """
    return _loop(
        ModelRef(*model),
        CellsRef(*cells),
        state_by_reference(state),
        OptionsRef(*options),
        until,
        scratch_by_reference(scratch),
        RecordRef(*record),
    )
