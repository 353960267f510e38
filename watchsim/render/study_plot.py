"""How are sensitivities drawn?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from watchsim.render.palette import FAINT, GRID, INK
from watchsim.render.style import (
    BAD,
    CURVE,
    FULL,
    GOOD,
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
from watchsim.studies.axes import Axis
from watchsim.studies.point import Output
from watchsim.studies.sensitivity import Effect, Sensitivity
from watchsim.studies.sweep import Sweep
from watchsim.units import to

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


# How is a sweep drawn?
#
# One key: a curve with error bars for each output. Two keys: a family of curves where one of them has few values, else a map.
# Points without a number are marked where they lie, with what happens there.

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


# How are sensitivities drawn?

MOST = 30  # bars in a panel
UP, DOWN = GOOD, BAD
ROW, REST_EFFECTS_PLOT = 4.2, 18.0  # mm, of a bar and of all around the bars
WORDS = 10.0  # mm, beside a bar
LETTERS, LEAST_WIDE = 1.15, 30.0  # mm, of a letter of the names; of a panel at least
LEAST = 1e-4  # of the longest bar: shorter ones are none
TOLD = 1e-4  # of the longest bar: shorter ones have no number beside them


def plot_sensitivity(found: Sensitivity, width: float = FULL) -> Figure:
    """A panel of bars for each output, the quantities in one order for all of them; a figure `width` mm wide to save as
    PNG, SVG or PDF. In a column the panels stand one below the other.

    A bar is the effect of 1 % more, of 10 µm or of 0.1°. What two step sizes disagree about is hatched.
    """
    shown = [effect for effect in found.effects if _matters(found, effect)][:MOST]
    across = len(found.outputs) if width >= NARROW else 1
    rows = -(-len(found.outputs) // across)
    made = figure(width, rows * (ROW * max(len(shown), 2) + REST_EFFECTS_PLOT), layout="constrained")
    panels = made.subplots(rows, across, sharey=True, squeeze=False).flat
    made.suptitle(f"{cut(found.title)}: what matters", x=0.01, ha="left", fontsize=TITLE, weight="bold", color=INK)
    names = [f"{effect.quantity.key}, {_signed(effect)}" for effect in shown]
    # A panel's width is known only when it is laid out; before, all are alike beside the names.
    wide = (width - LETTERS * max(map(len, names), default=0)) / across
    for axes, output in zip(panels, found.outputs, strict=True):
        _bars(axes, shown, output, max(wide, LEAST_WIDE))
    for axes in (panels[0],) if across > 1 else panels:
        axes.set_yticks(range(len(shown)), names, fontsize=SMALL)
    panels[0].invert_yaxis()
    return made


def _signed(effect: Effect) -> str:
    return f"+{effect.quantity.change_words}"


def _matters(found: Sensitivity, effect: Effect) -> bool:
    """Does it move any output by more than a trace?"""
    for one in found.outputs:
        longest = max((_length(other, one) for other in found.effects), default=0.0)
        if longest > 0.0 and _length(effect, one) > LEAST * longest:
            return True
    return False


def _length(effect: Effect, output: Output) -> float:
    return abs(effect.of(output.column, effect.quantity.change) or 0.0)


def _bars(axes: Axes, shown: list[Effect], output: Output, wide: float) -> None:
    from matplotlib.ticker import MaxNLocator

    dress(axes, grid="x")
    values = [effect.of(output.column, effect.quantity.change) or 0.0 for effect in shown]
    hatches = ["" if effect.by[output.column].agrees else "////" for effect in shown]
    bars = axes.barh(range(len(shown)), values, height=0.68, color=[UP if value > 0.0 else DOWN for value in values])
    longest = max((abs(value) for value in values), default=0.0) or 1.0
    for bar, value, hatch in zip(bars, values, hatches, strict=True):
        bar.set_hatch(hatch)
        if abs(value) < TOLD * longest:
            continue
        side = 1.0 if value >= 0.0 else -1.0
        place = (value + 0.02 * side * longest, bar.get_y() + 0.5 * bar.get_height())
        text = f"{value:+.3g}".replace("-", "−")
        axes.text(*place, text, va="center", ha="left" if side > 0 else "right", fontsize=SMALL, color=INK)
    room = longest * wide / max(wide - 2.0 * WORDS, 0.2 * wide)
    axes.set_xlim(-room, room)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 5, 10]))
    axes.axvline(0.0, color=FAINT, linewidth=HAIR)
    axes.set_title(
        f"change of {output.label} ({output.unit})" if output.unit else output.label, fontsize=LABEL, loc="left", color=INK
    )
    axes.spines["left"].set_visible(False)
    axes.tick_params(left=False)
