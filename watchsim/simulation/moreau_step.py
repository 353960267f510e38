"""What does one step of Moreau's time stepping do?

The contacts closed at the middle of the step take part. First what approaches is stopped and thrown back (compression and
expansion, Poisson's law); then forces and contacts act together over the step, at its middle (theta = 1/2), without
restitution; then penetration is taken back a little at a time, without touching velocities (docs/method.md 4).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import extent_margin, normal_gap
from watchsim.contact.kinematics import Closed, closed_contacts, contact_kinematics
from watchsim.contact.lookup import UNKNOWN, candidate, candidates
from watchsim.contact.poses import place, point_of, poses
from watchsim.dynamics.forces import driving_force, joint_damping, joint_energy, stretch, table_force
from watchsim.dynamics.linear import copy
from watchsim.jit import by_reference, kernel
from watchsim.mechanism.model import Model
from watchsim.simulation.keep import keep_event
from watchsim.simulation.moreau_prox import SWEEPS, fill_mobility, push, rates_of, relax, residual
from watchsim.simulation.state import CORRECTION, DAMPING, DRIVE, FRICTION, IMPACTS, N_IMPACTS, N_LCP, N_LCP_FAILED, ROOM

Array = NDArray[np.float64]

IMPACT_EVENT = 1
TAKEN_BACK = 0.2  # share of a penetration beyond `slop` taken back in a step


class MoreauWork(NamedTuple):
    """Room to work in; `memory` (percussions of the last step by contact) and `depth` belong to the state."""

    memory: Array  # (contacts, 2)
    depth: Array  # deepest penetration of the last step, m
    pose: object
    closed: Closed
    q: Array  # at the middle of the step
    u: Array  # after the impacts, before the forces
    free: Array  # with the forces, without contacts
    force: Array  # drives and gravity at the middle
    damping: Array
    joint: Array  # torque of the damping between a carried body and its carrier
    mass: Array
    inverse: Array
    G: Array
    b: Array
    rates: Array
    more: Array
    P: Array
    low: Array
    friction: Array
    restitution: Array
    unknown: NDArray[np.int64]
    at: Array
    sweeps: NDArray[np.int64]
    worst: Array  # residual of the laws


MoreauWorkRef = by_reference(MoreauWork, __name__)


def moreau_work(model: Model) -> MoreauWork:
    """Room for one model."""
    n, rows = len(model.coordinates), 2 * ROOM
    vectors = {name: np.zeros(n) for name in ("q", "u", "free", "force", "damping", "joint", "mass", "inverse", "at")}
    by_row = {name: np.zeros(rows) for name in ("b", "rates", "more", "P")}
    by_contact = {name: np.zeros(ROOM) for name in ("low", "friction", "restitution")}
    return MoreauWork(
        memory=np.zeros((len(model.contacts), 2)),
        depth=np.zeros(1),
        pose=poses(len(model.bodies)),
        closed=closed_contacts(ROOM),
        G=np.zeros((rows, rows)),
        unknown=np.zeros(1, np.int64),
        sweeps=np.zeros(1, np.int64),
        worst=np.zeros(1),
        **vectors,
        **by_row,
        **by_contact,
    )


@kernel
def closed_at_middle(model, cells, state, options, h, work):
    """The contacts without a gap at the middle of the step, with kinematics, into `work.closed`.

    Returns their number, -1 when a cell is unknown, -2 when there are too many.
    """
    for i in range(len(state.q)):
        work.q[i] = state.q[i] + 0.5 * h * state.u[i]
    place(model, work.q, state.u, work.pose)
    m = 0
    for p in range(len(model.pairs)):
        how, start, count = candidates(model, cells, p, work.q)
        if how == UNKNOWN:
            work.unknown[0] = p
            copy(work.q, work.at)
            return -1
        for place_in_list in range(start, start + count):
            k = candidate(model, cells, how, place_in_list)
            gap, _, _, _ = normal_gap(model, k, work.pose)
            if gap > 0.0 or (state.mode[k] == 0 and gap < -_believable(model, options, k, h, work)):
                continue
            if extent_margin(model, k, work.pose) >= -options.extent:
                if m == ROOM:
                    return -2
                contact_kinematics(model, k, work.pose, m, work.closed)
                m += 1
    return m


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
    return 2.0 * (h * math.sqrt(vx * vx + vy * vy) + work.depth[0]) + options.gap_close


@kernel
def _relax(state, m, work):
    sweeps = relax(work.G, work.b, work.low, work.friction, m, work.P)
    state.counts[N_LCP] += 1
    work.sweeps[0] += min(sweeps, SWEEPS)
    if sweeps > SWEEPS:
        state.counts[N_LCP_FAILED] += 1
    work.worst[0] = max(work.worst[0], residual(work.G, work.b, work.low, work.friction, m, work.P))


@kernel
def stop_approaches(model, state, options, m, work, record):
    """Impacts at the start of the step, into `work.u`; True if any is fast enough to be written down."""
    closed = work.closed
    copy(state.u, work.u)
    rates_of(closed, m, work.u, work.b)
    fastest = 0.0
    for i in range(m):
        fastest = max(fastest, -work.b[2 * i])
    if fastest == 0.0:
        return False
    for i in range(len(work.u)):
        work.inverse[i] = 1.0 / model.coordinates[i].mass
    fill_mobility(closed, m, work.inverse, work.G)
    for i in range(m):
        work.low[i], work.P[2 * i], work.P[2 * i + 1] = 0.0, 0.0, 0.0
    copy(work.b, work.rates)
    _relax(state, m, work)
    copy(work.P, work.more)
    for row in range(2 * m):
        for column in range(2 * m):
            work.b[row] += work.G[row, column] * work.P[column]
    for i in range(m):
        work.low[i] = work.restitution[i] * work.P[2 * i]
        work.P[2 * i], work.P[2 * i + 1] = work.low[i], 0.0
    _relax(state, m, work)
    for row in range(2 * m):
        work.P[row] += work.more[row]
    push(closed, m, work.P, work.inverse, work.u)
    rates_of(closed, m, work.u, work.b)
    return _write_impacts(state, options, m, work, record)


@kernel
def _write_impacts(state, options, m, work, record):
    """Energy of the impacts, and events of those that are faster than creeping into contact."""
    written = False
    for i in range(m):
        N, T = 2 * i, 2 * i + 1
        lost = -0.5 * (work.P[N] * (work.rates[N] + work.b[N]) + work.P[T] * (work.rates[T] + work.b[T]))
        state.sums[IMPACTS] += lost
        if work.P[N] > 0.0 and work.rates[N] < -options.accumulation_speed:
            row = keep_event(state, record, IMPACT_EVENT, work.closed.ids[i], -1, work.rates[N])
            event = record.events[row]
            event.impulse_normal, event.impulse_tangential, event.energy_lost = work.P[N], work.P[T], lost
            state.counts[N_IMPACTS] += 1
            written = True
    return written


@kernel
def _free_velocity(model, state, h, work):
    """Velocities after the step without contacts: springs and damping at its middle, drives at the middle's place."""
    for i in range(len(work.u)):
        coordinate = model.coordinates[i]
        work.force[i] = driving_force(model, i, work.q[i])
        work.damping[i] = coordinate.viscous + coordinate.quadratic * abs(work.u[i])
    for j in range(len(model.tables)):
        table, force = model.tables[j], table_force(model, j, state.clock[0] + 0.5 * h, work.q)
        work.force[table.coordinate] += force
        if table.on >= 0:
            work.force[table.on] -= force
    for j in range(len(model.joints)):
        joint = model.joints[j]
        work.force[joint.coordinate] += joint.force
        work.force[joint.on] -= joint.force
    for i in range(len(work.u)):
        coordinate = model.coordinates[i]
        change = 0.5 * h * work.damping[i] + 0.25 * h * h * coordinate.stiffness
        work.mass[i] = coordinate.mass + change
        work.inverse[i] = 1.0 / work.mass[i]
        pull = work.force[i] - coordinate.stiffness * (state.q[i] - coordinate.rest)
        work.free[i] = ((coordinate.mass - change) * work.u[i] + h * pull) * work.inverse[i]
    # Two coordinates at once would fill the matrix: what acts between them is taken at the middle as the last step foresees it.
    for i in range(len(work.u)):
        work.at[i] = work.u[i] + 0.5 * h * state.a[i]
    for j in range(len(model.joints)):
        joint = model.joints[j]
        work.joint[j] = joint_damping(joint, work.at)
        torque = work.joint[j] - joint.stiffness * stretch(joint, work.q)
        work.free[joint.coordinate] += h * torque * work.inverse[joint.coordinate]
        work.free[joint.on] -= h * torque * work.inverse[joint.on]


@kernel
def act(model, state, m, h, work, out_u):
    """Velocities at the end of the step: forces and contacts together, without restitution."""
    closed = work.closed
    _free_velocity(model, state, h, work)
    copy(work.free, out_u)
    if m == 0:
        return
    fill_mobility(closed, m, work.inverse, work.G)
    rates_of(closed, m, work.free, work.b)
    for i in range(m):
        work.low[i] = 0.0
        # Last step's percussions are a good guess at this one's.
        work.P[2 * i], work.P[2 * i + 1] = work.memory[closed.ids[i], 0], work.memory[closed.ids[i], 1]
    _relax(state, m, work)
    push(closed, m, work.P, work.inverse, out_u)
    rates_of(closed, m, work.u, work.b)
    rates_of(closed, m, out_u, work.rates)
    for i in range(m):
        N, T = 2 * i, 2 * i + 1
        state.sums[CORRECTION] -= 0.5 * work.P[N] * (work.b[N] + work.rates[N])
        state.sums[FRICTION] -= 0.5 * work.P[T] * (work.b[T] + work.rates[T])


@kernel
def move(model, state, options, m, h, work, u):
    """Positions at the end of the step, with the sums of work; `u` holds the velocities there."""
    for i in range(len(u)):
        coordinate = model.coordinates[i]
        mean = 0.5 * (work.u[i] + u[i])
        state.q[i] += h * mean
        state.sums[DRIVE] += h * mean * work.force[i]
        state.sums[DAMPING] += h * work.damping[i] * mean * mean
        state.a[i] = (u[i] - work.u[i]) / h
        work.free[i] = coordinate.stiffness * (state.q[i] - coordinate.rest) ** 2
    for j in range(len(model.joints)):
        joint = model.joints[j]
        way = 0.5 * h * (work.u[joint.coordinate] + u[joint.coordinate] - work.u[joint.on] - u[joint.on])
        state.sums[DAMPING] -= work.joint[j] * way
        spent = joint.stiffness * way * (stretch(joint, state.q) - 0.5 * way - stretch(joint, work.q))
        state.sums[CORRECTION] -= spent
    wound = joint_energy(model, state.q)
    _take_back(state, options, m, work)
    state.sums[CORRECTION] -= joint_energy(model, state.q) - wound
    for i in range(len(u)):
        coordinate = model.coordinates[i]
        after = coordinate.stiffness * (state.q[i] - coordinate.rest) ** 2
        state.sums[CORRECTION] -= 0.5 * (after - work.free[i])


@kernel
def _take_back(state, options, m, work):
    """A share of the penetrations at the middle, by the smallest change of positions; remember who is closed."""
    state.mode[:] = 0
    work.memory[:] = 0.0
    work.depth[0] = 0.0
    slop = 0.5 * options.gap_close
    any_deep = False
    for i in range(m):
        k = work.closed.ids[i]
        state.mode[k] = 1
        work.memory[k, 0], work.memory[k, 1] = work.P[2 * i], work.P[2 * i + 1]
        depth = -work.closed.kin[i].g
        work.depth[0] = max(work.depth[0], depth)
        work.b[2 * i], work.b[2 * i + 1] = -TAKEN_BACK * max(0.0, depth - slop), 0.0
        work.low[i], work.more[i] = 0.0, 0.0
        any_deep = any_deep or depth > slop
    state.worst[0] = max(state.worst[0], work.depth[0])
    if not any_deep:
        return
    for i in range(m):
        work.P[2 * i], work.P[2 * i + 1] = 0.0, 0.0
    relax(work.G, work.b, work.low, work.more, m, work.P)
    push(work.closed, m, work.P, work.inverse, state.q)
