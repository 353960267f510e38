"""How does a bore that was drawn on a layer of its own lie to the outlines of a plate?

Wholly in material, wholly in none, or across an outline: then what is missing must be drawn in the outline itself. Touching
is no crossing, so a slot may reach the border.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from watchsim.drawing.chaining.crossings import SHALLOW, Layer, all_meetings, crosses
from watchsim.drawing.chaining.outline_source import Outline
from watchsim.geometry.boxes import Boxes
from watchsim.geometry.extent import extents
from watchsim.geometry.inside import Inside
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.geometry.solids.mass import area

DEEPER = 4.0  # than what crosses without being a crossing: a point that far inside is inside


@dataclass(slots=True)
class Lie:
    """Of one bore: in how many `outlines` and `holes` of the plate it lies.

    `crosses` is a point (metres) where it crosses an outline of the plate, `around` one of them that it encloses or covers,
    `within` the number of a bore around it or in the same place; `meets` the number of an earlier bore that it crosses, and
    where.
    """

    outlines: int = 0
    holes: int = 0
    crosses: Point | None = None
    around: Loop | None = None
    within: int | None = None
    meets: tuple[int, Point] | None = None

    @property
    def clear(self) -> bool:
        """Can it be decided whether it lies in material?"""
        return self.crosses is None and self.around is None and self.meets is None

    @property
    def taken(self) -> bool:
        """Is it to be taken out of the plate?"""
        return self.clear and self.depth == 1 and self.within is None

    @property
    def depth(self) -> int:
        """How many times there is material around it."""
        return self.outlines - self.holes


def lies(bores: Sequence[Loop], plate: Sequence[Loop]) -> list[Lie]:
    """Of every bore (closed loops, running either way) to the closed loops of a plate and to the other bores."""
    found = [Lie() for _ in bores]
    if bores:
        rows = [*plate, *(bore if area(bore) > 0.0 else bore.reversed() for bore in bores)]
        _note_crossings(found, rows)
        _note_nesting(found, rows)
    return found


def _note_crossings(found: list[Lie], rows: Sequence[Loop]) -> None:
    """The last of `rows` are the bores; what crosses among the others was found when the drawing was read."""
    first = len(rows) - len(found)
    layer = Layer([Outline(loop, ("",) * len(loop.edges)) for loop in rows], SHALLOW)
    for meeting in all_meetings(layer)[0]:
        one, other = sorted((int(layer.owner[meeting.first]), int(layer.owner[meeting.second])))
        if other < first or one == other:
            continue
        place = next((p for p in meeting.points if crosses(layer, meeting, p)), None)
        if place is not None and one < first:
            found[other - first].crosses = place
        elif place is not None:
            found[other - first].meets = (one - first, place)


def _note_nesting(found: list[Lie], rows: Sequence[Loop]) -> None:
    """Where nothing crosses, a loop lies in a larger one if a point of it does."""
    first = len(rows) - len(found)
    sizes = [abs(area(loop)) for loop in rows]
    boxes = Boxes(np.array([extents([loop]) for loop in rows]))
    probes = [_inner_point(loop.reversed() if loop.hole and k < first else loop) for k, loop in enumerate(rows)]
    insides: dict[int, Inside] = {}
    for small, large in zip(*(column.tolist() for column in boxes.holding(np.array(probes))), strict=True):
        over = sizes[large] - sizes[small]
        if max(small, large) < first or over < 0.0 or (over == 0.0 and small <= large):
            continue
        if large not in insides:
            insides[large] = Inside(rows[large])
        if insides[large].winding(probes[small]) == 0:
            continue
        if min(small, large) >= first:
            found[small - first].within = large - first
            continue
        bore, loop = found[max(small, large) - first], rows[min(small, large)]
        covers = over <= SHALLOW * rows[large].length  # they lie on each other
        if loop.hole and (covers or large < first):
            bore.holes += 1
        elif covers or small < first:
            bore.around = loop
        else:
            bore.outlines += 1


def _inner_point(loop: Loop) -> Point:
    """A point inside a loop that runs counter-clockwise, beside the middle of its longest edge: deeper than a touch."""
    edge = max(loop.edges, key=lambda edge: edge.length)
    (x, y), (tx, ty) = edge.point(0.5), edge.tangent(0.5)
    return (x - DEEPER * SHALLOW * ty, y + DEEPER * SHALLOW * tx)
