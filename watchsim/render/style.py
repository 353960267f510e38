"""What do all plots have in common: width in print, sizes of letters, axes, the stretch of time that they show?

A figure is as wide as it will be printed, so that a letter of 6 pt here is one of 6 pt there. Pages under docs/ use the same.
"""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path
from typing import Any, Literal, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator, MultipleLocator
from numpy.typing import NDArray

from watchsim.analysis.phases import Phase, phases
from watchsim.analysis.timeline import BEGINNING, RESTING
from watchsim.analysis.timing import beats, beats_within, with_the_last
from watchsim.render.palette import FAINT, GRID, INK
from watchsim.render.view import Window, recorded, stretch
from watchsim.scene.roles import frequency, keeps_time, with_anchor
from watchsim.simulation.trajectory import Trajectory

MM = 1.0 / 25.4  # inches
POINT = 1.0 / 72.0 / MM  # mm
FULL, COLUMN = 170.0, 85.0  # mm, of a page and of one of its two columns
NARROW = 120.0  # mm: a narrower figure is laid out for a column
DPI = 200
TITLE, LABEL, TICK, SMALL = 9.0, 7.0, 6.5, 6.0  # pt; journals ask for 6 at least
EDGE = 2.0  # mm, that nothing comes closer to the figure's edge
HEADING = 11.0  # mm, the title and a line below it
CURVE, THIN, HAIR = 0.9, 0.6, 0.5  # pt, of curves, aids and frames
LEAD = 1.3  # height of a line of text over its size
MOST_LETTERS = 500  # of a title
LETTER = 0.60  # mean width of a letter over its size, on the safe side

# Okabe and Ito's colours for every kind of colour vision (jfly.uni-koeln.de/color, 2008), the yellow left out, and ink.
SERIES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", INK)
MARKERS = ("o", "s", "^", "D", "v", "X", "P")
GOOD, BAD = SERIES[0], SERIES[1]
MAP = "cividis"  # even in lightness, for every kind of colour vision


def figure(
    width: float = FULL, height: float = COLUMN, layout: Literal["constrained"] | None = None, ax: Axes | None = None
) -> Figure:
    """An empty figure of this size in mm that can be saved, and that a notebook shows.

    `ax` are axes of a figure that exists: what is drawn takes their place there, laid out as for that size.
    """
    if ax is not None:
        return _part(ax, width, height)
    made = ShownFigure(figsize=(width * MM, height * MM), dpi=DPI, facecolor="white", layout=layout)
    FigureCanvasAgg(made)
    return made


def _part(ax: Axes, width: float, height: float) -> Figure:
    """The place of some axes as a figure within theirs."""
    whole, spec = ax.get_figure(), ax.get_subplotspec()
    assert whole is not None
    if spec is None:
        raise ValueError("ax: axes of a grid are needed, as plt.subplots or add_subplot make them")
    ax.remove()
    made = whole.add_subfigure(spec, facecolor="none")
    made.laid_out = width, height  # type: ignore[attr-defined]
    return cast(Figure, made)


def size_mm(figure: Figure) -> tuple[float, float]:
    """Width and height."""
    if (laid_out := getattr(figure, "laid_out", None)) is not None:
        return float(laid_out[0]), float(laid_out[1])
    wide, high = (float(inches) / MM for inches in figure.get_size_inches())
    return wide, high


def width_mm(axes: Axes) -> float:
    """Of a panel."""
    return float(axes.get_window_extent().width) / axes.figure.dpi / MM


def height_mm(axes: Axes) -> float:
    """Of a panel."""
    return float(axes.get_window_extent().height) / axes.figure.dpi / MM


PARTS_OF_A_TURN = (10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0)  # °
PLAIN = (1, 2, 5, 10)


def ticks(axis: Axis, most: int, angle: bool = False) -> None:
    """Numbers at 1, 2 and 5 times powers of ten, about so many; large angles (°) in parts of a turn, or whole turns."""
    low, high = sorted(axis.get_view_interval())
    least = (high - low) / most
    if not angle or least <= PARTS_OF_A_TURN[0] / 2.0:
        axis.set_major_locator(MaxNLocator(nbins=most, steps=PLAIN))
        return
    turns = 10.0 ** math.floor(math.log10(max(least / 360.0, 1.0)))
    steps = (*PARTS_OF_A_TURN, *(360.0 * turns * k for k in PLAIN))
    axis.set_major_locator(MultipleLocator(next(step for step in steps if step >= least)))


def minus(text: str) -> str:
    """The text with true minus signs."""
    return text.replace("-", "−")


def panel(figure: Figure, left: float, top: float, width: float, height: float) -> Axes:
    """Axes at a place in mm from the figure's upper left corner."""
    wide, high = size_mm(figure)
    return figure.add_axes((left / wide, 1.0 - (top + height) / high, width / wide, height / high))


def panels(
    figure: Figure, width: float, heights: Sequence[float], across: int, sides: tuple[float, float], top: float, step: float
) -> list[Axes]:
    """Panels of these heights, so many beside each other in a figure of that width; all in mm.

    `sides` is the room left and right of each; their rows begin at `top`, each `step` below the one before.
    """
    left, right = sides
    wide = width / across - left - right
    places = ((k % across * (left + wide + right) + left, top + k // across * step) for k in range(len(heights)))
    return [panel(figure, *place, wide, high) for place, high in zip(places, heights, strict=True)]


def words(axes: Axes, x: float, y: float, text: str, **look: Any) -> None:
    """Small letters at a place in shares of a panel."""
    axes.text(x, y, text, **{"fontsize": SMALL, "color": INK, "transform": axes.transAxes, **look})


def note(axes: Axes, text: str, place: tuple[float, float], away: tuple[float, float], **look: Any) -> None:
    """Small letters beside a place of the data, so many points away."""
    axes.annotate(text, place, away, textcoords="offset points", **{"fontsize": SMALL, "color": INK, **look})


def heading(figure: Figure, title: str, words: str = "") -> None:
    """A title and a line below it, at the upper left; what does not fit is cut."""
    wide, high = size_mm(figure)
    look: dict[str, Any] = {"ha": "left", "va": "center", "color": INK}
    made = [figure.suptitle(cut(title), x=EDGE / wide, y=1.0 - 4.0 / high, fontsize=TITLE, weight="bold", **look)]
    if words:
        made.append(figure.text(EDGE / wide, 1.0 - 8.5 / high, cut(words), fontsize=LABEL, **look))
    for text in made:
        fit(text, wide - 2.0 * EDGE)


def cut(words: str) -> str:
    """The beginning of a text that no figure is wide enough for: to measure letters takes time."""
    return words if len(words) <= MOST_LETTERS else f"{words[:MOST_LETTERS].rstrip()}…"


def fit(text: Text, room: float) -> None:
    """Cut a text, measured as it is drawn, to `room` mm."""
    figure = text.get_figure()
    assert figure is not None
    whole = text.get_text()
    for _ in range(4):
        width = text.get_window_extent().width / figure.dpi / MM
        if width <= room:
            return
        most = min(int(len(text.get_text()) * room / width), len(text.get_text()) - 2)
        text.set_text(f"{whole[: max(most, 1)].rstrip()}…")


def dress(axes: Axes, grid: Literal["both", "x", "y", "none"] = "both") -> None:
    """Grid, frame and numbers of a panel; `grid`: both, x, y or none."""
    if grid != "none":
        axes.grid(True, axis=grid, color=GRID, linewidth=HAIR)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.spines[["left", "bottom"]].set_linewidth(HAIR)
    axes.tick_params(which="both", colors=INK, labelsize=TICK, length=2.0, width=HAIR, pad=1.5)
    for axis in (axes.xaxis, axes.yaxis):
        axis.label.set_fontsize(LABEL)
        axis.label.set_color(INK)
        axis.get_offset_text().set_fontsize(SMALL)


def title(axes: Axes, words: str, colour: str = INK) -> None:
    """What a panel shows, at its upper left."""
    axes.set_title(cut(words), loc="left", fontsize=LABEL, weight="bold", color=colour, y=1.0, pad=3.0)  # y: not searched for


def limits(axes: Axes, low: float, high: float, share: float = 0.08, flat: float = 1e-6, unit: float = 1e-300) -> None:
    """Room above and below the values; what differs by rounding only is not blown up."""
    axes.set_ylim(*with_room(low, high, share, flat, unit))


def with_room(low: float, high: float, share: float, flat: float, unit: float) -> tuple[float, float]:
    """From where to where an axis goes that shows values from `low` to `high`.

    It leaves `share` of their range on both sides, and is no shorter than the part `flat` of the largest, or of `unit`; what is
    nothing but zero has an axis from −1 to 1.
    """
    if low == high == 0.0:
        return -1.0, 1.0
    room = max(share * (high - low), 0.5 * flat * max(abs(low), abs(high), unit))
    return low - room, high + room


def key(axes: Axes, entries: Sequence[tuple[Any, str]], **where: Any) -> None:
    """A legend in the one style."""
    handles, names = [one for one, _ in entries], [name for _, name in entries]
    look: dict[str, Any] = {"frameon": False, "fontsize": SMALL, "labelcolor": INK, "handlelength": 1.4, "columnspacing": 1.0}
    axes.legend(handles, names, **{**look, "borderaxespad": 0.2, "handletextpad": 0.4, **where})


def save(figure: Figure, path: Path | str) -> None:
    """Write it in the format of the file's ending: letters as letters in PDF, as outlines in SVG, and the same every time.

    It is made in memory: matplotlib ends a PDF that cannot be written with an AttributeError instead of the disk's own words.
    """
    import matplotlib

    with matplotlib.rc_context({"pdf.fonttype": 42, "svg.hashsalt": "watchsim", "svg.fonttype": "path"}):
        ending = Path(path).suffix[1:].lower()
        stamp = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(ending)
        packed: dict[str, Any] = {"pil_kwargs": {"compress_level": 3}} if ending == "png" else {}
        made = io.BytesIO()
        figure.savefig(made, format=ending, metadata=stamp, **packed)
    Path(path).write_bytes(made.getvalue())


def energy_unit(largest: float) -> tuple[float, str]:
    """How many to the joule, and the unit's name, such that `largest` (J) has at most four digits before its point."""
    units = ((1e9, "nJ"), (1e6, "µJ"), (1e3, "mJ"), (1.0, "J"))
    return next((one for one in units if abs(largest) * one[0] < 1e4), units[-1])


PREFIXES = ((1.0, ""), (1e3, "m"), (1e6, "µ"), (1e9, "n"))


def scaled_unit(largest: float, unit: str, otherwise: int = -1) -> tuple[float, str]:
    """How many to the unit, and their name, such that `largest` is one or more, or those of prefix number `otherwise`."""
    factor, prefix = next((one for one in PREFIXES if largest * one[0] >= 1.0), PREFIXES[otherwise])
    return factor, prefix + unit


SCREEN = 134  # dots per inch: a page's width is 900 dots, in which letters of 6 pt can be read
COLOURS = 32  # of a small picture: a palette makes it small


class ShownFigure(Figure):
    """A figure that notebooks show as a picture, whether or not they know matplotlib."""

    def _repr_png_(self) -> bytes:
        out = io.BytesIO()
        FigureCanvasAgg(self)
        self.savefig(out, format="png", dpi=SCREEN)
        return out.getvalue()


def small_png(figure: Figure, dots: int) -> bytes:
    """A figure so many dots wide, in few colours."""
    from PIL import Image

    out, small = io.BytesIO(), io.BytesIO()
    figure.savefig(out, format="png", dpi=dots / figure.get_figwidth())
    Image.open(out).convert("RGB").quantize(COLOURS).save(small, "PNG", optimize=True)
    return small.getvalue()


# The room for words around panels is worked out from the number of characters. matplotlib's own layouts draw everything twice
# more to measure it, which takes longer than the plot.

INCH = 72.0  # pt
DIGIT = 0.637  # width of a digit over its size, in matplotlib's own font
LINE = 1.25  # height of a line of text over its size
BEFORE_LABEL = 4.0  # pt, the tick and the gap to its label
GAP = 4.0  # pt, between words and from the edge of the figure
TITLE_PAD = 3.0  # pt, between a panel and its title


def place_panels(figure: Figure, panels: NDArray[np.object_], above: float) -> None:
    """Set the sides of a grid of panels whose limits are final, so that nothing overlaps and nothing is cut off.

    `panels`: (rows, columns) axes with y labels and left titles, x labels in the last row only; `above` mm on top are left for
    the heading of the figure.
    """
    width, height = (side / POINT for side in size_mm(figure))
    rows, columns = panels.shape
    label = LINE * LABEL
    labels = [max(_label_width(axes.yaxis) for axes in panels[:, j]) for j in range(columns)]
    left = [BEFORE_LABEL + labels[j] + label + 2.0 * GAP for j in range(columns)]
    right = 0.5 * _label_width(panels[-1, 0].xaxis) + 0.5 * GAP  # the last label may stand below the corner
    bottom = BEFORE_LABEL + LINE * TICK + label + GAP
    titles = TITLE_PAD + label
    top = above / POINT
    panel_width = (width - sum(left) - columns * right) / columns
    step = (height - top - bottom) / rows
    panel_height = step - titles - GAP
    for j in range(columns):
        x = sum(left[: j + 1]) + j * (panel_width + right)
        for i in range(rows):
            y = bottom + (rows - 1 - i) * step
            axes = panels[i, j]
            axes.set_position((x / width, y / height, panel_width / width, panel_height / height))
            axes.yaxis.set_label_coords(-(left[j] - GAP - 0.5 * label) / panel_width, 0.5)
            axes.yaxis.label.set_verticalalignment("center")
            axes.xaxis.set_label_coords(0.5, -(bottom - GAP - 0.5 * label) / panel_height)
            axes.xaxis.label.set_verticalalignment("center")


def spare_labels(axis: Axis, length: float, angle: bool = False) -> None:
    """Numbers as of `ticks`, so few that they stand apart on an x axis of that length (pt)."""
    for bins in range(5, 0, -1):
        ticks(axis, bins, angle)
        places = _ticks(axis)
        apart = length * (places[1] - places[0]) / float(np.ptp(axis.get_view_interval())) if len(places) > 1 else length
        if _label_width(axis) + GAP <= apart:
            return


def _label_width(axis: Axis) -> float:
    """Of its widest tick label (pt)."""
    texts = axis.get_major_formatter().format_ticks(_ticks(axis))
    return max((DIGIT * TICK * sum(0.5 if c in ",." else 1.0 for c in text) for text in texts), default=0.0)


def _ticks(axis: Axis) -> list[float]:
    """Those in sight."""
    low, high = sorted(axis.get_view_interval())
    return [tick for tick in axis.get_major_locator().tick_values(low, high) if low <= tick <= high]


MOST_PASSING_PHASES = 12  # beats; of more the phases would be hairlines


def passing(run: Trajectory, window: Window, whole: bool = False) -> list[list[Phase]]:
    """The phases of each beat that is in sight, cut to the window; none where there is no escapement, or too much is shown.

    `whole`: without the beat that the end of the run cuts short.
    """
    found = with_anchor(run.scene)
    if found.wheel is None or found.lever is None or not keeps_time(run.scene):
        return []
    swings = beats(run)
    near = beats_within(swings if whole else with_the_last(run, swings), window)
    if not 0 < len(near) <= MOST_PASSING_PHASES + 2:
        return []
    start, end = window
    cut = (
        replace(one, start=max(one.start, start), end=max(min(one.end, end), start))
        for one in phases(run, near)
        if one.start < end and (one.end > start or one.name == "impulse")  # one out of sight counts: the next is the second
    )
    passing = [list(own) for _, own in groupby(cut, key=lambda one: one.beat)]
    return [beat for beat in passing if beat[-1].end > start]


SEARCHED = 3.1  # oscillations from the end: two whole beats lie in them
LONGER = 1.02  # so that the curve closes


@dataclass(frozen=True)
class Shown:
    """A stretch of time (s), and the phases of the beats of an escapement in it, a list for each beat."""

    window: Window
    phases: list[list[Phase]]


def one_cycle(run: Trajectory) -> Shown:
    """The last two beats of an escapement that are whole; else the last oscillation, or all of the last stretch recorded.

    ValueError where nothing was recorded.
    """
    start, end = recorded(run)[-1]
    if not end > start:
        raise ValueError(f"nothing to draw: the run holds only the instant {start:.9g} s")
    hertz = frequency(run.scene) if keeps_time(run.scene) else None
    if not hertz:
        return Shown((start, end), [])
    found = passing(run, (max(start, end - SEARCHED / hertz), end), whole=True)
    whole = [beat for beat in found if beat[0].name in BEGINNING and beat[-1].name in RESTING][-2:]
    if len(whole) == 2:
        return Shown((whole[0][0].start, whole[1][-1].end), whole)
    return Shown((max(start, end - LONGER / hertz), end), found)


def shown(run: Trajectory, window: Sequence[float] | None) -> Shown:
    """The window as asked (s), or one cycle; ValueError where it was not recorded."""
    if window is None:
        return one_cycle(run)
    span = stretch(run, window)
    return Shown(span, passing(run, span))
