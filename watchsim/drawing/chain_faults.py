"""What is wrong with the edges and outlines of a layer?

Open outlines, crossings and overlaps, edges that are not intended, and outlines that nearly coincide. What was drawn twice
exactly is taken out before; of a copy that is off by some nanometres the smaller one would count as a hole, and next to nothing
would be left of the part.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.findings import Finding, Stroke, finding_at
from watchsim.drawing.material import is_mark
from watchsim.drawing.nodes import TIGHT, Grid, Nodes, Outline, Track, nearest_fraction, passes_through
from watchsim.geometry.loops import Box, Floats, Ints, Loop, Table, meetings, near_pairs, table_of, within
from watchsim.geometry.primitives import Arc, Edge, Line, Point

# Loose ends are paired with their nearest partner, so that each gap is named once, with both ends.

STRAY = 0.25  # a single line whose ends are further than this part of its length from anything is no torn outline
MENDABLE = 1e-4  # metres: up to here a larger snap is proposed
FEW = 300  # up to that many ends all pairs are compared; the library takes longer to load
NEIGHBOURS = 8  # nearest ends considered for each loose end


def open_ends(chains: Sequence[Sequence[int]], loose: Sequence[int], strokes: Sequence[Stroke], nodes: Nodes) -> list[Finding]:
    """One finding per gap between `loose` ends. `chains` are steps: 2·i travels stroke i forward, 2·i + 1 backward.

    A single line on a layer of axes or centres is meant as one.
    """
    if not loose:
        return []
    near = near_ends([nodes.ends[end] for end in loose])
    stray = stray_lines([steps[0] // 2 for steps in chains if len(steps) == 1], loose, near, strokes)
    pairs = paired(loose, near, stray, chains_of(chains, strokes))
    found = [stray_finding(strokes[number]) for number in stray if not is_mark(strokes[number].layer)]
    return found + [gap_finding(a, b, strokes, nodes) for a, b in pairs]


def near_ends(points: Sequence[Point]) -> list[tuple[float, int, int]]:
    """(distance, i, j) with i < j, nearest first, of all pairs of which one is among the nearest of the other."""
    count = min(NEIGHBOURS + 1, len(points))
    if count < 2:
        return []
    distances, others = nearest(np.array(points), count)
    own = np.broadcast_to(np.arange(len(points))[:, None], others.shape)
    first, second, gap = np.minimum(own, others).ravel(), np.maximum(own, others).ravel(), distances.ravel()
    order = np.lexsort((second, first, gap))
    order = order[first[order] != second[order]]
    pairs = zip(gap[order].tolist(), first[order].tolist(), second[order].tolist(), strict=True)
    return list(dict.fromkeys(pairs))


def nearest(points: NDArray[np.float64], count: int) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Distances and numbers (n, count) of the points nearest to each of points (n, 2), itself among them."""
    if len(points) <= FEW:
        gaps = np.hypot(*(points[:, None] - points).transpose(2, 0, 1))
        others = np.argsort(gaps, axis=1, kind="stable")[:, :count]
        return np.take_along_axis(gaps, others, axis=1), others
    from scipy.spatial import KDTree

    distances, others = KDTree(points).query(points, k=count)
    return distances, others


def stray_lines(
    alone: Sequence[int], loose: Sequence[int], near: Sequence[tuple[float, int, int]], strokes: Sequence[Stroke]
) -> dict[int, None]:
    """The single lines (numbers of strokes, as an ordered set) far from every other loose end."""
    ends = set(loose)
    stray = {number: STRAY * strokes[number].edge.length for number in alone if isinstance(strokes[number].edge, Line)}
    for gap, i, j in near:
        a, b = loose[i] // 2, loose[j] // 2
        for number in (a, b) if a != b else ():
            if gap < stray.get(number, 0.0):
                del stray[number]
    return {number: None for number in stray if {2 * number, 2 * number + 1} <= ends}


def chains_of(chains: Sequence[Sequence[int]], strokes: Sequence[Stroke]) -> dict[int, tuple[int, float]]:
    """Number and length (m) of the chain that each stroke belongs to."""
    found = {}
    for number, steps in enumerate(chains):
        length = sum(strokes[step // 2].edge.length for step in steps)
        found.update({step // 2: (number, length) for step in steps})
    return found


def paired(
    loose: Sequence[int],
    near: Sequence[tuple[float, int, int]],
    stray: dict[int, None],
    owners: Mapping[int, tuple[int, float]],
) -> list[tuple[int, int]]:
    """Loose ends in pairs, nearest first; an odd one out has the partner -1.

    The two ends of one chain belong together however far apart they are, ends of two chains only where the gap is small
    beside both: else they are ends of different parts.
    """
    free = {i: end for i, end in enumerate(loose) if end // 2 not in stray}
    pairs = []
    for gap, i, j in near:
        if i in free and j in free and related(gap, owners.get(loose[i] // 2), owners.get(loose[j] // 2)):
            pairs.append((free.pop(i), free.pop(j)))
    left: dict[int, int] = {}
    for i, end in sorted(free.items()):
        chain = owners[end // 2][0] if end // 2 in owners else -1 - i
        if chain in left:
            other = left.pop(chain)
            pairs.append((loose[other], end))
        else:
            left[chain] = i
    return pairs + [(loose[i], -1) for i in sorted(left.values())]


def related(gap: float, one: tuple[int, float] | None, other: tuple[int, float] | None) -> bool:
    """May a gap of that width lie between ends of these two chains (number, length)?"""
    if one is None or other is None or one[0] == other[0]:
        return True
    return gap <= STRAY * min(one[1], other[1])


def stray_finding(stroke: Stroke) -> Finding:
    message = f"{stroke.source} is a single line that touches nothing; it is kept as an open chain"
    fix = "Delete it, or put it on another layer."
    return finding_at(stroke.edge.point(0.5), "stray-line", "warning", message, fix, stroke.layer)


def gap_finding(end: int, partner: int, strokes: Sequence[Stroke], nodes: Nodes) -> Finding:
    """The open outline with both ends, the gap and the entities."""
    p = nodes.ends[end]
    layer = strokes[end // 2].layer
    if partner < 0:
        message = f"the outline is open at {shown(p)} mm, {named(end, strokes)}: nothing meets it there"
        return finding_at(p, "open-outline", "error", message, "Close it in CAD.", layer)
    q = nodes.ends[partner]
    gap = math.dist(p, q)
    ends = f"{named(end, strokes)} and {named(partner, strokes)}"
    width = f"{1e6 * gap:.3g} µm" if gap < 1e-3 else f"{1e3 * gap:.4g} mm"
    message = f"the outline is open: {width} between {shown(p)} and {shown(q)} mm, {ends}"
    fix = "Join them in CAD"
    if gap <= MENDABLE:
        fix += f', or set snap = "{math.ceil(1e6 * gap)} µm"'
    return replace(finding_at(p, "open-outline", "error", message, fix + ".", layer), other_mm=(1e3 * q[0], 1e3 * q[1]))


def shown(p: Point) -> str:
    """Coordinates in mm, to the nanometre: rounding noise would only confuse."""
    return "({:g}, {:g})".format(*(round(1e3 * c, 6) + 0.0 for c in p))


def named(end: int, strokes: Sequence[Stroke]) -> str:
    return f"the {'end' if end % 2 else 'start'} of {strokes[end // 2].source}"


# Where outlines cross themselves or each other, or lie on each other. Joints are snapped before; what crosses less deeply than
# rounding is a touch. An open chain is compared with itself only: a centre line may cross what it likes.

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
    crowd = "so many edges run together near {} mm that not all crossings there were looked for"
    return found + [finding_at(p, "crowded", "warning", crowd.format(shown(p)), layer=name) for p in crowds]


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
    what = f"the {'outline' if loop.closed else 'open chain'} crosses itself" if itself else "two outlines cross"
    message = f"{what} at {shown(p)} mm: {names(layer, meeting)}"
    fix = "Trim them there in CAD" + ("." if itself else ", or put them on different layers.")
    return finding_at(p, "crossing", "error" if loop.closed else "warning", message, fix, loop.layer)


def overlap_finding(layer: Layer, meeting: Meeting, p: Point, q: Point) -> Finding:
    """A notice where two closed outlines share a border, as parts side by side do; a warning where an edge is too much."""
    a, b = (int(layer.owner[number]) for number in (meeting.first, meeting.second))
    neighbours = a != b and bool(layer.closed[a] and layer.closed[b])
    message = f"{names(layer, meeting)} lie on each other between {shown(p)} and {shown(q)} mm"
    severity, fix = ("notice", "") if neighbours else ("warning", "Leave only one of them there.")
    place = (0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]))
    return finding_at(place, "overlap", severity, message, fix, layer.outlines[a].loop.layer)


# Edges without length, edges drawn twice, and slits (a line out and back, of no width) are not intended: they are taken out,
# each with a finding.

NOTHING = 1e-12  # metres; far below any decimal of a drawing
SAME = 1e-9  # metres
AT_BRIDGE = 3  # ends that meet where a bridge leaves an outline


def with_length(strokes: Sequence[Stroke]) -> tuple[list[Stroke], list[Finding]]:
    """The strokes that are longer than nothing."""
    kept, findings = [], []
    for stroke in strokes:
        if stroke.edge.length > NOTHING:
            kept.append(stroke)
        else:
            findings.append(at_edge("zero-length", f"{stroke.source} has a piece of no length; it was left out", stroke))
    return kept, findings


def at_edge(code: str, message: str, stroke: Stroke) -> Finding:
    """A notice at the middle of a stroke."""
    return finding_at(stroke.edge.point(0.5), code, "notice", message, layer=stroke.layer)


def unique_loops(outlines: Sequence[Outline]) -> tuple[list[Outline], list[Finding]]:
    """The closed loops of a layer without those that repeat another one, whatever their direction and starting point."""
    grid = Grid(SAME)
    kept: list[Outline] = []
    boxes: list[Box] = []
    findings = []
    for outline in outlines:
        loop = outline.loop
        box = loop.box or (0.0, 0.0, 0.0, 0.0)
        near = (k for k in grid.around(box[:2]) if math.dist(boxes[k], box) <= 2.0 * SAME)
        if any(same_loop(kept[k].loop, loop) for k in near):
            message = f"the outline that begins with {outline.sources[0]} is drawn twice; one was left out"
            findings.append(finding_at(loop.edges[0].point(0.5), "duplicate", "notice", message, layer=loop.layer))
            continue
        grid.add(box[:2], len(kept))
        kept.append(outline)
        boxes.append(box)
    return kept, findings


def same_loop(a: Loop, b: Loop) -> bool:
    """Do both have the same edges? Full circles are compared by centre and radius."""
    if len(a.edges) != len(b.edges):
        return False
    first, second = a.edges[0], b.edges[0]
    if isinstance(first, Arc) and isinstance(second, Arc) and first.is_circle and second.is_circle:
        return max(abs(first.x - second.x), abs(first.y - second.y), abs(first.radius - second.radius)) <= SAME
    grid = Grid(SAME)
    for k, edge in enumerate(a.edges):
        grid.add(edge.point(0.5), k)
    return all(any(same_edge(a.edges[k], edge) for k in grid.around(edge.point(0.5))) for edge in b.edges)


def same_edge(a: Edge, b: Edge) -> bool:
    """The same middle, the same length, both lines or both arcs."""
    near = math.dist(a.point(0.5), b.point(0.5)) <= SAME and abs(a.length - b.length) <= 4.0 * SAME
    return near and isinstance(a, Arc) == isinstance(b, Arc)


def without_doubles(
    strokes: Sequence[Stroke], nodes: Nodes, numbers: Iterable[int], reach: float
) -> tuple[set[int], dict[int, int], list[Finding]]:
    """Which of these strokes to keep, those among them drawn more than once (with the copy's number), and findings.

    Strokes are the same, forward or reversed, if they join the same nodes and are lines, or arcs with their middles within
    `reach` metres.
    """
    groups: dict[tuple[int, int, bool], list[int]] = {}
    kept: set[int] = set()
    doubled: dict[int, int] = {}
    findings = []
    for number in numbers:
        stroke = strokes[number]
        a, b = nodes.of(number)
        round_one = isinstance(stroke.edge, Arc)
        others = groups.setdefault((min(a, b), max(a, b), round_one), [])
        half = stroke.edge.point(0.5) if others else (0.0, 0.0)
        same = (o for o in others if not round_one or math.dist(strokes[o].edge.point(0.5), half) <= reach)
        twin = next(same, None)
        if twin is None:
            others.append(number)
            kept.add(number)
            continue
        nodes.drop(number)
        doubled[twin] = number
        by = "itself" if strokes[twin].source == stroke.source else strokes[twin].source
        findings.append(at_edge("duplicate", f"{stroke.source} repeats an edge of {by}; one was left out", stroke))
    return kept, doubled, findings


def without_slits(
    strokes: Sequence[Stroke], nodes: Nodes, kept: set[int], doubled: dict[int, int]
) -> tuple[set[int], list[Finding]]:
    """Takes out runs of doubled strokes that have no width: from a free tip into an outline, or from an outline to its hole."""
    if not doubled:
        return kept, []
    rows = unbroken_rows(strokes)
    bridges = {number for number, copy in doubled.items() if rows[number] == rows[copy]}
    findings = []
    for first in sorted(doubled):
        for tip in nodes.of(first):
            run = slit_from(first, tip, nodes, doubled, bridges) if first in kept else []
            for number in run:
                nodes.drop(number)
            if run:
                kept -= set(run)
                message = f"{strokes[first].source} goes out and back along itself: a slit without width; it was left out"
                findings.append(at_edge("slit", message, strokes[first]))
    return kept, findings


def unbroken_rows(strokes: Sequence[Stroke]) -> list[int]:
    """A number for each stroke: the same for strokes that one entity draws without lifting the pen."""
    rows = [0] * len(strokes)
    for k in range(1, len(strokes)):
        before, after = strokes[k - 1], strokes[k]
        goes_on = before.run == after.run and math.dist(before.edge.end, after.edge.start) <= SAME
        rows[k] = rows[k - 1] + (not goes_on)
    return rows


def slit_from(first: int, tip: int, nodes: Nodes, doubled: Container[int], bridges: Container[int]) -> list[int]:
    """The doubled strokes from a free tip to a branch, or from one outline to another one; empty if it is none.

    Two outlines side by side share an edge, too: only what is drawn there and back without lifting the pen is a bridge, and
    both its ends must lie on outlines that are whole without it.
    """
    run: list[int] = []
    number, node = first, tip
    bridge = len(nodes.members[tip]) == AT_BRIDGE
    if len(nodes.members[tip]) != 1 and not bridge:
        return []
    while number in (bridges if bridge else doubled) and number not in run:
        run.append(number)
        a, b = nodes.of(number)
        node = b if node == a else a
        around = nodes.members[node]
        if len(around) != 2:
            return run if len(around) > 2 and (not bridge or len(around) == AT_BRIDGE) else []
        number = next((end // 2 for end in around if end // 2 != number), -1)
    return []


NEAR = 1e-6  # m: no part has a wall that thin
SMALL = 0.05  # of an outline's size; for tiny ones that is less
PROBES = (0.0, 0.5)  # of each edge
MOST_TWINS = 64  # edges that are looked at, evenly spread


def twins(loops: Sequence[Loop]) -> list[Finding]:
    """An error for each closed outline of one layer that follows another one all along within NEAR."""
    if len(loops) < 2:
        return []
    boxes = np.array([loop.box for loop in loops])
    order = np.argsort(boxes[:, 0], kind="stable")
    left = boxes[order, 0]
    found = []
    for place, k in enumerate(order.tolist()):
        size = max(boxes[k, 2] - boxes[k, 0], boxes[k, 3] - boxes[k, 1])
        near = min(NEAR, SMALL * size)
        stop = int(np.searchsorted(left, left[place] + near, side="right"))
        others = order[place + 1 : stop]
        alike = others[np.all(np.abs(boxes[others] - boxes[k]) <= near, axis=1)] if len(others) else others
        for other in alike.tolist():
            apart = distance(loops[k], loops[other], near)
            if apart <= near:
                p = loops[k].edges[0].point(0.5)
                message = f"two outlines coincide within {1e9 * apart:.3g} nm all along, near {shown(p)} mm"
                found.append(finding_at(p, "overlap", "error", message, "Leave only one of them.", loops[k].layer))
    return found


def distance(one: Loop, other: Loop, enough: float) -> float:
    """How far one outline leaves the other at most (m), at the ends and middles of both their edges; inf beyond `enough`."""
    worst = 0.0
    for here, there in ((one, other), (other, one)):
        track = Track(there)
        for edge in here.edges[:: max(1, len(here.edges) // MOST_TWINS)]:
            for probe in PROBES:
                worst = max(worst, track.side(edge.point(probe), 0.0, track.length)[0])
                if worst > enough:
                    return math.inf
    return worst
