"""How are the phases of a beat shown in a plot: bands behind the curves, and their names?

plot_phases(run).savefig("phases.pdf") draws wheel, lever and balance through the phases: angles and angular velocities.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from watchsim.analysis.phases import Phase
from watchsim.analysis.timeline import Beat, Stage, shown_beats, title
from watchsim.render import style
from watchsim.render.palette import ELSE, FAINT, INK, PHASE_LINES, PHASES, SECOND, looks
from watchsim.render.view import dense
from watchsim.scene.roles import with_anchor
from watchsim.simulation.trajectory import Array, Trajectory

SWATCH, GAP = 2.6, 1.0  # mm
APART = 3.5  # mm, from one name to the next swatch


def bands(phases: Iterable[Phase]) -> list[tuple[Phase, str]]:
    """The phases of one beat that are shaded, each with its colour."""
    found, impulses = [], 0
    for phase in phases:
        if phase.name == "locked":
            continue
        impulses += phase.name == "impulse"
        colour = SECOND if phase.name == "impulse" and impulses == 2 else PHASES.get(phase.name, ELSE)
        found.append((phase, colour))
    return found


def strong(name: str) -> str:
    """The colour of a phase where it is a curve."""
    return PHASE_LINES.get(name, FAINT)


def beat_name(beat: Beat) -> str:
    """Its number and the stone that acts in it."""
    stone = beat.stages[0].pallet
    return f"beat {beat.stages[0].beat}{f', {stone} stone' if stone else ''}"


def shade(axes: Axes, phases: Iterable[Phase], zero: float = 0.0, factor: float = 1e3, grey: bool = False) -> None:
    """A band for each phase of one beat, at (time - zero)·factor; the limits of the axes stay as they are."""
    place = axes.get_xaxis_transform(which="grid")
    for phase, colour in bands(phases):
        start, end = factor * (phase.start - zero), factor * (phase.end - zero)
        look: dict[str, Any] = {"color": "#dddddd" if grey else colour, "linewidth": 0.0, "zorder": 0, "transform": place}
        axes.add_artist(Rectangle((start, 0.0), end - start, 1.0, **look))


def name_above(axes: Axes, stages: Sequence[Stage], zero: float, factor: float = 1e3) -> None:
    """Names above the panel, spread where phases are short, with a line to the middle of each."""
    low, high = axes.get_xlim()
    shown = [stage for stage in stages if stage.name != "locked"]
    middles = [0.5 * factor * (stage.phase.start + stage.phase.end - 2.0 * zero) for stage in shown]
    wide, tall = style.width_mm(axes), style.height_mm(axes)
    line, gap = 2.6 / tall, 3.0 / tall
    for stage, middle, place in zip(shown, middles, spread(middles, 4.2 * (high - low) / wide), strict=True):
        where, top = (middle - low) / (high - low), (place - low) / (high - low)
        thin: dict[str, Any] = {
            "transform": axes.transAxes,
            "color": FAINT,
            "linewidth": style.HAIR,
            "clip_on": False,
            "zorder": 1,
        }
        axes.plot((where, top), (1.0, 1.0 + line), **thin)
        look: dict[str, Any] = {"rotation": 90.0, "fontsize": style.SMALL, "ha": "center", "va": "bottom", "color": INK}
        axes.text(top, 1.0 + gap, title(stage), transform=axes.transAxes, **look)


def name_key(figure: Figure, names: Iterable[str], top: float, lines: bool = False) -> float:
    """Swatches with the names of phases from the upper left on, `top` mm below the upper edge; where they end, mm."""
    wide, high = style.size_mm(figure)
    row = style.LEAD * style.SMALL * style.POINT
    x, y = style.EDGE, top + 0.5 * row
    for name in names:
        own = SWATCH + GAP + style.LETTER * style.SMALL * style.POINT * len(name)
        if x > style.EDGE and x + own > wide - style.EDGE:
            x, y = style.EDGE, y + 1.15 * row
        tall = 0.7 if lines else 0.7 * row
        colour = strong(name) if lines else PHASES.get(name, ELSE)
        place, size = (x / wide, 1.0 - (y + 0.5 * tall) / high), (SWATCH / wide, tall / high)
        figure.add_artist(Rectangle(place, *size, color=colour, linewidth=0.0, transform=figure.transFigure))
        figure.text((x + SWATCH + GAP) / wide, 1.0 - y / high, name, fontsize=style.SMALL, va="center_baseline", color=INK)
        x += own + APART
    return y + 0.5 * row


def spread(places: Sequence[float], least: float) -> list[float]:
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
    return moved if all(math.isfinite(place) for place in moved) else list(places)


PANEL, TOP, FOOT, LEFT, RIGHT, BETWEEN = 25.0, 35.0, 3.0, 13.5, 3.0, 11.0  # mm
LABEL_AT = 10.5  # mm, of the label left of its panel
BEFORE, AFTER = 0.08, 0.12  # of a beat's phases: what is shown besides
MANY = 2  # beats that are drawn one by one


def plot_phases(
    run: Trajectory, window: Sequence[float] | None = None, width: float = style.FULL, beats: list[Beat] | None = None
) -> Figure:
    """A figure `width` mm wide: left the whole window (s; default the last oscillation), then its last two beats at large.

    In a single column of text (less than 120 mm) only the beats. ValueError where no beat was recorded whole.
    """
    beats = beats or shown_beats(run, window, rubbed=False)
    span = (beats[0].start, beats[-1].end) if window is None else (float(window[0]), float(window[1]))
    span = (max(span[0], float(run.t[0])), min(span[1], float(run.t[-1])))
    columns = [*([None] if width >= style.NARROW else []), *beats[-MANY:]]
    parts = with_anchor(run.scene)
    names = list(dict.fromkeys(name for name in (parts.wheel, parts.lever, parts.oscillator) if name))
    rows = 2 * len(names)
    made = style.figure(width, TOP + rows * PANEL + FOOT)
    style.heading(made, run.scene.title, f"t = {span[0]:.4f} s to {span[1]:.4f} s")
    wide = (width - LEFT - RIGHT - (len(columns) - 1) * BETWEEN) / len(columns)
    for c, beat in enumerate(columns):
        left = LEFT + c * (wide + BETWEEN)
        panels = [style.panel(made, left, TOP + r * PANEL - 1.5, wide, PANEL - 5.0) for r in range(rows)]
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
            axes.plot(x, values, color=colour, linewidth=style.CURVE, solid_joinstyle="round", zorder=3)
            axes.set_xlim(1e3 * (span[0] - zero), 1e3 * (span[1] - zero))
            _numbers(axes, values)
            if first:
                axes.set_ylabel(unit, fontsize=style.SMALL, color=colour, weight="bold")
                axes.yaxis.set_label_coords(-LABEL_AT / style.width_mm(axes), 0.5)
    for axes in panels:
        for one in beats if beat is None else [beat]:
            shade(axes, (stage.phase for stage in one.stages), zero, grey=beat is None)
    for axes in panels[:-1]:
        axes.set_xticklabels([])
    stone = f", {beat.stages[0].pallet} stone" if beat is not None and beat.stages[0].pallet else ""
    words = f"ms after t = {zero:.4f} s" if beat is None else f"ms from {beat.first.removeprefix('beginning of the ')}{stone}"
    panels[-1].set_xlabel(words, fontsize=style.SMALL, labelpad=1.5)
    if beat is not None:
        name_above(panels[0], beat.stages, zero)


def _numbers(axes: Axes, values: Array) -> None:
    style.dress(axes)
    style.limits(axes, float(values.min()), float(values.max()), 0.1)
    style.ticks(axes.xaxis, 5)
    style.ticks(axes.yaxis, 4, [1, 2, 3, 5, 9, 10])
    axes.ticklabel_format(useOffset=False)
    axes.tick_params(labelsize=style.SMALL)
