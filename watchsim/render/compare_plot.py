"""Several runs over each other: amplitude over time, the last swing of each oscillator, the papers of their timegraphers."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from watchsim.analysis.timegrapher import tape
from watchsim.analysis.timing import beats
from watchsim.render import style
from watchsim.render.rows import reduced
from watchsim.scene.roles import swings
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.studies.compare import Comparison

LEFT, RIGHT, TALL, BETWEEN, FOOT, KEY = 16.0, 4.0, 40.0, 12.0, 2.0, 6.0  # mm
COLUMNS, POINTS = 1500, 400  # of dots in a panel; of a swing
OVER = 1.0  # period, of the last swing that is shown

Curve = Callable[[Trajectory], tuple[Array, Array]]


def plot_comparison(found: Comparison, width: float = style.FULL, ax: Axes | None = None) -> Figure:
    """A panel for each of them with a colour for each run; a figure `width` mm wide to save as PNG, SVG or PDF.

    ValueError where nothing swings in any of the runs, or scenes were not run (`watchsim.studies.compare.with_run`).
    """
    runs = [(side.name, side.run) for side in found.sides if side.run is not None and swings(side.run.scene)]
    if not runs:
        raise ValueError("only runs in which something swings can be drawn over each other")
    rows: tuple[tuple[str, str, Curve, str], ...] = (
        ("amplitude (°)", "time (s)", _amplitude, "."),
        ("angle, last oscillation (°)", "time since the rest position (ms)", _last, "-"),
        ("gain (ms)", "time (s)", _gain, "."),
    )
    made = style.figure(width, style.HEADING + KEY + len(rows) * (TALL + BETWEEN) + FOOT, ax=ax)
    style.heading(made, runs[0][1].scene.title, " and ".join(name for name, _ in runs))
    for k, (label, along, curve, look) in enumerate(rows):
        top = style.HEADING + KEY + k * (TALL + BETWEEN)
        axes = style.panel(made, LEFT, top, width - LEFT - RIGHT, TALL)
        _curves(axes, runs, curve, look)
        style.dress(axes)
        axes.ticklabel_format(useOffset=False)
        axes.set_ylabel(label)
        axes.set_xlabel(along, labelpad=1.5)
        if k == 0:
            handles, labels = axes.get_legend_handles_labels()
            place = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.0}
            style.key(axes, list(zip(handles, labels, strict=True)), ncols=len(runs), markerscale=2.0, **place)
    return made


def _curves(axes: Axes, runs: list[tuple[str, Trajectory]], curve: Curve, look: str) -> None:
    for number, (name, x, y) in enumerate(_known(runs, curve)):
        colour = style.SERIES[number % len(style.SERIES)]
        axes.plot(*reduced(x, y, COLUMNS), look, color=colour, label=name, gid=name, linewidth=style.CURVE, markersize=2.6)


def _known(runs: list[tuple[str, Trajectory]], curve: Curve) -> Iterator[tuple[str, Array, Array]]:
    for name, run in runs:
        try:
            yield name, *curve(run)
        except ValueError:  # no beat is heard, or there is no whole swing
            yield name, np.zeros(0), np.zeros(0)


def _amplitude(run: Trajectory) -> tuple[Array, Array]:
    found = beats(run)
    return found.t, found.amplitude_deg


def _last(run: Trajectory) -> tuple[Array, Array]:
    """From the last upward passage that has a whole period after it."""
    found = beats(run)
    upward = found.t[(found.end_at > found.start_at) & (found.t + OVER * found.nominal_period <= run.simulated)]
    if not len(upward):
        raise ValueError("no whole oscillation")
    since = np.linspace(0.0, OVER * found.nominal_period, POINTS)
    column = run.slices[found.body].start
    return 1e3 * since, np.degrees(run.positions(upward[-1] + since, [column])[:, 0])


def _gain(run: Trajectory) -> tuple[Array, Array]:
    shown = tape(run)
    return shown.t, shown.gain_ms - shown.gain_ms[0]
