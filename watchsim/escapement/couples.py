"""How far apart are two layers that may touch, and how does that change with the two bodies' coordinates?

By the exact distances of lines and arcs (contact.edges): nothing of the solver's gap functions or candidate cells enters, so
what is seen here says something about a run.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from watchsim.contact.edge_distance import EDGE, edge_records, nearest_edges, point_on
from watchsim.geometry.primitives import Arc, Edge, Point
from watchsim.jit import callable_kernel
from watchsim.model import records
from watchsim.scene.scene import Body, Scene

Pose = tuple[float, float, float, float]  # x, y, cosine and sine of the angle
MARGIN = 1e-4  # m: edges that stay further from the other body than this are left out
HARMLESS = 1e-9  # m: what comes closer counts as overlapping

_point_on = callable_kernel(point_on)


@dataclass(frozen=True, slots=True)
class Near:
    """The nearest points of two layers, and whether their outlines cross; the points are worked out when somebody asks."""

    distance: float
    crossing: bool
    _first: tuple[Any, float, Pose]
    _second: tuple[Any, float, Pose]
    _outward: tuple[float, float]  # of either edge: 1 where its normal points out of the material, else -1
    rows: tuple[int, int] = (-1, -1)

    @property
    def faces(self) -> tuple[int, int]:
        """The numbers of the two edges, -1 where the nearest point is a corner."""
        first, second = (abs(at) < 0.999 * edge.half for edge, at, _ in (self._first, self._second))
        return self.rows[0] if first else -1, self.rows[1] if second else -1

    @property
    def free(self) -> bool:
        return not self.crossing and self.distance > HARMLESS

    @property
    def on_a(self) -> Point:
        """In the movement, m."""
        return _place(*self._first)

    @property
    def on_b(self) -> Point:
        return _place(*self._second)

    @property
    def normal(self) -> Point:
        """Unit vector from b to a; where the points are one, out of the material of an edge that has it between its ends."""
        away = math.dist(self.on_a, self.on_b)
        if away > 0.0 and not self.crossing:
            return (self.on_a[0] - self.on_b[0]) / away, (self.on_a[1] - self.on_b[1]) / away
        of_a = self.faces[1] < 0 <= self.faces[0]
        edge, way, (_, _, c, s) = self._first if of_a else self._second
        out, turn = (-self._outward[0] if of_a else self._outward[1]), edge.curvature * way
        nx, ny = edge.nx * math.cos(turn) - edge.ny * math.sin(turn), edge.ny * math.cos(turn) + edge.nx * math.sin(turn)
        return out * (c * nx - s * ny), out * (s * nx + c * ny)


def _place(edge: Any, way: float, pose: Pose) -> Point:
    """The point of a body's edge at that way from the edge's middle, in the movement."""
    px, py = _point_on(edge, way)
    x, y, c, s = pose
    return float(x + c * px - s * py), float(y + s * px + c * py)


@dataclass(frozen=True, eq=False)
class Couple:
    """Two layers of which a contact is declared; `a` and `b` are numbers of bodies."""

    a: int
    b: int
    layers: tuple[str, str]
    edges: tuple[Any, Any]
    reach: tuple[float, float]  # m: the farthest point of either from its body's origin
    room: tuple[Any, Any]
    outward: tuple[list[float], list[float]]  # of each edge: 1 where its normal points out of the material, else -1

    def near(self, pose_a: Pose, pose_b: Pose) -> Near:
        """The nearest points at those poses."""
        first, second = self.edges
        near = nearest_edges(first, pose_a, second, pose_b, *self.room)
        i, j = int(near.edge_a), int(near.edge_b)
        on_a, on_b = (first[i], near.way_a, pose_a), (second[j], near.way_b, pose_b)
        return Near(float(near.distance), bool(near.crossing), on_a, on_b, (self.outward[0][i], self.outward[1][j]), (i, j))


def pose_of(body: Body, q: float) -> Pose:
    """Where the body's frame stands at coordinate q (rad, or m along its axis); of a fixed one q does not matter."""
    x, y = body.position
    angle = q if body.motion == "pivot" else body.angle
    if body.motion == "slide":
        x, y = x + q * body.axis[0], y + q * body.axis[1]
    return x, y, math.cos(angle), math.sin(angle)


def motion_at(body: Body, place: Point) -> Point:
    """How the body's material at that place (m, in the movement) moves for a unit change of its coordinate."""
    if body.motion == "pivot":
        return (-(place[1] - body.position[1]), place[0] - body.position[0])
    return body.axis if body.motion == "slide" else (0.0, 0.0)


def opening(bodies: tuple[Body, ...], couple: Couple, near: Near, number: int) -> float:
    """How the distance grows with the coordinate of body `number`: m/rad, or 1 for a slide along the normal."""
    nx, ny = near.normal
    if number == couple.a:
        vx, vy = motion_at(bodies[number], near.on_a)
        return nx * vx + ny * vy
    vx, vy = motion_at(bodies[number], near.on_b)
    return -nx * vx - ny * vy


def couples(scene: Scene) -> tuple[Couple, ...]:
    """All declared pairs of layers, without the edges that can never come near the other body."""
    numbers = {body.name: number for number, body in enumerate(scene.bodies)}
    made: dict[tuple[int, str, int, str], Couple] = {}
    for contact in scene.contacts:
        first, second = contact.sides
        a, b = scene.body(first.body), scene.body(second.body)
        for layer_a in a.layers if first.layer is None else (first.layer,):
            for layer_b in b.layers if second.layer is None else (second.layer,):
                edges = _edges(a, layer_a), _edges(b, layer_b)
                kept = _within(a, edges[0], b, edges[1]), _within(b, edges[1], a, edges[0])
                if not (kept[0] and kept[1]):
                    continue
                rows = edge_records(kept[0]), edge_records(kept[1])
                room = records(EDGE, len(rows[0])), records(EDGE, len(rows[1]))
                reach = _span(kept[0])[1], _span(kept[1])[1]
                key = (numbers[a.name], layer_a, numbers[b.name], layer_b)
                outward = _outward(kept[0]), _outward(kept[1])
                made[key] = Couple(numbers[a.name], numbers[b.name], (layer_a, layer_b), rows, reach, room, outward)
    return tuple(made.values())


def _edges(body: Body, layer: str) -> list[Edge]:
    return [edge for loop in body.loops if loop.layer == layer for edge in loop.edges]


def _outward(edges: list[Edge]) -> list[float]:
    """Of each record of these edges: 1 where its normal points to the right, out of the material, -1 for hollow arcs."""
    return [-1.0 if isinstance(edge, Arc) and edge.sweep < 0.0 else 1.0 for edge in edges if edge.length > 0.0]


def _within(own: Body, edges: list[Edge], other: Body, others: list[Edge]) -> list[Edge]:
    """The edges of a turning body that reach the ring in which the other one turns; all where one of the two slides."""
    if not (edges and others) or "slide" in (own.motion, other.motion) or own.motion == "fixed":
        return edges if others else []
    apart = math.dist(own.position, other.position)
    if other.motion == "fixed":
        c, s = math.cos(other.angle), math.sin(other.angle)
        px, py = (p - q for p, q in zip(own.position, other.position, strict=True))
        low, high = _span(others, (c * px + s * py, -s * px + c * py))
    else:
        near, far = _span(others)
        low, high = max(0.0, apart - far, near - apart), apart + far
    kept = []
    for edge in edges:
        inner, outer = _span([edge])
        if inner <= high + MARGIN and outer >= low - MARGIN:
            kept.append(edge)
    return kept


def _span(edges: list[Edge], centre: Point = (0.0, 0.0)) -> tuple[float, float]:
    """Bounds of the distances of points of the edges from `centre`."""
    low, high = math.inf, 0.0
    for edge in edges:
        points = [edge.point(f) for f in np.linspace(0.0, 1.0, 17)]
        away = [math.dist(point, centre) for point in points]
        slack = edge.length / 32.0
        low, high = min(low, max(0.0, min(away) - slack)), max(high, max(away) + slack)
    return low, high
