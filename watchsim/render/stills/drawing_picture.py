"""How does a drawing look to the program?

Outlines by layer, their material tinted, pivots as crosses, and a numbered red circle at every fault, so that the designer
sees what was read and where to mend it. The numbers are those of the text report.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.drawn_material import layer_roles
from watchsim.geometry.extent import Box, extents
from watchsim.geometry.polyline import polyline
from watchsim.geometry.primitives import Arc
from watchsim.render.palette import BACKGROUND, FAINT, GRID, INK
from watchsim.render.stills.fault_circles import FAULT, fault_circles
from watchsim.storage.write import write_file

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend

COLOURS = ("#2f5d8a", "#a8780a", "#2e7d57", "#7b4a9e", "#b0562c", "#3f8f98", "#5f6b78", "#96527a", "#6f7f1f", "#8a4b4b")
SIZE = (9.0, 7.2)  # inches
DPI = 150
LONGEST, SHORTEST = 16.0, 4.0  # inches of the sides of a slender part's picture
FINENESS = 3e-5  # of the part's size: chords of arcs stray less than a twentieth of a pixel
TINT = 0.16  # opacity of material
HATCHES = ("", "////", "....", "xxxx")  # of the material, for layers beyond the last colour
BESIDE = 1.015  # of the width of the axes: where the legend begins
LISTED = 20  # layers in the legend


def draw_drawing(drawing: Drawing, png_path: Path | str, centres: bool = False) -> None:
    """Writes the picture as PNG; OSError where the file cannot be written. It is written whole or not at all."""
    figure = picture(drawing, centres)

    def fill(scratch: Path) -> None:
        figure.savefig(scratch, format="png", dpi=DPI, bbox_inches="tight", pad_inches=0.2)

    write_file(Path(png_path), fill, "the picture")


def picture(drawing: Drawing, centres: bool = False) -> Figure:
    """The figure, on an Agg canvas; with `centres`, dots at the centres of all arcs that lie in the picture."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    box = _frame(drawing)
    figure = Figure(figsize=_paper(box), facecolor=BACKGROUND, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    _furnish(axes, drawing, box)
    roles = layer_roles(drawing.loops)
    for look in _looks(drawing):
        _layer(axes, drawing, look, roles.get(look.layer, "material"), FINENESS * max(box[2] - box[0], box[3] - box[1]))
        if centres:
            _centres(axes, drawing, look.layer, look.colour)
    legend = _legend(axes, drawing, centres) if drawing.layers else None
    left = fault_circles(axes, drawing.findings)
    if left and legend is not None:
        legend.set_title(f"{left} more faults\nare in the list only")
        legend.get_title().set_fontsize(9)
    return figure


def _frame(drawing: Drawing) -> Box:
    """What the picture shows, in metres: everything drawn and a margin, never nothing."""
    box = extents((*drawing.loops, *drawing.open_chains))
    xs = [x for _, x, _ in drawing.points] + ([box[0], box[2]] if box else [])
    ys = [y for _, _, y in drawing.points] + ([box[1], box[3]] if box else [])
    if not xs:
        return (-1e-3, -1e-3, 1e-3, 1e-3)
    margin = 0.06 * max(max(xs) - min(xs), max(ys) - min(ys)) or 1e-3
    return (min(xs) - margin, min(ys) - margin, max(xs) + margin, max(ys) + margin)


def _paper(box: Box) -> tuple[float, float]:
    """A sheet of constant area in the shape of the part, within limits; room for scales and legend beside it."""
    ratio = (box[2] - box[0]) / (box[3] - box[1])
    side = math.sqrt(SIZE[0] * SIZE[1])
    width, height = side * math.sqrt(ratio), side / math.sqrt(ratio)
    return (min(max(width, SHORTEST), LONGEST) + 2.2, min(max(height, SHORTEST), LONGEST) + 0.6)


def _furnish(axes: Axes, drawing: Drawing, box: Box) -> None:
    """Scales in millimetres, equal both ways; the title says what was read and how large it is."""
    axes.set_facecolor("white")
    axes.set_aspect("equal")
    axes.set_xlim(1e3 * box[0], 1e3 * box[2])
    axes.set_ylim(1e3 * box[1], 1e3 * box[3])
    axes.set_xlabel("x (mm)", color=INK)
    axes.set_ylabel("y (mm)", color=INK)
    axes.tick_params(colors=FAINT, labelcolor=INK)
    axes.grid(color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.ticklabel_format(useOffset=False, style="plain")
    for spine in axes.spines.values():
        spine.set_color(GRID)
    axes.set_title(_title(drawing), color=INK, fontsize=11, loc="left", parse_math=False)


def _title(drawing: Drawing) -> str:
    box = extents((*drawing.loops, *drawing.open_chains))
    if box is None:
        return f"{drawing.path.name}: nothing to show"
    size = f"{1e3 * (box[2] - box[0]):.4g} × {1e3 * (box[3] - box[1]):.4g} mm"
    return f"{drawing.path.name}   {size}{'' if drawing.units else '   (units not stated, taken as mm)'}"


class _Look(NamedTuple):
    """How a layer is shown."""

    layer: str
    colour: str
    hatch: str


def _looks(drawing: Drawing) -> list[_Look]:
    rounds = ((layer, *divmod(number, len(COLOURS))) for number, layer in enumerate(drawing.layers))
    return [_Look(layer, COLOURS[colour], HATCHES[turn % len(HATCHES)]) for layer, turn, colour in rounds]


def _layer(axes: Axes, drawing: Drawing, look: _Look, role: str, deviation: float) -> None:
    """The material of a layer in one tint with its holes left white, outlines and open chains on top, points as crosses.

    A bore on a layer of its own is white, and what only marks a place has no tint.
    """
    from matplotlib.collections import LineCollection
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Curve

    layer, colour, hatch = look
    closed = [1e3 * polyline(loop, deviation) for loop in drawing.loops if loop.layer == layer]
    chains = [1e3 * polyline(loop, deviation) for loop in drawing.open_chains if loop.layer == layer]
    if closed:
        # Holes run the other way round, so the winding rule leaves them out.
        curve = Curve(np.concatenate(closed), np.concatenate([_codes(len(points)) for points in closed]))
        if role == "material":
            axes.add_patch(PathPatch(curve, facecolor=colour, alpha=TINT, linewidth=0.0))
        elif role == "bore":
            axes.add_patch(PathPatch(curve, facecolor="white", linewidth=0.0, zorder=1.2))
        if hatch and role == "material":
            axes.add_patch(PathPatch(curve, facecolor="none", edgecolor=colour, alpha=2.0 * TINT, hatch=hatch, linewidth=0.0))
        axes.add_collection(LineCollection(closed, colors=colour, linewidths=1.1))
    if chains:
        axes.add_collection(LineCollection(chains, colors=colour, linewidths=1.1, linestyles=(0, (5, 2))))
    places = [(1e3 * x, 1e3 * y) for name, x, y in drawing.points if name == layer]
    if places:
        axes.plot(*zip(*places, strict=True), "+", color=colour, markersize=13, markeredgewidth=1.6, zorder=4)


def _codes(count: int) -> np.ndarray:
    """Path codes of one outline whose last point repeats the first."""
    from matplotlib.path import Path as Curve

    codes = np.full(count, Curve.LINETO, dtype=Curve.code_type)
    codes[0], codes[-1] = Curve.MOVETO, Curve.CLOSEPOLY
    return codes


def _centres(axes: Axes, drawing: Drawing, layer: str, colour: str) -> None:
    """A dot at the centre of every arc of the layer."""
    loops = [loop for loop in (*drawing.loops, *drawing.open_chains) if loop.layer == layer]
    places = {(1e3 * edge.x, 1e3 * edge.y) for loop in loops for edge in loop.edges if isinstance(edge, Arc)}
    if places:
        axes.plot(*zip(*sorted(places), strict=True), "o", color=colour, markersize=2.2, markeredgewidth=0.0, zorder=5)


def _legend(axes: Axes, drawing: Drawing, centres: bool) -> Legend:
    """Layer names beside the picture, and what crosses, dashes and circles mean where there are any."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    roles = layer_roles(drawing.loops)
    drawn = {loop.layer for loop in (*drawing.loops, *drawing.open_chains)}

    def swatch(look: _Look) -> object:
        if look.layer not in drawn:
            return Line2D([], [], color=look.colour, marker="+", linestyle="none", markersize=10, markeredgewidth=1.6)
        if roles.get(look.layer, "material") != "material":
            return Patch(facecolor="none", edgecolor=look.colour)
        return Patch(facecolor=look.colour, alpha=0.5, edgecolor=look.colour, hatch=look.hatch)

    rows = [(swatch(look), _short(look.layer)) for look in _looks(drawing)]
    if len(rows) > LISTED:
        rows = [*rows[:LISTED], (Line2D([], [], linestyle="none"), f"and {len(rows) - LISTED} more layers")]
    if drawing.open_chains:
        rows.append((Line2D([], [], color=FAINT, linestyle=(0, (5, 2)), linewidth=1.1), "open"))
    if any(layer in drawn for layer, _, _ in drawing.points):
        rows.append((Line2D([], [], color=FAINT, marker="+", linestyle="none", markersize=10), "point"))
    if centres:
        rows.append((Line2D([], [], color=FAINT, marker="o", linestyle="none", markersize=3), "centre of an arc"))
    if any(finding.x_mm is not None for finding in drawing.findings):
        ring = Line2D([], [], marker="o", linestyle="none", markersize=10, markerfacecolor="none", markeredgecolor=FAULT)
        rows.append((ring, "fault: see the list"))
    handles, names = zip(*rows, strict=True)
    legend = axes.legend(
        handles,
        names,
        loc="upper left",
        bbox_to_anchor=(BESIDE, 1.0),
        borderaxespad=0.0,
        frameon=False,
        fontsize=9,
        labelcolor=INK,
    )
    for text in legend.get_texts():
        text.set_parse_math(False)
    return legend


def _short(name: str) -> str:
    return name if len(name) <= 24 else name[:23] + "…"
