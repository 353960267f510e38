"""What is a line, what is an arc, and which boxes hold these points?

Edges are frozen records in metres and radians with a direction of travel. An outline is a sequence of them with the material on
the left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Decimal, localcontext

import numpy as np
from numpy.typing import NDArray

Point = tuple[float, float]
TURN = 2.0 * math.pi
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)  # of an interval: where golden-section search looks


@dataclass(frozen=True, slots=True)
class Line:
    """A straight edge from (x0, y0) to (x1, y1), metres."""

    x0: float
    y0: float
    x1: float
    y1: float

    @property
    def start(self) -> Point:
        return (self.x0, self.y0)

    @property
    def end(self) -> Point:
        return (self.x1, self.y1)

    @property
    def length(self) -> float:
        return math.hypot(self.x1 - self.x0, self.y1 - self.y0)

    def reversed(self) -> Line:
        return Line(self.x1, self.y1, self.x0, self.y0)

    def point(self, fraction: float) -> Point:
        """The point at `fraction` (0 to 1) of the way."""
        return (self.x0 + fraction * (self.x1 - self.x0), self.y0 + fraction * (self.y1 - self.y0))

    def tangent(self, fraction: float) -> Point:
        """Unit direction of travel; the same for every `fraction`."""
        length = self.length
        return ((self.x1 - self.x0) / length, (self.y1 - self.y0) / length)


@dataclass(frozen=True, slots=True)
class Arc:
    """A circular edge: centre (x, y), `radius` in metres, from angle `start_angle` through `sweep` radians.

    A positive sweep runs counter-clockwise; a full circle has `sweep` = ±2π.
    """

    x: float
    y: float
    radius: float
    start_angle: float
    sweep: float

    @property
    def start(self) -> Point:
        return self.point(0.0)

    @property
    def end(self) -> Point:
        return self.point(1.0)

    @property
    def length(self) -> float:
        return self.radius * abs(self.sweep)

    @property
    def is_circle(self) -> bool:
        return abs(self.sweep) >= TURN * (1.0 - 1e-12)

    def reversed(self) -> Arc:
        return Arc(self.x, self.y, self.radius, self.start_angle + self.sweep, -self.sweep)

    def point(self, fraction: float) -> Point:
        """The point at `fraction` (0 to 1) of the way."""
        angle = self.start_angle + fraction * self.sweep
        return (self.x + self.radius * math.cos(angle), self.y + self.radius * math.sin(angle))

    def tangent(self, fraction: float) -> Point:
        """Unit direction of travel at `fraction` of the way."""
        angle = self.start_angle + fraction * self.sweep
        side = math.copysign(1.0, self.sweep)
        return (-side * math.sin(angle), side * math.cos(angle))


Edge = Line | Arc


def moved(edge: Edge, angle: float, shift: Point) -> Edge:
    """The edge turned by `angle` (radians) about the origin, then shifted (metres)."""
    c, s = math.cos(angle), math.sin(angle)
    dx, dy = shift
    if isinstance(edge, Arc):
        x, y = c * edge.x - s * edge.y + dx, s * edge.x + c * edge.y + dy
        return Arc(x, y, edge.radius, edge.start_angle + angle, edge.sweep)
    (x0, y0), (x1, y1) = edge.start, edge.end
    return Line(c * x0 - s * y0 + dx, s * x0 + c * y0 + dy, c * x1 - s * y1 + dx, s * x1 + c * y1 + dy)


def reflected(edge: Edge, foot: Point, direction: Point) -> Edge:
    """The edge's image across the line through `foot` (metres) along the unit vector `direction`."""
    (fx, fy), (ux, uy) = foot, direction
    c, s = ux * ux - uy * uy, 2.0 * ux * uy  # of twice the line's angle

    def image(x: float, y: float) -> Point:
        return (fx + c * (x - fx) + s * (y - fy), fy + s * (x - fx) - c * (y - fy))

    if isinstance(edge, Line):
        return Line(*image(edge.x0, edge.y0), *image(edge.x1, edge.y1))
    return Arc(*image(edge.x, edge.y), edge.radius, 2.0 * math.atan2(uy, ux) - edge.start_angle, -edge.sweep)


DIGITS = 40
QUARTER = Decimal("1.5707963267948966192313216916397514420985846996875529")


def cos_sin(angle: Decimal) -> tuple[Decimal, Decimal]:
    """Cosine and sine of `angle` (radians, up to some turns) to about 38 digits.

    A point on an arc whose radius is a million times its length keeps all its digits only so.
    """
    with localcontext() as context:
        context.prec = DIGITS
        quarters = int((angle / QUARTER).to_integral_value())
        rest = angle - quarters * QUARTER  # within an eighth of a turn either way
        term, k = Decimal(1), 0
        sums = [Decimal(0), Decimal(0)]
        while abs(term) > Decimal(10) ** -DIGITS:
            sums[k % 2] += -term if k % 4 >= 2 else term
            k += 1
            term *= rest / k
        c, s = sums
        return ((c, s), (-s, c), (-c, -s), (s, -c))[quarters % 4]


def middle(edge: Arc, exact: bool) -> tuple[float, float, float, float]:
    """Middle of the arc and the direction to it from the centre; `exact`: rounded once, however far the centre is."""
    if not exact:
        angle = edge.start_angle + 0.5 * edge.sweep
        c, s = math.cos(angle), math.sin(angle)
        return edge.x + edge.radius * c, edge.y + edge.radius * s, c, s
    cosine, sine = cos_sin(Decimal(edge.start_angle) + Decimal(edge.sweep) / 2)
    x, y, radius = Decimal(edge.x), Decimal(edge.y), Decimal(edge.radius)
    return float(x + radius * cosine), float(y + radius * sine), float(cosine), float(sine)


FEW = 300  # up to that many, all pairs are compared; the library takes longer to load


class Boxes:
    """Boxes (m, 4), queried again and again."""

    def __init__(self, boxes: NDArray[np.float64]) -> None:
        self.boxes = boxes
        if len(boxes) > FEW:
            import shapely

            self.tree = shapely.STRtree(shapely.box(*boxes.T))

    def holding(self, points: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Numbers of points (n, 2) and of the boxes that hold them, one entry for each such pair."""
        if len(self.boxes) <= FEW:
            x, y = points[:, :1], points[:, 1:]
            held = (self.boxes[:, 0] <= x) & (x <= self.boxes[:, 2]) & (self.boxes[:, 1] <= y) & (y <= self.boxes[:, 3])
            point, box = np.nonzero(held)
            return point, box
        import shapely

        found = self.tree.query(shapely.points(points))
        return found[0], found[1]
