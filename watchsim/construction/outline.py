"""How is an outline drawn with lines, arcs and rounded corners?

A draughtsman's chain: edges one after the other, then every corner that asks for it gets a tangent fillet. Lengths are
whatever the caller uses (here millimetres), angles radians unless a name says degrees. Material is on the left.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point

SMALLER, SMALLEST = 0.8, 1e-3  # steps in which a fillet yields, and the least that is drawn


def sine(degrees: float) -> float:
    return math.sin(math.radians(degrees))


def cosine(degrees: float) -> float:
    return math.cos(math.radians(degrees))


def polar(radius: float, degrees: float, centre: Point = (0.0, 0.0)) -> Point:
    """The point at `radius` and `degrees` (counter-clockwise from +x) from `centre`."""
    return (centre[0] + radius * math.cos(math.radians(degrees)), centre[1] + radius * math.sin(math.radians(degrees)))


def turned(point: Point, degrees: float) -> Point:
    """The point turned about the origin."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (c * point[0] - s * point[1], s * point[0] + c * point[1])


def along(point: Point, degrees: float, distance: float) -> Point:
    """The point `distance` away in the direction `degrees`."""
    return polar(distance, degrees, point)


def angle_of(point: Point, centre: Point = (0.0, 0.0)) -> float:
    """Polar angle of the point about `centre`, degrees."""
    return math.degrees(math.atan2(point[1] - centre[1], point[0] - centre[0]))


def arc_between(start: Point, end: Point, centre: Point, left: bool) -> Arc:
    """The arc about `centre` from `start` to `end`, counter-clockwise if `left`; both must lie on it."""
    begin, finish = math.radians(angle_of(start, centre)), math.radians(angle_of(end, centre))
    sweep = (finish - begin) % TURN if left else -((begin - finish) % TURN)
    return Arc(*centre, math.dist(centre, start), begin, sweep)


def arc_of_radius(start: Point, end: Point, radius: float) -> Arc:
    """The short arc from `start` to `end`; a positive radius bends to the left, a negative one to the right."""
    half = math.dist(start, end) / 2.0
    rise = math.copysign(math.sqrt(radius * radius - half * half), radius)
    middle = ((start[0] + end[0]) / 2.0, (start[1] + end[1]) / 2.0)
    along_x, along_y = (end[0] - start[0]) / (2.0 * half), (end[1] - start[1]) / (2.0 * half)
    return arc_between(start, end, (middle[0] - rise * along_y, middle[1] + rise * along_x), radius > 0.0)


def circle(layer: str, centre: Point, radius: float, hole: bool = False) -> Loop:
    """A full circle as a loop."""
    return Loop((Arc(*centre, radius, 0.0, -TURN if hole else TURN),), layer, hole=hole)


def polygon(layer: str, corners: Sequence[Point]) -> Loop:
    """The closed polygon with sharp corners."""
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)), layer)


def rounded(layer: str, corners: Sequence[tuple[Point, float]], yielding: bool = False) -> Loop:
    """The closed polygon through corners that are rounded by a fillet each; `yielding` as in fillet_chain."""
    edges = polygon(layer, [corner for corner, _ in corners]).edges
    radii = [radius for _, radius in [*corners[1:], corners[0]]]
    return Loop(tuple(fillet_chain(edges, radii, closed=True, yielding=yielding)), layer)


def filleted(layer: str, parts: Sequence[tuple[Edge, float]], yielding: bool = False) -> Loop:
    """The closed chain of edges, each with the fillet behind it."""
    edges, radii = [edge for edge, _ in parts], [radius for _, radius in parts]
    return Loop(tuple(fillet_chain(edges, radii, closed=True, yielding=yielding)), layer)


def around(layer: str, edges: Sequence[Edge], angles: Iterable[float]) -> Loop:
    """One outline of the same edges again and again, turned about the origin by each of the angles, radians."""
    one = Loop(tuple(edges), layer)
    return Loop(tuple(edge for angle in angles for edge in one.moved(angle, (0.0, 0.0)).edges), layer)


def to_circle(start: Point, degrees: float, radius: float, out: bool = True) -> float:
    """How far along a direction the circle about the origin is crossed, on the way out or, before that, on the way in."""
    ux, uy = polar(1.0, degrees)
    ahead = start[0] * ux + start[1] * uy
    reach = math.sqrt(ahead**2 + radius**2 - start[0] ** 2 - start[1] ** 2)
    return -ahead + reach if out else -ahead - reach


def mirrored(edge: Edge) -> Edge:
    """The mirror image in the y axis, run through the other way, so that the material stays on the left."""
    if isinstance(edge, Line):
        return Line(-edge.x1, edge.y1, -edge.x0, edge.y0)
    return Arc(-edge.x, edge.y, edge.radius, math.pi - edge.start_angle - edge.sweep, edge.sweep)


def fillet_chain(edges: Sequence[Edge], radii: Sequence[float], closed: bool = False, yielding: bool = False) -> list[Edge]:
    """The chain with a fillet of radii[i] at the end of edges[i]; 0 leaves the corner sharp.

    An open chain needs one radius fewer than edges, a closed one as many. A `yielding` chain takes a smaller fillet, or none,
    where the one asked for does not fit between its neighbours.
    """
    rounding = _yielding if yielding else fillet
    trimmed, fillets = list(edges), dict[int, Arc | None]()
    for i, radius in enumerate(radii):
        follower = (i + 1) % len(trimmed)
        if radius > 0.0 and (closed or follower > 0):
            trimmed[i], fillets[i], trimmed[follower] = rounding(trimmed[i], trimmed[follower], radius)
    chain: list[Edge] = []
    for i, edge in enumerate(trimmed):
        chain.append(edge)
        corner = fillets.get(i)
        if corner is not None:
            chain.append(corner)
    return chain


def fillet(first: Edge, second: Edge, radius: float) -> tuple[Edge, Arc, Edge]:
    """Both edges cut back and the arc of `radius` that joins them tangentially.

    Raises ValueError where no such arc exists. The centre is where the two edges, moved sideways by `radius`, cross.
    """
    tx, ty = first.tangent(1.0)
    ux, uy = second.tangent(0.0)
    side = math.copysign(1.0, tx * uy - ty * ux)
    candidates = _crossings(_offset(first, side * radius), _offset(second, side * radius))
    if not candidates:
        raise ValueError(f"no fillet of radius {radius} fits at ({first.end[0]:.4f}, {first.end[1]:.4f})")
    centre = min(candidates, key=lambda point: math.dist(point, first.end))
    start, end = _foot(first, centre), _foot(second, centre)
    return _cut(first, first.start, start), arc_between(start, end, centre, side > 0.0), _cut(second, end, second.end)


def _yielding(first: Edge, second: Edge, radius: float) -> tuple[Edge, Arc | None, Edge]:
    """The fillet, or the largest of smaller ones that leaves something of both edges; None where none does."""
    while radius > SMALLEST:
        try:
            one, arc, other = fillet(first, second, radius)
        except ValueError:
            radius *= SMALLER
            continue
        if _shortened(first, one) and _shortened(second, other):
            return one, arc, other
        radius *= SMALLER
    return first, None, second


def _shortened(whole: Edge, rest: Edge) -> bool:
    """Is the rest a part of the edge, and not most of its circle or its continuation backwards?"""
    if isinstance(whole, Line) and isinstance(rest, Line):
        ahead = sum(a * b for a, b in zip(whole.tangent(0.0), _way(rest), strict=True))
        return 0.0 < ahead <= whole.length
    return rest.length <= whole.length


def _way(line: Line) -> Point:
    return (line.x1 - line.x0, line.y1 - line.y0)


def _offset(edge: Edge, distance: float) -> Edge:
    """The edge moved to its left by `distance`."""
    if isinstance(edge, Line):
        tx, ty = edge.tangent(0.0)
        dx, dy = -ty * distance, tx * distance
        return Line(edge.x0 + dx, edge.y0 + dy, edge.x1 + dx, edge.y1 + dy)
    return Arc(edge.x, edge.y, edge.radius - math.copysign(1.0, edge.sweep) * distance, edge.start_angle, edge.sweep)


def _crossings(first: Edge, second: Edge) -> list[Point]:
    """Points common to the infinite lines and full circles on which the edges lie."""
    if isinstance(first, Line) and isinstance(second, Line):
        tx, ty = first.tangent(0.0)
        ux, uy = second.tangent(0.0)
        cross = tx * uy - ty * ux
        if cross == 0.0:
            return []
        s = ((second.x0 - first.x0) * uy - (second.y0 - first.y0) * ux) / cross
        return [(first.x0 + s * tx, first.y0 + s * ty)]
    if isinstance(first, Line):
        return _line_circle(first, second)  # type: ignore[arg-type]
    if isinstance(second, Line):
        return _line_circle(second, first)
    return _circle_circle(first, second)


def _line_circle(line: Line, circle: Arc) -> list[Point]:
    tx, ty = line.tangent(0.0)
    dx, dy = circle.x - line.x0, circle.y - line.y0
    middle, height = dx * tx + dy * ty, dy * tx - dx * ty
    reach = circle.radius**2 - height**2
    if reach < 0.0:
        return []
    return [(line.x0 + s * tx, line.y0 + s * ty) for s in (middle - math.sqrt(reach), middle + math.sqrt(reach))]


def _circle_circle(first: Arc, second: Arc) -> list[Point]:
    dx, dy = second.x - first.x, second.y - first.y
    distance = math.hypot(dx, dy)
    if distance == 0.0:
        return []
    a = (distance**2 + first.radius**2 - second.radius**2) / (2.0 * distance)
    reach = first.radius**2 - a * a
    if reach < 0.0:
        return []
    b, ux, uy = math.sqrt(reach), dx / distance, dy / distance
    return [(first.x + a * ux - s * b * uy, first.y + a * uy + s * b * ux) for s in (1.0, -1.0)]


def _foot(edge: Edge, point: Point) -> Point:
    """The nearest point of the edge's line or circle."""
    if isinstance(edge, Line):
        tx, ty = edge.tangent(0.0)
        s = (point[0] - edge.x0) * tx + (point[1] - edge.y0) * ty
        return (edge.x0 + s * tx, edge.y0 + s * ty)
    return polar(edge.radius, angle_of(point, (edge.x, edge.y)), (edge.x, edge.y))


def _cut(edge: Edge, start: Point, end: Point) -> Edge:
    """The part of the edge between two of its points."""
    if isinstance(edge, Line):
        return Line(*start, *end)
    return arc_between(start, end, (edge.x, edge.y), edge.sweep > 0.0)
