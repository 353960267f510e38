"""How do amplitude, rate and beat error change over time, and what does the paper of a timegrapher look like?

plot_timing(run).savefig("timing.pdf")
plot_tape(run).savefig("tape.png")
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from watchsim.analysis.timegrapher import Tape, tape
from watchsim.analysis.timing import Beats, beats
from watchsim.analysis.verdict import verdict
from watchsim.analysis.verdict_kinds import BESIDE
from watchsim.render import style
from watchsim.render.palette import FAINT
from watchsim.render.rows import reduced
from watchsim.simulation.trajectory import Array, Trajectory

LEFT, FOOT = 14.0, 8.0  # mm
LABEL_AT = LEFT - 3.5  # mm, of the label left of its panel
COLUMNS = 1500  # of dots in a panel
SWINGS_RIGHT, SWINGS_TALL, SWINGS_BETWEEN, SWINGS_KEY = 4.0, 24.0, 3.5, 4.0  # mm
BIGGER = 1.9  # dots of one direction, so that those of the other do not hide them
SHARE = 0.02  # of the largest amplitude: a smaller range of them is not magnified
KEY_DOT = 2.4  # pt, of a dot in the key
TAPE_RIGHT, TAPE_TALL, TAPE_BETWEEN, TAPE_KEY, PAPER_TALL = 12.0, 22.0, 5.0, 5.0, 55.0  # mm
PAPER = 20.0  # ms, the width of the paper where the dots do not stay within it
GUIDES = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0)  # s/d
STEEP = 0.5  # of the panel's height: what the guide may rise over its width


def plot_timing(
    run: Trajectory, window: Sequence[float] | None = None, width: float = style.FULL, ax: Axes | None = None
) -> Figure:
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
    step, top = SWINGS_TALL + SWINGS_BETWEEN, style.HEADING + SWINGS_KEY
    made = style.figure(width, top + 3.0 * step + FOOT, ax=ax)
    style.heading(made, run.scene.title, f"{found.body}, {len(inside)} half swings{_beside(run)}")
    wide, size = width - LEFT - SWINGS_RIGHT, _dot(len(inside))
    panels = [style.panel(made, LEFT, top + k * step, wide, SWINGS_TALL) for k in range(3)]
    # Label, values, and the range that is not magnified further.
    swing = ("amplitude (°)", found.amplitude_deg, 1.0) if found.angular else ("amplitude (mm)", 1e3 * found.amplitude, 0.01)
    swing = (*swing[:2], _finer(swing[1], swing[2]))
    rows = (swing, ("rate (s/d)", found.rate_s_per_d, 1.0), ("beat error (ms)", found.beat_error_ms, 0.01))
    for axes, (label, values, least) in zip(panels, rows, strict=True):
        style.dress(axes)
        handles = _swings(axes, found, inside, values, label.split(" (")[0], size)
        axes.set_ylabel(label, labelpad=1.5)
        axes.yaxis.set_label_coords(-LABEL_AT / wide, 0.5)
        _room(axes, values[inside], least)
        if axes is panels[0]:
            _key(axes, handles, "left", KEY_DOT / size)
    _over_time(panels, found.t[inside], found.nominal_period)
    return made


def _swings(
    axes: Axes, found: Beats, inside: NDArray[np.int64], values: Array, name: str, size: float
) -> list[tuple[Any, str]]:
    """A dot for each half swing, in the colour and shape of its direction."""
    handles = []
    forward = (found.end_at > found.start_at)[inside]
    for way, number, mark, label, bigger in ((forward, 0, "o", "forward", BIGGER), (~forward, 1, "s", "back", 1.0)):
        own = inside[way]
        handles.append((_dots(axes, found.t[own], values[own], mark, number, bigger * size, f"{name} {label}"), label))
    return handles


def plot_tape(
    run: Trajectory, window: Sequence[float] | None = None, width: float = style.FULL, ax: Axes | None = None
) -> Figure:
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
    return tape_figure(shown, run.scene.title, f"Paper of a timegrapher{_beside(run)}", inside, width, ax)


def tape_figure(
    shown: Tape, title: str, about: str, inside: slice = slice(None), width: float = style.FULL, ax: Axes | None = None
) -> Figure:
    """The same of any tape, such as that of a recording, which has no true amplitude."""
    top, step = style.HEADING + TAPE_KEY, TAPE_TALL + TAPE_BETWEEN
    rows = [("rate (s/d)", shown.rate_s_per_d, 1.0), ("amplitude (°)", shown.amplitude_deg, _finer(shown.amplitude_deg, 1.0)),
            ("beat error (ms)", shown.beat_error_ms, 0.01)]  # fmt: skip
    read = shown.shown_deg[inside]
    if not np.isfinite(np.concatenate([shown.amplitude_deg[inside], read])).any():
        del rows[1]
    made = style.figure(width, top + PAPER_TALL + len(rows) * step + FOOT, ax=ax)
    style.heading(made, title, about)
    wide = width - LEFT - TAPE_RIGHT
    places = [(top, PAPER_TALL), *((top + PAPER_TALL + TAPE_BETWEEN + k * step, TAPE_TALL) for k in range(len(rows)))]
    panels = [style.panel(made, LEFT, up, wide, tall) for up, tall in places]
    for axes in panels:
        style.dress(axes)
        axes.yaxis.set_label_coords(-LABEL_AT / wide, 0.5)
    t = shown.t[inside]
    size = _dot(len(t))
    _paper(panels[0], shown, inside, size)
    for axes, (label, values, least) in zip(panels[1:], rows, strict=True):
        _dots(axes, t, values[inside], "o", 0, size, label, "true")
        axes.set_ylabel(label)
        _room(axes, values[inside], least)
    if np.isfinite(read).any():
        _dots(panels[2], t, read, "s", 4, size, "amplitude shown", "by lift angle")
        _room(panels[2], np.concatenate([shown.amplitude_deg[inside], read]), 1.0)
        _key(panels[2], list(zip(*panels[2].get_legend_handles_labels(), strict=True)), "right", 1.8)
    _over_time(panels, t, shown.nominal_period)
    return made


def _paper(axes: Axes, shown: Tape, inside: slice, size: float) -> None:
    t, forward = shown.t[inside], shown.forward[inside]
    gain = shown.gain_ms[inside] - shown.gain_ms[inside][0]
    low, high = float(gain.min()), float(gain.max())
    side, words = max(0.15 * (high - low), 0.05), "rising gains, falling loses"
    if high - low > PAPER:
        gain = np.mod(gain + 0.5 * PAPER, PAPER) - 0.5 * PAPER
        low, high, side, words = -0.5 * PAPER, 0.5 * PAPER, 0.0, f"{PAPER:g} ms wide, wrapped round"
    axes.set_ylim(low - side, high + side)
    for way, number, mark, label in ((forward, 0, "o", "tick"), (~forward, 1, "s", "tock")):
        _dots(axes, t[way], gain[way], mark, number, size, label, label)
    axes.set_ylabel("gain (ms)")
    axes.set_title(words, loc="left", fontsize=style.SMALL, color=FAINT, y=1.0, pad=3.0)
    _key(axes, list(zip(*axes.get_legend_handles_labels(), strict=True)), "right", 1.8)
    _guides(axes, float(t[0]), float(t[-1]))


def _guides(axes: Axes, start: float, end: float) -> None:
    """Slopes of round rates from the middle of the paper's left side."""
    low, high = axes.get_ylim()
    fitting = [rate for rate in GUIDES if 1e3 * rate / 86400.0 * (end - start) <= STEEP * (high - low)]
    middle = 0.5 * (low + high)
    for rate in (fitting[-1], 0.0, -fitting[-1]) if fitting else ():
        rise = 1e3 * rate / 86400.0 * (end - start)
        axes.plot([start, end], [middle, middle + rise], "--", color=FAINT, linewidth=style.HAIR, zorder=0)
        text = style.minus(f"{rate:+g} s/d") if rate else "0 s/d"
        style.note(axes, text, (end, middle + rise), (3, 0), va="center", color=FAINT, annotation_clip=False)


def _beside(run: Trajectory) -> str:
    """What else is wrong with the run that its curves do not say."""
    beside = BESIDE.get(verdict(run).name or "")
    return f", {beside}" if beside else ""


def _dot(count: int) -> float:
    """Of a dot, pt: smaller where there are many."""
    return 2.6 if count < 150 else 1.8 if count < 1000 else 1.2


def _dots(axes: Axes, x: Array, y: Array, mark: str, number: int, size: float, gid: str, label: str | None = None) -> Any:
    """In colour `number`; of many those that differ on paper."""
    look: dict[str, Any] = {"color": style.SERIES[number], "markersize": size, "markeredgewidth": 0.0}
    return axes.plot(*reduced(x, y, COLUMNS), mark, gid=gid, label=label, **look)[0]


def _finer(amplitudes: Array, least: float) -> float:
    """The range of amplitudes that is not magnified further: of a pendulum a share of its few degrees."""
    known = amplitudes[np.isfinite(amplitudes)]
    return min(least, SHARE * float(known.max())) if len(known) else least


def _room(axes: Axes, values: Array, least: float) -> None:
    """Limits around the values, no closer than `least`."""
    values = values[np.isfinite(values)]
    if len(values):
        low, high = float(values.min()), float(values.max())
        side = max(0.1 * (high - low), 0.5 * (least - (high - low)))
        axes.set_ylim(low - side, high + side)
    style.ticks(axes.yaxis, 4)
    axes.ticklabel_format(axis="y", useOffset=False)


def _over_time(panels: Sequence[Axes], t: Array, nominal_period: float) -> None:
    """One time axis for all panels, named below the last."""
    side = 0.01 * float(t[-1] - t[0]) or 0.5 * nominal_period
    for axes in panels:
        axes.set_xlim(float(t[0]) - side, float(t[-1]) + side)
    for axes in panels[:-1]:
        axes.set_xticklabels([])
    panels[-1].set_xlabel("time (s)", labelpad=1.5)


def _key(axes: Axes, entries: Sequence[tuple[Any, str]], side: str, scale: float) -> None:
    """Above a panel, on that side."""
    where: dict[str, Any] = {"loc": f"lower {side}", "bbox_to_anchor": (float(side == "right"), 1.0), "borderaxespad": 0.0}
    style.key(axes, entries, ncols=2, markerscale=scale, **where)
