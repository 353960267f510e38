"""How does a strip below the mechanism show a body's angle and velocity, with a cursor at the instant shown?

What a page of the strip holds never changes: it is drawn once, and the cursor is copied in. A window of many swings has several
pages, one after the other.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray

from watchsim.analysis.timing.phases import Phase
from watchsim.render.frame.marks.readouts import clock
from watchsim.render.frame.pose_history import Window, choose, dense
from watchsim.render.frame.view import Frame
from watchsim.render.palette import looks
from watchsim.render.picture_style import Style
from watchsim.scene.roles import roles
from watchsim.simulation.record.trajectory import Trajectory

Array = NDArray[np.float64]
Pixels = NDArray[np.uint8]

DPI = 72.0  # one point is one pixel
SWINGS = 8.0  # on a page
MOST_PAGES = 4000
LEFT, FOOT = 11.5, 2.3  # of the text's size: room for the words on the left and below
BELOW = 0.1  # of the height of one of the two rows, under its axes


class Strip:
    """The strip of one body in `room` (pixels); `size` is that of its text."""

    def __init__(
        self, run: Trajectory, window: Window, room: Frame, body: str, phases: Sequence[Phase], size: float, style: Style
    ) -> None:
        self._style = style
        self._run, self._room, self._phases, self._size = run, room, phases, size
        self._body = choose(run, [body])[0]
        self._window = window
        self._column = run.slices[body].start
        self._last: tuple[int, Pixels, tuple[float, float]] | None = None
        rows = dense(run, window)
        self._reach = [_reach(self._told(values[:, self._column])) for values in rows[1:3]]
        speed = rows[2][:, self._column]
        swings = 0.5 * float(np.count_nonzero(np.diff(np.signbit(speed))))
        self._pages = min(max(1, math.ceil(swings / SWINGS - 0.25)), MOST_PAGES)

    def draw(self, t: float, out_pixels: Pixels) -> None:
        """Copy the page that holds `t` (s) and its cursor into the picture."""
        share = (t - self._window[0]) / (self._window[1] - self._window[0]) * self._pages
        number = min(max(int(share), 0), self._pages - 1)
        if self._last is None or self._last[0] != number:
            self._last = (number, *self._page(number))
        _, page, (left, right) = self._last
        bottom = out_pixels.shape[0] - round(self._room.bottom)
        place = slice(bottom - page.shape[0], bottom), slice(round(self._room.left), round(self._room.left) + page.shape[1])
        out_pixels[place] = page
        middle = place[1].start + left + (share - number) * (right - left)
        half = max(1, round(0.06 * self._size))
        columns = slice(round(middle) - half, round(middle) + half)
        out_pixels[place[0].start : bottom - round(self._foot()), columns, :3] = np.round(
            255 * np.array(to_rgb(self._style.contact))
        )

    def _foot(self) -> float:
        """Pixels from the bottom of the strip to that of its lower axes."""
        return FOOT * self._size + BELOW * 0.5 * (self._room.height - FOOT * self._size)

    def _told(self, values: Array) -> Array:
        return values * 1e3 if self._body.motion in ("slide", "free") else np.degrees(values)

    def _page(self, number: int) -> tuple[Pixels, tuple[float, float]]:
        """The pixels of one page, and the columns of its first and last instant."""
        start, end = (self._window[0] + k / self._pages * (self._window[1] - self._window[0]) for k in (number, number + 1))
        width, height = round(self._room.width), round(self._room.height)
        figure = Figure(figsize=((width + 0.5) / DPI, (height + 0.5) / DPI), dpi=DPI, facecolor=self._style.background)
        canvas = FigureCanvasAgg(figure)
        left, right, foot = LEFT * self._size, 1.6 * self._size, FOOT * self._size
        each = (height - foot) / 2.0
        t, q, u, _ = dense(self._run, (start, end))
        told, line = clock((start, end)), self._style.curve(looks(self._run.scene)[self._body.name])
        travels = self._body.motion in ("slide", "free")
        units = ("travel (mm)", "velocity (mm/s)") if travels else ("angle (°)", "velocity (°/s)")
        for k, (values, unit) in enumerate(zip((q, u), units, strict=True)):
            box = (
                left / width,
                (foot + (1 - k) * each + BELOW * each) / height,
                1.0 - (left + right) / width,
                0.86 * each / height,
            )
            axes = figure.add_axes(box)
            self._shade(axes, start, end, told.base, told.factor)
            axes.plot(
                (t - told.base) * told.factor, self._told(values[:, self._column]), color=line, linewidth=0.11 * self._size
            )
            axes.set_xlim((start - told.base) * told.factor, (end - told.base) * told.factor)
            axes.set_ylim(*self._reach[k])
            self._dress(axes, f"{self._body.name}\n{unit}", k == 1)
        axes.set_xlabel(told.label, fontsize=0.8 * self._size, color=self._style.ink, labelpad=0.05 * self._size)
        canvas.draw()
        return np.array(canvas.buffer_rgba())[:height, :width].copy(), (left, width - right)

    def _shade(self, axes: Axes, start: float, end: float, base: float, factor: float) -> None:
        for phase in self._phases:
            if phase.name in self._style.phases and phase.end > start and phase.start < end:
                axes.axvspan(
                    (phase.start - base) * factor,
                    (phase.end - base) * factor,
                    color=self._style.phases[phase.name],
                    linewidth=0.0,
                    zorder=0,
                )

    def _dress(self, axes: Axes, unit: str, last: bool) -> None:
        axes.set_facecolor(self._style.background)
        axes.locator_params(axis="y", nbins=3)
        axes.grid(True, color=self._style.grid, linewidth=0.8)
        axes.set_axisbelow(True)
        axes.tick_params(
            labelsize=0.8 * self._size, colors=self._style.ink, length=0.0, labelbottom=last, pad=0.25 * self._size
        )
        axes.set_ylabel(
            unit, fontsize=0.8 * self._size, color=self._style.ink, rotation=0, ha="left", va="center", parse_math=False
        )
        axes.yaxis.set_label_coords((1.6 - LEFT) * self._size / (self._room.width - (LEFT + 1.6) * self._size), 0.5)
        for side, spine in axes.spines.items():
            spine.set_visible(side in ("left", "bottom"))
            spine.set_color(self._style.faint)


def strip_body(run: Trajectory, asked: str | None) -> str:
    """The body that a strip shows: the one asked for, else the oscillator, else the first that moves."""
    own = asked or roles(run.scene).oscillator
    return choose(run, [own] if own else None)[0].name


def _reach(values: Array) -> tuple[float, float]:
    """Limits of an axis with a little air."""
    known = values[np.isfinite(values)]
    low, high = float(known.min()), float(known.max())
    air = 0.08 * (high - low) or max(abs(high), 1.0) * 0.1
    return low - air, high + air
