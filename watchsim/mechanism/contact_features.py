"""Which primitives of an outline can touch something?

Every edge; and every convex corner, as an arc of radius 0 whose fan of normals fills the turn between its neighbours.
"""

from __future__ import annotations

import math

import numpy as np

from watchsim.geometry.exact_angle import middle
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point
from watchsim.model.records import ARC, CORNER, FULL, LINE, PART, PRIMITIVE, Records
from watchsim.tolerances import JOINT_RESOLUTION

FLAT = 8.0  # of the size: for larger radii than that the centre's rounding would show on the outline


def features(loop: Loop, body: int, size: float) -> Records:
    """Primitive records of one outline (metres, body frame). `size` turns the angles of corners into lengths.

    Edges shorter than a joint's tolerance have no primitive; their neighbours reach across.
    """
    edges = _watertight(loop, JOINT_RESOLUTION * size)
    rows = [_line(edge) if isinstance(edge, Line) else _arc(edge, size) for edge in edges]
    count = len(edges)
    for i in range(count if loop.closed else count - 1):
        j = (i + 1) % count
        turn = _turn(edges[i], edges[j], size)
        if turn > 0.0:
            corner = len(rows)
            rows.append(_corner(edges[i], edges[j], turn, size))
            if _parts_from_corner(edges[i]):
                rows[i]["after"], rows[corner]["before"] = corner, i
            if _parts_from_corner(edges[j]):
                rows[corner]["after"], rows[j]["before"] = j, corner
        elif turn == 0.0 and i != j and not (_is_hollow(edges[i]) or _is_hollow(edges[j])):
            rows[i]["after"], rows[j]["before"] = j, i
    empty = {**dict.fromkeys(PRIMITIVE.names or (), 0), "body": body, "before": -1, "after": -1}
    # Whole rows at once: writing one field of a record takes microseconds.
    return np.array([tuple({**empty, **row}.values()) for row in rows], PRIMITIVE).view(np.recarray)


def _watertight(loop: Loop, joint: float) -> list[Edge]:
    """The edges with length, and a short line wherever one does not start where the last one ends."""
    kept = [edge for edge in loop.edges if edge.length > joint]
    edges: list[Edge] = []
    for i, edge in enumerate(kept):
        edges.append(edge)
        if i == len(kept) - 1 and not loop.closed:
            break
        following = kept[(i + 1) % len(kept)]
        if math.dist(edge.end, following.start) > joint:
            edges.append(Line(*edge.end, *following.start))
    return edges


def _line(edge: Line) -> dict[str, float]:
    tx, ty = edge.tangent(0.0)
    point = {"x": edge.x0, "y": edge.y0, "px": edge.x0, "py": edge.y0}
    return {"kind": LINE, **point, "tx": tx, "ty": ty, "nx": ty, "ny": -tx, "length": edge.length}


def _arc(edge: Arc, size: float) -> dict[str, float]:
    side = 1.0 if edge.sweep > 0.0 else -1.0
    px, py, c, s = middle(edge, exact=edge.radius > FLAT * size)
    half = 0.5 * min(abs(edge.sweep), 2.0 * math.pi)
    fan = {"nx": side * c, "ny": side * s, "half_cos": math.cos(half), "half_sin": math.sin(half)}
    extent = FULL if edge.is_circle else PART
    return {
        "kind": ARC,
        "x": edge.x,
        "y": edge.y,
        "px": px,
        "py": py,
        "radius": edge.radius,
        "side": side,
        "extent": extent,
        **fan,
    }


def _direction(angle: float) -> Point:
    return math.cos(angle), math.sin(angle)


def _turn(before: Edge, after: Edge, size: float) -> float:
    """The angle by which the outline turns between two edges, positive at convex corners; 0 where they join smoothly."""
    (ax, ay), (bx, by) = before.tangent(1.0), after.tangent(0.0)
    turn = math.atan2(ax * by - ay * bx, ax * bx + ay * by)
    # A turn that no contact would notice: normals of a flat arc notice less.
    flattest = max(size, *(edge.radius for edge in (before, after) if isinstance(edge, Arc)), 0.0)
    return turn if abs(turn) * flattest >= JOINT_RESOLUTION * size else 0.0


def _is_hollow(edge: Edge) -> bool:
    return isinstance(edge, Arc) and edge.sweep < 0.0


def _parts_from_corner(edge: Edge) -> bool:
    """True if what touches the corner at the edge's end never touches the edge too: all but hollows of over half a turn."""
    return not (isinstance(edge, Arc) and edge.sweep < -math.pi)


def _corner(before: Edge, after: Edge, turn: float, size: float) -> dict[str, float]:
    """The corner between two edges, at which the outline turns by `turn`."""
    ax, ay = before.tangent(1.0)
    # Normals are tangents turned by -90 degrees; the fan fills the turn from the one before to the one after.
    nx, ny = _direction(math.atan2(ay, ax) - 0.5 * math.pi + 0.5 * turn)
    fan = {"nx": nx, "ny": ny, "half_cos": math.cos(0.5 * turn), "half_sin": math.sin(0.5 * turn), "extent": PART}
    x, y = after.start
    return {"kind": CORNER, "x": x, "y": y, "px": x, "py": y, "length": size, "side": 1.0, **fan}
