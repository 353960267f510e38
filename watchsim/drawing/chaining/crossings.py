"""Where do outlines cross themselves, each other, or lie on each other?

Joints are snapped before; what crosses less deeply than rounding is a touch. An open chain is asked about itself only: a
centre line may cross what it likes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np

from watchsim.drawing.chaining.nodes import TIGHT, Grid
from watchsim.drawing.chaining.open_ends import shown
from watchsim.drawing.chaining.outline_source import Outline
from watchsim.drawing.chaining.track import Track, nearest_fraction, passes_through
from watchsim.drawing.findings import Finding
from watchsim.geometry.edge_table import Table, table_of
from watchsim.geometry.meetings import meetings, within
from watchsim.geometry.near_edges import Floats, Ints, near_pairs
from watchsim.geometry.primitives import Arc, Edge, Point

SHALLOW = 10.0 * TIGHT  # metres: crossings less deep, and overlaps shorter, are rounding
AT_ONCE = 1 << 17  # pairs of edges whose points are worked out in one go
MOST = 2000  # findings of a layer: with more, the drawing as a whole is wrong


class Meeting(NamedTuple):
    """Two edges, by their numbers among all edges of the layer, and the points they share."""

    first: int
    second: int
    points: list[Point]


class Layer:
    """All edges of the outlines of one layer in one row."""

    def __init__(self, outlines: Sequence[Outline], depth: float) -> None:
        self.outlines, self.depth = outlines, depth
        self.edges: list[Edge] = [edge for outline in outlines for edge in outline.loop.edges]
        self.sources = [source for outline in outlines for source in outline.sources]
        counts = [len(outline.loop.edges) for outline in outlines]
        self.owner = np.repeat(np.arange(len(outlines)), counts)
        self.first = np.append(0, np.cumsum(counts))
        self.closed = np.array([outline.loop.closed for outline in outlines], dtype=bool)
        self.tracks: dict[int, Track] = {}

    def track(self, edge: int) -> tuple[Track, int]:
        """The chain of an edge, and the edge's number in it."""
        owner = int(self.owner[edge])
        if owner not in self.tracks:
            self.tracks[owner] = Track(self.outlines[owner].loop)
        return self.tracks[owner], edge - int(self.first[owner])

    def may_cross(self, first: Ints, second: Ints) -> np.ndarray:
        a, b = self.owner[first], self.owner[second]
        return (a == b) | (self.closed[a] & self.closed[b])

    def follows(self, before: Ints, after: Ints) -> np.ndarray:
        """Is the second edge the next one of the same chain?"""
        owner = self.owner[before]
        last = before == self.first[owner + 1] - 1
        following = np.where(last & self.closed[owner], self.first[owner], before + 1)
        return (owner == self.owner[after]) & (following == after) & ~(last & ~self.closed[owner])


def crossings(outlines: Sequence[Outline], deviation: float = 0.0) -> list[Finding]:
    """Errors for crossings and warnings for edges on each other, for the outlines of one layer.

    `deviation` in metres is how far edges may lie from what was drawn: a curl of that size comes from the fit.
    """
    if sum(len(outline.loop.edges) for outline in outlines) < 2:
        return []
    layer = Layer(outlines, max(SHALLOW, 2.0 * deviation))
    found: list[Finding] = []
    places: dict[tuple[int, int], Grid] = {}
    name = outlines[0].loop.layer
    meets, crowds = all_meetings(layer)
    for meeting in meets:
        overlapping = stretches(layer, meeting)
        found += [overlap_finding(layer, meeting, *ends) for ends in overlapping]
        for p in meeting.points:
            on = any(math.dist(p, end) <= SHALLOW for ends in overlapping for end in ends)
            if not on and crosses(layer, meeting, p) and fresh(layer, meeting, p, places):
                found.append(crossing_finding(layer, meeting, p))
        if len(found) >= MOST:
            message = f"more than {MOST} crossings and overlaps; the others were not looked for"
            return [*found, Finding("crowded", "warning", message, "Put different parts on different layers.", name)]
    return found + [crowd_finding(name, p) for p in crowds]


def all_meetings(layer: Layer) -> tuple[Iterator[Meeting], tuple[Point, ...]]:
    """Pairs of edges that meet other than at their common joint, and where there were too many edges to tell."""
    table = table_of(layer.edges)
    near = near_pairs(table, TIGHT)
    parts = (slice(k, k + AT_ONCE) for k in range(0, len(near.first), AT_ONCE))
    found = (meetings_of(layer, table, near.first[part], near.second[part]) for part in parts)
    return chain.from_iterable(found), near.crowds


def meetings_of(layer: Layer, table: Table, one: Ints, other: Ints) -> Iterator[Meeting]:
    """The same for some pairs."""
    found = meetings(table, one, other, TIGHT)
    first, second, point = one[found.pair], other[found.pair], found.point
    elsewhere = np.ones(len(point), bool)
    for before, after in ((first, second), (second, first)):
        end, start = table.end[before], table.start[after]
        gap = np.hypot(*(end - start).T)
        away = np.minimum(np.hypot(*(point - end).T), np.hypot(*(point - start).T))
        elsewhere &= ~layer.follows(before, after) | (away > 2.0 * gap + 4.0 * TIGHT)
    keep = np.zeros(len(one), bool)
    keep[found.pair[elsewhere]] = True  # then with the joint, from which two edges may run back along each other
    order = np.flatnonzero(keep[found.pair])
    order = order[np.argsort(found.pair[order], kind="stable")]
    return grouped(layer, first[order], second[order], point[order])


def grouped(layer: Layer, first: Ints, second: Ints, point: Floats) -> Iterator[Meeting]:
    """One Meeting for each pair; pairs that may cross, or have two points and so could lie on each other."""
    if not len(first):
        return
    changes = np.append(True, (first[1:] != first[:-1]) | (second[1:] != second[:-1]))
    starts = np.flatnonzero(changes)
    spread = np.maximum.reduceat(point, starts) - np.minimum.reduceat(point, starts)
    wanted = layer.may_cross(first[starts], second[starts]) | (spread.max(axis=1) > SHALLOW)
    stops = np.append(starts[1:], len(first))
    for start, stop in zip(starts[wanted].tolist(), stops[wanted].tolist(), strict=True):
        points: list[Point] = []
        for x, y in point[start:stop].tolist():
            if all(math.dist((x, y), other) > SHALLOW for other in points):
                points.append((x, y))
        yield Meeting(int(first[start]), int(second[start]), points)


def stretches(layer: Layer, meeting: Meeting) -> list[tuple[Point, Point]]:
    """The parts along which two edges lie on each other, by their ends."""
    a, b = layer.edges[meeting.first], layer.edges[meeting.second]
    if len(meeting.points) < 2 or isinstance(a, Arc) != isinstance(b, Arc):
        return []
    by_way = sorted((nearest_fraction(a, p), p) for p in meeting.points)
    if isinstance(a, Arc) and a.is_circle:
        by_way.append((by_way[0][0] + 1.0, by_way[0][1]))
    pieces = [(p, q, a.point(0.5 * (s + t))) for (s, p), (t, q) in pairwise(by_way)]
    table = table_of([b])
    zero = np.zeros(1, np.int64)
    return [(p, q) for p, q, middle in pieces if within(table, zero, np.array([middle]), TIGHT)[0]]


def fresh(layer: Layer, meeting: Meeting, p: Point, places: dict[tuple[int, int], Grid]) -> bool:
    """Is this the first pair of edges of these two outlines that meets there (at a corner there are up to four)?"""
    a, b = int(layer.owner[meeting.first]), int(layer.owner[meeting.second])
    grid = places.setdefault((min(a, b), max(a, b)), Grid(SHALLOW))
    if grid.around(p):
        return False
    grid.add(p, 0)
    return True


def crosses(layer: Layer, meeting: Meeting, p: Point) -> bool:
    """Does one outline go over to the other side of the other one at `p`?"""
    first, second = np.array([meeting.first]), np.array([meeting.second])
    if not layer.may_cross(first, second)[0]:
        return False
    (a, i), (b, j) = layer.track(meeting.first), layer.track(meeting.second)
    return passes_through(a, a.position(i, p), b, b.position(j, p), layer.depth)


def names(layer: Layer, meeting: Meeting) -> str:
    one, other = layer.sources[meeting.first], layer.sources[meeting.second]
    return f"{one} and {other}" if one != other else f"two pieces of {one}"


def crossing_finding(layer: Layer, meeting: Meeting, p: Point) -> Finding:
    itself = layer.owner[meeting.first] == layer.owner[meeting.second]
    loop = layer.outlines[int(layer.owner[meeting.first])].loop
    what = (
        ("the outline crosses itself" if loop.closed else "the open chain crosses itself") if itself else "two outlines cross"
    )
    message = f"{what} at {shown(p)} mm: {names(layer, meeting)}"
    fix = "Trim them there in CAD" + ("." if itself else ", or put them on different layers.")
    severity = "error" if loop.closed else "warning"
    return Finding("crossing", severity, message, fix, loop.layer, 1e3 * p[0], 1e3 * p[1])


def overlap_finding(layer: Layer, meeting: Meeting, p: Point, q: Point) -> Finding:
    """A notice where two closed outlines share a border, as parts side by side do; a warning where an edge is too much."""
    a, b = (int(layer.owner[number]) for number in (meeting.first, meeting.second))
    neighbours = a != b and bool(layer.closed[a] and layer.closed[b])
    message = f"{names(layer, meeting)} lie on each other between {shown(p)} and {shown(q)} mm"
    severity, fix = ("notice", "") if neighbours else ("warning", "Leave only one of them there.")
    x, y = 0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])
    return Finding("overlap", severity, message, fix, layer.outlines[a].loop.layer, 1e3 * x, 1e3 * y)


def crowd_finding(layer: str, p: Point) -> Finding:
    message = f"so many edges run together near {shown(p)} mm that not all crossings there were looked for"
    return Finding("crowded", "warning", message, "", layer, 1e3 * p[0], 1e3 * p[1])
