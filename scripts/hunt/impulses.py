"""Which jumps of velocity can contacts make?

Where outlines touch, found here from their edges alone, an impulse pushes along the normal, with friction up to μ times as
much across. A jump of velocities outside the cone that all such impulses span is no impact, whatever the law.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from hunt.generator.material import reach
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point, moved
from watchsim.scene.scene import Body, Scene

Array = NDArray[np.float64]

LEANING = 1e-3  # rad: a face that leans less against a normal is flush with it
STRAY = 1e-3  # share of a jump: the directions of two faces that pass for one differ by their turn, with levers of all lengths


class Touches:
    """The contacts of a scene at given coordinates: where outlines come as `near` as that share of the size."""

    def __init__(self, scene: Scene, slices: Mapping[str, slice], masses: Array, near: float) -> None:
        self._scene, self._slices, self._root = scene, slices, np.sqrt(masses)
        self._near = near * reach(scene)

    def unexplained(self, q: Array, jump: Array) -> tuple[float, int]:
        """The share of a jump (m/s, rad/s) that no pushing impulses explain, and the number of touching points."""
        columns = []
        rows = list(self.rows(q))
        for friction, normal, tangent in rows:
            columns += [normal + mu * tangent for mu in {friction, -friction}]
        return self._left(columns, jump), len(rows)

    def turn(self, q: Array, before: Array, jump: Array) -> float:
        """By what angle (rad) a face must turn where a body slides on to it, to make this jump by the force on it.

        A face taken for a smooth continuation also pulls. Infinity where neither push nor pull at one place makes the jump.
        """
        smallest, slip = math.inf, 0.0
        for _, normal, tangent in self.rows(q):
            slip = max(slip, float(abs(tangent @ before)))
            if self._left([normal, -normal], jump) <= STRAY:
                smallest = min(smallest, float(abs(normal @ jump)))
        return smallest / slip if slip > 0.0 else math.inf

    def rows(self, q: Array, apart: bool = False) -> Iterator[tuple[float, Array, Array]]:
        """Friction, and the generalised directions along normal and tangent, (n,) each, of each place where bodies touch.

        Where corners meet, edges that cannot be touched there have normals, too; `apart`: only those that part the bodies.
        """
        placed = {body.name: self._placed(body, q) for body in self._scene.bodies}
        for contact in self._scene.contacts:
            a, b = (self._scene.body(side.body) for side in contact.sides)
            for at, (nx, ny) in touching(placed[a.name], placed[b.name], self._near):
                sides = ((placed[a.name], (nx, ny)), (placed[b.name], (-nx, -ny)))
                if apart and not all(_beyond(edges, at, outward, self._near) for edges, outward in sides):
                    continue
                normal, tangent = (self._column(a, q, at, e) - self._column(b, q, at, e) for e in ((nx, ny), (-ny, nx)))
                yield contact.friction, normal, tangent

    def _left(self, columns: list[Array], jump: Array) -> float:
        """The share of a jump that no sum of these impulses with factors of at least zero makes."""
        wanted = self._root * jump
        length = float(np.linalg.norm(wanted))
        if not columns or length == 0.0:
            return float(length > 0.0)
        matrix = np.array(columns).T / self._root[:, None]
        scales = np.linalg.norm(matrix, axis=0)
        matrix = matrix[:, scales > 0.0] / scales[scales > 0.0]
        if not matrix.shape[1]:
            return 1.0
        return float(nnls(matrix, wanted / length, maxiter=50 * matrix.shape[1] + 100)[1])

    def gap_rates(self, q: Array, u: Array, pair: tuple[str, str]) -> list[tuple[Point, float]]:
        """Normal and opening rate (m/s) of each place where two bodies touch."""
        a, b = (self._scene.body(name) for name in pair)
        found = touching(self._placed(a, q), self._placed(b, q), self._near)
        return [(normal, float((self._column(a, q, at, normal) - self._column(b, q, at, normal)) @ u)) for at, normal in found]

    def _placed(self, body: Body, q: Array) -> list[Edge]:
        x, y, angle = _pose(body, q[self._slices.get(body.name, slice(0, 0))])
        return [moved(edge, angle, (x, y)) for loop in body.loops for edge in loop.edges]

    def _column(self, body: Body, q: Array, point: Point, push: Point) -> Array:
        """The generalised impulse of a push on a body."""
        out = np.zeros(len(q))
        if body.motion == "fixed":
            return out
        own = self._slices[body.name]
        x, y, _ = _pose(body, q[own])
        turn = (point[0] - x) * push[1] - (point[1] - y) * push[0]
        if body.motion == "slide":
            out[own] = push[0] * body.axis[0] + push[1] * body.axis[1]
        else:
            out[own] = (turn,) if body.motion == "pivot" else (*push, turn)
        return out


def _pose(body: Body, own: Array) -> tuple[float, float, float]:
    x, y = body.position
    if body.motion == "free":
        return float(own[0]), float(own[1]), float(own[2])
    if body.motion == "slide":
        return x + float(own[0]) * body.axis[0], y + float(own[0]) * body.axis[1], body.angle
    return x, y, float(own[0]) if body.motion == "pivot" else body.angle


def touching(first: list[Edge], second: list[Edge], near: float) -> Iterator[tuple[Point, Point]]:
    """Points where two outlines come within `near`, with the normal that points from the second to the first."""
    boxes_a, boxes_b = _boxes(first, near), _boxes(second, near)
    low = np.maximum(boxes_a[:, None, :2], boxes_b[None, :, :2])
    high = np.minimum(boxes_a[:, None, 2:], boxes_b[None, :, 2:])
    for i, j in np.argwhere((low <= high).all(axis=2)):
        a, b = first[i], second[j]
        for corner in (a.start, a.end):
            if normal := _at(b, corner, near):
                yield corner, normal
        for corner in (b.start, b.end):
            if normal := _at(a, corner, near):
                yield corner, (-normal[0], -normal[1])
        yield from _round(a, b, near)


def _beyond(edges: list[Edge], point: Point, normal: Point, near: float) -> bool:
    """Do all edges that end at a point lead away from it to the side to which the normal points?"""
    ways = [(edge.start, edge.tangent(0.0), 1.0) for edge in edges] + [(edge.end, edge.tangent(1.0), -1.0) for edge in edges]
    return all(
        way * (tx * normal[0] + ty * normal[1]) >= -LEANING
        for (x, y), (tx, ty), way in ways
        if math.hypot(x - point[0], y - point[1]) <= near
    )


def _boxes(edges: list[Edge], near: float) -> Array:
    rows = []
    for edge in edges:
        points = [edge.point(f / 8.0) for f in range(9)] if isinstance(edge, Arc) else [edge.start, edge.end]
        # A chord of an eighth of an arc hides at most its sagitta.
        slack = near + (edge.radius * (1.0 - math.cos(edge.sweep / 16.0)) if isinstance(edge, Arc) else 0.0)
        x, y = zip(*points, strict=True)
        rows.append((min(x) - slack, min(y) - slack, max(x) + slack, max(y) + slack))
    return np.array(rows)


def _at(edge: Edge, point: Point, near: float) -> Point | None:
    """The outward normal of an edge at a point on it; None where the point is not on it."""
    if isinstance(edge, Line):
        tx, ty = edge.tangent(0.0)
        dx, dy = point[0] - edge.x0, point[1] - edge.y0
        along = tx * dx + ty * dy
        on = -near <= along <= edge.length + near and abs(tx * dy - ty * dx) <= near
        return (ty, -tx) if on else None
    dx, dy = point[0] - edge.x, point[1] - edge.y
    far = math.hypot(dx, dy)
    if abs(far - edge.radius) > near or far == 0.0 or not _within(edge, (dx / far, dy / far), near):
        return None
    side = math.copysign(1.0, edge.sweep)
    return side * dx / far, side * dy / far


def _within(arc: Arc, direction: Point, near: float) -> bool:
    way = math.copysign(1.0, arc.sweep)
    turn = (way * (math.atan2(direction[1], direction[0]) - arc.start_angle)) % TURN
    slack = near / arc.radius
    return turn <= abs(arc.sweep) + slack or turn >= TURN - slack


def _round(a: Edge, b: Edge, near: float) -> Iterator[tuple[Point, Point]]:
    """Where the inside of an arc touches the inside of another edge."""
    directions: list[Point]
    if isinstance(a, Arc) and isinstance(b, Arc):
        dx, dy = a.x - b.x, a.y - b.y
        far = math.hypot(dx, dy)
        directions = [(dx / far, dy / far), (-dx / far, -dy / far)] if far > 0.0 else []
    elif isinstance(a, Arc) or isinstance(b, Arc):
        tx, ty = (b if isinstance(a, Arc) else a).tangent(0.0)
        directions = [(ty, -tx), (-ty, tx)]
    else:
        return
    arc, other = (a, b) if isinstance(a, Arc) else (b, a)
    assert isinstance(arc, Arc)
    for e in directions:
        point = (arc.x + arc.radius * e[0], arc.y + arc.radius * e[1])
        normal = _at(other, point, near)
        if normal and _within(arc, e, near):
            yield point, normal if arc is a else (-normal[0], -normal[1])
