"""Which lines and arcs is a spline made of?

A spline is cut where its smoothness ends (knots as often repeated as its degree); parts that are straight or round become
lines and arcs, and only the rest is fitted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.curves.affine import Vector
from watchsim.drawing.curves.dense_polygon import polygon_edges
from watchsim.drawing.curves.fit_points import through
from watchsim.drawing.curves.plane_shapes import Spline
from watchsim.drawing.dxf_records import DxfError
from watchsim.geometry.fitting.bspline import beziers
from watchsim.geometry.fitting.curve import Curve
from watchsim.geometry.fitting.fit import Fit, fit_all
from watchsim.geometry.fitting.recognise import Part, joined, parts_of, whole_circle
from watchsim.geometry.primitives import Edge, Line

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
        degree, knots, points = through(fit_points, tangents, closed)
        closed, weights = False, ()
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


def splines_edges(splines: Sequence[Spline], scale: float, tolerances: Sequence[float]) -> list[tuple[Fit, bool]]:
    """Lines and arcs (metres) along splines in units of `scale` metres; and whether anything had to be fitted."""
    result: list[tuple[Fit, bool]] = [(Fit((), 0.0), False)] * len(splines)
    curved = []
    for k, spline in enumerate(splines):
        if all(point[:2] == spline.points[0][:2] for point in spline.points):
            x, y = scale * spline.points[0][0], scale * spline.points[0][1]
            result[k] = Fit((Line(x, y, x, y),), 0.0), False  # of no length: the reader will say so
        elif spline.degree == 1:
            result[k] = polygon_edges(scale * np.array([(x, y) for x, y, _ in spline.points]), tolerances[k])
        else:
            curved.append(k)
    pieces = pieces_of([splines[k] for k in curved], scale)
    limits = [tolerances[k] for k, row in zip(curved, pieces, strict=True) for _ in row]
    parts = parts_of([piece for row in pieces for piece in row], limits)
    wanted = [(part.curve, limit) for row, limit in zip(parts, limits, strict=True) for part in row if part.edge is None]
    fits = iter(followed([curve for curve, _ in wanted], [limit for _, limit in wanted]))
    rows = iter(parts)
    for k, row in zip(curved, pieces, strict=True):
        result[k] = _put_together([part for _ in row for part in next(rows)], fits, tolerances[k])
    return result


def _put_together(parts: Sequence[Part], fits: Iterator[Fit], tolerance: float) -> tuple[Fit, bool]:
    """The edges of the parts of one spline: their own, or the next of the fits."""
    if len(parts) == 1 and parts[0].edge is None:
        return next(fits), True
    edges: list[Edge] = []
    worst, fitted = 0.0, False
    for part in parts:
        if part.edge is not None:
            edges.append(part.edge)
            continue
        fit = next(fits)
        edges.extend(fit.edges)
        worst, fitted = max(worst, fit.deviation), True
    edges, shift = joined(edges, tolerance - worst)
    return Fit(tuple(edges), worst + shift), fitted


def followed(curves: Sequence[Curve], tolerances: Sequence[float]) -> list[Fit]:
    """Circles where these are within the tolerance, else the fewest arcs."""
    circles = [whole_circle(curve, limit) for curve, limit in zip(curves, tolerances, strict=True)]
    rest = [k for k, circle in enumerate(circles) if circle is None]
    fits = iter(fit_all([curves[k] for k in rest], [tolerances[k] for k in rest]))
    return [next(fits) if circle is None else circle for circle in circles]


def pieces_of(splines: Sequence[Spline], scale: float) -> list[list[Curve]]:
    """Each spline cut at its corners, in metres."""
    result: list[list[Curve]] = [[] for _ in splines]
    for degree in {spline.degree for spline in splines}:
        chosen = [k for k, spline in enumerate(splines) if spline.degree == degree]
        for k, row in zip(chosen, _pieces(degree, [splines[k] for k in chosen], scale), strict=True):
            result[k] = row
    return result


def _pieces(degree: int, splines: Sequence[Spline], scale: float) -> Iterator[list[Curve]]:
    """The same for splines of one degree."""
    knots = np.array([knot for spline in splines for knot in spline.knots])
    weights = np.array([w for spline in splines for w in spline.weights or [1.0] * len(spline.points)])[:, None]
    plane = scale * np.array([(x, y) for spline in splines for x, y, _ in spline.points])
    starts = [[i for i in range(degree, len(s.points)) if s.knots[i] < s.knots[i + 1]] for s in splines]
    counts = [len(row) for row in starts]
    local = np.array([i for row in starts for i in row])
    knot = local + np.repeat(_first([len(spline.knots) for spline in splines]), counts)
    point = local + np.repeat(_first([len(spline.points) for spline in splines]), counts)
    control = beziers(degree, knots, np.hstack((plane * weights, weights)), knot, point)
    if np.all(weights == 1.0):
        control[..., 2] = 1.0
    for row, spline, first in zip(starts, splines, _first(counts).tolist(), strict=True):
        # Between two spans there are as many equal knots as their starts are apart.
        cuts = [0, *(j for j in range(1, len(row)) if row[j] - row[j - 1] >= degree), len(row)]
        breaks = np.array([*(spline.knots[i] for i in row), spline.knots[row[-1] + 1]])
        yield [Curve(control[first + a : first + b], breaks[a : b + 1]) for a, b in pairwise(cuts)]


def _first(counts: Sequence[int]) -> NDArray[np.intp]:
    """Where each of some rows begins when they are put end to end."""
    return np.cumsum([0, *counts[:-1]])
