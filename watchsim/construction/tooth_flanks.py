"""How does the outline of a gear follow from one flank of a tooth?

In the gear's own frame, millimetres; tooth 0 is centred on the x axis.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from watchsim.construction.outline import arc_between, circle
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

BORE = 0.25  # by the radius of the floor


def arc_through(first: Point, middle: Point, last: Point) -> Edge:
    """The arc through three points."""
    ax, ay = middle[0] - first[0], middle[1] - first[1]
    bx, by = last[0] - first[0], last[1] - first[1]
    cross = 2.0 * (ax * by - ay * bx)
    a, b = ax * ax + ay * ay, bx * bx + by * by
    centre = (first[0] + (by * a - ay * b) / cross, first[1] + (ax * b - bx * a) / cross)
    return arc_between(first, last, centre, cross > 0.0)


def other_flank(right: Sequence[Edge]) -> list[Edge]:
    """The left flank, from tip to foot, of a tooth whose right one is given from foot to tip."""
    return [_mirrored(edge).reversed() for edge in reversed(right)]


def gear_outline(layer: str, tooth: Sequence[Edge], teeth: int, floor: float) -> list[Loop]:
    """The toothed contour, one tooth with its gap turned round, and the bore."""
    one, pitch = Loop(tuple(tooth), layer), 2.0 * math.pi / teeth
    edges = [edge for i in range(teeth) for edge in one.moved(i * pitch, (0.0, 0.0)).edges]
    return [Loop(tuple(edges), layer), circle(layer, (0.0, 0.0), BORE * floor, hole=True)]


def _mirrored(edge: Edge) -> Edge:
    """Across the x axis; from the same end to the same end."""
    if isinstance(edge, Line):
        return Line(edge.x0, -edge.y0, edge.x1, -edge.y1)
    start, end = (edge.start[0], -edge.start[1]), (edge.end[0], -edge.end[1])
    return arc_between(start, end, (edge.x, -edge.y), edge.sweep < 0.0)
