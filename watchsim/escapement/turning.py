"""How far can one body be turned until it touches another, all others held?

Exact: the centre of a circle that turns about a pivot meets a line, or a circle of another radius, where a cosine has a known
value. Whether the place lies on both primitives is asked of the gap functions of the simulation (docs/theory/method.md 2.2).
"""

from __future__ import annotations

import math

from watchsim.contact.gaps import margins_of, place, point_of, shape_of_contact
from watchsim.jit import entry, kernel
from watchsim.model import LINE


@kernel
def _crossings(a, b, pa, pb, pivot, turns_a):
    """(found, first, second): turns at which the circle of `a` lies against the whole line or circle of `b`."""
    ox, oy = pivot
    vx, vy = point_of(pa, a.x, a.y)
    vx, vy = vx + pa.x - ox, vy + pa.y - oy
    reach = math.hypot(vx, vy)
    if b.kind == LINE:
        ex, ey = point_of(pb, b.nx, b.ny)
        px, py = point_of(pb, b.x, b.y)
        height = a.radius + ex * (px + pb.x - ox) + ey * (py + pb.y - oy)
    else:
        ex, ey = point_of(pb, b.x, b.y)
        ex, ey = ex + pb.x - ox, ey + pb.y - oy
        away = math.hypot(ex, ey)
        if away == 0.0:
            return False, 0.0, 0.0
        radius = b.radius + b.side * a.radius
        # The law of cosines without the cancellation of large squares.
        height = 0.5 * (reach * reach + (away - radius) * (away + radius)) / away
    if not abs(height) <= reach or reach == 0.0:
        return False, 0.0, 0.0
    between = math.atan2(vx * ey - vy * ex, vx * ex + vy * ey)
    half = math.acos(height / reach)
    if turns_a:
        return True, between + half, between - half
    return True, -between - half, half - between


@kernel
def _margin_and_rate(primitives, contact, pose, turned):
    """How far inside both primitives a contact lies, m; how fast its gap opens as body `turned` turns, m/rad."""
    a, b = primitives[contact.a], primitives[contact.b]
    pa, pb = pose[a.body], pose[b.body]
    shape = shape_of_contact(contact, a, b, pa, pb)
    inside_a, inside_b = margins_of(contact, a, b, pa, pb, shape)
    x, y = shape[5] + pa.x - pose[turned].x, shape[6] + pa.y - pose[turned].y
    rate = x * shape[2] - y * shape[1]
    return min(inside_a, inside_b), rate if a.body == turned else -rate


@kernel
def _turn_to_touch(model, ids, q, turned, sense, span, room, out_pose):
    place(model, q, q, out_pose)
    own = out_pose[turned]
    c, s = own.c, own.s
    best, found = span[1], -1
    for k in ids:
        contact = model.contacts[k]
        a, b = model.primitives[contact.a], model.primitives[contact.b]
        own.c, own.s = c, s
        met, first, second = _crossings(a, b, out_pose[a.body], out_pose[b.body], (own.x, own.y), a.body == turned)
        if not met:
            continue
        for root in (first, second):
            turn = sense * root - span[0]
            turn = turn - 2.0 * math.pi * math.floor(turn / (2.0 * math.pi)) + span[0]
            if turn >= best:
                continue
            cd, sd = math.cos(turn), sense * math.sin(turn)
            own.c, own.s = c * cd - s * sd, s * cd + c * sd
            margin, rate = _margin_and_rate(model.primitives, contact, out_pose, turned)
            if margin >= -room and sense * rate < -room:
                best, found = turn, k
    return best, found


@entry
def turn_to_touch(model, ids, q, turned, sense, span, room, out_pose):
    """(turn, contact): the least turn of body `turned` in direction `sense` (±1) at which one of the contacts `ids` closes.

    The body stands at coordinates q; turns from span[0] to span[1] (rad, less than a whole turn) are looked at, all others are
    held. (span[1], -1) where it stays free. A contact counts up to `room` (m) beyond the ends of its primitives.
    `out_pose` is scratch: one row per body.
    """
    return _turn_to_touch(model, ids, q, turned, sense, span, room, out_pose)


@entry
def turns_to_touch(model, ids, q, moved, angles, turned, reach, room, out_turns):
    """The same with coordinate `moved` at each of `angles` in turn: fills `out_turns`, infinite where the body stays free.

    Turns from 0 to `reach` are looked at, in its direction. `out_turns[0]` takes them, `out_turns[1]` is scratch, as is
    q: its coordinate `moved` stands at the last of the angles afterwards.
    """
    turns, pose = out_turns
    for i in range(len(angles)):
        q[moved] = angles[i]
        turn, found = _turn_to_touch(model, ids, q, turned, math.copysign(1.0, reach), (0.0, abs(reach)), room, pose)
        turns[i] = turn if found >= 0 else math.inf


@entry
def describe(model, k, q, out_pose, out_row):
    """Fill `out_row` (5) with contact `k`: gap; normal out of B's material; the contact point in the movement, m."""
    place(model, q, q, out_pose)
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    shape = shape_of_contact(contact, a, b, out_pose[a.body], out_pose[b.body])
    out_row[0], out_row[1], out_row[2] = shape[0], shape[1], shape[2]
    out_row[3], out_row[4] = out_pose[a.body].x + shape[5], out_pose[a.body].y + shape[6]


STEP = math.radians(0.25)  # of the lever, in the search for changes
WIDTH = 1e-11  # rad of the lever: a change is known to that
LEVEL = 1e-7  # a wheel that turns by less than that share of the lever's turn stands still
JUMP = 2.0  # times what its slope explains, and a little: the wheel has been let off
LITTLE = math.radians(0.02)


@entry
def jumps(lever, wheel, slope, lever_then, wheel_then, slope_then):
    """Has the wheel gone further between two rests than their slopes explain?"""
    way = abs(lever_then - lever)
    return abs(wheel_then - wheel) > JUMP * max(abs(slope), abs(slope_then)) * way + LITTLE


@kernel
def _level(slope):
    return 0 if abs(slope) <= LEVEL else (1 if slope > 0.0 else -1)


@kernel
def _let_go(model, ids, q, own, lever, wheel, hold, out_pose):
    """(contact, wheel, slope): where the wheel, turned back and let go, rests; contact -1 where it is free over `reach`."""
    way, led, back, reach, room = hold
    wheel -= way * back
    q[own[0]], q[own[1]] = wheel, lever
    turn, k = _turn_to_touch(model, ids, q, own[2], way, (0.0, reach), room, out_pose)
    if k < 0:
        return -1, wheel, 0.0
    wheel += way * turn
    q[own[0]] = wheel
    place(model, q, q, out_pose)
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    shape = shape_of_contact(contact, a, b, out_pose[a.body], out_pose[b.body])
    x, y = out_pose[a.body].x + shape[5], out_pose[a.body].y + shape[6]
    sign = 1.0 if a.body == own[2] else -1.0
    of_wheel = sign * ((x - out_pose[own[2]].x) * shape[2] - (y - out_pose[own[2]].y) * shape[1])
    of_lever = -sign * ((x - out_pose[own[3]].x) * shape[2] - (y - out_pose[own[3]].y) * shape[1])
    return k, wheel, -way * led * of_lever / of_wheel


@entry
def lead_on(model, ids, q, own, here, end, hold, out_pose):
    """(lever, wheel, contact) of the last rest of the same kind as `here`, and the same of what is just beyond it, its contact
    -1 where the wheel is free there, or where that one is at `end`.

    own   coordinates of wheel and lever, their bodies
    here  (lever, wheel, contact, slope) of a rest
    hold  (way, led, back, reach, room): ±1, in which the wheel is driven and the lever led; by how much the wheel is turned
          back before it is let go, and how far it may run, rad; `room` as of `turn_to_touch`
    q and `out_pose` are scratch.
    """
    good, wheel, contact, slope = here
    bad, beyond, k = end, wheel, -1
    is_bad = False
    while good != end and not (is_bad and abs(bad - good) <= WIDTH):
        if is_bad:
            lever = 0.5 * (good + bad)
        else:
            lever = good + hold[1] * min(STEP, abs(end - good))
            lever = end if abs(end - lever) < WIDTH else lever
        met, there, leans = _let_go(model, ids, q, own, lever, wheel, hold, out_pose)
        other = met != contact or _level(leans) != _level(slope)
        if other or jumps(good, wheel, slope, lever, there, leans):
            bad, beyond, k, is_bad = lever, there, met, True
        else:
            good, wheel, slope = lever, there, leans
    return good, wheel, contact, bad, beyond, k
