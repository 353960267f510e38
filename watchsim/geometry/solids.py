"""What are area, mass and moments of inertia of flat and of turned parts?

Exact for outlines of lines and arcs. An outline is the polygon of its chords plus one circular segment per arc; for both
there are closed forms (polygon: Gauss's area formula and its moments; segment: below). Loops that run clockwise count negative,
so holes subtract by themselves.

Segment of half angle h on radius r, about the middle of its chord (integrals over sector minus triangle, moved there):
area r² (h - sin h cos h), first moment along its axis r³ (sin h - sin³h/3 - h cos h), polar moment
r⁴ (h/2 + h cos²h - 3/2 sin h cos h). All three cancel for small h; there their power series are summed.

A half profile is turned about an axis. With s along the axis and r across it, Pappus's rule gives every volume integral as one
over the profile: ∫ f dV = 2π ∫ f r dA; the moment of inertia about the axis is 2π ∫ r³ dA. These are moments up to the third
order: of a triangle by products of its corners, of a segment by Gauss's rule over its opening angle. The integrands there are
positive trigonometric polynomials of low degree, so that the rule is exact to rounding and, unlike their closed forms, loses no
digits for flat segments.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from watchsim.geometry.loops import Loop, extents, polyline
from watchsim.geometry.primitives import Arc, Point

SERIES_BELOW = 0.7  # radians of half angle: above it the closed forms lose fewer than three digits
TERMS = 12
Moments = tuple[float, float, float, float]  # four integrals over an area


@dataclass(frozen=True, slots=True)
class Section:
    """Moments of an area: m², m³ (about the axes through `origin`) and m⁴ (polar, about `origin`)."""

    origin: Point
    area: float = 0.0
    first_x: float = 0.0  # ∫ (x - origin_x) dA
    first_y: float = 0.0
    polar: float = 0.0  # ∫ |p - origin|² dA

    @property
    def centroid(self) -> Point:
        """Metres; ZeroDivisionError where the area is zero."""
        return (self.origin[0] + self.first_x / self.area, self.origin[1] + self.first_y / self.area)

    def about(self, p: Point) -> Section:
        """The same area with its moments about `p` (Steiner)."""
        dx, dy = self.origin[0] - p[0], self.origin[1] - p[1]
        polar = self.polar + 2.0 * (dx * self.first_x + dy * self.first_y) + self.area * (dx * dx + dy * dy)
        return Section(p, self.area, self.first_x + dx * self.area, self.first_y + dy * self.area, polar)

    def plus(self, other: Section) -> Section:
        """Both areas together, about this one's origin."""
        there = other.about(self.origin)
        first = self.first_x + there.first_x, self.first_y + there.first_y
        return Section(self.origin, self.area + there.area, *first, self.polar + there.polar)


@dataclass(frozen=True, slots=True)
class MassProperties:
    """Mass (kg), centre of mass (m), moment of inertia (kg·m²) about the z axis through the origin of the drawing."""

    mass: float
    centre: Point
    inertia: float

    def inertia_about(self, p: Point) -> float:
        """kg·m² about the axis through `p` (Steiner, by way of the centre of mass)."""
        (x, y), (px, py) = self.centre, p
        return self.inertia - self.mass * (x * x + y * y) + self.mass * ((x - px) ** 2 + (y - py) ** 2)


def area(loop: Loop) -> float:
    """Signed area of a closed loop in m²: positive if it runs counter-clockwise."""
    return section_of_loop(loop).area


def mass_properties(loops: Iterable[Loop], thickness: float, density: float) -> MassProperties:
    """Of a plate with these outlines, `thickness` in m, `density` in kg/m³.

    Raises ValueError where there is no area, or more hole than material.
    """
    total = section(loops)
    if not total.area > 0.0:
        raise ValueError("these outlines enclose no area: no mass can be computed from them")
    surface = thickness * density
    return MassProperties(surface * total.area, total.centroid, surface * total.about((0.0, 0.0)).polar)


def section(loops: Iterable[Loop]) -> Section:
    """The moments of all closed loops together, about a point in their midst; open chains enclose nothing."""
    total: Section | None = None
    for loop in loops:
        if loop.closed and loop.edges:
            part = section_of_loop(loop)
            total = part if total is None else total.plus(part)
    return total if total is not None else Section((0.0, 0.0))


def section_of_loop(loop: Loop) -> Section:
    """The moments of one closed loop, about the mean of its corners (so that far-away drawings lose no digits)."""
    starts = [edge.start for edge in loop.edges]
    x0 = math.fsum(p[0] for p in starts) / len(starts)
    y0 = math.fsum(p[1] for p in starts) / len(starts)
    return Section((x0, y0), *_summed(loop, x0, y0, _triangle, _segment))


def _summed(
    loop: Loop,
    x0: float,
    y0: float,
    triangle: Callable[[float, float, float, float], Moments],
    segment: Callable[[Arc, float, float], Moments],
) -> Moments:
    """Moments of one closed loop, about (x0, y0): of the triangles to its chords and of the segments beside them."""
    parts = []
    previous = loop.edges[-1].end
    for edge in loop.edges:
        (ax, ay), (bx, by) = start, end = edge.start, edge.end
        if previous != start:  # within the snap: bridged by a straight bit
            parts.append(triangle(previous[0] - x0, previous[1] - y0, ax - x0, ay - y0))
        parts.append(triangle(ax - x0, ay - y0, bx - x0, by - y0))
        if isinstance(edge, Arc):
            parts.append(segment(edge, 0.5 * (ax + bx) - x0, 0.5 * (ay + by) - y0))
        previous = end
    first, second, third, fourth = (math.fsum(column) for column in zip(*parts, strict=True))
    return first, second, third, fourth


def _triangle(ax: float, ay: float, bx: float, by: float) -> Moments:
    """Area and moments of the triangle origin, a, b."""
    doubled = ax * by - bx * ay
    square = ax * ax + ay * ay + ax * bx + ay * by + bx * bx + by * by
    return 0.5 * doubled, doubled * (ax + bx) / 6.0, doubled * (ay + by) / 6.0, doubled * square / 12.0


def _segment(arc: Arc, mx: float, my: float) -> Moments:
    """Area and moments of the circular segment between an arc and its chord, whose middle is (mx, my)."""
    h = 0.5 * abs(arc.sweep)
    sign = math.copysign(1.0, arc.sweep)
    middle = arc.start_angle + 0.5 * arc.sweep
    ex, ey = math.cos(middle), math.sin(middle)
    unit_area, unit_first, unit_polar = _unit_segment(h)
    r = arc.radius
    size, first, polar = sign * r**2 * unit_area, sign * r**3 * unit_first, sign * r**4 * unit_polar
    along = ex * mx + ey * my
    return size, size * mx + first * ex, size * my + first * ey, polar + 2.0 * first * along + size * (mx * mx + my * my)


def _unit_segment(h: float) -> tuple[float, float, float]:
    """Area, first moment, polar moment of the segment of half angle h on the unit circle."""
    if h >= SERIES_BELOW:
        s, c = math.sin(h), math.cos(h)
        return h - s * c, s - s**3 / 3.0 - h * c, 0.5 * h + h * c * c - 1.5 * s * c
    # h - sin(2h)/2;  3/4 sin h + sin(3h)/12 - h cos h;  h + h cos(2h)/2 - 3/4 sin(2h): as series in h.
    size = first = polar = 0.0
    power, sign = h, 1.0  # h^n/n! with n = 2k + 1
    for k in range(1, TERMS + 2):
        n = 2 * k + 1
        power *= h * h / (2 * k * n)
        sign = -sign
        size -= sign * 2.0 ** (n - 1) * power
        first += sign * (0.75 + 3.0**n / 12.0 - n) * power
        polar += sign * 2.0 ** (n - 2) * (n - 3.0) * power
    return size, first, polar


# Solids for other programs and overlaps of layers seen from above need plane regions; arcs become chords here.

Region = Any  # a shapely geometry of polygons


def region(loops: Iterable[Loop], deviation: float, scale: float = 1.0) -> Region:
    """The material of the closed loops (metres), chords within `deviation` metres of their arcs, times `scale`.

    Larger loops come first: a hole empties what is around it, an island in a hole is material again.
    """
    found: Region = shapely.Polygon()
    for loop in sorted((loop for loop in loops if loop.closed and loop.edges), key=lambda loop: -abs(area(loop))):
        shape = shapely.make_valid(shapely.Polygon(scale * polyline(loop, deviation)))
        found = found.difference(shape) if loop.hole else found.union(shape)
    return found


def pieces(found: Region) -> Iterator[Region]:
    """The polygons of a region that have an area."""
    parts = getattr(found, "geoms", [found])
    yield from (part for part in parts if part.geom_type == "Polygon" and part.area > 0.0)


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
    moments = [_summed(loop, middle, 0.0, _triangle_revolution, _segment_revolution) for loop in profile]
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


def _triangle_revolution(ax: float, ay: float, bx: float, by: float) -> Moments:
    """∫ y, ∫ x y, ∫ x² y, ∫ y³ over the triangle origin, a, b: ∫ λ₁ⁱ λ₂ʲ dA = D i! j! / (i + j + 2)! with D twice its area."""
    doubled = ax * by - bx * ay
    return (
        doubled * (ay + by) / 6.0,
        doubled * (2.0 * ax * ay + ax * by + bx * ay + 2.0 * bx * by) / 24.0,
        doubled * (3.0 * (ax * ax * ay + bx * bx * by) + ax * ax * by + bx * bx * ay + 2.0 * ax * bx * (ay + by)) / 60.0,
        doubled * (ay + by) * (ay * ay + by * by) / 20.0,
    )


def _segment_revolution(arc: Arc, mx: float, my: float) -> Moments:
    """The same of the circular segment between an arc and its chord, whose middle is (mx, my)."""
    middle = arc.start_angle + 0.5 * arc.sweep
    ex, ey = math.cos(middle), math.sin(middle)  # from the chord to the arc; across it (-ey, ex)
    r = arc.radius
    unit = _unit_segment_revolution(0.5 * abs(arc.sweep))
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


def _unit_segment_revolution(h: float) -> tuple[float, float, float, float, float, float]:
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
