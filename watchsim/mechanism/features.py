"""Which primitives of an outline can touch something?

Every edge; and every convex corner, as an arc of radius 0 whose fan of normals fills the turn between its neighbours.
"""

from __future__ import annotations

import math

import numpy as np

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point
from watchsim.mechanism.model import ARC, CORNER, FULL, LINE, NARROW, PRIMITIVE, WIDE, Records

SMALLEST_TURN = 1e-9  # rad; below it two edges join smoothly
SMALLEST_GAP = 1e-13  # m; wider mismatches at joints are bridged by a line, so that outlines are watertight


def features(loop: Loop, body: int, size: float) -> Records:
    """Primitive records of one outline (metres, body frame). `size` turns the angles of corners into lengths."""
    edges = _watertight(loop)
    rows = [_line(edge) if isinstance(edge, Line) else _arc(edge) for edge in edges]
    count = len(edges)
    for i in range(count if loop.closed else count - 1):
        corner = _corner(edges[i], edges[(i + 1) % count], size)
        if corner is not None:
            rows.append(corner)
    out = np.zeros(len(rows), PRIMITIVE).view(np.recarray)
    for row, values in zip(out, rows, strict=True):
        row.body = body
        for name, value in values.items():
            setattr(row, name, value)
    return out


def _watertight(loop: Loop) -> list[Edge]:
    """The edges with a short line wherever one does not start exactly where the last one ends."""
    edges: list[Edge] = []
    count = len(loop.edges)
    for i, edge in enumerate(loop.edges):
        edges.append(edge)
        if i == count - 1 and not loop.closed:
            break
        following = loop.edges[(i + 1) % count]
        if math.dist(edge.end, following.start) > SMALLEST_GAP:
            edges.append(Line(*edge.end, *following.start))
    return edges


def _line(edge: Line) -> dict[str, float]:
    tx, ty = edge.tangent(0.0)
    return {"kind": LINE, "x": edge.x0, "y": edge.y0, "tx": tx, "ty": ty, "length": edge.length}


def _direction(angle: float) -> Point:
    return math.cos(angle), math.sin(angle)


def _arc(edge: Arc) -> dict[str, float]:
    first, last = edge.start_angle, edge.start_angle + edge.sweep
    if edge.sweep < 0.0:
        first, last = last, first
    (e0x, e0y), (e1x, e1y) = _direction(first), _direction(last)
    extent = FULL if edge.is_circle else WIDE if abs(edge.sweep) > math.pi else NARROW
    side = 1.0 if edge.sweep > 0.0 else -1.0
    fan = {"e0x": e0x, "e0y": e0y, "e1x": e1x, "e1y": e1y, "extent": extent}
    return {"kind": ARC, "x": edge.x, "y": edge.y, "radius": edge.radius, "side": side, **fan}


def _corner(before: Edge, after: Edge, size: float) -> dict[str, float] | None:
    """The corner between two edges, None where they join smoothly or the material's corner is concave."""
    (ax, ay), (bx, by) = before.tangent(1.0), after.tangent(0.0)
    turn = math.atan2(ax * by - ay * bx, ax * bx + ay * by)
    if turn < SMALLEST_TURN:
        return None
    # Normals are tangents turned by -90 degrees; the fan runs from the one before to the one after.
    fan = {"e0x": ay, "e0y": -ax, "e1x": by, "e1y": -bx, "extent": NARROW}
    x, y = after.start
    return {"kind": CORNER, "x": x, "y": y, "length": size, "side": 1.0, **fan}
