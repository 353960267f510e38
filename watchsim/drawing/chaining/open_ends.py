"""Where are outlines open?

Loose ends are paired with their nearest partner, so that each gap is named once, with both ends.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.chaining.nodes import Nodes
from watchsim.drawing.content import Stroke
from watchsim.drawing.drawn_material import MARKS, last_word
from watchsim.drawing.findings import Finding
from watchsim.geometry.primitives import Line, Point

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
    near = near_pairs([nodes.ends[end] for end in loose])
    stray = stray_lines([steps[0] // 2 for steps in chains if len(steps) == 1], loose, near, strokes)
    pairs = paired(loose, near, stray, chains_of(chains, strokes))
    meant = {number for number in stray if last_word(strokes[number].layer) in MARKS}
    return [stray_finding(strokes[number]) for number in stray if number not in meant] + [
        gap_finding(a, b, strokes, nodes) for a, b in pairs
    ]


def near_pairs(points: Sequence[Point]) -> list[tuple[float, int, int]]:
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
    x, y = stroke.edge.point(0.5)
    message = f"{stroke.source} is a single line that touches nothing; it is kept as an open chain"
    return Finding("stray-line", "warning", message, "Delete it, or put it on another layer.", stroke.layer, 1e3 * x, 1e3 * y)


def gap_finding(end: int, partner: int, strokes: Sequence[Stroke], nodes: Nodes) -> Finding:
    """The open outline with both ends, the gap and the entities."""
    p = nodes.ends[end]
    layer = strokes[end // 2].layer
    if partner < 0:
        message = f"the outline is open at {shown(p)} mm, {named(end, strokes)}: nothing meets it there"
        return Finding("open-outline", "error", message, "Close it in CAD.", layer, 1e3 * p[0], 1e3 * p[1])
    q = nodes.ends[partner]
    gap = math.dist(p, q)
    ends = f"{named(end, strokes)} and {named(partner, strokes)}"
    width = f"{1e6 * gap:.3g} µm" if gap < 1e-3 else f"{1e3 * gap:.4g} mm"
    message = f"the outline is open: {width} between {shown(p)} and {shown(q)} mm, {ends}"
    fix = "Join them in CAD"
    if gap <= MENDABLE:
        fix += f', or set snap = "{math.ceil(1e6 * gap)} µm"'
    return Finding(
        "open-outline", "error", message, fix + ".", layer, 1e3 * p[0], 1e3 * p[1], other_mm=(1e3 * q[0], 1e3 * q[1])
    )


def shown(p: Point) -> str:
    """Coordinates in mm, to the nanometre: rounding noise would only confuse."""
    return "({:g}, {:g})".format(*(round(1e3 * c, 6) + 0.0 for c in p))


def named(end: int, strokes: Sequence[Stroke]) -> str:
    return f"the {'end' if end % 2 else 'start'} of {strokes[end // 2].source}"
