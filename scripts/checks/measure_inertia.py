"""How large are area and polar moment of outlines by a way that shares nothing with the package?

Green's theorem with mpmath: the integrals over the area are integrals along the outline, summed by Gauss's rule with 30
digits over pieces of at most 0.4 rad. Joints within the rounding of a drawing are bridged by straight bits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any, TypeAlias

import mpmath
import numpy as np

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge

DIGITS = 30
NODES = 12
Number: TypeAlias = Any  # mpmath.mpf, which has no types


def moments(loops: Iterable[Loop]) -> tuple[Number, Number]:
    """Area (m²) and polar moment (m⁴) about the origin."""
    with mpmath.workdps(DIGITS):
        area = polar = mpmath.mpf(0)
        for loop in loops:
            end = _points(loop.edges[-1])(mpmath.mpf(1))
            for edge in loop.edges:
                point = _points(edge)
                start = point(mpmath.mpf(0))
                for way in (_straight(end, start), point):
                    a, p = _along(way, edge if way is point else None)
                    area, polar = area + a, polar + p
                end = point(mpmath.mpf(1))
        return area, polar


def _points(edge: Edge) -> Callable[[Number], tuple[Number, Number]]:
    if isinstance(edge, Arc):
        x, y, r, start, sweep = (mpmath.mpf(v) for v in (edge.x, edge.y, edge.radius, edge.start_angle, edge.sweep))
        if edge.is_circle:
            sweep = mpmath.sign(sweep) * 2 * mpmath.pi
        return lambda t: (x + r * mpmath.cos(start + t * sweep), y + r * mpmath.sin(start + t * sweep))
    a, b = (tuple(mpmath.mpf(v) for v in p) for p in (edge.start, edge.end))
    return _straight(a, b)


def _straight(a: tuple[Number, Number], b: tuple[Number, Number]) -> Callable[[Number], tuple[Number, Number]]:
    return lambda t: (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))


def _along(way: Callable[[Number], tuple[Number, Number]], edge: Edge | None) -> tuple[Number, Number]:
    """½ ∮ (x dy − y dx) and ¼ ∮ (x² + y²)(x dy − y dx) over one piece: of homogeneous integrands, by Green's theorem."""
    if edge is None and way(mpmath.mpf(0)) == way(mpmath.mpf(1)):
        return mpmath.mpf(0), mpmath.mpf(0)

    nodes, weights = _rule()
    parts = math.ceil(abs(edge.sweep) / 0.4) if isinstance(edge, Arc) else 1
    first = second = mpmath.mpf(0)
    for part in range(parts):
        for node, weight in zip(nodes, weights, strict=True):
            t = (part + (1 + node) / 2) / parts
            (x, y), (dx, dy) = way(t), _slope(way, edge, t)
            turn = weight * (x * dy - y * dx) / (2 * parts)
            first, second = first + turn, second + (x * x + y * y) * turn
    return first / 2, second / 4


@cache
def _rule() -> tuple[list[Number], list[Number]]:
    """Nodes and weights of Gauss and Legendre: the double ones, polished by Newton's method."""
    nodes, weights = [], []
    for guess in np.polynomial.legendre.leggauss(NODES)[0]:
        x = mpmath.mpf(guess)
        for _ in range(3):
            value, before = mpmath.legendre(NODES, x), mpmath.legendre(NODES - 1, x)
            slope = NODES * (x * value - before) / (x * x - 1)
            x -= value / slope
        nodes.append(x)
        weights.append(2 / ((1 - x * x) * slope**2))
    return nodes, weights


def _slope(way: Callable[[Number], tuple[Number, Number]], edge: Edge | None, t: Number) -> tuple[Number, Number]:
    if isinstance(edge, Arc):
        (x, y), sweep = way(t), mpmath.mpf(edge.sweep)
        if edge.is_circle:
            sweep = mpmath.sign(sweep) * 2 * mpmath.pi
        return -sweep * (y - mpmath.mpf(edge.y)), sweep * (x - mpmath.mpf(edge.x))
    (ax, ay), (bx, by) = way(mpmath.mpf(0)), way(mpmath.mpf(1))
    return bx - ax, by - ay
