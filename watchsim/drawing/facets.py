"""Is this arc drawn with straight pieces?

Facets are not arcs: a locking face of facets pushes in steps. They are imported as drawn, and reported.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from watchsim.drawing.findings import Finding
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line

FEWEST = 6  # pieces in a row
SHARPEST = math.radians(31.0)  # turn from piece to piece: a twelve-sided nut is still taken for a circle
BLUNTEST = math.radians(0.05)
EQUAL = 0.02  # relative difference of lengths and of turns


def facets(loops: Iterable[Loop]) -> list[Finding]:
    """A warning for each run of equal straight pieces with equal turns."""
    return [facet_finding(loop, run) for loop in loops for run in runs(loop)]


def runs(loop: Loop) -> list[list[Line]]:
    """The rows of at least FEWEST lines that turn alike."""
    edges: Sequence[Edge] = loop.edges
    if loop.closed:
        edges = (*edges[first_break(edges) :], *edges[: first_break(edges)])
    found: list[list[Line]] = []
    row: list[Line] = []
    turn = 0.0
    for edge in edges:
        if not isinstance(edge, Line):
            row = closed_row(found, row, [])
            continue
        step = turn_between(row[-1], edge) if row else 0.0
        if row and alike(row[-1], edge, step) and (len(row) == 1 or abs(step - turn) <= EQUAL * abs(turn)):
            row.append(edge)
        else:
            row = closed_row(found, row, [row[-1], edge] if row and alike(row[-1], edge, step) else [edge])
        turn = step
    closed_row(found, row, [])
    return found


def closed_row(found: list[list[Line]], row: list[Line], following: list[Line]) -> list[Line]:
    """Keeps a row that is long enough; returns the beginning of the next one."""
    if len(row) >= FEWEST:
        found.append(row)
    return following


def first_break(edges: Sequence[Edge]) -> int:
    """Where a closed loop is best cut open: at an edge that does not continue the one before."""
    for k, edge in enumerate(edges):
        before = edges[k - 1]
        if not isinstance(edge, Line) or not isinstance(before, Line) or not alike(before, edge, turn_between(before, edge)):
            return k
    return 0


def turn_between(a: Line, b: Line) -> float:
    """The change of direction in radians, positive to the left."""
    (ax, ay), (bx, by) = a.tangent(0.0), b.tangent(0.0)
    return math.atan2(ax * by - ay * bx, ax * bx + ay * by)


def alike(a: Line, b: Line, turn: float) -> bool:
    return BLUNTEST < abs(turn) < SHARPEST and abs(a.length - b.length) <= EQUAL * max(a.length, b.length)


def facet_finding(loop: Loop, row: Sequence[Line]) -> Finding:
    """The warning with radius and rise of the facets."""
    turn, length = abs(turn_between(row[0], row[1])), row[0].length
    radius = length / (2.0 * math.sin(0.5 * turn))
    rise = radius * (1.0 - math.cos(0.5 * turn))
    x, y = row[len(row) // 2].point(0.5)
    message = (
        f"{len(row)} equal straight pieces stand for an arc of radius {1e3 * radius:.4g} mm (each is up to {1e6 * rise:.3g} µm "
        "off); contacts will run over its corners"
    )
    return Finding("facets", "warning", message, "Draw an ARC or CIRCLE instead.", loop.layer, 1e3 * x, 1e3 * y)
