"""How deep do two regions of material overlap, or a region and an open face?"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.mechanism.material_polygons import chord_points

Floats = NDArray[np.float64]
COARSE = 5e-8  # m, of chords where two outlines do not come close


def face_line(points: Floats) -> Any:
    """The chords of an open face."""
    import shapely

    return shapely.LineString(points)


def regions_depth(a: Any, b: Any, allowed: float) -> tuple[float, Point]:
    """How far the boundary of one region reaches into the other, and where; 0 for a touch, negative for none.

    Where two bars cross, no corner of either lies in the other: there the width of what is common counts. The largest disc in a
    region is at least as wide as twice its area over its perimeter.
    """
    import shapely

    shapely.prepare(a)
    if not shapely.dwithin(a, b, allowed):  # quicker by far than to find where they are nearest
        return -1.0, (0.0, 0.0)
    parts = common_parts(a, b, allowed)
    if not parts:
        return 0.0, shapely.shortest_line(a, b).coords[0]
    points = np.concatenate([shapely.get_coordinates(part) for part in parts])
    vertices = shapely.points(points)
    depths = np.maximum(_from_boundary(vertices, a), _from_boundary(vertices, b))
    worst, widest = int(np.argmax(depths)), max(parts, key=_width)
    if _width(widest) > depths[worst]:
        return _width(widest), widest.representative_point().coords[0]
    return float(depths[worst]), (float(points[worst, 0]), float(points[worst, 1]))


def common_parts(a: Any, b: Any, allowed: float) -> list[Any]:
    """The polygons that two regions have in common.

    Where faces coincide to rounding, GEOS 3.14 may answer with all of one region: what is common lies in both, to `allowed` m.
    """
    import shapely

    parts = np.array([part for part in shapely.get_parts(shapely.intersection(a, b)) if part.area > 0.0], object)
    inside = shapely.point_on_surface(parts)
    for region in (a, b):
        shapely.prepare(region)
    return list(parts[shapely.dwithin(a, inside, allowed) & shapely.dwithin(b, inside, allowed)])


def _from_boundary(points: Any, region: Any) -> Floats:
    """Distances of points from the boundary of a region; by an index, for outlines that coincide have thousands in common."""
    import shapely

    ends, ring = shapely.get_coordinates(shapely.get_parts(region.boundary), return_index=True)
    edges = shapely.linestrings(np.stack([ends[:-1], ends[1:]], axis=1)[ring[:-1] == ring[1:]])
    found: tuple[Any, Floats] = shapely.STRtree(edges).query_nearest(points, return_distance=True, all_matches=False)
    return found[1]


def _width(region: Any) -> float:
    return 2.0 * float(region.area) / float(region.length)


def face_depth(face: Floats, edges: tuple[Edge, ...], shape: Any, allowed: float) -> tuple[float, Point]:
    """How far a region, or another face, that straddles an open face reaches behind it, counting only what lies beside an edge.

    0 for a touch, negative for none.
    """
    import shapely

    line = face_line(face)
    if shape.is_empty or line.distance(shape) > allowed:
        return -1.0, (0.0, 0.0)
    best, place = 0.0, shapely.shortest_line(line, shape).coords[0]
    if not line.intersects(shape):
        return best, place
    points = shapely.get_coordinates(shape)
    for edge in edges:
        if face_line(chord_points(Loop((edge,), closed=False), COARSE)).distance(shape) > 2.0 * COARSE:
            continue
        beside, behind = _behind_arc(edge, points) if isinstance(edge, Arc) else _behind_line(edge, points)
        behind = np.where(beside, behind, -math.inf)
        worst = int(np.argmax(behind))
        if behind[worst] > best:
            best, place = float(behind[worst]), (float(points[worst, 0]), float(points[worst, 1]))
    return best, place


def corner_depth(face: Floats, part: Any) -> tuple[float, Point]:
    """How deep a corner of an open face lies in a part of some material, and where.

    Negative where none lies in it, or an end does: the part has come round it.
    """
    import shapely

    corners = shapely.points(face)
    inside = shapely.contains(part, corners)
    if inside[[0, -1]].any() or not inside.any():
        return -1.0, (0.0, 0.0)
    depths = np.where(inside, shapely.distance(corners, part.boundary), -1.0)
    worst = int(depths.argmax())
    return float(depths[worst]), (float(face[worst, 0]), float(face[worst, 1]))


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
