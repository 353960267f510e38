"""Of which convex pieces is an outline made?

Engines for games know convex polygons and circles only. Arcs are first replaced by chords that stray by at most a given
deviation; the polygon is cut into triangles by clipping ears, and triangles are joined again while they stay convex
(Hertel and Mehlhorn 1983).
"""

from __future__ import annotations

import importlib
import importlib.util
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Protocol

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point
from watchsim.scene.scene import Body, Scene

MODULES = {"pymunk": "pymunk", "box2d": "Box2D", "mujoco": "mujoco"}
HEAVY = 1e12  # kg: a pivoted body of this mass stays on its pivot without a joint; only its inertia matters


@dataclass(frozen=True, slots=True)
class Setup:
    """How an engine is set up for a scene: its best known way.

    units       length units per metre: engines have lengths of their own built in
    deviation   m, of chords from arcs
    iterations  of the contact solver: velocities, positions
    slop        m of penetration that is left alone, where the engine lets one choose
    ring        duration of a contact in steps, where contacts are springs
    """

    units: float
    deviation: float = 1e-7
    iterations: tuple[int, int] = (20, 10)
    slop: float = 1e-9
    ring: float = 3.2


class World(Protocol):
    """A scene in another engine, at its start."""

    def advance(self, steps: int) -> None:
        """Take that many steps."""

    def place(self, body: str) -> tuple[float, float, float]:
        """x, y (m) and angle (rad, not wrapped) of a body that moves."""


def is_installed(method: str) -> bool:
    """True if the engine can be imported."""
    return importlib.util.find_spec(MODULES[method]) is not None


def version_of(method: str) -> str:
    """The engine's version, as its package says."""
    from importlib.metadata import version

    return version(MODULES[method])


def build(method: str, scene: Scene, step: float, setup: Setup) -> World:
    """The scene in the engine `method`, to be advanced in steps of `step` seconds."""
    maker: Any = importlib.import_module(f"watchsim.bench.engines.{method}_world")
    world: World = maker.build(scene, step, setup)
    return world


Polygon = tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Circle:
    """A full disc, metres."""

    centre: Point
    radius: float


Piece = Circle | Polygon


def convex_pieces(loop: Loop, deviation: float, corners: int = 8) -> list[Piece]:
    """Convex pieces (counter-clockwise, at most `corners` corners, metres) that fill a closed outer outline.

    An open chain of one line is the edge of a half-plane: a box as deep as a twentieth of its length lies behind it.
    ValueError for a hole or another open chain.
    """
    if loop.hole:
        raise ValueError(f'the hole on layer "{loop.layer}" cannot be filled with convex pieces')
    if not loop.closed:
        return [_half_plane(loop)]
    arcs = [edge for edge in loop.edges if isinstance(edge, Arc)]
    if len(arcs) == len(loop.edges) and len({(arc.x, arc.y, arc.radius) for arc in arcs}) == 1:
        return [Circle((arcs[0].x, arcs[0].y), arcs[0].radius)]
    points = [point for edge in loop.edges for point in _chords(edge, deviation)]
    return list(_joined(points, _ears(points), corners))


def _half_plane(loop: Loop) -> Polygon:
    if len(loop.edges) != 1 or not isinstance(loop.edges[0], Line):
        raise ValueError(f'the open chain on layer "{loop.layer}" bounds no material that convex pieces could fill')
    line = loop.edges[0]
    depth = 0.05 * line.length
    dx, dy = line.tangent(0.0)
    behind = [(x - depth * dy, y + depth * dx) for x, y in (line.end, line.start)]
    return (line.start, line.end, *behind)


def _chords(edge: Edge, deviation: float) -> list[Point]:
    """Start points of the chords that replace an edge."""
    if isinstance(edge, Line):
        return [edge.start]
    widest = 2.0 * math.acos(max(0.0, 1.0 - deviation / edge.radius))
    count = max(1, math.ceil(abs(edge.sweep) / widest))
    return [edge.point(k / count) for k in range(count)]


def _turn(a: Point, b: Point, c: Point) -> float:
    """Twice the area of a, b, c; positive counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _ears(points: list[Point]) -> list[list[int]]:
    """Triangles (indices) that fill the counter-clockwise polygon."""
    left, triangles = list(range(len(points))), []
    while len(left) > 3:
        ear = next((k for k in range(len(left)) if _is_ear(points, left, k)), None)
        if ear is None:
            raise ValueError("the outline crosses itself: it cannot be cut into triangles")
        a, b, c = left[ear - 1], left[ear], left[(ear + 1) % len(left)]
        if _turn(points[a], points[b], points[c]) > 0.0:
            triangles.append([a, b, c])
        del left[ear]
    return [*triangles, left]


def _is_ear(points: list[Point], left: list[int], k: int) -> bool:
    """True if the corner left[k] can be cut off, no other corner lying in its triangle."""
    a, b, c = (points[left[(k + j) % len(left)]] for j in (-1, 0, 1))
    if _turn(a, b, c) < 0.0:
        return False
    return not any(
        _turn(a, b, p) >= 0.0 and _turn(b, c, p) >= 0.0 and _turn(c, a, p) >= 0.0
        for p in (points[i] for i in left)
        if p not in (a, b, c)
    )


def _joined(points: list[Point], triangles: list[list[int]], corners: int) -> list[Polygon]:
    """Join pieces over shared edges while the result is convex and has few enough corners."""
    pieces = list(triangles)
    while (pair := _joinable(points, pieces, corners)) is not None:
        first, second, whole = pair
        pieces = [piece for k, piece in enumerate(pieces) if k not in (first, second)] + [whole]
    return [tuple(points[i] for i in piece) for piece in pieces]


def _joinable(points: list[Point], pieces: list[list[int]], corners: int) -> tuple[int, int, list[int]] | None:
    sides = {(piece[k - 1], piece[k]): number for number, piece in enumerate(pieces) for k in range(len(piece))}
    for (a, b), first in sides.items():
        second = sides.get((b, a))
        if second is None or second <= first:
            continue
        one, other = pieces[first], pieces[second]
        i, j = one.index(b), other.index(a)
        whole = [*one[i:], *one[:i], *(other[j:] + other[:j])[1:-1]]
        if len(whole) <= corners and _is_convex([points[k] for k in whole]):
            return first, second, whole
    return None


def _is_convex(points: list[Point]) -> bool:
    return all(_turn(points[k - 2], points[k - 1], points[k]) > 0.0 for k in range(len(points)))


# Only what they all can do: bodies that turn, are free or fixed, one set of contact parameters for each outline, constant
# torques, linear springs and dampers. Anything else is refused rather than left out in silence.

MOTIONS = ("pivot", "free", "fixed")


@dataclass(frozen=True, slots=True)
class Surface:
    """One convex piece of a body's outline, in its frame, m. Two meet where one's `own` bit is in the other's `meets`."""

    body: str
    piece: Piece
    own: int
    meets: int
    friction: float
    restitution: float


@dataclass(frozen=True, slots=True)
class Drive:
    """torque - stiffness (q - rest) - viscous u on a pivoted body, SI."""

    body: str
    torque: float = 0.0
    stiffness: float = 0.0
    rest: float = 0.0
    viscous: float = 0.0


def bodies(scene: Scene) -> tuple[Body, ...]:
    """The bodies; ValueError where one moves in a way other engines do not know here."""
    for body in scene.bodies:
        if body.motion not in MOTIONS:
            raise ValueError(f'body "{body.name}" can {body.motion}: not compared with other engines')
    return scene.bodies


def drives(scene: Scene) -> list[Drive]:
    """The forces on every pivoted body that has any; ValueError for forces other engines do not know here."""
    if any(torque.over != "constant" for torque in scene.torques):
        raise ValueError("a tabled torque: not compared with other engines")
    if any(damping.quadratic or damping.coulomb for damping in scene.damping):
        raise ValueError("damping other than viscous: not compared with other engines")
    found = []
    for body in scene.bodies:
        springs = [spring for spring in scene.springs if spring.body == body.name]
        if len(springs) > 1:
            raise ValueError(f'several springs on "{body.name}": not compared with other engines')
        drive = Drive(
            body.name,
            sum(torque.value for torque in scene.torques if torque.body == body.name),
            springs[0].stiffness if springs else 0.0,
            springs[0].rest if springs else 0.0,
            sum(damping.viscous for damping in scene.damping if damping.body == body.name),
        )
        if drive != Drive(body.name):
            found.append(drive)
    return found


def surfaces(scene: Scene, deviation: float) -> list[Surface]:
    """The convex pieces of all outlines that can touch; arcs become chords that stray by at most `deviation` metres."""
    return list(_surfaces(scene, deviation))


def _surfaces(scene: Scene, deviation: float) -> Iterator[Surface]:
    for body in scene.bodies:
        for loop in body.loops:
            own, meets, laws = 0, 0, set()
            for number, contact in enumerate(scene.contacts):
                for k, side in enumerate(contact.sides):
                    if side.body == body.name and side.layer in (None, loop.layer):
                        own |= 1 << (2 * number + k)
                        meets |= 1 << (2 * number + 1 - k)
                        laws.add((contact.friction, contact.restitution))
            if not own or loop.hole:
                continue
            if len(laws) > 1:
                raise ValueError(f'"{body.name}.{loop.layer}" has different contact laws: not compared with other engines')
            friction, restitution = laws.pop()
            for piece in convex_pieces(loop, deviation):
                yield Surface(body.name, piece, own, meets, friction, restitution)
