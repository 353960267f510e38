"""Which pieces of material does a drawing hold?

A piece is an outer outline with its holes. Equal pieces that stand around a centre, such as single teeth, are one piece.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.circles import circle_of
from watchsim.geometry.inside import winding
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Point
from watchsim.geometry.solids.mass import area, section
from watchsim.mechanism.material_polygons import chord_points, material
from watchsim.proposal.bodies.symmetry_centre import Turned, turned

Region = Any  # a polygon, or several, of shapely
Floats = NDArray[np.float64]

DEVIATION = 2e-5  # of an outline's length: of chords from arcs
LEAST = 1e-7  # of the square of its length: a piece with less area has no material
ALIKE = 1e-3  # relative: areas and lengths of equal pieces
FEWEST = 5  # equal pieces around a centre


@dataclass(frozen=True, eq=False)
class Piece:
    """Outlines of one layer that hang together: outer ones, then their holes. `file` is the number of its drawing."""

    file: int
    layer: str
    loops: tuple[Loop, ...]

    @cached_property
    def area(self) -> float:
        """m²."""
        return abs(sum(area(loop) for loop in self.loops))

    @cached_property
    def points(self) -> Floats:
        """(n, 2) of all outer outlines, m."""
        return np.concatenate([chord_points(loop, self._deviation) for loop in self.loops if not loop.hole])

    @cached_property
    def rings(self) -> list[tuple[Floats, bool]]:
        return [(chord_points(loop, self._deviation), loop.hole) for loop in self.loops]

    @cached_property
    def region(self) -> Region:
        parts = material(self.rings)
        whole = parts[0]
        for part in parts[1:]:
            whole = whole.union(part)
        return whole

    @cached_property
    def filled(self) -> Region:
        """The region without its holes."""
        outer = [(points, False) for points, hole in self.rings if not hole]
        parts = material(outer)
        whole = parts[0]
        for part in parts[1:]:
            whole = whole.union(part)
        return whole

    @property
    def has_material(self) -> bool:
        """False of an outline that crosses itself so that nothing is left: two equal halves that run either way."""
        return min(self.area, float(self.region.area)) > LEAST * self.length**2

    @cached_property
    def centroid(self) -> Point:
        return section(self.loops).centroid

    @cached_property
    def turned(self) -> Turned | None:
        """By which part of a turn, about which centre, its outer outlines come back onto themselves; None of a disc."""
        outer = [loop for loop in self.loops if not loop.hole]
        return turned(outer, [chord_points(loop, self._deviation) for loop in outer])

    @cached_property
    def arcs(self) -> list[Arc]:
        return [edge for loop in self.loops for edge in loop.edges if isinstance(edge, Arc)]

    @cached_property
    def is_disc(self) -> bool:
        outer = [loop for loop in self.loops if not loop.hole]
        return len(outer) == 1 and circle_of(outer[0]) is not None

    @cached_property
    def length(self) -> float:
        return sum(loop.length for loop in self.loops)

    @property
    def _deviation(self) -> float:
        first = self.loops[0]
        return DEVIATION * max(first.length, 1e-6)


def pieces_of(file: int, loops: Sequence[Loop], crowded: frozenset[str] = frozenset()) -> list[Piece]:
    """The pieces of closed outlines; layer by layer, in the order of the drawing.

    On `crowded` layers outlines cross: what is taken for a hole there, but leaves the outline around it, is a part of its own.
    """
    found: list[Piece] = []
    for layer in dict.fromkeys(loop.layer for loop in loops):
        own = [loop for loop in loops if loop.layer == layer and loop.closed]
        single = [Piece(file, layer, tuple(group)) for group in _with_holes(own, layer in crowded)]
        found += _around_a_centre([piece for piece in single if piece.has_material])
    return found


def _with_holes(loops: Sequence[Loop], crowded: bool) -> Iterator[list[Loop]]:
    outers = [loop for loop in loops if not loop.hole]
    groups: list[list[Loop]] = [[loop] for loop in outers]
    sizes = [abs(area(loop)) for loop in outers]
    for hole in (loop for loop in loops if loop.hole):
        place = hole.edges[0].point(0.5)
        around = [k for k, loop in enumerate(outers) if sizes[k] > abs(area(hole)) and winding(loop, place) != 0]
        within = min(around, key=lambda k: sizes[k], default=None)
        if within is None or (crowded and not _is_hole(hole, outers[within], loops)):
            groups.append([replace(hole.reversed(), hole=False)])
        else:
            groups[within].append(hole)
    yield from groups


def _is_hole(hole: Loop, outer: Loop, loops: Sequence[Loop]) -> bool:
    """Does it lie in the outline around it, and cross nothing else on its layer?"""
    inside, around = _filled(hole), _filled(outer)
    others = (_filled(loop) for loop in loops if loop is not hole and loop is not outer)
    return bool(around.covers(inside)) and not any(inside.boundary.crosses(other.boundary) for other in others)


def _filled(loop: Loop) -> Region:
    return material([(chord_points(loop, DEVIATION * loop.length), False)])[0]


def _around_a_centre(pieces: Sequence[Piece]) -> list[Piece]:
    """The same, with equal pieces that stand around a centre put together."""
    classes: list[list[Piece]] = []
    for piece in pieces:
        for group in classes:
            if _alike(piece, group[0]):
                group.append(piece)
                break
        else:
            classes.append([piece])
    found: list[Piece] = []
    for group in classes:
        loops = tuple(loop for piece in group for loop in piece.loops)
        whole = Piece(group[0].file, group[0].layer, loops)
        symmetry = whole.turned if len(group) >= FEWEST else None
        found += [whole] if symmetry is not None and symmetry.fold % len(group) == 0 else group
    return found


def _alike(one: Piece, other: Piece) -> bool:
    return math.isclose(one.area, other.area, rel_tol=ALIKE) and math.isclose(one.length, other.length, rel_tol=ALIKE)
