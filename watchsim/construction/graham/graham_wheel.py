"""What is the outline of an escape wheel with pointed teeth?

Thin teeth with a narrow tip, leaning forward so that only the front corner of the tip acts; it lies on the x axis for tooth 0,
and the wheel turns clockwise. Millimetres.
"""

from __future__ import annotations

import math

from watchsim.construction.graham.graham_dimensions import Graham
from watchsim.construction.outline import along, angle_of, arc_between, circle, polar, turned
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

DEPTH, RIM, HUB, BORE = 0.2, 0.1, 0.2, 0.06  # by the radius of the wheel
ARMS, ARM = 4, 0.05


def wheel(values: Graham) -> list[Loop]:
    """Teeth, windows and bore."""
    size = values.tip_radius
    pitch = 2.0 * math.pi / values.teeth
    tooth = Loop(tuple(_tooth(values)), "TEETH")
    edges = [edge for i in range(values.teeth) for edge in tooth.moved(i * pitch, (0.0, 0.0)).edges]
    inner, outer = HUB * size, (1.0 - DEPTH - RIM) * size
    windows = [_window(90.0 * i, inner, outer, ARM * size) for i in range(ARMS)]
    return [Loop(tuple(edges), "TEETH"), *windows, circle("TEETH", (0.0, 0.0), BORE * size, hole=True)]


def feet(values: Graham) -> tuple[Point, Point]:
    """Where front and back of tooth 0 meet the floor."""
    size = values.tip_radius
    tip, heel = (size, 0.0), polar(size, values.tip_width)
    return _down(tip, 180.0 - values.undercut, size), _down(heel, 180.0 + values.tip_width - values.back, size)


def _down(corner: Point, way: float, size: float) -> Point:
    """Along `way` from a corner to the floor."""
    floor, x, y = (1.0 - DEPTH) * size, *corner
    dx, dy = math.cos(math.radians(way)), math.sin(math.radians(way))
    ahead = -(x * dx + y * dy)
    return along(corner, way, ahead - math.sqrt(ahead * ahead - (x * x + y * y - floor * floor)))


def _tooth(values: Graham) -> list[Edge]:
    """From the foot of one tooth's front to that of the next, counter-clockwise."""
    front, back = feet(values)
    tip, heel = polar(values.tip_radius, 0.0), polar(values.tip_radius, values.tip_width)
    return [
        Line(*front, *tip),
        arc_between(tip, heel, (0.0, 0.0), True),
        Line(*heel, *back),
        arc_between(back, turned(front, 360.0 / values.teeth), (0.0, 0.0), True),
    ]


def gap(values: Graham) -> float:
    """Degrees of floor between two teeth."""
    front, back = feet(values)
    return 360.0 / values.teeth + angle_of(front) - angle_of(back)


def _window(start: float, inner: float, outer: float, half: float) -> Loop:
    """One opening between two arms, clockwise."""
    ends = []
    for radius in (inner, outer):
        lean = math.degrees(math.asin(half / radius))
        ends.append((polar(radius, start + lean), polar(radius, start + 90.0 - lean)))
    (a, b), (c, d) = ends
    edges: list[Edge] = [
        Line(*c, *a),
        arc_between(a, b, (0.0, 0.0), True),
        Line(*b, *d),
        arc_between(d, c, (0.0, 0.0), False),
    ]
    return Loop(tuple(edges), "TEETH", hole=True)
