"""How are the studies of the Swiss lever drawn? Error bars are those of the limit cycles; most are smaller than the marks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from swiss_studies import Floats, Series

from watchsim.render.palette import FAINT, GRID, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

IMAGES = Path(__file__).resolve().parents[3] / "docs" / "images"
BLUE, RED, GREEN, GOLD = "#1f4e79", "#b5452c", "#6b7d3a", "#c98a1b"
WIDTH, HEIGHT = 7.2, 3.2  # inches, of a panel


def panels(rows: int, columns: int = 1, *, share: bool = True, height: float = HEIGHT) -> tuple[Figure, list[Axes]]:
    """A figure with panels in reading order."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH if columns == 1 else 1.35 * WIDTH, height * rows), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    found: list[Any] = list(figure.subplots(rows, columns, squeeze=False, sharex="col" if share else "none").flat)
    for axes in found:
        axes.grid(True, color=GRID, linewidth=0.7)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
        axes.spines[["left", "bottom"]].set_color(FAINT)
        axes.tick_params(colors=INK, labelsize=9)
        axes.ticklabel_format(useOffset=False)
    return figure, found


def dots(axes: Axes, x: Floats, series: Series, name: str, label: str, colour: str, marker: str = "o") -> None:
    """Points of the limit cycles with their error bars."""
    y, bars = series.of(name), np.nan_to_num(series.of(f"{name}_error"))
    axes.errorbar(x, y, yerr=bars, color=colour, marker=marker, markersize=3.8, linewidth=1.0, capsize=2.0, label=label)


def line(axes: Axes, x: Floats, y: Floats, label: str, colour: str = FAINT, style: str = "--") -> None:
    """A law beside the points."""
    axes.plot(x, y, color=colour, linestyle=style, linewidth=1.2, label=label, zorder=1)


def named(axes: Axes, across: str, up: str, *, legend: bool = True) -> None:
    """The labels of a panel."""
    if across:
        axes.set_xlabel(across, color=INK)
    axes.set_ylabel(up, color=INK)
    if legend:
        axes.legend(frameon=False, fontsize=8)


def saved(figure: Figure, name: str) -> str:
    """Writes docs/images/swiss_study_NAME.png; the path as a page in docs/guide names it."""
    file = f"swiss_study_{name}.png"
    figure.savefig(IMAGES / file)
    return f"../images/{file}"
