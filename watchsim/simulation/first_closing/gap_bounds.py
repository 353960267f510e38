"""How fast can a gap change, at most, over a stretch of time?

Bounds of the bodies' speeds and accelerations over the stretch, for the motion as computed (step_path.py), and of what these do
to the gap of one contact. Conservative advancement rests on them (safe_times.py): a bound that is too small loses contacts.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from watchsim.contact.poses import point_of
from watchsim.jit import hot_kernel, kernel
from watchsim.model.records import FREE, LINE, PIVOT, SLIDE
from watchsim.tolerances import SLOWEST_CLOSING


class Bounds(NamedTuple):
    """What a body's frame does at most over a stretch of time."""

    speed: float  # m/s
    turn: float  # rad/s
    push: float  # m/s²
    twist: float  # rad/s²


@hot_kernel
def body_bounds(model, b, length, step, path):
    """`Bounds` of the frame over the next `length` seconds."""
    body = model.bodies[b]
    own = _own_bounds(body, length, step, path)
    if body.carrier < 0:
        return own
    carrier = _own_bounds(model.bodies[body.carrier], length, step, path)
    arm = math.sqrt(body.x * body.x + body.y * body.y)
    speed = carrier.speed + carrier.turn * arm
    return Bounds(speed, own.turn, carrier.push + carrier.twist * arm + carrier.turn * carrier.turn * arm, own.twist)


@hot_kernel
def _own_bounds(body, length, step, path):
    """The same from the body's own coordinates alone."""
    i = body.first
    bound, ratio = step.bound, abs(body.ratio)
    if body.motion == PIVOT:
        return Bounds(0.0, ratio * (abs(path.u[i]) + bound[i] * length), 0.0, ratio * bound[i])
    if body.motion == SLIDE:
        return Bounds(ratio * (abs(path.u[i]) + bound[i] * length), 0.0, ratio * bound[i], 0.0)
    if body.motion == FREE:
        ax, ay = bound[i], bound[i + 1]
        acceleration = math.sqrt(ax * ax + ay * ay)
        speed = math.sqrt(path.u[i] ** 2 + path.u[i + 1] ** 2) + acceleration * length
        return Bounds(speed, abs(path.u[i + 2]) + bound[i + 2] * length, acceleration, bound[i + 2])
    return Bounds(0.0, 0.0, 0.0, 0.0)


@hot_kernel
def gap_bounds(model, k, length, bounds_a, bounds_b, path):
    """Bounds over the next `length` seconds: |g'|, |g''| but for B's curvature, and the bodies' relative turning.

    `bounds_a` and `bounds_b` are the `body_bounds` of the two bodies.
    """
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    speed_a, turn_a, push_a, twist_a = bounds_a
    speed_b, turn_b, push_b, twist_b = bounds_b
    pa, pb = path.pose[a.body], path.pose[b.body]
    rx, ry = point_of(pa, a.x, a.y)
    arm_a = math.sqrt(rx * rx + ry * ry)
    speed = speed_a + turn_a * arm_a + speed_b
    dx, dy = pa.x + rx - pb.x, pa.y + ry - pb.y
    arm_b = math.sqrt(dx * dx + dy * dy) + speed * length
    closing = speed + turn_b * arm_b
    bend = push_a + twist_a * arm_a + turn_a * turn_a * arm_a + push_b
    vx, vy = pa.vx - pa.w * ry - pb.vx, pa.vy + pa.w * rx - pb.vy
    if b.kind != LINE:
        # An arc's gap depends on where its centre is, not on how it is turned: one about its own pivot does not move.
        px, py = point_of(pb, b.x, b.y)
        arm_p = math.sqrt(px * px + py * py)
        if arm_p < arm_b:
            bend += (twist_b + turn_b * turn_b) * arm_p
            return _closing((vx + pb.w * py, vy - pb.w * px), bend, length, speed + turn_b * arm_p), bend, turn_a + turn_b
    bend += (twist_b + turn_b * turn_b) * arm_b + 2.0 * turn_b * closing
    return _closing((vx + pb.w * dy, vy - pb.w * dx), bend, length, closing), bend, turn_a + turn_b


@kernel
def _closing(velocity, bend, length, most):
    """Bound of a relative speed over `length` seconds from what it is now: bodies that travel together do not approach."""
    vx, vy = velocity
    return max(min(most, math.sqrt(vx * vx + vy * vy) + bend * length), SLOWEST_CLOSING)


@kernel
def centre_distance(model, k, pose):
    """Distance of the two centres of a centre-centre contact; infinite for centre-line."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    if b.kind == LINE:
        return math.inf
    pa, pb = pose[a.body], pose[b.body]
    ax, ay = point_of(pa, a.x, a.y)
    bx, by = point_of(pb, b.x, b.y)
    return math.sqrt((pa.x + ax - pb.x - bx) ** 2 + (pa.y + ay - pb.y - by) ** 2)


@kernel
def next_stretch(model, options, k, left, step, path):
    """(length, closing, bend, swing): how long the bounds shall hold, of `left` seconds, and the `gap_bounds` for so long.

    What is thrown far has bounds far beyond its motion: a stretch is no longer than the bodies travel by the scene's size.
    """
    contact = model.contacts[k]
    a, b = model.primitives[contact.a].body, model.primitives[contact.b].body
    length = left
    bounds_a, bounds_b = body_bounds(model, a, left, step, path), body_bounds(model, b, left, step, path)
    speed = bounds_a.speed + bounds_b.speed
    if speed * left > options.size:
        length = options.size / speed
        bounds_a, bounds_b = body_bounds(model, a, length, step, path), body_bounds(model, b, length, step, path)
    closing, bend, swing = gap_bounds(model, k, length, bounds_a, bounds_b, path)
    return length, closing, bend, swing
