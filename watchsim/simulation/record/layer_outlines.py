"""How is a layer written so that its overlap with another one is soon found?

As chords in stretches, each with a circle around it, and as the material within, shrunk by a depth. Points are complex numbers.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.mechanism.material_polygons import chord_points, material

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

STRETCH = 48  # chords of an outline that are brought along together


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
        parts.append(as_complex(points)[places])
    stretches = np.concatenate(parts)
    centres = _middle(stretches)
    radii = np.abs(stretches - centres[:, None]).max(axis=1, initial=0.0)
    starts = np.array([complex(*points[0]) for points, hole in rings if not hole], complex)
    every = np.concatenate([np.zeros(0, complex), *(as_complex(points) for points, _ in rings), *map(as_complex, faces)])
    if not len(every):
        return Outlines(rings, faces, starts, stretches, centres, radii, 0.0, -np.inf)
    centre = complex(_middle(every[None])[0])
    return Outlines(rings, faces, starts, stretches, centres, radii, centre, float(np.abs(every - centre).max()))


def as_complex(points: Array) -> Complex:
    return points[:, 0] + 1j * points[:, 1]


def _middle(rows: Complex) -> Complex:
    """The middle of the box around each row of points."""
    low, high = rows.real.min(axis=1) + 1j * rows.imag.min(axis=1), rows.real.max(axis=1) + 1j * rows.imag.max(axis=1)
    middle: Complex = 0.5 * (low + high)
    return middle


@functools.lru_cache(maxsize=256)
def shrunk_material(outlines: Outlines, depth: float) -> Any:
    """Their material, shrunk by `depth`, as one prepared geometry; corners stay sharp."""
    import shapely

    found = shapely.union_all(material([(_shifted(points, depth, closed=True), hole) for points, hole in outlines.rings]))
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
