"""Is the mass of a hairspring where it must be?"""

from __future__ import annotations

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest

from watchsim.geometry.hairspring import Spiral, drawn_strip, ribbon, spiral_of_length
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line

SPRING = Spiral(0.6e-3, 2.6e-3, 12.0)


def test_length_and_second_moment_against_quadrature_of_high_precision() -> None:
    with mpmath.workdps(30):
        a, inner, end = mpmath.mpf(SPRING.pitch) / (2 * mpmath.pi), mpmath.mpf(SPRING.inner), 24 * mpmath.pi
        ends = mpmath.linspace(0, end, 13)
        length = mpmath.quad(lambda p: mpmath.sqrt((inner + a * p) ** 2 + a * a), ends)
        second = mpmath.quad(lambda p: (inner + a * p) ** 2 * mpmath.sqrt((inner + a * p) ** 2 + a * a), ends)
    assert SPRING.length == pytest.approx(float(length), rel=1e-13, abs=0.0)
    assert SPRING.second == pytest.approx(float(second), rel=1e-13, abs=0.0)


def test_strip_against_a_fine_grid_of_its_area() -> None:
    """Integrated over the strip itself, point by point along the true normals: no formula for spirals in it."""
    width, turns = 0.08e-3, 6.0
    spiral = Spiral(0.5e-3, 2e-3, turns)
    a = spiral.pitch / math.tau
    nodes, weights = np.polynomial.legendre.leggauss(8)
    along = np.concatenate([0.5 * (nodes + 1) + k for k in range(400)]) * math.tau * turns / 400
    step = np.tile(weights, 400) * 0.5 * math.tau * turns / 400
    r = spiral.inner + a * along
    speed = np.hypot(r, a)
    curvature = (r * r + 2 * a * a) / speed**3
    area = polar = 0.0
    for node, weight in zip(nodes, weights, strict=True):
        n = 0.5 * width * node  # along the left normal, toward the axis
        jacobian = (1 - curvature * n) * speed * step * 0.5 * width * weight
        square = r * r - 2 * n * r * r / speed + n * n
        area += float(jacobian.sum())
        polar += float((jacobian * square).sum())
    strip = spiral.strip(width)
    assert strip.area == pytest.approx(area, rel=1e-12, abs=0.0)
    assert strip.polar == pytest.approx(polar, rel=1e-8, abs=0.0)


def test_spiral_of_a_given_length() -> None:
    found = spiral_of_length(SPRING.inner, SPRING.outer, SPRING.length)
    assert found.turns == pytest.approx(SPRING.turns, rel=1e-12, abs=0.0)
    straight = spiral_of_length(1e-3, 2e-3, 1.0001e-3)
    assert straight.length == pytest.approx(1.0001e-3, rel=1e-9, abs=0.0)
    with pytest.raises(ValueError, match="does not even reach"):
        spiral_of_length(1e-3, 2e-3, 1e-3)


def test_drawn_strip_of_half_circles_is_a_ring_section() -> None:
    """Two half circles of one radius make a ring; a straight end of the strip is a bar."""
    r, b, length = 2e-3, 0.1e-3, 1e-3
    chain = Loop(
        (Arc(0.0, 0.0, r, 0.0, math.pi), Arc(0.0, 0.0, r, math.pi, math.pi), Line(r, 0.0, r, length)), "SPRING", closed=False
    )
    found = drawn_strip(chain, b).about((0.0, 0.0))
    ring = math.pi / 2 * ((r + b / 2) ** 4 - (r - b / 2) ** 4)
    bar = b * length * ((b * b + length * length) / 12 + r * r + length * length / 4)
    assert found.area == pytest.approx(b * (math.tau * r + length), rel=1e-12, abs=0.0)
    assert found.polar == pytest.approx(ring + bar, rel=1e-12, abs=0.0)


def test_drawn_arcs_come_near_the_spiral_they_follow() -> None:
    """Quarter turns about centres on a small square: a draughtsman's spiral of the same pitch."""
    pitch, count = SPRING.pitch, 48
    x, y, radius, arcs = 0.0, 0.0, 0.6e-3, []
    for k in range(count):
        arcs.append(Arc(x, y, radius, k * math.pi / 2, math.pi / 2))
        radius += pitch / 4
        angle = (k + 1) * math.pi / 2
        x, y = x - pitch / 4 * math.cos(angle), y - pitch / 4 * math.sin(angle)
    ends = [math.dist(a.end, b.start) for a, b in pairwise(arcs)]
    assert max(ends) < 1e-15
    strip, spiral = drawn_strip(Loop(tuple(arcs), closed=False), 0.03e-3), SPRING.strip(0.03e-3)
    assert strip.area == pytest.approx(spiral.area, rel=0.02, abs=0.0)
    assert strip.about((0.0, 0.0)).polar == pytest.approx(spiral.polar, rel=0.04, abs=0.0)


def test_a_strip_wider_than_its_bend_is_refused() -> None:
    with pytest.raises(ValueError, match="cannot follow an arc of radius"):
        ribbon(Arc(0.0, 0.0, 0.04e-3, 0.0, 1.0), 0.1e-3)


def test_the_picture_is_a_strip_of_the_spiral() -> None:
    """Its area is width times length, its corners lie half a width off the centre line, and it winds as often as it should."""
    spiral = Spiral(1e-3, 3e-3, 8.0)
    strip = spiral.outline(5e-5)
    x, y = np.array([edge.start for edge in strip.edges]).T
    area = 0.5 * abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))))
    assert area == pytest.approx(5e-5 * spiral.length, rel=2e-2, abs=0.0)
    turned = np.abs(np.diff(np.unwrap(np.arctan2(y, x)))).sum() / math.tau
    assert turned == pytest.approx(2.0 * spiral.turns, rel=1e-6, abs=0.0)
    r = np.hypot(x, y)
    assert (r.min(), r.max()) == pytest.approx((1e-3 - 2.5e-5, 3e-3 + 2.5e-5))


def test_a_strip_along_a_slanted_line_is_a_rectangle() -> None:
    """Counter-clockwise, its corners half a width to either side of the ends."""
    loop = ribbon(Line(1e-3, 2e-3, 4e-3, 6e-3), 1e-3)
    corners = [(1.4e-3, 1.7e-3), (4.4e-3, 5.7e-3), (3.6e-3, 6.3e-3), (0.6e-3, 2.3e-3)]
    for edge, here, there in zip(loop.edges, corners, [*corners[1:], corners[0]], strict=True):
        assert edge.start == pytest.approx(here) and edge.end == pytest.approx(there)
