"""Which generalized forces h(t, q, u) act, apart from contacts?"""

from __future__ import annotations

import math

from watchsim.candidates.cell_lookup import along
from watchsim.dynamics.line_springs import add_line_springs, line_spring_damping, line_spring_drive, line_spring_energy
from watchsim.jit import entry, hot_kernel, kernel
from watchsim.model.records import OVER_TIME, REPEATED
from watchsim.tolerances import KNOT_ROUNDING


@kernel
def table_value(model, table, x):
    """Linear interpolation in one table; beyond its ends the end values."""
    first, last = table.start, table.start + table.count - 1
    if x <= model.knots[first, 0]:
        return model.knots[first, 1]
    if x >= model.knots[last, 0]:
        return model.knots[last, 1]
    while last - first > 1:
        middle = (first + last) // 2
        if model.knots[middle, 0] <= x:
            first = middle
        else:
            last = middle
    fraction = (x - model.knots[first, 0]) / (model.knots[last, 0] - model.knots[first, 0])
    return model.knots[first, 1] + fraction * (model.knots[last, 1] - model.knots[first, 1])


@kernel
def driving_force(model, i, q):
    """Constant force of coordinate i, plus gravity on an excentric rotor: torque m (r × g) with r turned by q."""
    coordinate = model.coordinates[i]
    force = coordinate.force
    if coordinate.weight_x != 0.0 or coordinate.weight_y != 0.0:
        force += math.cos(q) * coordinate.weight_y - math.sin(q) * coordinate.weight_x
    return force


@kernel
def damping_force(model, i, u):
    """-c u - c2 u|u| of coordinate i; dry friction is in bearing_friction.py."""
    coordinate = model.coordinates[i]
    return -u * (coordinate.viscous + coordinate.quadratic * abs(u))


@kernel
def stretch(joint, q):
    """How far the spring between two coordinates is wound, rad or m."""
    return q[joint.coordinate] - q[joint.on] - joint.rest


@kernel
def joint_damping(joint, u):
    """-c w - c2 w|w| with the speed w of the one coordinate against the other."""
    w = u[joint.coordinate] - u[joint.on]
    return -w * (joint.viscous + joint.quadratic * abs(w))


@kernel
def joint_force(joint, q, u):
    """What acts on the one coordinate, and back on the other: drive, spring and damping."""
    return joint.force - joint.stiffness * stretch(joint, q) + joint_damping(joint, u)


@kernel
def push_back(model, i, force, out_h):
    """Take a force away from that on coordinate i, but where its motion is prescribed."""
    if not model.coordinates[i].driven:
        out_h[i] -= force


@kernel
def table_force(model, j, t, q):
    """What table j gives at time t and coordinates q."""
    table = model.tables[j]
    if table.over == REPEATED:
        return table_value(model, table, t - _whole_periods(model, table, t))
    return table_value(model, table, t if table.over == OVER_TIME else along(q, table.coordinate, table.on))


@kernel
def _period(model, table):
    """Of a repeated table, s: its last knot is the first, a period later."""
    return model.knots[table.start + table.count - 1, 0] - model.knots[table.start, 0]


@kernel
def _whole_periods(model, table, t):
    """How long all periods of a repeated table that are over at t lasted, s."""
    period = _period(model, table)
    return period * math.floor((t - model.knots[table.start, 0]) / period)


@hot_kernel
def forces(model, t, q, u, out_h):
    """h for all coordinates: drive, springs, damping. What acts at the pivot of a carried body acts back on its carrier."""
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        out_h[i] = (
            driving_force(model, i, q[i]) - coordinate.stiffness * (q[i] - coordinate.rest) + damping_force(model, i, u[i])
        )
    for j in range(len(model.joints)):
        joint = model.joints[j]
        torque = joint_force(joint, q, u)
        out_h[joint.coordinate] += torque
        push_back(model, joint.on, torque, out_h)
    add_line_springs(model, q, u, out_h)
    for j in range(len(model.tables)):
        table, force = model.tables[j], table_force(model, j, t, q)
        out_h[table.coordinate] += force
        if table.on >= 0:
            push_back(model, table.on, force, out_h)


@hot_kernel
def drive_power(model, t, q, u):
    """Power of everything that is neither a spring nor damping (motor torques, gravity), W.

    So is what keeps a prescribed motion up against all that acts back on it.
    """
    power = 0.0
    for i in range(len(model.coordinates)):
        if not model.coordinates[i].driven:
            power += u[i] * driving_force(model, i, q[i])
    for j in range(len(model.joints)):
        joint = model.joints[j]
        power += (u[joint.coordinate] - u[joint.on]) * joint.force
        if model.coordinates[joint.on].driven:
            power += u[joint.on] * joint_force(joint, q, u)
    for j in range(len(model.tables)):
        table = model.tables[j]
        if model.coordinates[table.coordinate].driven:
            continue
        force = table_force(model, j, t, q)
        power += along(u, table.coordinate, table.on) * force
        if table.on >= 0 and model.coordinates[table.on].driven:
            power += u[table.on] * force
    return power + line_spring_drive(model, q, u)


@hot_kernel
def damping_power(model, q, u):
    """Power taken by viscous and quadratic damping, W; never negative."""
    power = 0.0
    for i in range(len(model.coordinates)):
        power -= u[i] * damping_force(model, i, u[i])
    for j in range(len(model.joints)):
        joint = model.joints[j]
        power -= (u[joint.coordinate] - u[joint.on]) * joint_damping(joint, u)
    return power + line_spring_damping(model, q, u)


@kernel
def joint_energy(model, q):
    """Energy in the springs between carried bodies and their carriers, J."""
    energy = 0.0
    for j in range(len(model.joints)):
        joint = model.joints[j]
        energy += 0.5 * joint.stiffness * stretch(joint, q) ** 2
    return energy


@entry
def stored_energy(model, q, u):
    """Kinetic energy and energy in springs, J; a prescribed motion holds none that counts."""
    energy = 0.0
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if coordinate.driven:
            continue
        way = q[i] - coordinate.rest
        energy += 0.5 * (coordinate.mass * u[i] * u[i] + coordinate.stiffness * way * way)
    return energy + joint_energy(model, q) + line_spring_energy(model, q)


@kernel
def next_knot(model, t):
    """Time of the first knot after t of all tables over time; infinity if there is none. A step must not jump over it."""
    first = math.inf
    for j in range(len(model.tables)):
        table = model.tables[j]
        if table.over < OVER_TIME:
            continue
        begun = _whole_periods(model, table, t) if table.over == REPEATED else 0.0
        after = _knot_after(model, table, t, begun)
        if after == math.inf and table.over == REPEATED:  # at its last knot, to rounding
            after = _knot_after(model, table, t, begun + _period(model, table))
        first = min(first, after)
    return first


@kernel
def _knot_after(model, table, t, begun):
    """Time of the first knot after t of one table that began at `begun`; infinity if there is none."""
    for i in range(table.start, table.start + table.count):
        if begun + model.knots[i, 0] > t * (1.0 + KNOT_ROUNDING):
            return begun + model.knots[i, 0]
    return math.inf
