"""How does a drawing look to the program?

Outlines by layer, their material tinted, pivots as crosses, and a numbered red circle at every fault, so that the designer
sees what was read and where to mend it. The numbers are those of the text report.
"""

from __future__ import annotations

import io
import math
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.geometry.extent import Box, extents
from watchsim.geometry.polyline import polyline
from watchsim.render.palette import BACKGROUND, FAINT, GRID, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#2f5d8a", "#a8780a", "#2e7d57", "#7b4a9e", "#b0562c", "#3f8f98", "#5f6b78", "#96527a", "#6f7f1f", "#8a4b4b")
FAULT = "#d0021b"
SIZE = (9.0, 7.2)  # inches
DPI = 150
LONGEST, SHORTEST = 16.0, 4.0  # inches of the sides of a slender part's picture
CIRCLED = 99  # more circles would cover the part
FINENESS = 3e-5  # of the part's size: chords of arcs stray less than a twentieth of a pixel
LISTED = 20  # layers in the legend


def draw_drawing(drawing: Drawing, png_path: Path | str) -> None:
    """Writes the picture as PNG; OSError where the file cannot be written. It is written whole or not at all."""
    buffer = io.BytesIO()
    picture(drawing).savefig(buffer, format="png", dpi=DPI, bbox_inches="tight", pad_inches=0.2)
    path = Path(png_path)
    scratch = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        scratch.write_bytes(buffer.getvalue())
        scratch.replace(path)
    finally:
        scratch.unlink(missing_ok=True)


def picture(drawing: Drawing) -> Figure:
    """The figure, on an Agg canvas."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    box = _frame(drawing)
    figure = Figure(figsize=_paper(box), facecolor=BACKGROUND, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    _furnish(axes, drawing, box)
    for layer, colour in _coloured(drawing):
        _layer(axes, drawing, layer, colour, FINENESS * max(box[2] - box[0], box[3] - box[1]))
    _circles(axes, drawing.findings)
    if drawing.layers:
        _legend(figure, drawing)
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


def _coloured(drawing: Drawing) -> Iterator[tuple[str, str]]:
    for number, layer in enumerate(drawing.layers):
        yield layer, COLOURS[number % len(COLOURS)]


def _layer(axes: Axes, drawing: Drawing, layer: str, colour: str, deviation: float) -> None:
    """The material of a layer in one tint with its holes left white, outlines and open chains on top, points as crosses."""
    from matplotlib.collections import LineCollection
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Curve

    closed = [1e3 * polyline(loop, deviation) for loop in drawing.loops if loop.layer == layer]
    chains = [1e3 * polyline(loop, deviation) for loop in drawing.open_chains if loop.layer == layer]
    if closed:
        # Holes run the other way round, so the winding rule leaves them out.
        curve = Curve(np.concatenate(closed), np.concatenate([_codes(len(points)) for points in closed]))
        axes.add_patch(PathPatch(curve, facecolor=colour, alpha=0.16, linewidth=0.0))
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


def _circles(axes: Axes, findings: Sequence[Finding]) -> None:
    """Numbered circles at what was found, in the order of the report; places a hair apart share one circle."""
    from matplotlib.patheffects import withStroke

    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    near = 0.012 * max(x1 - x0, y1 - y0)
    shared: dict[tuple[int, int], list[tuple[int, Finding]]] = {}
    for number, finding in enumerate(findings, 1):
        if finding.x_mm is not None and finding.y_mm is not None and len(shared) < CIRCLED:
            shared.setdefault((round(finding.x_mm / near), round(finding.y_mm / near)), []).append((number, finding))
    for group in shared.values():
        x, y = group[0][1].x_mm or 0.0, group[0][1].y_mm or 0.0
        numbers = [str(number) for number, _ in group]
        text = ", ".join(numbers[:3]) + (" …" if len(numbers) > 3 else "")
        axes.plot(x, y, "o", markersize=15, markerfacecolor="none", markeredgecolor=FAULT, markeredgewidth=1.6, zorder=6)
        axes.annotate(
            *(text, (x, y), (9, 8), "data", "offset points"),
            color=FAULT,
            fontsize=9,
            fontweight="bold",
            zorder=7,
            annotation_clip=False,
            path_effects=[withStroke(linewidth=3, foreground="white")],
        )


def _legend(figure: Figure, drawing: Drawing) -> None:
    """Layer names beside the picture, and what crosses, dashes and circles mean where there are any."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    rows: list[tuple[object, str]] = [
        (Patch(facecolor=colour, alpha=0.5, edgecolor=colour), _short(layer)) for layer, colour in _coloured(drawing)
    ]
    if len(rows) > LISTED:
        rows = [*rows[:LISTED], (Line2D([], [], linestyle="none"), f"and {len(rows) - LISTED} more layers")]
    if drawing.open_chains:
        rows.append((Line2D([], [], color=FAINT, linestyle=(0, (5, 2)), linewidth=1.1), "open"))
    if drawing.points:
        rows.append((Line2D([], [], color=FAINT, marker="+", linestyle="none", markersize=10), "point"))
    if any(finding.x_mm is not None for finding in drawing.findings):
        ring = Line2D([], [], marker="o", linestyle="none", markersize=10, markerfacecolor="none", markeredgecolor=FAULT)
        rows.append((ring, "see the findings"))
    handles, names = zip(*rows, strict=True)
    legend = figure.legend(handles, names, loc="outside right upper", frameon=False, fontsize=9, labelcolor=INK)
    for text in legend.get_texts():
        text.set_parse_math(False)


def _short(name: str) -> str:
    return name if len(name) <= 24 else name[:23] + "…"
