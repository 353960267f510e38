"""How does Moreau's time stepping go from step to step?"""

from __future__ import annotations

import math

from watchsim.candidates.cell_lookup import along
from watchsim.contact.kinematics import ClosedRef
from watchsim.dynamics.small_systems import copy
from watchsim.jit import entry, inlined, kernel
from watchsim.model.records import CellsRef, ModelRef
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.loop_state.buffers import RecordRef
from watchsim.simulation.loop_state.scratch import AskedRef
from watchsim.simulation.loop_state.state import StateRef
from watchsim.simulation.moreau.one_step import act, closed_at_middle, move
from watchsim.simulation.moreau.percussion_laws import LawsRef
from watchsim.simulation.moreau.percussions import stop_approaches
from watchsim.simulation.moreau.step_work import MoreauWorkRef
from watchsim.simulation.motion.turning_points import sign
from watchsim.simulation.options import OptionsRef
from watchsim.simulation.record.write_buffers import keep_event, keep_row
from watchsim.simulation.stops import Stop
from watchsim.tolerances import STEP_ROUNDING

ROWS_PER_STEP, EVENTS_PER_CONTACT = 3, 2


class Pace:
    """How far apart steps and rows are, s."""

    step: float
    row: float


@kernel
def _passages(model, state, h, work, q, u, record):
    """Turning points and rest passages of sprung bodies within the step that ends at (q, u): the step is a parabola."""
    for i in range(len(u)):
        coordinate = model.coordinates[i]
        if coordinate.watched == 1:
            _keep_of(model, state, h, (i, -1, coordinate.level), (state.q, work.u, q, u), record)
    for j in range(len(model.joints)):
        joint = model.joints[j]
        if joint.watched == 1:
            _keep_of(model, state, h, (joint.coordinate, joint.on, joint.rest), (state.q, work.u, q, u), record)


@kernel
def _keep_of(model, state, h, spring, ends, record):
    """The same for one spring, (coordinate, coordinate of the carrier or -1, rest); `ends`: q and u before and after."""
    start = state.clock.time
    i, on, rest = spring
    body = model.coordinates[i].body
    before, fast, after, last = along(ends[0], i, on), along(ends[1], i, on), along(ends[2], i, on), along(ends[3], i, on)
    bend = (last - fast) / h
    side = sign(last)
    if side != 0 and side != state.side_u[i]:
        if state.side_u[i] != 0:
            tau = h * fast / (fast - last) if fast * last < 0.0 else 0.0
            state.clock.time = start + tau
            keep_event(state, record, EventKind.TURN, -1, body, before + 0.5 * fast * tau)
        state.side_u[i] = side
    way, side = before - rest, sign(after - rest)
    if side != 0 and side != state.side_q[i]:
        if state.side_q[i] != 0:
            doubled = fast + math.copysign(math.sqrt(max(0.0, fast * fast - 2.0 * bend * way)), fast)
            # Towards the rest position it is passed at the first root; away from it, after the turn, at the second.
            tau = -doubled / bend if way * fast > 0.0 else -2.0 * way / doubled
            tau = min(h, max(0.0, tau))
            state.clock.time = start + tau
            keep_event(state, record, EventKind.CROSS, -1, body, fast + bend * tau)
        state.side_q[i] = side
    state.clock.time = start


@kernel
def _step(model, cells, state, options, h, whole, work, record):
    """One step of length h, of which `whole` is the usual one; returns a Stop code."""
    code, m = closed_at_middle(model, cells, state, options, h, work)
    if code != Stop.RUNNING:
        return code
    jump = stop_approaches(model, state, options, m, work, record)
    if jump:
        keep_row(state, record, state.clock.time, state.q, state.u, state.a)
        keep_row(state, record, state.clock.time, state.q, work.u, state.a)
    act(model, state, m, h, work, state.u)
    copy(state.q, work.start)
    move(model, state, options, m, h, work, state.u)
    for i in range(len(state.u)):
        if not math.isfinite(state.q[i] + state.u[i]):
            return Stop.NOT_FINITE
        # `_passages` looks from the start of the step to its end.
        work.q[i], state.q[i] = state.q[i], work.start[i]
    _passages(model, state, h, work, work.q, state.u, record)
    copy(work.q, state.q)
    state.counts.steps += 1
    state.clock.time = state.counts.steps * whole if h == whole else state.clock.time + h
    return Stop.RUNNING


@entry
def advance_fixed(model, cells, state, options, until, pace, work, record):
    """Run to `until.end` in steps of `pace.step`, with a row every `pace.row`, s; otherwise as `advance`."""
    return _loop(
        ModelRef(*model),
        CellsRef(*cells),
        StateRef(*state),
        OptionsRef(*options),
        until,
        pace,
        _by_reference(work),
        RecordRef(*record),
    )


@inlined
def _by_reference(work):
    """The scratch arrays as a struct; what holds structs itself names them first."""
    return MoreauWorkRef(ClosedRef(*work.closed), LawsRef(*work.laws), AskedRef(*work.asked), *work[3:])


@kernel
def _loop(model, cells, state, options, until, pace, work, record):
    while True:
        events = EVENTS_PER_CONTACT * len(work.closed.ids)
        if record.used.rows + ROWS_PER_STEP >= len(record.rows) or record.used.events + events >= len(record.events):
            return Stop.BUFFER_FULL
        if state.now.event_waits == 1:
            state.now.event_waits = 0
            keep_row(state, record, 0.0, state.q, state.u, state.a)
        left = until.end - state.clock.time
        if left <= 0.0:
            return Stop.DURATION
        if state.clock.time >= until.slice_end and until.slice_end < until.end:
            return Stop.SLICE
        last = left <= pace.step * (1.0 + STEP_ROUNDING)
        if last and until.may_cut == 0:
            return Stop.LAST_STEP
        h = pace.step if left >= pace.step * (1.0 - STEP_ROUNDING) else left
        code = _step(model, cells, state, options, h, pace.step, work, record)
        if code != Stop.RUNNING:
            return code
        if last:
            state.clock.time = until.end
        # Rows at least so often; the last one always.
        if last or state.clock.time - work.kept.row_time >= pace.row * (1.0 - STEP_ROUNDING):
            work.kept.row_time = state.clock.time
            keep_row(state, record, state.clock.time, state.q, state.u, state.a)
