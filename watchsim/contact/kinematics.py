"""How do gaps change with motion?

For each closed contact: gap and rates, force directions w_N and w_T, and the bar terms of
g_N'' = w_N·u' + w̄_N and g_T'' = w_T·u' + w̄_T, in closed form (docs/method.md; Pfeiffer & Glocker 1996, ch. 4).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import extent_margin
from watchsim.contact.poses import point_of
from watchsim.jit import by_reference, kernel
from watchsim.mechanism.model import FREE, LINE, PIVOT, SLIDE, Records, records

KINEMATICS = np.dtype(
    [
        ("g", "f8"),
        ("gN_dot", "f8"),
        ("gT_dot", "f8"),
        ("bar_N", "f8"),
        ("bar_T", "f8"),
        ("margin", "f8"),  # how far inside its primitives the contact lies, m
        ("x", "f8"),  # contact point in the world
        ("y", "f8"),
    ]
)
SLOTS = 6  # a contact moves at most two free bodies


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
def _directions(model, b, row, sign, frame, out_closed):
    """Append body b's entries of w_N, w_T; frame = (nx, ny, arm_x, arm_y), the arm from the body's origin to the contact."""
    body = model.bodies[b]
    nx, ny, rx, ry = frame
    tx, ty = -ny, nx
    j = out_closed.slots[row]
    if body.motion == SLIDE:
        out_closed.coord[row, j] = body.first
        out_closed.w_N[row, j] = sign * (nx * body.axis_x + ny * body.axis_y)
        out_closed.w_T[row, j] = sign * (tx * body.axis_x + ty * body.axis_y)
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
    if body.motion == FREE or body.motion == PIVOT:
        out_closed.coord[row, j] = turn
        out_closed.w_N[row, j] = sign * (rx * ny - ry * nx)
        out_closed.w_T[row, j] = sign * (rx * ty - ry * tx)
        j += 1
    out_closed.slots[row] = j


@kernel
def contact_kinematics(model, k, pose, row, out_closed):
    """Fill row `row` with everything about contact `k` at the given poses."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    pa, pb = pose[a.body], pose[b.body]
    rax, ray = point_of(pa, a.x, a.y)  # O_A to the circle's centre
    rpx, rpy = point_of(pb, b.x, b.y)  # O_B to B's point
    dx, dy = (pa.x - pb.x) + (rax - rpx), (pa.y - pb.y) + (ray - rpy)
    vcx, vcy = pa.vx - pa.w * ray, pa.vy + pa.w * rax
    vx, vy = vcx - (pb.vx - pb.w * rpy), vcy - (pb.vy + pb.w * rpx)
    if b.kind == LINE:
        nx, ny = point_of(pb, b.ty, -b.tx)
        tx, ty = -ny, nx
        height = nx * dx + ny * dy
        gap = height - a.radius
        turning = pb.w
        gN_dot = nx * vx + ny * vy + pb.w * (tx * dx + ty * dy)
        curve = 2.0 * pb.w * (tx * vx + ty * vy) - pb.w * pb.w * height
    else:
        distance = math.sqrt(dx * dx + dy * dy)
        nx, ny = b.side * dx / distance, b.side * dy / distance
        tx, ty = -ny, nx
        gap = b.side * (distance - b.radius) - a.radius
        along = tx * vx + ty * vy
        turning = b.side * along / distance
        gN_dot = nx * vx + ny * vy
        curve = b.side * along * along / distance
    bar = -pa.w * pa.w * (nx * rax + ny * ray) + pb.w * pb.w * (nx * rpx + ny * rpy)
    kin = out_closed.kin[row]
    kin.g, kin.gN_dot, kin.bar_N = gap, gN_dot, bar + curve
    cx, cy = rax - a.radius * nx, ray - a.radius * ny  # O_A to the contact point
    bx, by = cx + pa.x - pb.x, cy + pa.y - pb.y  # O_B to it
    ux, uy = vcx - pb.vx, vcy - pb.vy  # velocity of the centre relative to O_B
    kin.gT_dot = tx * ux + ty * uy - pa.w * a.radius - pb.w * (nx * bx + ny * by)
    # w̄_T = d/dt of g_T_dot at constant u, with n' = Ω t, t' = -Ω n and x' = v - r_A Ω t, where n·t = 0.
    v_n = nx * ux + ny * uy
    kin.bar_T = -pa.w * pa.w * (tx * rax + ty * ray) - turning * v_n - pb.w * (turning * (tx * bx + ty * by) + v_n)
    kin.margin = extent_margin(model, k, pose, nx, ny)
    kin.x, kin.y = pa.x + cx, pa.y + cy
    out_closed.ids[row] = k
    out_closed.slots[row] = 0
    _directions(model, a.body, row, 1.0, (nx, ny, cx, cy), out_closed)
    _directions(model, b.body, row, -1.0, (nx, ny, bx, by), out_closed)
