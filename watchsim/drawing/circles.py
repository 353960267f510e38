"""Which outlines of a drawing are circles, where are their centres, and how large are they?

In one piece, or in several arcs of one centre, as programs that know no circles draw them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from watchsim.drawing.drawn_material import MARKS, last_word
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Point

SAME = 1e-9  # m: centres and radii this close are one
SHOWN = 8  # circles of a layer written out


class Circle(NamedTuple):
    """Metres."""

    centre: Point
    radius: float


def circle_of(loop: Loop) -> Circle | None:
    """The circle that a closed outline is; None where it is none."""
    first = loop.edges[0]
    if not loop.closed or not isinstance(first, Arc):
        return None
    if len(loop.edges) == 1:
        return Circle((first.x, first.y), first.radius) if first.is_circle else None
    for edge in loop.edges:
        if not isinstance(edge, Arc) or abs(edge.radius - first.radius) > SAME:
            return None
        if math.dist((edge.x, edge.y), (first.x, first.y)) > SAME:
            return None
    return Circle((first.x, first.y), first.radius)


def circle_reports(loops: Iterable[Loop]) -> list[dict[str, object]]:
    """For `inspect --json`: layer, centre and radius (mm), and whether it is a hole."""
    return [
        {
            "layer": loop.layer,
            "x_mm": 1e3 * circle.centre[0],
            "y_mm": 1e3 * circle.centre[1],
            "radius_mm": 1e3 * circle.radius,
            "hole": loop.hole,
        }
        for loop in loops
        if (circle := circle_of(loop)) is not None
    ]


def circle_lines(loops: Iterable[Loop]) -> Iterator[str]:
    """For people: the circles of one layer, equal ones together."""
    alike: dict[tuple[str, str], list[Point]] = {}
    for loop in loops:
        circle = circle_of(loop)
        if circle is not None:
            word = "pivot" if last_word(loop.layer) in MARKS else "hole" if loop.hole else "circle"
            alike.setdefault((word, f"{1e3 * circle.radius:.6g}"), []).append(circle.centre)
    shown = 0
    for (word, radius), centres in alike.items():
        kept = centres[: max(0, SHOWN - shown)]
        shown += len(centres)
        places = ", ".join(f"({_mm(x)}, {_mm(y)})" for x, y in kept)
        rest = len(centres) - len(kept)
        more = "" if not rest else f" and {rest} more" if kept else f"{rest}"
        where = f" at {places}{' mm' if kept else ''}{more}" if kept else f": {more}"
        yield f"{word if len(centres) == 1 else word + 's'} of radius {radius} mm{where}"


def _mm(value: float) -> str:
    return f"{round(1e3 * value, 6) + 0.0:.6g}"
