"""Which ends of edges are the same point, and which edge follows at each?

First ends that agree to a nanometre are one node; then loose ends are joined to what lies within the snap. Tiny real
edges thus survive: they hang together before the snap is looked at. A grid of cells finds neighbours, so the time
grows with the number of ends only.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from itertools import accumulate
from typing import NamedTuple

import numpy as np

from watchsim.drawing.findings import Stroke
from watchsim.geometry.loops import Loop, table_of
from watchsim.geometry.primitives import TURN, Arc, Edge, Point


class Outline(NamedTuple):
    """A loop or an open chain, and the name of the entity that drew each of its edges, as CAD shows it."""

    loop: Loop
    sources: tuple[str, ...]


# On which side of an outline one arrives, a way along another one from a point where both meet, is looked at near the meeting
# only, so outlines that come back elsewhere do not matter. Positions on a chain are lengths from its start.

STRIDE = 1.3  # growth of the steps away from the meeting


class Track:
    """A chain with the length from its start to each of its edges."""

    def __init__(self, loop: Loop) -> None:
        self.edges = loop.edges
        self.closed = loop.closed
        self.starts = [0.0, *accumulate(edge.length for edge in loop.edges)]
        self.length = self.starts[-1]

    def position(self, number: int, p: Point) -> float:
        """The position of the place on edge `number` that is nearest to `p`."""
        edge = self.edges[number]
        return self.starts[number] + edge.length * nearest_fraction(edge, p)

    def at(self, s: float) -> Point | None:
        """The point at position `s`; None beyond the ends of an open chain."""
        if self.closed:
            s %= self.length
        elif not 0.0 <= s <= self.length:
            return None
        k = min(bisect_right(self.starts, s) - 1, len(self.edges) - 1)
        length = self.edges[k].length
        return self.edges[k].point(min(max((s - self.starts[k]) / length, 0.0), 1.0)) if length > 0.0 else self.edges[k].start

    def side(self, p: Point, low: float, high: float) -> tuple[float, float]:
        """Distance (m) of `p` from the part between two positions, and the side: +1 left, -1 right of the way of travel."""
        best, side = math.inf, 0.0
        for k in self._between(low, high):
            edge = self.edges[k]
            f = nearest_fraction(edge, p)
            x, y = edge.point(f)
            gap = math.hypot(p[0] - x, p[1] - y)
            if gap < best:
                best = gap
                tx, ty = self._bisector(k, f)
                side = math.copysign(1.0, tx * (p[1] - y) - ty * (p[0] - x))
        return best, side

    def _between(self, low: float, high: float) -> list[int]:
        """Numbers of the edges that have a part between two positions."""
        if not self.closed:
            low, high = max(low, 0.0), min(high, self.length)
        elif high - low >= self.length:
            return list(range(len(self.edges)))
        else:
            turns = math.floor(low / self.length)
            low, high = low - turns * self.length, high - turns * self.length
        count = len(self.edges)
        first = min(bisect_right(self.starts, low) - 1, count - 1)
        last = min(bisect_right(self.starts, min(high, self.length)) - 1, count - 1)
        wrapped = range(min(bisect_right(self.starts, high - self.length), count)) if high > self.length else range(0)
        return [*range(first, last + 1), *wrapped]

    def _bisector(self, k: int, f: float) -> Point:
        """Direction of travel at fraction `f` of edge k; at a corner the mean of both, whose sides are right for what is
        nearest to the corner."""
        edge = self.edges[k]
        if 0.0 < f < 1.0:
            return edge.tangent(f)
        other = k + 1 if f >= 1.0 else k - 1
        if not self.closed and not 0 <= other < len(self.edges):
            return edge.tangent(f)
        (ax, ay), (bx, by) = edge.tangent(f), self.edges[other % len(self.edges)].tangent(1.0 - f)
        return (ax + bx, ay + by)


def nearest_fraction(edge: Edge, p: Point) -> float:
    """Where along the edge (0 to 1) it is nearest to `p`."""
    if not isinstance(edge, Arc):
        dx, dy = edge.x1 - edge.x0, edge.y1 - edge.y0
        square = dx * dx + dy * dy
        return min(max(((p[0] - edge.x0) * dx + (p[1] - edge.y0) * dy) / square, 0.0), 1.0) if square > 0.0 else 0.0
    turn = math.atan2(p[1] - edge.y, p[0] - edge.x) - edge.start_angle
    turn = (turn if edge.sweep > 0.0 else -turn) % TURN
    if turn <= abs(edge.sweep):
        return turn / abs(edge.sweep)
    return 1.0 if turn - abs(edge.sweep) < TURN - turn else 0.0


def passes_through(a: Track, at_a: float, b: Track, at_b: float, depth: float) -> bool:
    """Does chain b, which meets a at these positions, go over to the other side by more than `depth` metres each way?"""
    for track, at in ((a, at_a), (b, at_b)):
        if not track.closed and min(at, track.length - at) <= depth:
            return False  # what ends there crosses nothing
    most = min(a.length, b.length) / 2.0
    if a is b:
        apart = abs(at_a - at_b)
        most = min(apart, a.length - apart if a.closed else apart) / 3.0
    ahead, behind = (arrival(a, at_a, b, at_b, way, depth, most) for way in (1.0, -1.0))
    return ahead * behind < 0.0


def arrival(a: Track, at_a: float, b: Track, at_b: float, way: float, depth: float, most: float) -> float:
    """The side of a on which b arrives where it has left it by `depth`; 0 where it does not."""
    step = STRIDE * depth
    while step < most:
        p = b.at(at_b + way * step)
        if p is None:
            return 0.0
        distance, side = a.side(p, at_a - 3.0 * step, at_a + 3.0 * step)
        if distance > depth:
            return side
        step *= STRIDE
    return 0.0


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


class Junctions(NamedTuple):
    """`partner` of every end that goes on; ends that are `loose`; ends that meet where the way is unclear, by node."""

    partner: dict[int, int]
    loose: tuple[int, ...]
    branches: dict[int, tuple[int, ...]]


def junctions(nodes: Nodes, strokes: Sequence[Stroke]) -> Junctions:
    """The continuation at every node; `strokes` are those the nodes were made of.

    Where more than two ends meet, edges that one entity draws in one go (a polyline, a spline) continue each other; if more
    than two ends are left over then, nobody can know.
    """
    partner: dict[int, int] = {}
    loose: list[int] = []
    branches: dict[int, tuple[int, ...]] = {}
    for node, members in enumerate(nodes.members):
        ends = list(members) if len(members) <= 2 else _linked(members, strokes, partner)
        if len(ends) == 2:
            partner[ends[0]], partner[ends[1]] = ends[1], ends[0]
        elif len(ends) == 1:
            loose.append(ends[0])
        elif ends:
            branches[node] = tuple(ends)
    return Junctions(partner, tuple(loose), branches)


def _linked(members: Sequence[int], strokes: Sequence[Stroke], partner: dict[int, int]) -> list[int]:
    """Links the end of each stroke to the start of the next one of its run; the ends left over."""
    here = set(members)
    for end in sorted(members):
        following = end + 1
        if end % 2 == 1 and following in here and strokes[end // 2].run == strokes[following // 2].run:
            partner[end], partner[following] = following, end
            here -= {end, following}
    return sorted(here)
