"""Which small scenes have motions that are known in advance?"""

import dataclasses
import functools
import math
from pathlib import Path

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point
from watchsim.scene.forces import Contact, Side
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

PROFILES = Path(__file__).resolve().parents[2] / "profiles"


@functools.cache
def profile(name: str, file: str = "scene.toml") -> Scene:
    """A scene of the profiles folder."""
    return load(PROFILES / name / file)


def polygon(*points: Point) -> Loop:
    """A closed outline; counter-clockwise points bound material."""
    return Loop(tuple(Line(*a, *b) for a, b in zip(points, points[1:] + points[:1], strict=True)))


def box(width: float, height: float, centre: Point = (0.0, 0.0)) -> Loop:
    (x, y), w, h = centre, 0.5 * width, 0.5 * height
    return polygon((x - w, y - h), (x + w, y - h), (x + w, y + h), (x - w, y + h))


def circle(radius: float, centre: Point = (0.0, 0.0)) -> Loop:
    return Loop((Arc(*centre, radius, 0.0, 2.0 * math.pi),))


def bowl(radius: float) -> Loop:
    """A round hole: material all around."""
    return Loop((Arc(0.0, 0.0, radius, 0.0, -2.0 * math.pi),), hole=True)


def ground(length: float = 50.0) -> Body:
    """A fixed plane along x with material below."""
    return Body("ground", "fixed", loops=(Loop((Line(length, 0.0, -length, 0.0),), closed=False),))


def tip(radius: float) -> Loop:
    """A thorn whose corner points along +x at `radius` from the origin."""
    return polygon((radius, 0.0), (0.7 * radius, 0.1 * radius), (0.7 * radius, -0.1 * radius))


def touching(*names: str, friction: float = 0.0, restitution: float = 0.0) -> tuple[Contact, ...]:
    """One contact between two bodies."""
    first, last = names
    return (Contact((Side(first), Side(last)), friction, restitution),)


def on_slope(angle: float, gravity: float = 9.81) -> Point:
    """Gravity as seen from a plane that falls towards +x by `angle`."""
    return gravity * math.sin(angle), -gravity * math.cos(angle)


def of_kind(run: Trajectory, *kinds: EventKind):
    """The events of these kinds."""
    return [event for event in run.events if event["kind"] in kinds]


def turned(scene: Scene, angle: float) -> Scene:
    """The whole world turned about its origin: every pivot's angle grows by `angle`, with the rests of springs and tables."""
    c, s = math.cos(angle), math.sin(angle)

    def turn(point: Point) -> Point:
        return c * point[0] - s * point[1], s * point[0] + c * point[1]

    bodies = []
    for body in scene.bodies:
        velocity = body.velocity
        if body.motion == "free" and velocity:
            velocity = (*turn((velocity[0], velocity[1])), velocity[2])
        more = {"position": turn(body.position), "angle": body.angle + angle, "velocity": velocity, "axis": turn(body.axis)}
        bodies.append(dataclasses.replace(body, **more))
    springs = tuple(
        dataclasses.replace(spring, rest=spring.rest + (angle if scene.body(spring.body).motion == "pivot" else 0.0))
        for spring in scene.springs
    )
    return dataclasses.replace(scene, bodies=tuple(bodies), springs=springs, gravity=turn(scene.gravity))


def _mirrored_edge(edge: Edge) -> Edge:
    if isinstance(edge, Arc):
        return Arc(-edge.x, edge.y, edge.radius, math.pi - edge.start_angle, -edge.sweep)
    return Line(-edge.x0, edge.y0, -edge.x1, edge.y1)


def mirrored(scene: Scene) -> Scene:
    """The scene seen in a mirror on the y axis; only pivoted, free and fixed bodies."""
    bodies = []
    for body in scene.bodies:
        loops = tuple(dataclasses.replace(loop, edges=tuple(map(_mirrored_edge, loop.edges))).reversed() for loop in body.loops)
        signs = (-1.0, 1.0, -1.0) if body.motion == "free" else (-1.0,)
        velocity = tuple(v * sign for v, sign in zip(body.velocity, signs, strict=False))
        x, y = body.position
        cx, cy = body.centre_of_mass
        more = {"position": (-x, y), "angle": -body.angle, "velocity": velocity, "loops": loops, "centre_of_mass": (-cx, cy)}
        bodies.append(dataclasses.replace(body, **more))
    springs = tuple(dataclasses.replace(spring, rest=-spring.rest) for spring in scene.springs)
    torques = tuple(dataclasses.replace(torque, value=-torque.value) for torque in scene.torques)
    gravity = (-scene.gravity[0], scene.gravity[1])
    return dataclasses.replace(scene, bodies=tuple(bodies), springs=springs, torques=torques, gravity=gravity)
