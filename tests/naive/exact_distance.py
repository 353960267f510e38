"""How far apart are two edges, and how large is a gap, to fifty digits?

By centres, angles and intersections, as in a textbook, in mpmath's arithmetic. Shares nothing with the package but the data
classes of lines and arcs, whose fields alone it reads.
"""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import mpmath
import numpy as np

from watchsim.geometry.primitives import Arc, Edge, Line

mp = mpmath.mp.clone()
mp.dps = 50
TURN = 2 * mp.pi
Pose = tuple[float, float, float]  # x, y (m), angle (rad)


class Pair(NamedTuple):
    """Two edges at their poses, and the size that errors are measured by, m."""

    name: str
    a: Edge
    pose_a: Pose
    b: Edge
    pose_b: Pose
    size: float


class _Straight(NamedTuple):
    start: Any  # complex numbers of mpmath
    end: Any

    def ends(self) -> tuple[Any, Any]:
        return self.start, self.end

    def nearest(self, p: Any) -> list[Any]:
        way = self.end - self.start
        share = mp.re((p - self.start) * mp.conj(way)) / abs(way) ** 2
        return [self.start + share * way] if 0 <= share <= 1 else []


class _Round(NamedTuple):
    centre: Any
    radius: Any
    first: Any
    sweep: Any

    def ends(self) -> tuple[Any, Any]:
        return self.at(self.first), self.at(self.first + self.sweep)

    def at(self, angle: Any) -> Any:
        return self.centre + self.radius * mp.expj(angle)

    def along(self, direction: Any) -> list[Any]:
        """The point in a direction from the centre, if the arc has it."""
        turned = mp.fmod(mp.arg(direction) - self.first, TURN)
        turned = turned + TURN if turned < 0 else turned
        reached = turned <= self.sweep if self.sweep > 0 else TURN - turned <= -self.sweep or turned == 0
        return [self.centre + self.radius * direction / abs(direction)] if reached else []

    def nearest(self, p: Any) -> list[Any]:
        return self.along(p - self.centre) if p != self.centre else []


def placed(edge: Edge, pose: Pose) -> _Straight | _Round:
    """The edge in the world."""
    shift, turn = mp.mpc(pose[0], pose[1]), mp.mpf(pose[2])
    if isinstance(edge, Line):
        return _Straight(*(shift + mp.mpc(*p) * mp.expj(turn) for p in ((edge.x0, edge.y0), (edge.x1, edge.y1))))
    sweep = mp.mpf(edge.sweep)
    if abs(edge.sweep) >= 2.0 * math.pi * (1.0 - 1e-12):
        sweep = mp.sign(sweep) * TURN
    centre = shift + mp.mpc(edge.x, edge.y) * mp.expj(turn)
    return _Round(centre, mp.mpf(edge.radius), mp.mpf(edge.start_angle) + turn, sweep)


def exact_distance(pair: Pair) -> Any:
    """Of the nearest points of the two edges."""
    a, b = placed(pair.a, pair.pose_a), placed(pair.b, pair.pose_b)
    best = min(abs(p - q) for p in a.ends() for q in b.ends())
    for one, other in ((a, b), (b, a)):
        for p in one.ends():
            best = min([best, *(abs(p - q) for q in other.nearest(p))])
    if isinstance(a, _Round) and isinstance(b, _Round):
        return min([best, *_two_arcs(a, b)])
    if isinstance(a, _Round) or isinstance(b, _Round):
        arc, line = (a, b) if isinstance(a, _Round) else (b, a)
        return min([best, *_arc_and_line(arc, line)])
    return min([best, *_two_lines(a, b)])


def _two_lines(a: Any, b: Any) -> Iterator[Any]:
    u, v, w = a.end - a.start, b.end - b.start, b.start - a.start
    cross = mp.im(mp.conj(u) * v)
    if cross != 0 and 0 <= mp.im(mp.conj(w) * v) / cross <= 1 and 0 <= mp.im(mp.conj(w) * u) / cross <= 1:
        yield mp.mpf(0)


def _arc_and_line(arc: Any, line: Any) -> Iterator[Any]:
    u = (line.end - line.start) / abs(line.end - line.start)
    height = mp.im(mp.conj(u) * (arc.centre - line.start))
    foot = arc.centre - mp.mpc(0, 1) * u * height
    for sign in (1, -1):
        for p in arc.along(sign * mp.mpc(0, 1) * u):
            yield from (abs(p - q) for q in line.nearest(p))
    if abs(height) <= arc.radius:
        half = mp.sqrt(arc.radius**2 - height**2)
        for sign in (1, -1):
            p = foot + sign * half * u
            share = mp.re(mp.conj(u) * (p - line.start))
            if 0 <= share <= abs(line.end - line.start) and arc.along(p - arc.centre):
                yield mp.mpf(0)


def _two_arcs(a: Any, b: Any) -> Iterator[Any]:
    way = b.centre - a.centre
    if way == 0:
        return
    for first in (1, -1):
        for last in (1, -1):
            yield from (abs(p - q) for p in a.along(first * way) for q in b.along(last * way))
    share = (abs(way) ** 2 + a.radius**2 - b.radius**2) / (2 * abs(way))
    if abs(share) <= a.radius:
        half = mp.sqrt(a.radius**2 - share**2)
        for sign in (1, -1):
            p = a.centre + (share + sign * mp.mpc(0, 1) * half) * way / abs(way)
            if a.along(p - a.centre) and b.along(p - b.centre):
                yield mp.mpf(0)


def exact_gap(pair: Pair) -> Any:
    """Of convex arc or corner (the end of line a) against the whole line or circle of b, material on b's left."""
    a, b = placed(pair.a, pair.pose_a), placed(pair.b, pair.pose_b)
    centre, radius = (a.centre, a.radius) if isinstance(a, _Round) else (a.end, mp.mpf(0))
    if isinstance(b, _Straight):
        u = (b.end - b.start) / abs(b.end - b.start)
        return -mp.im(mp.conj(u) * (centre - b.start)) - radius
    return mp.sign(b.sweep) * (abs(centre - b.centre) - b.radius) - radius


def nasty_pairs(rng: np.random.Generator, count: int) -> Iterator[Pair]:
    """Pairs of all kinds in turn: random, flat, tiny, touching, nearly concentric, parallel."""
    makers = (_random, _flat, _tiny, _touching, _nested, _parallel)
    for i in range(count):
        yield makers[i % len(makers)](rng)


def _edge(rng: np.random.Generator, scale: float, flat: float = 0.0) -> Edge:
    """An edge about `scale` long near the origin; the radius of an arc is 10**flat times that."""
    x, y = rng.normal(size=2) * scale
    if rng.random() < 0.4 and not flat:
        dx, dy = rng.normal(size=2) * scale
        return Line(x, y, x + dx, y + dy)
    if not flat:
        radius = scale * math.exp(rng.normal())
        sweep = rng.choice([-1.0, 1.0]) * rng.choice([rng.uniform(0.1, 6.2), 2.0 * math.pi])
        return Arc(x, y, radius, rng.uniform(-7.0, 7.0), sweep)
    radius, middle = scale * 10.0**flat, rng.uniform(-math.pi, math.pi)
    sweep = rng.choice([-1.0, 1.0]) * rng.uniform(0.2, 2.0) * scale / radius
    return Arc(x - radius * math.cos(middle), y - radius * math.sin(middle), radius, middle - 0.5 * sweep, sweep)


def _pose(rng: np.random.Generator, scale: float) -> Pose:
    return (*(rng.normal(size=2) * scale), rng.uniform(-10.0, 10.0))


def _reach(edge: Edge, pose: Pose) -> float:
    """Largest coordinate of an edge, of its own frame and of the world."""
    x, y = edge.start
    length = edge.length if isinstance(edge, Line) else min(edge.length, 4.0 * edge.radius)
    return math.hypot(x, y) + length + math.hypot(pose[0], pose[1])


def _sized(name: str, a: Edge, pose_a: Pose, b: Edge, pose_b: Pose) -> Pair:
    return Pair(name, a, pose_a, b, pose_b, max(_reach(a, pose_a), _reach(b, pose_b)))


def _random(rng: np.random.Generator) -> Pair:
    return _sized("random", _edge(rng, 1.0), _pose(rng, 1.0), _edge(rng, 1.0), _pose(rng, 1.0))


def _flat(rng: np.random.Generator) -> Pair:
    """Radii of up to a million lengths on one or both sides."""
    flats = (rng.uniform(0.5, 6.0), rng.choice([0.0, rng.uniform(0.5, 6.0)]))
    a, b = (_edge(rng, 1.0, flat) for flat in rng.permutation(flats))
    return _sized("flat", a, _pose(rng, 1.0), b, _pose(rng, 1.0))


def _tiny(rng: np.random.Generator) -> Pair:
    """An edge of a nanometre to a micrometre, in a scene of a metre, near the other one."""
    return _sized("tiny", _edge(rng, 10.0 ** rng.uniform(-9, -6)), _pose(rng, 0.1), _edge(rng, 1.0), _pose(rng, 1.0))


def _touching(rng: np.random.Generator) -> Pair:
    """A point of one on a point of the other along the same tangent, but for up to a nanometre."""
    a, b = _edge(rng, 1.0, rng.choice([0.0, 3.0])), _edge(rng, 1.0, rng.choice([0.0, 2.0]))
    pose_b = _pose(rng, 1.0)
    share_a, share_b = rng.random(2)
    facing = math.atan2(*b.tangent(share_b)[::-1]) + pose_b[2] - math.atan2(*a.tangent(share_a)[::-1])
    angle = facing + rng.choice([0.0, math.pi]) + rng.choice([0.0, 1e-12, 1e-6])
    (x, y), (c, s) = b.point(share_b), (math.cos(pose_b[2]), math.sin(pose_b[2]))
    at = (c * x - s * y + pose_b[0], s * x + c * y + pose_b[1])
    (x, y), (c, s) = a.point(share_a), (math.cos(angle), math.sin(angle))
    off = rng.normal(size=2) * rng.choice([0.0, 1e-15, 1e-12, 1e-9])
    return _sized("touching", a, (at[0] - c * x + s * y + off[0], at[1] - s * x - c * y + off[1], angle), b, pose_b)


def _nested(rng: np.random.Generator) -> Pair:
    """Arcs of nearly equal radii, nearly or exactly concentric."""
    less, off = 10.0 ** rng.uniform(-15, -1), 10.0 ** rng.uniform(-15, -1) * rng.choice([0.0, 1.0, 1.0])
    inner = Arc(0.0, 0.0, 1.0 - less, rng.uniform(-7, 7), rng.uniform(0.1, 6.2))
    outer = Arc(0.0, 0.0, 1.0, rng.uniform(-7, 7), rng.choice([rng.uniform(0.1, 6.2), 2.0 * math.pi]) * rng.choice([-1, 1]))
    towards = rng.uniform(0.0, 7.0)
    pose = (off * math.cos(towards), off * math.sin(towards), rng.uniform(-10, 10))
    return _sized("nested", inner, pose, outer, (0.0, 0.0, rng.uniform(-10, 10)))


def _parallel(rng: np.random.Generator) -> Pair:
    """Flat on flat, or a line along an arc's tangent, turned by next to nothing."""
    height, tilt = rng.choice([0.0, 1e-12, 1e-3, 0.5]), rng.choice([0.0, 1e-15, 1e-9])
    a: Edge = Line(-rng.random(), 0.0, rng.random(), 0.0)
    if rng.random() < 0.5:
        radius = 10.0 ** rng.uniform(-2, 4)
        a = Arc(0.0, radius, radius, -0.5 * math.pi - 0.3 / radius, 0.6 / radius)
    pose = (rng.normal(), height, tilt)
    return _sized("parallel", a, pose, Line(-2.0 * rng.random(), 0.0, 2.0 * rng.random(), 0.0), (0.0, 0.0, 0.0))
