"""Which edges are not intended?

Edges without length, edges drawn twice, and slits (a line out and back, of no width) are taken out, each with a finding.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Sequence

from watchsim.drawing.chaining.nodes import Grid, Nodes
from watchsim.drawing.chaining.outline_source import Outline
from watchsim.drawing.content import Stroke
from watchsim.drawing.findings import Finding
from watchsim.geometry.extent import Box, extents
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge

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
    x, y = stroke.edge.point(0.5)
    return Finding(code, "notice", message, "", stroke.layer, 1e3 * x, 1e3 * y)


def unique_loops(outlines: Sequence[Outline]) -> tuple[list[Outline], list[Finding]]:
    """The closed loops of a layer without those that repeat another one, whatever their direction and starting point."""
    grid = Grid(SAME)
    kept: list[Outline] = []
    boxes: list[Box] = []
    findings = []
    for outline in outlines:
        loop = outline.loop
        box = extents([loop]) or (0.0, 0.0, 0.0, 0.0)
        near = (k for k in grid.around(box[:2]) if math.dist(boxes[k], box) <= 2.0 * SAME)
        if any(same_loop(kept[k].loop, loop) for k in near):
            x, y = loop.edges[0].point(0.5)
            message = f"the outline that begins with {outline.sources[0]} is drawn twice; one was left out"
            findings.append(Finding("duplicate", "notice", message, "", loop.layer, 1e3 * x, 1e3 * y))
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
