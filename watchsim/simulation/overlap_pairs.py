"""Do two layers overlap at some of many instants, by more than a given depth?

Both are polygons of chords. One is shrunk by that depth and stays where it is (prepared once); stretches of the other's outline
are brought to it, those alone that come near. Nothing here is shared with the gap functions of contacts.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.mechanism.force import Side
from watchsim.mechanism.overlap import face_depth, regions_depth
from watchsim.mechanism.polygons import chord_points, material, placed

Array = NDArray[np.float64]
Bits = NDArray[np.bool_]
Integers = NDArray[np.int64]

STRETCH = 16  # chords of an outline that are brought along together
MOST = 1 << 21  # distances of stretches worked out at once


@dataclass(frozen=True)
class Outlines:
    """One layer, or all of a body's, in the body's frame (m): rings around material with a word for holes, and open faces."""

    rings: tuple[tuple[Array, bool], ...]
    faces: tuple[Array, ...]
    stretches: Array  # (stretches, STRETCH + 1, 2) points of the rings, the last ones repeated
    centres: Array  # (stretches, 2) of circles around them
    radii: Array
    centre: Array  # of a circle around everything
    radius: float

    @property
    def points(self) -> int:
        return sum(len(points) for points, _ in self.rings)

    def shrunk(self, depth: float) -> list[Any]:
        """Its material, shrunk by `depth`, as prepared polygons; corners stay sharp."""
        import shapely

        polygons = material([(_shifted(points, depth, closed=True), hole) for points, hole in self.rings])
        polygons = [polygon for polygon in polygons if not polygon.is_empty]
        for polygon in polygons:
            shapely.prepare(polygon)
        return polygons

    def shifted_faces(self, depth: float) -> list[Array]:
        """Its open faces, `depth` further inside their material."""
        return [_shifted(points, depth, closed=False) for points in self.faces]


@functools.lru_cache(maxsize=256)
def outlines_of(loops: tuple[Loop, ...], deviation: float) -> Outlines:
    """Outlines with chords no further than `deviation` (m) from their arcs."""
    drawn = [(chord_points(loop, deviation), loop) for loop in loops if loop.edges]
    rings = tuple((points, loop.hole) for points, loop in drawn if loop.closed)
    faces = tuple(points for points, loop in drawn if not loop.closed)
    parts = [np.zeros((0, STRETCH + 1, 2))]
    for points, _ in rings:
        count = -(-(len(points) - 1) // STRETCH)
        parts.append(points[np.minimum(np.arange(count)[:, None] * STRETCH + np.arange(STRETCH + 1), len(points) - 1)])
    stretches = np.concatenate(parts)
    centres = 0.5 * (stretches.min(axis=1) + stretches.max(axis=1))
    radii = np.hypot(*(stretches - centres[:, None]).transpose(2, 0, 1)).max(axis=1, initial=0.0)
    every = np.concatenate([np.zeros((0, 2)), *(points for points, _ in rings), *faces])
    if not len(every):
        return Outlines(rings, faces, stretches, centres, radii, np.zeros(2), -np.inf)
    centre = 0.5 * (every.min(axis=0) + every.max(axis=0))
    return Outlines(rings, faces, stretches, centres, radii, centre, float(np.hypot(*(every - centre).T).max()))


@functools.lru_cache(maxsize=256)
def _shrunk(loops: tuple[Loop, ...], deviation: float, depth: float) -> list[Any]:
    return outlines_of(loops, deviation).shrunk(depth)


def _shifted(points: Array, depth: float, closed: bool) -> Array:
    """The chain of chords, each moved by `depth` to its left, where the material is."""
    points = points[np.append(True, np.any(np.diff(points, axis=0) != 0.0, axis=1))]
    along = np.diff(points, axis=0)
    left = np.column_stack((-along[:, 1], along[:, 0])) / np.hypot(*along.T)[:, None]
    before, after = (left[-1:], left[:1]) if closed else (left[:1], left[-1:])
    one, two = np.concatenate([before, left]), np.concatenate([left, after])
    # Where the outline turns back on itself the corner of the shifted chords would lie nowhere.
    bend = np.maximum(1.0 + (one * two).sum(axis=1), 0.02)
    return points + depth * (one + two) / bend[:, None]


class PairOfLayers:
    """The two sides of a declared contact."""

    def __init__(self, contact: int, sides: tuple[Side, Side], loops: tuple[tuple[Loop, ...], ...], depth: float, chord: float):
        self.contact, self.sides, self._loops, self._chord = contact, sides, loops, chord
        self._outlines = [outlines_of(one, chord) for one in loops]
        # The larger side stays where it is.
        self._still = int(self._outlines[1].points > self._outlines[0].points)
        self.depth = depth
        self.look_for(depth)

    def look_for(self, depth: float) -> None:
        """Overlaps deeper than `depth` (m) count from now on."""
        self.depth = depth
        self._shrunk = [_shrunk(loops, self._chord, depth) for loops in self._loops]
        self._whole = [
            _shrunk(loops, self._chord, 0.0) if any(o.faces for o in self._outlines) else [] for loops in self._loops
        ]
        self._faces = [outlines.shifted_faces(depth) for outlines in self._outlines]

    def overlapping(self, poses: tuple[Array, Array]) -> Integers:
        """At which instants they overlap; `poses` of both bodies, (instants, 3)."""
        still, mover = self._outlines[self._still], self._outlines[1 - self._still]
        seen = _seen_from(poses[self._still], poses[1 - self._still])
        near = np.hypot(*(_turned(seen, mover.centre) - still.centre).T) <= still.radius + mover.radius
        places = np.flatnonzero(near)
        if not len(places):
            return places
        seen, back = seen[places], _seen_from(poses[1 - self._still][places], poses[self._still][places])
        hit = self._crossing(seen)
        hit |= self._within(self._shrunk[self._still], mover, seen) | self._within(self._shrunk[1 - self._still], still, back)
        if still.faces or mover.faces:
            hit |= self._behind(self._still, back) | self._behind(1 - self._still, seen)
        return places[hit]

    def _crossing(self, seen: Array) -> Bits:
        """Does some of the moved outline lie in the shrunk material of the other?"""
        import shapely

        still, mover = self._outlines[self._still], self._outlines[1 - self._still]
        hit = np.zeros(len(seen), bool)
        size = max(1, len(mover.radii) * len(still.radii))
        for first in range(0, len(seen), max(1, MOST // size)):
            part = seen[first : first + max(1, MOST // size)]
            centres = _turned(part, mover.centres)  # (instants, stretches, 2)
            way = centres[:, :, None, :] - still.centres
            near = (way * way).sum(axis=3) <= (mover.radii[:, None] + still.radii) ** 2
            instant, stretch = np.nonzero(near.any(axis=2))
            if not len(instant):
                continue
            lines = shapely.linestrings(_turned_each(part[instant], mover.stretches[stretch]))
            for polygon in self._shrunk[self._still]:
                hit[first + instant[shapely.intersects(polygon, lines)]] = True
        return hit

    @staticmethod
    def _within(polygons: list[Any], other: Outlines, seen: Array) -> Bits:
        """Does a ring of the other lie wholly within one of the polygons? One point of it says so, where nothing crosses."""
        import shapely

        hit = np.zeros(len(seen), bool)
        starts = np.array([points[0] for points, hole in other.rings if not hole]).reshape(-1, 2)
        if len(starts) and polygons:
            at = _turned(seen, starts)
            for polygon in polygons:
                hit |= shapely.intersects_xy(polygon, at[..., 0], at[..., 1]).any(axis=1)
        return hit

    def _behind(self, side: int, seen: Array) -> Bits:
        """Does something of the other side reach behind the open faces of this one, between their ends?"""
        import shapely

        hit = np.zeros(len(seen), bool)
        for face in self._faces[side]:
            lines = shapely.linestrings(_turned(seen, face))
            ends = _turned(seen, face[[0, -1]])
            for polygon in self._whole[1 - side]:
                # What hangs over an end of the face has come round it.
                round_it = shapely.intersects_xy(polygon, ends[..., 0], ends[..., 1]).any(axis=1)
                hit |= shapely.intersects(polygon, lines) & ~round_it
            for other in self._outlines[1 - side].faces:
                met = shapely.intersection(shapely.LineString(other), lines)
                hit |= shapely.get_num_geometries(met) >= 2
        return hit

    def deepest(self, poses: tuple[Array, Array]) -> tuple[float, Point]:
        """How deep they overlap (m) at one instant, and where in the movement; `poses` of both bodies, (3,)."""
        import shapely

        regions, faces = [], []
        for outlines, loops, pose in zip(self._outlines, self._loops, poses, strict=True):
            at = (float(pose[0]), float(pose[1]), float(pose[2]))
            regions.append(shapely.union_all(material([(placed(points, at), hole) for points, hole in outlines.rings])))
            edges = [loop.moved(at[2], at[:2]).edges for loop in loops if loop.edges and not loop.closed]
            faces.append([(placed(points, at), own) for points, own in zip(outlines.faces, edges, strict=True)])
        found = [regions_depth(regions[0], regions[1], 0.0)]
        for one, other in ((0, 1), (1, 0)):
            shapes = [regions[other], *(shapely.LineString(points) for points, _ in faces[other])]
            found += [face_depth(points, edges, shape, 0.0) for points, edges in faces[one] for shape in shapes]
        return max(found)


def _seen_from(frame: Array, other: Array) -> Array:
    """(instants, 4): where the other frame stands in the first one, x, y, cosine and sine of its angle; poses (instants, 3)."""
    c, s = np.cos(frame[:, 2]), np.sin(frame[:, 2])
    dx, dy = (other - frame)[:, :2].T
    turn = other[:, 2] - frame[:, 2]
    return np.column_stack((c * dx + s * dy, c * dy - s * dx, np.cos(turn), np.sin(turn)))


def _turned(seen: Array, points: Array) -> Array:
    """The same points (…, 2) at every instant, (instants, …, 2)."""
    shape = (-1,) + (1,) * (points.ndim - 1)
    x, y, c, s = (value.reshape(shape) for value in seen.T)
    return np.stack((c * points[..., 0] - s * points[..., 1] + x, s * points[..., 0] + c * points[..., 1] + y), axis=-1)


def _turned_each(seen: Array, points: Array) -> Array:
    """Points (rows, n, 2), each row at its own instant."""
    x, y, c, s = (value[:, None] for value in seen.T)
    return np.stack((c * points[..., 0] - s * points[..., 1] + x, s * points[..., 0] + c * points[..., 1] + y), axis=-1)


def declared_pairs(scene: Any, depth: float, chord: float) -> Iterator[PairOfLayers]:
    """The two sides of every declared contact whose bodies can move against each other."""
    for number, contact in enumerate(scene.contacts):
        bodies = [scene.body(side.body) for side in contact.sides]
        loops = tuple(
            tuple(loop for loop in body.loops if side.layer in (None, loop.layer))
            for body, side in zip(bodies, contact.sides, strict=True)
        )
        if all(loops):
            yield PairOfLayers(number, contact.sides, loops, depth, chord)
