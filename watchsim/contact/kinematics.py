"""How do gaps change with motion?

For each closed contact: gap and rates, force directions w_N and w_T, and the bar terms of
g_N'' = w_N·u' + w̄_N and g_T'' = w_T·u' + w̄_T, in closed form (docs/theory/method.md; Pfeiffer & Glocker 1996, ch. 4).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import margins_of, shape_of_contact
from watchsim.contact.poses import place
from watchsim.jit import by_reference, entry, hot_kernel, kernel
from watchsim.model.records import FREE, PIVOT, SLIDE, Records, records
from watchsim.tolerances import SPIN_ROUNDING, TILT_ROUNDING

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
    kin.x, kin.y = pa.x + xa, pa.y + ya
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
