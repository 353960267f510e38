"""What does one SVG element draw?

Each reader takes the attributes of an element and gives rows of shapes in its user units, y downwards as SVG has it: pixels of
1/96 inch before any transformation (CSS Values and Units, absolute lengths). Rules for missing and extreme values after SVG 2,
chapter 9; what cannot be meant raises SvgError.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import partial
from itertools import pairwise
from typing import NamedTuple

from watchsim.drawing.dxf_records import LARGEST
from watchsim.drawing.projection import IDENTITY, Affine, Conic, Dot, Shape, Spline, Straight, circle, cosine_sine, shifted
from watchsim.drawing.svg_elements import SvgError
from watchsim.geometry.primitives import TURN

NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
INCH = Fraction(254, 10_000)
METRES = {
    **{"px": INCH / 96, "in": INCH, "pt": INCH / 72, "pc": INCH / 6},
    **{"mm": Fraction(1, 1000), "cm": Fraction(1, 100), "q": Fraction(1, 4000)},
}
ITEM = re.compile(rf"\s*(,?)\s*({NUMBER})")
_LENGTH = re.compile(rf"\s*({NUMBER})\s*([A-Za-z]*|%)\s*")


def finite(text: str) -> float:
    value = float(text)
    if not abs(value) <= LARGEST:
        raise SvgError(f'"{text[:40]}" is beyond any drawing')
    return value


def numbers(text: str) -> list[float]:
    """All numbers of a list with blanks or single commas between them; SvgError where there is anything else."""
    result: list[float] = []
    at = 0
    while (item := ITEM.match(text, at)) is not None:
        if item[1] and not result:
            break
        result.append(finite(item[2]))
        at = item.end()
    if text[at:].strip():
        raise SvgError(f'"{text[at : at + 20].strip()}" is not a number')
    return result


def split_length(text: str) -> tuple[float, str]:
    """The number and the unit in lower case ("" where there is none)."""
    match = _LENGTH.fullmatch(text)
    if match is None:
        raise SvgError(f'"{text[:40]}" is not a length')
    unit = match[2].lower()
    if unit and unit != "%" and unit not in METRES:
        raise SvgError(f'"{text[:40]}" is a length in a unit that cannot be known here')
    return finite(match[1]), unit


def length(text: str, whole: float) -> float:
    """A length in user units; `whole` is what 100 % stands for."""
    value, unit = split_length(text)
    if unit == "%":
        if whole == 0.0 and value != 0.0:
            raise SvgError(f'"{text[:40]}" is a part of a page whose size is not given')
        return value * whole / 100.0
    if unit in ("", "px"):
        return value
    ratio = METRES[unit] / METRES["px"]
    return value * ratio.numerator / ratio.denominator


def diagonal(width: float, height: float) -> float:
    """What 100 % of a length in no particular direction stands for."""
    return math.sqrt(0.5 * (width * width + height * height))


# The grammar of path data after SVG 1.1 §8.3: commands that repeat, numbers without blanks between them, flags of one digit.
# As there, a fault ends the path; what stands before it is drawn, and the fault is reported.

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


# Transformations and view boxes

TURNS = {"": 360.0, "deg": 360.0, "grad": 400.0, "rad": 2.0 * math.pi, "turn": 1.0}
ALIGNED = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
KEYWORDS = {"left": "0%", "top": "0%", "center": "50%", "right": "100%", "bottom": "100%"}
_FUNCTION = re.compile(r"[\s,]*([A-Za-z]+)\s*\(([^()]*)\)")
_ANGLE = re.compile(rf"\s*({NUMBER})\s*(deg|grad|rad|turn|)\s*")
_ASPECT = re.compile(r"\s*(?:defer\s+)?(?:x(Min|Mid|Max)Y(Min|Mid|Max)|none)(?:\s+(meet|slice))?\s*")


class Box(NamedTuple):
    """A view box or a viewport."""

    x: float
    y: float
    width: float
    height: float


def plane(a: float, b: float, c: float, d: float, e: float, f: float) -> Affine:
    """The map with the six numbers of SVG's matrix(): x' = ax + cy + e, y' = bx + dy + f."""
    return Affine((a, b, 0.0), (c, d, 0.0), (0.0, 0.0, 1.0), (e, f, 0.0))


def transform(text: str) -> Affine:
    """The map of a `transform` attribute; SvgError where it cannot be read."""
    result = IDENTITY
    if text.strip() == "none":
        return result
    at = 0
    while (match := _FUNCTION.match(text, at)) is not None:
        result = result.after(_function(match[1], match[2]))
        at = match.end()
    if text[at:].strip():
        raise SvgError(f'its transform has "{text[at : at + 30].strip()}", which cannot be read')
    if max(abs(number) for column in result for number in column) > 1e12:
        raise SvgError("its transform goes beyond any drawing")
    return result


def _function(name: str, arguments: str) -> Affine:
    try:
        if name in ("rotate", "skewX", "skewY"):
            return _angular(name, arguments)
        values = numbers(re.sub(r"(?<=[0-9.])px\b", "", arguments))
    except SvgError as error:
        raise SvgError(f"its transform {name}({arguments[:40]}) cannot be read: {error}") from None
    match name, values:
        case "matrix", [_, _, _, _, _, _]:
            return plane(*values)
        case ("translate" | "translateX", [x]) | ("translate", [x, _]):
            return shifted((x, values[1] if len(values) > 1 else 0.0, 0.0))
        case "translateY", [y]:
            return shifted((0.0, y, 0.0))
        case "scale", [x] | [x, _]:
            return plane(x, 0.0, 0.0, values[-1], 0.0, 0.0)
        case "scaleX", [x]:
            return plane(x, 0.0, 0.0, 1.0, 0.0, 0.0)
        case "scaleY", [y]:
            return plane(1.0, 0.0, 0.0, y, 0.0, 0.0)
    raise SvgError(f"its transform {name}({arguments[:40]}) is not one of SVG's")


def _angular(name: str, arguments: str) -> Affine:
    """rotate, skewX and skewY: the first number is an angle, with a unit where it comes from CSS."""
    match = _ANGLE.match(arguments)
    if match is None:
        raise SvgError("there is no angle")
    turn = float(match[1]) / TURNS[match[2]]
    if not abs(turn) < 1e9:
        raise SvgError("the angle is beyond any drawing")
    c, s = cosine_sine(2.0 * math.pi * math.remainder(turn, 1.0))
    rest = numbers(arguments[match.end() :].lstrip().removeprefix(","))
    if name == "rotate" and len(rest) in (0, 2):
        x, y = rest or (0.0, 0.0)
        return plane(c, s, -s, c, x - c * x + s * y, y - s * x - c * y)
    if rest or c == 0.0:
        raise SvgError("no such slant")
    return plane(1.0, 0.0, s / c, 1.0, 0.0, 0.0) if name == "skewX" else plane(1.0, s / c, 0.0, 1.0, 0.0, 0.0)


def placed(values: Mapping[str, str], width: float, height: float) -> Affine:
    """The transformation of an element about its `transform-origin`; `width` and `height` are those of its viewport."""
    if not values.get("transform"):
        return IDENTITY
    inner = transform(values["transform"])
    origin = values.get("transform-origin", "").split()
    if not origin:
        return inner
    if values.get("transform-box", "view-box") != "view-box":
        raise SvgError("its transform is about its own box (transform-box), which is not read")
    if len(origin) > 3:
        raise SvgError("its transform-origin cannot be read")
    sides = [KEYWORDS.get(word, word) for word in (*origin, "50%")]
    if origin[0] in ("top", "bottom") or {"left", "right"}.intersection(origin[1:2]):
        sides[:2] = sides[1::-1]
    x, y = length(sides[0], width), length(sides[1], height)
    return shifted((x, y, 0.0)).after(inner).after(shifted((-x, -y, 0.0)))


def view_box(text: str | None) -> Box | None:
    """The view box; None where there is none. A box without area raises SvgError."""
    if text is None or text.strip() in ("", "none"):
        return None
    values = numbers(text)
    if len(values) != 4 or not (values[2] > 0.0 and values[3] > 0.0):
        raise SvgError(f'its viewBox "{text[:40]}" is not four numbers with a width and a height above zero')
    return Box(*values)


def fitted(box: Box, width: float, height: float, aspect: str | None) -> tuple[float, float, float, float]:
    """(sx, sy, tx, ty) so that sx·x + tx, sy·y + ty shows `box` in a viewport of that size, after preserveAspectRatio."""
    match = _ASPECT.fullmatch(aspect or "xMidYMid")
    if match is None:
        raise SvgError(f'its preserveAspectRatio "{(aspect or "")[:40]}" cannot be read')
    sx, sy = width / box.width, height / box.height
    if match[1] is not None:
        sx = sy = max(sx, sy) if match[3] == "slice" else min(sx, sy)
    tx = ALIGNED[match[1] or "Min"] * (width - sx * box.width) - sx * box.x
    ty = ALIGNED[match[2] or "Min"] * (height - sy * box.height) - sy * box.y
    return sx, sy, tx, ty


QUARTER = 0.25 * TURN


class Measures(NamedTuple):
    """The attributes of an element and the size of its viewport, for percentages."""

    values: Mapping[str, str]
    width: float
    height: float

    def given(self, name: str) -> bool:
        return self.values.get(name, "auto").strip() != "auto"

    def along(self, name: str, default: float = 0.0) -> float:
        """A length in the direction of x."""
        return length(self.values[name], self.width) if self.given(name) else default

    def up(self, name: str, default: float = 0.0) -> float:
        """A length in the direction of y."""
        return length(self.values[name], self.height) if self.given(name) else default

    def size(self, name: str, value: float) -> float:
        if not self.given(name):
            raise SvgError(f"it has no {name}")
        if value < 0.0:
            raise SvgError(f"its {name} is {value:g}")
        return value


def path(m: Measures) -> PathData:
    if "d" not in m.values:
        raise SvgError("it has no d")
    text = m.values["d"]
    return PathData([], "") if text.strip() in ("", "none") else read_path(text)


def line(m: Measures) -> PathData:
    if not any(name in m.values for name in ("x1", "y1", "x2", "y2")):
        raise SvgError("it has no coordinates")
    a = (m.along("x1"), m.up("y1"), 0.0)
    return _single([Straight(a, (m.along("x2"), m.up("y2"), 0.0))], False)


def corners(m: Measures, closed: bool) -> PathData:
    if "points" not in m.values:
        raise SvgError("it has no points")
    flat = numbers(m.values["points"])
    if len(flat) % 2:
        raise SvgError(f"it has {len(flat)} coordinates, one without its partner")
    points = [(x, y, 0.0) for x, y in zip(flat[::2], flat[1::2], strict=True)]
    if closed and len(points) > 1 and points[0] != points[-1]:
        points.append(points[0])
    return _single([Straight(a, b) for a, b in pairwise(points)], len(points) > 2 and points[0] == points[-1])


def rect(m: Measures) -> PathData:
    width, height = m.size("width", m.along("width")), m.size("height", m.up("height"))
    if width == 0.0 or height == 0.0:
        return PathData([], "")
    x, y = m.along("x"), m.up("y")
    rx, ry = _radii(m, width, height)
    if rx == 0.0 or ry == 0.0:
        corners = [(x, y, 0.0), (x + width, y, 0.0), (x + width, y + height, 0.0), (x, y + height, 0.0)]
        return _single([Straight(corners[k - 1], corners[k]) for k in (1, 2, 3, 0)], True)
    # Around in the sense of growing angles, beginning with the upper side; a side without length is none.
    left, right, top, bottom = x + rx, x + width - rx, y + ry, y + height - ry
    shapes: list[Shape] = []
    sides = (
        ((right, top), ((left, y), (right, y))),
        ((right, bottom), ((x + width, top), (x + width, bottom))),
        ((left, bottom), ((right, y + height), (left, y + height))),
        ((left, top), ((x, bottom), (x, top))),
    )
    for k, (centre, (start, end)) in enumerate(sides):
        if (2.0 * rx < width) if k % 2 == 0 else (2.0 * ry < height):
            shapes.append(Straight((*start, 0.0), (*end, 0.0)))
        shapes.append(Conic((*centre, 0.0), (rx, 0.0, 0.0), (0.0, ry, 0.0), (k - 1) * QUARTER, QUARTER))
    return _single(shapes, True)


def _radii(m: Measures, width: float, height: float) -> tuple[float, float]:
    """One radius alone counts for both; none is longer than half its side (SVG 2, §10.2)."""
    rx, ry = m.along("rx", -1.0), m.up("ry", -1.0)
    for name, value in (("rx", rx), ("ry", ry)):
        if m.given(name) and value < 0.0:
            raise SvgError(f"its {name} is {value:g}")
    rx, ry = (ry if rx < 0.0 else rx), (rx if ry < 0.0 else ry)
    return min(max(rx, 0.0), 0.5 * width), min(max(ry, 0.0), 0.5 * height)


def full_circle(m: Measures) -> PathData:
    """A circle; one whose radius is written as 0 is not drawn by browsers and marks a point here."""
    radius = m.size("r", length(m.values["r"], diagonal(m.width, m.height)) if m.given("r") else 0.0)
    centre = (m.along("cx"), m.up("cy"), 0.0)
    return _single([circle(centre, radius) if radius > 0.0 else Dot(centre)], True)


def ellipse(m: Measures) -> PathData:
    if not m.given("rx") and not m.given("ry"):
        raise SvgError("it has neither rx nor ry")
    rx, ry = m.along("rx"), m.up("ry")
    rx, ry = (ry if not m.given("rx") else m.size("rx", rx)), (rx if not m.given("ry") else m.size("ry", ry))
    if rx == 0.0 or ry == 0.0:
        return PathData([], "")
    return _single([Conic((m.along("cx"), m.up("cy"), 0.0), (rx, 0.0, 0.0), (0.0, ry, 0.0), 0.0, TURN)], True)


def _single(shapes: Sequence[Shape], closed: bool) -> PathData:
    return PathData([Row(list(shapes), closed)] if shapes else [], "")


READERS: dict[str, Callable[[Measures], PathData]] = {
    "path": path,
    "line": line,
    "polyline": partial(corners, closed=False),
    "polygon": partial(corners, closed=True),
    "rect": rect,
    "circle": full_circle,
    "ellipse": ellipse,
}
