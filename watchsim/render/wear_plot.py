"""Where does an outline wear? Archard's N s as colour along it, of the places that wear most."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from numpy.typing import NDArray

from watchsim.analysis.wear import CELLS, TOOTH, Wear, cell_ends, wear
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import CORNER
from watchsim.render import style
from watchsim.render.marks import spaced
from watchsim.render.palette import FAINT, INK
from watchsim.simulation.trajectory import Trajectory
from watchsim.units import metric

Array = NDArray[np.float64]
MOST, WIDE = 6, 42.0  # panels; mm, of one with its caption
FACE = re.compile(" (corner|locking face|impulse face)$")  # those of a stone or pallet share a panel
TALL, FOOT = 0.95, 31.0  # of a panel's width; mm, of title, names and scale
DECADES = 1e3  # below the most: less counts as least
THICK, POINTS = 3.2, 26.0  # pt, and pt² of a corner
ROOM = 0.25  # of what wears, around it
LEAST = 1e-6  # of the most: less is rounding, as of a stop that is only pressed
LEAST_SIDE = 0.02  # of the body's outlines: narrower, a corner alone would not show what it is the corner of
MM = 1e3


def plot_wear(
    run: Trajectory, window: Sequence[float] | None = None, width: float = style.FULL, ax: Axes | None = None
) -> Figure:
    """Of the places that wear most (of all teeth the one that does) the true outline, with load times sliding distance in a
    year for each millimetre of it as colour; a corner, which has no length, as a ring, with its sum in words.

    ValueError where nothing slides, and as `wear` has it. `width` in mm.
    """
    found, compiled = wear(run, window), compile_scene(run.scene)
    groups = _groups(found)
    if not groups:
        raise ValueError("nothing slides there under a load, so nothing wears")
    cells = {side: _along(found, compiled, side) for sides in groups.values() for side in sides}
    most = max((float(own.max()) for own in cells.values() if len(own)), default=0.0) or 1.0
    across = max(min(3, int(width / WIDE), len(groups)), 1)
    norm, rows = LogNorm(most / DECADES, most), -(-len(groups) // across)
    made = style.figure(width, TALL * min(width / across, 0.4 * style.FULL) * rows + FOOT, layout="constrained", ax=ax)
    style.heading(made, run.scene.title, "Wear along outlines that slide under load (mm); rings: at corners")
    engine = made.get_layout_engine()
    if isinstance(engine, ConstrainedLayoutEngine):
        edge = style.EDGE / style.size_mm(made)[0]
        engine.set(rect=(edge, 0.0, 1.0 - 2.0 * edge, 1.0 - (style.HEADING + 2.0) / style.size_mm(made)[1]))
    panels = made.subplots(rows, across, squeeze=False)
    for axes, (name, sides) in zip(panels.flat, groups.items(), strict=False):
        _panel(axes, name, sides, (found, compiled, cells), norm)
    for axes in list(panels.flat)[len(groups) :]:
        axes.set_visible(False)
    scale = LineCollection([], cmap=style.MAP, norm=norm)
    bar = made.colorbar(scale, ax=panels, location="bottom", shrink=0.6, aspect=50, pad=0.04)
    bar.ax.tick_params(labelsize=style.TICK, colors=INK)
    bar.set_label("load × sliding distance in a year, N·m per mm of outline", fontsize=style.LABEL, color=INK)
    return made


def _groups(found: Wear) -> dict[str, list[int]]:
    """Name of a panel -> primitives: a stone with all its faces, one tooth of all; those that wear most."""
    sums: dict[tuple[str, str], list[int]] = {}
    for side, (body, place) in found.where.items():
        sums.setdefault((body, FACE.sub("", place)), []).append(side)
    index = {key: sum(float(found.along[side].sum()) for side in sides) for key, sides in sums.items()}
    teeth = [key for key in index if key[1].startswith(TOOTH)]
    left_out = set(teeth) - {max(teeth, key=index.__getitem__)} if teeth else set()
    least = LEAST * max(index.values(), default=0.0)
    ranked = sorted((key for key in index if key not in left_out and index[key] >= least), key=lambda key: -index[key])
    named = {key: key[1].lower() if key[1].isupper() else key[1] for key in ranked}  # layers in capitals are words here
    return {spaced(f"{key[0]}, {named[key]}" if key[0] != key[1] else key[0]): sums[key] for key in ranked[:MOST]}


def _along(found: Wear, compiled: Compiled, side: int) -> Array:
    """N·m in a year for each mm, of each part of an edge; nothing of a corner."""
    if compiled.model.primitives.kind[side] == CORNER:
        return np.zeros(0)
    ends = cell_ends(compiled, side)
    lengths = MM * np.hypot(*np.diff(ends, axis=0).T)
    return np.asarray(found.in_a_year(1.0) * found.along[side] / lengths)


def _panel(axes: Any, name: str, sides: list[int], what: tuple[Wear, Compiled, dict[int, Array]], norm: LogNorm) -> None:
    found, compiled, cells = what
    worn = np.concatenate([_worn_ends(found, compiled, side) for side in sides])
    middle = 0.5 * MM * (worn.min(axis=0) + worn.max(axis=0))
    primitives = compiled.model.primitives
    whole = [cell_ends(compiled, int(other)) for other in np.flatnonzero(primitives.body == primitives.body[sides[0]])]
    least = LEAST_SIDE * float(np.ptp(np.concatenate(whole), axis=0).max())
    half = (0.5 + ROOM) * MM * max(float(np.ptp(worn, axis=0).max()), least)
    for points in whole:
        axes.plot(*(MM * points).T, color=FAINT, linewidth=style.THIN, zorder=1)
    for side in sides:
        points = MM * cell_ends(compiled, side)
        if len(cells[side]):
            pieces = np.stack((points[:-1], points[1:]), axis=1)[cells[side] > 0.0]
            shown = cells[side][cells[side] > 0.0]
            axes.add_collection(
                LineCollection(list(pieces), array=shown, cmap=style.MAP, norm=norm, linewidths=THICK, zorder=2)
            )
    corners = [side for side in sides if not len(cells[side])]
    for side in corners:
        axes.scatter(
            *(MM * cell_ends(compiled, side)).T, s=POINTS, facecolor="none", edgecolor=INK, linewidth=style.THIN, zorder=3
        )
    axes.set_aspect("equal")
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    axes.set_title(name, fontsize=style.LABEL, color=INK)
    taken = found.in_a_year(sum(float(found.along[side].sum()) for side in sides))
    words = f"{metric(taken, 'N·m', 3)} a year"
    if corners:
        there = found.in_a_year(sum(float(found.along[side].sum()) for side in corners)) / taken
        line = "\n" if style.size_mm(axes.figure)[0] < style.NARROW else " "
        words += f",{line}{100.0 * there:.0f} % at corners"
    axes.set_xlabel(words, fontsize=style.SMALL, color=INK)
    style.ticks(axes.xaxis, 3)
    style.ticks(axes.yaxis, 3)
    axes.tick_params(labelsize=style.TICK, colors=INK)


def _worn_ends(found: Wear, compiled: Compiled, side: int) -> Array:
    """The ends of what wears of a primitive, m."""
    ends = cell_ends(compiled, side)
    if len(ends) == 1:
        return ends
    worn = np.flatnonzero(found.along[side] > 0.0)
    return ends[np.unique(np.concatenate((worn, np.minimum(worn + 1, CELLS))))]
