"""Which outline does a shape written into the scene have: a circle, a polygon, a line?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import TURN, Arc, Line, Point
from watchsim.scene.file.keys.key_values import Table, shown


def shape_loops(table: Table, key: str) -> tuple[Loop, ...]:
    """The outline under "circle", "polygon" or "line" of a body; its layer is named after the shape. Empty after a fault."""
    known = len(table.faults.found)
    readers = {"circle": _circle, "polygon": _polygon, "line": _line}
    loop = readers[key](table)
    return (loop,) if loop and len(table.faults.found) == known else ()


def _circle(table: Table) -> Loop:
    radius = table.positive("circle", "it is the radius")
    return Loop((Arc(0.0, 0.0, radius, 0.0, TURN),), "circle")


def _line(table: Table) -> Loop | None:
    points = _points(table, "line", at_least=2)
    if len(points) > 2:
        table.fault("line", "a line has two points; more make a polygon")
    if len(points) != 2:
        return None
    if points[0] == points[1]:
        table.fault("line", "its two points are the same")
        return None
    return Loop((Line(*points[0], *points[1]),), "line", closed=False)


def _polygon(table: Table) -> Loop | None:
    """Counter-clockwise whichever way it was written: the material is inside."""
    points = _points(table, "polygon", at_least=3)
    if points and not any(math.isnan(c) for point in points for c in point):
        _note_defects(table, points)
        points = points if signed_area(points) > 0.0 else points[::-1]
    edges = tuple(Line(*start, *end) for start, end in zip(points, (*points[1:], *points[:1]), strict=True))
    return Loop(edges, "polygon") if edges else None


def _points(table: Table, key: str, at_least: int) -> tuple[Point, ...]:
    value, dimension = table.mapping[key], table.dimension(key)
    if not isinstance(value, (list, tuple)) or len(value) < at_least:
        example = '["0 mm", "0 mm"], ["5 mm", "0 mm"]' + (', ["0 mm", "5 mm"]' if at_least > 2 else "")
        table.faults.add(
            f"{table.path}.{key}", f"a list of at least {at_least} points is needed here: {key} = [{example}]", shown(value)
        )
        return ()
    return tuple(table.point(f"{key}.{i}", item, dimension) for i, item in enumerate(value))


def _note_defects(table: Table, points: Sequence[Point]) -> None:
    if len(set(points)) < len(points):
        table.fault("polygon", "a point occurs twice in it; the outline closes by itself, without repeating the first point")
    elif signed_area(points) == 0.0:
        table.fault("polygon", "it encloses no area")
    elif crossing := first_crossing(points):
        table.fault("polygon", f"its sides {crossing[0]} and {crossing[1]} (counted from 0) cross each other")


def signed_area(points: Sequence[Point]) -> float:
    """Area of the polygon in m², positive when it runs counter-clockwise."""
    x0, y0 = points[0]
    local = [(x - x0, y - y0) for x, y in points]
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise(local))


def first_crossing(points: Sequence[Point]) -> tuple[int, int] | None:
    """Two sides that are no neighbours and meet."""
    sides = list(zip(points, (*points[1:], points[0]), strict=True))
    for i, first in enumerate(sides):
        for j in range(i + 2, len(sides) - (1 if i == 0 else 0)):
            if _meet(first, sides[j]):
                return i, j
    return None


def _meet(first: tuple[Point, Point], second: tuple[Point, Point]) -> bool:
    (a, b), (c, d) = first, second
    return _turn(a, b, c) * _turn(a, b, d) <= 0 and _turn(c, d, a) * _turn(c, d, b) <= 0 and _boxes_meet(first, second)


def _turn(a: Point, b: Point, c: Point) -> int:
    cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (cross > 0.0) - (cross < 0.0)


def _boxes_meet(first: tuple[Point, Point], second: tuple[Point, Point]) -> bool:
    for axis in (0, 1):
        low, high = sorted(point[axis] for point in first)
        other_low, other_high = sorted(point[axis] for point in second)
        if high < other_low or other_high < low:
            return False
    return True
