"""What acts at some instants of a run, besides the forces that are sought: force directions of some contacts, and all else?"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cell_lookup import along
from watchsim.contact.gaps import BACKWARD, FORWARD, OPEN, STICK, contact_kinematics, place, shape_of_contact
from watchsim.dynamics.coils import coil_energy, coil_pull, coil_value
from watchsim.dynamics.moving_frame import add_inertial_forces, inertial_power, next_jolt
from watchsim.jit import entry, hot_kernel, kernel
from watchsim.model import COIL_TORQUE, FREE, OVER_TIME, PIVOT, REPEATED, SLIDE, resistance
from watchsim.tolerances import KNOT_ROUNDING

# What do springs between points of two bodies do?
#
# Along the line between the points acts stiffness (l - length) + viscous l', pulling where it is positive; each body feels it
# at
# its own point, by the lever arms of its coordinates.


@kernel
def _end(model, b, x, y, q, u):
    """Place, velocity and arm from the origin, two components each, of the point (x, y) of body b; b < 0: of the movement."""
    if b < 0:
        return x, y, 0.0, 0.0, x, y
    body = model.bodies[b]
    i = body.first
    c, s, w = body.c, body.s, 0.0
    x0, y0, vx, vy = body.x, body.y, 0.0, 0.0
    if body.motion == PIVOT:
        angle = body.ratio * q[i] + body.phase
        c, s, w = math.cos(angle), math.sin(angle), body.ratio * u[i]
    elif body.motion == SLIDE:
        way, speed = body.ratio * q[i] + body.phase, body.ratio * u[i]
        x0, y0, vx, vy = x0 + way * body.axis_x, y0 + way * body.axis_y, speed * body.axis_x, speed * body.axis_y
    elif body.motion == FREE:
        c, s, w = math.cos(q[i + 2]), math.sin(q[i + 2]), u[i + 2]
        x0, y0, vx, vy = q[i], q[i + 1], u[i], u[i + 1]
    rx, ry = c * x - s * y, s * x + c * y
    return x0 + rx, y0 + ry, vx - w * ry, vy + w * rx, rx, ry


@kernel
def _line(model, line, q, u):
    """(length, its rate, direction x and y from the first point to the second); no direction where they meet."""
    xa, ya, vxa, vya, _, _ = _end(model, line.a, line.xa, line.ya, q, u)
    xb, yb, vxb, vyb, _, _ = _end(model, line.b, line.xb, line.yb, q, u)
    dx, dy = xb - xa, yb - ya
    length = math.sqrt(dx * dx + dy * dy)
    if length == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    nx, ny = dx / length, dy / length
    return length, nx * (vxb - vxa) + ny * (vyb - vya), nx, ny


@kernel
def _push(model, b, fx, fy, arm, out_h):
    """Add what a force at the end of `arm` does to the coordinates of body b, but where its motion is prescribed."""
    if b < 0 or model.bodies[b].first < 0 or model.coordinates[model.bodies[b].first].driven:
        return
    body = model.bodies[b]
    i, (rx, ry) = body.first, arm
    if body.motion == PIVOT:
        out_h[i] += body.ratio * (rx * fy - ry * fx)
    elif body.motion == SLIDE:
        out_h[i] += body.ratio * (fx * body.axis_x + fy * body.axis_y)
    else:
        out_h[i] += fx
        out_h[i + 1] += fy
        out_h[i + 2] += rx * fy - ry * fx


@kernel
def add_line_springs(model, q, u, out_h):
    """Add what all of them do to the coordinates."""
    for j in range(len(model.lines)):
        line = model.lines[j]
        length, rate, nx, ny = _line(model, line, q, u)
        pull = line.stiffness * (length - line.length) + line.viscous * rate
        _, _, _, _, rx, ry = _end(model, line.a, line.xa, line.ya, q, u)
        _push(model, line.a, pull * nx, pull * ny, (rx, ry), out_h)
        _, _, _, _, rx, ry = _end(model, line.b, line.xb, line.yb, q, u)
        _push(model, line.b, -pull * nx, -pull * ny, (rx, ry), out_h)


@kernel
def spring_pull(model, b, q, u):
    """The force of all of them, and of its hairspring's coil, on body b, N."""
    fx, fy = 0.0, 0.0
    if len(model.coils) > 0 and model.bodies[b].motion == PIVOT:
        fx, fy = coil_pull(model, model.bodies[b].first, q)
    for j in range(len(model.lines)):
        line = model.lines[j]
        if b in (line.a, line.b):
            length, rate, nx, ny = _line(model, line, q, u)
            pull = line.stiffness * (length - line.length) + line.viscous * rate
            sign = (1.0 if line.a == b else 0.0) - (1.0 if line.b == b else 0.0)
            fx, fy = fx + sign * pull * nx, fy + sign * pull * ny
    return fx, fy


@kernel
def line_spring_energy(model, q):
    """Energy in all of them, J."""
    energy = 0.0
    for j in range(len(model.lines)):
        line = model.lines[j]
        length, _, _, _ = _line(model, line, q, q)
        energy += 0.5 * line.stiffness * (length - line.length) ** 2
    return energy


@entry
def spring_pulls(model, b, q, u, out_pull):
    """For rows of coordinates: their force on body b, N (rows, 2)."""
    for row in range(len(q)):
        out_pull[row, 0], out_pull[row, 1] = spring_pull(model, b, q[row], u[row])


@entry
def line_spring_energies(model, q, out_energy):
    """The same for rows of coordinates."""
    for row in range(len(q)):
        out_energy[row] = line_spring_energy(model, q[row])


@entry
def line_spring_powers(model, q, u, out_taken, out_held):
    """For rows of coordinates: what the damping of each takes, W (rows, springs), and what keeps prescribed motions up, W."""
    for row in range(len(q)):
        for j in range(len(model.lines)):
            _, rate, _, _ = _line(model, model.lines[j], q[row], u[row])
            out_taken[row, j] = model.lines[j].viscous * rate * rate
        out_held[row] = line_spring_drive(model, q[row], u[row])


@kernel
def line_spring_damping(model, q, u):
    """Power that their damping takes, W."""
    power = 0.0
    for j in range(len(model.lines)):
        line = model.lines[j]
        _, rate, _, _ = _line(model, line, q, u)
        power += line.viscous * rate * rate
    return power


@kernel
def line_spring_drive(model, q, u):
    """Power that keeps prescribed motions up against them, W."""
    power = 0.0
    for j in range(len(model.lines)):
        line = model.lines[j]
        length, rate, nx, ny = _line(model, line, q, u)
        pull = line.stiffness * (length - line.length) + line.viscous * rate
        for side in range(2):
            b, x, y, sign = (line.a, line.xa, line.ya, 1.0) if side == 0 else (line.b, line.xb, line.yb, -1.0)
            if b >= 0 and model.bodies[b].first >= 0 and model.coordinates[model.bodies[b].first].driven:
                _, _, vx, vy, _, _ = _end(model, b, x, y, q, u)
                power -= sign * pull * (nx * vx + ny * vy)
    return power


# What does dry friction in a bearing do?
#
# -T sgn(u) while the coordinate moves; while it stands, whatever keeps it at rest, up to T. A finite force: it takes part in
# no impact. The grip of a coordinate is FORWARD or BACKWARD while it moves, STICK while it is held, OPEN without dry friction.


@kernel
def set_grips(model, u, label, island, options, out_grip):
    """What the velocities of the island's coordinates say; STICK where one is below rounding: held or about to move."""
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if label[i] != island:
            continue
        if coordinate.coulomb == 0.0 and not coordinate.loaded:
            out_grip[i] = OPEN
        elif abs(u[i]) * options.size <= options.speed_zero * coordinate.scale:
            out_grip[i] = STICK
        else:
            out_grip[i] = FORWARD if u[i] > 0.0 else BACKWARD


@kernel
def add_drag(dry, grip, out_h):
    """Dry friction of the moving bearings."""
    for i in range(len(out_h)):
        if grip[i] == FORWARD or grip[i] == BACKWARD:
            out_h[i] -= grip[i] * dry[i]


@kernel
def drag_power(dry, grip, u):
    """Power the moving bearings take, W. A smooth function of u also beyond a reversal, where the step will end."""
    power = 0.0
    for i in range(len(u)):
        if grip[i] == FORWARD or grip[i] == BACKWARD:
            power += grip[i] * dry[i] * u[i]
    return power


@kernel
def add_loads(closed, m, force, grip, out_load, out_terms):
    """Add what the m contacts do to the coordinates that are held, and the sum of its terms without sign."""
    for row in range(m):
        for k in range(closed.slots[row]):
            i = closed.coord[row, k]
            if grip[i] == STICK:
                normal, tangential = closed.w_N[row, k] * force[2 * row], closed.w_T[row, k] * force[2 * row + 1]
                out_load[i] += normal + tangential
                out_terms[i] += abs(normal) + abs(tangential)


@kernel
def stop_held(label, island, grip, out_u):
    """Velocities of the island after a decision: zero where held; where just set in motion, never against the new direction."""
    for i in range(len(label)):
        if label[i] != island:
            continue
        if grip[i] == STICK or (grip[i] != OPEN and grip[i] * out_u[i] < 0.0):
            out_u[i] = 0.0


# Which generalized forces h(t, q, u) act, apart from contacts?


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
def beyond_pins(coordinate, way):
    """How far a coil is bent beyond the pin it bears on, rad."""
    return way - min(max(way, coordinate.pin_low), coordinate.pin_high)


@kernel
def bent_force(model, i, q):
    """What the spring of coordinate i does beyond its stiffness: by the cube of the way from rest, curb pins and its coil."""
    coordinate = model.coordinates[i]
    way = q - coordinate.rest
    force = -coordinate.cubic * way * way * way - coordinate.pinned * beyond_pins(coordinate, way)
    return force + coil_value(model, coordinate.coil, COIL_TORQUE, way) if coordinate.coil > 0 else force


@kernel
def bent_energy(model, i, q):
    """What that part stores, J."""
    coordinate = model.coordinates[i]
    way = q - coordinate.rest
    beyond = beyond_pins(coordinate, way)
    energy = 0.25 * coordinate.cubic * way * way * way * way + 0.5 * coordinate.pinned * beyond * beyond
    return energy + coil_energy(model, coordinate.coil, way) if coordinate.coil > 0 else energy


damping_rate = kernel(resistance)


@kernel
def damping_force(model, i, u):
    """Of coordinate i against its speed; dry friction is in bearing_friction.py."""
    return -u * damping_rate(model.coordinates[i], abs(u))


@kernel
def stretch(joint, q):
    """How far the spring between two coordinates is wound, rad or m."""
    return q[joint.coordinate] - q[joint.on] - joint.rest


@kernel
def joint_damping(joint, u):
    """Against the speed w of the one coordinate less that of the other."""
    w = u[joint.coordinate] - u[joint.on]
    return -w * damping_rate(joint, abs(w))


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
        if coordinate.bent:
            out_h[i] += bent_force(model, i, q[i])
    for j in range(len(model.joints)):
        joint = model.joints[j]
        torque = joint_force(joint, q, u)
        out_h[joint.coordinate] += torque
        push_back(model, joint.on, torque, out_h)
    add_line_springs(model, q, u, out_h)
    if len(model.shocks) > 0:
        add_inertial_forces(model, t, q, u, out_h)
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
    if len(model.shocks) > 0:
        power += inertial_power(model, t, q, u)
    return power + line_spring_drive(model, q, u)


@hot_kernel
def damping_power(model, q, u):
    """Power taken by damping but for dry friction, W; never negative."""
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
        if coordinate.bent:
            energy += bent_energy(model, i, q[i])
    return energy + joint_energy(model, q) + line_spring_energy(model, q)


@kernel
def next_knot(model, t):
    """Time of the first knot after t of all tables over time; infinity if there is none. A step must not jump over it."""
    first = next_jolt(model, t)
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


# What acts at some instants of a run, besides the forces that are sought: force directions of some contacts, and all else?

Array = NDArray[np.float64]


class Seen(NamedTuple):
    """Kinematics of m contacts at n instants, and the forces h of all else."""

    w_N: Array  # (n, m, coordinates)
    w_T: Array
    bar: Array  # (n, 2, m): bar terms along normals and tangents
    normal: Array  # (n, m, 2)
    point: Array
    h: Array  # (n, coordinates)


def room(instants: int, contacts: int, coordinates: int) -> Seen:
    """Zeros for that many."""
    direction, place = (instants, contacts, coordinates), (instants, contacts, 2)
    shapes = (direction, direction, (instants, 2, contacts), place, place, (instants, coordinates))
    return Seen(*(np.zeros(shape) for shape in shapes))


@entry
def balance(model, t, q, u, ids, out_pose, out_closed, out_seen):
    """Fill `out_seen`, all zeros so far, for the contacts `ids`; t, q and u have a row per instant.

    `out_pose` is room for all bodies, `out_closed` for one contact.
    """
    for i in range(len(t)):
        place(model, q[i], u[i], out_pose)
        forces(model, t[i], q[i], u[i], out_seen.h[i])
        for row in range(len(ids)):
            contact_kinematics(model, ids[row], out_pose, 0, out_closed)
            for slot in range(out_closed.slots[0]):  # two of them may be of one coordinate
                j = out_closed.coord[0, slot]
                out_seen.w_N[i, row, j] += out_closed.w_N[0, slot]
                out_seen.w_T[i, row, j] += out_closed.w_T[0, slot]
            kin, contact = out_closed.kin[0], model.contacts[ids[row]]
            out_seen.bar[i, 0, row], out_seen.bar[i, 1, row] = kin.bar_N, kin.bar_T
            out_seen.point[i, row, 0], out_seen.point[i, row, 1] = kin.x, kin.y
            a, b = model.primitives[contact.a], model.primitives[contact.b]
            shape = shape_of_contact(contact, a, b, out_pose[a.body], out_pose[b.body])
            out_seen.normal[i, row, 0], out_seen.normal[i, row, 1] = shape.nx, shape.ny
