"""Do two layers overlap at some of many instants, by more than a given depth?

Both are polygons of chords. One is shrunk by that depth and stays where it is (prepared once); stretches of the other's outline
are brought to it, those alone that come near. Nothing here is shared with the gap functions of contacts. Points and poses are
complex numbers: a pose is (place of the frame's origin, turn of unit size).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.mechanism.material_polygons import material, placed
from watchsim.mechanism.overlap_depth import face_depth, regions_depth
from watchsim.scene.force import Side
from watchsim.simulation.record.layer_outlines import Outlines, as_complex, outlines_of, shrunk_material

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Poses = tuple[Complex, Complex]
Bits = NDArray[np.bool_]
Integers = NDArray[np.int64]

MOST = 1 << 21  # distances of stretches worked out at once


class PairOfLayers:
    """The two sides of a declared contact."""

    def __init__(self, contact: int, sides: tuple[Side, Side], loops: tuple[tuple[Loop, ...], ...], chord: float):
        self.contact, self.sides, self._loops = contact, sides, loops
        self._outlines = [outlines_of(one, chord) for one in loops]
        # The larger side stays where it is.
        self._still = int(self._outlines[1].points > self._outlines[0].points)
        still, mover = self._outlines[self._still], self._outlines[1 - self._still]
        self._reach = np.square(mover.radii[:, None] + still.radii)  # of two stretches that come near
        self._swallows = still.radius <= mover.radius  # can the mover hold the other within?

    def overlapping(self, poses: tuple[Poses, Poses], depth: float) -> Integers:
        """At which instants they overlap by more than `depth` (m); `poses` of both bodies, by instant."""
        still, mover = self._outlines[self._still], self._outlines[1 - self._still]
        (origin, turn), (place, turned) = poses[self._still], poses[1 - self._still]
        back = turn.conj()
        shift, twist = (place - origin) * back, turned * back
        near = np.abs(twist * mover.centre + shift - still.centre) <= still.radius + mover.radius
        places = np.flatnonzero(near)
        if not len(places):
            return places
        # Two bodies at rest on each other are looked at once.
        shift, twist = shift[places], twist[places]
        moved = np.append(True, (shift[1:] != shift[:-1]) | (twist[1:] != twist[:-1]))
        hit = self._overlap((shift[moved], twist[moved]), depth)
        return places[hit[np.cumsum(moved) - 1]]

    def _overlap(self, seen: Poses, depth: float) -> Bits:
        """Whether they overlap where the mover's frame stands so in the other one's."""
        still, mover = self._outlines[self._still], self._outlines[1 - self._still]
        shrunk = shrunk_material(still, depth)
        hit = self._crossing(shrunk, *seen) | self._within(shrunk, mover, seen)
        if self._swallows:
            hit |= self._within(shrunk_material(mover, depth), still, _inverse(seen))
        if still.faces or mover.faces:
            hit |= self._behind(self._still, _inverse(seen), depth) | self._behind(1 - self._still, seen, depth)
        return hit

    def _crossing(self, shrunk: Any, shift: Complex, twist: Complex) -> Bits:
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
            hit[instant[shapely.intersects(shrunk, lines)]] = True
        return hit

    @staticmethod
    def _within(shrunk: Any, other: Outlines, seen: Poses) -> Bits:
        """Does a ring of the other lie wholly within the shrunk material? One point of it says so, where nothing crosses."""
        import shapely

        at = seen[1][:, None] * other.starts + seen[0][:, None]
        within: Bits = shapely.intersects_xy(shrunk, at.real, at.imag).any(axis=1)
        return within

    def _behind(self, side: int, seen: Poses, depth: float) -> Bits:
        """Does something of the other side reach behind the open faces of this one, between their ends?"""
        import shapely

        hit = np.zeros(len(seen[0]), bool)
        whole = shrunk_material(self._outlines[1 - side], 0.0)
        for face in self._outlines[side].shifted_faces(depth):
            at = seen[1][:, None] * as_complex(face) + seen[0][:, None]
            lines, ends = shapely.linestrings(_real(at)), at[:, [0, -1]]
            for part in shapely.get_parts(whole):
                # What hangs over an end of the face has come round it.
                round_it = shapely.intersects_xy(part, ends.real, ends.imag).any(axis=1)
                hit |= shapely.intersects(part, lines) & ~round_it
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


Pairs = tuple[PairOfLayers, ...]
_last: list[tuple[Any, float, Pairs]] = []  # the scene asked about last, which most often is the next one


def declared_pairs(scene: Any, chord: float) -> Pairs:
    """The two sides of every declared contact whose bodies can move against each other."""
    if not _last or _last[0][0] is not scene or _last[0][1] != chord:
        _last[:] = [(scene, chord, tuple(_pairs(scene, chord)))]
    return _last[0][2]


def _pairs(scene: Any, chord: float) -> Iterator[PairOfLayers]:
    for number, contact in enumerate(scene.contacts):
        bodies = [scene.body(side.body) for side in contact.sides]
        loops = tuple(
            tuple(loop for loop in body.loops if side.layer in (None, loop.layer))
            for body, side in zip(bodies, contact.sides, strict=True)
        )
        if all(loops):
            yield PairOfLayers(number, contact.sides, loops, chord)
