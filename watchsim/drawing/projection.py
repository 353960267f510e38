"""Which shapes can a drawing hold, and what becomes of them in the plane?

Four shapes that stay of their kind under any affine map, so that nested, mirrored and unequally scaled blocks need no
special case. Only at the end are they projected to the plane and become lines and arcs, exactly where they are such.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from watchsim.drawing.findings import Content, Drawn, Finding, Inserted, Stroke, finding_at
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point

Vector = tuple[float, float, float]
NEARLY_Z = 1.0 / 64.0  # the format's own limit between its two rules for the x axis


class Affine(NamedTuple):
    """Maps (x, y, z) to x·`ax` + y·`ay` + z·`az` + `origin`.

    The drawing's plane is the world's xy plane; entities may be drawn in a plane of their own (object coordinates) and blocks
    may be turned, mirrored and scaled unequally.
    """

    ax: Vector = (1.0, 0.0, 0.0)
    ay: Vector = (0.0, 1.0, 0.0)
    az: Vector = (0.0, 0.0, 1.0)
    origin: Vector = (0.0, 0.0, 0.0)

    def direction(self, v: Vector) -> Vector:
        """The image of a difference of points."""
        (x, y, z), a, b, c = v, self.ax, self.ay, self.az
        return (x * a[0] + y * b[0] + z * c[0], x * a[1] + y * b[1] + z * c[1], x * a[2] + y * b[2] + z * c[2])

    def point(self, p: Vector) -> Vector:
        x, y, z = self.direction(p)
        return (x + self.origin[0], y + self.origin[1], z + self.origin[2])

    def after(self, inner: Affine) -> Affine:
        """The map that applies `inner` first, then this one."""
        ax, ay, az = (self.direction(axis) for axis in (inner.ax, inner.ay, inner.az))
        return Affine(ax, ay, az, self.point(inner.origin))


IDENTITY = Affine()


def object_plane(normal: Vector) -> Affine:
    """Object to world coordinates for an extrusion vector, by the arbitrary-axis rule of the DXF reference."""
    if normal == (0.0, 0.0, 1.0):
        return IDENTITY
    az = unit(normal)
    near_z = abs(az[0]) < NEARLY_Z and abs(az[1]) < NEARLY_Z
    ax = unit(cross((0.0, 1.0, 0.0) if near_z else (0.0, 0.0, 1.0), az))
    return Affine(ax, cross(az, ax), az)


def shifted(offset: Vector) -> Affine:
    return Affine(origin=offset)


def turned_scaled(angle: float, scale: Vector) -> Affine:
    """Scales along the axes first, then turns by `angle` (radians) about z."""
    c, s = cosine_sine(angle)
    sx, sy, sz = scale
    return Affine((c * sx, s * sx, 0.0), (-s * sy, c * sy, 0.0), (0.0, 0.0, sz))


def cosine_sine(angle: float) -> tuple[float, float]:
    """Cosine and sine, exact for whole quarter turns (a block turned by 90° keeps its lines straight up)."""
    quarters = angle / (0.5 * math.pi)
    whole = round(quarters)
    if abs(quarters - whole) < 1e-12:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[whole % 4]
    return math.cos(angle), math.sin(angle)


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v: Vector) -> Vector:
    """The unit vector; (0, 0, 1) for a vector of length zero, as CAD programs read it."""
    length = math.hypot(*v)
    return (v[0] / length, v[1] / length, v[2] / length) if length > 0.0 else (0.0, 0.0, 1.0)


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


# Shapes are projected to the drawing plane. What is a line or an arc becomes one, in metres; other curves wait until all are
# known, since many are followed much faster together. Everything found on the way is gathered here.

MOST_STROKES = 250_000  # more is a fault in the file, not a drawing
UNFOLDED = 50_000  # pieces that a small file may unfold into; one more for each of its bytes: see `most_strokes`
MOST_COPIES = 50_000  # of blocks, likewise
ROUNDING = 1e-11  # of the coordinates: a fit cannot be better than this


@dataclass(frozen=True, slots=True)
class Waiting:
    """A curve that arcs shall follow within `limit` metres, less what it was moved; its edges go before stroke `before`."""

    shape: Conic | Spline
    layer: str
    source: str
    run: int
    before: int
    limit: float
    curves: int
    moved: float


@dataclass
class Gathering:
    """What has been found so far; filled in while the file is walked through once."""

    scale: float
    tolerance: float
    most: int = MOST_STROKES  # pieces
    strokes: list[Stroke] = field(default_factory=list)
    waiting: list[Waiting] = field(default_factory=list)
    points: list[tuple[str, float, float]] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    ignored: Counter[str] = field(default_factory=Counter)
    hidden: Counter[str] = field(default_factory=Counter)
    kinds: Counter[str] = field(default_factory=Counter)
    tilted: int = 0
    copies: int = 0
    runs: int = 0
    inserted: list[Inserted] = field(default_factory=list)
    curves: int = 0
    arcs: int = 0
    deviation: float = 0.0

    def content(self, units: str | None, units_from: str | None, findings: Iterable[Finding]) -> Content:
        """What a reader hands on once the file is walked through and all curves are followed."""
        return Content(
            strokes=tuple(self.strokes),
            points=tuple(self.points),
            units=units,
            units_from=units_from,
            fitted_curves=self.curves,
            fitted_arcs=self.arcs,
            fitted_deviation=self.deviation,
            ignored=dict(self.ignored),
            drawn=Drawn(dict(self.kinds), math.fsum(stroke.edge.length for stroke in self.strokes)),
            inserted=tuple(self.inserted),
            findings=tuple(findings),
        )


class TooLarge(Exception):
    """The drawing unfolds into more pieces than `Gathering.most`, or more than MOST_COPIES copies of blocks."""


def most_strokes(size: int) -> int:
    """How many pieces a file of `size` bytes may hold: some hundred bytes of nested arrays can ask for any number."""
    return min(MOST_STROKES, UNFOLDED + size)


def emit(found: Gathering, shape: Shape, layer: str, source: str, curves: int = 1, moved: float = 0.0) -> None:
    """Projects one shape in world coordinates to the plane and keeps its edges, or keeps it until all are known.

    It stands for so many curves of the file, points of which were moved by at most `moved` metres.
    """
    scale = found.scale
    if isinstance(shape, Dot):
        found.points.append((layer, scale * shape.at[0], scale * shape.at[1]))
        return
    found.tilted += tilted(shape)
    edge = None if isinstance(shape, Spline) else exact_edge(shape, scale)
    if edge is not None:
        if edge.length > 0.0:
            found.kinds["line" if isinstance(edge, Line) else "circle" if edge.is_circle else "arc"] += 1
        keep(found, (edge,), layer, source)
    elif isinstance(shape, Spline) or (isinstance(shape, Conic) and not edge_on(shape)):
        found.kinds[kind_of(shape)] += curves
        limit = max(found.tolerance - moved, ROUNDING * scale * reach(shape))
        found.waiting.append(Waiting(shape, layer, source, found.runs, len(found.strokes), limit, curves, moved))
        if len(found.waiting) > found.most:
            raise TooLarge
    else:
        message = f"{source} is seen edge-on, as a line drawn there and back; it is left out"
        found.findings.append(finding_at(place_of(shape, scale), "edge-on", "warning", message, layer=layer))


def cannot_follow(found: Gathering, curve: Waiting, deviation: float) -> None:
    """Says that a curve could not be followed within its tolerance."""
    message = f"{curve.source} could only be followed within {deviation * 1e6:.3g} µm: it has a cusp or a gap"
    found.findings.append(finding_at(place_of(curve.shape, found.scale), "fit", "warning", message, layer=curve.layer))


def kind_of(shape: Conic | Spline) -> str:
    """The name of a shape that is followed by arcs."""
    if isinstance(shape, Spline):
        return "spline"
    return "ellipse" if abs(shape.sweep) >= TURN * (1.0 - 1e-12) else "ellipse_arc"


def keep(found: Gathering, edges: Iterable[Edge], layer: str, source: str) -> None:
    found.strokes.extend(Stroke(edge, layer, source, found.runs) for edge in edges)
    if len(found.strokes) > found.most:
        raise TooLarge


def corner(shape: Straight | Conic | Spline) -> tuple[float, float, float]:
    """Some point that belongs to the shape."""
    return shape.a if isinstance(shape, Straight) else shape.centre if isinstance(shape, Conic) else shape.points[0]


def place_of(shape: Straight | Conic | Spline, scale: float) -> Point:
    """The same in metres."""
    return (scale * corner(shape)[0], scale * corner(shape)[1])


def reach(shape: Straight | Conic | Spline) -> float:
    """The largest coordinate that matters for rounding, drawing units."""
    points = shape.points if isinstance(shape, Spline) else [corner(shape)]
    size = max(map(abs, (*shape.u, *shape.v))) if isinstance(shape, Conic) else 0.0
    return size + max(max(abs(x), abs(y)) for x, y, _ in points)


def tilted(shape: Straight | Conic | Spline) -> bool:
    """Does the shape leave its plane of constant height by more than a millionth of its size?"""
    if isinstance(shape, Conic):
        return max(abs(shape.u[2]), abs(shape.v[2])) > 1e-6 * max(math.hypot(*shape.u), math.hypot(*shape.v))
    if isinstance(shape, Straight):
        return shape.a[2] != shape.b[2] and abs(shape.a[2] - shape.b[2]) > 1e-6 * math.dist(shape.a, shape.b)
    points = shape.points
    first = points[0]
    return any(abs(p[2] - first[2]) > 1e-6 * math.dist(p, first) for p in points[1:])
