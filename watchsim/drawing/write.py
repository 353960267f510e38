"""How are outlines written as DXF and SVG files?

Outlines in metres become DXF of release 2010 (UTF-8, true colours) in millimetres: circles as CIRCLE, arcs as ARC, outlines of
straight lines only as one closed LWPOLYLINE, all else as LINE. An arc stays an arc about its own centre; as the bulge of a
polyline a flat one would lose digits. Only loops that touch another one are polylines with bulges all the same: as single lines
nobody could tell which way they go on. Numbers are written so that they read back to the last bit.

The sheet of a part has millimetres as its draughtsman has them, and one point on the layer PIVOT. Nothing changes from one
writing to the next: the same outlines give the same file.
"""

from __future__ import annotations

import io
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

from watchsim.geometry.loops import Box, Loop, extents
from watchsim.geometry.primitives import Arc, Edge, Line, Point

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts import Modelspace


MM = 1e3
TIGHT = 1e-13  # m
VIEW = 1.1  # of the larger side: what is seen when the file is opened
FORBIDDEN = str.maketrans(dict.fromkeys('<>/\\":;?*|=`,', "_"))  # in names of layers


def dxf_text(loops: Iterable[Loop], points: Iterable[tuple[str, Point]] = (), colours: Mapping[str, str] | None = None) -> str:
    """The DXF file of loops and open chains (metres) and of points (layer, place); `colours` are "#rrggbb" of layers.

    Characters that DXF forbids in names of layers become underscores.
    """
    import ezdxf  # loaded only to write: a tenth of a second

    stream = io.StringIO()
    with _no_dates():
        document = ezdxf.new("R2010", units=ezdxf.units.MM)
        for layer, colour in (colours or {}).items():
            document.layers.add(_name(layer), true_color=int(colour[1:], 16))
        space = document.modelspace()
        outlines, marks = list(loops), list(points)
        for layer in dict.fromkeys([*(loop.layer for loop in outlines), *(layer for layer, _ in marks)]):
            if _name(layer) not in document.layers:
                document.layers.add(_name(layer))
        _show(document, extents(outlines) or (0.0, 0.0, 0.0, 0.0))
        joints = Counter(joint for loop in outlines for joint in _joints(loop))
        for loop in outlines:
            touching = any(joints[joint] > 1 for joint in _joints(loop))
            _add_loop(space, loop, touching)
        for layer, (x, y) in marks:
            space.add_point((MM * x, MM * y), dxfattribs={"layer": _name(layer)})
        document.classes.add_required_classes(document.dxfversion)
        document.classes.classes = dict(sorted(document.classes.classes.items()))  # some come from a set, in any order
        document.write(stream)
    return stream.getvalue()


def _show(document: Drawing, box: Box) -> None:
    """Say in the file how far the outlines reach, and open it with all of them in view."""
    x0, y0, x1, y1 = (MM * side for side in box)
    space = document.modelspace()
    space.reset_extents((x0, y0, 0.0), (x1, y1, 0.0))
    document.header["$EXTMIN"], document.header["$EXTMAX"] = (x0, y0, 0.0), (x1, y1, 0.0)
    document.set_modelspace_vport(VIEW * max(x1 - x0, y1 - y0) or 1.0, (0.5 * (x0 + x1), 0.5 * (y0 + y1)))


@contextmanager
def _no_dates() -> Iterator[None]:
    """Without dates and random identifiers, which ezdxf writes otherwise."""
    import ezdxf

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
        bulges = (math.tan(0.25 * edge.sweep) if isinstance(edge, Arc) else 0.0 for edge in loop.edges)
        corners = [(MM * edge.start[0], MM * edge.start[1], bulge) for edge, bulge in zip(loop.edges, bulges, strict=True)]
        space.add_lwpolyline(corners, format="xyb", close=True, dxfattribs=attributes)
        return
    for edge in loop.edges:
        _add_edge(space, edge, attributes, MM)


def _joined(loop: Loop) -> bool:
    """Does every edge start where the one before ends, but for rounding?"""
    return all(math.dist(a.end, b.start) <= TIGHT for a, b in zip(loop.edges, (*loop.edges[1:], loop.edges[0]), strict=True))


def _add_edge(space: Modelspace, edge: Edge, attributes: dict[str, str], scale: float) -> None:
    if isinstance(edge, Line):
        space.add_line((scale * edge.x0, scale * edge.y0), (scale * edge.x1, scale * edge.y1), dxfattribs=attributes)
        return
    centre = (scale * edge.x, scale * edge.y)
    if edge.is_circle:
        space.add_circle(centre, scale * edge.radius, dxfattribs=attributes)
        return
    space.add_arc(centre, scale * edge.radius, *degrees_of(edge), dxfattribs=attributes)


def degrees_of(arc: Arc) -> tuple[float, float]:
    """Where an arc begins and ends in a DXF file, in which arcs run counter-clockwise."""
    start = math.degrees((arc if arc.sweep > 0.0 else arc.reversed()).start_angle) % 360.0
    return start, start + math.degrees(abs(arc.sweep))


# SVG: a page in real millimetres whose user unit is the millimetre, y turned down as SVG has it; one Inkscape layer per layer,
# in it one path with straight lines and circular A commands. Arcs are divided into parts of at most a quarter turn: A gives
# ends and radius only, and the centre of a half turn would be lost in their rounding.

MARGIN = 0.05  # of the larger side, around the outlines
STROKE = 0.002  # of the larger side


def svg_text(
    loops: Iterable[Loop], points: Iterable[tuple[str, Point]] = (), colours: Mapping[str, str] | None = None, title: str = ""
) -> str:
    """The SVG file of loops and open chains (metres) and of points (layer, place), these as small circles on a hidden layer.

    `colours` are "#rrggbb" of layers, to fill them.
    """
    layers: dict[str, list[Loop]] = {}
    for loop in loops:
        layers.setdefault(loop.layer, []).append(loop)
    x0, y0, x1, y1 = extents(loop for members in layers.values() for loop in members) or (0.0, 0.0, 1e-3, 1e-3)
    size = MM * max(x1 - x0, y1 - y0) or 1.0
    margin = MARGIN * size
    left, top = MM * x0 - margin, -MM * y1 - margin
    width, height = MM * (x1 - x0) + 2.0 * margin, MM * (y1 - y0) + 2.0 * margin
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"',
        f'  width="{width!r}mm" height="{height!r}mm" viewBox="{left!r} {top!r} {width!r} {height!r}">',
    ]
    lines += [f"  <title>{escape(title)}</title>"] if title else []
    for layer, members in layers.items():
        fill = (colours or {}).get(layer, "#d0d4d8")
        lines += _group(layer, f'fill="{fill}" stroke="#23272c" stroke-width="{STROKE * size:.4g}"', _path(members))
    marks: dict[str, list[str]] = {}
    for layer, (x, y) in points:
        marks.setdefault(layer, []).append(f'<circle cx="{MM * x!r}" cy="{-MM * y + 0.0!r}" r="{5.0 * STROKE * size:.4g}"/>')
    for layer, circles in marks.items():
        lines += _group(layer, f'fill="none" stroke="#e8590c" stroke-width="{STROKE * size:.4g}"', circles)
    return "\n".join([*lines, "</svg>", ""])


def _group(layer: str, look: str, content: Iterable[str]) -> list[str]:
    head = f'  <g inkscape:groupmode="layer" inkscape:label={quoteattr(layer)} {look}>'
    return [head, *(f"    {line}" for line in content), "  </g>"]


def _path(loops: list[Loop]) -> Iterator[str]:
    """One path with all closed loops of a layer, so that holes stay empty; one for each open chain."""
    pierced = any(loop.hole for loop in loops)  # then a circle must share the path of its holes
    closed = []
    for loop in loops:
        arc = loop.edges[0]
        if loop.closed and not pierced and len(loop.edges) == 1 and isinstance(arc, Arc) and arc.is_circle:
            yield f'<circle cx="{MM * arc.x!r}" cy="{-MM * arc.y + 0.0!r}" r="{MM * arc.radius!r}"/>'
        elif loop.closed:
            closed.append(loop)
    if closed:
        yield f'<path d="{" ".join(_commands(loop) for loop in closed)}"/>'
    for chain in loops:
        if not chain.closed:
            yield f'<path fill="none" d="{_commands(chain)}"/>'


def _commands(loop: Loop) -> str:
    """M, L, A and Z of one loop; holes run the other way, so that the non-zero rule leaves them empty."""
    words = [f"M {_xy(loop.edges[0].start)}"]
    for k, edge in enumerate(loop.edges):
        last = loop.closed and k == len(loop.edges) - 1
        if isinstance(edge, Line):
            words += [] if last else [f"L {_xy(edge.end)}"]
            continue
        parts = max(1, math.ceil(abs(edge.sweep) / (0.5 * math.pi) - 1e-9))
        radius, flag = MM * edge.radius, 0 if edge.sweep > 0.0 else 1  # mirrored: left turns become right turns
        for part in range(1, parts + 1):
            closing = last and part == parts
            end = loop.edges[0].start if closing else edge.point(part / parts)
            words.append(f"A {radius!r} {radius!r} 0 0 {flag} {_xy(end)}")
    return " ".join([*words, "Z"] if loop.closed else words)


def _xy(p: Point) -> str:
    return f"{MM * p[0]!r} {-MM * p[1] + 0.0!r}"


COLOURS = {"PIVOT": 1, "TEETH": 2, "STONES": 6, "PALLETS": 6, "PIN": 6, "FORK": 4, "DART": 3, "SAFETY": 3, "PINS": 5}
PLAIN = 7


@dataclass(frozen=True)
class Sheet:
    """The outlines of one part, in millimetres, and its pivot (None: no point is drawn)."""

    loops: tuple[Loop, ...]
    pivot: Point | None = (0.0, 0.0)

    @property
    def layers(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(loop.layer for loop in self.loops))

    def dxf(self) -> bytes:
        """The DXF file."""
        document = new_sheet(self.layers, self.pivot)
        for loop in self.loops:
            add_loop(document, loop)
        stream = io.StringIO()
        document.write(stream)
        return stream.getvalue().encode(document.output_encoding, "dxfreplace")


class Files(Mapping[str, bytes]):
    """The files of drawings by name; that of a design's sheet is made when somebody wants it."""

    def __init__(self, files: Mapping[str, bytes | Sheet]) -> None:
        self._files = dict(files)

    def __getitem__(self, name: str) -> bytes:
        found = self._files[name]
        return found.dxf() if isinstance(found, Sheet) else found

    def __iter__(self) -> Iterator[str]:
        return iter(self._files)

    def __len__(self) -> int:
        return len(self._files)


def new_sheet(layers: tuple[str, ...], pivot: Point | None = (0.0, 0.0)) -> Drawing:
    """An empty drawing in millimetres with these layers and, unless None, the pivot point (mm)."""
    import ezdxf

    ezdxf.options.write_fixed_meta_data_for_testing = True
    sheet = ezdxf.new("R2000", units=ezdxf.units.MM)
    for layer in layers:
        sheet.layers.add(layer, color=COLOURS.get(layer, PLAIN))
    if pivot is not None:
        sheet.layers.add("PIVOT", color=COLOURS["PIVOT"])
        sheet.modelspace().add_point((*pivot, 0.0), dxfattribs={"layer": "PIVOT"})
    return sheet


def add_polygon(sheet: Drawing, layer: str, corners: list[Point]) -> None:
    """A closed LWPOLYLINE through the corners (mm)."""
    sheet.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})


def add_circle(sheet: Drawing, layer: str, centre: Point, radius: float) -> None:
    """A CIRCLE (mm)."""
    sheet.modelspace().add_circle((*centre, 0.0), radius, dxfattribs={"layer": layer})


def add_loop(sheet: Drawing, loop: Loop) -> None:
    """The edges of a loop (here in millimetres) as LINE, ARC and CIRCLE on the loop's layer."""
    for edge in loop.edges:
        add_edge(sheet, loop.layer, edge)


def add_edge(sheet: Drawing, layer: str, edge: Edge) -> None:
    """One LINE, ARC or CIRCLE (mm)."""
    _add_edge(sheet.modelspace(), edge, {"layer": layer}, 1.0)


def write(sheet: Drawing, path: Path) -> None:
    """Save the drawing, making its folder if need be."""
    path.parent.mkdir(parents=True, exist_ok=True)
    sheet.saveas(path)
