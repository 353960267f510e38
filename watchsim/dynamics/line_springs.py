"""What do springs between points of two bodies do?

Along the line between the points acts stiffness (l - length) + viscous l', pulling where it is positive; each body feels it at
its own point, by the lever arms of its coordinates.
"""

from __future__ import annotations

import math

from watchsim.jit import entry, kernel
from watchsim.model.records import FREE, PIVOT, SLIDE


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
def line_spring_energy(model, q):
    """Energy in all of them, J."""
    energy = 0.0
    for j in range(len(model.lines)):
        line = model.lines[j]
        length, _, _, _ = _line(model, line, q, q)
        energy += 0.5 * line.stiffness * (length - line.length) ** 2
    return energy


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
