"""Which bodies stand inside each other at the start?

Contact laws push bodies apart from a touch, not out of each other: a scene must begin with all declared pairs open or just
touching. Outlines are compared as polylines, so depths below the polyline's own error are not told from a touch.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.geometry.polyline import polyline
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.mechanism.body import Body
from watchsim.mechanism.carry import at_start
from watchsim.mechanism.errors import Fault
from watchsim.mechanism.force import Side
from watchsim.mechanism.locate import key_lines
from watchsim.mechanism.scene import Scene

Floats = NDArray[np.float64]
DEVIATION = 0.5e-9  # m, of the polylines; too large: resting contacts are refused; too small: slow
ALLOWED = 1e-9 + 2.0 * DEVIATION  # m; both outlines may deviate


@dataclass(frozen=True, slots=True)
class Overlap:
    """The deepest point of an overlap of contact number `contact`: depth (m), place (m, movement coordinates)."""

    contact: int
    sides: tuple[Side, Side]
    depth: float
    place: Point

    def __str__(self) -> str:
        first, second = self.sides
        x, y = (f"{1e3 * value:.4g}" for value in self.place)
        layers = f"layers {first.layer} and {second.layer}"
        return f"{first.body} and {second.body} overlap by {1e3 * self.depth:.3g} mm at the start, at ({x}, {y}) mm ({layers})"


def overlaps(scene: Scene) -> list[Overlap]:
    """The deepest overlap of every declared contact whose outlines overlap by more than about a nanometre at the start."""
    found, scene = [], at_start(scene)
    for i, contact in enumerate(scene.contacts):
        sides = [list(_layers(scene.body(side.body), side)) for side in contact.sides]
        pairs = ((a, b) for a in sides[0] for b in sides[1])
        deepest = max((_deepest(i, a, b) for a, b in pairs), key=lambda overlap: overlap.depth, default=None)
        if deepest and deepest.depth > ALLOWED:
            found.append(deepest)
    return found


def overlap_faults(scene: Scene) -> list[Fault]:
    """The same as faults of the scene file, at the position of a body that can be moved."""
    lines = key_lines(scene.path.read_text(encoding="utf-8-sig")) if scene.path and scene.path.is_file() else {}
    faults = []
    for overlap in overlaps(scene):
        moving = next((side.body for side in overlap.sides if scene.body(side.body).motion != "fixed"), overlap.sides[0].body)
        key = f"bodies.{moving}.position"
        line = lines.get(key) or lines.get(f"bodies.{moving}")
        place = f"{scene.path or 'scene'}:{line}" if line else str(scene.path or "scene")
        shown = f"`watchsim check {scene.path} --png FILE` shows where" if scene.path else "`watchsim check` shows where"
        faults.append(Fault(key, f"{overlap}. Move or turn one of them; {shown}", place=place))
    return faults


@dataclass(frozen=True, slots=True)
class _Layer:
    """The outlines of one layer where they stand at the start: a region of material and open faces."""

    side: Side
    region: Any  # a shapely geometry
    faces: tuple[Edge, ...]


def _layers(body: Body, side: Side) -> Iterator[_Layer]:
    for layer in (side.layer,) if side.layer else body.layers:
        loops = [loop.moved(body.angle, body.position) for loop in body.loops if loop.layer == layer]
        faces = tuple(edge for loop in loops if not loop.closed for edge in loop.edges)
        yield _Layer(Side(body.name, layer), _region([loop for loop in loops if loop.closed]), faces)


def _region(loops: list[Loop]) -> Any:
    """Outer outlines without the holes that lie directly in them."""
    import shapely

    outers = [shapely.Polygon(polyline(loop, DEVIATION)) for loop in loops if not loop.hole]
    holes: list[list[NDArray[np.float64]]] = [[] for _ in outers]
    for loop in loops:
        if loop.hole:
            points = polyline(loop, DEVIATION)
            around = [i for i, outer in enumerate(outers) if outer.covers(shapely.Polygon(points).representative_point())]
            if around:
                holes[min(around, key=lambda i: outers[i].area)].append(points)
    pierced = [shapely.Polygon(outer.exterior, inner) for outer, inner in zip(outers, holes, strict=True)]
    return shapely.union_all([polygon if polygon.is_valid else polygon.buffer(0.0) for polygon in pierced])


def _deepest(contact: int, a: _Layer, b: _Layer) -> Overlap:
    candidates = [_regions_depth(a.region, b.region)]
    candidates += [_face_depth(face, b.region) for face in a.faces] + [_face_depth(face, a.region) for face in b.faces]
    depth, place = max(candidates)
    return Overlap(contact, (a.side, b.side), depth, place)


def _regions_depth(a: Any, b: Any) -> tuple[float, Point]:
    """How far the boundary of one region reaches into the other, and where."""
    import shapely

    common = shapely.intersection(a, b)
    if common.area == 0.0:
        return 0.0, (0.0, 0.0)
    points = shapely.get_coordinates(common)
    vertices = shapely.points(points)
    depths = np.maximum(shapely.distance(vertices, a.boundary), shapely.distance(vertices, b.boundary))
    worst = int(np.argmax(depths))
    return float(depths[worst]), (float(points[worst, 0]), float(points[worst, 1]))


def _face_depth(face: Edge, region: Any) -> tuple[float, Point]:
    """How far a region that straddles an open face reaches behind it, counting only what lies beside the face."""
    import shapely

    if not region.intersects(shapely.LineString(polyline(Loop((face,), closed=False), DEVIATION))):
        return 0.0, (0.0, 0.0)
    points = shapely.get_coordinates(region)
    beside, behind = _behind_arc(face, points) if isinstance(face, Arc) else _behind_line(face, points)
    behind = np.where(beside, behind, -math.inf)
    worst = int(np.argmax(behind))
    return max(float(behind[worst]), 0.0), (float(points[worst, 0]), float(points[worst, 1]))


def _behind_line(face: Line, points: Floats) -> tuple[NDArray[np.bool_], Floats]:
    """Which points lie beside the line, and how far each is behind it (m)."""
    (tx, ty), (x, y) = face.tangent(0.0), points.T - np.array([[face.x0], [face.y0]])
    along = x * tx + y * ty
    return (along >= 0.0) & (along <= face.length), tx * y - ty * x


def _behind_arc(face: Arc, points: Floats) -> tuple[NDArray[np.bool_], Floats]:
    """The same for an arc: behind is inside the circle if it runs counter-clockwise, else outside."""
    x, y = points.T - np.array([[face.x], [face.y]])
    way = math.copysign(1.0, face.sweep)
    turn = np.mod(way * (np.arctan2(y, x) - face.start_angle), TURN)
    return turn <= abs(face.sweep), way * (face.radius - np.hypot(x, y))
