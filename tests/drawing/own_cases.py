"""Which outlines do drawings of our own hold, counted and measured by ezdxf and by closed forms?"""

import math
from collections import Counter
from pathlib import Path
from typing import Any

import ezdxf
from ezdxf.math import ConstructionArc, bulge_to_arc
from naive.chaining import components

from watchsim.geometry.primitives import Arc, Edge, Line

OWN = Path(__file__).resolve().parents[2] / "profiles"
KINDS = {Line: "line", Arc: "arc"}


def own_truth(path: Path) -> dict[str, Any]:
    """As of a drawing in the list of truths: kinds, extents, length, loops, areas, in units of the drawing."""
    sheet = ezdxf.readfile(path)
    edges, kinds = [], Counter[str]()
    for entity in sheet.modelspace():
        for edge in _edges(entity):
            edges.append(edge)
            kinds["circle" if isinstance(edge, Arc) and edge.is_circle else KINDS[type(edge)]] += 1
    low, high = _box(edges)
    chained = components(edges, 1e-6 * math.dist(low, high))
    found = Counter(component.kind for component in chained)
    areas = [component.area for component in chained if component.kind in ("loop", "double")]
    return {
        "kinds": dict(kinds),
        "extents": (*low, *high),
        "length": math.fsum(edge.length for edge in edges),
        "closed_loops": found["loop"] + found["double"],
        "open_chains": found["chain"],
        "branching_components": found["branched"],
        "loop_area_sum": math.fsum(areas),
        "largest_loop_area": max(areas, default=0.0),
        "format": {"insunits": sheet.header["$INSUNITS"]},
    }


def _edges(entity: Any) -> list[Edge]:
    kind, dxf = entity.dxftype(), entity.dxf
    if kind == "LINE":
        return [Line(dxf.start.x, dxf.start.y, dxf.end.x, dxf.end.y)]
    if kind == "CIRCLE":
        return [Arc(dxf.center.x, dxf.center.y, dxf.radius, 0.0, math.tau)]
    if kind == "ARC":
        return [_arc(entity.construction_tool())]
    if kind == "LWPOLYLINE":
        points = list(entity.get_points("xyb"))
        ends = [*points[1:], *(points[:1] if entity.closed else [])]
        return [_side(one, other) for one, other in zip(points, ends, strict=False)]
    assert kind == "POINT", kind
    return []


def _side(one: tuple[float, ...], other: tuple[float, ...]) -> Edge:
    if one[2] == 0.0:
        return Line(one[0], one[1], other[0], other[1])
    centre, start, end, radius = bulge_to_arc(one[:2], other[:2], one[2])
    return _arc(ConstructionArc(centre, radius, math.degrees(start), math.degrees(end)))


def _arc(tool: ConstructionArc) -> Arc:
    sweep = (tool.end_angle - tool.start_angle) % 360.0
    return Arc(tool.center.x, tool.center.y, tool.radius, math.radians(tool.start_angle), math.radians(sweep))


def _box(edges: list[Edge]) -> tuple[tuple[float, float], tuple[float, float]]:
    points = []
    for edge in edges:
        points += [edge.start, edge.end]
        if isinstance(edge, Arc):
            quarters = (0.5 * math.pi * k for k in range(-8, 17))
            inside = [a for a in quarters if edge.start_angle <= a <= edge.start_angle + edge.sweep]
            points += [(edge.x + edge.radius * math.cos(a), edge.y + edge.radius * math.sin(a)) for a in inside]
    return (min(p[0] for p in points), min(p[1] for p in points)), (max(p[0] for p in points), max(p[1] for p in points))
