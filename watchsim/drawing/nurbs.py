"""Which lines and arcs is a spline made of?

A spline is cut where its smoothness ends (knots as often repeated as its degree); parts that are straight or round become
lines and arcs, and only the rest is fitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.affine import Vector
from watchsim.drawing.dense_polygon import polygon_edges
from watchsim.drawing.shapes import Spline
from watchsim.drawing.tags import DxfError
from watchsim.geometry.curve import Curve
from watchsim.geometry.fit import Fit, fit_arcs
from watchsim.geometry.primitives import Edge, Line
from watchsim.geometry.recognise import Part, joined, parts, whole_circle

Array = NDArray[np.float64]
HIGHEST_DEGREE = 24  # CAD programs stop at 11; beyond this the basis functions lose their digits
SAME_KNOT = 1e-10  # of the knots' range
WEIGHTIEST = 1e9  # times the smallest weight


def spline_from(
    degree: int,
    closed: bool,
    knots: Sequence[float],
    weights: Sequence[float],
    points: Sequence[Vector],
    fit_points: Sequence[Vector],
    tangents: Sequence[Vector] = (),
) -> Spline:
    """The spline of those parts, complete and consistent; DxfError says what does not fit."""
    if not points:
        return through(fit_points, tangents)
    if not 1 <= degree <= HIGHEST_DEGREE:
        raise DxfError(f"its degree is {degree}")
    if not knots:
        knots, points, weights = uniform(degree, closed, points, weights)
    if len(points) <= degree or len(knots) != len(points) + degree + 1:
        raise DxfError(f"{len(points)} control points and {len(knots)} knots do not make a spline of degree {degree}")
    if weights and (len(weights) != len(points) or not 0.0 < max(weights) <= WEIGHTIEST * min(weights)):
        raise DxfError("its weights are not one positive number of similar size for each control point")
    clean = cleaned(knots)
    if not clean[degree] < clean[len(points)]:
        raise DxfError("its knots do not ascend")
    return Spline(degree, clean, list(points), list(weights))


def cleaned(knots: Sequence[float]) -> list[float]:
    """Knots that ascend, those that differ by rounding made equal."""
    same = SAME_KNOT * (max(knots) - min(knots))
    result = [float(knots[0])]
    for knot in knots[1:]:
        if knot < result[-1] - same:
            raise DxfError("its knots do not ascend")
        result.append(float(knot) if knot > result[-1] + same else result[-1])
    return result


def uniform(
    degree: int, closed: bool, points: Sequence[Vector], weights: Sequence[float]
) -> tuple[list[float], list[Vector], list[float]]:
    """Knots for a spline that has none: ends clamped, or wrapped around if it is closed."""
    inner = len(points) - degree
    if not closed:
        middle = [float(k) for k in range(1, inner)]
        return [0.0] * (degree + 1) + middle + [float(max(inner, 1))] * (degree + 1), list(points), list(weights)
    wrapped = [*points, *points[:degree]]
    knots = [float(k) for k in range(len(wrapped) + degree + 1)]
    return knots, wrapped, [*weights, *weights[:degree]] if weights else []


def through(fit_points: Sequence[Vector], tangents: Sequence[Vector]) -> Spline:
    """The cubic spline through points, as CAD programs draw it (ezdxf's)."""
    from ezdxf.math import fit_points_to_cad_cv

    if len(fit_points) < 2:
        raise DxfError("it has neither control points nor at least two fit points")
    try:
        curve = fit_points_to_cad_cv(fit_points, tangents=list(tangents) or None)
    except (ValueError, ArithmeticError) as error:
        raise DxfError(f"no curve can be laid through its fit points ({error})") from None
    points = [(p.x, p.y, p.z) for p in curve.control_points]
    return spline_from(curve.degree, False, list(curve.knots()), list(curve.weights() or ()), points, ())


def spline_edges(spline: Spline, scale: float, tolerance: float) -> tuple[Fit, bool]:
    """Lines and arcs (metres) along a spline in units of `scale` metres; and whether anything had to be fitted."""
    plane = scale * np.array([(x, y) for x, y, _ in spline.points])
    if np.all(plane == plane[0]):
        return Fit((Line(*plane[0].tolist(), *plane[0].tolist()),), 0.0), False  # of no length: the reader will say so
    if spline.degree == 1:
        return polygon_edges(plane, tolerance)
    edges: list[Edge] = []
    worst, fitted = 0.0, False
    for curve in pieces(spline, scale):
        for part in parts(curve, tolerance):
            if part.edge is not None:
                edges.append(part.edge)
                continue
            fit = followed(curve, part, tolerance)
            edges.extend(fit.edges)
            worst, fitted = max(worst, fit.deviation), True
    edges, shift = joined(edges, tolerance - worst)
    return Fit(tuple(edges), worst + shift), fitted


def followed(curve: Curve, part: Part, tolerance: float) -> Fit:
    """A circle where that is within the tolerance, else the fewest arcs."""
    inner = curve.between(part.low, part.high)
    open_part = Curve(curve.homogeneous, curve.derivative, np.array([part.low, *inner, part.high]), curve.degree)
    return whole_circle(open_part, tolerance) or fit_arcs(open_part, tolerance)


def pieces(spline: Spline, scale: float) -> list[Curve]:
    """The spline cut at its corners: a span between cuts keeps the control points that act on it."""
    from scipy.interpolate import BSpline

    degree = spline.degree
    knots = np.asarray(spline.knots)
    weights = np.asarray(spline.weights) if spline.weights else np.ones(len(spline.points))
    plane = scale * np.array([(x, y) for x, y, _ in spline.points])
    points = np.column_stack((plane * weights[:, None], weights))
    distinct, first, count = np.unique(knots, return_index=True, return_counts=True)
    low, high = knots[degree], knots[len(points)]
    cuts = [k for k in range(len(distinct)) if low < distinct[k] < high and count[k] >= degree]
    ends = [int(np.searchsorted(distinct, low)), *cuts, int(np.searchsorted(distinct, high))]
    result = []
    for a, b in pairwise(ends):
        last, begin = int(first[a] + count[a] - 1), int(first[b])
        own = knots[last - degree : begin + degree + 1]
        curve = BSpline(own, points[last - degree : begin], degree)
        result.append(Curve(curve, curve.derivative(), distinct[a : b + 1], degree))
    return result
