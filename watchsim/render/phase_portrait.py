"""How fast does each part move, and where: velocity over angle, with the phases of a beat in colour?

plot_phase_portrait(run).savefig("portrait.pdf")
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from watchsim.analysis.phases import Phase
from watchsim.render import style
from watchsim.render.kinematics_plot import Channel, channels
from watchsim.render.palette import FAINT, looks
from watchsim.render.phase_bands import name_key, strong
from watchsim.render.rows import distinct
from watchsim.render.view import Window, choose, dense
from watchsim.simulation.trajectory import Array, Trajectory

LEFT, RIGHT, UNDER, OVER = 16.0, 3.5, 9.0, 5.0  # mm, around a panel
LABEL_AT = 12.8  # mm, of the label left of its panel: numbers of seven digits fit between
TALL = 38.0  # mm
TOP = 6.5
POINTS = 6000  # of a curve at least, for its bends
STYLES = ("-", "--")  # of x and y
WIDER = 1.8  # a phase against the rest of the curve
MOST = 12  # bodies
AT_REST = 1e-3  # of a panel: a curve that is shorter both ways is drawn as a point
FLAT = 1e-4  # a range smaller than this part of the value (or of 1 unit) is not magnified: a body at rest shows no rounding


def plot_phase_portrait(
    run: Trajectory, bodies: Sequence[str] | None = None, window: Sequence[float] | None = None, width: float = style.FULL
) -> Figure:
    """Velocity over place, a panel for each moving body (at most 12 unless named).

    window  (from, to) in seconds; default the last oscillation, or all of the last stretch where nothing keeps time

    An impact is a vertical line, a body at rest a point. ValueError as of `plot_kinematics`.
    """
    cycle = style.shown(run, window)
    span, phases = cycle.window, cycle.phases
    chosen = choose(run, bodies)
    shown = [channel for body in (chosen if bodies else chosen[:MOST]) for channel in channels(run, body)]
    if not shown:
        raise ValueError("nothing to plot: no body of this run moves")
    across = min(1 if width < style.NARROW else 3, len(shown))
    rows = -(-len(shown) // across)
    names = list(dict.fromkeys(phase.name for beat in phases for phase in beat if phase.name != "locked"))
    step = OVER + TALL + UNDER
    top = TOP + (5.0 if width >= style.NARROW else 8.0)
    made = style.figure(width, top + rows * step)
    style.heading(made, run.scene.title, "" if names else words(span))
    if names:
        name_key(made, names, TOP, lines=True)
    t, q, u, _ = dense(run, span, POINTS)
    worn = looks(run.scene)
    wide = width / across - LEFT - RIGHT
    for k, channel in enumerate(shown):
        left, up = (k % across) * (LEFT + wide + RIGHT) + LEFT, top + (k // across) * step + OVER
        axes = style.panel(made, left, up, wide, TALL)
        _portrait(axes, channel, (t, q, u), phases, worn[channel.body.name].line)
    return made


def words(span: Window) -> str:
    """The stretch of time, for a heading."""
    return f"t = {span[0]:.6g} s to {span[1]:.6g} s"


def _portrait(axes: Axes, channel: Channel, rows: tuple[Array, Array, Array], phases: list[list[Phase]], colour: str) -> None:
    t, q, u = rows
    style.dress(axes)
    style.title(axes, channel.body.name, colour)
    axes.axhline(0.0, color=FAINT, linewidth=0.5, zorder=1)
    lines = []
    for k, column in enumerate(channel.columns):
        x, y = channel.factor * q[:, column], channel.factor * u[:, column]
        name = f"{channel.body.name} portrait{f' {channel.legend[k]}' if channel.legend else ''}"
        lines += axes.plot(*distinct(x, y), STYLES[k], color=colour, linewidth=style.CURVE, zorder=2, gid=name)
        for phase in (phase for beat in phases for phase in beat if phase.name != "locked"):
            own = slice(*np.searchsorted(t, (phase.start, phase.end)).tolist())
            own = slice(own.start, own.stop + 1)
            axes.plot(x[own], y[own], color=strong(phase.name), linewidth=WIDER * style.CURVE, zorder=3, solid_capstyle="butt")
    places, speeds = (channel.factor * values[:, channel.columns] for values in (q, u))
    axes.set_xlim(*style.with_room(float(np.nanmin(places)), float(np.nanmax(places)), 0.05, FLAT, 1.0))
    style.limits(axes, float(np.nanmin(speeds)), float(np.nanmax(speeds)), flat=FLAT, unit=1.0)
    if np.ptp(places, axis=0).max() < AT_REST * np.ptp(axes.get_xlim()) and np.ptp(speeds) < AT_REST * np.ptp(axes.get_ylim()):
        axes.plot(places[-1], speeds[-1], "o", color=colour, markersize=3.0, zorder=4, gid=f"{channel.body.name} at rest")
    axes.ticklabel_format(useOffset=False)
    axes.yaxis.set_offset_position("right")  # opposite the title
    wide = style.width_mm(axes)
    style.spare_labels(axes.xaxis, wide / style.POINT, steps=[1, 2, 3, 4.5, 5, 9, 10])
    style.ticks(axes.yaxis, 5)
    axes.set_xlabel(f"{channel.names['angle']} ({channel.units['angle']})", labelpad=1.5)
    axes.set_ylabel(f"{channel.names['velocity']} ({channel.units['velocity']})")
    axes.yaxis.set_label_coords(-LABEL_AT / wide, 0.5, axes.transAxes)
    axes.yaxis.label.set_verticalalignment("center")
    if channel.legend:
        style.key(axes, list(zip(lines, channel.legend, strict=True)), loc="best")
