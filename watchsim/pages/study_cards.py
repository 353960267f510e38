"""What do limit cycles, sweeps and sensitivities show of themselves in a notebook?"""

from __future__ import annotations

from typing import Any

from watchsim.pages.card import card, image
from watchsim.pages.html import element, table
from watchsim.pages.timing_sheet.timekeeping import with_error
from watchsim.studies.axes import Axis
from watchsim.studies.limit_cycle.cycle import Cycle
from watchsim.studies.outputs import Output
from watchsim.studies.parameter_sweep import Sweep
from watchsim.studies.sensitivity import Sensitivity
from watchsim.units import to

ROWS = 12  # of a table; the rest is counted
DOTS, SHOWN = 560, 420  # of a picture, and how wide it is shown
PRINTED = 85.0  # mm, for which the letters are large enough


def cycle_html(cycle: Cycle) -> str:
    """Verdict, amplitude, rate, beat error and stability."""
    values = (
        ("amplitude", cycle.amplitude_deg, cycle.amplitude_deg_error, "°"),
        ("rate", cycle.rate_s_per_d, cycle.rate_s_per_d_error, " s/d"),
        ("beat error", cycle.beat_error_ms, cycle.beat_error_ms_error, " ms"),
    )
    told = [(name, *with_error(value, error, unit)) for name, value, error, unit in values if value is not None]
    lines = [" ".join(filter(None, parts)) for parts in told]
    if cycle.multipliers:
        lines.append(f"multiplier {', '.join(f'{value:.4g}' for value in cycle.multipliers)}")
    return card("Limit cycle" if cycle.found else f"No limit cycle: {cycle.verdict}", [*lines, cycle.message])


def sweep_html(sweep: Sweep) -> str:
    """The first rows as a table, and the plot."""
    from watchsim.render.figures.shown_figure import small_png
    from watchsim.render.figures.study_plot import plot_sweep

    count = len(sweep.rows)
    lines = [f"{count} {'point' if count == 1 else 'points'}", "" if sweep.whole else "interrupted: points are missing"]
    if not count:
        return card(f"Sweep of {sweep.title}", lines)
    head = [*map(_name, sweep.axes), *map(_heading, sweep.outputs), "verdict"]
    rows = [
        [
            *(_value(axis, row) for axis in sweep.axes),
            *(_number(row[one.column]) for one in sweep.outputs),
            row["verdict"] or "",
        ]
        for row in sweep.rows[:ROWS]
    ]
    shown = table(head, rows, f"the first {ROWS} of {count} points" if count > ROWS else "")
    try:
        figure = plot_sweep(sweep, PRINTED)
    except ValueError:  # keys without numbers
        return card(f"Sweep of {sweep.title}", lines, shown)
    return card(
        f"Sweep of {sweep.title}", lines, shown, element("div", image(small_png(figure, DOTS), "The sweep as curves", SHOWN))
    )


def sensitivity_html(found: Sensitivity) -> str:
    """What matters most, and the plot."""
    from watchsim.render.figures.effects_plot import plot_sensitivity
    from watchsim.render.figures.shown_figure import small_png

    count, outputs = len(found.effects), found.outputs
    lines = [f"{count} {'quantity' if count == 1 else 'quantities'}", "" if found.whole else "interrupted: some are missing"]
    if not count:
        return card(f"What matters in {found.title}", lines)
    head = ["change", *map(_heading, found.outputs)]
    rows = [
        [f"{one.quantity.key} +{one.quantity.change_words}", *(_number(one.of(o.column, one.quantity.change)) for o in outputs)]
        for one in found.effects[:ROWS]
    ]
    shown = table(head, rows, f"the first {ROWS} of {count} quantities" if count > ROWS else "")
    bars = small_png(plot_sensitivity(found, PRINTED), DOTS)
    return card(f"What matters in {found.title}", lines, shown, element("div", image(bars, "Effects as bars", SHOWN)))


def _heading(output: Output) -> str:
    return f"{output.label} ({output.unit})" if output.unit else output.label


def _name(axis: Axis) -> str:
    return f"{axis.key} ({axis.usual})" if axis.usual else axis.key


def _value(axis: Axis, row: Any) -> str:
    value = row[axis.key]
    if isinstance(value, str):
        return value
    return f"{to(value, axis.usual) if axis.usual else value:.6g}".replace("-", "−")


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.5g}".replace("-", "−")
