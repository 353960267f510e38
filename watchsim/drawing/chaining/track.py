"""On which side of an outline does one arrive, a way along another one from a point where both meet?

Positions on a chain are lengths from its start. Sides are asked near the meeting only, so outlines that come back elsewhere do
not matter.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from itertools import accumulate

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Point

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
