"""Charts of the timing sheet, and the still picture of a page: SVG in the page, for paper and for readers without scripts."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from watchsim.pages.html import Markup, element, joined
from watchsim.pages.player import path_data
from watchsim.render.opening import sight, touching_room
from watchsim.render.palette import BLUED, LIGHT, PALE_PICTURE_STYLE, mixed
from watchsim.render.parts import Part
from watchsim.render.rows import reduced
from watchsim.render.view import Frame, View, Window, bounds, hairsprings, poses, room_of, zigzags
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.units import decimals_for, signed

WIDTH, HEIGHT = 560.0, 230.0
LEFT, RIGHT, TOP, BOTTOM = 88.0, 12.0, 12.0, 44.0  # of the large letters on a phone five fit between label and axis
DOT = 2.4
MOST_DOTS = 1200  # dots of one series


@dataclass(frozen=True)
class Dots:
    """A series of points (n,), (n,), its name and the class that gives its colour."""

    name: str
    x: Array
    y: Array
    look: str


def scatter(series: Sequence[Dots], x_label: str, y_label: str, description: str, most: int = MOST_DOTS) -> Markup:
    """Dots over labelled axes, at most so many of a series; `description` is what the chart says to those who cannot see it."""
    clean = [_thinned(one, most) for one in series]
    xs, ys = (np.concatenate([getattr(one, axis) for one in clean]) for axis in "xy")
    x_axis, y_axis = _Axis(xs, LEFT, WIDTH - RIGHT, 7), _Axis(ys, HEIGHT - BOTTOM, TOP, 5)
    marks = [
        element("circle", cx=f"{x_axis(x):.1f}", cy=f"{y_axis(y):.1f}", r=DOT, class_=one.look)
        for one in clean
        for x, y in zip(one.x.tolist(), one.y.tolist(), strict=True)
    ]
    middle = 0.5 * (TOP + HEIGHT - BOTTOM)
    labels = (
        element("text", x_label, x=0.5 * (LEFT + WIDTH - RIGHT), y=HEIGHT - 5, text_anchor="middle"),
        element("text", y_label, x=13, y=middle, text_anchor="middle", transform=f"rotate(-90 13 {middle:g})"),
    )
    parts = (*_grid(x_axis, y_axis), *labels, *marks)
    picture = element("svg", *parts, viewBox=f"0 0 {WIDTH:g} {HEIGHT:g}", role="img", aria_label=description)
    key = element("p", *(_key(one) for one in series), class_="key") if len(series) > 1 else None
    return element("figure", picture, key, class_="chart")


def _key(one: Dots) -> Markup:
    dot = element("svg", element("circle", cx=5, cy=5, r=4, class_=one.look), viewBox="0 0 10 10", aria_hidden="true")
    return element("span", dot, one.name)


def _thinned(one: Dots, most: int) -> Dots:
    known = np.isfinite(one.x) & np.isfinite(one.y)
    return Dots(one.name, *reduced(one.x[known], one.y[known], most // 4), one.look)


class _Axis:
    """Values to places between `first` and `last`, with round marks."""

    def __init__(self, values: Array, first: float, last: float, marks: int) -> None:
        low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
        # Rounding must not fill a chart: a hundred-millionth of the value counts as nothing.
        least = max(1e-8 * max(abs(low), abs(high)), 1e-12)
        if high - low < least:
            low, high = low - 0.5 * max(0.02 * abs(low), least), high + 0.5 * max(0.02 * abs(high), least)
        pad = 0.05 * (high - low)
        self._low, self._high, self._first, self._last = low - pad, high + pad, first, last
        self.step = round_step((self._high - self._low) / marks)
        start = math.ceil(self._low / self.step)
        self.marks = [k * self.step for k in range(start, math.floor(self._high / self.step) + 1)]

    def __call__(self, value: float) -> float:
        return self._first + (value - self._low) / (self._high - self._low) * (self._last - self._first)

    def text(self, value: float) -> str:
        return signed(value, decimals_for(self.step * 1.0001))


def round_step(least: float) -> float:
    """1, 2 or 5 times a power of ten, no smaller than `least`."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= least * (1.0 - 1e-9))


def _grid(x_axis: _Axis, y_axis: _Axis) -> list[Markup]:
    parts = []
    for value in y_axis.marks:
        y = f"{y_axis(value):.1f}"
        parts.append(element("line", x1=LEFT, x2=WIDTH - RIGHT, y1=y, y2=y, class_="grid"))
        parts.append(element("text", y_axis.text(value), x=LEFT - 6, y=y, dy="0.32em", text_anchor="end"))
    for value in x_axis.marks:
        x = f"{x_axis(value):.1f}"
        parts.append(element("line", x1=x, x2=x, y1=HEIGHT - BOTTOM, y2=HEIGHT - BOTTOM + 4, class_="axis"))
        parts.append(element("text", x_axis.text(value), x=x, y=HEIGHT - BOTTOM + 17, text_anchor="middle"))
    parts.append(element("line", x1=LEFT, x2=WIDTH - RIGHT, y1=HEIGHT - BOTTOM, y2=HEIGHT - BOTTOM, class_="axis"))
    return parts


SERIES = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#8c7a00", "#7a7a7a")  # of page.css, in light


def bars(entries: Sequence[tuple[str, float, str]], description: str, colours: Mapping[str, str]) -> Markup:
    """A labelled bar for each (name, share of 1, value in words); negative shares run to the left of the zero line.

    `colours` by name are some of SERIES; other names are grey.
    """
    row, names, room = 30.0, 205.0, WIDTH - 205.0 - 185.0  # on a phone letters are half as large again
    low, high = min(0.0, *(share for _, share, _ in entries)), max(1e-9, *(share for _, share, _ in entries))
    zero = names - room * low / (high - low)
    parts: list[Markup] = []
    for k, (name, share, value) in enumerate(entries):
        colour = SERIES.index(colours.get(name, SERIES[-1]))
        y, width = row * k, room * abs(share) / (high - low)
        left = zero if share >= 0.0 else zero - width
        size = {"width": f"{max(width, 0.8):.2f}", "height": row - 10}
        parts += (
            element("text", name, x=names - 8, y=y + 0.5 * row, dy="0.34em", text_anchor="end"),
            element("rect", x=f"{left:.2f}", y=y + 5, **size, rx=2, class_=f"s{colour}"),
            element("text", value, x=f"{zero + (width if share >= 0 else 0) + 7:.2f}", y=y + 0.5 * row, dy="0.34em"),
        )
    picture = element("svg", *parts, viewBox=f"0 0 {WIDTH:g} {row * len(entries):g}", role="img", aria_label=description)
    return element("figure", picture, class_="chart")


def strip(entries: Sequence[tuple[str, float, int]], unit: str, description: str) -> Markup:
    """Lengths one after the other along a scale from zero; an entry is its name, its length and the number of its colour."""
    whole = max(sum(length for _, length, _ in entries), 1e-300)
    scale = (WIDTH - 2.0 * RIGHT) / whole
    x, height = RIGHT, 26.0
    parts: list[Markup] = []
    for name, length, colour in entries:
        box = element("title", f"{name}: {length:.3g} {unit}")
        width = max(length * scale, 0.5)
        parts.append(element("rect", box, x=f"{x:.2f}", y=0, width=f"{width:.2f}", height=height, class_=f"s{colour}"))
        x += length * scale
    step = round_step(whole / 8.0)
    for k in range(int(whole / step) + 1):
        at = f"{RIGHT + k * step * scale:.2f}"
        parts.append(element("line", x1=at, x2=at, y1=height, y2=height + 4, class_="axis"))
        label = f"{signed(k * step, decimals_for(step * 1.0001))}{'' if k else f' {unit}'}"
        parts.append(element("text", label, x=at, y=height + 17, text_anchor="middle" if k else "start"))
    picture = element("svg", *parts, viewBox=f"0 0 {WIDTH:g} {height + 22:g}", role="img", aria_label=description)
    return element("figure", picture, class_="chart")


MARGIN = 0.04
ASIDE = 0.3  # of a part's width: the most that the whole beside it takes
PEN = 2.7e-3  # of the height, the lines of outlines: 0.9 pixels of a printed picture
MOST_POSTER = 150_000  # characters of path data; more than that is left to the player
MM = 1e3
COIL = 1e-3  # of its size, that a chord may stray from a hairspring
FRAME = Frame(0.0, 0.0, 1280.0, 720.0)


def poster(run: Trajectory, window: Window, parts: tuple[Part, ...], t: float) -> Markup:
    """All parts at the instant `t` (s), as SVG in mm; the player moves the groups when the page is printed."""
    drawn = [path_data(part.outlines) for part in parts]
    if sum(map(len, drawn)) > MOST_POSTER:
        return Markup("")
    frames = {name: frame[0] for name, frame in poses(run, np.array([t])).items()}
    found = sight(run, window, FRAME, None, None, 1.0, 0.0)
    seen, close = found.view, found.whole is not None
    left, bottom, right, top = _box(run, window, seen, frames, close)
    pad = MARGIN * max(right - left, top - bottom)
    c, s = math.cos(seen.turn), math.sin(seen.turn)
    place = (c, -s, -s, -c, MM * (pad - left), MM * (pad + top))
    width, height = MM * (right - left + 2.0 * pad), MM * (top - bottom + 2.0 * pad)
    pen, groups = PEN * height, []
    for number, (part, data) in enumerate(zip(parts, drawn, strict=True)):
        look = LIGHT.worn(part.finish)
        shape = element("path", d=data, fill="none" if part.ground else look.fill, stroke=look.edge)
        groups.append(element("g", shape, transform=_matrix(*_pose(frames[part.body])), data_part=number))
    coils, pale = [], mixed(BLUED.line, LIGHT.background, PALE_PICTURE_STYLE)
    for number, spring in enumerate(hairsprings(run.scene)):
        line = _points(spring.line(frames, spring.coil.chords(COIL * spring.coil.outer)))
        wide = f"{max(MM * spring.coil.width, pen):.4g}"
        coils.append(element("path", d=line, fill="none", stroke=pale, stroke_width=wide, data_coil=number))
    lines = [
        element("path", d=_points(spring.line(frames)), fill="none", stroke=BLUED.line, data_zigzag=number)
        for number, spring in enumerate(zigzags(run.scene))
    ]
    drawing = element("g", *coils, *groups, *lines, transform=_matrix(*place), id="drawn", stroke_width=f"{pen:.4g}")
    aside = 0.0
    if close:
        aside, whole = _beside(_box(run, window, seen, frames, False), place, width, height)
        size = {"width": f"{width:.4f}", "height": f"{height:.4f}"}
        edges = element("clipPath", element("rect", **size), id="part")
        cut = element("rect", **size, fill="none", stroke=LIGHT.grid, stroke_width=f"{pen:.4g}")
        drawing = joined((edges, element("g", drawing, clip_path="url(#part)"), cut, whole))
    box = f"{-aside:.4f} 0 {width + aside:.4f} {height:.4f}"
    return element("svg", drawing, id="poster", viewBox=box, role="img", aria_label=f"The mechanism at {t:.6g} s")


def _beside(box: tuple[float, ...], place: tuple[float, ...], width: float, height: float) -> tuple[float, Markup]:
    """What the whole, within `box` (m), takes on the left of a picture (mm) whose map `place` shows a part; and the whole."""
    left, bottom, right, top = (MM * value for value in box)
    scale = min(ASIDE * width / (right - left), (1.0 - 2.0 * MARGIN) * height / (top - bottom))
    taken = scale * (right - left) + 2.0 * MARGIN * width
    # The map of the part puts a point (x, y) of the turned picture at (place[4] + x, place[5] - y).
    x, y = MARGIN * width - taken - scale * (place[4] + left), MARGIN * height - scale * (place[5] - top)
    return taken, element("use", href="#drawn", transform=_matrix(scale, 0.0, 0.0, scale, x, y))


def _box(
    run: Trajectory, window: Window, seen: View, frames: dict[str, Array], close: bool
) -> tuple[float, float, float, float]:
    """Least and largest x and y (m) in the turned picture, of everything or, `close`, of what touches."""
    if seen.follow is None:
        points = touching_room(run, window) if close else None
        points = room_of(run, window, None)[0] if points is None else points
        (left, bottom), (right, top) = (end.tolist() for end in bounds(points, seen.turn))
        return left, bottom, right, top
    c, s = math.cos(seen.turn), math.sin(seen.turn)
    x, y = seen.centre_at(frames)
    across, along = c * x - s * y, s * x + c * y
    half_width, half_height = 0.5 * FRAME.width / seen.scale, 0.5 * FRAME.height / seen.scale
    return across - half_width, along - half_height, across + half_width, along + half_height


def _pose(frame: Array) -> tuple[float, ...]:
    x, y, angle = frame.tolist()
    c, s = math.cos(angle), math.sin(angle)
    return c, s, -s, c, MM * x, MM * y


def _points(line: Array) -> str:
    """A line through points (n, 2), m, as SVG path data in mm."""
    return "M" + " ".join(f"{MM * x:.4f} {MM * y:.4f}" for x, y in line.tolist())


def _matrix(*numbers: float) -> str:
    return f"matrix({' '.join(f'{number:.7g}' for number in numbers)})"
