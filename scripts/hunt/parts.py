"""How is a random scene put together from outlines, and which numbers does it get?"""

import math
from collections.abc import Callable, Sequence
from itertools import combinations, pairwise, product
from typing import TypeVar

import numpy as np
import shapely
from numpy.typing import NDArray

from watchsim.geometry.loops import Loop, polyline
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.geometry.solids import mass_properties
from watchsim.mechanism.overlap import overlaps
from watchsim.scene.forces import Contact, Damping, Side, Spring, Torque
from watchsim.scene.scene import Body, Scene

T = TypeVar("T")


class Dice:
    """A seeded source: number `k` of seed `s` is the same mechanism on every machine."""

    def __init__(self, seed: int, number: int) -> None:
        self._rng = np.random.default_rng([seed, number])

    def uniform(self, low: float, high: float) -> float:
        """Evenly between both, four significant digits."""
        return float(f"{self._rng.uniform(low, high):.4g}")

    def log(self, low: float, high: float) -> float:
        """Evenly in the logarithm, four significant digits."""
        return float(f"{10.0 ** self._rng.uniform(np.log10(low), np.log10(high)):.4g}")

    def chance(self, share: float) -> bool:
        return bool(self._rng.random() < share)

    def sign(self) -> float:
        return 1.0 if self.chance(0.5) else -1.0

    def number(self, low: int, high: int) -> int:
        """A whole number, both ends included."""
        return int(self._rng.integers(low, high + 1))

    def pick(self, choices: Sequence[T]) -> T:
        return choices[int(self._rng.integers(len(choices)))]

    def friction(self) -> float:
        return 0.0 if self.chance(0.3) else 1.0 if self.chance(0.05) else self.uniform(0.01, 1.0)

    def restitution(self) -> float:
        return 0.0 if self.chance(0.4) else 1.0 if self.chance(0.1) else self.uniform(0.01, 0.99)

    def kink(self, largest: float = 1.5) -> float:
        """An angle between two edges, rad: from rounding to a right angle, either way."""
        return self.sign() * self.log(1e-10, largest)


MM = 1e-3
GRAVITY = (0.0, -9.81)


def fixed(name: str, *loops: Loop, position: Point = (0.0, 0.0), angle: float = 0.0) -> Body:
    return Body(name, "fixed", position, angle, loops=loops)


def pivoted(
    name: str, loop: Loop, position: Point, angle: float = 0.0, spin: float = 0.0, mass: float = 0.0, inertia: float = 0.0
) -> Body:
    """A plate of that `mass`, or poised with that `inertia`."""
    centre = (0.0, 0.0)
    if not inertia:
        found = mass_properties([loop], 1.0, 1.0)
        inertia, centre = found.inertia * mass / found.mass, found.centre
    return Body(name, "pivot", position, angle, (spin,), mass=mass, inertia=inertia, centre_of_mass=centre, loops=(loop,))


def sliding(name: str, loop: Loop, position: Point, direction: float, speed: float, mass: float, angle: float = 0.0) -> Body:
    """Slides along the angle `direction` (rad)."""
    axis = (math.cos(direction), math.sin(direction))
    axis = tuple(0.0 if abs(c) < 1e-15 else c for c in axis)  # type: ignore[assignment]
    return Body(name, "slide", position, angle, (speed,), axis, mass=mass, loops=(loop,))


def free(
    name: str,
    loop: Loop,
    position: Point,
    mass: float,
    angle: float = 0.0,
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Body:
    """A plate whose outline stands where it would with its origin at `position`."""
    found = mass_properties([loop], 1.0, 1.0)
    cx, cy = found.centre
    if math.hypot(cx, cy) < 1e-15:
        cx = cy = 0.0
    c, s = math.cos(angle), math.sin(angle)
    place = (position[0] + c * cx - s * cy, position[1] + s * cx + c * cy)
    inertia = found.inertia_about((cx, cy)) * mass / found.mass
    return Body(name, "free", place, angle, velocity, mass=mass, inertia=inertia, loops=(loop.moved(0.0, (-cx, -cy)),))


def scene(
    dice: Dice,
    title: str,
    bodies: list[Body],
    duration: float,
    *,
    gravity: bool = False,
    torques: tuple[Torque, ...] = (),
    springs: tuple[Spring, ...] = (),
    damping: tuple[Damping, ...] = (),
    law: tuple[float, float] | None = None,
) -> Scene:
    """All pairs of bodies can touch; `law` is (friction, restitution) of all contacts, else drawn, for all or for each."""
    shared = law or ((dice.friction(), dice.restitution()) if dice.chance(0.6) else None)
    contacts = []
    for a, b in combinations(bodies, 2):
        if a.motion == b.motion == "fixed":
            continue
        friction, restitution = shared or (dice.friction(), dice.restitution())
        contacts.append(Contact((Side(a.name), Side(b.name)), friction, restitution))
    return Scene(
        title, tuple(bodies), springs, torques, damping, tuple(contacts), GRAVITY if gravity else (0.0, 0.0), duration=duration
    )


# How deep does material stand inside material? By shapely on the true outlines, without any gap function.

DEVIATION = 1e-6  # of the scene's size: of the polylines for arcs
Poses = dict[str, tuple[float, float, float]]


class Material:
    """The outlines of a scene's bodies as polygons, each in its own frame. All loops must be outer outlines."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.size = reach(scene)
        self._points = {body.name: [polyline(loop, DEVIATION * self.size) for loop in body.loops] for body in scene.bodies}
        self._pairs = [(c.sides[0].body, c.sides[1].body) for c in scene.contacts]

    def depth(self, poses: Poses) -> float:
        """The deepest overlap of any two bodies that can touch, m; up to about `DEVIATION` of the size is none."""
        return self._worst(poses)[0]

    def at_start(self) -> tuple[float, float]:
        """The deepest overlap and the smallest distance at the start, m."""
        return self._worst({body.name: start_pose(body) for body in self.scene.bodies}, distances=True)

    def _worst(self, poses: Poses, distances: bool = False) -> tuple[float, float]:
        placed = {name: [shapely.Polygon(_placed(p, poses[name])) for p in loops] for name, loops in self._points.items()}
        deepest, nearest = 0.0, np.inf
        for first, second in self._pairs:
            for a, b in product(placed[first], placed[second]):
                if a.intersects(b):
                    deepest = max(deepest, _depth(a, b))
                if distances:
                    nearest = min(nearest, a.distance(b))
        return deepest, float(nearest)


def apart(scene: Scene) -> bool:
    """A coarse look first: the exact one draws arcs within half a nanometre."""
    material = Material(scene)
    depth, nearest = material.at_start()
    if depth > 1e-3 * material.size:
        return False
    return nearest > 1e-3 * material.size or not overlaps(scene)


def reach(scene: Scene) -> float:
    """The largest distance of an outline from its moving body's origin, m."""
    points = [polyline(loop, 1.0) for body in scene.bodies if body.motion != "fixed" for loop in body.loops]
    return max(float(np.hypot(p[:, 0], p[:, 1]).max()) for p in points)


def start_pose(body: Body) -> tuple[float, float, float]:
    return (*body.position, body.angle)


def _placed(points: NDArray[np.float64], pose: tuple[float, float, float]) -> NDArray[np.float64]:
    x, y, angle = pose
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]]) + np.array([x, y])


SLIVER = 16.0  # times area over circumference: more than the depth of any overlap that is not a sliver


def _depth(a: shapely.Polygon, b: shapely.Polygon) -> float:
    """How far the boundary of one reaches into the other; no more than a few times how thick the overlap is on average.

    Flush faces overlap by a sliver of rounding, whose corners shapely may put anywhere along them.
    """
    found = shapely.get_parts(shapely.intersection(a, b))
    inside = shapely.point_on_surface(found)
    # GEOS may take one polygon for what two flush ones have in common.
    common = shapely.union_all(found[(shapely.distance(inside, a) == 0.0) & (shapely.distance(inside, b) == 0.0)])
    if common.area == 0.0:
        return 0.0
    vertices = shapely.points(shapely.get_coordinates(common))
    reach = np.maximum(shapely.distance(vertices, a.boundary), shapely.distance(vertices, b.boundary)).max()
    return float(min(reach, SLIVER * common.area / common.length))


# Which outlines do random mechanisms have?
#
# Lengths in metres. Smooth curves come as CAD programs export them: as so many arcs through three points each, or chords, with
# a small kink at every joint.

Curve = Callable[[float], Point]
STRAIGHT = 1e-9  # sagitta by chord below which three points count as straight


def polygon(points: Sequence[Point]) -> Loop:
    """Counter-clockwise corners."""
    return Loop(tuple(Line(*a, *b) for a, b in zip(points, [*points[1:], points[0]], strict=True)), "polygon")


def circle(radius: float, centre: Point = (0.0, 0.0)) -> Loop:
    return Loop((Arc(*centre, radius, 0.0, TURN),), "circle")


def box(width: float, height: float, centre: Point = (0.0, 0.0)) -> Loop:
    (x, y), w, h = centre, 0.5 * width, 0.5 * height
    return polygon([(x - w, y - h), (x + w, y - h), (x + w, y + h), (x - w, y + h)])


def turned_points(points: Sequence[Point], angle: float) -> list[Point]:
    c, s = math.cos(angle), math.sin(angle)
    return [(c * x - s * y, s * x + c * y) for x, y in points]


def ragged(dice: Dice, radius: float, corners: int) -> Loop:
    """A star-shaped polygon, convex or not."""
    steps = [dice.uniform(0.5, 1.5) for _ in range(corners)]
    angles = np.cumsum(steps) * TURN / sum(steps)
    low = dice.pick((0.5, 0.8, 1.0))
    reach = [radius * (dice.uniform(low, 1.0) if low < 1.0 else 1.0) for _ in range(corners)]
    return polygon([(round(r * math.cos(a), 8), round(r * math.sin(a), 8)) for r, a in zip(reach, angles, strict=True)])


def arc_through(a: Point, b: Point, c: Point) -> Edge:
    """From a through b to c; a line where they are straight."""
    (ax, ay), (bx, by), (cx, cy) = a, b, c
    ux, uy, vx, vy = bx - ax, by - ay, cx - ax, cy - ay
    cross = ux * vy - uy * vx
    if abs(cross) < STRAIGHT * (vx * vx + vy * vy):
        return Line(*a, *c)
    u2, v2 = ux * ux + uy * uy, vx * vx + vy * vy
    x, y = ax + (vy * u2 - uy * v2) / (2.0 * cross), ay + (ux * v2 - vx * u2) / (2.0 * cross)
    start, end = math.atan2(ay - y, ax - x), math.atan2(cy - y, cx - x)
    sweep = (end - start) % TURN if cross > 0.0 else -((start - end) % TURN)
    return Arc(x, y, math.hypot(ax - x, ay - y), start, sweep)


def curve_edges(curve: Curve, count: int, arcs: bool) -> list[Edge]:
    """The curve for parameters from 0 to 1 in so many arcs or chords."""
    if not arcs:
        points = [curve(k / count) for k in range(count + 1)]
        return [Line(*a, *b) for a, b in pairwise(points)]
    points = [curve(0.5 * k / count) for k in range(2 * count + 1)]
    return [arc_through(*points[k : k + 3]) for k in range(0, 2 * count, 2)]


def closed_curve(curve: Curve, count: int, arcs: bool) -> Loop:
    """The same for a curve that closes, counter-clockwise."""
    return Loop(tuple(curve_edges(lambda s: curve(s % 1.0), count, arcs)), "curve")


def joined(*parts: Sequence[Edge], layer: str = "curve") -> Loop:
    """Edges one after another, gaps bridged by lines; closed."""
    edges: list[Edge] = []
    for part in parts:
        for edge in part:
            if edges and math.dist(edges[-1].end, edge.start) > 1e-12:
                edges.append(Line(*edges[-1].end, *edge.start))
            edges.append(edge)
    if math.dist(edges[-1].end, edges[0].start) > 1e-12:
        edges.append(Line(*edges[-1].end, *edges[0].start))
    return Loop(tuple(edges), layer)


def cam_curve(dice: Dice, radius: float) -> Curve:
    """An ellipse, a lobed disc or an eccentric, counter-clockwise."""
    kind, depth, lobes = dice.pick(("ellipse", "lobes", "eccentric")), dice.uniform(0.03, 0.35), dice.number(1, 3)

    def at(s: float) -> Point:
        a = TURN * s
        if kind == "ellipse":
            return radius * math.cos(a), radius * (1.0 - depth) * math.sin(a)
        if kind == "eccentric":
            return radius * (math.cos(a) + depth), radius * math.sin(a)
        r = radius * (1.0 + 0.3 * depth * math.cos(lobes * a))
        return r * math.cos(a), r * math.sin(a)

    return at


def gear(teeth: int, module: float, pieces: int, arcs: bool, play: float) -> Loop:
    """A sector of involute teeth of 25 degrees, each flank in so many pieces; its middle tooth points along +x."""
    pressure = math.radians(25.0)
    pitch = 0.5 * module * teeth
    base, tip, root = pitch * math.cos(pressure), pitch + module, pitch - 1.3 * module
    half = 0.25 * TURN / teeth * (1.0 - play) + math.tan(pressure) - pressure  # of the tooth, at the base circle
    low = max(base, root) * (1.0 + 1e-6)

    def flank(s: float) -> Point:
        r = low + (tip - low) * s
        t = math.sqrt((r / base) ** 2 - 1.0)
        a = -(half - (t - math.atan(t)))
        return r * math.cos(a), r * math.sin(a)

    up = curve_edges(flank, pieces, arcs)
    down = curve_edges(lambda s: (flank(1.0 - s)[0], -flank(1.0 - s)[1]), pieces, arcs)
    foot_angle = math.atan2(flank(0.0)[1], flank(0.0)[0])
    foot = (root * math.cos(foot_angle), root * math.sin(foot_angle))
    tooth = joined([Line(*foot, *up[0].start)], up, down, [Line(*down[-1].end, foot[0], -foot[1])])
    edges = [tooth.moved(k * TURN / teeth, (0.0, 0.0)).edges[:-1] for k in range(-2, 3 if teeth > 9 else 2)]
    return joined(*edges)


def ratchet_wheel(teeth: int, radius: float, depth: float, lean: float) -> Loop:
    """Saw teeth whose steep faces lean from the radius by `lean` rad; they look clockwise."""
    points: list[Point] = []
    for k in range(teeth):
        a = k * TURN / teeth
        low = (radius - depth) * math.cos(a - lean), (radius - depth) * math.sin(a - lean)
        points += [low, (radius * math.cos(a), radius * math.sin(a))]
    return polygon(points)


def slotted_wheel(slots: int, radius: float, width: float, depth: float) -> Loop:
    """A disc with radial slots, between them chords or arcs: a Geneva wheel without its lock."""
    edges: list[Edge] = []
    reach = math.sqrt(radius**2 - 0.25 * width**2)
    half = math.atan2(0.5 * width, reach)
    for k in range(slots):
        a = k * TURN / slots
        slot = turned_points(
            [(reach, -0.5 * width), (radius - depth, -0.5 * width), (radius - depth, 0.5 * width), (reach, 0.5 * width)], a
        )
        edges += [Line(*p, *q) for p, q in pairwise(slot)]
        edges.append(Arc(0.0, 0.0, radius, a + half, TURN / slots - 2.0 * half))
    return joined(edges)


def kinked_bar(dice: Dice, length: float, thick: float) -> Loop:
    """A bar whose top turns by a few kinks, each from 1e-10 rad to a right angle; the kinks lie right of its middle."""
    places = sorted(dice.uniform(-0.15, 0.4) * length for _ in range(dice.number(1, 3)))
    slope, top, last = 0.0, [(-0.5 * length, 0.0)], (-0.5 * length, 0.0)
    for x in [*places, 0.5 * length]:
        last = (x, last[1] + math.tan(slope) * (x - last[0]))
        top.append(last)
        turn = dice.kink(1.2)
        slope = slope + turn if abs(slope + turn) < 1.2 else slope - turn
    floor = min(y for _, y in top) - thick
    return polygon([(-0.5 * length, floor), (0.5 * length, floor), *reversed(top)])


def wavy_bar(dice: Dice, length: float, thick: float) -> Loop:
    """A bar whose top is a wave of many arcs or chords behind a flat start."""
    height, waves, count = dice.uniform(0.002, 0.04) * length, dice.number(1, 3), dice.number(2, 40)
    begin = -0.25 * length

    def top(s: float) -> Point:
        x = 0.5 * length - s * (0.5 * length - begin)
        return x, 0.5 * height * (1.0 - math.cos(TURN * waves * (1.0 - s)))

    edges = curve_edges(top, count, dice.chance(0.6))
    corners = [(begin, 0.0), (-0.5 * length, 0.0), (-0.5 * length, -thick), (0.5 * length, -thick), edges[0].start]
    return joined(edges, [Line(*a, *b) for a, b in pairwise(corners)])
