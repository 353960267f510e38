"""Which pieces does an SVG path draw?

The grammar of path data after SVG 1.1 §8.3: commands that repeat, numbers without blanks between them, flags of one digit.
As there, a fault ends the path; what stands before it is drawn, and the fault is reported.
"""

from __future__ import annotations

import math
import re
from typing import NamedTuple

from watchsim.drawing.curves.plane_shapes import Conic, Shape, Spline, Straight
from watchsim.drawing.svg.number_text import ITEM, finite
from watchsim.drawing.svg.xml_elements import SvgError

Point = tuple[float, float]
NUMBERS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
ULP = 2.0**-52
NARROWEST = 1e-9  # ratio of the radii of an arc
_COMMAND = re.compile(r"([MmZzLlHhVvCcSsQqTtAa])([^MmZzLlHhVvCcSsQqTtAa]*)")
_MORE = re.compile(r"\s*\S")
_FLAG = re.compile(r"\s*,?\s*([01])")


class Row(NamedTuple):
    """Pieces that follow each other, as one subpath or one outline draws them."""

    shapes: list[Shape]
    closed: bool


class PathData(NamedTuple):
    """The subpaths, and what was wrong ("" if nothing)."""

    rows: list[Row]
    fault: str


def read_path(text: str) -> PathData:
    """All subpaths of the `d` attribute."""
    pen = _Pen()
    fault = ""
    try:
        start = text[: match.start()] if (match := _COMMAND.search(text)) else text
        if start.strip() or (match and match[1] not in "Mm"):
            raise SvgError(f'it begins with "{text.strip()[:20]}", not with M')
        for match in _COMMAND.finditer(text):
            _follow(pen, match[1], text, match.start(2), match.end(2))
    except SvgError as error:
        fault = str(error)
    pen.lift()
    return PathData(pen.rows, fault)


def _follow(pen: _Pen, letter: str, text: str, at: int, end: int) -> None:
    """One command with all its repetitions; those before a fault are drawn."""
    kind, first = letter.upper(), True
    while first or _MORE.match(text, at, end):
        arguments, after = _arguments(kind, text, at, end, not first)
        if len(arguments) < NUMBERS[kind] or (kind == "Z" and not first):
            left = text[after:end].lstrip()
            seen = left.rstrip()[:20] or text[end : end + 1]
            where = f'character {end - len(left) + 1} is "{seen}"' if seen else "it ends"
            raise SvgError(f"{where} where {letter} needs a number" if kind != "Z" else f"{where}, after a closed outline")
        pen.draw(kind, letter.islower(), arguments)
        kind = "L" if kind == "M" else kind  # further pairs after a move are lines
        first, at = False, after


def _arguments(kind: str, text: str, at: int, end: int, comma: bool) -> tuple[list[float], int]:
    """The numbers of one repetition, fewer where something else follows; and where they end."""
    result: list[float] = []
    for k in range(NUMBERS[kind]):
        match = _FLAG.match(text, at, end) if kind == "A" and k in (3, 4) else ITEM.match(text, at, end)
        if match is None or (k == 0 and not comma and "," in text[at : match.end()]):
            break
        result.append(finite(match[match.lastindex or 1]))
        at = match.end()
    return result, at


class _Pen:
    """Draws command by command; holds the current point, the start of the subpath and the last control point."""

    def __init__(self) -> None:
        self.rows: list[Row] = []
        self.shapes: list[Shape] = []
        self.here: Point = (0.0, 0.0)
        self.start: Point = (0.0, 0.0)
        self.control: Point | None = None
        self.last = ""
        self.size = 0.0  # the largest coordinate of the subpath

    def draw(self, kind: str, relative: bool, a: list[float]) -> None:
        x, y = self.here if relative else (0.0, 0.0)
        if kind == "M":
            self.lift()
            self.here = self.start = (x + a[0], y + a[1])
            self.size = 0.0
        elif kind == "Z":
            self.close()
        elif kind == "H":
            self.line((x + a[0], self.here[1]))
        elif kind == "V":
            self.line((self.here[0], y + a[0]))
        elif kind == "L":
            self.line((x + a[0], y + a[1]))
        elif kind == "A":
            self.arc(a, (x + a[5], y + a[6]))
        else:
            given = [(x + a[k], y + a[k + 1]) for k in range(0, len(a), 2)]
            self.curve([self.reflected("CS" if kind == "S" else "QT"), *given] if kind in "ST" else given)
        self.last = kind

    def lift(self) -> None:
        """Ends the subpath."""
        if self.shapes:
            self.rows.append(Row(self.shapes, self.here == self.start))
            self.shapes = []

    def close(self) -> None:
        (x0, y0), (x1, y1) = self.start, self.here
        # Relative steps leave a remainder of their rounding; that is no line.
        if max(abs(x1 - x0), abs(y1 - y0)) > ULP * self.size * (len(self.shapes) + 1) or not self.shapes:
            self.line(self.start)
        self.here = self.start
        self.lift()

    def line(self, to: Point) -> None:
        self.shapes.append(Straight((*self.here, 0.0), (*to, 0.0)))
        self.move(to)

    def move(self, to: Point) -> None:
        self.here = to
        self.size = max(self.size, abs(to[0]), abs(to[1]))

    def reflected(self, kinds: str) -> Point:
        """The control point of a smooth curve: the last one mirrored, if the last command had one of that kind."""
        (x, y), control = self.here, self.control
        return (2.0 * x - control[0], 2.0 * y - control[1]) if control and self.last in tuple(kinds) else (x, y)

    def curve(self, points: list[Point]) -> None:
        degree = len(points)
        self.control = points[-2]
        if all(point == self.here for point in points):
            self.line(self.here)
            return
        knots = [0.0] * (degree + 1) + [1.0] * (degree + 1)
        self.shapes.append(Spline(degree, knots, [(x, y, 0.0) for x, y in (self.here, *points)]))
        self.move(points[-1])

    def arc(self, a: list[float], to: Point) -> None:
        if to == self.here:
            return  # SVG 1.1, F.6.2: nothing is drawn
        shape = elliptic_arc(self.here, to, abs(a[0]), abs(a[1]), math.radians(a[2]), a[3] != 0.0, a[4] != 0.0)
        self.shapes.append(shape)
        self.move(to)


def elliptic_arc(p: Point, q: Point, rx: float, ry: float, turn: float, large: bool, positive: bool) -> Straight | Conic:
    """The arc between two points as centre, axes and angles (SVG 1.1, F.6.5); radii that are too small grow (F.6.6).

    A circle is not turned, so that its centre lies exactly where the chord puts it.
    """
    if rx == 0.0 or ry == 0.0:
        return Straight((*p, 0.0), (*q, 0.0))
    big, chord = max(rx, ry), math.hypot(q[0] - p[0], q[1] - p[1])
    if min(rx, ry) < NARROWEST * big:
        raise SvgError(f"an arc has radii as different as {rx:g} and {ry:g}")
    if big < NARROWEST * chord:  # they grow in any case: only their ratio counts
        rx, ry = (radius / big * NARROWEST * chord for radius in (rx, ry))
    c, s = (1.0, 0.0) if rx == ry else (math.cos(turn), math.sin(turn))
    # Half the chord and, from its middle, the centre, both on the unit circle that the ellipse is the image of.
    hx, hy = 0.5 * (q[0] - p[0]), 0.5 * (q[1] - p[1])
    wx, wy = (c * hx + s * hy) / rx, (c * hy - s * hx) / ry
    half = math.hypot(wx, wy)
    if half == 0.0:  # the chord underflows: a point of no size
        return Straight((*p, 0.0), (*q, 0.0))
    if half > 1.0:
        rx, ry, wx, wy, half = rx * half, ry * half, wx / half, wy / half, 1.0
    rise = (1.0 - half) * (1.0 + half)
    noise = ULP * (4.0 + 4.0 * max(map(abs, (*p, *q))) / chord)
    rise = 0.0 if rise <= noise else math.sqrt(rise) / half  # of a semicircle the rounding would become its square root
    side = 1.0 if large != positive else -1.0
    mx, my = -side * rise * wy, side * rise * wx
    start = math.atan2(-wy - my, -wx - mx)
    inner = 2.0 * math.atan2(half, rise * half)
    sweep = 2.0 * math.pi - inner if large else inner
    centre = (0.5 * (p[0] + q[0]) + c * rx * mx - s * ry * my, 0.5 * (p[1] + q[1]) + s * rx * mx + c * ry * my, 0.0)
    u, v = (c * rx, s * rx, 0.0), (-s * ry, c * ry, 0.0)
    if positive:
        return Conic(centre, u, v, start, sweep)
    return Conic(centre, u, (-v[0], -v[1], 0.0), -start, sweep)
