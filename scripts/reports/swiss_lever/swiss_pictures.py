"""How are the studies of the Swiss lever drawn? Error bars are those of the limit cycles; most are smaller than the marks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from swiss_studies import Floats, Series

from watchsim.render.figures.figure_style import CURVE, FULL, HAIR, SERIES, dress, figure, key, save
from watchsim.render.palette import FAINT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

IMAGES = Path(__file__).resolve().parents[3] / "docs" / "images"
BLUE, RED, GREEN, GOLD = (SERIES[k] for k in (0, 1, 2, 4))
HEIGHT = 62.0  # mm, of a panel
MARKED: dict[str, Any] = {"marker": "o", "markersize": 2.6, "linewidth": CURVE}  # points of a curve


def panels(rows: int, columns: int = 1, *, share: bool = True, height: float = HEIGHT) -> tuple[Figure, list[Axes]]:
    """A figure with panels in reading order."""
    made = figure(FULL, height * rows, layout="constrained")
    found: list[Any] = list(made.subplots(rows, columns, squeeze=False, sharex="col" if share else "none").flat)
    for axes in found:
        dress(axes)
        axes.ticklabel_format(useOffset=False)
    return made, found


def dots(axes: Axes, x: Floats, series: Series, name: str, label: str, colour: str, marker: str = "o") -> None:
    """Points of the limit cycles with their error bars."""
    y, bars = series.of(name), np.nan_to_num(series.of(f"{name}_error"))
    axes.errorbar(x, y, yerr=bars, color=colour, elinewidth=HAIR, capsize=1.5, label=label, **{**MARKED, "marker": marker})


def line(axes: Axes, x: Floats, y: Floats, label: str, colour: str = FAINT, style: str = "--") -> None:
    """A law beside the points."""
    axes.plot(x, y, color=colour, linestyle=style, linewidth=CURVE, label=label, zorder=1)


def named(axes: Axes, across: str, up: str, *, legend: bool = True) -> None:
    """The labels of a panel."""
    if across:
        axes.set_xlabel(across)
    axes.set_ylabel(up)
    if legend:
        handles, names = axes.get_legend_handles_labels()
        key(axes, list(zip(handles, names, strict=True)))


def saved(made: Figure, name: str) -> str:
    """Writes docs/images/swiss_study_NAME.png; the path as a page in docs/guide names it."""
    file = f"swiss_study_{name}.png"
    save(made, IMAGES / file)
    return f"../images/{file}"
