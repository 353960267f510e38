"""Which edges come near each other?

A tree of square cells is refined, all cells of one level at once, until few edges pass through each cell; only edges that
share a cell can meet. The work grows with the number of edges, however they are arranged: where very many run together, not
every pair is given, and it is said where.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.edge_table import Table
from watchsim.geometry.primitives import Point

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FEW = 24  # edges in a cell that is refined no further
DEEPEST = 30  # levels: cells of a billionth of the drawing
GROWTH = 64  # entries per edge; edges that run along each other could be cut into cells for ever
MOST_ENTRIES = 3_000_000  # of edges in cells, and
MOST_PAIRS = 4_000_000  # of which each may be found in several cells: more would take too much memory
MOST_CROWDS = 8  # places reported
CROWD = 32  # partners looked at for each edge in a cell that could not be refined
AT_ONCE = 1 << 17  # entries refined in one go


class Pairs(NamedTuple):
    """Numbers of edges that could meet, first < second, and where there were too many edges to give all of them."""

    first: Ints
    second: Ints
    crowds: tuple[Point, ...]


def near_pairs(table: Table, reach: float) -> Pairs:
    """All pairs of edges that come within `reach` metres of each other, and some more."""
    count = len(table.box)
    if count < 2:
        return Pairs(np.empty(0, np.int64), np.empty(0, np.int64), ())
    low = table.box[:, :2].min(axis=0)
    width = float((table.box[:, 2:].max(axis=0) - low).max()) * (1.0 + 1e-12) + reach
    edge, cell = np.arange(count), np.zeros((count, 2), np.int64)
    keys: list[Ints] = []
    crowds: list[Point] = []
    room = MOST_PAIRS
    for level in range(DEEPEST + 1):
        size = width / 2**level
        order = np.lexsort((edge, cell[:, 1], cell[:, 0]))
        edge, cell = edge[order], cell[order]
        starts = np.flatnonzero(np.append(True, np.any(cell[1:] != cell[:-1], axis=1)))
        counts = np.diff(np.append(starts, len(edge)))
        last = level == DEEPEST or len(edge) > min(GROWTH * count, MOST_ENTRIES) or size < 4.0 * reach
        done = np.ones(len(counts), bool) if last else counts <= FEW
        found, complete = _paired(table, edge, starts[done], counts[done], reach, room)
        keys += found
        room -= sum(map(len, found))
        full = done & (counts > CROWD) if complete else done & (counts == counts[done].max())
        crowds += [tuple((low + (cell[k] + 0.5) * size).tolist()) for k in starts[full][:MOST_CROWDS]]
        if np.all(done) or not complete:
            break
        crowded = np.repeat(~done, counts)
        edge, cell = _refined(table, edge[crowded], cell[crowded], low, 0.5 * size, reach)
    ordered = np.sort(np.concatenate(keys)) if keys else np.empty(0, np.int64)
    unique = ordered[np.append(True, ordered[1:] != ordered[:-1])[: len(ordered)]]
    return Pairs(unique // count, unique % count, tuple(crowds))


def _paired(table: Table, edge: Ints, starts: Ints, counts: Ints, reach: float, room: int) -> tuple[list[Ints], bool]:
    """Keys first · n + second of the pairs within each group; in groups above CROWD each with its next ones only.

    False where there are more than `room`: then not all were looked for.
    """
    keys: list[Ints] = []
    last = np.repeat(starts + counts, counts)  # one past the group's end, for each of its members
    member = np.repeat(starts - np.append(0, np.cumsum(counts)[:-1]), counts) + np.arange(int(counts.sum()))
    for step in range(1, int(min(counts.max(initial=0), CROWD + 1))):
        fits = member + step < last
        member, last = member[fits], last[fits]
        first, second = edge[member], edge[member + step]
        a, b = table.box[first], table.box[second]
        near = np.all((a[:, :2] <= b[:, 2:] + reach) & (b[:, :2] <= a[:, 2:] + reach), axis=1)
        keys.append(first[near] * len(table.box) + second[near])
        room -= len(keys[-1])
        if room < 0:
            return keys, False
    return keys, True


def _refined(table: Table, edge: Ints, cell: Ints, low: Floats, size: float, reach: float) -> tuple[Ints, Ints]:
    """The quarters (of width `size`) of the cells that each edge really passes through, within `reach`."""
    parts = [
        _quartered(table, edge[k : k + AT_ONCE], cell[k : k + AT_ONCE], low, size, reach) for k in range(0, len(edge), AT_ONCE)
    ]
    edges, cells = zip(*parts, strict=True)
    return np.concatenate(edges), np.concatenate(cells)


def _quartered(table: Table, edge: Ints, cell: Ints, low: Floats, size: float, reach: float) -> tuple[Ints, Ints]:
    edge = np.repeat(edge, 4)
    cell = np.repeat(2 * cell, 4, axis=0) + np.tile(np.array([[0, 0], [0, 1], [1, 0], [1, 1]]), (len(cell), 1))
    middle, half = low + (cell + 0.5) * size, 0.5 * size + reach
    box = table.box[edge]
    inside = np.all((box[:, :2] <= middle + half) & (box[:, 2:] >= middle - half), axis=1)
    edge, cell, middle = edge[inside], cell[inside], middle[inside]
    arcs = table.arc[edge]
    passes = np.empty(len(edge), bool)
    passes[arcs] = _arc_passes(table, edge[arcs], middle[arcs], half)
    passes[~arcs] = _line_passes(table, edge[~arcs], middle[~arcs], half)
    return edge[passes], cell[passes]


def _line_passes(table: Table, edge: Ints, middle: Floats, half: float) -> NDArray[np.bool_]:
    """Does the straight line through the ends cut the square round `middle`?"""
    along, to = table.end[edge] - table.start[edge], middle - table.start[edge]
    return np.abs(along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]) <= half * np.abs(along).sum(axis=1)


def _arc_passes(table: Table, edge: Ints, middle: Floats, half: float) -> NDArray[np.bool_]:
    """Does the whole circle cut the square round `middle`?"""
    off = np.abs(middle - table.centre[edge])
    nearest, farthest = np.maximum(off - half, 0.0), off + half
    radius = table.radius[edge]
    return (np.hypot(*nearest.T) <= radius) & (np.hypot(*farthest.T) >= radius)
