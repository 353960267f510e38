"""Which outlines do lever escapements share: fork, impulse pin, safety roller and guard?

In the frame of their part, millimetres: the lever's pivot in the origin and the balance above it, or the balance's centre in
the origin and the lever below.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from watchsim.construction.outline import arc_between, filleted, mirrored, polar
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Edge, Line, Point


def edge_half(reach: float, centre: float, radius: float, edge: float) -> float:
    """From the middle line to the rounding, of radius `edge`, between the flat of an impulse pin and its round side.

    The flat is `reach` from the balance's centre, the centre of the round side `centre`.
    """
    return math.sqrt((radius - edge) ** 2 - (reach - edge - centre) ** 2)


def horn_radius(reach: float, centre: float, radius: float, edge: float, clearance: float) -> float:
    """Of the horns about the balance's centre, lever on the bank: past the farthest point of the pin's edge."""
    return math.hypot(edge_half(reach, centre, radius, edge), reach - edge) + edge + clearance


def impulse_pin(reach: float, centre: float, radius: float, height: float, edge: float) -> Loop:
    """A round pin with part of its diameter ground away: the flat, `height` from the pin's middle, looks outwards."""
    half = math.sqrt(radius**2 - height**2)
    left, right = (-half, -reach), (half, -reach)
    return filleted("PIN", [(Line(*left, *right), edge), (arc_between(right, left, (0.0, -centre), True), edge)])


def safety_roller(radius: float, depth: float, half_opening: float, edge: float) -> Loop:
    """A disc with a hollow for the guard's point; the opening in degrees at the balance's centre."""
    bottom = radius - depth
    right, left = (polar(radius, -90.0 + side * half_opening) for side in (1.0, -1.0))
    half, height = right[0], -right[1]
    hollow = (half**2 + (height - bottom) ** 2) / (2.0 * (height - bottom))  # circle through both edges and the bottom
    back = arc_between(left, right, (0.0, -(bottom + hollow)), False)
    return filleted("SAFETY", [(arc_between(right, left, (0.0, 0.0), True), edge), (back, edge)])


def guard(
    layer: str, y: float, tip: float, half: float, slope: float, drop: float, foot: tuple[float, float], fillet: float
) -> Loop:
    """A round foot (height of its centre, radius), a bar of half width `half`, and a point rounded by `tip` about (0, y).

    The point leans by `slope` (degrees) from the middle line, and is `drop` high from the bar to its rounding.
    """
    left, right = polar(tip, 180.0 - slope, (0.0, y)), polar(tip, slope, (0.0, y))
    join = foot[0] + math.sqrt(foot[1] ** 2 - half**2)
    shoulder = right[1] - drop
    parts: list[tuple[Edge, float]] = [
        (arc_between((-half, join), (half, join), (0.0, foot[0]), True), fillet),
        (Line(half, join, half, shoulder), 0.0),
        (Line(half, shoulder, *right), 0.0),
        (arc_between(right, left, (0.0, y), True), 0.0),
        (Line(*left, -half, shoulder), 0.0),
        (Line(-half, shoulder, -half, join), fillet),
    ]
    return filleted(layer, parts)


def fork(
    outside: Sequence[Point], tip: Point, about: tuple[Point, float], slot: tuple[float, float], radii: Sequence[float]
) -> Loop:
    """Counter-clockwise from the left end of the neck; the right half is drawn, the left one is its mirror image.

    The right half runs from the neck over the places `outside`, of which the last is the outer end of the horn, to the inner
    end of the horn, `tip`; along an arc `about` the balance on the bank (centre, radius), into the slot (half width, bottom).
    """
    (half, bottom), (centre, reach) = slot, about
    mouth = (half, centre[1] - math.sqrt(reach**2 - (half - centre[0]) ** 2))
    ways = [Line(*a, *b) for a, b in zip(outside, [*outside[1:], tip], strict=True)]
    right: list[Edge] = [*ways, arc_between(tip, mouth, centre, False), Line(*mouth, half, bottom)]
    (x, neck), left = outside[0], [mirrored(edge) for edge in reversed(right)]
    edges: list[Edge] = [Line(-x, neck, x, neck), *right, Line(half, bottom, -half, bottom), *left]
    return filleted("FORK", list(zip(edges, [0.0, *radii, *reversed(radii), 0.0], strict=True)))
