"""How does a simulation go from event to event?

The event loop: one smooth step (an exact flight where nothing couples the moving bodies), the first event in it, the
step up to that event, and what follows the event. It is left only for a reason that `Stop` names.
"""

from __future__ import annotations

import math

from watchsim.candidates.cell_lookup import time_through_cells
from watchsim.dynamics.applied_forces import next_knot
from watchsim.dynamics.delassus import fill_inverse
from watchsim.jit import entry, kernel
from watchsim.model.records import CellsRef, ModelRef
from watchsim.simulation.accepted_step import accept_coupled
from watchsim.simulation.events.after_event import settle
from watchsim.simulation.events.impulse_check import is_explained, kinetic_energy
from watchsim.simulation.events.mode_recurrence import begin_instant, decide_once, forget_decisions
from watchsim.simulation.first_closing.time_of_impact import first_touch
from watchsim.simulation.loop_state.buffers import RecordRef
from watchsim.simulation.loop_state.scratch import MONITORS, RECENT, scratch_by_reference
from watchsim.simulation.loop_state.state import StateRef
from watchsim.simulation.motion.contact_mode_end import NONE_FIRED, first_leave, first_turn
from watchsim.simulation.motion.free_flight import (
    FLIGHT_PHASE,
    add_flight_sums,
    begin_flight,
    can_fly,
    flight_length,
    keep_flight_rows,
)
from watchsim.simulation.motion.integrator import coupled_step
from watchsim.simulation.motion.row_times import keep_inner_rows
from watchsim.simulation.motion.turning_points import keep_passages
from watchsim.simulation.options import OptionsRef
from watchsim.simulation.record.write_buffers import keep_row
from watchsim.simulation.stops import Stop
from watchsim.tolerances import FINEST_ROWS, FURTHEST_SIZES, SAME_INSTANT

TOUCHED, BEARING, KINDS = MONITORS, MONITORS + 1, MONITORS + 2  # what ends a step, besides the monitors of a contact
FLIGHT_CELLS = 128
EVENTS_AT_ONCE = 2000
ROWS_PER_STEP = math.ceil(FLIGHT_PHASE / FINEST_ROWS) + 8
EVENTS_PER_CONTACT = 20


@kernel
def where_it_is(model, q, u):
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
def _smooth_step(model, cells, state, options, end_time, scratch, record):
    """One smooth step up to its first event; returns (Stop code, event?)."""
    left = end_time - state.clock.time
    flying, spacing, code = can_fly(model, state), math.inf, NONE_FIRED
    proposed = state.clock.step
    if flying:
        length, spacing = flight_length(model, state, options)
        begin_flight(model, state, min(length, left), scratch.step)
        # A long flight would ask about cells far behind the first event.
        for p in range(len(model.pairs)):
            length = min(length, time_through_cells(model, p, state.q, state.u, scratch.step.bound, FLIGHT_CELLS))
        scratch.step.span.length = min(length, left)
        leave = first_turn(model, state)
    else:
        longest = min(left, options.max_step, next_knot(model, state.clock.time) - state.clock.time)
        made, smallest = coupled_step(model, state, options, longest, scratch)
        if not made:
            return Stop.STEP_TOO_SMALL, False
        leave, code = first_leave(model, state, options, smallest, scratch)
    step = scratch.step
    length = step.span.length
    known, touch, contact = first_touch(model, cells, state, options, min(length, leave), scratch)
    if not known:
        state.clock.step = proposed
        return Stop.CELL_UNKNOWN, False
    end = min(length, touch, leave)
    state.clock.time = end_time if end == left else step.span.start + end
    if flying:
        state.counts.flights += 1
        add_flight_sums(model, state, step, end)
        keep_flight_rows(model, state, end, spacing, scratch.step, record)
    else:
        end, explained = accept_coupled(model, state, options, end, contact, scratch)
        if not explained:
            return Stop.UNEXPLAINED, False
        if end < min(length, touch, leave):
            state.clock.time = step.span.start + end
        keep_inner_rows(model, options, end, scratch.step, record)
        keep_row(state, record, state.clock.time, state.q, state.u, state.a)
    keep_passages(model, state, step, end, record)
    state.now.touched = contact
    event = contact >= 0 or leave <= length
    if event:
        _note_end(state, contact, code, scratch.ended)
    return Stop.RUNNING, event


@kernel
def _note_end(state, contact, code, ended):
    """Remember what ended the step: `KINDS` times the contact (or bearing) that did, plus the kind of its monitor.

    TOUCHED: it closed; BEARING: dry friction in the bearing of a coordinate holds or lets go. `code`: of the monitor that
    ended a coupled step.
    """
    if contact >= 0:
        what = KINDS * contact + TOUCHED
    elif code == NONE_FIRED:
        what = BEARING
    elif code >= MONITORS * state.now.awake_contacts:
        what = KINDS * (code - MONITORS * state.now.awake_contacts) + BEARING
    else:
        what = KINDS * state.active[code // MONITORS] + code % MONITORS
    ended.by[ended.number % RECENT] = what
    ended.number += 1


@kernel
def _reaches(model, state, options, end_time):
    """True if the next step, taken freely, might come as far as `end_time`."""
    longest = min(state.clock.step, options.max_step)
    if can_fly(model, state):
        longest, _ = flight_length(model, state, options)
    return longest >= end_time - state.clock.time


@kernel
def _settle(model, cells, state, options, scratch, record):
    """Handle the waiting event; counts events that hardly let time advance."""
    if state.clock.time - state.clock.event > SAME_INSTANT * options.accumulation_time:
        state.now.events, state.clock.event = 0, state.clock.time
        begin_instant(state)
    elif state.now.events > EVENTS_AT_ONCE:
        return Stop.TOO_MANY_EVENTS
    touched, blows = state.now.touched, state.counts.impacts + state.counts.jams
    lost = state.sums.impacts - state.sums.drive
    before = kinetic_energy(model, state.u)
    code = settle(model, cells, state, options, scratch, record)
    if code != Stop.RUNNING:
        return code
    state.worst.kinetic_energy = max(state.worst.kinetic_energy, before)
    moving = kinetic_energy(model, state.u)
    after = moving + (state.sums.impacts - state.sums.drive - lost)
    # Where a driven body strikes what is at rest, all energy comes in at this instant, with its rounding.
    if not is_explained(model, options, before, after, max(state.worst.kinetic_energy, moving)):
        return Stop.UNEXPLAINED
    if state.counts.impacts + state.counts.jams > blows:
        forget_decisions(state)
    elif touched < 0 and not decide_once(state):
        return Stop.TOO_MANY_EVENTS
    state.now.events += 1
    state.counts.instants += 1
    keep_passages(model, state, scratch.step, 0.0, record)
    keep_row(state, record, state.clock.time, state.q, state.u, state.a)
    return Stop.RUNNING


@kernel
def _work_done(state):
    """Counts of what is done again once a cell is known."""
    counts = state.counts
    return counts.steps, counts.rejected_steps, counts.evaluations, counts.gap_evaluations, counts.cells_looked_up


@kernel
def _undone(code, state, before):
    """What is done again with the cell known counts once: work must not depend on what earlier runs have learnt."""
    if code == Stop.CELL_UNKNOWN:
        counts = state.counts
        counts.steps, counts.rejected_steps, counts.evaluations, counts.gap_evaluations, counts.cells_looked_up = before
    return code


@kernel
def _loop(model, cells, state, options, until, scratch, record):
    """From step to step and event to event; see `advance`."""
    fill_inverse(model, state.grip, scratch.work.inverse)
    while True:
        if not _room_left(record, len(state.active)):
            return Stop.BUFFER_FULL
        before = _work_done(state)
        if state.now.event_waits == 1:
            code = _settle(model, cells, state, options, scratch, record)
            if code != Stop.RUNNING:
                return _undone(code, state, before)
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
            return _undone(code, state, before)
        code = where_it_is(model, state.q, state.u)
        if code != Stop.RUNNING:
            return code
        state.now.event_waits = 1 if event else 0


@entry
def advance(model, cells, state, options, until, scratch, record):
    """Run to the time `until.end`, or return at the end of a slice: see `Until`; returns a Stop code.

    Before a step that the end might cut short it returns once, unless `until.may_cut` is set.

    All arguments but `until`, a record, are NamedTuples; `until.steps`, `state`, `scratch` and `record` are written to.
    """
    return _loop(
        ModelRef(*model),
        CellsRef(*cells),
        StateRef(*state),
        OptionsRef(*options),
        until,
        scratch_by_reference(scratch),
        RecordRef(*record),
    )
