"""Do two layers overlap at some of many instants, by more than a given depth?

Both are polygons of chords. One is shrunk by that depth and stays where it is (prepared once); stretches of the other's outline
are brought to it, those alone that come near. Nothing here is shared with the gap functions of contacts. Points and poses are
complex numbers: a pose is (place of the frame's origin, turn of unit size).
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
from watchsim.mechanism.material_polygons import chord_points, material, placed
from watchsim.mechanism.overlap_depth import face_depth, regions_depth
from watchsim.scene.force import Side

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Poses = tuple[Complex, Complex]
Bits = NDArray[np.bool_]
Integers = NDArray[np.int64]

STRETCH = 48  # chords of an outline that are brought along together
MOST = 1 << 21  # distances of stretches worked out at once


@dataclass(frozen=True, eq=False)
class Outlines:
    """One layer, or all of a body's, in the body's frame (m): rings around material with a word for holes, and open faces."""

    rings: tuple[tuple[Array, bool], ...]
    faces: tuple[Array, ...]
    starts: Complex  # a point of each outer ring
    stretches: Complex  # (stretches, STRETCH + 1) points of the rings, the last ones repeated
    centres: Complex  # (stretches,) of circles around them
    radii: Array
    centre: complex  # of a circle around everything
    radius: float

    @property
    def points(self) -> int:
        return sum(len(points) for points, _ in self.rings)

    def shifted_faces(self, depth: float) -> list[Array]:
        """Its open faces, `depth` further inside their material."""
        return [_shifted(points, depth, closed=False) for points in self.faces]


@functools.lru_cache(maxsize=256)
def outlines_of(loops: tuple[Loop, ...], deviation: float) -> Outlines:
    """Outlines with chords no further than `deviation` (m) from their arcs."""
    drawn = [(chord_points(loop, deviation), loop) for loop in loops if loop.edges]
    rings = tuple((points, loop.hole) for points, loop in drawn if loop.closed)
    faces = tuple(points for points, loop in drawn if not loop.closed)
    parts = [np.zeros((0, STRETCH + 1), complex)]
    for points, _ in rings:
        count = -(-(len(points) - 1) // STRETCH)
        places = np.minimum(np.arange(count)[:, None] * STRETCH + np.arange(STRETCH + 1), len(points) - 1)
        parts.append(_complex(points)[places])
    stretches = np.concatenate(parts)
    centres = _middle(stretches)
    radii = np.abs(stretches - centres[:, None]).max(axis=1, initial=0.0)
    starts = np.array([complex(*points[0]) for points, hole in rings if not hole], complex)
    every = np.concatenate([np.zeros(0, complex), *(_complex(points) for points, _ in rings), *map(_complex, faces)])
    if not len(every):
        return Outlines(rings, faces, starts, stretches, centres, radii, 0.0, -np.inf)
    centre = complex(_middle(every[None])[0])
    return Outlines(rings, faces, starts, stretches, centres, radii, centre, float(np.abs(every - centre).max()))


def _complex(points: Array) -> Complex:
    return points[:, 0] + 1j * points[:, 1]


def _middle(rows: Complex) -> Complex:
    """The middle of the box around each row of points."""
    low, high = rows.real.min(axis=1) + 1j * rows.imag.min(axis=1), rows.real.max(axis=1) + 1j * rows.imag.max(axis=1)
    middle: Complex = 0.5 * (low + high)
    return middle


@functools.lru_cache(maxsize=256)
def _shrunk(outlines: Outlines, depth: float) -> NDArray[Any]:
    """(polygons, 1): their material, shrunk by `depth`, as prepared polygons; corners stay sharp."""
    import shapely

    polygons = material([(_shifted(points, depth, closed=True), hole) for points, hole in outlines.rings])
    found = np.array([polygon for polygon in polygons if not polygon.is_empty], object)
    shapely.prepare(found)
    return found[:, None]


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
        self.contact, self.sides, self._loops = contact, sides, loops
        self._outlines = [outlines_of(one, chord) for one in loops]
        # The larger side stays where it is.
        self._still = int(self._outlines[1].points > self._outlines[0].points)
        still, mover = self._outlines[self._still], self._outlines[1 - self._still]
        self._reach = np.square(mover.radii[:, None] + still.radii)  # of two stretches that come near
        self.look_for(depth)

    def look_for(self, depth: float) -> None:
        """Overlaps deeper than `depth` (m) count from now on."""
        self._depth, self._drawn = depth, False

    def _draw(self) -> None:
        """Shrink the material by the depth; left until they first come near."""
        still, mover, depth = self._still, 1 - self._still, self._depth
        any_faces = any(outlines.faces for outlines in self._outlines)
        self._drawn = True
        nothing = np.zeros((0, 1), object)
        self._shrunk = [nothing, nothing]
        self._shrunk[still] = _shrunk(self._outlines[still], depth)
        if self._outlines[still].radius <= self._outlines[mover].radius:
            # Only then can the other one swallow it.
            self._shrunk[mover] = _shrunk(self._outlines[mover], depth)
        self._whole = [_shrunk(outlines, 0.0) if any_faces else nothing for outlines in self._outlines]
        self._faces = [outlines.shifted_faces(depth) for outlines in self._outlines]

    def overlapping(self, poses: tuple[Poses, Poses]) -> Integers:
        """At which instants they overlap; `poses` of both bodies, by instant."""
        still, mover = self._outlines[self._still], self._outlines[1 - self._still]
        (origin, turn), (place, turned) = poses[self._still], poses[1 - self._still]
        back = turn.conj()
        shift, twist = (place - origin) * back, turned * back
        near = np.abs(twist * mover.centre + shift - still.centre) <= still.radius + mover.radius
        places = np.flatnonzero(near)
        if not len(places):
            return places
        if not self._drawn:
            self._draw()
        seen = shift[places], twist[places]
        hit = self._crossing(*seen)
        hit |= self._within(self._shrunk[self._still], mover, seen)
        if len(self._shrunk[1 - self._still]):
            hit |= self._within(self._shrunk[1 - self._still], still, _inverse(seen))
        if still.faces or mover.faces:
            hit |= self._behind(self._still, _inverse(seen)) | self._behind(1 - self._still, seen)
        return places[hit]

    def _crossing(self, shift: Complex, twist: Complex) -> Bits:
        """Does some of the moved outline lie in the shrunk material of the other?"""
        import shapely

        still, mover = self._outlines[self._still], self._outlines[1 - self._still]
        hit = np.zeros(len(shift), bool)
        block = max(1, MOST // max(1, len(mover.radii) * len(still.radii)))
        for first in range(0, len(shift), block):
            at = slice(first, first + block)
            centres = twist[at, None] * mover.centres + shift[at, None]
            x, y = centres.real[:, :, None] - still.centres.real, centres.imag[:, :, None] - still.centres.imag
            instant, stretch = np.nonzero((x * x + y * y <= self._reach).any(axis=2))
            if not len(instant):
                continue
            instant += first
            lines = shapely.linestrings(_real(twist[instant, None] * mover.stretches[stretch] + shift[instant, None]))
            hit[instant[shapely.intersects(self._shrunk[self._still], lines).any(axis=0)]] = True
        return hit

    @staticmethod
    def _within(polygons: NDArray[Any], other: Outlines, seen: Poses) -> Bits:
        """Does a ring of the other lie wholly within one of the polygons? One point of it says so, where nothing crosses."""
        import shapely

        at = seen[1][:, None] * other.starts + seen[0][:, None]
        within: Bits = shapely.intersects_xy(polygons[:, :, None], at.real, at.imag).any(axis=(0, 2))
        return within

    def _behind(self, side: int, seen: Poses) -> Bits:
        """Does something of the other side reach behind the open faces of this one, between their ends?"""
        import shapely

        hit = np.zeros(len(seen[0]), bool)
        for face in self._faces[side]:
            at = seen[1][:, None] * _complex(face) + seen[0][:, None]
            lines, ends = shapely.linestrings(_real(at)), at[:, [0, -1]]
            for polygon in self._whole[1 - side][:, 0]:
                # What hangs over an end of the face has come round it.
                round_it = shapely.intersects_xy(polygon, ends.real, ends.imag).any(axis=1)
                hit |= shapely.intersects(polygon, lines) & ~round_it
            for other in self._outlines[1 - side].faces:
                met = shapely.intersection(shapely.LineString(other), lines)
                hit |= shapely.get_num_geometries(met) >= 2
        return hit

    def deepest(self, poses: tuple[Poses, Poses], instant: int) -> tuple[float, Point]:
        """How deep they overlap (m) at one of the instants, and where in the movement."""
        import shapely

        regions, faces = [], []
        for outlines, loops, (origin, turn) in zip(self._outlines, self._loops, poses, strict=True):
            place = complex(origin[instant])
            at = (place.real, place.imag, float(np.angle(turn[instant])))
            regions.append(shapely.union_all(material([(placed(points, at), hole) for points, hole in outlines.rings])))
            edges = [loop.moved(at[2], at[:2]).edges for loop in loops if loop.edges and not loop.closed]
            faces.append([(placed(points, at), own) for points, own in zip(outlines.faces, edges, strict=True)])
        found = [regions_depth(regions[0], regions[1], 0.0)]
        for one, other in ((0, 1), (1, 0)):
            shapes = [regions[other], *(shapely.LineString(points) for points, _ in faces[other])]
            found += [face_depth(points, edges, shape, 0.0) for points, edges in faces[one] for shape in shapes]
        return max(found)


def _inverse(seen: Poses) -> Poses:
    """Where the first frame stands in the second one."""
    shift, twist = seen
    back = twist.conj()
    return -shift * back, back


def _real(points: Complex) -> Array:
    """Points as (…, 2) coordinates."""
    return np.ascontiguousarray(points).view(np.float64).reshape(*points.shape, 2)


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
