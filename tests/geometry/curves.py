"""Which curves can arcs be tried on? Rational ones, and others by high polynomials; with points and slopes by other means."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import BarycentricInterpolator, BSpline

from watchsim.geometry.biarcs import Curve

Array = np.ndarray
Map = Callable[[Array], Array]


@dataclass(frozen=True)
class Known(Curve):
    """A curve of which points and slopes (n, 2) are known by other means, at parameters (n,)."""

    points: Map
    slopes: Map


def bezier(values: Map, low: float, high: float, degree: int) -> Array:
    """Control points (degree + 1, columns) of the polynomial through `values` at Chebyshev's places."""
    u = 0.5 - 0.5 * np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    basis = np.column_stack([math.comb(degree, k) * u**k * (1.0 - u) ** (degree - k) for k in range(degree + 1)])
    return np.linalg.solve(basis, values(low + (high - low) * u))


def known(homogeneous: Map, points: Map, slopes: Map, breaks: Array, degree: int) -> Known:
    control = np.array([bezier(homogeneous, a, b, degree) for a, b in pairwise(breaks)])
    control[:, 0], control[:, -1] = homogeneous(breaks[:-1]), homogeneous(breaks[1:])
    return Known(control, breaks, points, slopes)


def spline(degree: int, knots: Sequence[float], points: Sequence[Sequence[float]], weights: Sequence[float] = ()) -> Known:
    """The NURBS curve, metres."""
    w = np.asarray(weights or np.ones(len(points)), dtype=float)
    homogeneous = BSpline(np.asarray(knots, dtype=float), np.column_stack((np.asarray(points) * w[:, None], w)), degree)
    derivative = homogeneous.derivative()
    breaks = np.unique(np.asarray(knots, dtype=float)[degree : len(points) + 1])

    def at(t: Array) -> Array:
        h = homogeneous(t)
        return h[:, :2] / h[:, 2:]

    def slopes(t: Array) -> Array:
        h, dh = homogeneous(t), derivative(t)
        return (dh[:, :2] - h[:, :2] * (dh[:, 2:] / h[:, 2:])) / h[:, 2:]

    result = known(homogeneous, at, slopes, breaks, degree)
    if not weights:
        result.control[..., 2] = 1.0
    return result


def quarter_ellipse(a: float, b: float) -> Known:
    return spline(2, [0, 0, 0, 1, 1, 1], [(a, 0), (a, b), (0, b)], [1, math.sqrt(0.5), 1])


def smooth(at: Callable[[Array], tuple[Array, Array]], low: float, high: float, degree: int = 8, spans: int = 1) -> Known:
    """A curve given by points and slopes; of so many spans and such a degree that polynomials follow it well."""

    def homogeneous(t: Array) -> Array:
        return np.column_stack((at(t)[0], np.ones(len(t))))

    result = known(homogeneous, lambda t: at(t)[0], lambda t: at(t)[1], np.linspace(low, high, spans + 1), degree)
    result.control[..., 2] = 1.0
    return result


def involute(r: float, low: float, high: float) -> Known:
    def at(t: Array) -> tuple[Array, Array]:
        c, s = np.cos(t), np.sin(t)
        return r * np.column_stack((c + t * s, s - t * c)), r * np.column_stack((t * c, t * s))

    return smooth(at, low, high, spans=4)


def spiral(r: float, growth: float, turns: float) -> Known:
    """Radius r·(1 + growth·angle)."""

    def at(t: Array) -> tuple[Array, Array]:
        e, u = np.column_stack((np.cos(t), np.sin(t))), np.column_stack((-np.sin(t), np.cos(t)))
        return r * (1 + growth * t)[:, None] * e, r * (growth * e + (1 + growth * t)[:, None] * u)

    return smooth(at, 0.0, 2 * math.pi * turns, spans=math.ceil(8 * turns))


def least_arcs(curve: Known, tolerance: float) -> float:
    """(√3/216/ε)^(1/3) ∫ |κ′|^(1/3) ds: the least for small ε. κ′ from interpolation."""
    total = 0.0
    for low, high in zip(curve.breaks[:-1], curve.breaks[1:], strict=True):
        nodes = 0.5 * (low + high) + 0.5 * (high - low) * np.cos(np.pi * (np.arange(41) + 0.5) / 41)
        plane = BarycentricInterpolator(nodes, curve.points(nodes))
        t = low + (high - low) * (np.arange(4000) + 0.5) / 4000
        one, two, three = (plane.derivative(t, der) for der in (1, 2, 3))
        speed = np.hypot(one[:, 0], one[:, 1])
        turn, more = (one[:, 0] * x[:, 1] - one[:, 1] * x[:, 0] for x in (two, three))
        rate = more / speed**3 - 3.0 * turn * np.sum(one * two, axis=1) / speed**5
        total += float(np.mean(np.cbrt(np.abs(rate / speed)) * speed)) * (high - low)
    return total * (math.sqrt(3.0) / 216.0 / tolerance) ** (1.0 / 3.0)
