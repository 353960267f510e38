"""Where do two edges meet?

Closed forms for lines and arcs, for many pairs at once: the roots of line and line, line and circle, circle and circle, and
ends of one edge that lie on the other (which edges along each other have instead of roots).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loops import Floats, Ints, Table
from watchsim.geometry.primitives import TURN

Flags = NDArray[np.bool_]
PARALLEL = 1e-12  # sine of the angle between lines below which their root is rounding


class Meetings(NamedTuple):
    """Points (m, 2) in metres at which pair `pair` meets; the same point may come several times."""

    pair: Ints
    point: Floats


def meetings(table: Table, first: Ints, second: Ints, reach: float) -> Meetings:
    """All points where edges first[k] and second[k] come together within `reach` metres."""
    numbers = np.arange(len(first))
    pairs: list[Ints] = []
    points: list[Floats] = []
    for a, b in ((first, second), (second, first)):
        for end in (table.start, table.end):
            keep = within(table, b, end[a], reach)
            pairs.append(numbers[keep])
            points.append(end[a][keep])
    for a_arc, b_arc, roots in ((False, False, _lines), (False, True, _line_circle), (True, True, _circles)):
        for a, b in ((first, second), (second, first))[: 1 if a_arc == b_arc else 2]:
            chosen = numbers[(table.arc[a] == a_arc) & (table.arc[b] == b_arc)]
            for found, root in roots(table, a[chosen], b[chosen], reach):
                some, p = chosen[found], root[found]
                keep = within(table, a[some], p, reach) & within(table, b[some], p, reach)
                pairs.append(some[keep])
                points.append(p[keep])
    return Meetings(np.concatenate(pairs), np.concatenate(points))


def within(table: Table, edge: Ints, point: Floats, reach: float) -> Flags:
    """Does point[k] lie within `reach` metres of edge[k]?"""
    start, end = table.start[edge], table.end[edge]
    near_end = np.minimum(np.hypot(*(point - start).T), np.hypot(*(point - end).T)) <= reach
    along, to = end - start, point - start
    length = np.hypot(*along.T)
    s = np.sum(along * to, axis=1)
    beside = np.abs(along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]) <= reach * length
    on_line = (s >= 0.0) & (s <= length * length) & beside
    off = point - table.centre[edge]
    on_arc = (np.abs(np.hypot(*off.T) - table.radius[edge]) <= reach) & _in_sweep(table, edge, off)
    return near_end | np.where(table.arc[edge], on_arc, on_line)


def _in_sweep(table: Table, edge: Ints, off: Floats) -> Flags:
    """Does the direction `off` from the centre lie in the arc's sector?"""
    sweep = table.sweep[edge]
    turn = np.where(sweep < 0.0, -1.0, 1.0) * (np.arctan2(off[:, 1], off[:, 0]) - table.start_angle[edge])
    return np.mod(turn, TURN) <= np.abs(sweep)


def _lines(table: Table, a: Ints, b: Ints, reach: float) -> list[tuple[Flags, Floats]]:
    u, v = table.end[a] - table.start[a], table.end[b] - table.start[b]
    cross = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    found = np.abs(cross) > PARALLEL * np.hypot(*u.T) * np.hypot(*v.T)
    to = table.start[b] - table.start[a]
    s = (to[:, 0] * v[:, 1] - to[:, 1] * v[:, 0]) / np.where(found, cross, 1.0)
    return [(found, table.start[a] + s[:, None] * u)]


def _line_circle(table: Table, a: Ints, b: Ints, reach: float) -> list[tuple[Flags, Floats]]:
    start, u = table.start[a], table.end[a] - table.start[a]
    u = u / np.hypot(*u.T)[:, None]
    to, radius = table.centre[b] - start, table.radius[b]
    foot, beside = np.sum(u * to, axis=1), u[:, 0] * to[:, 1] - u[:, 1] * to[:, 0]
    found = np.abs(beside) <= radius + reach
    half = np.sqrt(np.maximum((radius - beside) * (radius + beside), 0.0))
    return [(found, start + (foot + side * half)[:, None] * u) for side in (-1.0, 1.0)]


def _circles(table: Table, a: Ints, b: Ints, reach: float) -> list[tuple[Flags, Floats]]:
    to, r, q = table.centre[b] - table.centre[a], table.radius[a], table.radius[b]
    apart = np.hypot(*to.T)
    found = (apart > reach) & (apart <= r + q + reach) & (apart >= np.abs(r - q) - reach)
    apart = np.where(found, apart, 1.0)
    u = to / apart[:, None]
    foot = 0.5 * (apart + (r - q) * (r + q) / apart)
    half = np.sqrt(np.maximum((r - foot) * (r + foot), 0.0))
    across = np.column_stack((-u[:, 1], u[:, 0]))
    return [(found, table.centre[a] + foot[:, None] * u + (side * half)[:, None] * across) for side in (-1.0, 1.0)]
