"""Where is every body now, and how fast does it move?"""

from __future__ import annotations

import math

import numpy as np

from watchsim.jit import hot_kernel, kernel
from watchsim.model.records import FIXED, PIVOT, SLIDE, records

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
