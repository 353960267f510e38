"""Which lines and arcs is a spline made of?

A spline is cut where its smoothness ends (knots as often repeated as its degree); what is straight becomes a line, what
is an exact circle becomes an arc, and only the rest is fitted.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.affine import Vector
from watchsim.drawing.dense_polygon import polygon_edges
from watchsim.drawing.shapes import Spline
from watchsim.drawing.tags import DxfError
from watchsim.geometry.biarc import Curve, Fit, fit_arcs
from watchsim.geometry.primitives import TURN, Arc, Edge, Line

Array = NDArray[np.float64]
HIGHEST_DEGREE = 24  # CAD programs stop at 11; beyond this the basis functions lose their digits
SAME_KNOT = 1e-10  # of the knots' range
WEIGHTIEST = 1e9  # times the smallest weight
ON_CIRCLE = 1e-9  # of the radius: rational circles are exact up to the decimals they are written with
ON_LINE = 1e-12  # of the length


class Piece(NamedTuple):
    """A smooth part of a spline in the plane: homogeneous control points (n, 3) in metres and its knots."""

    degree: int
    knots: Array
    points: Array

    @property
    def breaks(self) -> Array:
        """The distinct knots of its domain."""
        return np.unique(self.knots[self.degree : len(self.knots) - self.degree])


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
    if spline.degree == 1:
        return polygon_edges(scale * np.array([(x, y) for x, y, _ in spline.points]), tolerance)
    edges: list[Edge] = []
    worst, fitted = 0.0, False
    for piece in pieces(spline, scale):
        exact = straight(piece) or circular(piece)
        if exact is None:
            fit = fit_arcs(evaluator(piece), list(piece.breaks), tolerance)
            edges.extend(fit.edges)
            worst, fitted = max(worst, fit.deviation), True
        elif not (edges and extend(edges, exact)):
            edges.append(exact)
    return Fit(tuple(edges), worst), fitted


def pieces(spline: Spline, scale: float) -> list[Piece]:
    """The spline cut at its corners: a span between cuts keeps the control points that act on it."""
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
        result.append(Piece(degree, knots[last - degree : begin + degree + 1], points[last - degree : begin]))
    return result


def evaluator(piece: Piece) -> Curve:
    """Points and derivatives of the piece, by the quotient rule from homogeneous coordinates."""
    from scipy.interpolate import BSpline

    curve = BSpline(piece.knots, piece.points, piece.degree)
    slope = curve.derivative()

    def at(t: Array) -> tuple[Array, Array]:
        h, dh = curve(t), slope(t)
        points = h[:, :2] / h[:, 2:]
        return points, (dh[:, :2] - points * dh[:, 2:]) / h[:, 2:]

    return at


def samples(piece: Piece) -> Array:
    """Points (n, 2), so many on each polynomial part that lying on a circle there means lying on it everywhere."""
    count = 2 * piece.degree + 2
    breaks = piece.breaks
    t = (breaks[:-1, None] + np.diff(breaks)[:, None] * np.arange(count) / count).ravel()
    return evaluator(piece)(np.append(t, breaks[-1]))[0]


def straight(piece: Piece) -> Line | None:
    """The line, if all control points lie on it in order."""
    points = piece.points[:, :2] / piece.points[:, 2:]
    chord = points[-1] - points[0]
    length = math.hypot(*chord)
    if length == 0.0 or not clamped(piece):
        return None
    offset = points - points[0]
    across = np.abs(offset[:, 1] * chord[0] - offset[:, 0] * chord[1])
    along = offset @ chord
    if np.max(across) > ON_LINE * length * length or np.any(np.diff(along) < -ON_LINE * length * length):
        return None
    return Line(float(points[0, 0]), float(points[0, 1]), float(points[-1, 0]), float(points[-1, 1]))


def clamped(piece: Piece) -> bool:
    """Does the piece begin at its first and end at its last control point?"""
    d, knots = piece.degree, piece.knots
    return bool(knots[1] == knots[d] and knots[-2] == knots[-1 - d])


def circular(piece: Piece) -> Arc | None:
    """The arc, if the whole piece lies on one circle and runs one way along it."""
    points = samples(piece)
    third = len(points) // 3
    centre = circumcentre(points[0], points[third], points[2 * third])
    if centre is None:
        return None
    radii = np.hypot(*(points - centre).T)
    radius = float(np.mean(radii))
    if np.max(np.abs(radii - radius)) > ON_CIRCLE * radius:
        return None
    angles = np.unwrap(np.arctan2(points[:, 1] - centre[1], points[:, 0] - centre[0]))
    steps = np.diff(angles)
    if not (np.all(steps > 0.0) or np.all(steps < 0.0)):
        return None
    return Arc(float(centre[0]), float(centre[1]), radius, float(angles[0]), float(angles[-1] - angles[0]))


def circumcentre(a: Array, b: Array, c: Array) -> Array | None:
    """The centre of the circle through three points, None where it is too far to be told from a line."""
    (bx, by), (cx, cy) = b - a, c - a
    area = 2.0 * (bx * cy - by * cx)
    bb, cc = bx * bx + by * by, cx * cx + cy * cy
    if abs(area) <= 1e-6 * max(bb, cc):
        return None
    return a + np.array([cy * bb - by * cc, bx * cc - cx * bb]) / area


def extend(edges: list[Edge], following: Edge) -> bool:
    """Joins an arc of the same circle to the last edge: a circle drawn in pieces is one circle again."""
    last = edges[-1]
    if not (isinstance(last, Arc) and isinstance(following, Arc)) or last.sweep * following.sweep < 0.0:
        return False
    apart = math.hypot(last.x - following.x, last.y - following.y) + abs(last.radius - following.radius)
    if apart > 4.0 * ON_CIRCLE * last.radius:
        return False
    sweep = last.sweep + following.sweep
    if abs(sweep) > TURN - ON_CIRCLE:
        sweep = math.copysign(TURN, sweep)
    edges[-1] = Arc(last.x, last.y, last.radius, last.start_angle, sweep)
    return True
