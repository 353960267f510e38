"""What do all plots have in common: width in print, sizes of letters, colours, axes?

A figure is as wide as it will be printed, so that a letter of 6 pt here is one of 6 pt there. Pages under docs/ use the same.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from watchsim.render.palette import FAINT, GRID, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Figure
    from matplotlib.text import Text

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


def figure(width: float = FULL, height: float = COLUMN, layout: Literal["constrained"] | None = None) -> Figure:
    """An empty figure of this size in mm that can be saved, and that a notebook shows."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    from watchsim.render.figures.shown_figure import ShownFigure

    made = ShownFigure(figsize=(width * MM, height * MM), dpi=DPI, facecolor="white", layout=layout)
    FigureCanvasAgg(made)
    return made


def panel(figure: Figure, left: float, top: float, width: float, height: float) -> Axes:
    """Axes at a place in mm from the figure's upper left corner."""
    wide, high = (inches / MM for inches in figure.get_size_inches())
    return figure.add_axes((left / wide, 1.0 - (top + height) / high, width / wide, height / high))


def heading(figure: Figure, title: str, words: str = "") -> None:
    """A title and a line below it, at the upper left; what does not fit is cut."""
    wide, high = (inches / MM for inches in figure.get_size_inches())
    look: dict[str, Any] = {"ha": "left", "va": "center", "color": INK}
    made = [figure.suptitle(cut(title), x=EDGE / wide, y=1.0 - 4.0 / high, fontsize=TITLE, weight="bold", **look)]
    if words:
        made.append(figure.text(EDGE / wide, 1.0 - 8.5 / high, cut(words), fontsize=LABEL, **look))
    for text in made:
        fit(text, wide - 2.0 * EDGE)


def without_help() -> None:
    """Have matplotlib make no help texts about properties when it is loaded: a third of its loading."""
    from matplotlib.artist import Artist

    if hasattr(Artist, "_update_set_signature_and_docstring"):
        Artist._update_set_signature_and_docstring = classmethod(lambda _: None)


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

    It leaves `share` of their range on both sides, and is no shorter than the part `flat` of the largest, or of `unit`.
    """
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
