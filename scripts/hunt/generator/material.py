"""How deep does material stand inside material? By shapely on the true outlines, without any gap function."""

from __future__ import annotations

from itertools import product

import numpy as np
import shapely
from numpy.typing import NDArray

from watchsim.geometry.loops import polyline
from watchsim.mechanism.overlap import overlaps
from watchsim.scene.scene import Body, Scene

DEVIATION = 1e-6  # of the scene's size: of the polylines for arcs
Poses = dict[str, tuple[float, float, float]]


class Material:
    """The outlines of a scene's bodies as polygons, each in its own frame. All loops must be outer outlines."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.size = reach(scene)
        self._points = {body.name: [polyline(loop, DEVIATION * self.size) for loop in body.loops] for body in scene.bodies}
        self._pairs = [(c.sides[0].body, c.sides[1].body) for c in scene.contacts]

    def depth(self, poses: Poses) -> float:
        """The deepest overlap of any two bodies that can touch, m; up to about `DEVIATION` of the size is none."""
        return self._worst(poses)[0]

    def at_start(self) -> tuple[float, float]:
        """The deepest overlap and the smallest distance at the start, m."""
        return self._worst({body.name: start_pose(body) for body in self.scene.bodies}, distances=True)

    def _worst(self, poses: Poses, distances: bool = False) -> tuple[float, float]:
        placed = {name: [shapely.Polygon(_placed(p, poses[name])) for p in loops] for name, loops in self._points.items()}
        deepest, nearest = 0.0, np.inf
        for first, second in self._pairs:
            for a, b in product(placed[first], placed[second]):
                if a.intersects(b):
                    deepest = max(deepest, _depth(a, b))
                if distances:
                    nearest = min(nearest, a.distance(b))
        return deepest, float(nearest)


def apart(scene: Scene) -> bool:
    """A coarse look first: the exact one draws arcs within half a nanometre."""
    material = Material(scene)
    depth, nearest = material.at_start()
    if depth > 1e-3 * material.size:
        return False
    return nearest > 1e-3 * material.size or not overlaps(scene)


def reach(scene: Scene) -> float:
    """The largest distance of an outline from its moving body's origin, m."""
    points = [polyline(loop, 1.0) for body in scene.bodies if body.motion != "fixed" for loop in body.loops]
    return max(float(np.hypot(p[:, 0], p[:, 1]).max()) for p in points)


def start_pose(body: Body) -> tuple[float, float, float]:
    return (*body.position, body.angle)


def _placed(points: NDArray[np.float64], pose: tuple[float, float, float]) -> NDArray[np.float64]:
    x, y, angle = pose
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]]) + np.array([x, y])


SLIVER = 16.0  # times area over circumference: more than the depth of any overlap that is not a sliver


def _depth(a: shapely.Polygon, b: shapely.Polygon) -> float:
    """How far the boundary of one reaches into the other; no more than a few times how thick the overlap is on average.

    Flush faces overlap by a sliver of rounding, whose corners shapely may put anywhere along them.
    """
    found = shapely.get_parts(shapely.intersection(a, b))
    inside = shapely.point_on_surface(found)
    # GEOS may take one polygon for what two flush ones have in common.
    common = shapely.union_all(found[(shapely.distance(inside, a) == 0.0) & (shapely.distance(inside, b) == 0.0)])
    if common.area == 0.0:
        return 0.0
    vertices = shapely.points(shapely.get_coordinates(common))
    reach = np.maximum(shapely.distance(vertices, a.boundary), shapely.distance(vertices, b.boundary)).max()
    return float(min(reach, SLIVER * common.area / common.length))
