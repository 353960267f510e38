"""What does the sheet of a part look like as a DXF file?

Millimetres as its draughtsman has them (write_dxf writes outlines in metres), named layers, one point on the layer PIVOT, and
nothing that changes from one writing to the next: the same sheet gives the same file.
"""

from __future__ import annotations

import io
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

if TYPE_CHECKING:
    from ezdxf.document import Drawing

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


def new_sheet(layers: tuple[str, ...], pivot: Point | None = (0.0, 0.0)) -> Drawing:
    """An empty drawing in millimetres with these layers and, unless None, the pivot point (mm)."""
    import ezdxf  # a fifth of the start of a run that draws nothing

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
    """One LINE, ARC or CIRCLE; a DXF arc always runs counter-clockwise."""
    space = sheet.modelspace()
    attributes = {"layer": layer}
    if isinstance(edge, Line):
        space.add_line((*edge.start, 0.0), (*edge.end, 0.0), dxfattribs=attributes)
    elif edge.is_circle:
        space.add_circle((edge.x, edge.y, 0.0), edge.radius, dxfattribs=attributes)
    else:
        arc = edge if edge.sweep > 0.0 else edge.reversed()
        start = math.degrees(arc.start_angle) % 360.0
        space.add_arc((arc.x, arc.y, 0.0), arc.radius, start, start + math.degrees(arc.sweep), dxfattribs=attributes)


def write(sheet: Drawing, path: Path) -> None:
    """Save the drawing, making its folder if need be."""
    path.parent.mkdir(parents=True, exist_ok=True)
    sheet.saveas(path)
