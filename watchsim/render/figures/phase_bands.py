"""How are the phases of a beat shown in a plot: bands behind the curves, and their names?"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from watchsim.analysis.timeline.rows import Stage
from watchsim.analysis.timeline.timeline_table import title
from watchsim.analysis.timing.phases import Phase
from watchsim.render.figures.figure_style import EDGE, HAIR, LEAD, LETTER, MM, POINT, SMALL
from watchsim.render.palette import ELSE, FAINT, INK, PHASE_LINES, PHASES, SECOND

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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


def shade(axes: Axes, phases: Iterable[Phase], zero: float = 0.0, factor: float = 1e3, grey: bool = False) -> None:
    """A band for each phase of one beat, at (time - zero)·factor; the limits of the axes stay as they are."""
    from matplotlib.patches import Rectangle

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
    box = axes.get_window_extent()
    wide, tall = (pixels / axes.figure.dpi / MM for pixels in (box.width, box.height))
    line, gap = 2.6 / tall, 3.0 / tall
    for stage, middle, place in zip(shown, middles, spread(middles, 4.2 * (high - low) / wide), strict=True):
        where, top = (middle - low) / (high - low), (place - low) / (high - low)
        style: dict[str, Any] = {"transform": axes.transAxes, "color": FAINT, "linewidth": HAIR, "clip_on": False, "zorder": 1}
        axes.plot((where, top), (1.0, 1.0 + line), **style)
        look: dict[str, Any] = {"rotation": 90.0, "fontsize": SMALL, "ha": "center", "va": "bottom", "color": INK}
        axes.text(top, 1.0 + gap, title(stage), transform=axes.transAxes, **look)


def name_key(figure: Figure, names: Iterable[str], top: float, lines: bool = False) -> float:
    """Swatches with the names of phases from the upper left on, `top` mm below the upper edge; where they end, mm."""
    from matplotlib.patches import Rectangle

    wide, high = (inches / MM for inches in figure.get_size_inches())
    row = LEAD * SMALL * POINT
    x, y = EDGE, top + 0.5 * row
    for name in names:
        own = SWATCH + GAP + LETTER * SMALL * POINT * len(name)
        if x > EDGE and x + own > wide - EDGE:
            x, y = EDGE, y + 1.15 * row
        tall = 0.7 if lines else 0.7 * row
        colour = strong(name) if lines else PHASES.get(name, ELSE)
        place, size = (x / wide, 1.0 - (y + 0.5 * tall) / high), (SWATCH / wide, tall / high)
        figure.add_artist(Rectangle(place, *size, color=colour, linewidth=0.0, transform=figure.transFigure))
        figure.text((x + SWATCH + GAP) / wide, 1.0 - y / high, name, fontsize=SMALL, va="center_baseline", color=INK)
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
