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
    segments = _segments(solid, height)
    if len(segments):
        for line in shapely.get_parts(shapely.line_merge(shapely.multilinestrings(shapely.linestrings(segments)))):
            outline = _outline(shapely.get_coordinates(line), rounding)
            if len(outline.corners) > 1:
                yield outline


def _segments(solid: Solid, height: float) -> Array:
    """The pieces (n, 2, 2) in which faces meet the plane. Each edge is cut once, so that neighbours share points exactly.

    A vertex on the plane counts as above it.
    """
    above = solid.vertices[:, 2] >= height
    sides = solid.sides
    sides = sides[above[sides[:, 0]] != above[sides[:, 1]]]  # two of each face that is cut
    a, b = solid.vertices[sides[:, 0]], solid.vertices[sides[:, 1]]
    share = ((height - a[:, 2]) / (b[:, 2] - a[:, 2]))[:, None]
    segments: Array = (a + share * (b - a))[:, :2].reshape(-1, 2, 2)
    return segments[np.any(segments[:, 0] != segments[:, 1], axis=1)]


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
