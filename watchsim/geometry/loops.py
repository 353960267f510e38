"""What is a sound outline, how large is it, which points draw it, which lie inside, and where do its edges meet?

An outline is a chain of edges, each starting where the one before ends; closed, it bounds material on its left: an outer
outline runs counter-clockwise, a hole clockwise. Pictures, movies and overlap checks need plain vertices; lines give their
ends, arcs are sampled so finely that no chord strays further from its arc than requested.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.primitives import TURN, Arc, Edge, Point, moved, reflected


@dataclass(frozen=True)
class Loop:
    """An oriented chain of edges in metres, with the layer it was drawn on.

    `closed` False marks an open chain; `hole` True a loop that bounds the inside of another one.
    """

    edges: tuple[Edge, ...]
    layer: str = "0"
    closed: bool = True
    hole: bool = False

    @property
    def length(self) -> float:
        return sum(edge.length for edge in self.edges)

    @cached_property
    def box(self) -> Box | None:
        """As `extents`, of this one."""
        return extents([self])

    def reversed(self) -> Loop:
        edges = tuple(edge.reversed() for edge in reversed(self.edges))
        return Loop(edges, self.layer, self.closed, self.hole)

    def moved(self, angle: float, shift: Point) -> Loop:
        """Turned by `angle` (radians) about the origin, then shifted (metres)."""
        return Loop(tuple(moved(edge, angle, shift) for edge in self.edges), self.layer, self.closed, self.hole)

    def reflected(self, foot: Point, direction: Point) -> Loop:
        """Its image across the line through `foot` along the unit vector `direction`, still with the material on the left."""
        edges = tuple(reflected(edge, foot, direction).reversed() for edge in reversed(self.edges))
        return Loop(edges, self.layer, self.closed, self.hole)


Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

QUARTER = 0.5 * math.pi


class Table(NamedTuple):
    """Edges as columns, metres and radians: ends, boxes (n, 4), and for arcs centre, radius, start angle and sweep."""

    start: Floats
    end: Floats
    box: Floats
    arc: Flags
    centre: Floats
    radius: Floats
    start_angle: Floats
    sweep: Floats


def table_of(edges: Sequence[Edge]) -> Table:
    """The edges in columns; what only arcs have is 0 for lines."""
    rows = [
        (e.x, e.y, e.radius, e.start_angle, e.sweep) if isinstance(e, Arc) else (e.x0, e.y0, e.x1, e.y1, 0.0) for e in edges
    ]
    columns = np.array(rows, dtype=float).reshape(-1, 5)
    arc = np.array([isinstance(edge, Arc) for edge in edges], dtype=bool)
    start, end = columns[:, :2].copy(), columns[:, 2:4].copy()
    columns[~arc] = 0.0
    centre, (radius, angle, sweep) = columns[:, :2], columns[:, 2:].T
    for corner, at in ((start, angle), (end, angle + sweep)):
        corner[arc] = (centre + radius[:, None] * np.column_stack((np.cos(at), np.sin(at))))[arc]
    low, high = np.minimum(angle, angle + sweep) / QUARTER, np.maximum(angle, angle + sweep) / QUARTER
    box = np.hstack((np.minimum(start, end), np.maximum(start, end)))
    # An arc reaches furthest along an axis where it passes a whole quarter turn: 0 to 3, or any number of turns later.
    for quarter, (column, furthest) in enumerate(((2, np.maximum), (3, np.maximum), (0, np.minimum), (1, np.minimum))):
        passes = arc & (4.0 * np.ceil((low - quarter) / 4.0) + quarter <= high)
        side = centre[:, column % 2] + radius * (1.0 if column > 1 else -1.0)
        box[passes, column] = furthest(box[passes, column], side[passes])
    return Table(start, end, box, arc, centre, radius, angle, sweep)


Box = tuple[float, float, float, float]
FEW = 32  # edges: from columns it takes longer


def edge_extents(edge: Edge) -> Box:
    """(xmin, ymin, xmax, ymax) in metres, exact for arcs: their ends and the points in between that look along an axis."""
    (x0, y0), (x1, y1) = edge.start, edge.end
    xs, ys = [x0, x1], [y0, y1]
    if isinstance(edge, Arc):
        low, high = sorted((edge.start_angle, edge.start_angle + edge.sweep))
        for k in range(math.ceil(low / QUARTER), math.floor(high / QUARTER) + 1):
            ex, ey = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[k % 4]
            xs.append(edge.x + edge.radius * ex)
            ys.append(edge.y + edge.radius * ey)
    return (min(xs), min(ys), max(xs), max(ys))


def extents(loops: Iterable[Loop]) -> Box | None:
    """The box around all loops and chains in metres; None where there are none."""
    edges = [edge for loop in loops for edge in loop.edges]
    if not edges:
        return None
    if len(edges) > FEW:
        box = table_of(edges).box
        return (*box[:, :2].min(axis=0).tolist(), *box[:, 2:].max(axis=0).tolist())
    xmin, ymin, xmax, ymax = zip(*map(edge_extents, edges), strict=True)
    return (min(xmin), min(ymin), max(xmax), max(ymax))


def total_length(loops: Iterable[Loop]) -> float:
    """Metres along all edges."""
    return math.fsum(edge.length for loop in loops for edge in loop.edges)


# Edges that come near each other: a tree of square cells is refined, all cells of one level at once, until few edges pass
# through each cell; only edges that share a cell can meet. The work grows with the number of edges, however they are arranged:
# where very many run together, not every pair is given, and it is said where.

Ints = NDArray[np.int64]

FEW_EDGES = 200  # up to that many, all pairs are compared
IN_CELL = 24  # edges in a cell that is refined no further
DEEPEST = 30  # levels: cells of a billionth of the drawing
GROWTH = 64  # entries per edge; edges that run along each other could be cut into cells for ever
MOST_ENTRIES = 3_000_000  # of edges in cells, and
MOST_PAIRS = 4_000_000  # of which each may be found in several cells: more would take too much memory
MOST_CROWDS = 8  # places reported
CROWD = 32  # partners looked at for each edge in a cell that could not be refined
AT_ONCE = 1 << 17  # entries refined in one go


class Pairs(NamedTuple):
    """Numbers of edges that could meet, first < second, and where there were too many edges to give all of them."""

    first: Ints
    second: Ints
    crowds: tuple[Point, ...]


def near_pairs(table: Table, reach: float) -> Pairs:
    """All pairs of edges that come within `reach` metres of each other, and some more."""
    count = len(table.box)
    if count < 2:
        return Pairs(np.empty(0, np.int64), np.empty(0, np.int64), ())
    if count <= FEW_EDGES and count * count <= MOST_PAIRS:
        lower, upper = table.box[:, :2], table.box[:, 2:] + reach
        near = (lower[:, None] <= upper).all(axis=2)
        first, second = np.nonzero(np.triu(near & near.T, 1))
        return Pairs(first, second, ())
    low = table.box[:, :2].min(axis=0)
    width = float((table.box[:, 2:].max(axis=0) - low).max()) * (1.0 + 1e-12) + reach
    edge, cell = np.arange(count), np.zeros((count, 2), np.int64)
    keys: list[Ints] = []
    crowds: list[Point] = []
    room = MOST_PAIRS
    for level in range(DEEPEST + 1):
        size = width / 2**level
        order = np.lexsort((edge, cell[:, 1], cell[:, 0]))
        edge, cell = edge[order], cell[order]
        starts = np.flatnonzero(np.append(True, np.any(cell[1:] != cell[:-1], axis=1)))
        counts = np.diff(np.append(starts, len(edge)))
        last = level == DEEPEST or len(edge) > min(GROWTH * count, MOST_ENTRIES) or size < 4.0 * reach
        done = np.ones(len(counts), bool) if last else counts <= IN_CELL
        found, complete = _paired(table, edge, starts[done], counts[done], reach, room)
        keys += found
        room -= sum(map(len, found))
        full = done & (counts > CROWD) if complete else done & (counts == counts[done].max())
        crowds += [tuple((low + (cell[k] + 0.5) * size).tolist()) for k in starts[full][:MOST_CROWDS]]
        if np.all(done) or not complete:
            break
        crowded = np.repeat(~done, counts)
        edge, cell = _refined(table, edge[crowded], cell[crowded], low, 0.5 * size, reach)
    ordered = np.sort(np.concatenate(keys)) if keys else np.empty(0, np.int64)
    unique = ordered[np.append(True, ordered[1:] != ordered[:-1])[: len(ordered)]]
    return Pairs(unique // count, unique % count, tuple(crowds))


def _paired(table: Table, edge: Ints, starts: Ints, counts: Ints, reach: float, room: int) -> tuple[list[Ints], bool]:
    """Keys first · n + second of the pairs within each group; in groups above CROWD each with its next ones only.

    False where there are more than `room`: then not all were looked for.
    """
    keys: list[Ints] = []
    last = np.repeat(starts + counts, counts)  # one past the group's end, for each of its members
    member = np.repeat(starts - np.append(0, np.cumsum(counts)[:-1]), counts) + np.arange(int(counts.sum()))
    for step in range(1, int(min(counts.max(initial=0), CROWD + 1))):
        fits = member + step < last
        member, last = member[fits], last[fits]
        first, second = edge[member], edge[member + step]
        a, b = table.box[first], table.box[second]
        near = np.all((a[:, :2] <= b[:, 2:] + reach) & (b[:, :2] <= a[:, 2:] + reach), axis=1)
        keys.append(first[near] * len(table.box) + second[near])
        room -= len(keys[-1])
        if room < 0:
            return keys, False
    return keys, True


def _refined(table: Table, edge: Ints, cell: Ints, low: Floats, size: float, reach: float) -> tuple[Ints, Ints]:
    """The quarters (of width `size`) of the cells that each edge really passes through, within `reach`."""
    parts = [
        _quartered(table, edge[k : k + AT_ONCE], cell[k : k + AT_ONCE], low, size, reach) for k in range(0, len(edge), AT_ONCE)
    ]
    edges, cells = zip(*parts, strict=True)
    return np.concatenate(edges), np.concatenate(cells)


def _quartered(table: Table, edge: Ints, cell: Ints, low: Floats, size: float, reach: float) -> tuple[Ints, Ints]:
    edge = np.repeat(edge, 4)
    cell = np.repeat(2 * cell, 4, axis=0) + np.tile(np.array([[0, 0], [0, 1], [1, 0], [1, 1]]), (len(cell), 1))
    middle, half = low + (cell + 0.5) * size, 0.5 * size + reach
    box = table.box[edge]
    inside = np.all((box[:, :2] <= middle + half) & (box[:, 2:] >= middle - half), axis=1)
    edge, cell, middle = edge[inside], cell[inside], middle[inside]
    arcs = table.arc[edge]
    passes = np.empty(len(edge), bool)
    passes[arcs] = _arc_passes(table, edge[arcs], middle[arcs], half)
    passes[~arcs] = _line_passes(table, edge[~arcs], middle[~arcs], half)
    return edge[passes], cell[passes]


def _line_passes(table: Table, edge: Ints, middle: Floats, half: float) -> Flags:
    """Does the straight line through the ends cut the square round `middle`?"""
    along, to = table.end[edge] - table.start[edge], middle - table.start[edge]
    return np.abs(along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]) <= half * np.abs(along).sum(axis=1)


def _arc_passes(table: Table, edge: Ints, middle: Floats, half: float) -> Flags:
    """Does the whole circle cut the square round `middle`?"""
    off = np.abs(middle - table.centre[edge])
    nearest, farthest = np.maximum(off - half, 0.0), off + half
    radius = table.radius[edge]
    return (np.hypot(*nearest.T) <= radius) & (np.hypot(*farthest.T) >= radius)


# Where two edges meet: closed forms for lines and arcs, for many pairs at once: the roots of line and line, line and circle,
# circle and circle, and ends of one edge that lie on the other (which edges along each other have instead of roots).

PARALLEL = 1e-12  # sine of the angle between lines below which their root is rounding


class Meetings(NamedTuple):
    """Points (m, 2) in metres at which pair `pair` meets; the same point may come several times."""

    pair: Ints
    point: Floats


def meetings(table: Table, first: Ints, second: Ints, reach: float) -> Meetings:
    """All points where edges first[k] and second[k] come together within `reach` metres."""
    numbers, none = np.arange(len(first)), np.zeros((0, 2))
    # All at once: most calls are of few pairs, where a call costs more than what it computes.
    ends = np.concatenate([end[a] for a in (first, second) for end in (table.start, table.end)])
    pairs, others = np.tile(numbers, 4), np.concatenate([second, second, first, first])
    keep = within(table, others, ends, reach)
    pairs, points = pairs[keep], ends[keep]
    some: list[Ints] = []
    root: list[Floats] = [none]
    for a_arc, b_arc, roots in ((False, False, _lines), (False, True, _line_circle), (True, True, _circles)):
        for a, b in ((first, second), (second, first))[: 1 if a_arc == b_arc else 2]:
            chosen = numbers[(table.arc[a] == a_arc) & (table.arc[b] == b_arc)]
            for found, point in roots(table, a[chosen], b[chosen], reach) if len(chosen) else ():
                some.append(chosen[found])
                root.append(point[found])
    met, place = np.concatenate([numbers[:0], *some]), np.concatenate(root)
    keep = within(table, first[met], place, reach) & within(table, second[met], place, reach)
    return Meetings(np.concatenate([pairs, met[keep]]), np.concatenate([points, place[keep]]))


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


class Inside:
    """Answers for many points of one closed loop: its edges are sorted into strips of height, and one strip is looked at.

    Exact for arcs: the winding number of the polygon of chords, and one turn more for each arc between which and its chord the
    point lies.
    """

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


SMALLEST_STEP = 1e-4  # radians; a finer chord differs from its arc by rounding only


def chords(arc: Arc, deviation: float) -> int:
    """Number of equal chords (at least 1; a turn at least 3) whose sagitta stays below `deviation` metres."""
    ratio = min(max(deviation / arc.radius, 0.0), 1.0) if arc.radius > 0.0 else 1.0
    step = max(2.0 * math.acos(1.0 - ratio), SMALLEST_STEP)
    fewest = math.ceil(abs(arc.sweep) / (2.0 * math.pi / 3.0) - 1e-9)
    return max(1, fewest, math.ceil(abs(arc.sweep) / step))


def edge_points(edge: Edge, deviation: float) -> NDArray[np.float64]:
    """(n, 2) points from the start of the edge to just before its end, metres."""
    if not isinstance(edge, Arc):
        return np.array([edge.start])
    count = chords(edge, deviation)
    angles = edge.start_angle + edge.sweep * np.arange(count) / count
    return np.column_stack((edge.x + edge.radius * np.cos(angles), edge.y + edge.radius * np.sin(angles)))


def points_along(edge: Edge, fractions: NDArray[np.float64]) -> NDArray[np.complex128]:
    """The points x + iy (m) at these fractions (0 to 1) of the way."""
    if isinstance(edge, Arc):
        return complex(edge.x, edge.y) + edge.radius * np.exp(1j * (edge.start_angle + fractions * edge.sweep))
    start, end = complex(*edge.start), complex(*edge.end)
    return np.asarray(start + fractions * (end - start))


def polyline(loop: Loop, deviation: float) -> NDArray[np.float64]:
    """(n, 2) points along the loop in metres, arcs within `deviation` metres; a closed loop ends on its first point."""
    if not loop.edges:
        return np.empty((0, 2))
    parts = [edge_points(edge, deviation) for edge in loop.edges]
    last = parts[0][:1] if loop.closed else np.array([loop.edges[-1].end])
    return np.concatenate([*parts, last])
