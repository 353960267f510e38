"""How is a study of tolerances drawn: spread against limits, contributions, what matters most, and where watches fail?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from watchsim.render import style
from watchsim.render.palette import FAINT, INK
from watchsim.render.study_plot import output_label
from watchsim.scene.keys import in_words
from watchsim.scene.roles import timekeeper
from watchsim.scene.scene import Scene
from watchsim.studies.point import OUTPUTS, Output
from watchsim.studies.sampling import deviation
from watchsim.studies.study_report import WHETHER
from watchsim.studies.tolerance_result import Contribution, Samples, ToleranceStudy, apart
from watchsim.units import known_unit

LEFT_OUT = ("period_s", "multiplier")  # the rate says it, or nobody asks
MOST_OUTPUTS, MOST_BARS = 6, 8
TALL, BARS_TALL, SCATTER_TALL, TITLE_TALL = 42.0, 50.0, 58.0, 12.0  # mm, of the rows of panels
BINS = 40
LEAST = 0.01  # of the variance: less has no bar
MANY = 2000  # dots: as a picture, in files of vectors as well, which would be large and slow to open
PALE = "#9fb4c4"  # good watches where failing ones matter: seen on white, and behind their colours


def plot_tolerance(study: ToleranceStudy, width: float = style.FULL, ax: Axes | None = None) -> Figure:
    """Histograms with their limits; below each what contributes; then the output with most at stake over the two dimensions
    that matter most, and the map of failures over the two that decide these. A figure `width` mm wide."""
    columns = [name for name in study.outputs if name not in LEFT_OUT]
    limited = {one.column for one in study.plan.limits}
    columns.sort(key=lambda name: (name not in limited, name not in study.contributions))
    outputs = [next(one for one in OUTPUTS.values() if one.column == name) for name in columns[:MOST_OUTPUTS]]
    names = {**{one.column: one.label for one in outputs}, **WHETHER}
    with_bars = [(name, label) for name, label in names.items() if name in study.contributions]
    across = 3 if width >= style.NARROW else 1
    heights = [TALL] * -(-len(outputs) // across) + [BARS_TALL] * -(-len(with_bars) // across) + [SCATTER_TALL]
    made = style.figure(width, TITLE_TALL + sum(heights), layout="constrained", ax=ax)
    made.suptitle(style.cut(study.title), x=0.01, ha="left", fontsize=style.TITLE, weight="bold", color=INK)
    ratios = [sum(one for one in heights if one == tall) for tall in (TALL, BARS_TALL, SCATTER_TALL)]
    parts: Any = made.subfigures(3, 1, height_ratios=ratios)
    samples = samples_of(study)
    for axes, one in _panels(parts[0], outputs, across):
        _histogram(axes, study, samples, one)
    _key(parts[0], samples)
    for axes, (name, label) in _panels(parts[1], with_bars, across):
        _bars(axes, label, study.contributions[name], study.explained.get(name, 1.0))
    pair = parts[2].subplots(1, 2)
    _scatter(pair[0], study, samples, outputs)
    _map(pair[1], study, samples)
    return made


def samples_of(study: ToleranceStudy) -> Samples:
    """The samples of a study in columns."""
    numbers = np.array(study.numbers_of, dtype=np.int64)
    return Samples(study.plan, tuple(study.rows[int(number)] for number in numbers), numbers)


def _panels(figure: Any, items: Sequence[Any], across: int) -> list[tuple[Axes, Any]]:
    panels: list[Axes] = list(figure.subplots(max(1, -(-len(items) // across)), across, squeeze=False).flat)
    for empty in panels[len(items) :]:
        empty.set_axis_off()
    return list(zip(panels, items, strict=False))


def _histogram(axes: Axes, study: ToleranceStudy, samples: Samples, output: Output) -> None:
    values = samples.column(output.column)
    there = np.isfinite(values)
    good = samples.good[there]
    values = values[there]
    edges = np.histogram_bin_edges(values, bins=min(BINS, max(8, int(np.sqrt(len(values))))))
    axes.hist([values[good], values[~good]], bins=edges.tolist(), stacked=True, color=[style.GOOD, style.BAD], linewidth=0.0)
    for limit in (one for one in study.plan.limits if one.column == output.column):
        for end in limit.expectation.bounds:
            if np.isfinite(end):
                axes.axvline(end / limit.factor, color=INK, linewidth=style.CURVE)
    one = study.outputs[output.column]
    if one.linear_sigma and one.nominal is not None and output.column != "beat_error_ms":
        x = np.linspace(edges[0], edges[-1], 120)
        bell = np.exp(-0.5 * ((x - one.nominal) / one.linear_sigma) ** 2) / (one.linear_sigma * np.sqrt(2.0 * np.pi))
        axes.plot(x, bell * len(values) * (edges[1] - edges[0]), color=FAINT, linewidth=style.THIN, linestyle="--")
    cpk = "" if one.cpk is None else f", Cpk {one.cpk:.2f}"
    axes.set_title(style.minus(f"mean {one.mean:.4g}, σ {one.sigma:.2g}{cpk}"), loc="right", fontsize=style.SMALL, color=FAINT)
    axes.set_xlabel(output_label(output))
    axes.set_yticks([])
    style.dress(axes, grid="none")
    style.ticks(axes.xaxis, 4)


def _key(figure: Any, samples: Samples) -> None:
    """What the colours of the histograms mean, and their lines, above them."""
    there = [(style.GOOD, "good", samples.good.any()), (style.BAD, "failing", not samples.good.all())]
    marks: list[tuple[Any, str]] = [(Patch(color=colour), words) for colour, words, any_of_them in there if any_of_them]
    if samples.plan.limits:
        marks.append((Line2D([], [], color=INK, linewidth=style.CURVE), "limit"))
    marks.append((Line2D([], [], color=FAINT, linewidth=style.THIN, linestyle="--"), "linear prediction"))
    look: dict[str, Any] = {"frameon": False, "fontsize": style.SMALL, "labelcolor": INK, "ncols": len(marks)}
    figure.legend(*zip(*marks, strict=True), loc="outside upper left", **look)


def _bars(axes: Axes, label: str, each: tuple[Contribution, ...], explained: float) -> None:
    """First-order and, paler, total indices; rank correlations with their signs where there are none."""
    ranks = each[0].total is None
    shown = [one for one in each if ranks or (one.total or 0.0) >= LEAST][:MOST_BARS]
    names = [in_words(one.key) for one in shown]
    totals = np.array([one.rank if ranks else one.total for one in shown], float)
    firsts = np.array([0.0 if one.first is None else one.first for one in shown])
    places = np.arange(len(shown))
    axes.barh(places, totals, height=0.7, color=style.SERIES[5])
    axes.barh(places, firsts, height=0.4, color=style.GOOD)
    axes.set_yticks(places, names, fontsize=style.SMALL)
    axes.set_ylim(max(len(shown), 3) - 0.4, -0.6)
    axes.set_xlim(-1.0 if ranks else 0.0, 1.0)
    if ranks:
        axes.axvline(0.0, color=FAINT, linewidth=style.HAIR)
    style.title(axes, label)
    known = "rank correlation" if ranks else f"share; {100.0 * explained:.3g} % explained"
    axes.set_xlabel(known, fontsize=style.SMALL)
    style.ticks(axes.xaxis, 4)
    style.dress(axes, grid="x")


def _scatter(axes: Axes, study: ToleranceStudy, samples: Samples, outputs: list[Output]) -> None:
    """The first output over the dimension that contributes most to it, coloured by the second."""
    one = next((output for output in outputs if output.column in study.contributions), None)
    if one is None:
        axes.set_axis_off()
        return
    names = [each.key for each in study.contributions[one.column]]
    x, label = _values(study, samples, names[0])
    y = samples.column(one.column)
    if len(names) > 1:
        colour, words = _values(study, samples, names[1])
        dots = axes.scatter(x, y, c=colour, s=4.0, cmap=style.MAP, linewidths=0.0, rasterized=len(x) > MANY)
        bar = axes.figure.colorbar(dots, ax=axes)
        bar.set_label(words, fontsize=style.SMALL, color=INK)
        bar.ax.tick_params(labelsize=style.SMALL, colors=INK, length=2.0, width=style.HAIR)
        bar.outline.set_visible(False)
    for limit in (each for each in study.plan.limits if each.column == one.column):
        for end in limit.expectation.bounds:
            if np.isfinite(end):
                axes.axhline(end / limit.factor, color=INK, linewidth=style.CURVE)
    axes.set_xlabel(label)
    axes.set_ylabel(output_label(one))
    style.ticks(axes.xaxis, 5)
    style.dress(axes)


def _map(axes: Axes, study: ToleranceStudy, samples: Samples) -> None:
    """Good and failing watches over the two dimensions in which those of the most frequent failure differ most."""
    if not study.failures or len(study.plan.space.draws) < 2:
        axes.set_axis_off()
        return
    away = np.abs(apart(samples, next(iter(study.failures)))[0])
    decides = dict.fromkeys(study.plan.space.draws[j].name for j in np.argsort(-away, kind="stable"))
    (x, across), (y, up) = (_values(study, samples, name) for name in list(decides)[:2])
    many = len(x) > MANY
    axes.scatter(x[samples.good], y[samples.good], s=4.0, color=PALE, linewidths=0.0, label="good", rasterized=many)
    for i, words in enumerate(study.failures):
        mine = np.array([wrong == words for wrong in samples.wrong])
        mark, colour = style.MARKERS[i % len(style.MARKERS)], style.SERIES[(i + 1) % len(style.SERIES)]
        axes.scatter(x[mine], y[mine], s=6.0, marker=mark, color=colour, linewidths=0.0, label=words, rasterized=many)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    style.ticks(axes.xaxis, 5)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False, fontsize=style.SMALL)
    style.dress(axes)


def _values(study: ToleranceStudy, samples: Samples, name: str) -> tuple[np.ndarray, str]:
    """What the samples were made to, in the unit people read, and words for an axis; of teeth the mean of their magnitudes."""
    space = study.plan.space
    places = [j for j, draw in enumerate(space.draws) if draw.name == name]
    one = space.tolerances[space.draws[places[0]].members[0]]
    factor = known_unit(one.unit).factor
    unit = f" ({one.unit})" if one.unit else ""
    if len(places) > 1:
        return np.abs(samples.deviations[:, places]).mean(axis=1) / factor, f"{in_words(name)}, mean error{unit}"
    big = one.dimension.usual[1] if one.unit == "µm" and abs(one.nominal) > 1e-4 else one.unit
    unit = f" ({big})" if big else ""
    return (one.nominal + samples.deviations[:, places[0]]) / known_unit(big).factor, f"{in_words(name)}{unit}"


ROW, AROUND = 7.5, 16.0  # mm, of a tolerance, and of the title
NODES, DENSITY_BINS = 4000, 26  # bins of a tenth of half the width: limits are edges of them


def plot_limits(scene: Scene, width: float = style.FULL) -> Figure:
    """The tolerances of a scene: a line each, with the frequency of its deviations between its limits."""
    count = len(scene.tolerances)
    made = style.figure(width, AROUND + ROW * count)
    style.heading(made, style.cut(scene.title), f"what its {timekeeper(scene, many=True)} are made to")
    axes = made.add_axes((0.36, 6.0 / (AROUND + ROW * count), 0.2, ROW * count / (AROUND + ROW * count)))
    for row, one in enumerate(scene.tolerances):
        u = (np.arange(NODES) + 0.5) / NODES
        x = deviation(one, u)
        middle, half = 0.5 * (one.low + one.high), 0.5 * (one.high - one.low)
        counts, edges = np.histogram((x - middle) / half, bins=DENSITY_BINS, range=(-1.3, 1.3))
        axes.bar(edges[:-1], -0.75 * counts / counts.max(), 0.1, row + 0.4, align="edge", color=style.GOOD, linewidth=0.0)
        for end in (-1.0, 1.0):
            axes.plot([end, end], [row - 0.4, row + 0.4], color=INK, linewidth=style.CURVE)
        words = {"fontsize": style.SMALL, "color": INK, "va": "center"}
        axes.text(-1.45, row, f"{in_words(one.key)}   {one.shown(one.nominal)}", ha="right", **words)  # type: ignore[arg-type]
        axes.text(1.45, row, one.words, ha="left", **words)  # type: ignore[arg-type]
    axes.set_ylim(count - 0.5, -0.5)
    axes.set_xlim(-1.35, 1.35)
    axes.set_axis_off()
    return made
