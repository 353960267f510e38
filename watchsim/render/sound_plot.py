"""How does a beat sound, and which noise is whose?

plot_sound(run).savefig("sound.pdf")
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from watchsim.analysis.sound import TONES, blows
from watchsim.render import style
from watchsim.render.force_plot import beat_spans
from watchsim.render.marks import clock
from watchsim.render.part_names import Met
from watchsim.render.phase_plots import name_key, names_in, shade
from watchsim.render.rows import reduced
from watchsim.render.view import Window
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.storage.columns import rows_where

LEFT, RIGHT, KEY, TALL, FOOT = 13.0, 3.0, 5.0, 24.0, 7.0  # mm
RUNG_OUT = 6e-3  # s, after which nothing of a noise is seen
FAINT = 0.02  # of the loudest: softer ones have no name
NAMED = 3  # rows of names above a panel
LINE = 3.2  # mm, of a row of names
GAP = 1.5  # mm between names, and between a name and the line of another
FINEST, MOST = 96_000.0, 400_000  # samples a second, and in all


def plot_sound(
    run: Trajectory, window: Sequence[float] | None = None, width: float = style.FULL, ax: Axes | None = None
) -> Figure:
    """The sound of a beat as an oscilloscope shows it, each noise named by what met what, over the phases.

    Each impact rings as in `watchsim.sound`, as loud as the root of the energy it loses; 1 is the loudest noise shown.

    window  (from, to) in seconds; default the last two beats without their free oscillation, or where there are none the last
            oscillation, or all of the last stretch recorded

    ValueError where no impact was kept there.
    """
    cycle = style.shown(run, window)
    spans = [cycle.window] if window is not None else beat_spans(run, cycle)
    heard = [blows(run, span[0] - RUNG_OUT, span[1]) for span in spans]
    loudest = max((float(energies.max(initial=0.0)) for _, energies in heard), default=0.0)
    if loudest <= 0.0:
        raise ValueError("nothing sounds there, or no impacts were kept")
    names = names_in(cycle.phases)
    clocks, wide = [clock(span) for span in spans], width - LEFT - RIGHT
    labels = []
    rung = [(times, np.sqrt(np.maximum(energies, 0.0) / loudest)) for times, energies in heard]
    for span, time, (times, loud) in zip(spans, clocks, rung, strict=True):
        low, high = map(time.at, span)
        shown = times >= span[0]
        labels.append(_rows(wide * (time.at(times[shown]) - low) / (high - low), loud[shown], _met(run, times[shown]), wide))
    rows = 1 + max((row for own in labels for row, *_ in own), default=0)
    top, over = style.HEADING + KEY * bool(names), rows * LINE + 1.0
    made = style.figure(width, top + len(spans) * (over + TALL + FOOT), ax=ax)
    style.heading(made, run.scene.title, "Sound of the impacts, each named by what met what")
    if names:
        name_key(made, names, style.HEADING)
    for k, (span, time, (times, loud)) in enumerate(zip(spans, clocks, rung, strict=True)):
        axes = style.panel(made, LEFT, top + over + k * (over + TALL + FOOT), wide, TALL)
        style.dress(axes, "x")
        t, wave = _wave(times, loud, span)
        axes.plot(*reduced(time.at(t), wave), linewidth=style.THIN, color=style.INK, zorder=3, gid=f"sound {k}")
        axes.set_xlim(*map(time.at, span))
        style.limits(axes, -1.0, 1.0)
        for beat in cycle.phases:
            if beat[-1].end > span[0] and beat[0].start < span[1]:
                shade(axes, beat, time.base, time.factor)
        _name(axes, labels[k], wide)
        axes.set_ylabel("relative", labelpad=1.5)
        axes.set_xlabel(time.label, labelpad=1.5)
        style.ticks(axes.yaxis, 4)
    return made


def _wave(times: Array, loud: Array, span: Window) -> tuple[Array, Array]:
    """Instants (s) of a stretch, and the sum of all that rings there."""
    count = int(min(FINEST * (span[1] - span[0]), MOST)) + 2
    t = np.linspace(*span, count)
    out = np.zeros(count)
    for begun, strength in zip(times.tolist(), loud.tolist(), strict=True):
        own = slice(*np.searchsorted(t, (begun, begun + RUNG_OUT)))
        since = t[own] - begun
        for hertz, decay, share in TONES:
            out[own] += strength * share * np.exp(-since / decay) * np.cos(2.0 * np.pi * hertz * since)
    return t, out


def _met(run: Trajectory, times: Array) -> list[str]:
    """What met what at those instants: the pair that lost most energy in an impact."""
    events = rows_where(run.events, lambda part: (part["kind"] == EventKind.IMPACT) & np.isin(part["t"], times))
    found, met = [], Met(run)
    for t in times.tolist():
        own = events[events["t"] == t]
        found.append(met.words(int(own["contact"][np.argmax(own["energy_lost"])]), t))
    return found


Label = tuple[int, float, float, float, str]  # row, from, to, and where the line is, mm; words


def _rows(places: Array, loud: Array, words: Sequence[str], wide: float) -> list[Label]:
    """Names above a panel, the loudest first, as many as fit; no name over another, and no line through one. All in mm."""
    letter = style.LETTER * style.SMALL * style.POINT
    taken: list[Label] = []
    for k in np.argsort(-loud, kind="stable").tolist():
        if loud[k] < FAINT:
            break
        at, long = float(places[k]), letter * len(words[k])
        begin = min(max(at - 1.0, 0.0), wide - long)
        row = next((row for row in range(NAMED) if _fits(row, begin, begin + long, at, taken)), None)
        if row is not None:
            taken.append((row, begin, begin + long, at, words[k]))
    return taken


def _name(axes: Axes, labels: Sequence[Label], wide: float) -> None:
    tall = style.height_mm(axes)
    for row, begin, _, at, words in labels:
        height = 1.0 + (1.0 + row * LINE) / tall
        style.words(axes, begin / wide, height, words, va="bottom")
        axes.plot(
            [at / wide] * 2, [1.0, height], transform=axes.transAxes, color=style.INK, linewidth=style.HAIR, clip_on=False
        )


def _fits(row: int, begin: float, end: float, at: float, taken: Sequence[Label]) -> bool:
    for other, start, stop, line, _ in taken:
        if other == row and begin < stop + GAP and end > start - GAP:
            return False
        if other > row and begin - GAP < line < end + GAP:
            return False  # the line of a name above would run through this one
        if other < row and start - GAP < at < stop + GAP:
            return False
    return True
