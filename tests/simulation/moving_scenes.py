"""Which small scenes have motions that are known in advance?"""

import dataclasses
import functools
import math
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from numpy.typing import NDArray
from reference.flat_cam import Drive, Piece, start

from watchsim.contact.gaps import Closed, closed_contacts
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point
from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.scratch import Projection, _projection_room
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


# Which cams made of many tangent arcs have a motion that is known?

DRIVE = Drive(inertia=2e-8, torque=1e-8, roller=0.4e-3, mass=1e-5, stiffness=2.0, rest=-2e-3)
RATE = 25.0
ECCENTRIC = (Piece(0.2e-3, 0.05e-3, 1.1e-3, 0.0, 2.0 * math.pi),)


def cam_outline(pieces: Sequence[Piece], cuts: int) -> Loop:
    """Each piece cut into `cuts` tangent arcs."""
    edges = []
    for piece in pieces:
        step = (piece.last - piece.first) / cuts
        edges += [Arc(piece.x, piece.y, piece.radius, piece.first + i * step, step) for i in range(cuts)]
    return Loop(tuple(edges))


def cam_scene(pieces: Sequence[Piece], cuts: int, duration: float, friction: float = 0.0, angle: float = 0.3) -> Scene:
    """The cam turns from `angle` at RATE; the roller stands on it."""
    height, speed = start(tuple(pieces), DRIVE, angle, RATE)
    roller = Loop((Arc(0.0, 0.0, DRIVE.roller, 0.0, 2.0 * math.pi),))
    bodies = (
        Body("cam", "pivot", (0.0, 0.0), angle, velocity=(RATE,), inertia=DRIVE.inertia, loops=(cam_outline(pieces, cuts),)),
        Body("roller", "slide", (0.0, height), axis=(0.0, 1.0), velocity=(speed,), mass=DRIVE.mass, loops=(roller,)),
    )
    return Scene(
        "cam",
        bodies,
        springs=(Spring("roller", DRIVE.stiffness, DRIVE.rest - height),),
        torques=(Torque("cam", DRIVE.torque),),
        contacts=(Contact((Side("roller"), Side("cam")), friction, 0.5),),
        duration=duration,
        tolerance=1e-11,
    )


# Contacts that no drawing has: random force directions, as kernels keep them and as whole matrices.

Array = NDArray[np.float64]


def closed_of(normal: Array, tangential: Array, ids: list[int] | None = None, **kin: list[float]) -> Closed:
    """Contacts with these force directions, (m, n) each; entries in no particular order, none for what both leave alone."""
    m = len(normal)
    closed = closed_contacts(m + 2)
    for i in range(m):
        columns = [j for j in range(normal.shape[1]) if normal[i, j] != 0.0 or tangential[i, j] != 0.0][::-1]
        closed.ids[i], closed.slots[i] = i if ids is None else ids[i], len(columns)
        closed.coord[i, : len(columns)] = columns
        closed.w_N[i, : len(columns)], closed.w_T[i, : len(columns)] = normal[i, columns], tangential[i, columns]
    for name, values in kin.items():
        closed.kin[name][:m] = values
    closed.slots[m:], closed.w_N[m:], closed.kin["g"][m:] = 1, 99.0, -99.0  # of no contact asked about
    return closed


def projection_of(m: int, n: int) -> Projection:
    """Room for so many contacts and no more on n coordinates; whatever was in it before."""
    projection = _projection_room(n, m)
    for array in projection:
        array[...] = 1 if array.dtype.kind == "i" else 77.0
    return projection


def both(normal: Array, tangential: Array) -> Array:
    """(2 m, n): normal and tangential direction of one contact after another."""
    return np.stack([normal, tangential], axis=1).reshape(2 * len(normal), -1)


def named(**values: object) -> SimpleNamespace:
    """A record of made-up fields."""
    return SimpleNamespace(**values)
