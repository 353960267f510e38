"""Which bodies touch at the start, and which stand inside each other?

Contact laws push bodies apart from a touch, not out of each other: a scene must begin with all declared pairs open or
touching. Numbers of drawings and scenes are rounded: what overlaps by no more than `DRAWING_ROUNDING` touches, what overlaps
by more is a fault. Outlines are compared as polygons of chords that are fine where the two come close.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loops import Loop, chords, extents, polyline
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.mechanism.compile import scene_size
from watchsim.scene.errors import Fault
from watchsim.scene.forces import Side
from watchsim.scene.scene import Scene
from watchsim.scene.toml import key_lines
from watchsim.scene.trains import start_poses
from watchsim.tolerances import CHORDS_APART, CHORDS_NEAR, DRAWING_ROUNDING, LARGEST_DRAWN, NEAR_CHORDS, SMALLEST_DRAWN
from watchsim.units import show

# Which polygons stand for the material that some outlines bound?
#
# Arcs become chords. Polygons of chords serve wherever a check must share nothing with the gap functions of contacts.

Floats = NDArray[np.float64]
Bits = NDArray[np.bool_]


@functools.lru_cache(maxsize=512)
def chord_points(loop: Loop, deviation: float) -> Floats:
    """(chords + 1, 2) points of the loop in metres, read-only, no chord further than `deviation` from its arc."""
    points = polyline(loop, deviation)
    points.flags.writeable = False
    return points


def refined_points(loop: Loop, coarse: float, near: Bits, fine: float) -> tuple[Floats, float]:
    """`chord_points` of deviation `coarse`, in which the chords marked `near` are split until they deviate by at most `fine`.

    Returns the points and the largest deviation (m) of the chords that were marked.
    """
    parts, worst, at = [], 0.0, 0
    for edge in loop.edges:
        count = chords(edge, coarse) if isinstance(edge, Arc) else 1
        flags = near[at : at + count]
        at += count
        if not isinstance(edge, Arc):
            parts.append(np.array([edge.start]))
            continue
        step = abs(edge.sweep) / count
        pieces = max(1, math.ceil(step * math.sqrt(edge.radius / (8.0 * fine))))
        number = np.where(flags, pieces, 1)
        place = np.repeat(np.arange(count), number)
        nth = np.arange(len(place)) - np.repeat(np.cumsum(number) - number, number)
        angles = edge.start_angle + edge.sweep * (place + nth / number[place]) / count
        parts.append(np.column_stack((edge.x + edge.radius * np.cos(angles), edge.y + edge.radius * np.sin(angles))))
        if flags.any():
            worst = max(worst, edge.radius * (step / pieces) ** 2 / 8.0)
    end = parts[0][:1] if loop.closed else np.array([loop.edges[-1].end])
    return np.concatenate([*parts, end]), worst


def material(rings: Sequence[tuple[Floats, bool]]) -> list[Any]:
    """Polygons, each an outer ring without the holes that lie directly in it; `rings`: points, and whether it is a hole."""
    import shapely

    outers = [shapely.Polygon(points) for points, hole in rings if not hole]
    holes: list[list[Floats]] = [[] for _ in outers]
    for points, hole in rings:
        if hole:
            inside = shapely.Polygon(points).representative_point()
            around = [i for i, outer in enumerate(outers) if outer.covers(inside)]
            if around:
                holes[min(around, key=lambda i: outers[i].area)].append(points)
    pierced = [shapely.Polygon(outer.exterior, inner) if inner else outer for outer, inner in zip(outers, holes, strict=True)]
    return [polygon if polygon.is_valid else polygon.buffer(0.0) for polygon in pierced]


def placed(points: Floats, pose: tuple[float, float, float]) -> Floats:
    """Points of a body's frame that stands at `pose` (x, y, angle), in the movement."""
    x, y, angle = pose
    c, s = math.cos(angle), math.sin(angle)
    return np.column_stack((c * points[:, 0] - s * points[:, 1] + x, s * points[:, 0] + c * points[:, 1] + y))


# How deep do two regions of material overlap, or a region and an open face?


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
        coarse = max(CHORDS_APART, CHORDS_APART / LARGEST_DRAWN * edge.radius) if isinstance(edge, Arc) else CHORDS_APART
        if face_line(chord_points(Loop((edge,), closed=False), coarse)).distance(shape) > 2.0 * coarse:
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


Pose = tuple[float, float, float]
SIDES = np.array([-1.0, -1.0, 1.0, 1.0])  # what widens a box (xmin, ymin, xmax, ymax)


@dataclass(frozen=True, slots=True)
class Overlap:
    """Where two layers of contact number `contact` overlap most: depth (m), place (m, in the movement); depth 0: they touch.

    `allowed` is the depth up to which they count as touching: the rounding of the drawing and the error of the chords.
    """

    contact: int
    sides: tuple[Side, Side]
    depth: float
    place: Point
    allowed: float = DRAWING_ROUNDING

    def __str__(self) -> str:
        first, second = self.sides
        x, y = (f"{1e3 * value:.4g}" for value in self.place)
        layers = f"layers {first.layer} and {second.layer}"
        return f"{first.body} and {second.body} overlap by {1e3 * self.depth:.3g} mm at the start, at ({x}, {y}) mm ({layers})"


_last: tuple[Scene | None, tuple[Overlap, ...]] = (None, ())


def meetings(scene: Scene) -> tuple[Overlap, ...]:
    """Every two layers of a declared contact that touch or overlap at the start. The last scene's are remembered."""
    global _last  # noqa: PLW0603  # a command checks the scene that it then simulates
    if _last[0] is not scene:
        _last = scene, tuple(_meetings(scene))
    return _last[1]


def overlaps(scene: Scene) -> list[Overlap]:
    """The deepest overlap of every declared contact whose outlines overlap at the start by more than rounding."""
    deepest: dict[int, Overlap] = {}
    for met in meetings(scene):
        if met.depth > met.allowed and (met.contact not in deepest or met.depth > deepest[met.contact].depth):
            deepest[met.contact] = met
    return list(deepest.values())


def overlap_faults(scene: Scene) -> list[Fault]:
    """The same as faults of the scene file; what frees the bodies is left to `check`, since studies ask this of each point."""
    return faults_at(scene, ((overlap, f"{overlap}. Move or turn one of them") for overlap in overlaps(scene)))


TURNS = (0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0)  # °: tried in either direction


def cure_of(scene: Scene, overlap: Overlap) -> str:
    """What to do about it: an angle at which a body is free, where one of some small turns makes it so."""
    before = {one.contact for one in overlaps(scene)}
    bodies = [scene.body(side.body) for side in overlap.sides]
    geared = {name for gear in (*scene.gears, *scene.rigid_gears) for name in gear.between}
    turned = [body for body in bodies if body.motion == "pivot" and body.name not in geared]
    for degrees in (sign * turn for turn in TURNS for sign in (1.0, -1.0)):
        for body in turned:
            there = replace(body, angle=body.angle + math.radians(degrees))
            moved = replace(scene, bodies=tuple(there if one is body else one for one in scene.bodies))
            left = {one.contact for one in _meetings(moved) if one.depth > one.allowed}
            if overlap.contact not in left and left <= before:
                return f'Move or turn one of them; {body.name} is free at angle = "{show(there.angle, "°")}"'
    return "Move or turn one of them"


def faults_at(scene: Scene, found: Iterable[tuple[Overlap, str]]) -> list[Fault]:
    """Words about overlaps as faults of the scene file, at the position of a body that can be moved."""
    found = list(found)
    lines = key_lines(scene.path.read_text(encoding="utf-8-sig")) if found and scene.path and scene.path.is_file() else {}
    faults = []
    for overlap, words in found:
        moving = next((side.body for side in overlap.sides if scene.body(side.body).motion != "fixed"), overlap.sides[0].body)
        key = f"bodies.{moving}.position"
        line = lines.get(key) or lines.get(f"bodies.{moving}")
        place = f"{scene.path or 'scene'}:{line}" if line else str(scene.path or "scene")
        shown = f"`watchsim check {scene.path} --png FILE` shows where" if scene.path else "`watchsim check` shows where"
        faults.append(Fault(key, f"{words}; {shown}", place=place))
    return faults


def _grain(scene: Scene) -> float:
    """By how much coarser than usual a scene of its size is drawn, and looked at."""
    size = scene_size(scene)
    return size / min(max(size, SMALLEST_DRAWN), LARGEST_DRAWN)


def _meetings(scene: Scene) -> Iterator[Overlap]:
    poses, grain = start_poses(scene), _grain(scene)
    layers: dict[Side, _Layer] = {}
    for i, contact in enumerate(scene.contacts):
        sides = []
        for side in contact.sides:
            body = scene.body(side.body)
            names = (side.layer,) if side.layer else body.layers
            for own in (Side(body.name, name) for name in names):
                if own not in layers:
                    loops = tuple(loop for loop in body.loops if loop.layer == own.layer and loop.edges)
                    layers[own] = _Layer(own, loops, poses[body.name], grain)
            sides.append([layers[Side(body.name, name)] for name in names])
        for a in sides[0]:
            for b in sides[1]:
                met = _meeting(i, a, b)
                if met is not None:
                    yield met


LENS = 3  # points of an arc and its chord seen from afar: without area, and near to nothing


class _Layer:
    """The outlines of one layer where they stand at the start: their chords, and open faces.

    `grain`: see `_grain`; of a scene that is large for one body, the others are looked at as finely as they are drawn.
    """

    def __init__(self, side: Side, loops: tuple[Loop, ...], pose: Pose, grain: float) -> None:
        self.side, self.loops, self.pose = side, loops, pose
        box = extents(loops) or (0.0, 0.0, 0.0, 0.0)
        self.grain = grain = min(grain, max(1.0, math.dist(box[:2], box[2:]) / LARGEST_DRAWN))
        coarse = CHORDS_APART * grain
        self.points = [placed(chord_points(loop, coarse), pose) for loop in loops]
        low = [np.minimum(points[1:], points[:-1]) for points in self.points]
        high = [np.maximum(points[1:], points[:-1]) for points in self.points]
        none = np.zeros((0, 2))
        # Boxes around the chords, wide enough for their arcs.
        self.boxes = np.hstack([np.concatenate([none, *low]) - coarse, np.concatenate([none, *high]) + coarse])
        ends = self.boxes[:, :2].min(axis=0, initial=math.inf), self.boxes[:, 2:].max(axis=0, initial=-math.inf)
        self.box: Floats = np.concatenate(ends)

    def finely(self, near: NDArray[np.bool_]) -> tuple[Any, list[tuple[Floats, tuple[Edge, ...]]], float]:
        """(region of material, open faces as points and edges, largest deviation of the chords marked `near`)."""
        import shapely

        rings, faces, worst, at = [], [], 0.0, 0
        for loop, coarse in zip(self.loops, self.points, strict=True):
            marked = near[at : at + len(coarse) - 1]
            at += len(coarse) - 1
            coarsely, fine = CHORDS_APART * self.grain, CHORDS_NEAR * self.grain
            points, error = refined_points(loop, coarsely, marked, fine) if marked.any() else (None, 0.0)
            points, worst = coarse if points is None else placed(points, self.pose), max(worst, error)
            if loop.closed and len(points) > LENS:
                rings.append((points, loop.hole))
            elif not loop.closed:
                faces.append((points, loop.moved(self.pose[2], self.pose[:2]).edges))
        return shapely.union_all(material(rings)), faces, worst


def _meeting(contact: int, a: _Layer, b: _Layer) -> Overlap | None:
    """The deepest point at which two layers touch or overlap; None where they are apart."""
    import shapely

    rounding = DRAWING_ROUNDING * min(a.grain, b.grain)
    if not _meet(a.box[None], b.box[None] + rounding * SIDES)[0]:  # of nothing at all it is empty
        return None
    (region_a, faces_a, error_a), (region_b, faces_b, error_b) = (
        layer.finely(near) for layer, near in zip((a, b), _near(a, b), strict=True)
    )
    allowed = rounding + error_a + error_b
    found = [regions_depth(region_a, region_b, allowed)]
    for faces, region, others in ((faces_a, region_b, faces_b), (faces_b, region_a, faces_a)):
        for points, edges in faces:
            found += [
                face_depth(points, edges, shape, allowed) for shape in (region, *(face_line(other) for other, _ in others))
            ]
            found += [corner_depth(points, part) for part in shapely.get_parts(region)]
    depth, place = max(found)
    return Overlap(contact, (a.side, b.side), depth, place, allowed) if depth >= 0.0 else None


def _meet(boxes: Floats, box: Floats) -> NDArray[np.bool_]:
    """Which boxes (xmin, ymin, xmax, ymax) meet the other one."""
    return np.asarray(((boxes[:, :2] <= box[:, 2:]) & (boxes[:, 2:] >= box[:, :2])).all(axis=1))


def _near(a: _Layer, b: _Layer) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which chords of either layer come close to one of the other."""
    import shapely

    marks = np.zeros(len(a.boxes), bool), np.zeros(len(b.boxes), bool)
    margin = NEAR_CHORDS * max(a.grain, b.grain) * SIDES
    wide = a.boxes + margin
    inside_a, inside_b = np.flatnonzero(_meet(wide, b.box[None])), np.flatnonzero(_meet(b.boxes, a.box[None] + margin))
    if len(inside_a) and len(inside_b):
        tree = shapely.STRtree(shapely.box(*wide[inside_a].T))
        found_b, found_a = tree.query(shapely.box(*b.boxes[inside_b].T))
        marks[0][inside_a[found_a]], marks[1][inside_b[found_b]] = True, True
    return marks
