"""How does Moreau's time stepping go from step to step?"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cell_lookup import UNKNOWN, along, candidate, candidates
from watchsim.contact.gaps import (
    OPEN,
    Closed,
    ClosedRef,
    closed_contacts,
    contact_kinematics,
    extent_margin,
    normal_gap,
    place,
    point_of,
    poses,
)
from watchsim.dynamics.delassus import copy, drive_through_contacts
from watchsim.dynamics.forces import (
    add_line_springs,
    bent_energy,
    bent_force,
    damping_rate,
    driving_force,
    joint_damping,
    joint_energy,
    line_spring_damping,
    line_spring_drive,
    line_spring_energy,
    push_back,
    stretch,
    table_force,
)
from watchsim.dynamics.moving_frame import add_inertial_forces
from watchsim.jit import by_reference, entry, inlined, kernel
from watchsim.model import CellsRef, Model, ModelRef, blank
from watchsim.simulation.closed_contacts import gives_no_way, is_immovable
from watchsim.simulation.moreau_percussions import (
    LOAD_SWEEPS,
    Laws,
    LawsRef,
    cone,
    fill_mobility,
    friction_cones,
    laws,
    push,
    rates_of,
    relax,
    solve_percussions,
    stop_approaches,
    within_loads,
)
from watchsim.simulation.options import OptionsRef
from watchsim.simulation.scratch import (
    CellRequest,
    CellRequestRef,
    RecordRef,
    cell_request,
    keep_event,
    keep_row,
    request_cell,
    state_by_reference,
)
from watchsim.simulation.state import EventKind, Stop, room_for
from watchsim.simulation.step_path import sign, turning_side
from watchsim.tolerances import STEP_ROUNDING, STRAY_PER_TOLERANCE, TAKEN_BACK, YIELD

# What does Moreau's time stepping keep from step to step, and where does it work?

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class KeptSteps:
    """What is kept from step to step."""

    depth: float  # deepest penetration of the last step, m
    row_time: float  # when the last row was written, s
    since_row: float  # steps made since then
    violation: float  # worst residual of the laws so far
    sweeps: int  # of relaxation so far


class MoreauWork(NamedTuple):
    """Room to work in; `memory` (percussions of the last step by contact), `kept`, `row_a` and `row_jerk` belong to the state.

    Rows of `rates` and `more` are those of `laws`: N, T of each of the m closed contacts, then the bearings.
    """

    closed: Closed
    laws: Laws
    requested: CellRequest
    memory: Array  # (contacts, 2)
    kept: KeptSteps
    pose: object
    q: Array  # at the middle of the step
    u: Array  # after the impacts, before the forces
    free: Array  # with the forces, without contacts
    foreseen: Array  # velocities at the middle as the last step foresees them
    bounds: Array  # of the friction of bearings with a load, in the round before
    start: Array  # coordinates at the start of the step
    before: Array  # velocities there, before impacts
    bend: Array  # accelerations of the step before
    row_a: Array  # accelerations at the last row
    row_jerk: Array  # and how fast they changed there, per s
    wound: Array  # by coordinate: twice the energy of its spring before positions are taken back
    force: Array  # drives and gravity at the middle
    damping: Array
    line: Array  # what line springs do to each coordinate
    joint: Array  # force of the damping between two coordinates
    mass: Array
    inverse: Array
    change: Array  # of velocities, by one percussion
    rates: Array
    more: Array
    restitution: Array
    dry: Integers  # coordinate of each bearing with dry friction


MoreauWorkRef = by_reference(MoreauWork, __name__)


def moreau_work(model: Model) -> MoreauWork:
    """Room for one model."""
    n, room = len(model.coordinates), room_for(model)
    loaded = list(model.bearings.coordinate)  # these first: they take part in impacts, too
    dry = np.array([*loaded, *(k for k in np.flatnonzero(model.coordinates.coulomb > 0.0) if k not in loaded)], np.int64)
    rows = 2 * room + len(dry)
    vectors = {
        name: np.zeros(n)
        for name in (
            "q",
            "u",
            "free",
            "force",
            "damping",
            "line",
            "mass",
            "inverse",
            "change",
            "foreseen",
            "start",
            "wound",
            "bounds",
        )
    }
    vectors |= {name: np.zeros(n) for name in ("before", "bend", "row_a", "row_jerk", "bounds")}
    by_row = {name: np.zeros(rows) for name in ("rates", "more")}
    return MoreauWork(
        memory=np.zeros((len(model.contacts), 2)),
        kept=blank(KeptSteps),
        pose=poses(len(model.bodies)),
        closed=closed_contacts(room),
        laws=laws(room, len(dry)),
        restitution=np.zeros(room),
        dry=dry,
        requested=cell_request(n),
        joint=np.zeros(len(model.joints)),
        **vectors,
        **by_row,
    )


# What does one step of Moreau's time stepping do?
#
# The contacts closed at the middle of the step take part. First what approaches is stopped and thrown back (compression and
# expansion, Poisson's law); then forces and contacts act together over the step, at its middle (theta = 1/2), without
# restitution; then penetration is taken back a little at a time, without touching velocities (docs/theory/method.md 6).


@kernel
def closed_at_middle(model, cells, state, options, h, work):
    """The contacts without a gap at the middle of the step, with kinematics, into `work.closed`.

    Returns (Stop code: RUNNING, CELL_UNKNOWN, TOO_MANY_CONTACTS or BLOCKED; their number).
    """
    for i in range(len(state.q)):
        work.q[i] = state.q[i] + 0.5 * h * state.u[i]
    place(model, work.q, state.u, work.pose)
    m = 0
    for p in range(len(model.pairs)):
        how, start, count = candidates(model, cells, p, work.q)
        if how == UNKNOWN:
            request_cell(work.requested, p, work.q)
            return Stop.CELL_UNKNOWN, m
        for place_in_list in range(start, start + count):
            k = candidate(model, cells, how, place_in_list)
            gap = normal_gap(model, k, work.pose).gap
            if gap > options.gap_close or (state.regime.mode[k] == OPEN and gap < -_believable(model, options, k, h, work)):
                continue
            if extent_margin(model, k, work.pose) >= -options.extent:
                if m == len(work.closed.ids):
                    return Stop.TOO_MANY_CONTACTS, m
                contact_kinematics(model, k, work.pose, m, work.closed)
                if gives_no_way(model, work.closed, m):
                    if work.closed.kin[m].gN_dot < -options.speed_zero and not is_immovable(model, work.closed, m):
                        state.instant.touched = k
                        return Stop.BLOCKED, m
                    continue
                m += 1
    return Stop.RUNNING, m


@kernel
def _believable(model, options, k, h, work):
    """How deep a contact that was open may be now; deeper, it is the far side of a part."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa, pb = work.pose[a.body], work.pose[b.body]
    ax, ay = point_of(pa, a.x, a.y)
    dx, dy = pa.x + ax - pb.x, pa.y + ay - pb.y
    vx = pa.vx - pa.w * ay - pb.vx + pb.w * dy
    vy = pa.vy + pa.w * ax - pb.vy - pb.w * dx
    # A neighbour on the outline takes over what the last contact had.
    return 2.0 * (h * math.sqrt(vx * vx + vy * vy) + work.kept.depth) + options.gap_close


@kernel
def _free_velocity(model, state, h, work):
    """Velocities after the step without contacts: springs and damping at its middle, drives at the middle's place."""
    for i in range(len(work.u)):
        work.force[i] = driving_force(model, i, work.q[i])
        work.damping[i] = damping_rate(model.coordinates[i], abs(work.u[i]))
    for j in range(len(model.tables)):
        table, force = model.tables[j], table_force(model, j, state.clock.time + 0.5 * h, work.q)
        work.force[table.coordinate] += force
        if table.on >= 0:
            push_back(model, table.on, force, work.force)
    for j in range(len(model.joints)):
        joint = model.joints[j]
        work.force[joint.coordinate] += joint.force
        push_back(model, joint.on, joint.force, work.force)
    if len(model.shocks) > 0:
        add_inertial_forces(model, state.clock.time + 0.5 * h, work.q, work.u, work.force)
    for i in range(len(work.u)):
        coordinate = model.coordinates[i]
        change = 0.5 * h * work.damping[i] + 0.25 * h * h * coordinate.stiffness
        work.mass[i] = coordinate.mass + change
        work.inverse[i] = 1.0 / work.mass[i]
        pull = work.force[i] - coordinate.stiffness * (state.q[i] - coordinate.rest)
        if coordinate.bent:
            pull += bent_force(model, i, work.q[i])
        work.free[i] = ((coordinate.mass - change) * work.u[i] + h * pull) * work.inverse[i]
        if coordinate.driven:
            work.inverse[i] = 0.0
    # Two coordinates at once would fill the matrix: what acts between them is taken at the middle as the last step foresees it.
    for i in range(len(work.u)):
        work.foreseen[i] = work.u[i] + 0.5 * h * state.a[i]
    for j in range(len(model.joints)):
        joint = model.joints[j]
        work.joint[j] = joint_damping(joint, work.foreseen)
        torque = work.joint[j] - joint.stiffness * stretch(joint, work.q)
        work.free[joint.coordinate] += h * torque * work.inverse[joint.coordinate]
        work.free[joint.on] -= h * torque * work.inverse[joint.on]
    if len(model.lines) > 0:
        work.line[:] = 0.0
        add_line_springs(model, work.q, work.foreseen, work.line)
        for i in range(len(work.u)):
            work.free[i] += h * work.line[i] * work.inverse[i]


@kernel
def _begin_percussions(model, m, options, h, work):
    """The laws of contacts and bearings in this step, and a first guess; returns the number of bearings."""
    laws, bearings = work.laws, len(work.dry)
    fill_mobility(work, m, bearings)
    rates_of(work, m, bearings, work.free, laws.b)
    friction_cones(model, m, work.u, options, work)
    for i in range(m):
        # Last step's percussions are a good guess at this one's.
        last = work.memory[work.closed.ids[i]]
        laws.P[2 * i], laws.P[2 * i + 1] = last[0], last[1]
    for k in range(bearings):
        j = work.dry[k]
        most = h * model.coordinates[j].coulomb
        laws.ends[m + k, 0], laws.ends[m + k, 2] = -most, most
        laws.P[2 * m + k] = -math.copysign(most, work.u[j]) if work.u[j] != 0.0 else 0.0
    return bearings


@kernel
def act(model, state, options, m, h, work, out_u):
    """Velocities at the end of the step: forces, contacts and dry bearings together, without restitution."""
    laws = work.laws
    _free_velocity(model, state, h, work)
    if m == 0 and len(work.dry) == 0:
        copy(work.free, out_u)
        return
    bearings = _begin_percussions(model, m, options, h, work)
    for _ in range(LOAD_SWEEPS):
        solve_percussions(state, m, bearings, work)
        copy(work.free, out_u)
        push(work, m, bearings, laws.P, out_u)
        if within_loads(model, m, (state.clock.time + 0.5 * h, h), laws.P, work.u, out_u, work):
            break
    rates_of(work, m, bearings, work.u, laws.b)
    rates_of(work, m, bearings, out_u, work.rates)
    for i in range(m):
        N, T = 2 * i, 2 * i + 1
        state.sums.correction -= 0.5 * laws.P[N] * (laws.b[N] + work.rates[N])
        state.sums.friction -= 0.5 * laws.P[T] * (laws.b[T] + work.rates[T])
    for i in range(len(work.u)):
        work.foreseen[i] = 0.5 * (work.u[i] + out_u[i])
    state.sums.drive += drive_through_contacts(model, work.closed, m, laws.P, work.foreseen)
    for row in range(2 * m, 2 * m + bearings):
        state.sums.damping -= 0.5 * laws.P[row] * (laws.b[row] + work.rates[row])


@kernel
def move(model, state, options, m, h, work, u):
    """Positions at the end of the step, with the sums of work; `u` holds the velocities there."""
    for i in range(len(u)):
        coordinate = model.coordinates[i]
        mean = 0.5 * (work.u[i] + u[i])
        state.q[i] += h * mean
        if coordinate.bent:  # taken at the middle: what it does beyond its energy is the method's error
            state.sums.correction -= h * mean * bent_force(model, i, work.q[i]) - bent_energy(model, i, work.start[i])
        if not coordinate.driven:
            state.sums.drive += h * mean * work.force[i]
        state.sums.damping += h * work.damping[i] * mean * mean
        state.a[i] = (u[i] - work.u[i]) / h
        work.wound[i] = coordinate.stiffness * (state.q[i] - coordinate.rest) ** 2
    for j in range(len(model.joints)):
        joint = model.joints[j]
        way = 0.5 * h * (work.u[joint.coordinate] + u[joint.coordinate] - work.u[joint.on] - u[joint.on])
        state.sums.damping -= work.joint[j] * way
        if model.coordinates[joint.on].driven:
            held = work.joint[j] - joint.stiffness * stretch(joint, work.q)
            state.sums.drive += 0.5 * h * (work.u[joint.on] + u[joint.on]) * held
        spent = joint.stiffness * way * (stretch(joint, state.q) - 0.5 * way - stretch(joint, work.q))
        state.sums.correction -= spent
    _book_line_springs(model, state, h, work, u)
    wound = joint_energy(model, state.q) + line_spring_energy(model, state.q)
    _take_back(state, options, m, work)
    state.sums.correction -= joint_energy(model, state.q) + line_spring_energy(model, state.q) - wound
    for i in range(len(u)):
        coordinate = model.coordinates[i]
        after = coordinate.stiffness * (state.q[i] - coordinate.rest) ** 2
        state.sums.correction -= 0.5 * (after - work.wound[i])
        if coordinate.bent:
            state.sums.correction -= bent_energy(model, i, state.q[i])


@kernel
def _book_line_springs(model, state, h, work, u):
    """Damping and drives of line springs over the step; what their forces do beyond that is the method's error."""
    if len(model.lines) == 0:
        return
    done = line_spring_energy(model, state.q) - line_spring_energy(model, work.start)
    for i in range(len(u)):
        done += work.line[i] * 0.5 * h * (work.u[i] + u[i])
    taken = h * line_spring_damping(model, work.q, work.foreseen)
    driven = h * line_spring_drive(model, work.q, work.foreseen)
    state.sums.damping += taken
    state.sums.drive += driven
    state.sums.correction -= done + taken - driven


@kernel
def _take_back(state, options, m, work):
    """A share of the penetrations at the middle, by the smallest change of positions; remember who is closed."""
    laws = work.laws
    state.regime.mode[:] = 0
    work.memory[:] = 0.0
    work.kept.depth = 0.0
    slop = 0.5 * options.gap_close
    any_deep = False
    for i in range(m):
        k = work.closed.ids[i]
        state.regime.mode[k] = 1
        work.memory[k, 0], work.memory[k, 1] = laws.P[2 * i], laws.P[2 * i + 1]
        depth = -work.closed.kin[i].g
        work.kept.depth = max(work.kept.depth, depth)
        laws.b[2 * i], laws.b[2 * i + 1] = -TAKEN_BACK * max(0.0, depth - slop), 0.0
        laws.low[i] = 0.0
        cone(laws.ends, i, 0.0)
        any_deep = any_deep or depth > slop
    state.worst.penetration = max(state.worst.penetration, work.kept.depth)
    if not any_deep:
        return
    for i in range(m):
        laws.P[2 * i], laws.P[2 * i + 1] = 0.0, 0.0
        laws.G[2 * i, 2 * i] *= 1.0 + YIELD
    relax(laws, m, 0)
    push(work, m, 0, laws.P, state.q)


ROWS_PER_STEP, EVENTS_PER_CONTACT = 4, 2


class Pace:
    """How far apart steps and rows are, s."""

    step: float
    row: float


@kernel
def _passages(model, state, options, h, work, q, u, record):
    """Turning points and rest passages of sprung bodies within the step that ends at (q, u): the step is a parabola."""
    for i in range(len(u)):
        coordinate = model.coordinates[i]
        if coordinate.watched == 1:
            _keep_of(model, state, options, h, (i, -1, coordinate.level), (state.q, work.u, q, u), record)
    for j in range(len(model.joints)):
        joint = model.joints[j]
        if joint.watched == 1:
            _keep_of(model, state, options, h, (joint.coordinate, joint.on, joint.rest), (state.q, work.u, q, u), record)


@kernel
def _keep_of(model, state, options, h, spring, ends, record):
    """The same for one spring, (coordinate, coordinate of the carrier or -1, rest); `ends`: q and u before and after."""
    start = state.clock.time
    i, on, rest = spring
    body = model.coordinates[i].body
    before, fast, after, last = along(ends[0], i, on), along(ends[1], i, on), along(ends[2], i, on), along(ends[3], i, on)
    bend = (last - fast) / h
    side = turning_side(last, model.coordinates[i], options)
    if side != 0 and side != state.side_u[i]:
        if state.side_u[i] != 0:
            tau = h * fast / (fast - last) if fast * last < 0.0 else 0.0
            state.clock.time = start + tau
            keep_event(record, state.clock, state.counts, EventKind.TURN, -1, body, before + 0.5 * fast * tau)
        state.side_u[i] = side
    way, side = before - rest, sign(after - rest)
    if side != 0 and side != state.side_q[i]:
        if state.side_q[i] != 0:
            doubled = fast + math.copysign(math.sqrt(max(0.0, fast * fast - 2.0 * bend * way)), fast)
            # Towards the rest position it is passed at the first root; away from it, after the turn, at the second.
            tau = -doubled / bend if way * fast > 0.0 else -2.0 * way / doubled
            tau = min(h, max(0.0, tau))
            state.clock.time = start + tau
            keep_event(record, state.clock, state.counts, EventKind.CROSS, -1, body, fast + bend * tau)
        state.side_q[i] = side
    state.clock.time = start


# Between rows the motion is a polynomial through q, u and a at both (`Trajectory.sample`). What it misses is the way that the
# acceleration strays from a straight line: where that is more than the tolerance, as at impacts, at reversals of slips and
# where contacts close or open, a row stands at the start of the step in which it happens, before it and after it.


@kernel
def _strays(model, state, options, h, work):
    """True if rows further apart than to the start of this step, which is done, would miss part of the way."""
    kept, stray = work.kept, 0.0
    apart = state.clock.time - kept.row_time + h
    for i in range(len(state.a)):
        if kept.since_row == 1.0:
            work.row_jerk[i] = (state.a[i] - work.row_a[i]) / h
        off = state.a[i] - work.row_a[i] - work.row_jerk[i] * (kept.since_row * h)
        stray = max(stray, abs(off) / model.coordinates[i].scale)
    return stray * apart * apart > STRAY_PER_TOLERANCE * options.tolerance


@kernel
def _keep_rows(model, state, options, jump, h, longest, work, record):
    """Rows at the start of the step just made, `longest` seconds after the last one at the latest.

    `state.q` is that at the start, `state.a` the acceleration in the step. `jump`: there were impacts.
    """
    kept, time = work.kept, state.clock.time
    first = state.counts.steps == 0
    kinked = jump or first or _strays(model, state, options, h, work)
    if kinked or time - kept.row_time >= longest * (1.0 - STEP_ROUNDING):
        if jump or not first:
            keep_row(record, time, state.q, work.before, work.bend)
        if kinked:
            keep_row(record, time, state.q, work.u, state.a)
        for i in range(len(state.a)):
            work.row_a[i] = state.a[i] if kinked else work.bend[i]
            work.row_jerk[i] = 0.0 if kinked else (state.a[i] - work.bend[i]) / h
        kept.row_time, kept.since_row = time, 0.0 if kinked else 1.0
    kept.since_row += 1.0


@kernel
def _step(model, cells, state, options, h, pace, work, record):
    """One step of length h, of which `pace.step` is the usual one; returns a Stop code."""
    code, m = closed_at_middle(model, cells, state, options, h, work)
    if code != Stop.RUNNING:
        return code
    copy(state.u, work.before)
    copy(state.a, work.bend)
    jump = stop_approaches(model, state, options, m, work, record)
    act(model, state, options, m, h, work, state.u)
    copy(state.q, work.start)
    move(model, state, options, m, h, work, state.u)
    for i in range(len(state.u)):
        if not math.isfinite(state.q[i] + state.u[i]):
            return Stop.NOT_FINITE
        # `_passages` looks from the start of the step to its end.
        work.q[i], state.q[i] = state.q[i], work.start[i]
    _passages(model, state, options, h, work, work.q, state.u, record)
    _keep_rows(model, state, options, jump, h, pace.row, work, record)
    copy(work.q, state.q)
    state.counts.steps += 1
    state.clock.time = state.counts.steps * h if h == pace.step else state.clock.time + h
    return Stop.RUNNING


@entry
def advance_fixed(model, cells, state, options, until, pace, work, record):
    """Run to `until.end` in steps of `pace.step`, with a row every `pace.row`, s; otherwise as `advance`."""
    return _loop(
        ModelRef(*model),
        CellsRef(*cells),
        state_by_reference(state),
        OptionsRef(*options),
        until,
        pace,
        _by_reference(work),
        RecordRef(*record),
    )


@inlined
def _by_reference(work):
    """The scratch arrays as a struct; what holds structs itself names them first."""
    return MoreauWorkRef(ClosedRef(*work.closed), LawsRef(*work.laws), CellRequestRef(*work.requested), *work[3:])


@kernel
def _loop(model, cells, state, options, until, pace, work, record):
    while True:
        events = EVENTS_PER_CONTACT * len(work.closed.ids)
        if record.used.rows + ROWS_PER_STEP >= len(record.rows) or record.used.events + events >= len(record.events):
            return Stop.BUFFER_FULL
        if state.instant.event_waits == 1:
            state.instant.event_waits = 0
        left = until.end - state.clock.time
        if left <= 0.0:
            return Stop.DURATION
        if state.clock.time >= until.slice_end and until.slice_end < until.end:
            return Stop.SLICE
        last = left <= pace.step * (1.0 + STEP_ROUNDING)
        if last and until.may_cut == 0:
            return Stop.LAST_STEP
        h = pace.step if left >= pace.step * (1.0 - STEP_ROUNDING) else left
        code = _step(model, cells, state, options, h, pace, work, record)
        if code != Stop.RUNNING:
            return code
        if last:
            state.clock.time = until.end
            keep_row(record, until.end, state.q, state.u, state.a)
