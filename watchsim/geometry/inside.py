"""Does this point lie inside the outline?

Exact for arcs: the winding number of the polygon of chords, and one turn more for each arc between which and its chord the
point lies.
"""

from __future__ import annotations

import math

from watchsim.geometry.extent import edge_extents
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Point


class Inside:
    """Answers for many points of one closed loop: its edges are sorted into strips of height, and one strip is looked at."""

    def __init__(self, loop: Loop) -> None:
        self.edges = loop.edges
        boxes = [edge_extents(edge) for edge in loop.edges]
        ends = [edge.end[1] for edge in loop.edges]
        lows = [min(box[1], ends[k - 1]) for k, box in enumerate(boxes)]
        highs = [max(box[3], ends[k - 1]) for k, box in enumerate(boxes)]
        self.low = min(lows)
        count = math.isqrt(len(boxes)) + 1
        self.width = (max(highs) - self.low) / count or 1.0
        self.strips: list[list[int]] = [[] for _ in range(count + 1)]
        for k, (low, high) in enumerate(zip(lows, highs, strict=True)):
            for strip in range(self._strip(low), self._strip(high) + 1):
                self.strips[strip].append(k)

    def _strip(self, y: float) -> int:
        return min(max(int((y - self.low) / self.width), 0), len(self.strips) - 1)

    def winding(self, p: Point) -> int:
        """How often the loop runs counter-clockwise round `p` (metres); on the outline itself either answer may come."""
        return sum(_turns(self.edges[k - 1], self.edges[k], p) for k in self.strips[self._strip(p[1])])


def winding(loop: Loop, p: Point) -> int:
    """The same for a single point."""
    return sum(_turns(loop.edges[k - 1], edge, p) for k, edge in enumerate(loop.edges))


def _turns(before: Edge, edge: Edge, p: Point) -> int:
    """What an edge, and the gap between it and the one before, add to the winding number."""
    x, y = p
    previous, start, end = before.end, edge.start, edge.end
    turns = _crossing(previous[0] - x, previous[1] - y, start[0] - x, start[1] - y)
    turns += _crossing(start[0] - x, start[1] - y, end[0] - x, end[1] - y)
    if isinstance(edge, Arc) and _under(edge, start, end, p):
        turns += 1 if edge.sweep > 0.0 else -1
    return turns


def _crossing(ax: float, ay: float, bx: float, by: float) -> int:
    """+1 or -1 where the line a-b crosses the positive x axis upward or downward; each end belongs to one side only."""
    if (ay > 0.0) == (by > 0.0):
        return 0
    upward = by > 0.0
    left_of_origin = ax * by - bx * ay  # positive: the origin lies to the left of a-b
    if (left_of_origin > 0.0) != upward or left_of_origin == 0.0:
        return 0
    return 1 if upward else -1


def _under(arc: Arc, start: Point, end: Point, p: Point) -> bool:
    """Does `p` lie between the arc and its chord?"""
    if math.hypot(p[0] - arc.x, p[1] - arc.y) >= arc.radius:
        return False
    if arc.is_circle:
        return True
    side = (end[0] - start[0]) * (p[1] - start[1]) - (end[1] - start[1]) * (p[0] - start[0])
    return (side < 0.0) == (arc.sweep > 0.0)
