"""Which lines and arcs is a spline made of?

A spline is cut where its smoothness ends (knots as often repeated as its degree); parts that are straight or round become
lines and arcs, and only the rest is fitted.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.dxf_records import DxfError
from watchsim.drawing.projection import Spline, Vector
from watchsim.geometry.biarcs import Array, Curve, beziers
from watchsim.geometry.fitting import Fit, fit_all, fit_arcs
from watchsim.geometry.primitives import Edge, Line, moved, reflected
from watchsim.geometry.recognition import Part, parts_of, put_together, whole_circle

# Programs may store a spline by the points it was drawn through alone. Between them it is cubic, with steady curvature.

FEWEST = 3  # points round a closed curve


class Cubic(NamedTuple):
    """A B-spline without weights."""

    degree: int
    knots: list[float]
    points: list[Vector]


def through(fit_points: Sequence[Vector], tangents: Sequence[Vector], closed: bool) -> Cubic:
    """The cubic spline through points; smooth at its end, too, where it is closed and does not repeat its first point."""
    if len(fit_points) < 2:
        raise DxfError("it has neither control points nor at least two fit points")
    distinct = [b for a, b in pairwise([fit_points[-1], *fit_points]) if a != b]
    if closed and fit_points[0] != fit_points[-1] and len(distinct) >= FEWEST:
        return around(distinct)
    # As CAD programs draw it (ezdxf's).
    from ezdxf.math import fit_points_to_cad_cv

    try:
        curve = fit_points_to_cad_cv(fit_points, tangents=list(tangents) or None)
    except (ValueError, ArithmeticError) as error:
        raise DxfError(f"no curve can be laid through its fit points ({error})") from None
    return Cubic(curve.degree, list(curve.knots()), [(p.x, p.y, p.z) for p in curve.control_points])


def around(fit_points: Sequence[Vector]) -> Cubic:
    """The periodic cubic spline with the chords' lengths as its parameter (C. de Boor, A Practical Guide to Splines, ch. IV).

    At each point the second derivatives from both sides agree: that fixes the slopes. Double knots between cubic pieces.
    """
    p = np.array(fit_points)
    chords = np.roll(p, -1, axis=0) - p
    after = np.sqrt(np.sum(chords * chords, axis=1))
    before = np.roll(after, 1)
    rise = chords / after[:, None]
    number = np.arange(len(p))
    matrix = np.diag(2.0 * (before + after))
    matrix[number, number - 1] += after
    matrix[number, (number + 1) % len(p)] += before
    slopes = np.linalg.solve(matrix, 3.0 * (after[:, None] * np.roll(rise, 1, axis=0) + before[:, None] * rise))
    handles = after[:, None] * slopes / 3.0, after[:, None] * np.roll(slopes, -1, axis=0) / 3.0
    inner = np.stack((p + handles[0], np.roll(p, -1, axis=0) - handles[1]), axis=1).reshape(-1, 3)
    breaks = np.append(0.0, np.cumsum(after)).tolist()
    points = [(x, y, z) for x, y, z in np.vstack((p[:1], inner, p[:1])).tolist()]
    return Cubic(3, [breaks[0]] * 2 + [knot for knot in breaks for _ in (0, 1)] + [breaks[-1]] * 2, points)


# Some programs write curves as splines of degree one: polygons with facets far below any tolerance. Where the facets are so
# fine that a smooth curve through their corners stays within the tolerance of them, the smooth curve is followed instead; real
# corners and coarse facets stay lines.

FEWEST_FACETS = 8  # facets in a row before they are taken for a curve
SHARPEST = math.radians(10.0)  # a corner, however short its sides


def polygon_edges(points: Array, tolerance: float) -> tuple[Fit, bool]:
    """Lines, or arcs within `tolerance` metres, along the polygon through `points` (n, 2); and whether any were fitted."""
    points = points[np.append(True, np.any(np.diff(points, axis=0) != 0.0, axis=1))]
    cuts = corners(points, tolerance)
    edges: list[Edge] = []
    worst, fitted = 0.0, False
    for a, b in pairwise(cuts):
        fit = smooth(points[a : b + 1], tolerance) if b - a >= FEWEST_FACETS else None
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
    own = [next(fits) if part.edge is None else Fit((part.edge,), 0.0) for part in parts]
    return put_together(own, tolerance), any(part.edge is None for part in parts)


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


# Splines of a drawing may be copies of each other: blocks that are inserted many times, teeth that were drawn once and turned,
# the two halves of a symmetrical part. What is followed once need only be turned, shifted or mirrored. A copy may differ by
# rounding, which is measured: a spline leaves another one by no more than their control points do.

SAME = 1e-3  # of the tolerance: copies may differ by so much
TRIED = 4  # splines of the same size that are compared


class Motion(NamedTuple):
    """Takes z = x + iy to `turn`·z + `shift`, or to `turn`·conj(z) + `shift` where it mirrors."""

    turn: complex
    shift: complex
    mirrors: bool

    def edge(self, edge: Edge) -> Edge:
        """The image of an edge (metres, as is `shift`), travelled in the same direction."""
        image = reflected(edge, (0.0, 0.0), (1.0, 0.0)) if self.mirrors else edge
        return moved(image, cmath.phase(self.turn), (self.shift.real, self.shift.imag))


class Follower:
    """Follows splines (drawing units of `scale` metres) by lines and arcs, those that are copies of earlier ones by copies."""

    def __init__(self, scale: float) -> None:
        self.scale = scale
        self.fits: list[tuple[Fit, bool]] = []
        self.places: list[np.ndarray] = []  # control points of the splines that were followed, complex, metres
        self.alike: dict[tuple[object, ...], list[int]] = {}

    def edges(self, splines: Sequence[Spline], tolerances: Sequence[float]) -> list[tuple[Fit, bool]]:
        """For each spline its edges (metres), and whether anything had to be fitted."""
        plans: list[tuple[int, Motion | None, float]] = []
        fresh: list[int] = []
        for k, (spline, limit) in enumerate(zip(splines, tolerances, strict=True)):
            plan = self._plan(spline, limit)
            if plan[1] is None:
                fresh.append(k)
            plans.append(plan)
        self.fits += splines_edges([splines[k] for k in fresh], self.scale, [tolerances[k] for k in fresh])
        return [self._fit(*plan) for plan in plans]

    def _plan(self, spline: Spline, limit: float) -> tuple[int, Motion | None, float]:
        """Which fit the spline takes, its own or another one's, moved; and by how far that misses (metres)."""
        z = self.scale * np.array([complex(x, y) for x, y, _ in spline.points])
        size = float(np.sum(np.abs(np.diff(z))))
        key = (spline.degree, round(size / limit), limit, tuple(spline.knots), tuple(spline.weights))
        others = self.alike.setdefault(key, [])
        for number in others[:TRIED]:
            for mirrors in (False, True):
                motion, away = motion_between(self.places[number], z, mirrors)
                if away <= SAME * limit:
                    return number, motion, away
        others.append(len(self.places))
        self.places.append(z)
        return len(self.places) - 1, None, 0.0

    def _fit(self, number: int, motion: Motion | None, away: float) -> tuple[Fit, bool]:
        fit, fitted = self.fits[number]
        if motion is None:
            return fit, fitted
        return Fit(tuple(map(motion.edge, fit.edges)), fit.deviation + away), fitted


def motion_between(z: np.ndarray, image: np.ndarray, mirrors: bool) -> tuple[Motion, float]:
    """The motion that takes some points nearly to others, and how far it misses; points as complex numbers."""
    if mirrors:
        z = z.conjugate()
    far = int(np.argmax(np.abs(z - z[0])))
    arm = (image[far] - image[0]) * (z[far] - z[0]).conjugate()
    if arm == 0.0:
        return Motion(1.0 + 0.0j, 0.0j, mirrors), math.inf
    turn = complex(arm / abs(arm))
    shift = complex(np.mean(image - turn * z))
    return Motion(turn, shift, mirrors), float(np.max(np.abs(turn * z + shift - image)))
