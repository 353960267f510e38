"""Where do the words of a frame stand, and how are those written that change?

A band at the top for title and time, one at the bottom for what every body reads and the scale; the mechanism has the
rest. What never changes becomes artists of the figure; what changes is written by `Layout.write`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import FancyBboxPatch
from matplotlib.text import Text
from matplotlib.transforms import IdentityTransform

from watchsim.render.marks import Clock, clock, goes_round, reading, scale_bar, spaced, speed_text, turn_text
from watchsim.render.palette import Finish, Style, looks
from watchsim.render.style import cut
from watchsim.render.view import Frame, Pixels, Window, sampled
from watchsim.scene.roles import roles
from watchsim.scene.scene import Body
from watchsim.simulation.trajectory import Array, Trajectory

# Laying out text costs a millisecond; every character is drawn once and copied afterwards. Digits have one width, so that
# numbers do not tremble.


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


KEPT = 2000  # texts


class Words:
    """Texts of one size (pixels) and colour on one background, laid out when they first appear and copied from then on."""

    def __init__(self, size: float, ink: str, background: str, weight: str = "normal") -> None:
        self.size, self.height = size, math.ceil(1.5 * size)
        self._drop = round(0.4 * size)  # from the baseline down to the foot of the line
        self._ink, self._background, self._weight = ink, background, weight
        self._image = lru_cache(KEPT)(self._drawn)

    def width(self, text: str) -> int:
        """Pixels that `text` takes."""
        return self._image(text).shape[1]

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

    def _drawn(self, text: str) -> Pixels:
        room = math.ceil(self.size * (len(text) + 2))
        figure = Figure(figsize=((room + 0.5) / DPI, (self.height + 0.5) / DPI), dpi=DPI, facecolor=self._background)
        canvas = FigureCanvasAgg(figure)
        drawn = figure.text(0.0, self._drop / (self.height + 0.5), text, color=self._ink, weight=self._weight)
        drawn.set(fontsize=self.size, parse_math=False)
        width = math.ceil(drawn.get_window_extent(canvas.get_renderer()).width) + 1
        canvas.draw()
        return np.array(canvas.buffer_rgba())[:, :width].copy()


TITLE, TIME, SMALL = 19.0, 24.0, 15.0  # text sizes in pixels at 1280 × 720
PAD, GAP = 24.0, 30.0
CHIP = 0.85  # of the text size: the side of a coloured square
BAR = 0.16  # of the width: the longest scale bar
SMALLEST = 9.0  # pixels; smaller text cannot be read
LEAST = 8.0  # pixels of height for the bodies


@dataclass(frozen=True)
class Reading:
    """A changing number: whose, against which carrier, how it is written, and where its last pixel and its baseline are."""

    body: str
    on: str | None
    text: Callable[[Array], str]
    right: int
    baseline: int


@dataclass(frozen=True)
class Layout:
    """The frame left for the mechanism, and the places of the changing numbers."""

    frame: Frame
    clock: Clock
    step: float
    time: Lettering
    time_at: tuple[int, int]
    small: Lettering
    readings: tuple[Reading, ...]

    def write(self, t: float, frames: dict[str, Array], out_pixels: Pixels) -> None:
        """Write time and read-outs for the instant `t` and the poses x, y, angle of its bodies."""
        self.time.write(self.clock.text(t, self.step), *self.time_at, out_pixels)
        for item in self.readings:
            own = frames[item.body] if item.on is None else frames[item.body] - frames[item.on]
            self.small.write(item.text(own), item.right, item.baseline, out_pixels)


def lay_out(figure: Figure, run: Trajectory, window: Window, step: float, style: Style) -> Layout:
    """Place title, time and read-outs on the figure (one point is one pixel) and say what room is left."""
    width, height = int(figure.bbox.width), int(figure.bbox.height)
    unit = _unit(figure)
    time = Lettering(max(TIME * unit, SMALLEST), style.ink, style.background, "bold")
    small = Lettering(max(SMALL * unit, SMALLEST), style.ink, style.background)
    time_of = clock(window)
    baseline = round(height - PAD * unit - 0.75 * TIME * unit)
    time_width = max(time.width(time_of.text(t, step)) for t in window)
    _title(figure, run.scene.title, (PAD * unit, baseline), width - 2.0 * PAD * unit - time_width - GAP * unit, style.ink)
    # The line for notes is kept free even where none is shown: a frame drawn alone matches its movie.
    top = height - baseline + 0.35 * TIME * unit + 1.3 * small.size
    readings, bottom = _readings(figure, run, window, small, style)
    frame = Frame(0.0, bottom, width, height - top - bottom)
    if frame.height < LEAST:
        raise ValueError(f"size = {width}x{height}: no room is left beside title, time and read-outs; choose a larger picture")
    return Layout(frame, time_of, step, time, (round(width - PAD * unit), baseline), small, readings)


def draw_notes(figure: Figure, frame: Frame, speed: float | None, turn: float, style: Style) -> None:
    """Below the time: how fast a movie goes, and by how much (rad) the picture is turned against the scene's axes."""
    size = max(SMALL * _unit(figure), SMALLEST)
    notes = ["" if speed is None else speed_text(speed), turn_text(turn)]
    place = (frame.left + frame.width - PAD * _unit(figure), frame.bottom + frame.height + 0.3 * size)
    _words(figure, ", ".join(filter(None, notes)), place, size, style.faint, ha="right")


def draw_scale(figure: Figure, scale: float, style: Style) -> None:
    """A bar of a round length at the lower right; `scale` is in pixels per metre."""
    width, unit = int(figure.bbox.width), _unit(figure)
    length, name = scale_bar(BAR * width / scale)
    right, base = width - PAD * unit, PAD * unit
    left, tick = right - length * scale, 4.0 * unit
    x, y = [left] * 3 + [right] * 3, [base + tick, base - tick, base, base, base - tick, base + tick]
    _line(figure, x, y, style.ink, max(1.5 * unit, 1.0))
    _words(figure, name, (0.5 * (left + right), base + 2.0 * tick), max(SMALL * unit, SMALLEST), style.ink, ha="center")


def draw_key(figure: Figure, entries: Sequence[tuple[str, str]], style: Style) -> None:
    """Strokes in their colours with what they mean, side by side in the line below the title."""
    unit = _unit(figure)
    size, x = max(SMALL * unit, SMALLEST), PAD * unit
    base = figure.bbox.height - (PAD + 0.75 * TIME + 0.35 * TIME) * unit - size
    for colour, meaning in entries:
        ends, height = [x, x + 1.6 * size], [base + 0.35 * size] * 2
        _line(figure, ends, height, colour, max(3.0 * unit, 1.5), solid_capstyle="round")
        text = _words(figure, meaning, (x + 2.2 * size, base), size, style.ink)
        x += 2.2 * size + _width(text) + GAP * unit


def draw_rules(figure: Figure, frame: Frame, style: Style) -> None:
    """Hairlines along the frame, for a picture that cuts bodies off there."""
    for y in (frame.bottom, frame.bottom + frame.height):
        _line(figure, [frame.left, frame.left + frame.width], [y, y], style.grid, max(_unit(figure), 0.7))


def _line(figure: Figure, x: list[float], y: list[float], colour: str, width: float, **look: Any) -> None:
    """A line through places in pixels."""
    figure.add_artist(Line2D(x, y, color=colour, linewidth=width, transform=IdentityTransform(), **look))


def relative_size(width: float, height: float) -> float:
    """How large a picture is, 1 for 1280 × 720 pixels, wide, square or tall."""
    return min(math.sqrt(width * height / (1280.0 * 720.0)), min(width, height) / 720.0)


def _unit(figure: Figure) -> float:
    """Size of everything drawn, relative to a picture of 1280 × 720 or of 720 × 1280 pixels."""
    return min(max(relative_size(figure.bbox.width, figure.bbox.height), 0.4), 4.0)


def _words(figure: Figure, words: str, place: tuple[float, float], size: float, colour: str, **style: str) -> Text:
    """Text at a place in pixels; `style` may hold `ha` and `weight`."""
    text = Text(*place, words, color=colour, fontsize=size, transform=IdentityTransform(), parse_math=False)
    text.set(**style)
    figure.add_artist(text)
    return text


def _width(text: Text) -> float:
    return float(text.get_window_extent().width)


def _title(figure: Figure, title: str, place: tuple[float, float], room: float, ink: str) -> None:
    """The scene's title, shortened where it does not fit."""
    title = cut(title)
    text = _words(figure, title, place, max(TITLE * _unit(figure), SMALLEST), ink, weight="bold")
    while title and _width(text) > room:
        title = title[:-1].rstrip(" ,;:-–")
        text.set_text(f"{title}…" if title else "")


@dataclass(frozen=True)
class _Cell:
    """A name and a value on their way to a place: `x` in pixels, `row` from the top of the rows, `taken` pixels wide."""

    body: Body
    name: Text
    as_text: Callable[[Array], str]
    look: Finish
    x: float
    row: int
    taken: float


def _readings(
    figure: Figure, run: Trajectory, window: Window, small: Lettering, style: Style
) -> tuple[tuple[Reading, ...], float]:
    """Rows of name and value from the bottom left, and the height they take."""
    unit = _unit(figure)
    line, left, limit = 1.55 * small.size, PAD * unit, figure.bbox.width * (1.0 - BAR) - (PAD + GAP) * unit
    cells: list[_Cell] = []
    x, row, worn, swinging = left, 0, looks(run.scene), roles(run.scene).oscillator
    for body in run.scene.bodies:
        if body.name not in run.slices:
            continue
        seen = sampled(run, body, window)
        if body.on is not None:  # against its carrier
            seen = seen - sampled(run, run.scene.body(body.on), window)
        within = body.motion != "slide" and body.name != swinging and goes_round(seen[:, 2])
        as_text, ends = reading(body, seen, within)
        name = _words(
            figure, f"{spaced(body.name)} mod 360°" if within else spaced(body.name), (0.0, 0.0), small.size, style.ink
        )
        taken = 1.5 * CHIP * small.size + _width(name) + 0.8 * small.size + max(small.width(text) for text in ends)
        if x > left and x + taken > limit:
            x, row = left, row + 1
        cells.append(_Cell(body, name, as_text, worn[body.name], x, row, taken))
        x += taken + GAP * unit
    placed = tuple(_place(figure, cell, round(PAD * unit + (row - cell.row) * line), small.size) for cell in cells)
    return placed, 1.6 * PAD * unit + (row + 1) * line


def _place(figure: Figure, cell: _Cell, base: int, size: float) -> Reading:
    """Put a cell's coloured chip and name on the figure, on a baseline `base` pixels above the bottom."""
    x, chip = round(cell.x), CHIP * size
    box = FancyBboxPatch((x, base - 0.05 * size), chip, chip, boxstyle=f"round,pad=0,rounding_size={0.2 * size}")
    box.set(facecolor=cell.look.fill, edgecolor=cell.look.edge, linewidth=max(0.06 * size, 0.7), transform=IdentityTransform())
    figure.add_artist(box)
    cell.name.set_position((x + 1.5 * chip, base))
    return Reading(cell.body.name, cell.body.on, cell.as_text, round(x + cell.taken), base)
