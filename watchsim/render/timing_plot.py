"""What does the paper of a timegrapher look like, and rate, amplitude and beat error over time?

plot_tape(run).savefig("tape.png")
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timegrapher import Tape, tape
from watchsim.analysis.timing import Beats, beats
from watchsim.analysis.verdict import verdict
from watchsim.analysis.verdict_kinds import BESIDE
from watchsim.render.palette import FAINT
from watchsim.render.rows import reduced
from watchsim.render.style import FULL, HAIR, HEADING, SERIES, SMALL, dress, figure, heading, key, panel
from watchsim.simulation.trajectory import Array, Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


# How do amplitude, rate and beat error change over time?
#
# plot_timing(run).savefig("timing.pdf")

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


# What does the paper of a timegrapher look like, and rate, amplitude and beat error over time?

PAPER = 20.0  # ms, the width of the paper where the dots do not stay within it
GUIDES = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0)  # s/d
STEEP = 0.5  # of the panel's height: what the guide may rise over its width
LEFT_TAPE_PLOT, RIGHT_TAPE_PLOT, PAPER_TALL, TALL_TAPE_PLOT, BETWEEN_TAPE_PLOT, FOOT_TAPE_PLOT, KEY_TAPE_PLOT = (
    14.0,
    12.0,
    55.0,
    22.0,
    5.0,
    8.0,
    5.0,
)  # mm
LEAST_TAPE_PLOT = (1.0, 1.0, 0.01)  # s/d, °, ms: a range smaller than this is not blown up


def plot_tape(run: Trajectory, window: Sequence[float] | None = None, width: float = FULL) -> Figure:
    """The paper of a timegrapher with a trace for each direction of swing, and below it rate, amplitude and beat error, beat by
    beat; a figure `width` mm wide to save as PNG, SVG or PDF.

    window  (from, to) in seconds; default all beats. ValueError where no beat is heard in it.
    """
    shown, inside = tape(run), slice(None)
    if window is not None:
        start, end = window
        first, last = np.searchsorted(shown.t, (start, end))
        inside = slice(int(first), int(last))
        if last <= first:
            known = f"the first comes at {shown.t[0]:.6g} s, the last at {shown.t[-1]:.6g} s"
            raise ValueError(f"no beat is heard from {start:.9g} s to {end:.9g} s: {known}")
    made = figure(width, HEADING + KEY_TAPE_PLOT + PAPER_TALL + 3.0 * (TALL_TAPE_PLOT + BETWEEN_TAPE_PLOT) + FOOT_TAPE_PLOT)
    beside = BESIDE.get(verdict(run).name or "")
    heading(made, run.scene.title, f"Paper of a timegrapher{f', {beside}' if beside else ''}")
    wide = width - LEFT_TAPE_PLOT - RIGHT_TAPE_PLOT
    tops = [
        HEADING + KEY_TAPE_PLOT,
        *(
            HEADING + KEY_TAPE_PLOT + PAPER_TALL + BETWEEN_TAPE_PLOT + k * (TALL_TAPE_PLOT + BETWEEN_TAPE_PLOT)
            for k in range(3)
        ),
    ]
    panels = [panel(made, LEFT_TAPE_PLOT, top, wide, PAPER_TALL if k == 0 else TALL_TAPE_PLOT) for k, top in enumerate(tops)]
    for axes in panels:
        dress(axes)
        axes.yaxis.set_label_coords(-(LEFT_TAPE_PLOT - 3.5) / wide, 0.5)
    _paper(panels[0], shown, inside)
    t, marks = shown.t[inside], dot(len(shown.t[inside]))
    for axes, values, label, least in zip(
        panels[1:],
        (shown.rate_s_per_d, shown.amplitude_deg, shown.beat_error_ms),
        ("rate (s/d)", "amplitude (°)", "beat error (ms)"),
        LEAST_TAPE_PLOT,
        strict=True,
    ):
        look: dict[str, Any] = {"color": SERIES[0], "markersize": marks, "markeredgewidth": 0.0}
        axes.plot(*reduced(t, values[inside], COLUMNS), "o", label="true", gid=label, **look)
        axes.set_ylabel(label)
        room(axes, values[inside], least)
    if np.isfinite(shown.shown_deg[inside]).any():
        look = {"color": SERIES[4], "markersize": marks, "markeredgewidth": 0.0}
        read = shown.shown_deg[inside]
        panels[2].plot(*reduced(t, read, COLUMNS), "s", label="by lift angle", gid="amplitude shown", **look)
        room(panels[2], np.concatenate([shown.amplitude_deg[inside], read]), LEAST_TAPE_PLOT[1])
        _legend(panels[2])
    for axes in panels[:-1]:
        axes.set_xticklabels([])
    panels[-1].set_xlabel("time (s)", labelpad=1.5)
    side = 0.01 * float(t[-1] - t[0]) if len(t) > 1 else 0.5 * shown.nominal_period
    for axes in panels:
        axes.set_xlim(float(t[0]) - side, float(t[-1]) + side)
    return made


def _paper(axes: Axes, shown: Tape, inside: slice) -> None:
    t, forward = shown.t[inside], shown.forward[inside]
    gain = shown.gain_ms[inside] - shown.gain_ms[inside][0]
    low, high = float(gain.min()), float(gain.max())
    wrapped = high - low > PAPER
    if wrapped:
        gain = np.mod(gain + 0.5 * PAPER, PAPER) - 0.5 * PAPER
        low, high = -0.5 * PAPER, 0.5 * PAPER
    side = 0.0 if wrapped else max(0.15 * (high - low), 0.05)
    axes.set_ylim(low - side, high + side)
    marks = dot(len(t))
    for way, colour, mark, label in ((True, SERIES[0], "o", "tick"), (False, SERIES[1], "s", "tock")):
        look: dict[str, Any] = {"color": colour, "markersize": marks, "markeredgewidth": 0.0, "label": label, "gid": label}
        axes.plot(*reduced(t[forward == way], gain[forward == way], COLUMNS), mark, **look)
    axes.set_ylabel("gain (ms)")
    words = "rising gains, falling loses"
    if wrapped:
        words = f"{PAPER:g} ms wide, wrapped round"
    axes.set_title(words, loc="left", fontsize=SMALL, color=FAINT, y=1.0, pad=3.0)
    _legend(axes)
    _guides(axes, float(t[0]), float(t[-1]))


def _guides(axes: Axes, start: float, end: float) -> None:
    """Slopes of round rates from the middle of the paper's left side."""
    low, high = axes.get_ylim()
    reach = STEEP * (high - low)
    fitting = [rate for rate in GUIDES if 1e3 * rate / 86400.0 * (end - start) <= reach]
    if not fitting:
        return
    middle = 0.5 * (low + high)
    for rate in (fitting[-1], 0.0, -fitting[-1]):
        rise = 1e3 * rate / 86400.0 * (end - start)
        axes.plot([start, end], [middle, middle + rise], "--", color=FAINT, linewidth=HAIR, zorder=0)
        text = f"{rate:+g} s/d".replace("-", "−") if rate else "0 s/d"
        axes.annotate(
            text,
            (end, middle + rise),
            (3, 0),
            textcoords="offset points",
            va="center",
            fontsize=SMALL,
            color=FAINT,
            annotation_clip=False,
        )


def _legend(axes: Axes) -> None:
    handles, names = axes.get_legend_handles_labels()
    where: dict[str, Any] = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "ncols": 2, "borderaxespad": 0.0}
    key(axes, list(zip(handles, names, strict=True)), markerscale=1.8, **where)
