"""Do two layers overlap at some of many instants, by more than a given depth?

Both are polygons of chords. A compiled sieve lets pass what stays away (overlap_sieve.py); of the rest polygons judge: one
layer is shrunk by that depth, and the other's outline must not reach into it. No gap function of a contact is asked.
Points and poses are complex numbers: a pose is (place of the frame's origin, turn of unit size).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.mechanism.material_polygons import material, placed
from watchsim.mechanism.overlap_depth import corner_depth, face_depth, regions_depth
from watchsim.model.records import Records, records
from watchsim.scene.force import Side
from watchsim.simulation.record.layer_outlines import CHORDS, Outlines, outlines_of, shrunk_material, stretches_of
from watchsim.simulation.record.overlap_sieve import PAIR, STRETCH, sieve

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Poses = tuple[Complex, Complex]
Bits = NDArray[np.bool_]
Integers = NDArray[np.int64]

MARGIN = 0.5  # of the depth: how near the shrunk outline the other one is left to the polygons


class PairOfLayers:
    """The two sides of a declared contact."""

    def __init__(self, contact: int, sides: tuple[Side, Side], loops: tuple[tuple[Loop, ...], ...], chord: float):
        self.contact, self.sides, self._loops = contact, sides, loops
        self._outlines = [outlines_of(one, chord) for one in loops]
        # The larger side stays where it is.
        self._is_second = int(self._outlines[1].points > self._outlines[0].points)
        self.still, self.mover = self._outlines[self._is_second], self._outlines[1 - self._is_second]
        self.bodies = sides[self._is_second].body, sides[1 - self._is_second].body
        self.swallows = self.still.smallest <= self.mover.radius  # can the mover hold a ring of the other within?
        self.has_faces = bool(self.still.faces or self.mover.faces)

    def overlapping(self, still: Array, mover: Array, depth: float) -> Bits:
        """Whether they overlap by more than `depth` (m); `still` and `mover` (instants, 3): x, y (m), angle (rad)."""
        back = np.exp(-1j * still[:, 2])
        shift = (mover[:, 0] - still[:, 0] + 1j * (mover[:, 1] - still[:, 1])) * back
        seen = shift, np.exp(1j * mover[:, 2]) * back
        hit = _reaches_into(self.mover, shrunk_material(self.still, depth), seen)
        if self.swallows:
            hit |= _reaches_into(self.still, shrunk_material(self.mover, depth), _inverse(seen))
        if self.has_faces:
            hit |= self._behind(self._is_second, _inverse(seen), depth) | self._behind(1 - self._is_second, seen, depth)
        return hit

    def _behind(self, side: int, seen: Poses, depth: float) -> Bits:
        """Does something of the other side reach behind the open faces of this one, between their ends?"""
        import shapely

        hit = np.zeros(len(seen[0]), bool)
        whole = shrunk_material(self._outlines[1 - side], 0.0)
        for face in self._outlines[side].shifted_faces(depth):
            at = seen[1][:, None] * (face[:, 0] + 1j * face[:, 1]) + seen[0][:, None]
            lines, ends = shapely.linestrings(_real(at)), at[:, [0, -1]]
            for part in shapely.get_parts(whole):
                # What hangs over an end of the face has come round it.
                round_it = shapely.intersects_xy(part, ends.real, ends.imag).any(axis=1)
                hit |= shapely.intersects(part, lines) & ~round_it
            for other in self._outlines[1 - side].faces:
                met = shapely.intersection(shapely.LineString(other), lines)
                hit |= shapely.get_num_geometries(met) >= 2
        return hit

    def deepest(self, where: Sequence[Array]) -> tuple[float, Point]:
        """How deep they overlap (m), and where in the movement; `where` the two bodies are: x, y (m), angle (rad)."""
        import shapely

        regions, faces = [], []
        for outlines, loops, at in zip(self._outlines, self._loops, where, strict=True):
            x, y, angle = at.tolist()
            rings = [(placed(points, (x, y, angle)), hole) for points, hole in outlines.rings]
            regions.append(shapely.union_all(material(rings)))
            edges = [loop.moved(angle, (x, y)).edges for loop in loops if loop.edges and not loop.closed]
            faces.append([(placed(points, (x, y, angle)), own) for points, own in zip(outlines.faces, edges, strict=True)])
        found = [regions_depth(regions[0], regions[1], 0.0)]
        for one, other in ((0, 1), (1, 0)):
            shapes = [regions[other], *(shapely.LineString(points) for points, _ in faces[other])]
            found += [face_depth(points, edges, shape, 0.0) for points, edges in faces[one] for shape in shapes]
            found += [corner_depth(points, part) for points, _ in faces[one] for part in shapely.get_parts(regions[other])]
        return max(found)


class Layers:
    """All pairs of layers of a scene."""

    def __init__(self, pairs: tuple[PairOfLayers, ...]) -> None:
        self.pairs = pairs
        self.bodies = sorted({side.body for pair in pairs for side in pair.sides})
        self._sieve: tuple[float, Records, Records, Array] | None = None  # depth, pairs, stretches, points
        self._room = np.zeros((CHORDS + 1, 2))

    def overlapping(self, where: Array, depth: float) -> Bits:
        """(pairs, instants): do they overlap by more than `depth` (m)?

        `where` (bodies, instants, 3): x, y (m) and angle (rad) of `bodies`.
        """
        if self._sieve is None or self._sieve[0] != depth:
            self._sieve = depth, *self._records(depth)
        found = np.zeros((len(self.pairs), where.shape[1]), bool)
        sieve(*self._sieve[1:], np.ascontiguousarray(where), MARGIN * depth, self._room, found)
        if found.any():
            for pair, left in zip(self.pairs, found, strict=True):
                still, mover = (where[self.bodies.index(body)][left] for body in pair.bodies)
                left[left] = pair.overlapping(still, mover, depth)
        return found

    def _records(self, depth: float) -> tuple[Records, Records, Array]:
        """What the sieve reads: pairs, stretches and points."""
        rows = records(PAIR, len(self.pairs))
        stretches, points = [records(STRETCH, 0)], [np.zeros((0, 2))]
        for row, pair in zip(rows, self.pairs, strict=True):
            row.still, row.mover = (self.bodies.index(body) for body in pair.bodies)
            (row.still_x, row.still_y), (row.mover_x, row.mover_y) = pair.still.centre, pair.mover.centre
            row.still_radius, row.mover_radius = pair.still.radius, pair.mover.radius
            row.swallows, row.open = pair.swallows, pair.has_faces
            for name, (some, joined) in (("still", stretches_of(pair.still, depth)), ("mover", stretches_of(pair.mover, 0.0))):
                first, before = sum(len(part) for part in stretches), sum(len(part) for part in points)
                row[f"{name}_first"], row[f"{name}_stop"] = first, first + len(some)
                moved = some.copy()
                moved.first += before
                moved.last += before
                stretches.append(moved)
                points.append(joined)
        return rows, np.concatenate(stretches).view(np.recarray), np.concatenate(points)


def _reaches_into(outlines: Outlines, shrunk: Any, seen: Poses) -> Bits:
    """Does a ring reach into some material, or lie within? `seen`: where its frame stands in the frame of the material."""
    import shapely

    hit = np.zeros(len(seen[0]), bool)
    for ring, hole in outlines.rings:
        at = seen[1][:, None] * (ring[:, 0] + 1j * ring[:, 1]) + seen[0][:, None]
        hit |= shapely.intersects(shrunk, shapely.linestrings(_real(at)))
        if not hole:
            # What nothing crosses lies wholly within where one of its points does.
            hit |= shapely.intersects_xy(shrunk, at[:, 0].real, at[:, 0].imag)
    return hit


def _inverse(seen: Poses) -> Poses:
    """Where the first frame stands in the second one."""
    shift, twist = seen
    back = twist.conj()
    return -shift * back, back


def _real(points: Complex) -> Array:
    """Points as (…, 2) coordinates."""
    return np.ascontiguousarray(points).view(np.float64).reshape(*points.shape, 2)


_last: list[tuple[Any, float, Layers]] = []  # the scene asked about last, which most often is the next one


def declared_pairs(scene: Any, chord: float) -> Layers:
    """The two sides of every declared contact whose bodies can move against each other."""
    if not _last or _last[0][0] is not scene or _last[0][1] != chord:
        _last[:] = [(scene, chord, Layers(tuple(_pairs(scene, chord))))]
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
