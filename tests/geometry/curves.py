"""Which curves can arcs be tried on? Rational ones, and others by high polynomials."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy.interpolate import BarycentricInterpolator, BSpline

from watchsim.geometry.curve import Curve

Array = np.ndarray


def spline(degree: int, knots: Sequence[float], points: Sequence[Sequence[float]], weights: Sequence[float] = ()) -> Curve:
    """The NURBS curve, metres."""
    w = np.asarray(weights or np.ones(len(points)), dtype=float)
    homogeneous = BSpline(np.asarray(knots, dtype=float), np.column_stack((np.asarray(points) * w[:, None], w)), degree)
    breaks = np.unique(np.asarray(knots, dtype=float)[degree : len(points) + 1])
    return Curve(homogeneous, homogeneous.derivative(), breaks, degree)


def quarter_ellipse(a: float, b: float) -> Curve:
    return spline(2, [0, 0, 0, 1, 1, 1], [(a, 0), (a, b), (0, b)], [1, math.sqrt(0.5), 1])


def smooth(at: Callable[[Array], tuple[Array, Array]], low: float, high: float, degree: int = 8) -> Curve:
    """A curve given by points and slopes; `degree` so high that polynomials of it follow every part well."""

    def homogeneous(t: Array) -> Array:
        return np.column_stack((at(t)[0], np.ones(len(t))))

    def derivative(t: Array) -> Array:
        return np.column_stack((at(t)[1], np.zeros(len(t))))

    return Curve(homogeneous, derivative, np.array([low, high]), degree)


def involute(r: float, low: float, high: float) -> Curve:
    def at(t: Array) -> tuple[Array, Array]:
        c, s = np.cos(t), np.sin(t)
        return r * np.column_stack((c + t * s, s - t * c)), r * np.column_stack((t * c, t * s))

    return smooth(at, low, high)


def spiral(r: float, growth: float, turns: float) -> Curve:
    """Radius r·(1 + growth·angle)."""

    def at(t: Array) -> tuple[Array, Array]:
        e, u = np.column_stack((np.cos(t), np.sin(t))), np.column_stack((-np.sin(t), np.cos(t)))
        return r * (1 + growth * t)[:, None] * e, r * (growth * e + (1 + growth * t)[:, None] * u)

    return smooth(at, 0.0, 2 * math.pi * turns)


def least_arcs(curve: Curve, tolerance: float) -> float:
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
