"""How does a drawing look to the program?

Outlines by layer, their material tinted, pivots as crosses, and a numbered red circle at every fault, so that the designer
sees what was read and where to mend it. The numbers are those of the text report. Faults a hair apart share a circle; a number
stands beside its circle where it covers the least of other circles and numbers, further out with a thin line in a crowd.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import ORDER, Finding
from watchsim.drawing.material import layer_roles
from watchsim.geometry.loops import Box, extents, polyline
from watchsim.geometry.primitives import Arc, Point
from watchsim.render.palette import BACKGROUND, FAINT, FAULT, GRID, INK
from watchsim.render.parts import compound
from watchsim.storage.write import write_file

# Lengths of the marks are in points on the paper.
CIRCLED = 80  # more circles would cover the part
RADIUS = 6.5  # of a circle
CLOSE = 6.0  # faults this close share a circle
LETTER, LINE = 5.9, 9.5  # width of a digit and height of a number
REACHES = (10.5, 21.0, 35.0, 50.0, 65.0, 80.0)  # from the centre of a circle to the near side of its number
WAYS = 12
GROUPS = 2  # numbers or ranges of numbers written at one circle


def fault_circles(axes: Axes, findings: Sequence[Finding]) -> int:
    """Draws circles with the numbers of the report, the gravest first; returns how many faults with a place have none."""
    numbered = sorted(enumerate(findings, 1), key=lambda pair: ORDER.index(pair[1].severity))
    placed = [(k, x, y) for k, finding in numbered for x, y in places(finding)]
    if not placed:
        return 0
    figure = axes.get_figure()
    assert isinstance(figure, Figure)
    figure.draw_without_rendering()  # the layout is settled only then
    scale = 72.0 / figure.dpi
    points = scale * axes.transData.transform(np.array([(x, y) for _, x, y in placed]))
    circles, left = shared([(number, point) for (number, _, _), point in zip(placed, points, strict=True)])
    frame = scale * np.array(axes.get_window_extent().extents)
    centres = np.array([centre for centre, _ in circles])
    taken = [(x - RADIUS, y - RADIUS, x + RADIUS, y + RADIUS) for x, y in centres.tolist()]
    for centre, numbers in sorted(circles, key=lambda circle: min(circle[1])):
        box, text = label(centre, numbers, np.array(taken), frame)
        taken.append(box)
        _draw(axes, tuple(axes.transData.inverted().transform(centre / scale)), centre, text, box)
    return left


def places(finding: Finding) -> list[Point]:
    """Where in the drawing (mm) it is: nowhere, at one place, or at both ends of a gap."""
    if finding.x_mm is None or finding.y_mm is None:
        return []
    return [(finding.x_mm, finding.y_mm), *([finding.other_mm] if finding.other_mm else [])]


def shared(points: Sequence[tuple[int, NDArray[np.float64]]]) -> tuple[list[tuple[NDArray[np.float64], list[int]]], int]:
    """Circles (centre, numbers of their faults), at most CIRCLED, and how many faults found no place at all."""
    circles: list[tuple[NDArray[np.float64], list[int]]] = []
    left: set[int] = set()
    for number, point in points:
        near = next((numbers for centre, numbers in circles if math.dist(centre, point) <= CLOSE), None)
        if near is not None:
            near += [number] if number not in near else []
        elif len(circles) < CIRCLED:
            circles.append((point, [number]))
        else:
            left.add(number)
    return circles, len(left.difference(*(numbers for _, numbers in circles)))


def in_ranges(numbers: Sequence[int]) -> str:
    """ "3, 7–12 …": at most GROUPS numbers or ranges."""
    groups: list[list[int]] = []
    for number in sorted(numbers):
        if groups and number == groups[-1][-1] + 1:
            groups[-1].append(number)
        else:
            groups.append([number])
    texts = [f"{g[0]}–{g[-1]}" if len(g) > 2 else ", ".join(map(str, g)) for g in groups]
    return ", ".join(texts[:GROUPS]) + (f" … (in all {len(numbers)})" if len(texts) > GROUPS else "")


def label(
    centre: NDArray[np.float64], numbers: Sequence[int], taken: NDArray[np.float64], frame: NDArray[np.float64]
) -> tuple[Box, str]:
    """Box and text of a circle's numbers; where all of them have no room, the first alone and how many more there are."""
    full = in_ranges(numbers)
    box, covered = best_box(centre, LETTER * len(full), taken, frame)
    short = f"{min(numbers)} +{len(numbers) - 1}"
    if covered == 0.0 or len(short) >= len(full):
        return box, full
    return best_box(centre, LETTER * len(short), taken, frame)[0], short


def best_box(
    centre: NDArray[np.float64], width: float, taken: NDArray[np.float64], frame: NDArray[np.float64]
) -> tuple[Box, float]:
    """The place of a number of that width that covers least, and the area it covers; upper right before others."""
    best, least, hidden = (0.0, 0.0, 0.0, 0.0), math.inf, 0.0
    for reach in REACHES:
        for k in range(WAYS):
            angle = math.pi / 4.0 - math.tau * k / WAYS
            c, s = math.cos(angle), math.sin(angle)
            x = centre[0] + reach * c + 0.5 * width * (c / max(abs(c), 0.5))
            y = centre[1] + reach * s
            box = (x - 0.5 * width, y - 0.5 * LINE, x + 0.5 * width, y + 0.5 * LINE)
            wide = np.minimum(box[2], taken[:, 2]) - np.maximum(box[0], taken[:, 0])
            high = np.minimum(box[3], taken[:, 3]) - np.maximum(box[1], taken[:, 1])
            covered = float(np.sum(np.maximum(wide, 0.0) * np.maximum(high, 0.0)))
            outside = box[0] < frame[0] or box[1] < frame[1] or box[2] > frame[2] or box[3] > frame[3]
            cost = covered + (width * LINE if outside else 0.0) + 0.5 * (reach - REACHES[0])
            if cost < least - 1e-9:
                best, least, hidden = box, cost, covered
    return best, hidden


def _draw(axes: Axes, place: Point, centre: NDArray[np.float64], text: str, box: Box) -> None:
    x, y = place
    middle = (0.5 * (box[0] + box[2]) - centre[0], 0.5 * (box[1] + box[3]) - centre[1])
    ring = 2.0 * RADIUS
    axes.plot(x, y, "o", markersize=ring, markerfacecolor="none", markeredgecolor=FAULT, markeredgewidth=1.4, zorder=6)
    gap = math.hypot(max(abs(middle[0]) - 0.5 * (box[2] - box[0]), 0.0), middle[1])
    far = gap > REACHES[0] + 0.5 * LINE
    axes.annotate(
        *(text, (x, y), middle, "data", "offset points"),
        color=FAULT,
        fontsize=8,
        fontweight="bold",
        ha="center",
        va="center",
        zorder=7,
        annotation_clip=False,
        arrowprops={"arrowstyle": "-", "color": FAULT, "linewidth": 0.6, "shrinkA": 0.0, "shrinkB": RADIUS} if far else None,
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
    )


COLOURS = ("#2f5d8a", "#a8780a", "#2e7d57", "#7b4a9e", "#b0562c", "#3f8f98", "#5f6b78", "#96527a", "#6f7f1f", "#8a4b4b")
SIZE = (9.0, 7.2)  # inches
DPI = 150
LONGEST, SHORTEST = 16.0, 4.0  # inches of the sides of a slender part's picture
FINENESS = 3e-5  # of the part's size: chords of arcs stray less than a twentieth of a pixel
TINT = 0.16  # opacity of material
HATCHES = ("", "////", "....", "xxxx")  # of the material, for layers beyond the last colour
BESIDE = 1.015  # of the width of the axes: where the legend begins
LISTED = 20  # layers in the legend
NAMED = 60  # letters of the file's name


def draw_drawing(drawing: Drawing, png_path: Path | str, centres: bool = False) -> None:
    """Writes the picture as PNG; OSError where the file cannot be written. It is written whole or not at all."""
    figure = picture(drawing, centres)

    def fill(scratch: Path) -> None:
        figure.savefig(scratch, format="png", dpi=DPI, bbox_inches="tight", pad_inches=0.2)

    write_file(Path(png_path), fill, "the picture")


def picture(drawing: Drawing, centres: bool = False) -> Figure:
    """The figure, on an Agg canvas; with `centres`, dots at the centres of all arcs that lie in the picture."""
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
    name, box = _short(drawing.path.name, NAMED), extents((*drawing.loops, *drawing.open_chains))
    if box is None:
        return f"{name}: nothing to show"
    size = f"{1e3 * (box[2] - box[0]):.4g} × {1e3 * (box[3] - box[1]):.4g} mm"
    return f"{name}   {size}{'' if drawing.units else '   (units not stated, taken as mm)'}"


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
    layer, colour, hatch = look
    closed = [1e3 * polyline(loop, deviation) for loop in drawing.loops if loop.layer == layer]
    chains = [1e3 * polyline(loop, deviation) for loop in drawing.open_chains if loop.layer == layer]
    if closed:
        # Holes run the other way round, so the winding rule leaves them out.
        curve = compound(closed)
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


def _centres(axes: Axes, drawing: Drawing, layer: str, colour: str) -> None:
    """A dot at the centre of every arc of the layer."""
    loops = [loop for loop in (*drawing.loops, *drawing.open_chains) if loop.layer == layer]
    places = {(1e3 * edge.x, 1e3 * edge.y) for loop in loops for edge in loop.edges if isinstance(edge, Arc)}
    if places:
        axes.plot(*zip(*sorted(places), strict=True), "o", color=colour, markersize=2.2, markeredgewidth=0.0, zorder=5)


def _legend(axes: Axes, drawing: Drawing, centres: bool) -> Legend:
    """Layer names beside the picture, and what crosses, dashes and circles mean where there are any."""
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
    place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (BESIDE, 1.0), "borderaxespad": 0.0}
    legend = axes.legend(handles, names, frameon=False, fontsize=9, labelcolor=INK, **place)
    for text in legend.get_texts():
        text.set_parse_math(False)
    return legend


def _short(name: str, most: int = 24) -> str:
    """One line of at most so many letters: a name may be as long as the file."""
    name = " ".join(name[: 4 * most].split())
    return name if len(name) <= most else name[: most - 1] + "…"
