"""How are studies drawn: sweeps, sensitivities, speed against error?

A sweep over one key: a curve with error bars for each output. Over two: a family of curves where one key has few values, else a
map. Points without a number are marked where they lie, with what happens there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import blended_transform_factory

from watchsim.render import style
from watchsim.render.palette import FAINT, GRID, INK
from watchsim.render.style import SERIES
from watchsim.scene.keys import in_words
from watchsim.studies.axes import Axis
from watchsim.studies.fit import Fit
from watchsim.studies.goals import Better
from watchsim.studies.point import Output
from watchsim.studies.sensitivity import Effect, Sensitivity
from watchsim.studies.sweep import Sweep
from watchsim.units import to

TALL, REST = 46.0, 9.0  # mm, of a panel, and of the title
FAMILY = len(SERIES)  # curves in one panel at most


def plot_sweep(sweep: Sweep, width: float = style.FULL, ax: Axes | None = None) -> Figure:
    """A panel for each output over the first key, or over the one with most values; a figure `width` mm wide to save as PNG,
    SVG or PDF.

    ValueError where nothing can be drawn: more than two keys, or keys without numbers.
    """
    sweep = _weak_to_strong(sweep)
    numeric = [axis for axis in sweep.axes if axis.is_numeric]
    if not numeric or len(sweep.axes) > 2:
        raise ValueError("only sweeps over one or two keys with numbers can be drawn")
    made = style.figure(width, TALL * len(sweep.outputs) + REST, layout="constrained", ax=ax)
    panels = made.subplots(len(sweep.outputs), 1, sharex=True, squeeze=False)[:, 0]
    made.suptitle(style.cut(sweep.title), x=0.01, ha="left", fontsize=style.TITLE, weight="bold", color=INK)
    # The abscissa belongs to numbers, and to the longer list.
    along = max(numeric, key=lambda axis: len(axis.values))
    other = next((axis for axis in sweep.axes if axis is not along), None)
    field = other if other is not None and other.is_numeric and len(other.values) > FAMILY else None
    for axes, output in zip(panels, sweep.outputs, strict=True):
        if field is not None:
            _map(made, axes, sweep, along, field, output)
        else:
            _curves(axes, sweep, along, other, output)
        style.dress(axes, grid="both" if field is None else "none")
        axes.ticklabel_format(useOffset=False)
    panels[-1].set_xlabel(axis_label(along))
    if other is not None and field is None:
        look: dict[str, Any] = {"frameon": False, "fontsize": style.SMALL, "title_fontsize": style.SMALL, "labelcolor": INK}
        look |= {"loc": "outside right upper"} if width >= style.NARROW else {"loc": "outside lower left", "ncols": 3}
        made.legend(*panels[0].get_legend_handles_labels(), title=axis_label(other), **look)
    return made


def plot_front(better: Better, width: float = style.FULL, ax: Axes | None = None) -> Figure:
    """The front of two goals: designs of which none is better in both, the one that was chosen, and the scene as it was.

    ValueError where there is no front, or one of more than two goals.
    """
    if len(better.goals) != 2 or not better.front:
        raise ValueError("only a front of two goals can be drawn")
    first, second = (one.output for one in better.goals)
    made = style.figure(width, 2.0 * TALL + REST, layout="constrained", ax=ax)
    axes = made.subplots()
    made.suptitle(style.cut(better.title), x=0.01, ha="left", fontsize=style.TITLE, weight="bold", color=INK)
    x, y = (np.array([_of_front(better, one, design) for design in better.front]) for one in (first, second))
    axes.plot(x, y, color=SERIES[0], marker="o", markersize=3.5, linewidth=style.CURVE, label="front")
    for k, label, colour, mark in ((0, "as it was", FAINT, "s"), (1, "chosen", style.BAD, "D")):
        x_at, y_at = (_either(better, one, k) for one in (first, second))
        if x_at is not None and y_at is not None:
            axes.plot([x_at], [y_at], color=colour, marker=mark, markersize=5.0, linestyle="none", label=label)
    axes.set_xlabel(f"{output_label(first)}, {better.goals[0].way}")
    axes.set_ylabel(f"{output_label(second)}, {better.goals[1].way}")
    style.dress(axes, grid="both")
    axes.ticklabel_format(useOffset=False)
    axes.legend(frameon=False, fontsize=style.SMALL, labelcolor=INK)
    return made


def _of_front(better: Better, output: Output, design: Mapping[str, float]) -> float:
    """In the unit of the output, which is a result or a number that was varied."""
    knob = next((one for one in better.knobs if one.key == output.name), None)
    return design[output.column] if knob is None else to(design[knob.key], knob.unit)


def _either(better: Better, output: Output, k: int) -> float | None:
    """As it was (0), or as it is now (1)."""
    knob = next((one for one in better.knobs if one.key == output.name), None)
    return better.values[output.column][k] if knob is None else to(better.keys[knob.key][k], knob.unit)


def plot_fit(found: Fit, width: float = style.FULL, ax: Axes | None = None) -> Figure:
    """What was measured and what the fitted scene gives, and below it the difference, for each kind of reading."""
    measured = found.measured
    made = style.figure(width, 1.3 * TALL * len(measured.columns) + REST, layout="constrained", ax=ax)
    panels = made.subplots(2 * len(measured.columns), 1, sharex=True, height_ratios=[2, 1] * len(measured.columns))
    about = f"{found.title}, fitted to {measured.name}"
    made.suptitle(style.cut(about), x=0.01, ha="left", fontsize=style.TITLE, weight="bold", color=INK)
    for k, (kind, values) in enumerate(measured.columns.items()):
        over = np.arange(1, len(values) + 1) if measured.times is None else measured.times
        upper, lower = panels[2 * k : 2 * k + 2]
        label, unit = READINGS[kind]
        look: dict[str, Any] = (
            {"linewidth": style.CURVE} if measured.times is not None else {"marker": "s", "linestyle": "none"}
        )
        upper.plot(over, found.modelled[kind], color=SERIES[1], markersize=4.0, label="scene", **look)
        upper.plot(over, values, "o", color=SERIES[0], markersize=2.5, label="measured")
        lower.plot(over, values - found.modelled[kind], "o", color=SERIES[0], markersize=2.5)
        lower.axhline(0.0, color=SERIES[1], linewidth=style.HAIR)
        upper.set_ylabel(f"{label} ({unit})")
        lower.set_ylabel(f"left over ({unit})")
        for axes in (upper, lower):
            style.dress(axes, grid="both")
            axes.ticklabel_format(useOffset=False)
    panels[0].legend(frameon=False, fontsize=style.SMALL, labelcolor=INK, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2)
    panels[-1].set_xlabel("reading" if measured.times is None else "time (s)")
    return made


READINGS = {
    "angle_deg": ("angle", "°"),
    "amplitude_deg": ("amplitude", "°"),
    "rate_s_per_d": ("rate", "s/d"),
    "beat_error_ms": ("beat error", "ms"),
}


def output_label(output: Output) -> str:
    return f"{output.label} ({output.unit})" if output.unit else output.label


def axis_label(axis: Axis) -> str:
    return f"{in_words(axis.key)} ({axis.usual})" if axis.usual else in_words(axis.key)


def usual_value(axis: Axis, value: Any) -> Any:
    """A value of a key in the unit in which people read it."""
    return to(value, axis.usual) if axis.usual and not isinstance(value, str) else value


def _weak_to_strong(sweep: Sweep) -> Sweep:
    """A drive that turns clockwise is negative in the scene; its curves run over the magnitude."""
    for axis in sweep.axes:
        values = [abs(value) for value in axis.values if not isinstance(value, str) and value <= 0.0]
        if axis.key.startswith("torques.") and axis.key.endswith(".value") and len(values) == len(axis.values):
            key = f"{axis.key}.magnitude"
            axes = tuple(replace(one, key=key, values=tuple(values)) if one is axis else one for one in sweep.axes)
            sweep = replace(sweep, axes=axes, rows=tuple({**row, key: abs(row[axis.key])} for row in sweep.rows))
    return sweep


def _curves(axes: Axes, sweep: Sweep, along: Axis, other: Axis | None, output: Output) -> None:
    for i, value in enumerate(other.values if other else (None,)):
        rows = [row for row in sweep.rows if other is None or row[other.key] == value]
        rows.sort(key=lambda row: row[along.key])
        good = [row for row in rows if row[output.column] is not None]
        x = np.array([usual_value(along, row[along.key]) for row in good], float)
        y = np.array([row[output.column] for row in good], float)
        bars = np.array([row.get(f"{output.column}_error") or 0.0 for row in good], float)
        colour, mark = SERIES[i % FAMILY], style.MARKERS[i % FAMILY]
        label = f"{usual_value(other, value):.6g}" if other and other.is_numeric else str(value)
        look: dict[str, Any] = {"color": colour, "marker": mark, "markersize": 2.5, "linewidth": style.CURVE}
        axes.errorbar(x, y, yerr=bars, label=label, capsize=1.5, elinewidth=style.HAIR, **look)
        _failures(axes, [row for row in rows if row[output.column] is None], along, colour if other else style.BAD)
    axes.set_ylabel(output_label(output))


def _failures(axes: Axes, rows: Sequence[Any], along: Axis, colour: str) -> None:
    """Crosses at the lower edge, named once per verdict."""
    edge = blended_transform_factory(axes.transData, axes.transAxes)
    named: set[str] = set()
    for row in rows:
        x, verdict = usual_value(along, row[along.key]), row["verdict"] or "no result"
        axes.plot([x], [0.04], marker="x", color=colour, markersize=3.5, transform=edge, clip_on=False, linestyle="none")
        if verdict not in named:
            style.words(axes, x, 0.09, verdict, transform=edge, color=style.BAD, ha="center", va="bottom")
            named.add(verdict)


def _map(figure: Figure, axes: Axes, sweep: Sweep, along: Axis, other: Axis, output: Output) -> None:
    x, y = sorted({usual_value(along, v) for v in along.values}), sorted({usual_value(other, v) for v in other.values})
    field = np.full((len(y), len(x)), np.nan)
    for row in sweep.rows:
        if row[output.column] is not None:
            field[y.index(usual_value(other, row[other.key])), x.index(usual_value(along, row[along.key]))] = row[output.column]
    mesh = axes.pcolormesh(x, y, np.ma.masked_invalid(field), cmap=style.MAP, shading="nearest")
    axes.set_facecolor(GRID)  # where there is no number
    if reasons := sorted({row["verdict"] or "no result" for row in sweep.rows if row[output.column] is None}):
        axes.set_title(f"grey: {', '.join(reasons)}", loc="right", fontsize=style.SMALL, color=INK)
    bar = figure.colorbar(mesh, ax=axes)
    bar.set_label(output_label(output), color=INK, fontsize=style.LABEL)
    bar.ax.tick_params(labelsize=style.SMALL, colors=INK, length=2.0, width=style.HAIR)
    bar.outline.set_visible(False)
    axes.set_ylabel(axis_label(other))


MOST_BARS = 30  # bars in a panel
BAR, AROUND_BARS = 4.2, 18.0  # mm, of a bar and of all around the bars
WORDS = 10.0  # mm, beside a bar
LETTERS, LEAST_WIDE = 1.15, 30.0  # mm, of a letter of the names; of a panel at least
LEAST = 1e-4  # of the longest bar: shorter ones are none
NUMBERED = 1e-4  # of the longest bar: shorter ones have no number beside them


def plot_sensitivity(found: Sensitivity, width: float = style.FULL, ax: Axes | None = None) -> Figure:
    """A panel of bars for each output, the quantities in one order for all of them; a figure `width` mm wide to save as
    PNG, SVG or PDF. In a column the panels stand one below the other.

    A bar is the effect of 1 % more, of 10 µm or of 0.1°. What two step sizes disagree about is hatched.
    """
    shown = [effect for effect in found.effects if _matters(found, effect)][:MOST_BARS]
    across = len(found.outputs) if width >= style.NARROW else 1
    rows = -(-len(found.outputs) // across)
    made = style.figure(width, rows * (BAR * max(len(shown), 2) + AROUND_BARS), layout="constrained", ax=ax)
    panels = made.subplots(rows, across, sharey=True, squeeze=False).flat
    made.suptitle(f"{style.cut(found.title)}: what matters", x=0.01, ha="left", fontsize=style.TITLE, weight="bold", color=INK)
    said = [in_words(effect.quantity.key) for effect in shown]
    # A dimension of the design and a quantity of a body may have the same words.
    said = [
        f"design {words}" if said.count(words) > 1 and effect.quantity.key.startswith("design.") else words
        for words, effect in zip(said, shown, strict=True)
    ]
    names = [f"{words}, +{effect.quantity.change_words}" for words, effect in zip(said, shown, strict=True)]
    # A panel's width is known only when it is laid out; before, all are alike beside the names.
    wide = (width - LETTERS * max(map(len, names), default=0)) / across
    for axes, output in zip(panels, found.outputs, strict=True):
        _bars(axes, shown, output, max(wide, LEAST_WIDE))
    for axes in (panels[0],) if across > 1 else panels:
        axes.set_yticks(range(len(shown)), names, fontsize=style.SMALL)
    panels[0].invert_yaxis()
    return made


def _matters(found: Sensitivity, effect: Effect) -> bool:
    """Does it move any output by more than a trace?"""

    def length(one: Effect, output: Output) -> float:
        return abs(one.of(output.column, one.quantity.change) or 0.0)

    return any(length(effect, one) > LEAST * max(length(other, one) for other in found.effects) for one in found.outputs)


def _bars(axes: Axes, shown: list[Effect], output: Output, wide: float) -> None:
    style.dress(axes, grid="x")
    values = [effect.of(output.column, effect.quantity.change) or 0.0 for effect in shown]
    hatches = ["" if effect.by[output.column].agrees else "////" for effect in shown]
    colours = [style.GOOD if value > 0.0 else style.BAD for value in values]
    bars = axes.barh(range(len(shown)), values, height=0.68, color=colours)
    longest = max((abs(value) for value in values), default=0.0) or 1.0
    for bar, value, hatch in zip(bars, values, hatches, strict=True):
        bar.set_hatch(hatch)
        if abs(value) < NUMBERED * longest:
            continue
        side = 1.0 if value >= 0.0 else -1.0
        place = (value + 0.02 * side * longest, bar.get_y() + 0.5 * bar.get_height())
        text, beside = style.minus(f"{value:+.3g}"), "left" if side > 0 else "right"
        style.words(axes, *place, text, transform=axes.transData, va="center", ha=beside)
    room = longest * wide / max(wide - 2.0 * WORDS, 0.2 * wide)
    axes.set_xlim(-room, room)
    style.ticks(axes.xaxis, 4)
    axes.axvline(0.0, color=FAINT, linewidth=style.HAIR)
    title = f"change of {output_label(output)}" if output.unit else output.label
    axes.set_title(title, fontsize=style.LABEL, loc="left", color=INK)
    axes.spines["left"].set_visible(False)
    axes.tick_params(left=False)


ENGINES = {  # name in print, colour and mark
    "pfeiffer-glocker": ("watchsim, by events", SERIES[0], "o"),
    "moreau": ("watchsim, Moreau's time stepping", SERIES[5], "s"),
    "pymunk": ("pymunk", SERIES[1], "^"),
    "box2d": ("Box2D", SERIES[3], "v"),
    "mujoco": ("MuJoCo", SERIES[2], "D"),
}
SPEED_ACROSS, SPEED_TALL = 3, 62.0  # panels beside each other; mm, of a row of them
EXACT = 1e-14  # what comes out exactly is drawn here


def plot_speed(rows: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Processor time per simulated second over error, both logarithmic, a panel for each scene; the file's ending decides."""
    methods: dict[str, set[str]] = {}
    for row in rows:
        methods.setdefault(row["scene"], set()).add(row["method"])
    scenes = [name for name, engines in methods.items() if len(engines) > 1]
    across, down = min(SPEED_ACROSS, len(scenes)), -(-len(scenes) // SPEED_ACROSS)
    made = style.figure(style.FULL, SPEED_TALL * down, layout="constrained")
    panels = made.subplots(down, across, squeeze=False).ravel()
    for axes, scene in zip(panels, scenes, strict=False):
        _speeds(axes, scene, [row for row in rows if row["scene"] == scene])
    for empty in panels[len(scenes) :]:
        empty.set_axis_off()
    for first in panels[::across]:
        first.set_ylabel("time per simulated second (s)")
    shown = {label: line for axes in panels for line, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    made.legend(shown.values(), shown, loc="outside lower center", ncols=len(shown), frameon=False, fontsize=style.SMALL)
    style.save(made, path)


def _speeds(axes: Axes, scene: str, rows: Sequence[Mapping[str, Any]]) -> None:
    axis = {"error_state": "error of the place after 3 s (m)", "error_amplitude_deg": "error of the amplitude (°)"}
    name = next(name for name in axis if any(row[name] is not None for row in rows))
    for method in dict.fromkeys(row["method"] for row in rows):
        points = [row for row in rows if row["method"] == method and row[name] is not None and not row["note"]]
        x = [max(row[name], EXACT) for row in points]
        y = [row["wall_s_per_simulated_s"] for row in points]
        spread = [[t - row["wall_least"] for t, row in zip(y, points, strict=True)]]
        spread.append([row["wall_largest"] - t for t, row in zip(y, points, strict=True)])
        if points:
            look: dict[str, Any] = dict(zip(("label", "color", "marker"), ENGINES[method], strict=True))
            axes.errorbar(x, y, yerr=spread, linewidth=style.CURVE, elinewidth=style.HAIR, markersize=3.5, **look)
    axes.set_xscale("log")
    axes.set_yscale("log")
    style.title(axes, scene)
    axes.set_xlabel(axis[name])
    style.dress(axes)
