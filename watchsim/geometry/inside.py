"""Does this point lie inside the outline?

Exact for arcs: the winding number of the polygon of chords, and one turn more for each arc between which and its chord the
point lies.
"""

from __future__ import annotations

import math

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Point


def winding(loop: Loop, p: Point) -> int:
    """How often the closed loop runs counter-clockwise round `p` (metres); on the outline itself either answer may come."""
    x, y = p
    turns = 0
    previous = loop.edges[-1].end
    for edge in loop.edges:
        start, end = edge.start, edge.end
        turns += _crossing(previous[0] - x, previous[1] - y, start[0] - x, start[1] - y)
        turns += _crossing(start[0] - x, start[1] - y, end[0] - x, end[1] - y)
        if isinstance(edge, Arc) and _under(edge, start, end, p):
            turns += 1 if edge.sweep > 0.0 else -1
        previous = end
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
