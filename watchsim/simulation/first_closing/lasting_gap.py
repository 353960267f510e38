"""For how long can a gap that hardly changes not close, although its bodies move fast?

A body that turns about one of its own corners, on which a corner of another body lies: gaps there stay at rounding while all
coordinates accelerate. Bounds of the coordinates one by one (time_of_impact.py) do not see that their accelerations cancel,
and would have such a gap looked at every few nanoseconds. Here the two material points at the place of the contact are
compared, by their velocities and accelerations now and a bound of how fast these change (docs/theory/method.md 3.3).
"""

from __future__ import annotations

import math

from watchsim.contact.gaps import normal_gap
from watchsim.contact.poses import point_of
from watchsim.jit import kernel
from watchsim.model.records import FIXED, FREE, PIVOT, SLIDE
from watchsim.simulation.motion.step_path import acceleration_on_path, jerk_bound


@kernel
def _material_point(model, state, step, b, rx, ry, left, tau, path):
    """(vx, vy, ax, ay, bound of the third derivative for `left` s) of the point of body b at (rx, ry) from its origin."""
    body, pose = model.bodies[b], path.pose[b]
    i = body.first
    if body.motion == SLIDE:
        a = body.ratio * acceleration_on_path(model, state, step, i, tau, path)
        return pose.vx, pose.vy, a * body.axis_x, a * body.axis_y, abs(body.ratio) * jerk_bound(model, state, step, i)
    if body.motion == FIXED:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    turn = i if body.motion == PIVOT else i + 2
    w, twist = pose.w, body.ratio * acceleration_on_path(model, state, step, turn, tau, path)
    ax, ay, jerk = -twist * ry - w * w * rx, twist * rx - w * w * ry, 0.0
    if body.motion == FREE:
        ax += acceleration_on_path(model, state, step, i, tau, path)
        ay += acceleration_on_path(model, state, step, i + 1, tau, path)
        jerk = jerk_bound(model, state, step, i) + jerk_bound(model, state, step, i + 1)
    bound = abs(body.ratio) * step.bound[turn]
    fastest = abs(w) + bound * left
    change = abs(body.ratio) * jerk_bound(model, state, step, turn)
    jerk += (change + 3.0 * bound * fastest + fastest**3) * math.sqrt(rx * rx + ry * ry)
    return pose.vx - w * ry, pose.vy + w * rx, ax, ay, jerk


@kernel
def _points_apart(model, state, k, left, tau, step, path):
    """(vx, vy, ax, ay, bound of how a changes) of the point of A at the centre of its circle against that of B there."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa, pb = path.pose[a.body], path.pose[b.body]
    rx, ry = point_of(pa, a.x, a.y)
    one = _material_point(model, state, step, a.body, rx, ry, left, tau, path)
    two = _material_point(model, state, step, b.body, rx + pa.x - pb.x, ry + pa.y - pb.y, left, tau, path)
    return one[0] - two[0], one[1] - two[1], one[2] - two[2], one[3] - two[3], one[4] + two[4]


@kernel
def _fastest_turn(model, b, left, step, path):
    """A bound of the turning rate of body b for `left` seconds."""
    body = model.bodies[b]
    if body.motion == PIVOT:
        return abs(path.pose[b].w) + abs(body.ratio) * step.bound[body.first] * left
    return abs(path.pose[b].w) + step.bound[body.first + 2] * left if body.motion == FREE else 0.0


@kernel
def _time_for(room, speed, push, jerk, left):
    """A time up to `left` in which a way does not exceed `room`, by its speed, acceleration and a bound of the jerk."""
    # A third of the room for each.
    time = left
    if 3.0 * speed * time > room:
        time = room / (3.0 * speed)
    if 1.5 * push * time * time > room:
        time = math.sqrt(room / (1.5 * push))
    if 0.5 * jerk * time**3 > room:
        time = (2.0 * room / jerk) ** (1.0 / 3.0)
    return time


@kernel
def _is_carried(model, k):
    contact = model.contacts[k]
    a, b = model.primitives[contact.a].body, model.primitives[contact.b].body
    return model.bodies[a].carrier >= 0 or model.bodies[b].carrier >= 0


@kernel
def may_last(room, rate, time):
    """False where `time_apart` would find no more than `time`, so fast does a gap with this much room fall."""
    return 3.0 * max(-rate, 0.0) * time < room


@kernel
def time_still(model, state, k, room, left, tau, step, path):
    """A time up to `left` seconds in which the place of contact k moves by no more than `room` on either body, or 0.

    The bodies must stand in `path` where they are at `tau`. Not for carried bodies: 0.
    """
    if _is_carried(model, k):
        return 0.0
    vx, vy, ax, ay, jerk = _points_apart(model, state, k, left, tau, step, path)
    return _time_for(room, math.sqrt(vx * vx + vy * vy), math.sqrt(ax * ax + ay * ay), jerk, left)


@kernel
def time_apart(model, state, k, room, left, tau, step, path):
    """A time up to `left` seconds within which contact k, on the free side with this much room, cannot close; or 0.

    As in `time_still`. With x the way between the two points and e the normal, which turns with B, the gap falls by no more
    than -e·x. Not for hollow arcs, where it may fall by more: 0.
    """
    b = model.primitives[model.contacts[k].b]
    if b.side < 0.0 or _is_carried(model, k):
        return 0.0
    here = normal_gap(model, k, path.pose)
    vx, vy, ax, ay, jerk = _points_apart(model, state, k, left, tau, step, path)
    turn = _fastest_turn(model, b.body, left, step, path)
    jerk = jerk * (1.0 + turn * left) + 3.0 * turn * math.sqrt(ax * ax + ay * ay)
    push = max(-(here.nx * ax + here.ny * ay), 0.0) + 2.0 * turn * math.sqrt(vx * vx + vy * vy)
    return _time_for(room, max(-here.rate, 0.0), push, jerk, left)
