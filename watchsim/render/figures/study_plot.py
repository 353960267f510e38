"""How is a sweep drawn?

One key: a curve with error bars for each output. Two keys: a family of curves where one of them has few values, else a map.
Points without a number are marked where they lie, with what happens there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from watchsim.render.figures.figure_style import (
    BAD,
    CURVE,
    FULL,
    HAIR,
    LABEL,
    MAP,
    MARKERS,
    NARROW,
    SERIES,
    SMALL,
    TITLE,
    cut,
    dress,
    figure,
)
from watchsim.render.palette import GRID, INK
from watchsim.studies.axes import Axis
from watchsim.studies.outputs import Output
from watchsim.studies.parameter_sweep import Sweep
from watchsim.units import to

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

TALL, REST = 46.0, 9.0  # mm, of a panel, and of the title
FAMILY = len(SERIES)  # curves in one panel at most


def plot_sweep(sweep: Sweep, width: float = FULL) -> Figure:
    """A panel for each output over the first key, or over the one with most values; a figure `width` mm wide to save as PNG,
    SVG or PDF.

    ValueError where nothing can be drawn: more than two keys, or keys without numbers.
    """
    numeric = [axis for axis in sweep.axes if axis.is_numeric]
    if not numeric or len(sweep.axes) > 2:
        raise ValueError("only sweeps over one or two keys with numbers can be drawn")
    made = figure(width, TALL * len(sweep.outputs) + REST, layout="constrained")
    panels = made.subplots(len(sweep.outputs), 1, sharex=True, squeeze=False)[:, 0]
    made.suptitle(cut(sweep.title), x=0.01, ha="left", fontsize=TITLE, weight="bold", color=INK)
    along, other = _roles(sweep, numeric)
    field = other if other is not None and other.is_numeric and len(other.values) > FAMILY else None
    for axes, output in zip(panels, sweep.outputs, strict=True):
        if field is not None:
            _map(made, axes, sweep, along, field, output)
        else:
            _curves(axes, sweep, along, other, output)
        dress(axes, grid="both" if field is None else "none")
        axes.ticklabel_format(useOffset=False)
    panels[-1].set_xlabel(_label(along))
    if other is not None and field is None:
        handles, labels = panels[0].get_legend_handles_labels()
        look: dict[str, Any] = {"frameon": False, "fontsize": SMALL, "title_fontsize": SMALL, "labelcolor": INK}
        where: dict[str, Any] = {"loc": "outside right upper"} if width >= NARROW else {"loc": "outside lower left", "ncols": 3}
        made.legend(handles, labels, title=_label(other), **look, **where)
    return made


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
        colour, mark = SERIES[i % FAMILY], MARKERS[i % FAMILY]
        label = f"{_shown(other, value):.6g}" if other and other.is_numeric else str(value)
        look: dict[str, Any] = {
            "color": colour,
            "marker": mark,
            "markersize": 2.5,
            "linewidth": CURVE,
            "capsize": 1.5,
            "elinewidth": HAIR,
        }
        axes.errorbar(x, y, yerr=bars, label=label, **look)
        _failures(axes, [row for row in rows if row[output.column] is None], along, colour if other else BAD)
    axes.set_ylabel(f"{output.label} ({output.unit})" if output.unit else output.label)


def _failures(axes: Axes, rows: Sequence[Any], along: Axis, colour: str) -> None:
    """Crosses at the lower edge, named once per verdict."""
    from matplotlib.transforms import blended_transform_factory

    edge = blended_transform_factory(axes.transData, axes.transAxes)
    told: set[str] = set()
    for row in rows:
        x, verdict = _shown(along, row[along.key]), row["verdict"] or "no result"
        axes.plot([x], [0.04], marker="x", color=colour, markersize=3.5, transform=edge, clip_on=False, linestyle="none")
        if verdict not in told:
            style: dict[str, Any] = {"color": BAD, "fontsize": SMALL, "ha": "center", "va": "bottom"}
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
        axes.set_title(f"grey: {', '.join(reasons)}", loc="right", fontsize=SMALL, color=INK)
    bar = figure.colorbar(mesh, ax=axes)
    bar.set_label(f"{output.label} ({output.unit})" if output.unit else output.label, color=INK, fontsize=LABEL)
    bar.ax.tick_params(labelsize=SMALL, colors=INK, length=2.0, width=HAIR)
    bar.outline.set_visible(False)
    axes.set_ylabel(_label(other))
