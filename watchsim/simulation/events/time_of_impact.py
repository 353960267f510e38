"""When, within the current step, does an open contact close first? None may be missed.

Safe steps: with a bound B of |g''| over a stretch of time the gap stays above g + g' d - B d²/2, so time may advance to that
parabola's zero. Near a contact this is Newton's method from the safe side (it converges quadratically and never jumps over
a root); far from it, one evaluation covers the whole stretch. The bounds hold for the motion as computed (step_path.py).
"""

from __future__ import annotations

import math

from watchsim.candidates.cell_lookup import LISTED, UNKNOWN, candidate, candidates, time_in_cell
from watchsim.contact.gaps import normal_gap, placed_gap
from watchsim.contact.index_sets import OPEN
from watchsim.contact.kinematics import contact_kinematics
from watchsim.contact.poses import point_of
from watchsim.jit import kernel
from watchsim.model.records import FIXED, FREE, LINE, PIVOT, SLIDE
from watchsim.simulation.events.handover import is_beside_active, room_beside_active
from watchsim.simulation.events.immovable import is_immovable
from watchsim.simulation.loop_state.scratch import ask
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.motion.sleeping import is_at_rest
from watchsim.simulation.motion.step_path import body_on_path
from watchsim.simulation.tolerances import IMMOVABLE, NEIGHBOUR_STRIDE, SLOWEST_CLOSING, TIME_ROUNDING


@kernel
def _body_bounds(model, b, length, step, path):
    """Bounds over the next `length` seconds: (speed, turning rate, acceleration, turning acceleration) of the frame."""
    body = model.bodies[b]
    own = _own_bounds(body, length, step, path)
    if body.carrier < 0:
        return own
    speed, turn, push, twist = _own_bounds(model.bodies[body.carrier], length, step, path)
    arm = math.sqrt(body.x * body.x + body.y * body.y)
    return speed + turn * arm, own[1], push + twist * arm + turn * turn * arm, own[3]


@kernel
def _own_bounds(body, length, step, path):
    """The same from the body's own coordinates alone."""
    i = body.first
    bound, ratio = step.bound, abs(body.ratio)
    if body.motion == PIVOT:
        return 0.0, ratio * (abs(path.u[i]) + bound[i] * length), 0.0, ratio * bound[i]
    if body.motion == SLIDE:
        return ratio * (abs(path.u[i]) + bound[i] * length), 0.0, ratio * bound[i], 0.0
    if body.motion == FREE:
        ax, ay = bound[i], bound[i + 1]
        acceleration = math.sqrt(ax * ax + ay * ay)
        speed = math.sqrt(path.u[i] ** 2 + path.u[i + 1] ** 2) + acceleration * length
        return speed, abs(path.u[i + 2]) + bound[i + 2] * length, acceleration, bound[i + 2]
    return 0.0, 0.0, 0.0, 0.0


@kernel
def _gap_bounds(model, k, length, bounds_a, bounds_b, path):
    """Bounds over the next `length` seconds: |g'|, |g''| but for B's curvature, and the bodies' relative turning.

    `bounds_a` and `bounds_b` are the `_body_bounds` of the two bodies.
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
def _centre_distance(model, k, pose):
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
def _safe(room, approach, closing, bend, distance):
    """A time within which a gap with this much room, closing now at rate `approach`, cannot close."""
    straight = room / closing
    if distance < math.inf:
        # Over this time the centres stay at least half as far apart as now.
        limit = 0.5 * distance / closing
        bend += closing * closing / (0.5 * distance) if distance > 0.0 else 0.0
    else:
        limit = math.inf
    root = math.sqrt(approach * approach + 2.0 * bend * room)
    if approach > 0.0:
        curved = 2.0 * room / (approach + root)
    else:
        curved = (root - approach) / bend if bend > 0.0 else math.inf
    return max(straight, min(curved, limit))


@kernel
def _time_outside(model, k, inside_a, inside_b, motion, distance):
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
def _is_due(gap, rate, outside, clear, options):
    """True if a gap that comes from outside has closed, or one that lies within the rounding behind it goes on closing."""
    zero, band = options.gap_zero, options.behind
    if outside:
        return gap <= zero and ((clear and rate < 0.0) or gap < -zero)
    return gap >= -band and (rate < -options.speed_zero or (rate < 0.0 and gap <= zero - band))


@kernel
def _time_to_zero(gap, rate, outside, bounds, options):
    """A time within which a gap, now at some distance from zero, is not due. `bounds`: closing, bend, distance."""
    closing, bend, distance = bounds
    if not outside:
        safe = _safe(-gap, rate, closing, bend, distance)
        if gap >= -options.behind:
            safe = min(safe, _safe(gap + options.behind, -rate, closing, bend, distance))
        return safe
    leaving = gap > options.gap_zero or rate > options.speed_zero
    return _safe(max(gap, 0.0) if leaving else gap + 2.0 * options.gap_zero, -rate, closing, bend, distance)


@kernel
def _next_stretch(model, options, k, left, step, path):
    """(length, closing, bend, swing): how long the bounds shall hold, of `left` seconds, and the `_gap_bounds` for so long.

    What is thrown far has bounds far beyond its motion: a stretch is no longer than the bodies travel by the scene's size.
    """
    contact = model.contacts[k]
    a, b = model.primitives[contact.a].body, model.primitives[contact.b].body
    length = left
    bounds_a, bounds_b = _body_bounds(model, a, left, step, path), _body_bounds(model, b, left, step, path)
    speed = bounds_a[0] + bounds_b[0]
    if speed * left > options.size:
        length = options.size / speed
        bounds_a, bounds_b = _body_bounds(model, a, length, step, path), _body_bounds(model, b, length, step, path)
    closing, bend, swing = _gap_bounds(model, k, length, bounds_a, bounds_b, path)
    return length, closing, bend, swing


@kernel
def _time_immovable(model, options, k, rate, bend, path):
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
def crossing(model, state, options, k, start, end, step, path):
    """First time in [start, end) at which open contact k closes inside its primitives; infinity if it does not.

    The two bodies must stand where they are at `start`.
    """
    contact = model.contacts[k]
    body_a, body_b = model.primitives[contact.a].body, model.primitives[contact.b].body
    length, closing, bend, swing = _next_stretch(model, options, k, end - start, step, path)
    if closing == 0.0 and length == end - start:
        return math.inf
    zero = options.gap_zero
    tau, stretch = start, start + length
    # `outside`: on the free side; `clear`: has been further than rounding from it since.
    fresh, outside, clear, beside = True, True, False, 0.0
    while tau < end:
        if tau > start:
            body_on_path(model, state, step, body_a, tau, path)
            body_on_path(model, state, step, body_b, tau, path)
        if tau >= stretch:
            length, closing, bend, swing = _next_stretch(model, options, k, end - tau, step, path)
            stretch = tau + length
        gap, rate, inside_a, inside_b = placed_gap(model, k, path.pose)
        distance = _centre_distance(model, k, path.pose)
        state.counts.gap_evaluations += 1
        if fresh or not outside:
            outside, clear = gap >= -zero, beside > 0.0  # what lay beside its primitives was no contact until now
        fresh = False
        leaving = gap > zero or rate > options.speed_zero
        clear = clear or (outside and leaving)  # a contact that has just rebounded returns to this gap by falling only
        # The extent beyond their ends still counts.
        inside_a, inside_b = inside_a + options.extent, inside_b + options.extent
        beside = _time_outside(model, k, inside_a, inside_b, (closing, swing), distance)
        # Positions jump where drift is taken back: a gap may have closed by that.
        near = gap <= zero if outside else gap >= -options.behind
        if near and min(inside_a, inside_b) < 0.0:
            # At least the time in which the gap cannot pass through its rounding.
            tau += max(beside, zero / closing)
            fresh = True
        elif _is_due(gap, rate, outside, clear, options):
            # Where a smooth outline goes on, its next piece has no gap either, and closes only when its turn comes.
            way, turn = room_beside_active(model, state, options, k, path.pose)
            if way < 0.0:
                wait = _time_immovable(model, options, k, rate, bend, path)
                if wait > 0.0:
                    tau += max(wait, TIME_ROUNDING * tau)
                    fresh = True
                    continue
                soon = outside and clear and gap > 0.0 and rate * (end - tau) < -gap
                return min(end, tau + gap / -rate) if soon else tau
            # It is the same contact at least until points or normals could have come apart.
            turning = swing + closing / (0.5 * distance)
            same = 0.5 * min(way / closing, turn / turning if turning > 0.0 else math.inf)
            tau += max(same, NEIGHBOUR_STRIDE * options.extent / closing)
            fresh = True
        else:
            clear = clear and leaving if outside else clear
            safe = _time_to_zero(gap, rate, outside, (closing, bend, distance), options)
            safe = max(safe, _time_immovable(model, options, k, rate, bend, path) if near and not leaving else 0.0)
            # Beside its primitives the gap may pass through zero: which side it is on afterwards is found anew.
            fresh = beside > safe
            # Never less than the rounding of time itself.
            tau += beside if fresh else max(safe, TIME_ROUNDING * tau)
        if stretch < end:
            tau = min(tau, stretch)
    return math.inf


@kernel
def _stays_open(model, state, options, k, length, first, bounds, path):
    """True if one look at the current poses shows that contact k cannot close in the next `length` seconds.

    `bounds` are the `_body_bounds` of the pair's bodies, of body `first` and of the other one.
    """
    here = normal_gap(model, k, path.pose)
    gap, rate = here.gap, here.rate
    state.counts.gap_evaluations += 1
    if -options.behind <= gap <= options.gap_zero:
        return False
    # Behind its primitive a contact must come out before it can close.
    room, approach = (gap, -rate) if gap > 0.0 else (-gap, rate)
    # The circle may be on either body of the pair.
    in_order = model.primitives[model.contacts[k].a].body == first
    closing, bend, _ = _gap_bounds(model, k, length, bounds[0 if in_order else 1], bounds[1 if in_order else 0], path)
    return room > closing * length or _safe(room, approach, closing, bend, _centre_distance(model, k, path.pose)) >= length


@kernel
def _place_pair(model, state, pair, tau, step, path):
    body_on_path(model, state, step, pair.a, tau, path)
    body_on_path(model, state, step, pair.b, tau, path)


@kernel
def _first_of(model, cells, state, options, p, tau, until, step, path):
    """(known, time, contact) of the first closing in [tau, until) among the candidates of pair p in one cell."""
    pair = model.pairs[p]
    best, who = until, NO_CONTACT
    how, start, count = candidates(model, cells, p, path.q)
    if how == UNKNOWN:
        return False, 0.0, NO_CONTACT
    if how == LISTED:
        state.counts.cells_looked_up += 1
    bounds = (_body_bounds(model, pair.a, until - tau, step, path), _body_bounds(model, pair.b, until - tau, step, path))
    doubts = 0
    for place in range(start, start + count):
        k = candidate(model, cells, how, place)
        if state.mode[k] != OPEN or is_beside_active(model, state, k):
            continue
        if not _stays_open(model, state, options, k, until - tau, pair.a, bounds, path):
            path.doubt[doubts] = k
            doubts += 1
    for j in range(doubts):
        if j > 0:
            _place_pair(model, state, pair, tau, step, path)
        root = crossing(model, state, options, path.doubt[j], tau, best, step, path)
        if root < best:
            best, who = root, path.doubt[j]
    return True, best, who


@kernel
def first_touch(model, cells, state, options, end, scratch):
    """(known, time, contact) of the first closing in [0, end) of the current step, or NO_CONTACT.

    `known` is False when a cell was met that nobody has asked about: it is then in `scratch.asked`.
    """
    best, who, step, path = end, NO_CONTACT, scratch.step, scratch.path
    for p in range(len(model.pairs)):
        pair = model.pairs[p]
        if is_at_rest(model, state, pair.a) and is_at_rest(model, state, pair.b):
            continue
        tau = 0.0
        while tau < best:
            _place_pair(model, state, pair, tau, step, path)
            until = min(best, tau + time_in_cell(model, p, path.q, path.u, step.bound))
            known, root, k = _first_of(model, cells, state, options, p, tau, until, step, path)
            if not known:
                ask(scratch.asked, p, path.q)
                return False, 0.0, NO_CONTACT
            if k >= 0:
                best, who = root, k
                break
            tau = until
    return True, best, who
