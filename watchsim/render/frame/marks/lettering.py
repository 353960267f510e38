"""How are changing numbers written a hundred times a second?

Laying out text costs a millisecond; every character is drawn once and copied afterwards. Digits have one width, so that
numbers do not tremble.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]

CHARACTERS = "0123456789.-−+ °msµ"
DPI = 72.0  # one point is one pixel


class Lettering:
    """Characters of one size and colour on one background; `size` and `height` (of a line) in pixels."""

    def __init__(self, size: float, ink: str, background: str, weight: str = "normal") -> None:
        self.size, self.height = size, math.ceil(1.35 * size)
        self._drop = round(0.3 * size)  # from the baseline down to the foot of the line
        room = math.ceil(2.0 * size)
        figure = Figure(figsize=((room + 0.5) / DPI, (self.height + 0.5) / DPI), dpi=DPI, facecolor=background)
        canvas = FigureCanvasAgg(figure)
        renderer = canvas.get_renderer()
        text = figure.text(0.0, 0.0, "", fontsize=size, color=ink, weight=weight)
        self._cells: dict[str, Pixels] = {}
        for character in CHARACTERS:
            text.set_text(character * 8)
            width = max(1, round(text.get_window_extent(renderer).width / 8.0)) if character != " " else round(0.3 * size)
            text.set_text(character)
            text.set_position((0.0, self._drop / (self.height + 0.5)))
            canvas.draw()
            self._cells[character] = np.array(canvas.buffer_rgba())[:, :width].copy()

    def width(self, text: str) -> int:
        """Pixels that `text` takes; characters it does not know take none."""
        return sum(self._cells[character].shape[1] for character in text if character in self._cells)

    def write(self, text: str, right: int, baseline: int, out_pixels: Pixels) -> None:
        """Copy `text` into the image so that it ends at column `right`, on a baseline so many pixels above the bottom."""
        x, top = right - self.width(text), out_pixels.shape[0] - baseline + self._drop - self.height
        for character in text:
            cell = self._cells.get(character)
            if cell is None:
                continue
            stop = x + cell.shape[1]
            if x >= 0 and stop <= out_pixels.shape[1] and top >= 0 and top + self.height <= out_pixels.shape[0]:
                out_pixels[top : top + self.height, x:stop] = cell
            x = stop
