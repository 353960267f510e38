"""Into which cells is the configuration space of two bodies divided?

Cells are sized by how far a point travels in one. An outline that comes back onto itself within a turn gets as many cells for
each such part, so that they can be shared (symmetry.py).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.alike import AlikeContacts
from watchsim.mechanism.chords import chords
from watchsim.mechanism.model import ARC, CORNER, FREE, FULL, PIVOT, SLIDE, Records

FEW_CONTACTS = 24  # with no more reachable pairs of primitives than this, a search costs more than it saves
# A cell lets the outermost point of either body travel this share of the larger one's reach: the first where outlines are made
# of pieces as short as that, so that few of them fit into it, else the second.
FINEST_SHARE, CELL_SHARE = 0.01, 0.02
FEWEST = 8  # cells in a turn
MOST_PARTS = 1024  # a symmetry with more parts is not worth the table


class _Axis(NamedTuple):
    """One cell coordinate: its number, the size of a cell, cells in a turn (0: it is a length), alike parts of a turn."""

    coordinate: int
    size: float
    wrap: int
    fold: int


def choose_cells(bodies: Records, primitives: Records, contacts: Records, pairs: Records, near: NDArray[np.int64]) -> None:
    """Fill in the cell coordinates of each pair of bodies that has enough reachable contacts to need a search."""
    for pair in pairs:
        ids = near[pair.near_start : pair.near_stop]
        moving = [b for b in (pair.a, pair.b) if bodies[b].motion in (PIVOT, SLIDE, FREE)]
        if len(ids) <= FEW_CONTACTS or not 1 <= sum(3 if bodies[b].motion == FREE else 1 for b in moving) <= 3:
            continue
        used = np.unique(np.concatenate([contacts.a[ids], contacts.b[ids]]))
        mine = {b: primitives[used[primitives.body[used] == b]] for b in moving}
        reach = {b: float(np.hypot(*chords(rows, pair.clearance).points.T).max(initial=0.0)) for b, rows in mine.items()}
        piece = _typical_length(primitives[used])
        largest = max(reach.values())
        travel = min(max(FINEST_SHARE * largest, piece), CELL_SHARE * largest) or pair.clearance
        axes: list[_Axis] = []
        parts = 1
        for b in moving:
            fold = 1 if bodies[b].motion == SLIDE else AlikeContacts(primitives, contacts, pair, ids, b).fold
            fold = fold if parts * fold <= MOST_PARTS else 1
            parts *= fold
            axes += _axes(bodies[b], travel, reach[b], fold)
        pair.axes, pair.listed = len(axes), 1
        for i, axis in enumerate(axes):
            pair[f"c{i}"], pair[f"size{i}"], pair[f"wrap{i}"], pair[f"fold{i}"] = axis


def _typical_length(rows: Records) -> float:
    """Median length of the lines and arcs among some primitives, m; 0 without any."""
    half = np.where(rows.extent == FULL, np.pi, np.arctan2(rows.half_sin, rows.half_cos))
    lengths = np.where(rows.kind == ARC, 2.0 * half * rows.radius, rows.length)[rows.kind != CORNER]
    return float(np.median(lengths)) if len(lengths) else 0.0


def _axes(body: Any, travel: float, reach: float, fold: int) -> list[_Axis]:
    """A body's coordinates, with cells in which its points travel about `travel` metres."""
    cells = max(FEWEST, 2.0 * math.pi * reach / travel)
    turn = fold * math.ceil(cells / fold)
    turning = (2.0 * math.pi / turn, turn, fold)
    if body.motion == PIVOT:
        return [_Axis(body.first, *turning)]
    if body.motion == SLIDE:
        return [_Axis(body.first, travel, 0, 1)]
    return [_Axis(body.first, travel, 0, 1), _Axis(body.first + 1, travel, 0, 1), _Axis(body.first + 2, *turning)]
