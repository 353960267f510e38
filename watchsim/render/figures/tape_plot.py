"""What does the paper of a timegrapher look like, and rate, amplitude and beat error over time?

plot_tape(run).savefig("tape.png")
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from watchsim.analysis.tape import Tape, tape
from watchsim.analysis.verdicts.verdict import verdict
from watchsim.analysis.verdicts.verdict_kinds import BESIDE
from watchsim.render.figures.column_extremes import reduced
from watchsim.render.figures.figure_style import FULL, HAIR, HEADING, SERIES, SMALL, dress, figure, heading, key, panel
from watchsim.render.figures.timing_plot import COLUMNS, dot, room
from watchsim.render.palette import FAINT
from watchsim.simulation.record.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PAPER = 20.0  # ms, the width of the paper where the dots do not stay within it
GUIDES = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0)  # s/d
STEEP = 0.5  # of the panel's height: what the guide may rise over its width
LEFT, RIGHT, PAPER_TALL, TALL, BETWEEN, FOOT, KEY = 14.0, 12.0, 55.0, 22.0, 5.0, 8.0, 5.0  # mm
LEAST = (1.0, 1.0, 0.01)  # s/d, °, ms: a range smaller than this is not blown up


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
    made = figure(width, HEADING + KEY + PAPER_TALL + 3.0 * (TALL + BETWEEN) + FOOT)
    beside = BESIDE.get(verdict(run).name or "")
    heading(made, run.scene.title, f"Paper of a timegrapher{f', {beside}' if beside else ''}")
    wide = width - LEFT - RIGHT
    tops = [HEADING + KEY, *(HEADING + KEY + PAPER_TALL + BETWEEN + k * (TALL + BETWEEN) for k in range(3))]
    panels = [panel(made, LEFT, top, wide, PAPER_TALL if k == 0 else TALL) for k, top in enumerate(tops)]
    for axes in panels:
        dress(axes)
        axes.yaxis.set_label_coords(-(LEFT - 3.5) / wide, 0.5)
    _paper(panels[0], shown, inside)
    t, marks = shown.t[inside], dot(len(shown.t[inside]))
    for axes, values, label, least in zip(
        panels[1:],
        (shown.rate_s_per_d, shown.amplitude_deg, shown.beat_error_ms),
        ("rate (s/d)", "amplitude (°)", "beat error (ms)"),
        LEAST,
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
        room(panels[2], np.concatenate([shown.amplitude_deg[inside], read]), LEAST[1])
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
