"""Into which cells is the configuration space of two bodies divided?

Cells are sized by how far a point travels in one. An outline that comes back onto itself within a turn gets as many cells for
each such part, so that they can be shared (symmetry.py).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.cell_frame import MOVEMENT, TRAVEL, Axis, axes_of, seen_from
from watchsim.candidates.chords import chords
from watchsim.candidates.equivalent_contacts import AlikeContacts
from watchsim.candidates.named_rows import named_rows
from watchsim.model.records import ARC, CORNER, FULL, SLIDE, Records

FEW_CONTACTS = 24  # with no more reachable pairs of primitives than this, a search costs more than it saves
# A cell lets the outermost point of either body travel this share of the larger one's reach: the first where outlines are made
# of pieces as short as that, so that few of them fit into it, else the second.
FINEST_SHARE, CELL_SHARE = 0.01, 0.02
FEWEST = 8  # cells in a turn
MOST_PARTS = 1024  # a symmetry with more parts is not worth the table


class _Cells(NamedTuple):
    """One cell coordinate: its number, what is taken away, the size of a cell, cells in a turn (0: a length), alike parts."""

    c: int
    on: int
    size: float
    wrap: int
    fold: int


def choose_cells(bodies: Records, primitives: Records, contacts: Records, pairs: Records, near: NDArray[np.int64]) -> None:
    """Fill in the cell coordinates of each pair of bodies that has enough reachable contacts to need a search."""
    for pair in pairs:
        ids = near[pair.near_start : pair.near_stop]
        axes = {b: axes_of(bodies, b, pair.frame) for b in (int(pair.a), int(pair.b))}
        used_by = [axis.coordinate for own in axes.values() for axis in own]
        # A coordinate that moves both bodies, as that of two gears, would need cells of both.
        if len(ids) <= FEW_CONTACTS or not 1 <= len(used_by) <= 3 or len(set(used_by)) < len(used_by):
            continue
        moving = [b for b in axes if axes[b]]
        used, _ = named_rows(np.concatenate([contacts.a[ids], contacts.b[ids]]), len(primitives))
        mine = {b: primitives[used[primitives.body[used] == b]] for b in axes}
        reach = {b: float(np.hypot(*chords(rows, pair.clearance).points.T).max(initial=0.0)) for b, rows in mine.items()}
        piece = _typical_length(primitives[used])
        largest = max(reach[b] for b in moving)
        travels = any(axis.kind == TRAVEL for own in axes.values() for axis in own)
        if travels and pair.frame == MOVEMENT and all(bodies[b].carrier < 0 for b in axes):
            pair.reach = sum(reach.values()) + 2.0 * pair.clearance
        travel = min(max(FINEST_SHARE * largest, piece), CELL_SHARE * largest) or pair.clearance
        cells: list[_Cells] = []
        parts = 1
        for b in moving:
            seen = seen_from(bodies, b, pair.frame)
            slides = seen.motion == SLIDE
            fold = 1 if slides else AlikeContacts(primitives, contacts, pair, ids, b).fold
            fold = fold if parts * fold <= MOST_PARTS else 1
            parts *= fold
            # Only a body's own angle, the last of its axes, brings its outline back onto itself, and only there is it geared.
            cells += [_cells(axis, travel, reach[b]) for axis in axes[b][:-1]]
            cells.append(_cells(axes[b][-1], travel, reach[b], fold, seen.ratio))
        pair.axes, pair.listed = len(cells), 1
        for i, axis in enumerate(cells):
            for name, value in axis._asdict().items():
                pair[f"{name}{i}"] = value


def _typical_length(rows: Records) -> float:
    """Median length of the lines and arcs among some primitives, m; 0 without any."""
    half = np.where(rows.extent == FULL, np.pi, np.arctan2(rows.half_sin, rows.half_cos))
    lengths = np.where(rows.kind == ARC, 2.0 * half * rows.radius, rows.length)[rows.kind != CORNER]
    return float(np.median(lengths)) if len(lengths) else 0.0


def _cells(axis: Axis, travel: float, reach: float, fold: int = 1, ratio: float = 1.0) -> _Cells:
    """Cells in which the points of a body within `reach` of its origin travel about `travel` metres.

    `ratio`: how far the body itself goes when the coordinate changes by one.
    """
    if axis.kind == TRAVEL:
        return _Cells(axis.coordinate, axis.on, travel / abs(ratio), 0, 1)
    cells = max(FEWEST, 2.0 * math.pi * (axis.arm + reach) / travel)
    turn = fold * math.ceil(cells / fold)
    return _Cells(axis.coordinate, axis.on, 2.0 * math.pi / (turn * abs(ratio)), turn, fold)
