"""How open is a contact, and how fast does it close?

Every pair is a circle (a convex arc, or a corner: radius 0) on body A against a line or an arc on body B: two gap
functions, centre-line and centre-centre, both between points fixed in their bodies. A gap is defined for the whole
infinite line or full circle; whether the contact lies inside both primitives is a question of its own.
"""

from __future__ import annotations

import math

from watchsim.contact.poses import point_of
from watchsim.jit import kernel
from watchsim.mechanism.model import FULL, LINE, NARROW


@kernel
def normal_gap(model, k, pose):
    """Gap, its rate, and the normal (outward from B's material) of contact `k`: (g, g_dot, nx, ny)."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa, pb = pose[a.body], pose[b.body]
    ax, ay = point_of(pa, a.x, a.y)
    bx, by = point_of(pb, b.x, b.y)
    dx, dy = (pa.x - pb.x) + (ax - bx), (pa.y - pb.y) + (ay - by)
    vx = pa.vx - pb.vx - pa.w * ay + pb.w * by
    vy = pa.vy - pb.vy + pa.w * ax - pb.w * bx
    if b.kind == LINE:
        # Outward normal: the direction of travel turned by -90 degrees.
        nx, ny = point_of(pb, b.ty, -b.tx)
        gap = nx * dx + ny * dy - a.radius
        return gap, nx * vx + ny * vy + pb.w * (nx * dy - ny * dx), nx, ny
    distance = math.sqrt(dx * dx + dy * dy)
    if distance == 0.0:
        return -b.side * b.radius - a.radius, 0.0, 0.0, 0.0
    nx, ny = b.side * dx / distance, b.side * dy / distance
    return b.side * (distance - b.radius) - a.radius, nx * vx + ny * vy, nx, ny


@kernel
def _inside_fan(p, x, y):
    """How far the unit direction (x, y), in the body's frame, lies inside the fan of normals e0..e1; sine of the angle."""
    if p.extent == FULL:
        return 1.0
    first = p.e0x * y - p.e0y * x
    last = x * p.e1y - y * p.e1x
    if p.extent == NARROW:
        # Opposite the fan of a shallow arc both sines are small: say clearly "outside" there.
        if (p.e0x + p.e1x) * x + (p.e0y + p.e1y) * y < 0.0 and (p.e0x * p.e1x + p.e0y * p.e1y) > -0.5:
            return -1.0
        return min(first, last)
    return max(first, last)


@kernel
def extent_margin(model, k, pose, nx, ny):
    """How far inside both primitives the contact lies, metres; negative outside. (nx, ny) is the contact's normal."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa, pb = pose[a.body], pose[b.body]
    # The contact lies on A in the direction -n from the circle's centre.
    margin = _inside_fan(a, -(pa.c * nx + pa.s * ny), -(-pa.s * nx + pa.c * ny)) * max(a.radius, a.length)
    if b.kind == LINE:
        ax, ay = point_of(pa, a.x, a.y)
        dx, dy = pa.x + ax - pb.x, pa.y + ay - pb.y
        x, y = pb.c * dx + pb.s * dy - b.x, -pb.s * dx + pb.c * dy - b.y
        foot = b.tx * x + b.ty * y
        return min(margin, foot, b.length - foot)
    side = b.side
    x, y = side * (pb.c * nx + pb.s * ny), side * (-pb.s * nx + pb.c * ny)
    return min(margin, _inside_fan(b, x, y) * b.radius)
