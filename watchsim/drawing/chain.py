"""Which edges form loops?

Edges of one layer are joined end to end. Where exactly two meet the chain goes on; where more meet nobody can know which
way was meant, so chains end there and a finding names the place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from watchsim.drawing.content import Stroke
from watchsim.drawing.findings import Finding
from watchsim.drawing.gaps import open_ends
from watchsim.drawing.nesting import nested
from watchsim.drawing.nodes import TIGHT, Join, Nodes
from watchsim.drawing.tidy import unique_circles, with_length, without_doubles, without_slits
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point

NOTED = 10.0  # times the snap: gaps up to that are closed, but said


class Chains(NamedTuple):
    """Closed loops (outer ones counter-clockwise, holes clockwise), open chains, and what was found on the way."""

    loops: tuple[Loop, ...]
    open_chains: tuple[Loop, ...]
    findings: tuple[Finding, ...]


class Path(NamedTuple):
    """Strokes in travel order as ends: 2·i travels stroke i forward, 2·i + 1 backward."""

    steps: tuple[int, ...]
    closed: bool


def chain(strokes: Sequence[Stroke], snap: float) -> Chains:
    """The loops and open chains of all layers; `snap` in metres."""
    layers: dict[str, list[Stroke]] = {}
    for stroke in strokes:
        layers.setdefault(stroke.layer, []).append(stroke)
    parts = [chain_layer(layer, members, snap) for layer, members in layers.items()]
    return Chains(
        tuple(loop for part in parts for loop in part.loops),
        tuple(loop for part in parts for loop in part.open_chains),
        tuple(finding for part in parts for finding in part.findings),
    )


def chain_layer(layer: str, strokes: Sequence[Stroke], snap: float) -> Chains:
    """The same for the strokes of one layer."""
    drawn, findings = with_length(strokes)
    circles, repeated = unique_circles([s for s in drawn if isinstance(s.edge, Arc) and s.edge.is_circle])
    pieces = [s for s in drawn if not (isinstance(s.edge, Arc) and s.edge.is_circle)]
    nodes = Nodes(pieces)
    kept, doubled, doubles = without_doubles(pieces, nodes, min(TIGHT, snap))
    nodes.snap(snap, loose_only=False)
    joins = nodes.snap(NOTED * snap, loose_only=True)
    kept, slits = without_slits(pieces, nodes, kept, doubled)
    paths = trace(nodes, kept)
    closed = [assembled(path, pieces, layer) for path in paths if path.closed]
    loops = nested([*closed, *(Loop((circle.edge,), layer) for circle in circles)])
    notes = [*(closed_gap(join, pieces) for join in joins), *branches(nodes, pieces, layer)]
    notes += open_ends([path.steps for path in paths if not path.closed], pieces, nodes)
    chains = tuple(assembled(path, pieces, layer) for path in paths if not path.closed)
    return Chains(tuple(loops), chains, (*findings, *repeated, *doubles, *slits, *notes))


def trace(nodes: Nodes, kept: set[int]) -> list[Path]:
    """All chains, each beginning with its stroke of lowest number if closed, and in that stroke's direction in any case."""
    left = dict.fromkeys(sorted(kept))
    paths = []
    for first in list(left):
        if first not in left:
            continue
        del left[first]
        ahead = follow(nodes, left, 2 * first)
        closed = meets(nodes, 2 * first, ahead[-1])
        behind = [] if closed else [step ^ 1 for step in reversed(follow(nodes, left, 2 * first + 1)[1:])]
        steps = (*behind, *ahead)
        # A chain that comes back to the branch it left from is a loop that touches another one there.
        paths.append(Path(steps, closed or start_node(nodes, steps[0]) == end_node(nodes, steps[-1])))
    return paths


def start_node(nodes: Nodes, step: int) -> int:
    return nodes.node[step]


def end_node(nodes: Nodes, step: int) -> int:
    return nodes.node[step ^ 1]


def meets(nodes: Nodes, first: int, last: int) -> bool:
    """Has the way come back to its beginning?"""
    node = end_node(nodes, last)
    return node == start_node(nodes, first) and len(nodes.members[node]) == 2


def follow(nodes: Nodes, left: dict[int, None], step: int) -> list[int]:
    """The way on from a travelled stroke while exactly two meet; strokes used are taken from `left`."""
    steps = [step]
    while True:
        around = nodes.members[end_node(nodes, steps[-1])]
        following = [end for end in around if end // 2 in left] if len(around) == 2 else []
        if not following:
            return steps
        del left[following[0] // 2]
        steps.append(following[0])


def assembled(path: Path, strokes: Sequence[Stroke], layer: str) -> Loop:
    """The edges in travel order, lines stretched to meet their neighbours; arcs stay as drawn."""
    edges = [strokes[step // 2].edge if step % 2 == 0 else strokes[step // 2].edge.reversed() for step in path.steps]
    count = len(edges)
    for k in range(count if path.closed else count - 1):
        following = (k + 1) % count
        joint = joint_of(edges[k], edges[following])
        if following != k:
            edges[k], edges[following] = ending_at(edges[k], joint), starting_at(edges[following], joint)
    return Loop(tuple(edges), layer, path.closed)


def joint_of(before: Edge, after: Edge) -> Point:
    """Where the two shall meet: an arc's end, or half-way between two lines."""
    p, q = before.end, after.start
    if isinstance(before, Arc):
        return p
    if isinstance(after, Arc) or p == q:
        return q
    return (0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]))


def ending_at(edge: Edge, p: Point) -> Edge:
    return replace(edge, x1=p[0], y1=p[1]) if isinstance(edge, Line) else edge


def starting_at(edge: Edge, p: Point) -> Edge:
    return replace(edge, x0=p[0], y0=p[1]) if isinstance(edge, Line) else edge


def closed_gap(join: Join, strokes: Sequence[Stroke]) -> Finding:
    """The notice for a gap that was wider than the snap and was closed all the same."""
    a, b = (strokes[number].source for number in join.strokes)
    message = f"a gap of {1e6 * join.gap:.3g} µm between {a} and {b} was closed"
    x, y = join.at
    return Finding("gap-closed", "notice", message, "Join them in CAD.", strokes[join.strokes[0]].layer, 1e3 * x, 1e3 * y)


def branches(nodes: Nodes, strokes: Sequence[Stroke], layer: str) -> list[Finding]:
    """An error for each place where more than two edges meet."""
    found = []
    for (x, y), members in zip(nodes.at, nodes.members, strict=True):
        if len(members) > 2:
            names = ", ".join(dict.fromkeys(strokes[end // 2].source for end in members[:8]))
            message = f"{len(members)} edges meet at ({1e3 * x:.6g}, {1e3 * y:.6g}) mm: {names}; which way does the outline go?"
            fix = "Leave only two of them there, or put the others on another layer."
            found.append(Finding("branch", "error", message, fix, layer, 1e3 * x, 1e3 * y))
    return found
