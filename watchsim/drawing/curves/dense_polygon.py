"""Which arcs follow a curve that was exported as very many points?

Some programs write curves as splines of degree one: polygons with facets far below any tolerance. Where the facets are so
fine that a smooth curve through their corners stays within the tolerance of them, the smooth curve is followed instead; real
corners and coarse facets stay lines.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.fitting.curve import Curve
from watchsim.geometry.fitting.fit import Fit, fit_arcs
from watchsim.geometry.primitives import Edge, Line

Array = NDArray[np.float64]
FEWEST = 8  # facets in a row before they are taken for a curve
SHARPEST = math.radians(10.0)  # a corner, however short its sides


def polygon_edges(points: Array, tolerance: float) -> tuple[Fit, bool]:
    """Lines, or arcs within `tolerance` metres, along the polygon through `points` (n, 2); and whether any were fitted."""
    points = points[np.append(True, np.any(np.diff(points, axis=0) != 0.0, axis=1))]
    cuts = corners(points, tolerance)
    edges: list[Edge] = []
    worst, fitted = 0.0, False
    for a, b in pairwise(cuts):
        fit = smooth(points[a : b + 1], tolerance) if b - a >= FEWEST else None
        if fit is None:
            edges.extend(Line(*points[k].tolist(), *points[k + 1].tolist()) for k in range(a, b))
        else:
            edges.extend(fit.edges)
            worst, fitted = max(worst, fit.deviation), True
    return Fit(tuple(edges), worst), fitted


def corners(points: Array, tolerance: float) -> list[int]:
    """Numbers of the points where a smooth curve could not stay within half the tolerance of the facets, and both ends."""
    sides = np.diff(points, axis=0)
    lengths = np.hypot(sides[:, 0], sides[:, 1])
    before, after = sides[:-1], sides[1:]
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turns = np.abs(np.arctan2(across, np.sum(before * after, axis=1)))
    rise = np.maximum(lengths[:-1], lengths[1:]) * turns / 8.0  # of an arc with that turn over the longer side
    sharp = np.flatnonzero((rise > 0.5 * tolerance) | (turns > SHARPEST)) + 1
    return [0, *(int(k) for k in sharp), len(points) - 1]


def smooth(points: Array, tolerance: float) -> Fit | None:
    """Arcs along the smooth curve through the points; None where it swings too far from their polygon."""
    from scipy.interpolate import CubicSpline

    sides = np.diff(points, axis=0)
    lengths = np.hypot(sides[:, 0], sides[:, 1])
    s = np.append(0.0, np.cumsum(lengths))
    curve = CubicSpline(s, points)
    between = (s[:-1, None] + lengths[:, None] * np.array([0.25, 0.5, 0.75])).ravel()
    side = np.repeat(np.arange(len(sides)), 3)
    offset = curve(between) - points[side]
    swing = float(np.max(np.abs(sides[side, 0] * offset[:, 1] - sides[side, 1] * offset[:, 0]) / lengths[side]))
    if swing > 0.5 * tolerance:
        return None
    follow = Curve(_bezier_spans(curve.c, lengths), s)
    fit = fit_arcs(follow, tolerance - swing)
    return Fit(fit.edges, fit.deviation + swing)


def _bezier_spans(powers: Array, widths: Array) -> Array:
    """Control points (n, 4, 3), weight 1, of cubics given by falling powers (4, n, 2) of what is up to `widths` (n,)."""
    cubic, square, linear, constant = (powers[k] * widths[:, None] ** (3 - k) for k in range(4))
    points = (constant, constant + linear / 3.0, constant + (2.0 * linear + square) / 3.0, constant + linear + square + cubic)
    control: Array = np.ones((len(widths), 4, 3))
    control[:, :, :2] = np.stack(points, axis=1)
    return control
