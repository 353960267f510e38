"""How is a cam drawn as arcs or chords, and how far is its motion from that of the curve?"""

import math
from dataclasses import dataclass

import numpy as np
from gear_scenes import through
from reference.flat_cam import Curve, FlatCam, end_state, point

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate

DURATION = 0.25  # s: about a turn
PHASE = 0.1234  # rad: no joint at a symmetric place


def drawn(curve: Curve, count: int, chords: bool) -> Loop:
    """The curve as `count` arcs through three points each, or as chords."""
    points = [np.array(point(curve, PHASE + math.pi * i / count)) for i in range(2 * count)]
    points.append(points[0])
    if chords:
        return Loop(tuple(Line(*points[i].tolist(), *points[i + 2].tolist()) for i in range(0, 2 * count, 2)))
    return Loop(tuple(through(*points[i : i + 3]) for i in range(0, 2 * count, 2)))


def top(loop: Loop, angle: float) -> float:
    """The height of the outline turned by `angle`: where a flat face comes to stand."""
    best = -math.inf
    for edge in loop.edges:
        for x, y in (edge.start, edge.end):
            best = max(best, x * math.sin(angle) + y * math.cos(angle))
        if not isinstance(edge, Line):
            up = (0.5 * math.pi - angle - edge.start_angle) % (2.0 * math.pi)
            if up < edge.sweep:
                best = max(best, edge.x * math.sin(angle) + edge.y * math.cos(angle) + edge.radius)
    return best


def cam_scene(cam: FlatCam, count: int, chords: bool, restitution: float) -> Scene:
    """The cam turns under the flat face."""
    outline = drawn(cam.curve, count, chords)
    height, step = top(outline, cam.angle), 1e-7
    lift = (top(outline, cam.angle + step) - top(outline, cam.angle - step)) / (2.0 * step)
    w, h = 4e-3, 1e-3
    face = ((-w, 0.0), (w, 0.0), (w, h), (-w, h))
    box = Loop(tuple(Line(*a, *b) for a, b in zip(face, face[1:] + face[:1], strict=True)))
    bodies = (
        Body("cam", angle=cam.angle, velocity=(cam.speed,), inertia=cam.inertia, loops=(outline,)),
        Body("face", "slide", (0.0, height), axis=(0.0, 1.0), velocity=(lift * cam.speed,), mass=cam.mass, loops=(box,)),
    )
    return Scene(
        "cam",
        bodies,
        springs=(Spring("face", cam.stiffness, cam.rest - height),),
        torques=(Torque("cam", cam.torque),),
        contacts=(Contact((Side("face"), Side("cam")), 0.0, restitution),),
        duration=DURATION,
    )


@dataclass(frozen=True)
class Compared:
    """Errors of the cam's angle (rad) and speed (over itself) at the end; what it took."""

    angle: float
    speed: float
    passed: int  # edges of the outline passed
    events: int
    evaluations: int
    stop: str
    residual: float


def compared(cam: FlatCam, count: int, chords: bool, restitution: float = 0.0, tolerance: float = 1e-9) -> Compared:
    run = simulate(cam_scene(cam, count, chords, restitution), tolerance=tolerance)
    angle, speed = end_state(cam, DURATION)
    passed = max(1, round(count * float(run.end_q[0] - cam.angle) / (2.0 * math.pi)))
    found = abs(float(run.end_q[0]) - angle), abs(float(run.end_u[0]) / speed - 1.0)
    residual = float(run.energy["residual_relative"])
    return Compared(*found, passed, run.counts["events"], run.counts["gap_evaluations"], run.stop.name, residual)
