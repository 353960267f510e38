"""What are area, centroid and moment of inertia of a flat part?

Exact for outlines of lines and arcs. An outline is the polygon of its chords plus one circular segment per arc; for both
there are closed forms (polygon: Gauss's area formula and its moments; segment: below). Loops that run
clockwise count negative, so holes subtract by themselves.

Segment of half angle h on radius r, about the middle of its chord (integrals over sector minus triangle, moved there):
area r² (h - sin h cos h), first moment along its axis r³ (sin h - sin³h/3 - h cos h), polar moment
r⁴ (h/2 + h cos²h - 3/2 sin h cos h). All three cancel for small h; there their power series are summed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Point

SERIES_BELOW = 0.7  # radians of half angle: above it the closed forms lose fewer than three digits
TERMS = 12


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
        return Section(
            self.origin,
            self.area + there.area,
            self.first_x + there.first_x,
            self.first_y + there.first_y,
            self.polar + there.polar,
        )


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
    edges = loop.edges
    starts = [edge.start for edge in edges]
    x0 = math.fsum(p[0] for p in starts) / len(starts)
    y0 = math.fsum(p[1] for p in starts) / len(starts)
    parts = []
    previous = edges[-1].end
    for edge, start in zip(edges, starts, strict=True):
        end = edge.end
        if previous != start:  # within the snap: bridged by a straight bit
            parts.append(_triangle(previous[0] - x0, previous[1] - y0, start[0] - x0, start[1] - y0))
        parts.append(_triangle(start[0] - x0, start[1] - y0, end[0] - x0, end[1] - y0))
        if isinstance(edge, Arc):
            parts.append(_segment(edge, 0.5 * (start[0] + end[0]) - x0, 0.5 * (start[1] + end[1]) - y0))
        previous = end
    return Section((x0, y0), *(math.fsum(column) for column in zip(*parts, strict=True)))


def _triangle(ax: float, ay: float, bx: float, by: float) -> tuple[float, float, float, float]:
    """Area and moments of the triangle origin, a, b."""
    doubled = ax * by - bx * ay
    square = ax * ax + ay * ay + ax * bx + ay * by + bx * bx + by * by
    return 0.5 * doubled, doubled * (ax + bx) / 6.0, doubled * (ay + by) / 6.0, doubled * square / 12.0


def _segment(arc: Arc, mx: float, my: float) -> tuple[float, float, float, float]:
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
