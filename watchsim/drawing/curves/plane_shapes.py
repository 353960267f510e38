"""Which shapes can a drawing hold, and what becomes of them in the plane?

Four shapes that stay of their kind under any affine map, so that nested, mirrored and unequally scaled blocks need no
special case. Only at the end are they projected to the plane and become lines and arcs, exactly where they are such.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from watchsim.drawing.curves.affine import Affine, Vector
from watchsim.geometry.primitives import TURN, Arc, Edge, Line

ROUND = 1e-9  # relative difference of the axes up to which an ellipse is a circle: below any drawing's decimals
FLAT = 1e-9  # relative width below which an ellipse is seen edge-on


@dataclass(frozen=True, slots=True)
class Straight:
    """A straight piece from a to b."""

    a: Vector
    b: Vector

    def mapped(self, affine: Affine) -> Straight:
        return Straight(affine.point(self.a), affine.point(self.b))


@dataclass(frozen=True, slots=True)
class Conic:
    """centre + u cos t + v sin t for t from `start` through `sweep` radians: circles, ellipses and their arcs.

    u and v are conjugate, not necessarily perpendicular; an affine map acts on them as on any vector.
    """

    centre: Vector
    u: Vector
    v: Vector
    start: float
    sweep: float

    def mapped(self, affine: Affine) -> Conic:
        return Conic(affine.point(self.centre), affine.direction(self.u), affine.direction(self.v), self.start, self.sweep)


@dataclass(frozen=True, slots=True)
class Spline:
    """A B-spline with `weights` (empty: all one) on the part of `knots` that its degree and control points span."""

    degree: int
    knots: Sequence[float]
    points: Sequence[Vector]
    weights: Sequence[float] = field(default=())

    def mapped(self, affine: Affine) -> Spline:
        return Spline(self.degree, self.knots, [affine.point(p) for p in self.points], self.weights)


@dataclass(frozen=True, slots=True)
class Dot:
    """A single point."""

    at: Vector

    def mapped(self, affine: Affine) -> Dot:
        return Dot(affine.point(self.at))


Shape = Straight | Conic | Spline | Dot


def circle(centre: Vector, radius: float, start: float = 0.0, sweep: float = TURN) -> Conic:
    return Conic(centre, (radius, 0.0, 0.0), (0.0, radius, 0.0), start, sweep)


def bulge(a: Vector, b: Vector, amount: float) -> Straight | Conic:
    """The polyline segment from a to b with that bulge, the tangent of a quarter of its angle (positive: to the left)."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    if abs(amount) < 1e-8 or (dx == 0.0 and dy == 0.0):
        return Straight(a, b)  # at 1e-8 the rise is below the rounding of the centre
    k = (1.0 - amount * amount) / (4.0 * amount)
    x, y = 0.5 * (a[0] + b[0]) - k * dy, 0.5 * (a[1] + b[1]) + k * dx
    radius = math.hypot(dx, dy) * (1.0 + amount * amount) / (4.0 * abs(amount))
    return circle((x, y, a[2]), radius, math.atan2(a[1] - y, a[0] - x), 4.0 * math.atan(amount))


def exact_edge(shape: Straight | Conic, scale: float) -> Edge | None:
    """The line or arc (metres) of a shape in drawing units of `scale` metres; None for an ellipse."""
    if isinstance(shape, Straight):
        (x0, y0, _), (x1, y1, _) = shape.a, shape.b
        return Line(scale * x0, scale * y0, scale * x1, scale * y1)
    (ux, uy, _), (vx, vy, _) = shape.u, shape.v
    uu, vv, uv = ux * ux + uy * uy, vx * vx + vy * vy, ux * vx + uy * vy
    if abs(uu - vv) > 2.0 * ROUND * max(uu, vv) or abs(uv) > ROUND * max(uu, vv):
        return None
    side = math.copysign(1.0, ux * vy - uy * vx)
    start = math.atan2(uy, ux) + side * shape.start
    return Arc(scale * shape.centre[0], scale * shape.centre[1], scale * math.hypot(ux, uy), start, side * shape.sweep)


def forward(conic: Conic) -> Conic:
    """The same curve travelled in the same direction, with a parameter that grows."""
    if conic.sweep > 0.0:
        return conic
    x, y, z = conic.v
    return Conic(conic.centre, conic.u, (-x, -y, -z), -conic.start, -conic.sweep)


def edge_on(conic: Conic) -> bool:
    """Is the ellipse so narrow that it is a line folded back on itself?"""
    (ux, uy, _), (vx, vy, _) = conic.u, conic.v
    return abs(ux * vy - uy * vx) <= FLAT * max(ux * ux + uy * uy, vx * vx + vy * vy)
