"""How do rate and amplitude depend on which way is up? Drawn on dials, over the hour that is up."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from watchsim.render import style
from watchsim.render.palette import FAINT, GRID, INK
from watchsim.render.style import SERIES
from watchsim.studies.positions import Positions
from watchsim.studies.study_report import winding

TALL = 92.0  # mm
HOURS = range(1, 13)
LINES = ("-", "--", "-.")  # of the windings
ROOM = 0.15  # of the span of the values, within and without
PANELS = (("rate_s_per_d", "rate (s/d)"), ("amplitude_deg", "amplitude (°)"))


def plot_positions(found: Positions, width: float = style.FULL, ax: Axes | None = None) -> Figure:
    """A dial for the rate and one for the amplitude: for each temperature and winding a curve through the hours that are up
    (linear between them), and a dotted circle where the watch lies."""
    made = style.figure(width, TALL, layout="constrained", ax=ax)
    made.suptitle(style.cut(found.title), x=0.01, ha="left", fontsize=style.TITLE, weight="bold", color=INK)
    for axes, (column, label) in zip(made.subplots(1, 2, subplot_kw={"projection": "polar"}), PANELS, strict=True):
        _dial(axes, found, column, label)
    handles = made.axes[0].get_legend_handles_labels()
    made.legend(*handles, loc="outside lower center", ncols=3, frameon=False, fontsize=style.SMALL, labelcolor=INK)
    return made


def _dial(axes: Any, found: Positions, column: str, label: str) -> None:
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    around = np.linspace(0.0, math.tau, 361)
    warmths, windings = (sorted({state[k] for state in found.states}) for k in (0, 1))
    for state in found.states:
        colour, line = (SERIES[warmths.index(state[0]) % len(SERIES)], LINES[windings.index(state[1]) % len(LINES)])
        look: dict[str, Any] = {"color": colour, "linewidth": style.CURVE}
        rows = [row for row in found.at(state).values() if row[column] is not None]
        upright = sorted((_hour(row["position"]), row[column]) for row in rows if row["up_deg"] is not None)
        if upright:
            angles, values = np.array(upright).T
            axes.plot(around, np.interp(around, angles, values, period=math.tau), linestyle=line, **look)
            axes.plot(angles, values, marker="o", markersize=3.0, linestyle="none", **look)
            axes.plot([], [], marker="o", markersize=3.0, linestyle=line, label=f"{state[0]:g} °C, {winding(state)}", **look)
        for lying in {row[column] for row in rows if row["up_deg"] is None}:
            axes.plot(around, np.full(around.shape, lying), linestyle=":", **look)
    values = [row[column] for row in found.rows if row[column] is not None]
    low, high = min(values), max(values)
    room = ROOM * (high - low) or 0.05 * abs(high) or 1.0
    axes.set_rlim(low - 2.0 * room, high + room)
    style.ticks(axes.yaxis, 4)
    axes.set_xticks([hour * math.tau / 12.0 for hour in HOURS], [str(hour) for hour in HOURS])
    axes.set_rlabel_position(45.0)
    axes.tick_params(labelsize=style.TICK, colors=INK, pad=1.0)
    axes.grid(color=GRID, linewidth=style.HAIR)
    axes.spines["polar"].set(color=FAINT, linewidth=style.HAIR)
    axes.set_title(f"{label}, dotted: lying", fontsize=style.LABEL, color=INK)


def _hour(position: str) -> float:
    """The angle (rad) of an hour on the dial, clockwise from 12."""
    hours, _, minutes = position.partition("H")
    return (float(hours) % 12.0 + float(minutes or 0) / 60.0) * math.tau / 12.0
