"""How open is a contact, and how fast does it close?

Every pair is a circle (a convex arc, or a corner: radius 0) on body A against a line or an arc on body B. One gap function
serves all of them: both sides are given by a point on the outline and the normal there, and A's radius is added to B's curve,
which leaves a point against one curve of curvature K (docs/theory/method.md 2.2). No centre enters, so nothing is lost where
arcs are so flat that their centres lie far away. A gap is defined for the whole infinite line or full circle; whether the
contact lies inside both primitives is a question of its own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from watchsim.contact.poses import point_of
from watchsim.jit import hot_kernel, kernel
from watchsim.model.records import FULL, LINE


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
