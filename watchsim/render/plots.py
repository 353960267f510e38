"""How do angle and velocity of every body run over time?

plot_kinematics(run, window=(19.4, 19.75)).savefig("beat.png")
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.body import Body
from watchsim.render.palette import FAINT, GRID, INK, looks
from watchsim.render.poses import Window, choose, dense, stretch
from watchsim.render.readouts import Clock, clock
from watchsim.simulation.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

QUANTITIES = ("angle", "velocity")
PANEL = (6.0, 2.1)  # inches
FLAT = 1e-6  # a range smaller than this part of the value (or of 1 unit) is shown as flat, not magnified
STYLES = ("-", "--")  # of x and y


@dataclass(frozen=True)
class Channel:
    """One row of panels: which coordinates of a body, under what names and in which units."""

    body: Body
    columns: tuple[int, ...]
    factor: float
    units: dict[str, str]
    names: dict[str, str]
    legend: tuple[str, ...] = ()


ROTATION = ({"angle": "°", "velocity": "°/s"}, {"angle": "angle", "velocity": "angular velocity"})
TRAVEL = ({"angle": "mm", "velocity": "mm/s"}, {"angle": "position", "velocity": "velocity"})


def plot_kinematics(
    run: Trajectory,
    bodies: Sequence[str] | None = None,
    quantities: Sequence[str] = QUANTITIES,
    window: Sequence[float] | None = None,
) -> Figure:
    """One panel per moving body and quantity over a common time axis; a figure to save as PNG, SVG or PDF.

    bodies      names; default all that move
    quantities  "angle" (°; sliding and free bodies: their position in mm too), "velocity" (°/s, mm/s)
    window      (from, to) in seconds; default all that was recorded

    Between rows the curve follows the trajectory's own interpolation; at an impact the velocity jumps. ValueError naming
    the choices for an unknown body or quantity, or a window that was not recorded.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    shown = choose(run, bodies)
    asked = _quantities(quantities)
    span = stretch(run, window)
    rows = [channel for body in shown for channel in _channels(run, body)]
    if not rows:
        raise ValueError("nothing to plot: no body of this run moves")
    figure = Figure(figsize=(PANEL[0] * len(asked), PANEL[1] * len(rows) + 1.0), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(len(rows), len(asked), sharex=True, squeeze=False)
    colours = {name: look.line for name, look in looks(run.scene).items()}
    t, q, u = dense(run, span)
    told = clock(span)
    for grid_row, channel in zip(panels, rows, strict=True):
        for axes, quantity in zip(grid_row, asked, strict=True):
            values = channel.factor * (q if quantity == "angle" else u)[:, channel.columns]
            _panel(axes, channel, quantity, colours[channel.body.name])
            _draw(axes, (t - told.base) * told.factor, values, channel, colours[channel.body.name])
            _limits(axes, values, quantity == "angle" and channel.units is ROTATION[0])
    _time_axis(figure, panels, run.scene.title, told, span)
    return figure


def _quantities(quantities: Sequence[str]) -> tuple[str, ...]:
    asked = (quantities,) if isinstance(quantities, str) else tuple(quantities)
    unknown = [name for name in asked if name not in QUANTITIES]
    if unknown or not asked:
        wrong = ", ".join(repr(name) for name in unknown) or "none given"
        raise ValueError(f"quantities: {wrong}; choose from {', '.join(QUANTITIES)}")
    return asked


def _channels(run: Trajectory, body: Body) -> list[Channel]:
    first = run.slices[body.name].start
    if body.motion == "slide":
        return [Channel(body, (first,), 1e3, *TRAVEL)]
    if body.motion == "free":
        place = Channel(body, (first, first + 1), 1e3, *TRAVEL, ("x", "y"))
        return [place, Channel(body, (first + 2,), 180.0 / math.pi, *ROTATION)]
    return [Channel(body, (first,), 180.0 / math.pi, *ROTATION)]


def _panel(axes: Axes, channel: Channel, quantity: str, colour: str) -> None:
    axes.set_ylabel(f"{channel.names[quantity]} ({channel.units[quantity]})", color=INK)
    axes.set_title(channel.body.name, loc="left", fontsize=10, color=colour, weight="bold", pad=4)
    axes.grid(True, color=GRID, linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=9)


def _draw(axes: Axes, x: Array, values: Array, channel: Channel, colour: str) -> None:
    for k in range(values.shape[1]):
        label = channel.legend[k] if channel.legend else None
        axes.plot(x, values[:, k], STYLES[k], color=colour, linewidth=1.3, label=label, solid_joinstyle="round")
    if channel.legend:
        axes.legend(frameon=False, fontsize=9, loc="upper left", ncols=len(channel.legend), borderaxespad=0.2)


def _limits(axes: Axes, values: Array, angle: bool) -> None:
    """Room above and below; rounding noise of a resting body is not blown up; large angles in parts of a turn."""
    from matplotlib.ticker import MaxNLocator, StrMethodFormatter

    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    least = FLAT * max(abs(low), abs(high), 1.0)
    room = max(0.08 * (high - low), 0.5 * least)
    axes.set_ylim(low - room, high + room)
    if angle and high - low > 60.0:
        axes.yaxis.set_major_locator(MaxNLocator(nbins=9, steps=[1, 1.5, 1.8, 3, 3.6, 4.5, 6, 9, 10]))
    else:
        axes.yaxis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 5, 10]))
    if high - low > 10.0:
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
    else:
        axes.ticklabel_format(axis="y", useOffset=high - low <= 1e-4 * max(abs(low), abs(high)), style="plain")


def _time_axis(figure: Figure, panels: NDArray[np.object_], title: str, told: Clock, span: Window) -> None:
    left, right = ((t - told.base) * told.factor for t in span)
    for axes in panels[-1]:
        axes.set_xlim(left, right)
        axes.set_xlabel(told.label, color=INK)
    figure.suptitle(title, x=0.01, ha="left", fontsize=13, weight="bold", color=INK)
    figure.align_ylabels()
