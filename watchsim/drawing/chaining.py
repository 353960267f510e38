"""Which edges form loops?

Edges of one layer are joined end to end. Where exactly two meet the chain goes on; where more meet nobody can know which
way was meant, so chains end there and a finding names the place.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.chain_faults import (
    crossings,
    open_ends,
    shown,
    twins,
    unique_loops,
    with_length,
    without_doubles,
    without_slits,
)
from watchsim.drawing.findings import Finding, Stroke, finding_at
from watchsim.drawing.nodes import TIGHT, Join, Junctions, Nodes, Outline, junctions
from watchsim.geometry.loops import Inside, Loop
from watchsim.geometry.primitives import Arc, Boxes, Edge, Line, Point
from watchsim.geometry.solids import area

AT_ONCE = 2_000_000  # pairs of loops that may be looked at in one go, and
MOST = 30_000_000  # in all: more are a fault in the drawing


def nested(loops: Sequence[Loop]) -> list[Loop] | None:
    """The closed loops of one layer, oriented and with holes marked; same order. None where too many lie in each other.

    A loop inside an odd number of others of its layer is a hole and runs clockwise; all others run counter-clockwise, so that
    the material is on the left everywhere.
    """
    areas = [area(loop) for loop in loops]
    found = depths(loops, np.abs(areas))
    if found is None:
        return None
    result = []
    for loop, size, depth in zip(loops, areas, found, strict=True):
        hole = depth % 2 == 1
        turned = loop.reversed() if (size > 0.0) == hole else loop
        result.append(replace(turned, hole=hole))
    return result


def depths(loops: Sequence[Loop], size: NDArray[np.float64]) -> list[int] | None:
    """In how many others each loop lies, by the middle of its first edge: one more than the smallest loop around it."""
    if len(loops) < 2:
        return [0] * len(loops)
    boxes = np.array([loop.box for loop in loops])
    probes = np.array([loop.edges[0].point(0.5) for loop in loops])
    tree = Boxes(boxes)
    depth = [0] * len(loops)
    insides: dict[int, Inside] = {}
    largest_first = np.argsort(-size, kind="stable")
    step = max(1, AT_ONCE // len(loops))
    seen = 0
    for chosen in (largest_first[k : k + step] for k in range(0, len(loops), step)):
        which, outer = tree.holding(probes[chosen])
        seen += len(which)
        if seen > MOST:
            return None
        inner = chosen[which]
        around = np.all((boxes[outer, :2] <= boxes[inner, :2]) & (boxes[outer, 2:] >= boxes[inner, 2:]), axis=1)
        keep = np.flatnonzero(around & (size[outer] > size[inner]))
        keep = keep[np.lexsort((size[outer[keep]], which[keep]))]  # of each loop the smallest around it first
        found = outer[keep]
        starts = np.searchsorted(which[keep], np.arange(len(chosen) + 1))
        for number, k in enumerate(chosen.tolist()):
            for other in found[starts[number] : starts[number + 1]].tolist():
                if other not in insides:
                    insides[other] = Inside(loops[other])
                if insides[other].winding((float(probes[k, 0]), float(probes[k, 1]))) != 0:
                    depth[k] = depth[other] + 1
                    break
    return depth


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


def chain(strokes: Sequence[Stroke], snap: float, deviation: float = 0.0) -> Chains:
    """The loops and open chains of all layers; `snap` and the worst `deviation` of fitted curves in metres."""
    layers: dict[str, list[Stroke]] = {}
    for stroke in strokes:
        layers.setdefault(stroke.layer, []).append(stroke)
    parts = [chain_layer(layer, members, snap, deviation) for layer, members in layers.items()]
    return Chains(
        tuple(loop for part in parts for loop in part.loops),
        tuple(loop for part in parts for loop in part.open_chains),
        tuple(finding for part in parts for finding in part.findings),
    )


def chain_layer(layer: str, strokes: Sequence[Stroke], snap: float, deviation: float) -> Chains:
    """The same for the strokes of one layer. What one entity closes by itself is a loop, whatever else touches it."""
    drawn, findings = with_length(strokes)
    whole, pieces = closed_runs(drawn)
    nodes = Nodes(pieces)
    kept, doubled, doubles = without_doubles(pieces, nodes, range(len(pieces)), min(TIGHT, snap))
    nodes.snap(snap, loose_only=False)
    joins = nodes.snap(NOTED * snap, loose_only=True)
    # What was drawn twice with small differences hangs together only now.
    changed = {end // 2 for node in nodes.joined for end in nodes.members[node]} & kept
    still, again, more = without_doubles(pieces, nodes, sorted(changed), snap)
    kept, doubled, doubles = kept - changed | still, doubled | again, doubles + more
    kept, slits = without_slits(pieces, nodes, kept, doubled)
    meeting = junctions(nodes, pieces)
    paths = trace(nodes, meeting, kept)
    closed = [assembled(run, layer, True) for run in whole]
    closed += [assembled(travelled(path, pieces), layer, True) for path in paths if path.closed]
    outlines, repeated = unique_loops(closed)
    notes = [*(closed_gap(join, pieces) for join in joins), *branches(nodes, meeting, pieces)]
    still_open = [path for path in paths if not path.closed]
    notes += open_ends([path.steps for path in still_open], meeting.loose, pieces, nodes)
    chains = [assembled(travelled(path, pieces), layer, False) for path in still_open]
    notes += crossings([*outlines, *chains], deviation)
    notes += twins([outline.loop for outline in outlines])
    loops = nested([outline.loop for outline in outlines])
    if loops is None:
        loops = [outline.loop for outline in outlines]
        message = "so many outlines are nested that holes were not distinguished from the parts around them"
        notes.append(Finding("crowded", "error", message, "Look for parts that are drawn many times over each other.", layer))
    return Chains(tuple(loops), tuple(chain.loop for chain in chains), (*findings, *repeated, *doubles, *slits, *notes))


def closed_runs(strokes: Sequence[Stroke]) -> tuple[list[list[Stroke]], list[Stroke]]:
    """The runs that close by themselves, and all other strokes."""
    whole, rest = [], []
    for _, group in groupby(strokes, key=lambda stroke: stroke.run):
        run = list(group)
        joints = zip([run[-1], *run], run, strict=False)  # that of its ends first: most runs are not closed
        circle = isinstance(run[0].edge, Arc) and run[0].edge.is_circle
        if circle or (all(math.dist(a.edge.end, b.edge.start) <= TIGHT for a, b in joints) and not folded(run)):
            whole.append(run)
        else:
            rest += run
    return whole, rest


def folded(run: Sequence[Stroke]) -> bool:
    """Does the run go along one of its edges twice? Then it has slits, which are found by chaining its edges again."""
    if len(run) < 3:
        return len(run) == 2 and all(isinstance(stroke.edge, Line) for stroke in run)
    middles = {}
    for stroke in run:
        x, y = stroke.edge.point(0.5)
        middles[(round(x / TIGHT), round(y / TIGHT))] = stroke
    return len(middles) < len(run)


def trace(nodes: Nodes, meeting: Junctions, kept: set[int]) -> list[Path]:
    """All chains, in the direction of their stroke of lowest number; closed ones begin with it."""
    left = dict.fromkeys(sorted(kept))
    paths = []
    for first in list(left):
        if first not in left:
            continue
        del left[first]
        ahead = follow(meeting, left, 2 * first)
        closed = meeting.partner.get(ahead[-1] ^ 1) == 2 * first
        behind = [] if closed else [step ^ 1 for step in reversed(follow(meeting, left, 2 * first + 1)[1:])]
        steps = (*behind, *ahead)
        start, end = nodes.node[steps[0]], nodes.node[steps[-1] ^ 1]
        # A chain that comes back to the branch it left from is a loop that touches another one there.
        paths.append(Path(steps, closed or (start == end and start in meeting.branches)))
    return paths


def follow(meeting: Junctions, left: dict[int, None], step: int) -> list[int]:
    """The way on from a travelled stroke to where it ends or is used up; strokes used are taken from `left`."""
    steps = [step]
    while True:
        following = meeting.partner.get(steps[-1] ^ 1)
        if following is None or following // 2 not in left:
            return steps
        del left[following // 2]
        steps.append(following)


def travelled(path: Path, strokes: Sequence[Stroke]) -> list[Stroke]:
    """The strokes of a path in travel order and direction."""
    forward = ((strokes[step // 2], step % 2 == 0) for step in path.steps)
    return [stroke if ahead else replace(stroke, edge=stroke.edge.reversed()) for stroke, ahead in forward]


def assembled(strokes: Sequence[Stroke], layer: str, closed: bool) -> Outline:
    """A loop of strokes in travel order, lines stretched to meet their neighbours; arcs stay as drawn."""
    edges = [stroke.edge for stroke in strokes]
    count = len(edges)
    for k in range(count if closed else count - 1):
        following = (k + 1) % count
        if following != k and not (isinstance(edges[k], Arc) and isinstance(edges[following], Arc)):
            joint = joint_of(edges[k], edges[following])
            for number, at in ((k, "end"), (following, "start")):
                edge = edges[number]
                if isinstance(edge, Line) and getattr(edge, at) != joint:
                    edges[number] = Line(edge.x0, edge.y0, *joint) if at == "end" else Line(*joint, edge.x1, edge.y1)
    return Outline(Loop(tuple(edges), layer, closed), tuple(stroke.source for stroke in strokes))


def joint_of(before: Edge, after: Edge) -> Point:
    """Where the two shall meet: an arc's end, or half-way between two lines."""
    p, q = before.end, after.start
    if isinstance(before, Arc):
        return p
    return q if isinstance(after, Arc) or p == q else (0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]))


def closed_gap(join: Join, strokes: Sequence[Stroke]) -> Finding:
    """The notice for a gap that was wider than the snap and was closed all the same."""
    a, b = (strokes[number].source for number in join.strokes)
    message = f"a gap of {1e6 * join.gap:.3g} µm between {a} and {b} was closed"
    return finding_at(join.at, "gap-closed", "notice", message, "Join them in CAD.", strokes[join.strokes[0]].layer)


def branches(nodes: Nodes, meeting: Junctions, strokes: Sequence[Stroke]) -> list[Finding]:
    """An error for each place where more than two edges meet."""
    found = []
    for node, ends in meeting.branches.items():
        p = nodes.at[node]
        names = ", ".join(dict.fromkeys(strokes[end // 2].source for end in ends[:8]))
        message = f"{len(ends)} edges meet at {shown(p)} mm: {names}; which way does the outline go?"
        fix = "Leave only two of them there, or put the others on another layer."
        found.append(finding_at(p, "branch", "error", message, fix, strokes[ends[0] // 2].layer))
    return found
