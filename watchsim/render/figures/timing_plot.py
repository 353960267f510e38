"""How do amplitude, rate and beat error change over time?

plot_timing(run).savefig("timing.pdf")
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.beats import Beats, beats
from watchsim.analysis.verdicts.verdict import verdict
from watchsim.analysis.verdicts.verdict_kinds import BESIDE
from watchsim.render.figures.column_extremes import reduced
from watchsim.render.figures.figure_style import FULL, HEADING, SERIES, dress, figure, heading, key, panel
from watchsim.simulation.record.trajectory import Array, Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEFT, RIGHT, TALL, BETWEEN, FOOT, KEY = 14.0, 4.0, 24.0, 3.5, 8.0, 4.0  # mm
LEAST = {"amplitude": (1.0, 0.01), "rate": (1.0, 1.0), "beat error": (0.01, 0.01)}  # a smaller range is not blown up: °, mm; …
COLUMNS = 1500  # of dots in a panel
BIGGER = 1.9  # dots of one direction, so that those of the other do not hide them
KEY_DOT = 2.4  # pt, of a dot in the key


def plot_timing(run: Trajectory, window: Sequence[float] | None = None, width: float = FULL) -> Figure:
    """Amplitude of every half swing, rate of every oscillation, and beat error, of whatever swings.

    window  (from, to) in seconds; default the whole run

    Dots of the two directions differ in colour and shape. ValueError where nothing swings, or not once in the window.
    """
    found = beats(run)
    start, end = (0.0, run.simulated) if window is None else (float(window[0]), float(window[1]))
    inside = np.flatnonzero((found.t >= start) & (found.t <= end))
    if len(inside) == 0:
        known = f"; the first comes at {found.t[0]:.6g} s, the last at {found.t[-1]:.6g} s" if len(found) else ""
        raise ValueError(f"no whole half swing of {found.body} lies from {start:.9g} s to {end:.9g} s{known}")
    made = figure(width, HEADING + KEY + 3.0 * (TALL + BETWEEN) + FOOT)
    beside = BESIDE.get(verdict(run).name or "")
    heading(made, run.scene.title, f"{found.body}, {len(inside)} half swings{f', {beside}' if beside else ''}")
    curves = _curves(found)
    handles: list[tuple[Any, str]] = []
    panels = []
    for k, (name, (label, values)) in enumerate(curves.items()):
        axes = panel(made, LEFT, HEADING + KEY + k * (TALL + BETWEEN), width - LEFT - RIGHT, TALL)
        dress(axes)
        shown = _dots(axes, found, inside, values, name)
        handles = handles or shown
        axes.set_ylabel(label, labelpad=1.5)
        axes.yaxis.set_label_coords(-(LEFT - 3.5) / (width - LEFT - RIGHT), 0.5)
        room(axes, values[inside], LEAST[name][0 if found.angular else 1])
        side = 0.01 * (found.t[inside[-1]] - found.t[inside[0]]) or 0.5 * found.nominal_period
        axes.set_xlim(found.t[inside[0]] - side, found.t[inside[-1]] + side)
        panels.append(axes)
    for axes in panels[:-1]:
        axes.set_xticklabels([])
    panels[-1].set_xlabel("time (s)", labelpad=1.5)
    key(
        panels[0],
        handles,
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=2,
        borderaxespad=0.0,
        markerscale=KEY_DOT / dot(len(inside)),
    )
    return made


def _curves(found: Beats) -> dict[str, tuple[str, Array]]:
    swing = ("amplitude (°)", found.amplitude_deg) if found.angular else ("amplitude (mm)", 1e3 * found.amplitude)
    return {
        "amplitude": swing,
        "rate": ("rate (s/d)", found.rate_s_per_d),
        "beat error": ("beat error (ms)", found.beat_error_ms),
    }


def _dots(axes: Axes, found: Beats, inside: NDArray[np.int64], values: Array, name: str) -> list[tuple[Any, str]]:
    """A dot for each half swing, in the colour and shape of its direction; of many those that differ on paper."""
    handles = []
    forward = found.end_at > found.start_at
    size = dot(len(inside))
    directions = ((True, SERIES[0], "o", "forward", BIGGER), (False, SERIES[1], "s", "back", 1.0))
    for way, colour, mark, label, bigger in directions:
        own = inside[forward[inside] == way]
        x, y = reduced(found.t[own], values[own], COLUMNS)
        gid = f"{name} {label}"
        look: dict[str, Any] = {"color": colour, "markersize": bigger * size, "markeredgewidth": 0.0, "gid": gid}
        handles.append((axes.plot(x, y, mark, **look)[0], label))
    return handles


def dot(count: int) -> float:
    """Of a dot, pt: smaller where there are many."""
    return 2.6 if count < 150 else 1.8 if count < 1000 else 1.2


def room(axes: Axes, values: Array, least: float) -> None:
    """Limits around the values, no closer than `least`."""
    from matplotlib.ticker import MaxNLocator

    values = values[np.isfinite(values)]
    if len(values):
        low, high = float(values.min()), float(values.max())
        side = max(0.1 * (high - low), 0.5 * (least - (high - low)))
        axes.set_ylim(low - side, high + side)
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 5, 10]))
    axes.ticklabel_format(axis="y", useOffset=False)
