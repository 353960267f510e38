"""How do angle and velocity of every body run over time?

plot_kinematics(run, window=(19.4, 19.75)).savefig("beat.png")
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from watchsim.render.drawn_rows import drawn
from watchsim.render.figures.plot_margins import GAP, LABEL_SIZE, POINT, TICK_SIZE, TITLE_PAD, TITLE_SIZE, place_panels
from watchsim.render.frame.marks.readouts import clock
from watchsim.render.frame.pose_history import choose, dense, stretch
from watchsim.render.palette import FAINT, GRID, INK, looks
from watchsim.scene.body import Body
from watchsim.simulation.record.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

QUANTITIES = ("angle", "velocity", "acceleration")
USUAL = QUANTITIES[:2]
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


ROTATION = (
    {"angle": "°", "velocity": "°/s", "acceleration": "°/s²"},
    {"angle": "angle", "velocity": "angular velocity", "acceleration": "angular acceleration"},
)
TRAVEL = (
    {"angle": "mm", "velocity": "mm/s", "acceleration": "mm/s²"},
    {"angle": "position", "velocity": "velocity", "acceleration": "acceleration"},
)


def plot_kinematics(
    run: Trajectory,
    bodies: Sequence[str] | None = None,
    quantities: Sequence[str] = USUAL,
    window: Sequence[float] | None = None,
) -> Figure:
    """One panel per moving body and quantity over a common time axis; a figure to save as PNG, SVG or PDF.

    bodies      names; default all that move
    quantities  "angle" (°; sliding and free bodies: their position in mm too), "velocity" (°/s, mm/s), "acceleration" (°/s²,
                mm/s²; it jumps with every force, and what happens within an impact has none)
    window      (from, to) in seconds; default all that was recorded

    Between rows the curve follows the trajectory's own interpolation; at an impact the velocity jumps. ValueError naming
    the choices for an unknown body or quantity, or a window that was not recorded.
    """
    return Kinematics(run, bodies, quantities).show(window)


class Kinematics:
    """The panels of `plot_kinematics`, which can show one window after another: most of a plot's cost is making them."""

    def __init__(self, run: Trajectory, bodies: Sequence[str] | None = None, quantities: Sequence[str] = USUAL) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        from watchsim.render.figures.shown_figure import ShownFigure

        self.run, self._quantities = run, _quantities(quantities)
        self._channels = [channel for body in choose(run, bodies) for channel in _channels(run, body)]
        if not self._channels:
            raise ValueError("nothing to plot: no body of this run moves")
        rows, columns = len(self._channels), len(self._quantities)
        self.figure: Figure = ShownFigure(figsize=(PANEL[0] * columns, PANEL[1] * rows + 1.0), dpi=150)
        FigureCanvasAgg(self.figure)
        self._panels = self.figure.subplots(rows, columns, sharex=True, squeeze=False)
        below = 1.0 - GAP * POINT / self.figure.get_figheight()
        title = {"fontsize": TITLE_SIZE, "weight": "bold", "color": INK}
        self.figure.suptitle(run.scene.title, x=0.01, y=below, ha="left", va="top", **title)
        worn = looks(run.scene)
        for axes, channel, quantity in self._each():
            _panel(axes, channel, quantity, worn[channel.body.name].line)

    def show(self, window: Sequence[float] | None = None) -> Figure:
        """The figure, now of this window (s); default all that was recorded."""
        span = stretch(self.run, window)
        t, *motion = dense(self.run, span)
        told = clock(span)
        x = (t - told.base) * told.factor
        for axes, channel, quantity in self._each():
            values = channel.factor * motion[QUANTITIES.index(quantity)][:, channel.columns]
            for line, column in zip(axes.get_lines(), values.T, strict=True):
                seen = drawn(x, column)
                line.set_data(x[seen], column[seen])
            _limits(axes, values, quantity == "angle" and channel.units is ROTATION[0])
        for axes in self._panels[-1]:
            axes.set_xlabel(told.label, color=INK)
        self._panels[-1, 0].set_xlim(*((end - told.base) * told.factor for end in span))  # which all panels share
        place_panels(self.figure, self._panels)
        return self.figure

    def _each(self) -> Iterator[tuple[Axes, Channel, str]]:
        """Every panel with what it shows."""
        for row, channel in zip(self._panels, self._channels, strict=True):
            for axes, quantity in zip(row, self._quantities, strict=True):
                yield axes, channel, quantity


def write_png(figure: Figure, path: Path) -> None:
    """As `figure.savefig(path)`, but without transparency and lightly packed: a tenth more bytes in half the time."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    dots = (figure.dpi, figure.dpi)
    Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB").save(path, format="png", compress_level=1, dpi=dots)


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
    axes.set_title(channel.body.name, loc="left", fontsize=LABEL_SIZE, color=colour, weight="bold", y=1.0, pad=TITLE_PAD)
    axes.grid(True, color=GRID, linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=TICK_SIZE)
    axes.yaxis.set_offset_position("right")  # opposite the title
    for k in range(len(channel.columns)):
        label = channel.legend[k] if channel.legend else None
        axes.plot([], [], STYLES[k], color=colour, linewidth=1.3, label=label, solid_joinstyle="round")
    if channel.legend:
        axes.legend(frameon=False, fontsize=TICK_SIZE, loc="upper left", ncols=len(channel.legend), borderaxespad=0.2)


def _limits(axes: Axes, values: Array, angle: bool) -> None:
    """Room above and below; rounding noise of a resting body is not blown up; large angles in parts of a turn."""
    from matplotlib.ticker import MaxNLocator, ScalarFormatter, StrMethodFormatter

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
        plain = ScalarFormatter(useOffset=high - low <= 1e-4 * max(abs(low), abs(high)))
        plain.set_scientific(False)
        axes.yaxis.set_major_formatter(plain)
