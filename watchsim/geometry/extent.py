"""How large is an outline?"""

from __future__ import annotations

import math
from collections.abc import Iterable

from watchsim.geometry.edge_table import table_of
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge

Box = tuple[float, float, float, float]
QUARTER = 0.5 * math.pi
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
