"""What does one SVG element draw?

Each reader takes the attributes of an element and gives rows of shapes in its user units, y downwards as SVG has it. Rules
for missing and extreme values after SVG 2, chapter 9; what cannot be meant raises SvgError.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import NamedTuple

from watchsim.drawing.curves.plane_shapes import Conic, Dot, Shape, Straight, circle
from watchsim.drawing.svg.number_text import diagonal, length, numbers
from watchsim.drawing.svg.path_data import PathData, Row, read_path
from watchsim.drawing.svg.xml_elements import SvgError
from watchsim.geometry.primitives import TURN

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


def polyline(m: Measures) -> PathData:
    return _corners(m, closed=False)


def polygon(m: Measures) -> PathData:
    return _corners(m, closed=True)


def _corners(m: Measures, closed: bool) -> PathData:
    if "points" not in m.values:
        raise SvgError("it has no points")
    flat = numbers(m.values["points"])
    if len(flat) % 2:
        raise SvgError(f"it has {len(flat)} coordinates, one without its partner")
    corners = [(x, y, 0.0) for x, y in zip(flat[::2], flat[1::2], strict=True)]
    if closed and len(corners) > 1 and corners[0] != corners[-1]:
        corners.append(corners[0])
    shapes: list[Shape] = [Straight(a, b) for a, b in pairwise(corners)]
    return _single(shapes, len(corners) > 2 and corners[0] == corners[-1])


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
    for k, (centre, side) in enumerate(
        (
            ((right, top), ((left, y), (right, y))),
            ((right, bottom), ((x + width, top), (x + width, bottom))),
            ((left, bottom), ((right, y + height), (left, y + height))),
            ((left, top), ((x, bottom), (x, top))),
        )
    ):
        if (2.0 * rx < width) if k % 2 == 0 else (2.0 * ry < height):
            shapes.append(Straight((*side[0], 0.0), (*side[1], 0.0)))
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


def _single(shapes: list[Shape], closed: bool) -> PathData:
    return PathData([Row(shapes, closed)] if shapes else [], "")


READERS: dict[str, Callable[[Measures], PathData]] = {
    "path": path,
    "line": line,
    "polyline": polyline,
    "polygon": polygon,
    "rect": rect,
    "circle": full_circle,
    "ellipse": ellipse,
}
