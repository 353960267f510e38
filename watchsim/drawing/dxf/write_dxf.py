"""How are outlines written as a DXF file?

Release 2010 (UTF-8, true colours) in millimetres: circles as CIRCLE, arcs as ARC, outlines of straight lines only as one closed
LWPOLYLINE, all else as LINE. An arc stays an arc about its own centre; as the bulge of a polyline a flat one would lose digits.
Only loops that touch another one are polylines with bulges all the same: as single lines nobody could tell which way they go
on. Numbers are written so that they read back to the last bit, and the same outlines give the same bytes.
"""

from __future__ import annotations

import io
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager

import ezdxf
from ezdxf.layouts import Modelspace

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point

MM = 1e3
TIGHT = 1e-13  # m
FORBIDDEN = str.maketrans(dict.fromkeys('<>/\\":;?*|=`,', "_"))  # in names of layers


def dxf_text(loops: Iterable[Loop], points: Iterable[tuple[str, Point]] = (), colours: Mapping[str, str] | None = None) -> str:
    """The DXF file of loops and open chains (metres) and of points (layer, place); `colours` are "#rrggbb" of layers.

    Characters that DXF forbids in names of layers become underscores.
    """
    stream = io.StringIO()
    with _no_dates():
        document = ezdxf.new("R2010", units=ezdxf.units.MM)
        for layer, colour in (colours or {}).items():
            document.layers.add(_name(layer), true_color=int(colour[1:], 16))
        space = document.modelspace()
        outlines = list(loops)
        joints = Counter(joint for loop in outlines for joint in _joints(loop))
        for loop in outlines:
            touching = any(joints[joint] > 1 for joint in _joints(loop))
            _add_loop(space, loop, touching)
        for layer, (x, y) in points:
            space.add_point((MM * x, MM * y), dxfattribs={"layer": _name(layer)})
        document.write(stream)
    return stream.getvalue()


@contextmanager
def _no_dates() -> Iterator[None]:
    """Without dates and random identifiers, which ezdxf writes otherwise."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def _name(layer: str) -> str:
    return layer.translate(FORBIDDEN) or "0"


def _joints(loop: Loop) -> list[tuple[str, int, int]]:
    """Where its edges begin, as layer and nanometres; nothing of full circles, which touch nothing by their ends."""
    if loop.closed and len(loop.edges) == 1:
        return []
    return [(loop.layer, round(1e9 * x), round(1e9 * y)) for x, y in (edge.start for edge in loop.edges)]


def _add_loop(space: Modelspace, loop: Loop, touching: bool) -> None:
    attributes = {"layer": _name(loop.layer)}
    straight = all(isinstance(edge, Line) for edge in loop.edges)
    if loop.closed and len(loop.edges) > 1 and (touching or straight) and _joined(loop):
        corners = [(MM * edge.start[0], MM * edge.start[1], _bulge(edge)) for edge in loop.edges]
        space.add_lwpolyline(corners, format="xyb", close=True, dxfattribs=attributes)
        return
    for edge in loop.edges:
        _add_edge(space, edge, attributes)


def _bulge(edge: Edge) -> float:
    return math.tan(0.25 * edge.sweep) if isinstance(edge, Arc) else 0.0


def _joined(loop: Loop) -> bool:
    """Does every edge start where the one before ends, but for rounding?"""
    return all(math.dist(a.end, b.start) <= TIGHT for a, b in zip(loop.edges, (*loop.edges[1:], loop.edges[0]), strict=True))


def _add_edge(space: Modelspace, edge: Edge, attributes: dict[str, str]) -> None:
    if isinstance(edge, Line):
        space.add_line((MM * edge.x0, MM * edge.y0), (MM * edge.x1, MM * edge.y1), dxfattribs=attributes)
        return
    centre = (MM * edge.x, MM * edge.y)
    if edge.is_circle:
        space.add_circle(centre, MM * edge.radius, dxfattribs=attributes)
        return
    arc = edge if edge.sweep > 0.0 else edge.reversed()  # a DXF arc runs counter-clockwise
    start = math.degrees(arc.start_angle) % 360.0
    space.add_arc(centre, MM * arc.radius, start, start + math.degrees(arc.sweep), dxfattribs=attributes)
