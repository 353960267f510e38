"""At which heights does the section of a solid change, and which outlines does a cut show?

Heights are along the z axis; a cut gives corners joined by straight pieces.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

Array = NDArray[np.float64]

UPRIGHT = 1e-5  # z of the normal of a wall that counts as upright
SLIVER = 1e-6  # m: what the chords of a shaft leave open in a bore of the same radius is narrower


class Solid(NamedTuple):
    """A named mesh of a file: vertices (n, 3), all different, and faces (m, 3) of three of them each."""

    name: str
    vertices: Array
    faces: NDArray[np.int64]

    @property
    def sides(self) -> NDArray[np.int64]:
        """The edges (3 m, 2) of all faces, three of each in a row, the lower number of a vertex first."""
        return np.sort(self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)

    @property
    def open_edges(self) -> int:
        """How many edges belong to one face only, or to three: none of a closed mesh."""
        return int(np.sum(np.unique(self.sides, axis=0, return_counts=True)[1] % 2))


class Slab(NamedTuple):
    """The heights (m) between two at which the section changes; `same` where it does not between them."""

    bottom: float
    top: float
    same: bool

    @property
    def middle(self) -> float:
        return 0.5 * (self.bottom + self.top)


class Outline(NamedTuple):
    """Corners (n, 2), of which no three neighbours lie in a line; the last one of a closed outline is not the first."""

    corners: Array
    closed: bool


def slabs(solids: Sequence[Solid], rounding: float) -> Iterator[Slab]:
    """From level to level, upwards; a level is a height at which something begins or ends. Gaps are left out."""
    corners = np.concatenate([solid.vertices[solid.faces] for solid in solids])
    z = corners[..., 2]
    low, high = z.min(axis=1), z.max(axis=1)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    rising = high - low > rounding
    leaning = rising & (np.abs(normals[:, 2]) > UPRIGHT * np.linalg.norm(normals, axis=1))
    ends = [low[~rising], [low.min(), high.max()]]
    order = np.argsort(low[leaning])
    if len(order):  # stretches in which walls lean, one above the other
        lows, tops = low[leaning][order], np.maximum.accumulate(high[leaning][order])
        new = np.append(True, lows[1:] > tops[:-1] + rounding)
        ends += [lows[new], tops[np.append(new[1:], True)]]
    levels = np.unique(np.concatenate(ends))
    levels = levels[np.append(True, np.diff(levels) > 2.0 * rounding)]
    for bottom, top in pairwise(levels.tolist()):
        inside = (low < 0.5 * (bottom + top)) & (high > 0.5 * (bottom + top))
        if inside.any():
            yield Slab(bottom, top, not bool((inside & leaning).any()))


def outlines_at(solid: Solid, height: float, rounding: float) -> Iterator[Outline]:
    """What a cut at that height shows. Where the mesh is open there an outline is, too."""
    segments, backwards = _segments(solid, height)
    if len(segments):
        lines = _lines(segments)
        directed = np.where(backwards[:, None, None], segments[:, ::-1], segments)
        if not solid.open_edges and not all(_bounds_material(line, directed) for line in lines):
            lines = _lines(_united(directed, rounding))
        for line in lines:
            outline = _outline(line, rounding)
            if len(outline.corners) > 1:
                yield outline


def _lines(segments: Array) -> list[Array]:
    """Segments (n, 2, 2) that hang together, as the points of lines."""
    merged = shapely.line_merge(shapely.multilinestrings(shapely.linestrings(segments)))
    return [shapely.get_coordinates(line) for line in shapely.get_parts(merged)]


def _segments(solid: Solid, height: float) -> tuple[Array, NDArray[np.bool_]]:
    """The pieces (n, 2, 2) in which faces meet the plane, and which of them have the solid on their right.

    Each edge is cut once, so that neighbours share points exactly. A vertex on the plane counts as above it.
    """
    above = solid.vertices[:, 2] >= height
    sides = solid.sides
    cut = above[sides[:, 0]] != above[sides[:, 1]]
    sides = sides[cut]  # two of each face that is cut
    a, b = solid.vertices[sides[:, 0]], solid.vertices[sides[:, 1]]
    share = ((height - a[:, 2]) / (b[:, 2] - a[:, 2]))[:, None]
    segments: Array = (a + share * (b - a))[:, :2].reshape(-1, 2, 2)
    first, second, third = (solid.vertices[solid.faces[np.flatnonzero(cut)[::2] // 3, k]] for k in range(3))
    normals = np.cross(second - first, third - first)[:, :2]
    ways = segments[:, 1] - segments[:, 0]
    backwards = ways[:, 0] * normals[:, 1] > ways[:, 1] * normals[:, 0]
    long = np.any(ways != 0.0, axis=1)
    return segments[long], backwards[long]


def _windings(segments: Array, x: float, y: float) -> int:
    """In how many bodies a point lies, by the segments that have them on their left."""
    (x0, y0), (x1, y1) = segments[:, 0].T, segments[:, 1].T
    crossing = (y0 > y) != (y1 > y)
    right = x < x0[crossing] + (y - y0[crossing]) * (x1 - x0)[crossing] / (y1 - y0)[crossing]
    return int(np.where((y1 > y0)[crossing], 1, -1)[right].sum())


def _bounds_material(line: Array, segments: Array) -> bool:
    """Is there material on one side of a line only?

    Not where bodies of one mesh overlap or share a wall, as a staff and its bore do.
    """
    a, b = max(pairwise(line), key=lambda ends: float(np.hypot(*(ends[1] - ends[0]))))
    length = float(np.hypot(*(b - a)))
    off = min(SLIVER, 0.25 * length) / length * np.array((a[1] - b[1], b[0] - a[0]))
    return {abs(_windings(segments, *(0.5 * (a + b) + way * off))) for way in (-1.0, 1.0)} == {0, 1}


def _united(segments: Array, rounding: float) -> Array:
    """The outer segments of all bodies together, on a grid of `rounding`."""
    drawn = shapely.set_precision(shapely.multilinestrings(shapely.linestrings(segments)), rounding, mode="pointwise")
    cells = shapely.get_parts(shapely.polygonize([shapely.union_all(shapely.get_parts(drawn), grid_size=rounding)]))
    inside = [_windings(segments, *shapely.get_coordinates(shapely.point_on_surface(cell))[0]) != 0 for cell in cells]
    rings = shapely.get_rings(shapely.get_parts(shapely.union_all(cells[inside], grid_size=rounding)))
    wide = 2.0 * shapely.area(shapely.polygons(rings)) > SLIVER * shapely.length(rings)
    return np.concatenate([np.stack((p[:-1], p[1:]), axis=1) for p in map(shapely.get_coordinates, rings[wide])])


def _outline(points: Array, rounding: float) -> Outline:
    """The points at which it turns: faces of a wall are cut along their diagonals, too."""
    closed = bool(np.all(points[0] == points[-1]))
    points = points[:-1] if closed else points
    parity = 0
    while len(points) > 2:
        before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
        ways, chords = points - before, after - before
        height = np.abs(ways[:, 0] * chords[:, 1] - ways[:, 1] * chords[:, 0])
        length = np.hypot(*chords.T)
        flat = (height <= rounding * length) & (length > 0.0)  # where it turns back is a corner
        if not closed:
            flat[[0, -1]] = False
        if not flat.any():
            break
        flat[parity::2] = False  # of neighbours only every other one at a time
        points, parity = points[~flat], 1 - parity
    return Outline(points, closed)
