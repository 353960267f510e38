"""How do wheel, lever and balance move through the phases of a beat: angles and angular velocities, phases shaded and named?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timeline.shown_beats import Beat, shown_beats
from watchsim.render.figures.figure_style import CURVE, FULL, MM, NARROW, SMALL, dress, figure, heading, limits, panel
from watchsim.render.figures.phase_bands import name_above, shade
from watchsim.render.frame.pose_history import dense
from watchsim.render.palette import looks
from watchsim.scene.roles import with_anchor
from watchsim.simulation.record.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

PANEL, TOP, FOOT, LEFT, RIGHT, BETWEEN = 25.0, 35.0, 3.0, 13.5, 3.0, 11.0  # mm
LABEL_AT = 10.5  # mm, of the label left of its panel
BEFORE, AFTER = 0.08, 0.12  # of a beat's phases: what is shown besides
MANY = 2  # beats that are drawn one by one


def plot_phases(
    run: Trajectory, window: Sequence[float] | None = None, width: float = FULL, beats: list[Beat] | None = None
) -> Figure:
    """A figure `width` mm wide: left the whole window (s; default the last oscillation), then its last two beats at large.

    In a single column of text (less than 120 mm) only the beats. ValueError where no beat was recorded whole.
    """
    beats = beats or shown_beats(run, window, rubbed=False)
    span = (beats[0].start, beats[-1].end) if window is None else (float(window[0]), float(window[1]))
    span = (max(span[0], float(run.t[0])), min(span[1], float(run.t[-1])))
    large = beats[-MANY:]
    columns = [*([None] if width >= NARROW else []), *large]
    parts = with_anchor(run.scene)
    names = list(dict.fromkeys(name for name in (parts.wheel, parts.lever, parts.oscillator) if name))
    rows = 2 * len(names)
    height = TOP + rows * PANEL + FOOT
    made = figure(width, height)
    heading(made, run.scene.title, f"t = {span[0]:.4f} s to {span[1]:.4f} s")
    wide = (width - LEFT - RIGHT - (len(columns) - 1) * BETWEEN) / len(columns)
    for c, beat in enumerate(columns):
        left = LEFT + c * (wide + BETWEEN)
        panels = [panel(made, left, TOP + r * PANEL - 1.5, wide, PANEL - 5.0) for r in range(rows)]
        _column(panels, run, names, span if beat is None else around(beat, run), beat, beats, first=c == 0)
    return made


def around(beat: Beat, run: Trajectory) -> tuple[float, float]:
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
    beats: list[Beat],
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
            axes.plot(x, values, color=colour, linewidth=CURVE, solid_joinstyle="round", zorder=3)
            axes.set_xlim(1e3 * (span[0] - zero), 1e3 * (span[1] - zero))
            _numbers(axes, values)
            if first:
                axes.set_ylabel(unit, fontsize=SMALL, color=colour, weight="bold")
                axes.yaxis.set_label_coords(-LABEL_AT / _width(axes), 0.5)
    for axes in panels:
        for one in beats if beat is None else [beat]:
            shade(axes, (stage.phase for stage in one.stages), zero, grey=beat is None)
    for axes in panels[:-1]:
        axes.set_xticklabels([])
    stone = f", {beat.stages[0].pallet} stone" if beat is not None and beat.stages[0].pallet else ""
    words = f"ms after t = {zero:.4f} s" if beat is None else f"ms from {beat.first.removeprefix('beginning of the ')}{stone}"
    panels[-1].set_xlabel(words, fontsize=SMALL, labelpad=1.5)
    if beat is not None:
        name_above(panels[0], beat.stages, zero)


def _numbers(axes: Axes, values: Array) -> None:
    from matplotlib.ticker import MaxNLocator

    dress(axes)
    limits(axes, float(values.min()), float(values.max()), 0.1)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 5, 10]))
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 3, 5, 9, 10]))
    axes.ticklabel_format(useOffset=False)
    axes.tick_params(labelsize=SMALL)


def _width(axes: Axes) -> float:
    """Of a panel, mm."""
    return float(axes.get_window_extent().width) / axes.figure.dpi / MM
