"""What becomes of a shape in the plane?

Shapes are projected to the drawing plane. What is a line or an arc becomes one, in metres; other curves wait until all are
known, since many are followed much faster together (see follow). Everything found on the way is gathered here.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

from watchsim.drawing.content import Drawn, Inserted, Stroke
from watchsim.drawing.curves.plane_shapes import Conic, Dot, Shape, Spline, Straight, edge_on, exact_edge
from watchsim.drawing.findings import Finding
from watchsim.geometry.primitives import TURN, Edge, Line

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

    def drawn(self) -> Drawn:
        return Drawn(dict(self.kinds), math.fsum(stroke.edge.length for stroke in self.strokes))


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
        found.findings.append(_at("edge-on", "warning", message, layer, scale, shape))


def cannot_follow(found: Gathering, curve: Waiting, deviation: float) -> None:
    """Says that a curve could not be followed within its tolerance."""
    message = f"{curve.source} could only be followed within {deviation * 1e6:.3g} µm: it has a cusp or a gap"
    found.findings.append(_at("fit", "warning", message, curve.layer, found.scale, curve.shape))


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


def _at(code: str, severity: str, message: str, layer: str, scale: float, shape: Straight | Conic | Spline) -> Finding:
    x, y, _ = corner(shape)
    return Finding(code, severity, message, "", layer, 1e3 * scale * x, 1e3 * scale * y)
