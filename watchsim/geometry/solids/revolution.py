"""What are mass and moments of inertia of a turned part?

A half profile of lines and arcs is turned about an axis. With s along the axis and r across it, Pappus's rule gives every
volume integral as one over the profile: ∫ f dV = 2π ∫ f r dA; the moment of inertia about the axis is 2π ∫ r³ dA. These are
moments up to the third order of a polygon and of circular segments, as in `mass`: of a triangle by products of its corners,
of a segment by Gauss's rule over its opening angle. The integrands there are positive trigonometric polynomials of low degree,
so that the rule is exact to rounding and, unlike their closed forms, loses no digits for flat segments.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from watchsim.geometry.extent import extents
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Point

NODES, WEIGHTS = (tuple(map(float, column)) for column in np.polynomial.legendre.leggauss(24))
ON_AXIS = 1e-6  # of the profile's largest radius: a profile drawn with few decimals may cross its axis by that


@dataclass(frozen=True, slots=True)
class Turned:
    """A solid of revolution of density one.

    `volume` in m³; `centre`, the place of its centroid along the axis, in m; moments of inertia in m⁵: `axial` about the axis,
    `transverse` about any line through the centroid square to it.
    """

    volume: float
    centre: float
    axial: float
    transverse: float


def turned(loops: Iterable[Loop], foot: Point, direction: Point) -> Turned:
    """The solid of a half profile (closed loops, holes clockwise, metres) turned about the line through `foot` along the unit
    vector `direction`; `centre` counts from `foot`.

    Raises ValueError where the profile encloses no area or lies on both sides of the axis.
    """
    profile = upright(loops, foot, direction)
    box = extents(profile)
    middle = 0.5 * (box[0] + box[2]) if box else 0.0
    moments = [_loop_moments(loop, middle) for loop in profile]
    first, along, along_square, cubed = (math.tau * math.fsum(column) for column in zip(*moments, strict=True))
    if not first > 0.0:
        raise ValueError("this half profile encloses no area: nothing can be turned from it")
    centre = along / first
    return Turned(first, middle + centre, cubed, 0.5 * cubed + along_square - first * centre * centre)


def upright(loops: Iterable[Loop], foot: Point, direction: Point) -> tuple[Loop, ...]:
    """The closed loops with the axis along x, `foot` at the origin and the material at y >= 0; ValueError as from `turned`."""
    angle = math.atan2(direction[1], direction[0])
    closed = [loop.moved(0.0, (-foot[0], -foot[1])).moved(-angle, (0.0, 0.0)) for loop in loops if loop.closed and loop.edges]
    box = extents(closed)
    if box is None:
        raise ValueError("this half profile encloses no area: nothing can be turned from it")
    _, low, _, high = box
    slack = ON_AXIS * max(abs(low), abs(high))
    if low < -slack and high > slack:
        raise ValueError("the profile lies on both sides of its axis: draw one half of it only")
    return tuple(closed if high > slack else [loop.reflected((0.0, 0.0), (1.0, 0.0)) for loop in closed])


def reach(loops: Iterable[Loop], foot: Point, direction: Point) -> float:
    """The largest radius of the turned part, metres; ValueError as from `turned`."""
    box = extents(upright(loops, foot, direction))
    return box[3] if box else 0.0


Moments = tuple[float, float, float, float]  # ∫ y, ∫ x y, ∫ x² y, ∫ y³ over an area


def _loop_moments(loop: Loop, middle: float) -> Moments:
    """Of one loop, x counted from `middle`."""
    parts = []
    x, y = loop.edges[-1].end
    for edge in loop.edges:
        (ax, ay), (bx, by) = edge.start, edge.end
        parts.append(_triangle(x - middle, y, ax - middle, ay))  # nothing, or a bridge across a gap within the snap
        parts.append(_triangle(ax - middle, ay, bx - middle, by))
        if isinstance(edge, Arc):
            parts.append(_segment(edge, 0.5 * (ax + bx) - middle, 0.5 * (ay + by)))
        x, y = bx, by
    first, along, along_square, cubed = (math.fsum(column) for column in zip(*parts, strict=True))
    return first, along, along_square, cubed


def _triangle(ax: float, ay: float, bx: float, by: float) -> Moments:
    """Of the triangle origin, a, b: ∫ λ₁ⁱ λ₂ʲ dA = D i! j! / (i + j + 2)! with D twice its area."""
    doubled = ax * by - bx * ay
    return (
        doubled * (ay + by) / 6.0,
        doubled * (2.0 * ax * ay + ax * by + bx * ay + 2.0 * bx * by) / 24.0,
        doubled * (3.0 * (ax * ax * ay + bx * bx * by) + ax * ax * by + bx * bx * ay + 2.0 * ax * bx * (ay + by)) / 60.0,
        doubled * (ay + by) * (ay * ay + by * by) / 20.0,
    )


def _segment(arc: Arc, mx: float, my: float) -> Moments:
    """Of the circular segment between an arc and its chord, whose middle is (mx, my)."""
    middle = arc.start_angle + 0.5 * arc.sweep
    ex, ey = math.cos(middle), math.sin(middle)  # from the chord to the arc; across it (-ey, ex)
    r = arc.radius
    unit = _unit_segment(0.5 * abs(arc.sweep))
    scale = [math.copysign(1.0, arc.sweep) * r**power for power in (2, 3, 4, 4, 5, 5)]
    m00, m10, m20, m02, m30, m12 = (factor * moment for factor, moment in zip(scale, unit, strict=True))
    return (
        my * m00 + ey * m10,
        mx * my * m00 + (mx * ey + my * ex) * m10 + ex * ey * (m20 - m02),
        mx * mx * my * m00
        + mx * (mx * ey + 2.0 * my * ex) * m10
        + ex * (2.0 * mx * ey + my * ex) * m20
        + ey * (my * ey - 2.0 * mx * ex) * m02
        + ex * ex * ey * m30
        + ey * (ey * ey - 2.0 * ex * ex) * m12,
        my**3 * m00 + 3.0 * my * (my * ey * m10 + ey * ey * m20 + ex * ex * m02) + ey**3 * m30 + 3.0 * ey * ex * ex * m12,
    )


def _unit_segment(h: float) -> tuple[float, float, float, float, float, float]:
    """∫ uⁱ vʲ for (i, j) = 00, 10, 20, 02, 30, 12 over the segment of half angle h on the unit circle.

    u counts from the chord outward, v along it. At the angle t from the middle lies a strip parallel to the chord: of width
    sin t dt, at the height u = cos t - cos h, with v from -sin t to sin t.
    """
    sums = [0.0] * 6
    for node, weight in zip(NODES, WEIGHTS, strict=True):
        t = 0.5 * h * (1.0 + node)
        u = 2.0 * math.sin(0.5 * (h + t)) * math.sin(0.5 * (h - t))
        strip = h * weight * math.sin(t) ** 2
        across = strip * math.sin(t) ** 2 / 3.0
        for k, value in enumerate((strip, strip * u, strip * u * u, across, strip * u**3, across * u)):
            sums[k] += value
    return sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]
