"""Which ends of edges are the same point?

First ends that agree to a nanometre are one node; then loose ends are joined to what lies within the snap. Tiny real
edges thus survive: they hang together before the snap is asked. A grid of cells finds neighbours, so the time
grows with the number of ends only.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from watchsim.drawing.content import Stroke
from watchsim.geometry.edge_table import table_of
from watchsim.geometry.primitives import Point

TIGHT = 1e-9  # metres: the decimals of a drawing
CROWD = 64  # neighbours looked at per cell: where more ends crowd within a snap, none can be distinguished from another
NOBODY: list[int] = []


class Join(NamedTuple):
    """Two nodes that were `gap` metres apart, at that place, and the strokes that end there."""

    gap: float
    at: Point
    strokes: tuple[int, int]


class Nodes:
    """The node of every end. End 2·i is the start of stroke i, 2·i + 1 its end."""

    def __init__(self, strokes: Sequence[Stroke]) -> None:
        table = table_of([stroke.edge for stroke in strokes])
        self.ends: list[Point] = [(x, y) for x, y in np.hstack((table.start, table.end)).reshape(-1, 2).tolist()]
        self.lengths = [stroke.edge.length for stroke in strokes]
        self.at: list[Point] = []
        self.members: list[list[int]] = []
        self.node: list[int] = []
        self.joined: set[int] = set()  # nodes made of two
        self._collect()

    def _collect(self) -> None:
        """Each end goes to the nearest node within TIGHT, or makes a new one."""
        grid = Grid(TIGHT)
        for end, p in enumerate(self.ends):
            best, nearest = -1, TIGHT
            before = self.node[-1] if end % 2 == 0 and end else -1
            # Most often an edge starts where the one before ends: no other node can be nearer.
            beside = before >= 0 and math.dist(p, self.at[before]) <= 0.5 * TIGHT and self._may_join(end, before, TIGHT)
            for node in (before,) if beside else grid.around(p):
                gap = math.dist(p, self.at[node])
                if gap <= nearest and self._may_join(end, node, TIGHT):
                    best, nearest = node, gap
            if best < 0:
                best = len(self.at)
                self.at.append(p)
                self.members.append([])
                grid.add(p, best)
            self.members[best].append(end)
            self.node.append(best)

    def _may_join(self, end: int, node: int, reach: float) -> bool:
        """Not both ends of an edge that is itself as short as the reach: it would vanish."""
        return self.lengths[end // 2] > 3.0 * reach or (end ^ 1) not in self.members[node]

    def snap(self, reach: float, loose_only: bool) -> list[Join]:
        """Joins loose ends to the nearest node within `reach` metres (`loose_only`: to another loose end), nearest first."""
        joins = []
        for gap, a, b in sorted(self._pairs(reach, loose_only)):
            loose = (len(self.members[a]) == 1) + (len(self.members[b]) == 1)
            if loose < (2 if loose_only else 1) or not self.members[a] or not self.members[b]:
                continue
            if not all(self._may_join(end, a, reach) for end in self.members[b]):
                continue
            joins.append(Join(gap, self.at[a], (self.members[a][0] // 2, self.members[b][0] // 2)))
            self._merge(a, b)
        return joins

    def _pairs(self, reach: float, loose_only: bool) -> Iterator[tuple[float, int, int]]:
        grid = Grid(reach)
        loose = [node for node, members in enumerate(self.members) if len(members) == 1]
        for node in loose if loose_only else range(len(self.at)):
            if self.members[node]:
                grid.add(self.at[node], node)
        for a in loose:
            for b in grid.around(self.at[a]):
                gap = math.dist(self.at[a], self.at[b])
                if a != b and gap <= reach:
                    yield gap, min(a, b), max(a, b)

    def _merge(self, a: int, b: int) -> None:
        for end in self.members[b]:
            self.node[end] = a
        self.members[a].extend(self.members[b])
        self.members[b] = []
        self.joined.add(a)

    def drop(self, stroke: int) -> None:
        """Takes both ends of a stroke out."""
        for end in (2 * stroke, 2 * stroke + 1):
            self.members[self.node[end]].remove(end)

    def of(self, stroke: int) -> tuple[int, int]:
        """The nodes of start and end of a stroke."""
        return self.node[2 * stroke], self.node[2 * stroke + 1]


class Grid:
    """Numbered points by square cells of four times the reach: what is within reach of a point lies in one to four of them."""

    def __init__(self, reach: float) -> None:
        self.reach = reach
        self.scale = 0.25 / reach
        self.cells: dict[tuple[int, int], list[int]] = {}

    def add(self, p: Point, number: int) -> None:
        cell = math.floor(p[0] * self.scale), math.floor(p[1] * self.scale)
        self.cells.setdefault(cell, []).append(number)

    def around(self, p: Point) -> list[int]:
        """The numbers of the points within reach, and of some further away."""
        (x, y), reach, scale, cells = p, self.reach, self.scale, self.cells
        low_x, high_x = math.floor((x - reach) * scale), math.floor((x + reach) * scale)
        low_y, high_y = math.floor((y - reach) * scale), math.floor((y + reach) * scale)
        found = cells.get((low_x, low_y), NOBODY)[:CROWD]
        if high_x > low_x:
            found = found + cells.get((high_x, low_y), NOBODY)[:CROWD]
        if high_y > low_y:
            found = found + cells.get((low_x, high_y), NOBODY)[:CROWD]
            if high_x > low_x:
                found = found + cells.get((high_x, high_y), NOBODY)[:CROWD]
        return found
