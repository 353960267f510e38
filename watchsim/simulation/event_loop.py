"""How does a simulation go from event to event?

The event loop (`advance`): one smooth step (an exact flight where nothing couples the moving bodies), the first event in it,
the step up to that event, and what follows the event (events.py). It is left only for a reason that `Stop` names.
"""

from __future__ import annotations

import math

from watchsim.contact.cell_lookup import time_through_cells
from watchsim.contact.gaps import OPEN, normal_gap, place
from watchsim.dynamics.delassus import fill_inverse
from watchsim.dynamics.forces import next_knot
from watchsim.jit import entry, kernel
from watchsim.model import CellsRef, ModelRef
from watchsim.simulation.closed_contacts import is_explained, kinetic_energy, refresh
from watchsim.simulation.coupled_motion import motion, place_contacts, project_positions, project_velocities
from watchsim.simulation.dop853 import dense_value
from watchsim.simulation.events import handle_event
from watchsim.simulation.first_closing import first_touch
from watchsim.simulation.free_motion import flow
from watchsim.simulation.integrator import NONE_FIRED, coupled_step, first_leave, first_turn
from watchsim.simulation.modes import begin_instant, decide_once, key_of_modes
from watchsim.simulation.options import OptionsRef, longest_step
from watchsim.simulation.scratch import MONITORS, RECENT, SUMS, RecordRef, keep_row, scratch_by_reference, state_by_reference
from watchsim.simulation.state import NO_CONTACT, Stop
from watchsim.simulation.step_path import (
    FLIGHT_PHASE,
    add_flight_sums,
    begin_flight,
    can_fly,
    flight_length,
    keep_flight_rows,
    keep_inner_rows,
    keep_passages,
)
from watchsim.tolerances import DEPENDENT_IN_STEPS, FINEST_ROWS, FURTHEST_SIZES, HIDDEN_REBOUND, RATES_TURNED, SAME_INSTANT

TOUCHED, BEARING, KINDS = MONITORS, MONITORS + 1, MONITORS + 2  # what ends a step, besides the monitors of a contact
FLIGHT_CELLS = 128
EVENTS_AT_ONCE = 2000
ROWS_PER_STEP = math.ceil(FLIGHT_PHASE / FINEST_ROWS) + 8
EVENTS_PER_CONTACT = 20
NEWTON_STEPS = 6


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
    flying, spacing, code = can_fly(model, state.regime.awake, state.instant.awake_contacts), math.inf, NONE_FIRED
    proposed = state.clock.step
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
        made, smallest = coupled_step(model, state, options, longest, scratch.smooth)
        if not made:
            return Stop.STEP_TOO_SMALL, False
        leave, code = first_leave(model, state.regime, options, smallest, scratch.smooth, state.counts)
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
    keep_passages(model, state, step, end, record)
    state.instant.touched = contact
    event = contact >= 0 or leave <= length
    if event:
        _note_end(state.regime.active, state.instant.awake_contacts, contact, code, scratch.ended)
    return Stop.RUNNING, event


# The path of a step drifts off the contacts in force. Drift is taken back, and a contact that ends the step closes where that
# has been done (docs/theory/method.md 2.10): the next one of two nearly parallel faces would be met late otherwise.


@kernel
def accept_coupled(model, state, options, end, touched, scratch):
    """Bring the state to time `end` of a coupled step, or to when `touched` closes: sums, positions and velocities.

    Returns (that time, True; False where drift is no rounding).
    """
    before = _follow_step(model, state, options, end, scratch)
    if touched != NO_CONTACT:
        end, before = _follow_to_touch(model, state, options, (end, before), touched, scratch)
    smooth = scratch.smooth
    n = len(model.coordinates)
    state.sums.drive += smooth.y[2 * n]
    state.sums.damping += smooth.y[2 * n + 1]
    state.sums.friction += smooth.y[2 * n + 2]
    for i in range(n):
        state.a[i] = smooth.dy[n + i]
    state.worst.kinetic_energy = max(state.worst.kinetic_energy, before)
    return end, is_explained(model, options, before, kinetic_energy(model, state.u), state.worst.kinetic_energy)


@kernel
def _follow_to_touch(model, state, options, followed, touched, scratch):
    """Bring the state, which is where a coupled step ends, to where contact `touched` closes on the way without drift.

    `followed` and what is returned: (time, kinetic energy before drift is taken back, J). The end of the step stays the end
    where the contact does not close before. Between nearly parallel faces the drift of a contact in force is a long way to the
    next face.
    """
    pose, (end, before) = scratch.smooth.pose, followed
    tau, kinetic = end, before
    for _ in range(NEWTON_STEPS):
        place(model, state.q, state.u, pose)
        look = normal_gap(model, touched, pose)
        if abs(look.gap) <= HIDDEN_REBOUND * options.gap_zero:
            return tau, kinetic
        if (tau == end and look.gap > 0.0) or look.rate >= 0.0:
            break
        earlier = min(tau - look.gap / look.rate, end)
        if earlier <= 0.0:
            break
        tau, kinetic = earlier, _follow_step(model, state, options, earlier, scratch)
    if tau < end:
        _follow_step(model, state, options, end, scratch)
    return end, before


@kernel
def _follow_step(model, state, options, end, scratch):
    """Positions and velocities at time `end` of a coupled step, drift taken back; returns the kinetic energy before that, J."""
    step, smooth, projection = scratch.step, scratch.smooth, scratch.projection
    closed, pose, inverse = smooth.closed, smooth.pose, scratch.work.system.inverse
    n = len(model.coordinates)
    for i in range(2 * n + SUMS):
        value = dense_value(step, i, end) if end < step.span.length else step.y1[i]
        smooth.y[i] = value
        if i < n:
            state.q[i] = value
        elif i < 2 * n:
            state.u[i - n] = value
    for i in range(n):
        coordinate = model.coordinates[i]
        if coordinate.driven and coordinate.linear:  # known in closed form: no error of steps adds up
            state.q[i], state.u[i] = flow(coordinate, OPEN, step.y0[i], step.y0[n + i], end)
            smooth.y[i], smooth.y[n + i] = state.q[i], state.u[i]
    motion(model, state.regime, options, step.span.start + end, smooth, state.counts)
    before = kinetic_energy(model, state.u)
    first = 0
    while first < state.instant.awake_contacts:
        m = place_contacts(model, state.regime.active, first, state.regime.upto[first], pose, closed)
        deepest = project_positions(closed, m, True, options.behind, inverse, projection, state.q)
        state.worst.penetration = max(state.worst.penetration, deepest)
        if _turns_rates(model, state.u, options, m, closed):
            place(model, state.q, state.u, pose)
            refresh(model, m, closed, pose)
        project_velocities(closed, m, state.regime.mode, DEPENDENT_IN_STEPS, inverse, projection, state.u)
        first += m
    return before


@kernel
def _turns_rates(model, u, options, m, closed):
    """True if taking back the gaps of the m contacts changes their rates, by the gap times how fast bodies turn."""
    furthest, fastest = 0.0, 0.0
    for i in range(m):
        furthest = max(furthest, abs(closed.kin[i].g))
    for i in range(len(u)):
        fastest = max(fastest, abs(u[i]) / model.coordinates[i].scale)
    return furthest * fastest > RATES_TURNED * options.speed_zero


@kernel
def _note_end(active, awake_contacts, contact, code, out_ended):
    """Remember what ended the step: `KINDS` times the contact (or bearing) that did, plus the kind of its monitor.

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
        what = KINDS * active[code // MONITORS] + code % MONITORS
    out_ended.by[out_ended.number % RECENT] = what
    out_ended.number += 1


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
    lost = state.sums.impacts - state.sums.drive
    before = kinetic_energy(model, state.u)
    code = handle_event(model, cells, state, options, scratch, record)
    if code != Stop.RUNNING:
        return code
    state.worst.kinetic_energy = max(state.worst.kinetic_energy, before)
    moving = kinetic_energy(model, state.u)
    after = moving + (state.sums.impacts - state.sums.drive - lost)
    # Where a driven body strikes what is at rest, all energy comes in at this instant, with its rounding.
    if not is_explained(model, options, before, after, max(state.worst.kinetic_energy, moving)):
        return Stop.UNEXPLAINED
    if state.counts.impacts + state.counts.jams > blows:
        state.instant.decisions = 0  # the same modes may be decided again: the velocities are others
    elif touched < 0 and not decide_once(key_of_modes(state.regime, state.instant), state.decided, state.instant):
        return Stop.TOO_MANY_EVENTS
    state.instant.events += 1
    state.counts.instants += 1
    keep_passages(model, state, scratch.step, 0.0, record)
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
        code = where_it_is(model, state.q, state.u)
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
