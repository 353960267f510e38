"""How are words written that change now and then, such as the name of a phase?

A text is laid out when it first appears and copied from then on.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]

DPI = 72.0  # one point is one pixel
MOST = 2000  # texts kept


class Words:
    """Texts of one size (pixels) and colour on one background."""

    def __init__(self, size: float, ink: str, background: str, weight: str = "normal") -> None:
        self.size, self.height = size, math.ceil(1.5 * size)
        self._drop = round(0.4 * size)  # from the baseline down to the foot of the line
        self._ink, self._background, self._weight = ink, background, weight
        self._kept: dict[str, Pixels] = {}

    def write(self, text: str, x: float, baseline: float, out_pixels: Pixels, right: bool = False) -> None:
        """Copy `text` into the image from column `x` on, or up to it; the baseline is so many pixels above the bottom."""
        if not text:
            return
        image = self._image(text)
        left = round(x) - image.shape[1] if right else round(x)
        top = out_pixels.shape[0] - round(baseline) + self._drop - self.height
        across = slice(max(left, 0), min(left + image.shape[1], out_pixels.shape[1]))
        down = slice(max(top, 0), min(top + self.height, out_pixels.shape[0]))
        if across.start < across.stop and down.start < down.stop:
            inside = image[down.start - top : down.stop - top, across.start - left : across.stop - left]
            out_pixels[down, across] = inside

    def width(self, text: str) -> int:
        """Pixels that `text` takes."""
        return int(self._image(text).shape[1])

    def _image(self, text: str) -> Pixels:
        if text not in self._kept:
            if len(self._kept) >= MOST:
                self._kept.clear()
            self._kept[text] = self._drawn(text)
        return self._kept[text]

    def _drawn(self, text: str) -> Pixels:
        room = math.ceil(self.size * (len(text) + 2))
        figure = Figure(figsize=((room + 0.5) / DPI, (self.height + 0.5) / DPI), dpi=DPI, facecolor=self._background)
        canvas = FigureCanvasAgg(figure)
        drawn = figure.text(
            0.0,
            self._drop / (self.height + 0.5),
            text,
            fontsize=self.size,
            color=self._ink,
            weight=self._weight,
            parse_math=False,
        )
        width = math.ceil(drawn.get_window_extent(canvas.get_renderer()).width) + 1
        canvas.draw()
        return np.array(canvas.buffer_rgba())[:, :width].copy()
