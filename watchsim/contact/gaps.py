"""How do gaps change with motion?

For each closed contact: gap and rates, force directions w_N and w_T, and the bar terms of
g_N'' = w_N·u' + w̄_N and g_T'' = w_T·u' + w̄_T, in closed form (docs/theory/method.md; Pfeiffer & Glocker 1996, ch. 4).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import by_reference, entry, hot_kernel, kernel
from watchsim.model import FIXED, FREE, FULL, LINE, PIVOT, SLIDE, Records, records
from watchsim.tolerances import SPIN_ROUNDING, TILT_ROUNDING

# Which contacts are closed, resting, sliding or sticking?
#
# The mode of a contact is indexed by its permanent number. Of the closed contacts I_C those that neither approach nor separate
# are I_N (method 2.3); the decision over I_N (method 2.5) leaves some in force, whose mode is not OPEN. I_T are those that
# STICK.

OPEN = 0
FORWARD = 1  # sliding with g_T_dot > 0: friction force -mu lambda_N
BACKWARD = -1
STICK = 2


# Where is every body now, and how fast does it move?

POSE = np.dtype(
    [
        ("x", "f8"),  # origin of the body's frame
        ("y", "f8"),
        ("c", "f8"),  # cosine and sine of its angle
        ("s", "f8"),
        ("vx", "f8"),
        ("vy", "f8"),
        ("w", "f8"),
        ("rx", "f8"),  # of a carried body: from its carrier's origin to its own,
        ("ry", "f8"),
        ("ax", "f8"),  # and how its origin accelerates while no velocity changes; else always 0
        ("ay", "f8"),
    ]
)


def poses(bodies: int) -> np.recarray:
    """Room for the poses of that many bodies."""
    return records(POSE, bodies)


@hot_kernel
def _ride(carrier, body, q, u, pose):
    """Origin of a carried body: the point (body.x, body.y) of its carrier's frame. A carrier owns its coordinate."""
    i = carrier.first
    if carrier.motion == SLIDE:
        pose.rx, pose.ry = carrier.c * body.x - carrier.s * body.y, carrier.s * body.x + carrier.c * body.y
        pose.x, pose.y = carrier.x + q[i] * carrier.axis_x + pose.rx, carrier.y + q[i] * carrier.axis_y + pose.ry
        pose.vx, pose.vy = u[i] * carrier.axis_x, u[i] * carrier.axis_y
        return
    turn = i if carrier.motion == PIVOT else i + 2
    c, s, w = math.cos(q[turn]), math.sin(q[turn]), u[turn]
    pose.rx, pose.ry = c * body.x - s * body.y, s * body.x + c * body.y
    pose.x, pose.y = carrier.x + pose.rx, carrier.y + pose.ry
    pose.vx, pose.vy = -w * pose.ry, w * pose.rx
    pose.ax, pose.ay = -w * w * pose.rx, -w * w * pose.ry
    if carrier.motion != PIVOT:
        pose.x, pose.y = q[i] + pose.rx, q[i + 1] + pose.ry
        pose.vx, pose.vy = pose.vx + u[i], pose.vy + u[i + 1]


@hot_kernel
def place_body(model, b, q, u, out_pose):
    """Pose and velocity of body `b` from coordinates q and velocities u."""
    body = model.bodies[b]
    i = body.first
    pose = out_pose[b]
    pose.x, pose.y, pose.c, pose.s = body.x, body.y, body.c, body.s
    pose.vx, pose.vy, pose.w = 0.0, 0.0, 0.0
    if body.motion == PIVOT:
        angle = body.ratio * q[i] + body.phase
        pose.c, pose.s, pose.w = math.cos(angle), math.sin(angle), body.ratio * u[i]
        if body.carrier >= 0:
            _ride(model.bodies[body.carrier], body, q, u, pose)
    elif body.motion == SLIDE:
        way, speed = body.ratio * q[i] + body.phase, body.ratio * u[i]
        pose.x, pose.y = body.x + way * body.axis_x, body.y + way * body.axis_y
        pose.vx, pose.vy = speed * body.axis_x, speed * body.axis_y
    elif body.motion != FIXED:
        pose.x, pose.y, pose.c, pose.s = q[i], q[i + 1], math.cos(q[i + 2]), math.sin(q[i + 2])
        pose.vx, pose.vy, pose.w = u[i], u[i + 1], u[i + 2]


@kernel
def place(model, q, u, out_pose):
    """Poses and velocities of all bodies."""
    for b in range(len(model.bodies)):
        place_body(model, b, q, u, out_pose)


@kernel
def point_of(pose, x, y):
    """World position relative to the frame's origin (rx, ry) of the body point (x, y)."""
    return pose.c * x - pose.s * y, pose.s * x + pose.c * y


# How open is a contact, and how fast does it close?
#
# Every pair is a circle (a convex arc, or a corner: radius 0) on body A against a line or an arc on body B. One gap function
# serves all of them: both sides are given by a point on the outline and the normal there, and A's radius is added to B's
# curve, which leaves a point against one curve of curvature K (docs/theory/method.md 2.2). No centre enters, so nothing is
# lost where arcs are so flat that their centres lie far away. A gap is defined for the whole infinite line or full circle;
# whether the contact lies inside both primitives is a question of its own.


class Shape(NamedTuple):
    """Where the two sides of a contact are to each other, and how they are bent."""

    gap: float  # m
    nx: float  # outward normal of B's material; 0 where circle and arc are concentric
    ny: float
    Q: float  # 1 + K gap; 0 where circle and arc are concentric
    foot: float  # K times the way from B's point along B's tangent there, over Q: the sine of n's angle from B's normal
    arm_x: float  # from A's origin to the contact, m
    arm_y: float


class Gap(NamedTuple):
    """How open a contact is, and how fast that changes."""

    gap: float  # m
    rate: float  # m/s
    nx: float  # outward normal of B's material
    ny: float


class PlacedGap(NamedTuple):
    """The same, with how far inside each of its primitives the contact lies; negative outside."""

    gap: float  # m
    rate: float  # m/s
    inside_a: float  # m
    inside_b: float


@hot_kernel
def shape_of_contact(contact, a, b, pa, pb):
    """The `Shape` of a contact between primitives a and b at poses pa and pb."""
    curvature, radius = contact.curvature, a.radius
    ax, ay = point_of(pa, a.px, a.py)
    bx, by = point_of(pb, b.px, b.py)
    max_, may = point_of(pa, a.nx, a.ny)
    mbx, mby = point_of(pb, b.nx, b.ny)
    wx, wy = (pa.x - pb.x) + (ax - bx), (pa.y - pb.y) + (ay - by)
    # The sum of the two normals: small where the contact is near both points.
    sx, sy = max_ + mbx, may + mby
    x, y = wx - radius * sx, wy - radius * sy
    nx, ny = mbx + curvature * x, mby + curvature * y
    Q = math.sqrt(nx * nx + ny * ny)
    gap = (2.0 * (wx * mbx + wy * mby) - radius * (sx * sx + sy * sy) + curvature * (x * x + y * y)) / (1.0 + Q)
    if Q == 0.0:
        return Shape(gap, 0.0, 0.0, 0.0, 0.0, ax, ay)
    nx, ny = nx / Q, ny / Q
    foot = curvature * (mbx * y - mby * x) / Q
    return Shape(gap, nx, ny, Q, foot, ax - radius * (max_ + nx), ay - radius * (may + ny))


@kernel
def _gap_rate(shape, pa, pb):
    """Of both materials at the contact point: what moves along the tangent does not change the gap."""
    x, y = shape.arm_x, shape.arm_y
    vx = pa.vx - pb.vx - pa.w * y + pb.w * (y + pa.y - pb.y)
    vy = pa.vy - pb.vy + pa.w * x - pb.w * (x + pa.x - pb.x)
    return shape.nx * vx + shape.ny * vy


@hot_kernel
def normal_gap(model, k, pose):
    """The `Gap` of contact `k`."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa, pb = pose[a.body], pose[b.body]
    shape = shape_of_contact(contact, a, b, pa, pb)
    return Gap(shape.gap, _gap_rate(shape, pa, pb), shape.nx, shape.ny)


@hot_kernel
def placed_gap(model, k, pose):
    """The `PlacedGap` of contact `k`."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa, pb = pose[a.body], pose[b.body]
    shape = shape_of_contact(contact, a, b, pa, pb)
    inside_a, inside_b = margins_of(contact, a, b, pa, pb, shape)
    return PlacedGap(shape.gap, _gap_rate(shape, pa, pb), inside_a, inside_b)


# Which contacts are too far off to look at? Where circles around two primitives are apart, these do not touch.

CIRCLE = np.dtype(
    [
        ("x", "f8"),  # its centre in the body's frame
        ("y", "f8"),
        ("radius", "f8"),  # nothing of the primitive is further from there
        ("arm", "f8"),  # of the centre about the body's origin
    ]
)


def circles_around(primitives: Records) -> Records:
    """A `CIRCLE` around each primitive: about the middle of a line or an arc, a corner itself."""
    half, rows = 0.5 * primitives.length, records(CIRCLE, len(primitives))
    straight = primitives.kind == LINE
    rows.x = primitives.px + np.where(straight, half * primitives.tx, 0.0)
    rows.y = primitives.py + np.where(straight, half * primitives.ty, 0.0)
    # From the middle of an arc to its ends; the sine of a quarter of its angle, exact also for flat arcs.
    whole = primitives.extent == FULL
    angle = np.where(whole, np.pi, np.arctan2(primitives.half_sin, primitives.half_cos))
    rows.radius = np.where(straight, half, 2.0 * primitives.radius * np.sin(0.5 * angle))
    rows.arm = np.hypot(rows.x, rows.y)
    return rows


@hot_kernel
def are_apart(contact, around, pa, pb, least):
    """True if the primitives of a contact are further than `least` (m) from each other; their bodies are at pa and pb."""
    a, b = around[contact.a], around[contact.b]
    ax, ay = point_of(pa, a.x, a.y)
    bx, by = point_of(pb, b.x, b.y)
    x, y, reach = (pa.x - pb.x) + (ax - bx), (pa.y - pb.y) + (ay - by), a.radius + b.radius + least
    return x * x + y * y > reach * reach


@kernel
def contact_point(model, k, pose):
    """The contact point of `k` in the world, on A's circle: (x, y)."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa = pose[a.body]
    shape = shape_of_contact(contact, a, b, pa, pose[b.body])
    return pa.x + shape.arm_x, pa.y + shape.arm_y


@kernel
def _inside_fan(p, along, across, reach):
    """How far a normal lies inside a primitive's fan: reach × the sine of the angle to the fan's end.

    (along, across) are cosine and size of the sine of its angle from the middle of the fan. More than a right angle from the
    ends counts as one.
    """
    if p.extent == FULL:
        return reach
    sine = p.half_sin * along - p.half_cos * across
    if p.half_cos * along + p.half_sin * across < 0.0:
        return math.copysign(reach, sine)
    return reach * sine


@kernel
def gap_of_arc(p):
    """Angle between the ends of an arc of more than half a turn, which is not part of it, rad; infinite of other primitives."""
    if p.half_cos >= 0.0 or p.extent == FULL or p.kind == LINE or p.radius == 0.0:
        return math.inf
    return 2.0 * (math.pi - math.atan2(p.half_sin, p.half_cos))


@hot_kernel
def margins_of(contact, a, b, pa, pb, shape):
    """How far inside primitive a and inside b the contact lies, metres; negative outside."""
    nx, ny, x, y = shape.nx, shape.ny, shape.arm_x, shape.arm_y
    if shape.Q == 0.0:
        return 0.0, -b.radius
    # The contact lies on A in the direction -n from the circle's centre.
    fx, fy = point_of(pa, a.nx, a.ny)
    inside_a = _inside_fan(a, -(nx * fx + ny * fy), abs(nx * fy - ny * fx), max(a.radius, a.length))
    if b.kind == LINE:
        bx, by = point_of(pb, b.x, b.y)
        tx, ty = point_of(pb, b.tx, b.ty)
        way = tx * (x + (pa.x - pb.x) - bx) + ty * (y + (pa.y - pb.y) - by)
        return inside_a, min(way, b.length - way)
    fx, fy = point_of(pb, b.nx, b.ny)
    return inside_a, _inside_fan(b, nx * fx + ny * fy, abs(shape.foot), b.radius)


@kernel
def extent_margins(model, k, pose):
    """How far inside A's and inside B's primitive contact `k` lies, metres; negative outside."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa, pb = pose[a.body], pose[b.body]
    return margins_of(contact, a, b, pa, pb, shape_of_contact(contact, a, b, pa, pb))


@kernel
def extent_margin(model, k, pose):
    """How far inside both primitives contact `k` lies, metres; negative outside."""
    inside_a, inside_b = extent_margins(model, k, pose)
    return min(inside_a, inside_b)


KINEMATICS = np.dtype(
    [
        ("g", "f8"),
        ("gN_dot", "f8"),
        ("gT_dot", "f8"),
        ("bar_N", "f8"),
        ("bar_T", "f8"),
        ("bar_size", "f8"),  # magnitudes of the vectors that both are made of, m/s²: the scale of their rounding
        ("margin", "f8"),  # how far inside its primitives the contact lies, m
        ("x", "f8"),  # contact point in the world
        ("y", "f8"),
        ("nx", "f8"),  # outward normal of B's material
        ("ny", "f8"),
    ]
)
SLOTS = 8  # a contact moves at most two bodies, each carried by a free one


class Closed(NamedTuple):
    """The closed contacts of one instant: `ids` (permanent numbers), kinematics and sparse force directions.

    Row i has `slots[i]` entries: coordinate `coord[i, j]` with w_N `w_N[i, j]` and w_T `w_T[i, j]`.
    """

    ids: NDArray[np.int64]
    kin: Records
    slots: NDArray[np.int64]
    coord: NDArray[np.int64]
    w_N: NDArray[np.float64]
    w_T: NDArray[np.float64]


ClosedRef = by_reference(Closed, __name__)


def closed_contacts(room: int) -> Closed:
    """Room for that many closed contacts."""
    return Closed(
        np.zeros(room, np.int64),
        records(KINEMATICS, room),
        np.zeros(room, np.int64),
        np.zeros((room, SLOTS), np.int64),
        np.zeros((room, SLOTS)),
        np.zeros((room, SLOTS)),
    )


@kernel
def _share(direction, axis):
    """Of a direction along an axis; of one across it rounding alone is left, by which no force may hold or move a body."""
    share = direction[0] * axis[0] + direction[1] * axis[1]
    return share if abs(share) > TILT_ROUNDING else 0.0


@hot_kernel
def _directions(model, b, row, sign, frame, out_closed):
    """Append body b's entries of w_N, w_T; frame = (nx, ny, arm_x, arm_y), the arm from the body's origin to the contact.

    For a carrier the arm ends at the pivot of the body that it carries: turning it, it shifts that body and turns it not.
    """
    body = model.bodies[b]
    nx, ny, rx, ry = frame
    tx, ty = -ny, nx
    j = out_closed.slots[row]
    sign *= body.ratio
    if body.motion == SLIDE:
        out_closed.coord[row, j] = body.first
        out_closed.w_N[row, j] = sign * _share((nx, ny), (body.axis_x, body.axis_y))
        out_closed.w_T[row, j] = sign * _share((tx, ty), (body.axis_x, body.axis_y))
        out_closed.slots[row] = j + 1
        return
    turn = body.first
    if body.motion == FREE:
        for i in range(2):
            out_closed.coord[row, j + i] = body.first + i
            out_closed.w_N[row, j + i] = sign * (nx if i == 0 else ny)
            out_closed.w_T[row, j + i] = sign * (tx if i == 0 else ty)
        j += 2
        turn += 2
    if body.motion in (FREE, PIVOT):
        out_closed.coord[row, j] = turn
        out_closed.w_N[row, j] = sign * (rx * ny - ry * nx)
        out_closed.w_T[row, j] = sign * (rx * ty - ry * tx)
        j += 1
    out_closed.slots[row] = j


@hot_kernel
def _add_carriers(model, body_a, body_b, row, normal, pose, out_closed):
    """What the carriers of the two bodies add: their coordinates, and how they make the bodies' origins accelerate."""
    nx, ny = normal
    kin = out_closed.kin[row]
    for side in range(2):
        b, sign = (body_a, 1.0) if side == 0 else (body_b, -1.0)
        if model.bodies[b].carrier >= 0:
            p = pose[b]
            kin.bar_N += sign * (nx * p.ax + ny * p.ay)
            kin.bar_T += sign * (nx * p.ay - ny * p.ax)
            _directions(model, model.bodies[b].carrier, row, sign, (nx, ny, p.rx, p.ry), out_closed)


@kernel
def contact_kinematics(model, k, pose, row, out_closed):
    """Fill row `row` with everything about contact `k` at the given poses."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa, pb = pose[a.body], pose[b.body]
    shape = shape_of_contact(contact, a, b, pa, pb)
    gap, nx, ny, Q = shape.gap, shape.nx, shape.ny, shape.Q
    xa, ya = shape.arm_x, shape.arm_y
    tx, ty = -ny, nx
    xb, yb = xa + pa.x - pb.x, ya + pa.y - pb.y
    # Velocity of A's material against B's at the contact point.
    vx, vy = (pa.vx - pa.w * ya) - (pb.vx - pb.w * yb), (pa.vy + pa.w * xa) - (pb.vy + pb.w * xb)
    v_n, v_t = nx * vx + ny * vy, tx * vx + ty * vy
    spin = pa.w - pb.w
    # The normal turns at the rate `turning`; the contact point travels along A's outline at `travel`.
    turning = pb.w + contact.curvature * (v_t + a.radius * spin) / Q
    share = a.radius * contact.curvature
    travel = (spin * (contact.reduced + share * gap) - share * v_t) / Q
    kin = out_closed.kin[row]
    kin.g, kin.gN_dot, kin.gT_dot = gap, v_n, v_t
    # w̄ = d/dt of the rates at constant u: of n' = Ω t, t' = -Ω n, and of the arms of a travelling contact point.
    square_a, square_b = pa.w * pa.w, pb.w * pb.w
    kin.bar_N = (turning + pb.w) * v_t - spin * travel - square_a * (nx * xa + ny * ya) + square_b * (nx * xb + ny * yb)
    kin.bar_T = -(turning + pb.w) * v_n - square_a * (tx * xa + ty * ya) + square_b * (tx * xb + ty * yb)
    reach_a, reach_b = abs(xa) + abs(ya), abs(xb) + abs(yb)
    speed = abs(v_t) + abs(v_n)
    kin.bar_size = (abs(turning) + abs(pb.w)) * speed + abs(spin * travel) + square_a * reach_a + square_b * reach_b
    if reach_a + reach_b > 0.0:
        # Spins are rounded by what the bodies' speeds are: of bodies that travel flush nothing else is left of all terms.
        rounded = SPIN_ROUNDING * (abs(pa.vx) + abs(pa.vy) + abs(pb.vx) + abs(pb.vy))
        kin.bar_size += rounded * rounded / (reach_a + reach_b)
    inside_a, inside_b = margins_of(contact, a, b, pa, pb, shape)
    kin.margin = min(inside_a, inside_b)
    kin.x, kin.y, kin.nx, kin.ny = pa.x + xa, pa.y + ya, nx, ny
    out_closed.ids[row] = k
    out_closed.slots[row] = 0
    _directions(model, a.body, row, 1.0, (nx, ny, xa, ya), out_closed)
    _directions(model, b.body, row, -1.0, (nx, ny, xb, yb), out_closed)
    if model.bodies[a.body].carrier >= 0 or model.bodies[b.body].carrier >= 0:
        _add_carriers(model, a.body, b.body, row, (nx, ny), pose, out_closed)


@kernel
def gap_acceleration(closed, i, a):
    """g_N'' of row i of `closed` under the accelerations a of the coordinates: w_N·a + w̄_N."""
    total = closed.kin[i].bar_N
    for k in range(closed.slots[i]):
        total += closed.w_N[i, k] * a[closed.coord[i, k]]
    return total


@entry
def every_contact(model, q, u, pose, out_closed):
    """Kinematics of all contacts, row by row."""
    place(model, q, u, pose)
    for k in range(len(model.contacts)):
        contact_kinematics(model, k, pose, k, out_closed)
