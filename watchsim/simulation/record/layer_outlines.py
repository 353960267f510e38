"""How is a layer written so that its overlap with another one is soon found?

As chords; as stretches of them, each with a circle around it, for the sieve (overlap_sieve.py); and as the material within,
for the polygons (overlap_instants.py). The last two also shrunk by a depth.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.mechanism.material_polygons import chord_points, material
from watchsim.model.records import Records, records
from watchsim.simulation.record.overlap_sieve import STRETCH

Array = NDArray[np.float64]

CHORDS = 32  # of a ring in one stretch, at most
LONGEST = 1.0 / 4.0  # of an outline's size: longer chords are divided, longer stretches cut


@dataclass(frozen=True, eq=False)
class Outlines:
    """One layer, or all of a body's, in the body's frame (m): rings around material with a word for holes, and open faces."""

    rings: tuple[tuple[Array, bool], ...]
    faces: tuple[Array, ...]
    centre: tuple[float, float]  # of a circle around everything
    radius: float
    smallest: float  # radius of a circle around its smallest outer ring

    @property
    def points(self) -> int:
        return sum(len(points) for points, _ in self.rings)

    def shrunk_rings(self, depth: float) -> list[tuple[Array, bool]]:
        """Its rings, `depth` further inside the material; corners stay sharp."""
        return [(_shifted(points, depth, closed=True), hole) for points, hole in self.rings]

    def shifted_faces(self, depth: float) -> list[Array]:
        """Its open faces, `depth` further inside their material."""
        return [_shifted(points, depth, closed=False) for points in self.faces]


@functools.lru_cache(maxsize=256)
def outlines_of(loops: tuple[Loop, ...], deviation: float) -> Outlines:
    """Outlines with chords no further than `deviation` (m) from their arcs."""
    drawn = [(chord_points(loop, deviation), loop) for loop in loops if loop.edges]
    rings = tuple((points, loop.hole) for points, loop in drawn if loop.closed)
    faces = tuple(points for points, loop in drawn if not loop.closed)
    every = np.concatenate([np.zeros((0, 2)), *(points for points, _ in rings), *faces])
    if not len(every):
        return Outlines(rings, faces, (0.0, 0.0), -np.inf, np.inf)
    smallest = min((_circle(points)[1] for points, hole in rings if not hole), default=np.inf)
    return Outlines(rings, faces, *_circle(every), smallest)


def _circle(points: Array) -> tuple[tuple[float, float], float]:
    """Centre and radius of a circle around points."""
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return (float(middle[0]), float(middle[1])), float(np.hypot(*(points - middle).T).max())


@functools.lru_cache(maxsize=256)
def stretches_of(outlines: Outlines, depth: float) -> tuple[Records, Array]:
    """The rings, shrunk by `depth`, in stretches of CHORDS chords (STRETCH), and the points (n, 2) that these join."""
    rings = outlines.shrunk_rings(depth) if depth > 0.0 else outlines.rings
    longest = LONGEST * outlines.radius
    parts, firsts, lasts, begins, begun = [np.zeros((0, 2))], [], [], [], 0
    for ring, hole in rings:
        points = _divided(ring, longest)
        chords = len(points) - 1
        way = np.cumsum(np.hypot(*np.diff(points, axis=0).T)) // longest
        first = np.flatnonzero((np.arange(chords) % CHORDS == 0) | np.append(False, way[1:] != way[:-1]))
        firsts.append(begun + first)
        lasts.append(begun + np.append(first[1:], chords))
        begins.append((first == 0) & (not hole))
        parts.append(points)
        begun += len(points)
    joined = np.concatenate(parts)
    out = records(STRETCH, sum(map(len, firsts)))
    if len(out):
        out.first, out.last, out.begins = (np.concatenate(values) for values in (firsts, lasts, begins))
        _put_circles(out, joined)
    return out, joined


def _put_circles(stretches: Records, points: Array) -> None:
    """Fill in the circles around stretches, and their longest chords."""
    ends = np.column_stack([stretches.first, stretches.last + 1]).ravel()  # each second range is of no stretch
    more = np.concatenate([points, points[-1:]])
    low, high = np.minimum.reduceat(more, ends)[::2], np.maximum.reduceat(more, ends)[::2]
    stretches.x, stretches.y = (0.5 * (low + high)).T
    stretches.radius = 0.5 * np.hypot(*(high - low).T)
    chords = np.append(np.hypot(*np.diff(points, axis=0).T), 0.0)
    stretches.half = 0.5 * np.maximum.reduceat(chords, ends - [0, 1] * len(stretches))[::2]


def _divided(points: Array, longest: float) -> Array:
    """The same chain, with points on its chords so that none is longer than `longest` (m): circles around them are smaller."""
    pieces = np.maximum(1, np.ceil(np.hypot(*np.diff(points, axis=0).T) / longest)).astype(np.int64)
    chord = np.repeat(np.arange(len(pieces)), pieces)
    share = (np.arange(len(chord)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[chord]
    return np.concatenate([points[chord] + share[:, None] * np.diff(points, axis=0)[chord], points[-1:]])


@functools.lru_cache(maxsize=256)
def shrunk_material(outlines: Outlines, depth: float) -> Any:
    """Their material, shrunk by `depth`, as one prepared geometry."""
    import shapely

    found = shapely.union_all(material(outlines.shrunk_rings(depth)))
    shapely.prepare(found)
    return found


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
