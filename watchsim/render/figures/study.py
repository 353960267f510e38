"""How is a sweep drawn?

One key: a curve with error bars for each output. Two keys: a family of curves where one of them has few values, else a map.
Points without a number are marked where they lie, with what happens there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from watchsim.render.palette import CONTACT, FAINT, GRID, INK
from watchsim.studies.axes import Axis
from watchsim.studies.outputs import Output
from watchsim.studies.sweep import Sweep
from watchsim.units import to

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

PANEL = (7.0, 2.6)  # inches
FAMILY = 7  # curves in one panel at most
CURVES = ("#1f4e79", "#b5452c", "#6b7d3a", "#c98a1b", "#74469a", "#2f7a58", "#6a7683")
MAP = "cividis"


def plot_sweep(sweep: Sweep) -> Figure:
    """A panel for each output over the first key, or over the one with most values; a figure to save as PNG, SVG or PDF.

    ValueError where nothing can be drawn: more than two keys, or keys without numbers.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    numeric = [axis for axis in sweep.axes if axis.is_numeric]
    if not numeric or len(sweep.axes) > 2:
        raise ValueError("only sweeps over one or two keys with numbers can be drawn")
    size = (PANEL[0], PANEL[1] * len(sweep.outputs) + 0.6)
    figure = Figure(figsize=size, dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(len(sweep.outputs), 1, sharex=True, squeeze=False)[:, 0]
    figure.suptitle(sweep.title, x=0.01, ha="left", fontsize=11, weight="bold", color=INK)
    along, other = _roles(sweep, numeric)
    field = other if other is not None and other.is_numeric and len(other.values) > FAMILY else None
    for axes, output in zip(panels, sweep.outputs, strict=True):
        if field is not None:
            _map(figure, axes, sweep, along, field, output)
        else:
            _curves(axes, sweep, along, other, output)
        _dress(axes, grid=field is None)
    panels[-1].set_xlabel(_label(along), color=INK)
    if other is not None and field is None:
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(
            handles, labels, title=_label(other), loc="outside right upper", frameon=False, fontsize=8, title_fontsize=8
        )
    return figure


def _roles(sweep: Sweep, numeric: Sequence[Axis]) -> tuple[Axis, Axis | None]:
    """The key along the abscissa and the other one: the abscissa belongs to numbers, and to the longer list."""
    along = max(numeric, key=lambda axis: len(axis.values))
    return along, next((axis for axis in sweep.axes if axis is not along), None)


def _label(axis: Axis) -> str:
    return f"{axis.key} ({axis.usual})" if axis.usual else axis.key


def _shown(axis: Axis, value: Any) -> Any:
    """A value of a key in the unit in which people read it."""
    return to(value, axis.usual) if axis.usual and not isinstance(value, str) else value


def _curves(axes: Axes, sweep: Sweep, along: Axis, other: Axis | None, output: Output) -> None:
    for i, value in enumerate(other.values if other else (None,)):
        rows = [row for row in sweep.rows if other is None or row[other.key] == value]
        rows.sort(key=lambda row: row[along.key])
        good = [row for row in rows if row[output.column] is not None]
        x = np.array([_shown(along, row[along.key]) for row in good], float)
        y = np.array([row[output.column] for row in good], float)
        bars = np.array([row.get(f"{output.column}_error") or 0.0 for row in good], float)
        colour = CURVES[i % len(CURVES)]
        label = f"{_shown(other, value):.6g}" if other and other.is_numeric else str(value)
        axes.errorbar(x, y, yerr=bars, color=colour, marker="o", markersize=3.5, linewidth=1.2, capsize=2.0, label=label)
        _failures(axes, [row for row in rows if row[output.column] is None], along, colour if other else CONTACT)
    axes.set_ylabel(f"{output.label} ({output.unit})" if output.unit else output.label, color=INK)


def _failures(axes: Axes, rows: Sequence[Any], along: Axis, colour: str) -> None:
    """Crosses at the lower edge, named once per verdict."""
    from matplotlib.transforms import blended_transform_factory

    edge = blended_transform_factory(axes.transData, axes.transAxes)
    told: set[str] = set()
    for row in rows:
        x, verdict = _shown(along, row[along.key]), row["verdict"] or "no result"
        axes.plot([x], [0.04], marker="x", color=colour, markersize=5, transform=edge, clip_on=False, linestyle="none")
        if verdict not in told:
            style: dict[str, Any] = {"color": CONTACT, "fontsize": 8, "ha": "center", "va": "bottom"}
            axes.text(x, 0.09, verdict, transform=edge, **style)
            told.add(verdict)


def _map(figure: Figure, axes: Axes, sweep: Sweep, along: Axis, other: Axis, output: Output) -> None:
    x, y = sorted({_shown(along, v) for v in along.values}), sorted({_shown(other, v) for v in other.values})
    field = np.full((len(y), len(x)), np.nan)
    for row in sweep.rows:
        if row[output.column] is not None:
            field[y.index(_shown(other, row[other.key])), x.index(_shown(along, row[along.key]))] = row[output.column]
    mesh = axes.pcolormesh(x, y, np.ma.masked_invalid(field), cmap=MAP, shading="nearest")
    axes.set_facecolor(GRID)  # where there is no number
    if reasons := sorted({row["verdict"] or "no result" for row in sweep.rows if row[output.column] is None}):
        axes.set_title(f"grey: {', '.join(reasons)}", loc="right", fontsize=8, color=INK)
    bar = figure.colorbar(mesh, ax=axes)
    bar.set_label(f"{output.label} ({output.unit})" if output.unit else output.label, color=INK)
    bar.outline.set_visible(False)
    axes.set_ylabel(_label(other), color=INK)


def _dress(axes: Axes, grid: bool) -> None:
    if grid:
        axes.grid(True, color=GRID, linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=9)
    axes.ticklabel_format(useOffset=False)
