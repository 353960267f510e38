"""When, within the current step, does an open contact close first? None may be missed.

Conservative advancement of second order: time advances by what the bounds of the gap's motion (gap_bounds.py) call safe
(safe_times.py). Near a contact this is Newton's method from the safe side (it converges quadratically and never jumps over a
root); far from it, one evaluation covers the whole stretch.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from watchsim.contact.cell_lookup import LISTED, UNKNOWN, candidate, candidates, time_in_cell
from watchsim.contact.gaps import (
    OPEN,
    are_apart,
    contact_kinematics,
    gap_acceleration,
    normal_gap,
    place,
    placed_gap,
    point_of,
)
from watchsim.jit import hot_kernel, kernel
from watchsim.model import FIXED, FREE, LINE, PIVOT, SLIDE
from watchsim.simulation.closed_contacts import beyond_ends, has_one_way, is_beside_active, is_immovable, room_beside_active
from watchsim.simulation.coupled_motion import is_at_rest
from watchsim.simulation.scratch import request_cell
from watchsim.simulation.state import NO_CONTACT
from watchsim.simulation.step_path import acceleration_on_path, body_on_path, jerk_bound
from watchsim.tolerances import FINE_LOOK, IMMOVABLE, NEAR_POINTS, NEIGHBOUR_STRIDE, SLOWEST_CLOSING, TIME_ROUNDING

# From which gap on does a contact close, where faces too flat to count have let one body sink into the other?
#
# Where two bodies move past each other in one direction only, faces that lie along it take no part in the motion
# (`is_immovable` in closed_contacts.py), and what they rise the bodies sink in. The next face, which may rise more, is then met
# at its joint with a gap that is already negative. It closes there as it would with a gap of zero (docs/theory/method.md 2.6).
# Faces met so have a concave joint: past a convex one the next face falls away.


@kernel
def sunk_level(model, options, k, gap, inside_b, path):
    """The gap of contact k if it counts as sunk in by that, else 0. `inside_b`: how far it is inside B's primitive, m.

    Its bodies must stand in `path` where it has this gap.
    """
    if gap >= -options.behind or gap < -options.sunk or inside_b > NEAR_POINTS * options.extent:
        return 0.0
    if not _by_concave_joint(model, k, path.pose):
        return 0.0
    contact_kinematics(model, k, path.pose, 0, path.probe)
    return gap if has_one_way(model, path.probe, 0, options.sunk) else 0.0


@kernel
def _by_concave_joint(model, k, pose):
    """True if the nearer end of B's line is no convex joint; of an arc, if either end is none."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    if b.kind != LINE:
        return b.before < 0 or b.after < 0
    pa, pb = pose[a.body], pose[b.body]
    ax, ay = point_of(pa, a.x, a.y)
    bx, by = point_of(pb, b.x + 0.5 * b.length * b.tx, b.y + 0.5 * b.length * b.ty)
    mx, my = point_of(pb, b.x, b.y)
    beyond = (pa.x + ax - pb.x - bx) * (bx - mx) + (pa.y + ay - pb.y - by) * (by - my) > 0.0
    return (b.after if beyond else b.before) < 0


# How fast can a gap change, at most, over a stretch of time?
#
# Bounds of the bodies' speeds and accelerations over the stretch, for the motion as computed (step_path.py), and of what these
# do
# to the gap of one contact. Conservative advancement rests on them (safe_times.py): a bound that is too small loses contacts.


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


# For how long can a gap that hardly changes not close, although its bodies move fast?
#
# A body that turns about one of its own corners, on which a corner of another body lies: gaps there stay at rounding while all
# coordinates accelerate. Bounds of the coordinates one by one (time_of_impact.py) do not see that their accelerations cancel,
# and would have such a gap looked at every few nanoseconds. Here the two material points at the place of the contact are
# compared, by their velocities and accelerations now and a bound of how fast these change (docs/theory/method.md 3.3).


@kernel
def _material_point(model, step, b, rx, ry, left, tau, path):
    """(vx, vy, ax, ay, bound of the third derivative for `left` s) of the point of body b at (rx, ry) from its origin."""
    body, pose = model.bodies[b], path.pose[b]
    i = body.first
    if body.motion == SLIDE:
        a = body.ratio * acceleration_on_path(model, step, i, tau, path)
        return pose.vx, pose.vy, a * body.axis_x, a * body.axis_y, abs(body.ratio) * jerk_bound(model, step, i)
    if body.motion == FIXED:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    turn = i if body.motion == PIVOT else i + 2
    w, twist = pose.w, body.ratio * acceleration_on_path(model, step, turn, tau, path)
    ax, ay, jerk = -twist * ry - w * w * rx, twist * rx - w * w * ry, 0.0
    if body.motion == FREE:
        ax += acceleration_on_path(model, step, i, tau, path)
        ay += acceleration_on_path(model, step, i + 1, tau, path)
        jerk = jerk_bound(model, step, i) + jerk_bound(model, step, i + 1)
    bound = abs(body.ratio) * step.bound[turn]
    fastest = abs(w) + bound * left
    change = abs(body.ratio) * jerk_bound(model, step, turn)
    jerk += (change + 3.0 * bound * fastest + fastest**3) * math.sqrt(rx * rx + ry * ry)
    return pose.vx - w * ry, pose.vy + w * rx, ax, ay, jerk


@kernel
def _points_apart(model, k, left, tau, step, path):
    """(vx, vy, ax, ay, bound of how a changes) of the point of A at the centre of its circle against that of B there."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa, pb = path.pose[a.body], path.pose[b.body]
    rx, ry = point_of(pa, a.x, a.y)
    one = _material_point(model, step, a.body, rx, ry, left, tau, path)
    two = _material_point(model, step, b.body, rx + pa.x - pb.x, ry + pa.y - pb.y, left, tau, path)
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
def time_still(model, k, room, left, tau, step, path):
    """A time up to `left` seconds in which the place of contact k moves by no more than `room` on either body, or 0.

    The bodies must stand in `path` where they are at `tau`. Not for carried bodies: 0.
    """
    if _is_carried(model, k):
        return 0.0
    vx, vy, ax, ay, jerk = _points_apart(model, k, left, tau, step, path)
    return _time_for(room, math.sqrt(vx * vx + vy * vy), math.sqrt(ax * ax + ay * ay), jerk, left)


@kernel
def time_apart(model, k, room, left, tau, step, path):
    """A time up to `left` seconds within which contact k, on the free side with this much room, cannot close; or 0.

    As in `time_still`. With x the way between the two points and e the normal, which turns with B, the gap falls by no more
    than -e·x. Not for hollow arcs, where it may fall by more: 0.
    """
    b = model.primitives[model.contacts[k].b]
    if b.side < 0.0 or _is_carried(model, k):
        return 0.0
    here = normal_gap(model, k, path.pose)
    vx, vy, ax, ay, jerk = _points_apart(model, k, left, tau, step, path)
    turn = _fastest_turn(model, b.body, left, step, path)
    jerk = jerk * (1.0 + turn * left) + 3.0 * turn * math.sqrt(ax * ax + ay * ay)
    push = max(-(here.nx * ax + here.ny * ay), 0.0) + 2.0 * turn * math.sqrt(vx * vx + vy * vy)
    return _time_for(room, max(-here.rate, 0.0), push, jerk, left)


# For how long can a gap certainly not close?
#
# With a bound B of |g''| over a stretch of time the gap stays above g + g' d - B d²/2, so time may advance to that parabola's
# zero; and what lies outside its primitives, cannot move, or goes on from a contact in force need not be looked at for a while.


@kernel
def safe_time(room, approach, closing, bend, distance):
    """A time within which a gap with this much room, closing now at rate `approach`, cannot close."""
    straight = room / closing
    if distance < math.inf:
        # Over this time the centres stay at least half as far apart as now.
        limit = 0.5 * distance / closing
        if distance > 0.0:
            bend += closing * closing / (0.5 * distance)
    else:
        limit = math.inf
    root = math.sqrt(approach * approach + 2.0 * bend * room)
    curved = math.inf
    if approach > 0.0:
        curved = 2.0 * room / (approach + root)
    elif bend > 0.0:
        curved = (root - approach) / bend
    return max(straight, min(curved, limit))


@kernel
def time_outside(model, k, inside_a, inside_b, motion, distance):
    """A time for which a contact stays outside its primitives, from how far inside each it is; 0 if it is inside both."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    closing, swing = motion
    near = 0.5 * distance
    turn = swing + closing / near  # of the normal in either body, while the centres keep half their distance
    time = 0.0
    if inside_a < 0.0:
        time = -inside_a / (turn * max(a.radius, a.length)) if turn > 0.0 else math.inf
    if inside_b < 0.0:
        time = max(time, -inside_b / (closing if b.kind == LINE else turn * b.radius))
    return min(time, near / closing)


@kernel
def is_due(gap, rate, outside, clear, options):
    """True if the gap crosses zero from the free side, or lies within the rounding behind it and goes on closing."""
    zero, band = options.gap_zero, options.behind
    if outside:
        return gap <= zero and ((clear and rate < 0.0) or gap < -zero)
    return gap >= -band and (rate < -options.speed_zero or (rate < 0.0 and gap <= zero - band))


@kernel
def time_to_zero(gap, rate, outside, bounds, options):
    """A time within which a gap, now at some distance from zero, is not due. `bounds`: closing, bend, distance."""
    closing, bend, distance = bounds
    if not outside:
        safe = safe_time(-gap, rate, closing, bend, distance)
        if gap >= -options.behind:
            safe = min(safe, safe_time(gap + options.behind, -rate, closing, bend, distance))
        return safe
    return safe_time(room_outside(gap, rate, options), -rate, closing, bend, distance)


@kernel
def time_to_touch(gap, rate, bounds, options):
    """In how long a gap closes that is zero to rounding and falls: where its tangent vanishes, unless it could be deeper then.

    A gap that has only begun to fall has a tangent that vanishes much later. `bounds`: closing, bend, distance.
    """
    closing, bend, distance = bounds
    if gap <= 0.0:
        return 0.0
    time = gap / -rate
    curved = closing * closing / (0.5 * distance) if distance > 0.0 else math.inf
    is_straight = 0.5 * (bend + curved) * time * time <= options.gap_zero and closing * time <= 0.5 * distance
    return time if is_straight else safe_time(gap, -rate, closing, bend, distance)


@kernel
def room_outside(gap, rate, options):
    """How far a gap on the free side may fall before it is due."""
    leaving = gap > options.gap_zero or rate > options.speed_zero
    return max(gap, 0.0) if leaving else gap + 2.0 * options.gap_zero


@kernel
def time_immovable(model, options, k, rate, bend, path):
    """Until when contact k, without a gap, need not be looked at because no motion closes it; 0 where one does.

    It may begin to close when its lever arms grow: it is looked at before it is further behind than counts as touching.
    """
    contact_kinematics(model, k, path.pose, 0, path.probe)
    if not is_immovable(model, path.probe, 0):
        return 0.0
    b = model.primitives[model.contacts[k].b]
    motion = model.bodies[b.body].motion
    if b.kind == LINE and motion in (FIXED, SLIDE):
        bend *= math.sqrt(IMMOVABLE)  # the line does not turn: bodies accelerate along it, too
    steady = 0.25 * options.behind / max(-rate, SLOWEST_CLOSING)
    return min(steady, math.sqrt(0.5 * options.behind / max(bend, SLOWEST_CLOSING)))


@kernel
def time_held(model, active, in_force, options, k, tau, rate, bounds, path):
    """For how long a contact that is due need not close: 0 if it closes now. `bounds`: closing, bend, swing, distance."""
    closing, bend, swing, distance = bounds
    # Where a smooth outline goes on, its next piece has no gap either, and closes only when its turn comes.
    way, turn = room_beside_active(model, active, in_force, options, k, path.pose)
    if way < 0.0:
        wait = time_immovable(model, options, k, rate, bend, path)
        return max(wait, TIME_ROUNDING * tau) if wait > 0.0 else 0.0
    # It is the same contact at least until points or normals could have come apart.
    turning = swing + closing / (0.5 * distance)
    same = 0.5 * min(way / closing, turn / turning if turning > 0.0 else math.inf)
    return max(same, NEIGHBOUR_STRIDE * options.extent / closing)


# Which of the open contacts that may close in a step could close first?
#
# A binary heap (Williams 1964) by the time up to which each is known to stay open. It is what the search for the time of impact
# looks at next: so no contact is searched beyond the first closing by more than one turn of looks.


@kernel
def put(waiting, count, contact, pair, times):
    """Add an entry to the heap `waiting[:count]`, `times` being (start, until, stays_open); returns the new count."""
    start, until, stays_open = times
    place = count
    while place > 0 and waiting[(place - 1) // 2].stays_open > stays_open:
        _copy(waiting[(place - 1) // 2], waiting[place])
        place = (place - 1) // 2
    entry = waiting[place]
    entry.contact, entry.pair, entry.start, entry.until, entry.stays_open = contact, pair, start, until, stays_open
    return count + 1


@kernel
def drop_first(waiting, count):
    """Take the first entry, `waiting[0]`, off the heap; returns the new count."""
    last, place = count - 1, 0
    while True:
        child = 2 * place + 1
        if child + 1 < last and waiting[child + 1].stays_open < waiting[child].stays_open:
            child += 1
        if child >= last or waiting[child].stays_open >= waiting[last].stays_open:
            break
        _copy(waiting[child], waiting[place])
        place = child
    _copy(waiting[last], waiting[place])
    return last


@kernel
def _copy(entry, out_entry):
    out_entry.contact, out_entry.pair = entry.contact, entry.pair
    out_entry.start, out_entry.until, out_entry.stays_open = entry.start, entry.until, entry.stays_open


# When, within the current step, does an open contact close first? None may be missed.

MAX_EVALUATIONS = 16  # at one contact, before one that could close earlier has its turn


@kernel
def _place(model, bodies, tau, step, path):
    """Bring two bodies to time tau of the step."""
    body_on_path(model, step, bodies[0], tau, path)
    body_on_path(model, step, bodies[1], tau, path)


@kernel
def _look(model, options, k, anew, level, path):
    """(gap of contact k above its level, rate, how far it is inside either primitive, level, which is found `anew` or kept)."""
    gap, rate, inside_a, inside_b = placed_gap(model, k, path.pose)
    if anew:
        level = sunk_level(model, options, k, gap, inside_b, path)
    return gap - level, rate, inside_a + options.extent, inside_b + options.extent, level  # beyond their ends still counts


@kernel
def crossing(model, active, in_force, options, k, span, step, path, out_counts):
    """(time, closes?): open contact k closes at that time within `span` (s), or does not until then.

    After `MAX_EVALUATIONS` looks the time may be short of `end`.
    """
    contact, (start, end) = model.contacts[k], span
    body_a, body_b = model.primitives[contact.a].body, model.primitives[contact.b].body
    _place(model, (body_a, body_b), start, step, path)
    length, closing, bend, swing = next_stretch(model, options, k, end - start, step, path)
    if closing == 0.0 and length == end - start:
        return end, False
    tau, stretch = start, start + length
    # `outside`: on the free side; `clear`: has been further than rounding from it since. Gaps count from `level`.
    fresh, outside, clear, beside, level = True, True, False, 0.0, 0.0
    for _ in range(MAX_EVALUATIONS):
        if tau >= end:
            break
        out_counts.gap_evaluations += 1
        if tau > start:
            _place(model, (body_a, body_b), tau, step, path)
        if tau >= stretch:
            length, closing, bend, swing = next_stretch(model, options, k, end - tau, step, path)
            stretch = tau + length
        anew = fresh or beside > 0.0  # what lay beside its primitives was no contact until now
        gap, rate, inside_a, inside_b, level = _look(model, options, k, anew, level, path)
        distance = centre_distance(model, k, path.pose)
        if fresh or not outside:
            outside, clear = gap >= -options.gap_zero, beside > 0.0
        fresh = True
        leaving = gap > options.gap_zero or rate > options.speed_zero
        clear = clear or (outside and leaving)  # a contact that has just rebounded returns to this gap by falling only
        beside = time_outside(model, k, inside_a, inside_b, (closing, swing), distance)
        # Positions jump where drift is taken back: a gap may have closed by that.
        near = gap <= options.gap_zero if outside else gap >= -options.behind
        if near and min(inside_a, inside_b) < 0.0:
            # At least the time in which the gap cannot pass through its rounding.
            wait = max(beside, options.gap_zero / closing)
            if wait < FINE_LOOK * (end - tau):
                way_in = -inside_b if model.primitives[contact.b].kind == LINE else 0.0
                wait = max(wait, time_still(model, k, max(options.gap_zero, way_in), end - tau, tau, step, path))
            tau += max(wait, TIME_ROUNDING * tau)
        elif is_due(gap, rate, outside, clear, options):
            wait = time_held(model, active, in_force, options, k, tau, rate, (closing, bend, swing, distance), path)
            if wait == 0.0:
                rest = time_to_touch(gap, rate, (closing, bend, distance), options) if outside and clear else 0.0
                time = tau + rest if tau + rest < end else tau
                return time, time < end
            tau += wait
        else:
            clear = clear and leaving if outside else clear
            safe = time_to_zero(gap, rate, outside, (closing, bend, distance), options)
            if outside and safe < FINE_LOOK * (end - tau):
                room = room_outside(gap, rate, options)
                if may_last(room, rate, safe):
                    safe = max(safe, time_apart(model, k, room, end - tau, tau, step, path))
            safe = max(safe, time_immovable(model, options, k, rate, bend, path) if near and not leaving else 0.0)
            # Beside its primitives the gap may pass through zero: which side it is on afterwards is determined again.
            fresh = beside > safe
            # Never less than the rounding of time itself.
            tau += beside if fresh else max(safe, TIME_ROUNDING * tau)
        if stretch < end:
            tau = min(tau, stretch)
    return min(tau, end), False


@hot_kernel
def _stays_open_for(model, options, k, here, length, first, bounds, path):
    """A time in which contact k, `here` its gap at the current poses, cannot close; infinity if it is `length` or more.

    `bounds` are the `body_bounds` of the pair's bodies, of body `first` and of the other one.
    """
    gap, rate = here.gap, here.rate
    if -options.behind <= gap <= options.gap_zero or sunk_level(model, options, k, gap, 0.0, path) < 0.0:
        return 0.0
    # Behind its primitive a contact must come out before it can close.
    room, approach = (gap, -rate) if gap > 0.0 else (-gap, rate)
    # The circle may be on either body of the pair.
    in_order = model.primitives[model.contacts[k].a].body == first
    closing, bend, _ = gap_bounds(model, k, length, bounds[0 if in_order else 1], bounds[1 if in_order else 0], path)
    if room > closing * length:
        return math.inf
    safe = safe_time(room, approach, closing, bend, centre_distance(model, k, path.pose))
    return math.inf if safe >= length else safe


@hot_kernel
def _is_out_of_reach(model, options, k, length, first, bounds, path):
    """True if the primitives of contact k are further apart than their bodies can come together; as `_stays_open_for`."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    one, other = bounds[0 if a.body == first else 1], bounds[1 if a.body == first else 0]
    turning = one.turn * path.around[contact.a].arm + other.turn * path.around[contact.b].arm
    way = length * (one.speed + other.speed + turning)
    return are_apart(contact, path.around, path.pose[a.body], path.pose[b.body], way + beyond_ends(options))


# When will a contact probably close? A step of coupled bodies that goes far beyond that is made in vain.


@kernel
def closing_expected(model, cells, state, options, longest, scratch):
    """(known, time): after how many seconds, of `longest`, a contact closes if accelerations stay as they are; else infinity.

    `known` is False when an unknown cell was met: it is then in `scratch.requested`. A guess, on which nothing depends but the
    length of the step.
    """
    path, step, soonest = scratch.path, scratch.step, math.inf
    for i in range(len(state.q)):
        path.u[i], step.bound[i] = state.u[i], abs(state.a[i])
    place(model, state.q, state.u, path.pose)
    for p in range(len(model.pairs)):
        pair = model.pairs[p]
        if is_at_rest(model, state.regime.awake, pair.a) and is_at_rest(model, state.regime.awake, pair.b):
            continue
        how, start, number = candidates(model, cells, p, state.q)
        if how == UNKNOWN:
            request_cell(scratch.requested, p, state.q)
            return False, soonest
        bounds = body_bounds(model, pair.a, longest, step, path), body_bounds(model, pair.b, longest, step, path)
        for slot in range(start, start + number):
            k, within = candidate(model, cells, how, slot), min(longest, soonest)
            if state.regime.mode[k] != OPEN or _is_out_of_reach(model, options, k, within, pair.a, bounds, path):
                continue
            state.counts.gap_evaluations += 1
            if _stays_open_for(model, options, k, normal_gap(model, k, path.pose), within, pair.a, bounds, path) < math.inf:
                time = _returns_after(model, options, k, state.a, path)
                if time < soonest and not is_beside_active(model, state.regime.active, state.instant.awake_contacts, k):
                    soonest = time
    return True, soonest


@kernel
def _returns_after(model, options, k, a, path):
    """When open contact k closes, s, if its gap moves on along a parabola; infinity if it does not, or where it is beside."""
    contact_kinematics(model, k, path.pose, 0, path.probe)
    here = path.probe.kin[0]
    still = here.g <= options.gap_zero and abs(here.gN_dot) <= options.speed_zero
    if here.g < -options.behind or here.margin < -options.extent or still:
        return math.inf
    gap, rate, bend = max(here.g, 0.0), here.gN_dot, gap_acceleration(path.probe, 0, a)
    square = rate * rate - 2.0 * bend * gap
    if square < 0.0:
        return math.inf
    if rate < 0.0:
        return 2.0 * gap / (math.sqrt(square) - rate)
    return (rate + math.sqrt(square)) / -bend if bend < 0.0 else math.inf


# Which of them closes first?


@kernel
def _list(model, cells, state, options, p, span, count, step, path):
    """(known, number waiting): put the contacts of pair p that may close in its cell among those that wait.

    With them when the pair enters its next cell. `span`: the time at which it is in this cell, and the end of the search.
    """
    pair, tau, end = model.pairs[p], span[0], span[1]
    _place(model, (pair.a, pair.b), tau, step, path)
    until = min(end, tau + time_in_cell(model, p, path.q, path.u, step.bound))
    how, start, number = candidates(model, cells, p, path.q)
    if how == UNKNOWN:
        return False, count
    if how == LISTED:
        state.counts.cells_looked_up += 1
    here = body_bounds(model, pair.a, until - tau, step, path), body_bounds(model, pair.b, until - tau, step, path)
    later = here
    if until < end:
        later = body_bounds(model, pair.a, end - tau, step, path), body_bounds(model, pair.b, end - tau, step, path)
    for slot in range(start, start + number):
        k = candidate(model, cells, how, slot)
        if state.regime.mode[k] != OPEN or path.spared[k] == path.search.number:
            continue
        if _is_out_of_reach(model, options, k, until - tau, pair.a, here, path):
            continue
        state.counts.gap_evaluations += 1
        look = normal_gap(model, k, path.pose)
        stays = tau + _stays_open_for(model, options, k, look, until - tau, pair.a, here, path)
        if stays >= until:
            # Dart and roller: no turning of the balance changes their gap, in whichever cell it is.
            if until < end and _stays_open_for(model, options, k, look, end - tau, pair.a, later, path) == math.inf:
                path.spared[k] = path.search.number
        elif not is_beside_active(model, state.regime.active, state.instant.awake_contacts, k):
            count = put(path.waiting, count, k, p, (tau, until, stays))
    if until < end:
        count = put(path.waiting, count, NO_CONTACT, p, (until, until, until))
    return True, count


@kernel
def first_touch(model, cells, state, options, end, scratch):
    """(known, time, contact) of the first closing in [0, end) of the current step, or NO_CONTACT.

    `known` is False when an unknown cell was met: it is then in `scratch.requested`. The contact that could
    close first is looked at next: what lies far off is not searched beyond the first closing, however long the step.
    """
    best, who, step, path = end, NO_CONTACT, scratch.step, scratch.path
    count, known, in_force = 0, True, state.instant.awake_contacts + state.instant.sleeping_contacts
    path.search.number += 1
    for p in range(len(model.pairs)):
        if is_at_rest(model, state.regime.awake, model.pairs[p].a) and is_at_rest(model, state.regime.awake, model.pairs[p].b):
            continue
        known, count = _list(model, cells, state, options, p, (0.0, end), count, step, path)
        if not known:
            request_cell(scratch.requested, p, path.q)
            return False, 0.0, NO_CONTACT
    while count > 0 and path.waiting[0].stays_open < best:
        first = path.waiting[0]
        k, p, start, until = first.contact, first.pair, first.start, first.until
        count = drop_first(path.waiting, count)
        if k == NO_CONTACT:
            known, count = _list(model, cells, state, options, p, (start, best), count, step, path)
            if not known:
                request_cell(scratch.requested, p, path.q)
                return False, 0.0, NO_CONTACT
            continue
        until = min(until, best)
        time, closes = crossing(model, state.regime.active, in_force, options, k, (start, until), step, path, state.counts)
        if closes:
            best, who = time, k
        elif time < until:
            count = put(path.waiting, count, k, p, (time, until, time))
    return True, best, who
