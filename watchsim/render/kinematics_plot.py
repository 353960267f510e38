"""How do angle and velocity of every body run over time, and one over the other?

plot_kinematics(run, window=(19.4, 19.75)).savefig("beat.png")
plot_phase_portrait(run).savefig("portrait.pdf")
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import IO

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.ticker import ScalarFormatter

from watchsim.analysis.phases import Phase
from watchsim.render import style
from watchsim.render.marks import clock, spaced
from watchsim.render.palette import FAINT, looks
from watchsim.render.phase_plots import name_key, names_in, shade, strong
from watchsim.render.rows import COLUMNS, bands, distinct, envelope, reduced
from watchsim.render.view import choose, dense, stretch
from watchsim.scene.scene import Body
from watchsim.simulation.trajectory import Array, Trajectory

QUANTITIES = ("angle", "velocity", "acceleration")
USUAL = QUANTITIES[:2]
PANEL, FOOT = 30.0, 9.0  # mm, the height of a row of panels, and room for the time below
MANY, LOW = 24, 20.0  # so many rows, and the height of each of more
KEY, KEY_GAP = 6.5, 1.0  # mm, where the names of phases begin, and room below them
FILLED = 0.25  # opacity of the area between envelopes
CROWDED = 0.3  # of a panel's width, taken by the strokes of a curve: more would make a solid block of it
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


ROTATION = (  # units and names of the quantities; "angular acceleration" is longer than a panel is high, its unit says the same
    dict(zip(QUANTITIES, ("°", "°/s", "°/s²"), strict=True)),
    dict(zip(QUANTITIES, ("angle", "angular velocity", "acceleration"), strict=True)),
)
TRAVEL = (
    dict(zip(QUANTITIES, ("mm", "mm/s", "mm/s²"), strict=True)),
    dict(zip(QUANTITIES, ("position", "velocity", "acceleration"), strict=True)),
)


def plot_kinematics(
    run: Trajectory,
    bodies: Sequence[str] | None = None,
    quantities: Sequence[str] = USUAL,
    window: Sequence[float] | None = None,
    width: float = style.FULL,
    ax: Axes | None = None,
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
    return Kinematics(run, bodies, quantities, width, ax).show(window)


class Kinematics:
    """The panels of `plot_kinematics`, which can show one window after another: most of a plot's cost is making them."""

    def __init__(
        self,
        run: Trajectory,
        bodies: Sequence[str] | None = None,
        quantities: Sequence[str] = USUAL,
        width: float = style.FULL,
        ax: Axes | None = None,
    ) -> None:
        self.run, self._quantities = run, _quantities(quantities)
        self._channels = [channel for body in choose(run, bodies) for channel in channels(run, body)]
        if not self._channels:
            raise ValueError("nothing to plot: no body of this run moves")
        side_by_side = 1 if width < style.NARROW else len(self._quantities)
        rows = len(self._channels) * len(self._quantities) // side_by_side
        self.figure: Figure = style.figure(width, (PANEL if rows <= MANY else LOW) * rows + FOOT + KEY, ax=ax)
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
        time = clock(span)
        x = time.at(t)
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
                shade(axes, beat, time.base, time.factor)
        for axes in self._panels[-1]:
            axes.set_xlabel(time.label)
        self._panels[-1, 0].set_xlim(*map(time.at, span))  # which all panels share
        style.place_panels(self.figure, self._panels, self._named(phases))
        return self.figure

    def _named(self, phases: list[list[Phase]]) -> float:
        """The names of the phases in sight below the title; where the panels begin, mm."""
        texts, artists = self._own
        for one in (*self.figure.texts[texts:], *self.figure.artists[artists:]):
            one.remove()
        names = names_in(phases)
        return name_key(self.figure, names, KEY) + KEY_GAP if names else KEY

    def _each(self) -> Iterator[tuple[Axes, Channel, str]]:
        """Every panel with what it shows."""
        for axes, shown in zip(self._panels.flat, product(self._channels, self._quantities), strict=True):
            yield axes, *shown


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
        units, names = TRAVEL
        return [Channel(body, (first,), 1e3, units, names | {QUANTITIES[0]: "travel"})]  # from `position`, along its axis
    if body.motion == "free":
        place = Channel(body, (first, first + 1), 1e3, *TRAVEL, ("x", "y"))
        return [place, Channel(body, (first + 2,), 180.0 / math.pi, *ROTATION)]
    return [Channel(body, (first,), 180.0 / math.pi, *ROTATION)]


def _panel(axes: Axes, channel: Channel, quantity: str, colour: str) -> None:
    style.dress(axes)
    axes.set_ylabel(f"{channel.names[quantity]} ({channel.units[quantity]})")
    style.title(axes, spaced(channel.body.name), colour)
    axes.yaxis.set_offset_position("right")  # opposite the title
    lines = []
    for k in range(len(channel.columns)):
        name = f"{channel.body.name} {quantity}{f' {channel.legend[k]}' if channel.legend else ''}"
        lines += axes.plot([], [], STYLES[k], color=colour, linewidth=style.CURVE, solid_joinstyle="round", gid=name, zorder=3)
    if channel.legend:
        style.key(axes, list(zip(lines, channel.legend, strict=True)), loc="upper left", ncols=len(channel.legend))


def _curve(axes: Axes, line: Line2D, x: Array, y: Array, columns: int) -> None:
    """Draw y over x: as a line, as its envelopes where it goes to and fro too often, or as the area that dense points cover."""
    width = axes.bbox.width / axes.figure.dpi * style.INCH
    areas = envelope(x, y, CROWDED * width / (2.0 * line.get_linewidth()))
    opacity = FILLED if areas else 1.0
    areas = areas or (bands(x, y, columns) if line.get_linestyle() == STYLES[0] else [])
    line.set_data(*(((), ()) if areas else reduced(x, y, columns)))
    for middle, low, high in areas:
        outline = np.column_stack((np.append(middle, middle[::-1]), np.append(low, high[::-1])))
        area = Polygon(outline, edgecolor=line.get_color(), linewidth=line.get_linewidth(), zorder=line.get_zorder())
        area.set_facecolor(to_rgba(line.get_color(), opacity))
        area.set(joinstyle="round", gid=line.get_gid())
        axes.add_artist(area)  # its limits are known


def _limits(axes: Axes, values: Array, angle: bool) -> None:
    """Room above and below; rounding noise of a resting body is not blown up; large angles in parts of a turn."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    if high - low < (ROUNDED if angle else EVEN) * max(abs(low), abs(high)):  # a constant: its rounding is no motion
        low = high = 0.5 * (low + high)
        style.limits(axes, low, high, flat=0.1, unit=1.0)
    else:
        style.limits(axes, low, high, flat=FLAT, unit=1.0)
    large = angle and high - low > 60.0
    style.ticks(axes.yaxis, 9 if large else 5, angle=large)
    plain = ScalarFormatter(useOffset=high - low <= 1e-4 * max(abs(low), abs(high)))
    plain.set_scientific(False)
    axes.yaxis.set_major_formatter(plain)


LEFT, RIGHT, UNDER, OVER = 16.0, 3.5, 9.0, 5.0  # mm, around a panel
LABEL_AT = 12.8  # mm, of the label left of its panel: numbers of seven digits fit between
TALL, TOP = 38.0, 6.5  # mm
POINTS = 6000  # of a curve at least, for its bends
WIDER = 1.8  # a phase against the rest of the curve
AT_REST = 1e-3  # of a panel: a curve that is shorter both ways is drawn as a point
EVEN, ROUNDED = 1e-6, 1e-12  # of its value: a smaller range of a velocity, of an angle is that of a constant
STILL = 1e-4  # a range smaller than this part of the value (or of 1 unit) is not magnified: a body at rest shows no rounding


def plot_phase_portrait(
    run: Trajectory,
    bodies: Sequence[str] | None = None,
    window: Sequence[float] | None = None,
    width: float = style.FULL,
    ax: Axes | None = None,
) -> Figure:
    """Velocity over place, a panel for each moving body (at most 12 unless named).

    window  (from, to) in seconds; default the last oscillation, or all of the last stretch where nothing keeps time

    An impact is a vertical line, a body at rest a point. ValueError as of `plot_kinematics`.
    """
    cycle = style.shown(run, window)
    span, phases = cycle.window, cycle.phases
    chosen = choose(run, bodies)
    shown = [channel for body in (chosen if bodies else chosen[:12]) for channel in channels(run, body)]
    if not shown:
        raise ValueError("nothing to plot: no body of this run moves")
    across = 1 if width < style.NARROW else 2 if len(shown) in (2, 4) else min(3, len(shown))
    rows = -(-len(shown) // across)
    names = names_in(phases, banded=False)
    step = OVER + TALL + UNDER
    top = TOP + (5.0 if width >= style.NARROW else 8.0)
    made = style.figure(width, top + rows * step, ax=ax)
    style.heading(made, run.scene.title, "" if names else f"t = {span[0]:.6g} s to {span[1]:.6g} s")
    if names:
        name_key(made, names, TOP, lines=True)
    t, q, u, _ = dense(run, span, POINTS)
    worn = looks(run.scene)
    panels = style.panels(made, width, [TALL] * len(shown), across, (LEFT, RIGHT), top + OVER, step)
    for axes, channel in zip(panels, shown, strict=True):
        _portrait(axes, channel, (t, q, u), phases, worn[channel.body.name].line)
    return made


def _portrait(axes: Axes, channel: Channel, rows: tuple[Array, Array, Array], phases: list[list[Phase]], colour: str) -> None:
    t, q, u = rows
    style.dress(axes)
    style.title(axes, spaced(channel.body.name), colour)
    axes.axhline(0.0, color=FAINT, linewidth=0.5, zorder=1)
    lines = []
    for k, column in enumerate(channel.columns):
        x, y = channel.factor * q[:, column], channel.factor * u[:, column]
        name = f"{channel.body.name} portrait{f' {channel.legend[k]}' if channel.legend else ''}"
        lines += axes.plot(*distinct(x, y), STYLES[k], color=colour, linewidth=style.CURVE, zorder=2, gid=name)
        for phase in (phase for beat in phases for phase in beat if phase.name != "locked"):
            first, last = np.searchsorted(t, (phase.start, phase.end)).tolist()
            own = slice(first, last + 1)
            axes.plot(x[own], y[own], color=strong(phase.name), linewidth=WIDER * style.CURVE, zorder=3, solid_capstyle="butt")
    places, speeds = (channel.factor * values[:, channel.columns] for values in (q, u))
    axes.set_xlim(*style.with_room(float(np.nanmin(places)), float(np.nanmax(places)), 0.05, STILL, 1.0))
    style.limits(axes, float(np.nanmin(speeds)), float(np.nanmax(speeds)), flat=STILL, unit=1.0)
    still = np.ptp(places, axis=0).max() < AT_REST * np.ptp(axes.get_xlim()) and np.ptp(speeds) < AT_REST * np.ptp(
        axes.get_ylim()
    )
    if still:
        axes.plot(places[-1], speeds[-1], "o", color=colour, markersize=3.0, zorder=4, gid=f"{channel.body.name} at rest")
    axes.ticklabel_format(useOffset=False)
    axes.yaxis.set_offset_position("right")  # opposite the title
    wide = style.width_mm(axes)
    style.spare_labels(axes.xaxis, wide / style.POINT, angle=channel.units["angle"] == ROTATION[0]["angle"])
    style.ticks(axes.yaxis, 5)
    if still and not channel.legend:  # its place is all that there is to read
        axes.set_xticks(places[-1])
        axes.set_yticks([0.0])
    axes.set_xlabel(f"{channel.names['angle']} ({channel.units['angle']})", labelpad=1.5)
    axes.set_ylabel(f"{channel.names['velocity']} ({channel.units['velocity']})")
    axes.yaxis.set_label_coords(-LABEL_AT / wide, 0.5, axes.transAxes)
    axes.yaxis.label.set_verticalalignment("center")
    if channel.legend:
        style.key(axes, list(zip(lines, channel.legend, strict=True)), loc="best")
