"""What do bodies feel when the case is shaken and turned?

Coordinates are those in the case, whose point `about` is accelerated by A and which turns by Φ. A mass m at ρ from that point
with velocity v in the case then feels m (-A - Φ'' e×ρ + Φ'² ρ - 2 Φ' e×v), and gravity turned by -Φ (Landau & Lifshitz,
Mechanics, § 39). Of a half sine and of straight lines between recorded values Φ'' is integrated in closed form.
"""

from __future__ import annotations

import math

from watchsim.jit import entry, kernel
from watchsim.model import FREE, PIVOT, SLIDE


@kernel
def _half_sine(shock, t):
    """(its height from 0 to 1, the integral of that over time, and the integral of that)."""
    since, pulse = t - shock.start, math.pi / shock.duration
    if since <= 0.0:
        return 0.0, 0.0, 0.0
    if since >= shock.duration:
        return 0.0, 2.0 / pulse, shock.duration / pulse + 2.0 / pulse * (since - shock.duration)
    phase = pulse * since
    return math.sin(phase), (1.0 - math.cos(phase)) / pulse, since / pulse - math.sin(phase) / (pulse * pulse)


@kernel
def _row_before(model, shock, t):
    """The last row of a recording that is not after t, of those with one behind."""
    low, high = shock.first, shock.first + shock.count - 1
    while high - low > 1:
        middle = (low + high) // 2
        if model.jolts[middle, 0] <= t - shock.start:
            low = middle
        else:
            high = middle
    return low


@kernel
def _recorded(model, shock, t):
    """(A_x, A_y, Φ'', Φ', Φ) of a recording; before and behind it nothing accelerates the case."""
    since, k = t - shock.start, _row_before(model, shock, t)
    if since < model.jolts[shock.first, 0]:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    one, two = model.jolts[k], model.jolts[k + 1]
    whole = two[0] - one[0]
    way = min(since - one[0], whole)
    x, y = (two[1] - one[1]) / whole, (two[2] - one[2]) / whole
    bend = (two[3] - one[3]) / whole
    turn = one[3] + bend * way
    spin = one[4] + way * (one[3] + 0.5 * way * bend)
    angle = one[5] + way * (one[4] + way * (0.5 * one[3] + way * bend / 6.0))
    if since > two[0]:
        return 0.0, 0.0, 0.0, spin, angle + spin * (since - two[0])
    return one[1] + x * way, one[2] + y * way, turn, spin, angle


@kernel
def case_motion(model, t):
    """(x and y of gravity less A and less the gravity of the scene, Φ'', Φ') at time t (s)."""
    ax, ay, turn, spin, angle = 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(len(model.shocks)):
        shock = model.shocks[j]
        if shock.count > 0:
            x, y, twist, rate, way = _recorded(model, shock, t)
        else:
            height, first, second = _half_sine(shock, t)
            x, y, twist = height * shock.x, height * shock.y, height * shock.turn
            rate, way = first * shock.turn, second * shock.turn
        ax, ay, turn, spin, angle = ax + x, ay + y, turn + twist, spin + rate, angle + way
    gx, gy = model.shocks[0].gravity_x, model.shocks[0].gravity_y
    c, s = math.cos(angle), math.sin(angle)
    return c * gx + s * gy - gx - ax, c * gy - s * gx - gy - ay, turn, spin


@kernel
def inertial_force(model, k, frame, q, u):
    """(force x, y on the body of row k, N; torque about its pivot or centre, N·m) in a case of that `case_motion`."""
    row, (fx, fy, turn, spin) = model.weighed[k], frame
    body = model.bodies[row.body]
    i, x, y, vx, vy = body.first, body.x, body.y, 0.0, 0.0
    mx, my = row.moment_x, row.moment_y
    if body.motion == PIVOT:
        angle = body.ratio * q[i] + body.phase
        c, s, w = math.cos(angle), math.sin(angle), body.ratio * u[i]
        mx, my = c * row.moment_x - s * row.moment_y, s * row.moment_x + c * row.moment_y
        vx, vy = -w * my, w * mx
    elif body.motion == SLIDE:
        way, speed = body.ratio * q[i] + body.phase, body.ratio * u[i]
        x, y = x + way * body.axis_x, y + way * body.axis_y
        vx, vy = row.mass * speed * body.axis_x, row.mass * speed * body.axis_y
    else:
        x, y, vx, vy = q[i], q[i + 1], row.mass * u[i], row.mass * u[i + 1]
    x, y = x - model.shocks[0].about_x, y - model.shocks[0].about_y
    # Mass times the place of its centre; (mx, my) is that from the pivot.
    rx, ry = row.mass * x + mx, row.mass * y + my
    torque = mx * fy - my * fx - turn * (row.inertia + mx * x + my * y) + spin * spin * (mx * y - my * x)
    force_x = row.mass * fx + turn * ry + spin * spin * rx + 2.0 * spin * vy
    force_y = row.mass * fy - turn * rx + spin * spin * ry - 2.0 * spin * vx
    if body.carrier >= 0:
        torque = -turn * row.inertia  # poised; what its pivot feels is in the carrier's mass
    return force_x, force_y, torque


@kernel
def _share(model, k, force):
    """What the force on the body of row k does to its coordinates: (how many, the first, second and third one)."""
    body = model.bodies[model.weighed[k].body]
    fx, fy, torque = force
    if body.motion == FREE:
        return 3, fx, fy, torque
    return 1, body.ratio * (torque if body.motion == PIVOT else fx * body.axis_x + fy * body.axis_y), 0.0, 0.0


@kernel
def add_inertial_forces(model, t, q, u, out_h):
    """Add what the motion of the case does to all coordinates."""
    frame = case_motion(model, t)
    for k in range(len(model.weighed)):
        i = model.bodies[model.weighed[k].body].first
        count, one, two, three = _share(model, k, inertial_force(model, k, frame, q, u))
        out_h[i] += one
        if count > 1:
            out_h[i + 1] += two
            out_h[i + 2] += three


@kernel
def _power(model, k, frame, q, u):
    """The work done on the body of row k, as it is seen in the case, W."""
    i = model.bodies[model.weighed[k].body].first
    count, one, two, three = _share(model, k, inertial_force(model, k, frame, q, u))
    return one * u[i] + two * u[i + 1] + three * u[i + 2] if count > 1 else one * u[i]


@kernel
def inertial_power(model, t, q, u):
    """The same of all bodies."""
    power, frame = 0.0, case_motion(model, t)
    for k in range(len(model.weighed)):
        power += _power(model, k, frame, q, u)
    return power


@kernel
def inertial_on(model, b, t, q, u):
    """Force on body b by the motion of the case, N."""
    if len(model.shocks) > 0:
        frame = case_motion(model, t)
        for k in range(len(model.weighed)):
            if model.weighed[k].body == b:
                fx, fy, _ = inertial_force(model, k, frame, q, u)
                return fx, fy
    return 0.0, 0.0


@entry
def inertial_rows(model, b, t, q, u, out_force, out_power):
    """For rows of coordinates: force on body b, N (rows, 2), and the work on each body of `weighed`, W (rows, bodies)."""
    for row in range(len(t)):
        out_force[row, 0], out_force[row, 1] = inertial_on(model, b, t[row], q[row], u[row])
        frame = case_motion(model, t[row])
        for k in range(len(model.weighed)):
            out_power[row, k] = _power(model, k, frame, q[row], u[row])


@kernel
def next_jolt(model, t):
    """The first time after t at which the acceleration of the case has a corner or a jump; infinity if there is none."""
    first = math.inf
    for j in range(len(model.shocks)):
        shock = model.shocks[j]
        if shock.count == 0:
            for time in (shock.start, shock.start + shock.duration):
                if time > t:
                    first = min(first, time)
        else:
            for k in range(shock.first, shock.first + shock.count):
                if shock.start + model.jolts[k, 0] > t:
                    first = min(first, shock.start + model.jolts[k, 0])
                    break
    return first


@kernel
def is_shaken(model, t):
    """True as long as the case will move, or turns for ever."""
    for j in range(len(model.shocks)):
        if t < model.shocks[j].over:
            return True
    return False
