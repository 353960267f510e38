"""Which outlines of a layer does a place near them choose, and which edge?"""

from __future__ import annotations

import math
from collections.abc import Sequence

from watchsim.drawing.chaining.track import nearest_fraction
from watchsim.geometry.inside import winding
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line, Point

SAME = 1e-8  # m; edges as near as this to each other cannot be distinguished by a place
CLEARER = 2.0  # times: so much farther off than the nearest must the next one be


def part_near(loops: Sequence[Loop], place: Point) -> tuple[tuple[int, ...], bool]:
    """The numbers of the outline nearest to the place (of one that holds it, if any does) and of the holes in it, and whether
    it is clearly the intended one."""
    order = sorted(parts_of(loops), key=lambda part: _away(loops[part[0]], place))
    if not order:
        return (), False
    clear = len(order) == 1 or _away(loops[order[1][0]], place) > CLEARER * _away(loops[order[0][0]], place)
    return order[0], clear


def parts_of(loops: Sequence[Loop]) -> list[tuple[int, ...]]:
    """The numbers of each outer outline or open chain with those of the holes in it."""
    outer = [k for k, loop in enumerate(loops) if not loop.hole]
    owners = {k: _owner(loops, outer, loop) for k, loop in enumerate(loops) if loop.hole}
    alone = [(k,) for k, owner in owners.items() if owner is None]
    return [(k, *(hole for hole, owner in owners.items() if owner == k)) for k in outer] + alone


def _away(loop: Loop, place: Point) -> float:
    """Distance of the place from the outline, 0 inside of it."""
    if loop.closed and winding(loop, place):
        return 0.0
    return min(math.dist(edge.point(nearest_fraction(edge, place)), place) for edge in loop.edges)


def _owner(loops: Sequence[Loop], outer: Sequence[int], hole: Loop) -> int | None:
    """The smallest outline around a hole."""
    around = [k for k in outer if loops[k].closed and winding(loops[k], hole.edges[0].point(0.5))]
    return min(around, key=lambda k: loops[k].length, default=None)


def lines_near(loops: Sequence[Loop], place: Point) -> list[tuple[Line, float]]:
    """The straight edges nearest to the place, several where they meet there, and which fraction of each lies nearest."""
    lines = [(edge, nearest_fraction(edge, place)) for loop in loops for edge in loop.edges if isinstance(edge, Line)]
    away = [math.dist(line.point(fraction), place) for line, fraction in lines]
    return [one for one, distance in zip(lines, away, strict=True) if distance <= min(away) + SAME]
