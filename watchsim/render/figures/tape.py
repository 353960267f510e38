"""What does the paper of a timegrapher look like, and rate, amplitude and beat error over time?

plot_tape(run).savefig("tape.png")
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.tape import Tape, tape
from watchsim.analysis.verdicts.verdict import verdict
from watchsim.analysis.verdicts.words import BESIDE
from watchsim.render.palette import BLUED, BRASS, FAINT, GRID, INK, RUBY
from watchsim.simulation.record.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

PAPER = 20.0  # ms, the width of the paper where the dots do not stay within it
GUIDES = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0)  # s/d
STEEP = 0.5  # of the panel's height: what the guide may rise over its width
LEAST = (1.0, 1.0, 0.01)  # s/d, °, ms: a range smaller than this is not blown up


def plot_tape(run: Trajectory, window: Sequence[float] | None = None) -> Figure:
    """The paper of a timegrapher with a trace for each direction of swing, and below it rate, amplitude and beat error, beat by
    beat; a figure to save as PNG, SVG or PDF.

    window  (from, to) in seconds; default all beats. ValueError where no beat is heard in it.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    shown, inside = tape(run), slice(None)
    if window is not None:
        start, end = window
        first, last = np.searchsorted(shown.t, (start, end))
        inside = slice(int(first), int(last))
        if last <= first:
            known = f"the first comes at {shown.t[0]:.6g} s, the last at {shown.t[-1]:.6g} s"
            raise ValueError(f"no beat is heard from {start:.9g} s to {end:.9g} s: {known}")
    figure = Figure(figsize=(10.0, 8.4), dpi=150)
    FigureCanvasAgg(figure)
    panels = figure.subplots(4, 1, sharex=True, height_ratios=(2.6, 1.0, 1.0, 1.0))
    figure.subplots_adjust(left=0.09, right=0.90, top=0.90, bottom=0.07, hspace=0.22)
    figure.suptitle(run.scene.title, x=0.09, y=0.98, ha="left", va="top", fontsize=13, weight="bold", color=INK)
    beside = BESIDE.get(verdict(run).name or "")
    figure.text(
        0.09, 0.945, f"Paper of a timegrapher{f', {beside}' if beside else ''}", ha="left", va="top", fontsize=10, color=INK
    )
    _paper(panels[0], shown, inside)
    t, marks = shown.t[inside], _size(len(shown.t[inside]))
    for axes, values, label, least in zip(
        panels[1:],
        (shown.rate_s_per_d, shown.amplitude_deg, shown.beat_error_ms),
        ("rate (s/d)", "amplitude (°)", "beat error (ms)"),
        LEAST,
        strict=True,
    ):
        axes.plot(t, values[inside], ".", color=BLUED.line, markersize=marks, label="true")
        axes.set_ylabel(label, color=INK)
        _room(axes, values[inside], least)
    if np.isfinite(shown.shown_deg[inside]).any():
        panels[2].plot(t, shown.shown_deg[inside], ".", color=BRASS.line, markersize=marks, label="by lift angle")
        _room(panels[2], np.concatenate([shown.amplitude_deg[inside], shown.shown_deg[inside]]), LEAST[1])
        _legend(panels[2])
    for axes in panels:
        _dress(axes)
    panels[-1].set_xlabel("time (s)", color=INK)
    if len(t) > 1:
        side = 0.01 * float(t[-1] - t[0])
        panels[-1].set_xlim(float(t[0]) - side, float(t[-1]) + side)
    figure.align_ylabels(panels)
    return figure


def _paper(axes: Axes, shown: Tape, inside: slice) -> None:
    t, forward = shown.t[inside], shown.forward[inside]
    gain = shown.gain_ms[inside] - shown.gain_ms[inside][0]
    low, high = float(gain.min()), float(gain.max())
    wrapped = high - low > PAPER
    if wrapped:
        gain = np.mod(gain + 0.5 * PAPER, PAPER) - 0.5 * PAPER
        low, high = -0.5 * PAPER, 0.5 * PAPER
    room = 0.0 if wrapped else max(0.15 * (high - low), 0.05)
    axes.set_ylim(low - room, high + room)
    marks = _size(len(t))
    for way, colour, label in ((True, BLUED.line, "tick"), (False, RUBY.line, "tock")):
        axes.plot(t[forward == way], gain[forward == way], ".", color=colour, markersize=marks, label=label)
    axes.set_ylabel("gain (ms)", color=INK)
    words = "rising gains, falling loses"
    if wrapped:
        words += f"; the paper is {PAPER:g} ms wide, and what leaves it on one side comes back on the other"
    axes.set_title(words, loc="left", fontsize=9, color=FAINT)
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
        axes.plot([start, end], [middle, middle + rise], "--", color=FAINT, linewidth=0.8, zorder=0)
        text = f"{rate:+g} s/d".replace("-", "−") if rate else "0 s/d"
        axes.annotate(
            text,
            (end, middle + rise),
            (4, 0),
            textcoords="offset points",
            va="center",
            fontsize=9,
            color=FAINT,
            annotation_clip=False,
        )


def _room(axes: Axes, values: Array, least: float) -> None:
    from matplotlib.ticker import MaxNLocator

    values = values[np.isfinite(values)]
    if len(values):
        low, high = float(values.min()), float(values.max())
        room = max(0.1 * (high - low), 0.5 * (least - (high - low)))
        axes.set_ylim(low - room, high + room)
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 5, 10]))
    axes.ticklabel_format(axis="y", useOffset=False)


def _legend(axes: Axes) -> None:
    axes.legend(
        frameon=False, fontsize=9, loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=2, borderaxespad=0.0, markerscale=2.0
    )


def _dress(axes: Axes) -> None:
    axes.grid(True, color=GRID, linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=9)


def _size(count: int) -> float:
    """Of a dot, pt: smaller where there are many."""
    return 5.0 if count < 150 else 3.5 if count < 1000 else 2.0
