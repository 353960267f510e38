"""Which bodies touch at the start, and which stand inside each other?

Contact laws push bodies apart from a touch, not out of each other: a scene must begin with all declared pairs open or
touching. Numbers of drawings and scenes are rounded: what overlaps by no more than `DRAWING_ROUNDING` touches, what overlaps
by more is a fault. Outlines are compared as polygons of chords that are fine where the two come close.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Point
from watchsim.mechanism.material_polygons import chord_points, material, placed, refined_points
from watchsim.mechanism.overlap_depth import COARSE, corner_depth, face_depth, face_line, regions_depth
from watchsim.scene.carriers import start_poses
from watchsim.scene.errors import Fault
from watchsim.scene.file.keys.locate import key_lines
from watchsim.scene.force import Side
from watchsim.scene.scene import Scene
from watchsim.tolerances import DRAWING_ROUNDING

Floats = NDArray[np.float64]
Pose = tuple[float, float, float]
DEVIATION = 0.1e-9  # m, of chords near the other outline; too large: depths are uncertain; too small: slow
SIDES = np.array([-1.0, -1.0, 1.0, 1.0])  # what widens a box (xmin, ymin, xmax, ymax)
CLOSE = 1e-6  # m, between chords of two outlines that count as near


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
    """The same as faults of the scene file."""
    return faults_at(scene, ((overlap, f"{overlap}. Move or turn one of them") for overlap in overlaps(scene)))


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


def _meetings(scene: Scene) -> Iterator[Overlap]:
    poses = start_poses(scene)
    layers: dict[Side, _Layer] = {}
    for i, contact in enumerate(scene.contacts):
        sides = []
        for side in contact.sides:
            body = scene.body(side.body)
            names = (side.layer,) if side.layer else body.layers
            for own in (Side(body.name, name) for name in names):
                if own not in layers:
                    loops = tuple(loop for loop in body.loops if loop.layer == own.layer and loop.edges)
                    layers[own] = _Layer(own, loops, poses[body.name])
            sides.append([layers[Side(body.name, name)] for name in names])
        for a in sides[0]:
            for b in sides[1]:
                met = _meeting(i, a, b)
                if met is not None:
                    yield met


class _Layer:
    """The outlines of one layer where they stand at the start: their chords, and open faces."""

    def __init__(self, side: Side, loops: tuple[Loop, ...], pose: Pose) -> None:
        self.side, self.loops, self.pose = side, loops, pose
        self.points = [placed(chord_points(loop, COARSE), pose) for loop in loops]
        low = [np.minimum(points[1:], points[:-1]) for points in self.points]
        high = [np.maximum(points[1:], points[:-1]) for points in self.points]
        none = np.zeros((0, 2))
        # Boxes around the chords, wide enough for their arcs.
        self.boxes = np.hstack([np.concatenate([none, *low]) - COARSE, np.concatenate([none, *high]) + COARSE])
        ends = self.boxes[:, :2].min(axis=0, initial=math.inf), self.boxes[:, 2:].max(axis=0, initial=-math.inf)
        self.box: Floats = np.concatenate(ends)

    def finely(self, near: NDArray[np.bool_]) -> tuple[Any, list[tuple[Floats, tuple[Edge, ...]]], float]:
        """(region of material, open faces as points and edges, largest deviation of the chords marked `near`)."""
        import shapely

        rings, faces, worst, at = [], [], 0.0, 0
        for loop, coarse in zip(self.loops, self.points, strict=True):
            marked = near[at : at + len(coarse) - 1]
            at += len(coarse) - 1
            points, error = refined_points(loop, COARSE, marked, DEVIATION) if marked.any() else (None, 0.0)
            points, worst = coarse if points is None else placed(points, self.pose), max(worst, error)
            if loop.closed:
                rings.append((points, loop.hole))
            else:
                faces.append((points, loop.moved(self.pose[2], self.pose[:2]).edges))
        return shapely.union_all(material(rings)), faces, worst


def _meeting(contact: int, a: _Layer, b: _Layer) -> Overlap | None:
    """The deepest point at which two layers touch or overlap; None where they are apart."""
    import shapely

    if not _meet(a.box[None], b.box[None] + DRAWING_ROUNDING * SIDES)[0]:  # of nothing at all it is empty
        return None
    (region_a, faces_a, error_a), (region_b, faces_b, error_b) = (
        layer.finely(near) for layer, near in zip((a, b), _near(a, b), strict=True)
    )
    allowed = DRAWING_ROUNDING + error_a + error_b
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
    wide = a.boxes + CLOSE * SIDES
    inside_a, inside_b = np.flatnonzero(_meet(wide, b.box[None])), np.flatnonzero(_meet(b.boxes, a.box[None] + CLOSE * SIDES))
    if len(inside_a) and len(inside_b):
        tree = shapely.STRtree(shapely.box(*wide[inside_a].T))
        found_b, found_a = tree.query(shapely.box(*b.boxes[inside_b].T))
        marks[0][inside_a[found_a]], marks[1][inside_b[found_b]] = True, True
    return marks
