"""How much room do the words around the panels of a plot need?

Worked out from the number of characters. matplotlib's own layouts draw everything twice more to measure it, which takes
longer than the plot.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from watchsim.render.figures.figure_style import LABEL, POINT, TICK

if TYPE_CHECKING:
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

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
    width, height = (inches * INCH for inches in figure.get_size_inches())
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


def spare_labels(axis: Axis, length: float, steps: Sequence[float], most: int = 5) -> None:
    """Numbers at multiples of `steps`, at most so many, and so few that they stand apart on an x axis of that length (pt)."""
    from matplotlib.ticker import MaxNLocator

    for bins in range(most, 0, -1):
        axis.set_major_locator(MaxNLocator(nbins=bins, steps=steps))
        ticks = _ticks(axis)
        apart = length * (ticks[1] - ticks[0]) / float(np.ptp(axis.get_view_interval())) if len(ticks) > 1 else length
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
