"""How do wheel, lever and balance move through the phases of a beat: angles and angular velocities, phases shaded and named?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timeline.oscillation import Beat, shown_beats
from watchsim.analysis.timeline.table import title
from watchsim.render.frame.pose_history import dense
from watchsim.render.palette import FAINT, GRID, INK, PHASES, looks
from watchsim.scene.roles import roles
from watchsim.simulation.record.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

MM = 1.0 / 25.4  # inches
FULL, COLUMN = 170.0, 85.0  # mm
PANEL, TOP, FOOT, LEFT, RIGHT, BETWEEN = 25.0, 31.0, 5.0, 13.5, 3.0, 11.0
SIZE, SMALL = 6.5, 6.0  # pt
SHADES = {**PHASES, "locked": "#ffffff"}
SECOND = "#b3d7b3"  # of an impulse that follows another
BEFORE, AFTER = 0.08, 0.12  # of a beat's phases: what is shown besides
MANY = 2  # beats that are drawn one by one
DPI = 200


def phase_plot(
    run: Trajectory, window: Sequence[float] | None = None, width: float = FULL, told: list[Beat] | None = None
) -> Figure:
    """A figure `width` mm wide: left the whole window (s; default the last oscillation), then its last two beats at large.

    In a single column of text (less than 120 mm) only the beats. ValueError where no beat was recorded whole.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    told = told or shown_beats(run, window)
    span = (told[0].start, told[-1].end) if window is None else (float(window[0]), float(window[1]))
    span = (max(span[0], float(run.t[0])), min(span[1], float(run.t[-1])))
    large = told[-MANY:]
    columns = [*([None] if width > 0.7 * FULL else []), *large]
    parts = roles(run.scene)
    names = [name for name in (parts.wheel, parts.lever, parts.oscillator) if name]
    rows = 2 * len(names)
    height = TOP + rows * PANEL + FOOT
    figure = Figure(figsize=(width * MM, height * MM), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    figure.text(2.0 / width, 1.0 - 4.0 / height, run.scene.title, fontsize=9.0, weight="bold", va="center", color=INK)
    words = f"t = {span[0]:.4f} s to {span[1]:.4f} s"
    figure.text(2.0 / width, 1.0 - 8.5 / height, words, fontsize=SIZE, va="center", color=INK)
    wide = (width - LEFT - RIGHT - (len(columns) - 1) * BETWEEN) / len(columns)
    for c, beat in enumerate(columns):
        panels = [
            figure.add_axes(
                (
                    (LEFT + c * (wide + BETWEEN)) / width,
                    1.0 - (TOP + (r + 1) * PANEL - 3.5) / height,
                    wide / width,
                    (PANEL - 5.0) / height,
                )
            )
            for r in range(rows)
        ]
        _column(panels, run, names, span if beat is None else _around(beat, run), beat, told, first=c == 0)
    return figure


def _around(beat: Beat, run: Trajectory) -> tuple[float, float]:
    """The beat without its free oscillation, and a little more."""
    end = max((stage.phase.end for stage in beat.stages if stage.name != "locked"), default=beat.end)
    way = end - beat.start
    return max(beat.start - BEFORE * way, float(run.t[0])), min(end + AFTER * way, float(run.t[-1]))


def _column(
    panels: list[Axes],
    run: Trajectory,
    names: list[str],
    span: tuple[float, float],
    beat: Beat | None,
    told: list[Beat],
    first: bool,
) -> None:
    """Angle and velocity of each body over one stretch of time."""
    t, q, u, _ = dense(run, span)
    zero = span[0] if beat is None else beat.start
    x = 1e3 * (t - zero)
    worn = looks(run.scene)
    for k, name in enumerate(names):
        column, colour = run.slices[name].start, worn[name].line
        for axes, values, unit in (
            (panels[2 * k], np.degrees(q[:, column]), f"{name} (°)"),
            (panels[2 * k + 1], 1e-3 * np.degrees(u[:, column]), f"{name} (1000 °/s)"),
        ):
            axes.plot(x, values, color=colour, linewidth=0.9, solid_joinstyle="round", zorder=3)
            _dress(axes, (1e3 * (span[0] - zero), 1e3 * (span[1] - zero)), values)
            if first:
                axes.set_ylabel(unit, fontsize=SMALL, color=colour, weight="bold")
                axes.yaxis.set_label_coords(-10.5 * MM / (_width(axes)), 0.5)
    for axes in panels:
        _shade(axes, told if beat is None else [beat], zero, whole=beat is None)
    for axes in panels[:-1]:
        axes.set_xticklabels([])
    stone = f", {beat.stages[0].pallet} stone" if beat is not None and beat.stages[0].pallet else ""
    words = f"ms after t = {zero:.4f} s" if beat is None else f"ms from first touch{stone}"
    panels[-1].set_xlabel(words, fontsize=SMALL, color=INK, labelpad=1.5)
    if beat is not None:
        _names(panels[0], beat, zero)


def _dress(axes: Axes, limits: tuple[float, float], values: Array) -> None:
    from matplotlib.ticker import MaxNLocator

    low, high = float(values.min()), float(values.max())
    room = max(0.1 * (high - low), 1e-6 * max(abs(low), abs(high), 1.0))
    axes.set_ylim(low - room, high + room)
    axes.set_xlim(*limits)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 5, 10]))
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 3, 5, 9, 10]))
    axes.ticklabel_format(useOffset=False)
    axes.tick_params(colors=INK, labelsize=SMALL, length=2.0, width=0.5, pad=1.5)
    axes.grid(True, color=GRID, linewidth=0.4)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.spines[["left", "bottom"]].set_linewidth(0.5)


def _shade(axes: Axes, beats: list[Beat], zero: float, whole: bool) -> None:
    """A band for each phase; in the view of the whole window one for each beat."""
    for beat in beats:
        impulses = 0
        for stage in beat.stages:
            if stage.name == "locked":
                continue
            colour = SHADES.get(stage.name, "#eeeeee")
            if stage.name == "impulse":
                impulses += 1
                colour = SECOND if impulses == 2 else colour
            start, end = 1e3 * (stage.phase.start - zero), 1e3 * (stage.phase.end - zero)
            axes.axvspan(start, end, color="#dddddd" if whole else colour, linewidth=0.0, zorder=0)


def _names(axes: Axes, beat: Beat, zero: float) -> None:
    """Names above the panel, slanted, spread where phases are short, with a line to the middle of each."""
    low, high = axes.get_xlim()
    stages = [stage for stage in beat.stages if stage.name != "locked"]
    middles = [500.0 * (stage.phase.start + stage.phase.end - 2.0 * zero) for stage in stages]
    least = 4.2 * (high - low) / (_width(axes) / MM)
    for stage, middle, place in zip(stages, middles, _spread(middles, least), strict=True):
        words = title(stage)
        where, top = (middle - low) / (high - low), (place - low) / (high - low)
        axes.plot(
            (where, top), (1.0, 1.14), transform=axes.transAxes, color=FAINT, linewidth=0.5, clip_on=False, zorder=1
        )  # fmt: skip
        axes.text(
            top, 1.16, words, transform=axes.transAxes, rotation=90.0, fontsize=SMALL, ha="center", va="bottom", color=INK
        )  # fmt: skip


def _width(axes: Axes) -> float:
    """Of a panel, inches."""
    return float(axes.get_window_extent().width) / DPI


def _spread(places: list[float], least: float) -> list[float]:
    """The places moved apart to a least distance, as a whole as little as possible."""
    moved = list(places)
    for _ in range(200):
        worst = 0.0
        for k in range(len(moved) - 1):
            lack = least - (moved[k + 1] - moved[k])
            if lack > 1e-12 * least:
                moved[k], moved[k + 1] = moved[k] - 0.5 * lack, moved[k + 1] + 0.5 * lack
                worst = max(worst, lack)
        if not worst > 1e-3 * least:
            break
    return moved if all(math.isfinite(place) for place in moved) else places
