"""How do angle and velocity of every body run over time?

plot_kinematics(run, window=(19.4, 19.75)).savefig("beat.png")
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.ticker import ScalarFormatter, StrMethodFormatter

from watchsim.analysis.phases import Phase
from watchsim.render import style
from watchsim.render.marks import clock
from watchsim.render.palette import looks
from watchsim.render.phase_bands import name_key, shade
from watchsim.render.rows import COLUMNS, bands, reduced
from watchsim.render.view import choose, dense, stretch
from watchsim.scene.scene import Body
from watchsim.simulation.trajectory import Array, Trajectory

QUANTITIES = ("angle", "velocity", "acceleration")
USUAL = QUANTITIES[:2]
PANEL, FOOT = 30.0, 9.0  # mm, the height of a row of panels, and room for the time below
MANY, LOW = 24, 20.0  # so many rows, and the height of each of more
KEY, KEY_GAP = 6.5, 1.0  # mm, where the names of phases begin, and room below them
FLAT = 1e-6  # a range smaller than this part of the value (or of 1 unit) is shown as flat, not magnified
STYLES = ("-", "--")  # of x and y
DOT_COLUMNS = 2  # in which the values of a curve are looked at, to each dot of a picture's width


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
    # "angular acceleration" is longer than a panel is high; its unit says the same.
    {"angle": "angle", "velocity": "angular velocity", "acceleration": "acceleration"},
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
    width: float = style.FULL,
) -> Figure:
    """One panel per moving body and quantity over a common time axis; a figure to save as PNG, SVG or PDF.

    bodies      names; default all that move
    quantities  "angle" (°; sliding and free bodies: their position in mm too), "velocity" (°/s, mm/s), "acceleration" (°/s²,
                mm/s²; it jumps with every force, and what happens within an impact has none)
    window      (from, to) in seconds; default all that was recorded
    width       mm, as printed: 170 for a page, 85 for a column

    Where the window shows a few beats of an escapement their phases are shaded and named. Between rows the curve follows the
    trajectory's own interpolation; at an impact the velocity jumps, and of dense curves every spike is drawn. ValueError naming
    the choices for an unknown body or quantity, or a window that was not recorded.
    """
    return Kinematics(run, bodies, quantities, width).show(window)


class Kinematics:
    """The panels of `plot_kinematics`, which can show one window after another: most of a plot's cost is making them."""

    def __init__(
        self, run: Trajectory, bodies: Sequence[str] | None = None, quantities: Sequence[str] = USUAL, width: float = style.FULL
    ) -> None:
        self.run, self._quantities = run, _quantities(quantities)
        self._channels = [channel for body in choose(run, bodies) for channel in channels(run, body)]
        if not self._channels:
            raise ValueError("nothing to plot: no body of this run moves")
        side_by_side = 1 if width < style.NARROW else len(self._quantities)
        rows = len(self._channels) * len(self._quantities) // side_by_side
        self.figure: Figure = style.figure(width, (PANEL if rows <= MANY else LOW) * rows + FOOT + KEY)
        self._panels = self.figure.subplots(rows, side_by_side, sharex=True, squeeze=False)
        style.heading(self.figure, run.scene.title)
        self._own = len(self.figure.texts), len(self.figure.artists)
        worn = looks(run.scene)
        for axes, channel, quantity in self._each():
            _panel(axes, channel, quantity, worn[channel.body.name].line)

    def of(self, run: Trajectory) -> Kinematics:
        """The same panels, from now on of this run, which must be one of the same scene."""
        self.run = run
        return self

    def show(self, window: Sequence[float] | None = None, dots: bool = False) -> Figure:
        """The figure, now of this window (s), default all recorded; for `dots` only as fine as `write_png` shows it."""
        span = stretch(self.run, window)
        t, *motion = dense(self.run, span, accelerations=QUANTITIES[2] in self._quantities)
        told = clock(span)
        x = (t - told.base) * told.factor
        phases = style.passing(self.run, span)
        columns = DOT_COLUMNS * round(self._panels[0, 0].bbox.width) if dots else COLUMNS
        for axes, channel, quantity in self._each():
            values = channel.factor * motion[QUANTITIES.index(quantity)][:, channel.columns]
            for patch in list(axes.patches):
                patch.remove()
            for line, column in zip(axes.get_lines(), values.T, strict=True):
                _curve(axes, line, x, column, columns)
            _limits(axes, values, quantity == "angle" and channel.units is ROTATION[0])
            for beat in phases:
                shade(axes, beat, told.base, told.factor)
        for axes in self._panels[-1]:
            axes.set_xlabel(told.label)
        self._panels[-1, 0].set_xlim(*((end - told.base) * told.factor for end in span))  # which all panels share
        style.place_panels(self.figure, self._panels, self._named(phases))
        return self.figure

    def _named(self, phases: list[list[Phase]]) -> float:
        """The names of the phases in sight below the title; where the panels begin, mm."""
        texts, artists = self._own
        for one in (*self.figure.texts[texts:], *self.figure.artists[artists:]):
            one.remove()
        names = list(dict.fromkeys(phase.name for beat in phases for phase in beat if phase.name != "locked"))
        return name_key(self.figure, names, KEY) + KEY_GAP if names else KEY

    def _each(self) -> Iterator[tuple[Axes, Channel, str]]:
        """Every panel with what it shows."""
        shown = ((channel, quantity) for channel in self._channels for quantity in self._quantities)
        for axes, (channel, quantity) in zip(self._panels.flat, shown, strict=True):
            yield axes, channel, quantity


def write_png(figure: Figure, path: Path | IO[bytes]) -> None:
    """As `figure.savefig(path)`, but without transparency and lightly packed: a tenth more bytes in half the time."""
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


def channels(run: Trajectory, body: Body) -> list[Channel]:
    """The rows of panels of one body: one, and of a free body two."""
    first = run.slices[body.name].start
    if body.motion == "slide":
        return [Channel(body, (first,), 1e3, *TRAVEL)]
    if body.motion == "free":
        place = Channel(body, (first, first + 1), 1e3, *TRAVEL, ("x", "y"))
        return [place, Channel(body, (first + 2,), 180.0 / math.pi, *ROTATION)]
    return [Channel(body, (first,), 180.0 / math.pi, *ROTATION)]


def _panel(axes: Axes, channel: Channel, quantity: str, colour: str) -> None:
    style.dress(axes)
    axes.set_ylabel(f"{channel.names[quantity]} ({channel.units[quantity]})")
    style.title(axes, channel.body.name, colour)
    axes.yaxis.set_offset_position("right")  # opposite the title
    lines = []
    for k in range(len(channel.columns)):
        name = f"{channel.body.name} {quantity}{f' {channel.legend[k]}' if channel.legend else ''}"
        lines += axes.plot([], [], STYLES[k], color=colour, linewidth=style.CURVE, solid_joinstyle="round", gid=name, zorder=3)
    if channel.legend:
        style.key(axes, list(zip(lines, channel.legend, strict=True)), loc="upper left", ncols=len(channel.legend))


def _curve(axes: Axes, line: Line2D, x: Array, y: Array, columns: int) -> None:
    """Draw y over x: as a line, or where its points are dense as the area that it covers; dashed ones stay lines."""
    areas = bands(x, y, columns) if line.get_linestyle() == STYLES[0] else []
    line.set_data(*(((), ()) if areas else reduced(x, y, columns)))
    for middle, low, high in areas:
        outline = np.column_stack((np.append(middle, middle[::-1]), np.append(low, high[::-1])))
        look: dict[str, Any] = {"color": line.get_color(), "linewidth": line.get_linewidth(), "zorder": line.get_zorder()}
        axes.add_artist(Polygon(outline, joinstyle="round", gid=line.get_gid(), **look))  # its limits are known


def _limits(axes: Axes, values: Array, angle: bool) -> None:
    """Room above and below; rounding noise of a resting body is not blown up; large angles in parts of a turn."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    style.limits(axes, low, high, flat=FLAT, unit=1.0)
    if angle and high - low > 60.0:
        style.ticks(axes.yaxis, 9, [1, 1.5, 1.8, 3, 3.6, 4.5, 6, 9, 10])
    else:
        style.ticks(axes.yaxis, 5)
    if high - low > 10.0:
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
    else:
        plain = ScalarFormatter(useOffset=high - low <= 1e-4 * max(abs(low), abs(high)))
        plain.set_scientific(False)
        axes.yaxis.set_major_formatter(plain)
