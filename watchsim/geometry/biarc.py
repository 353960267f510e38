"""Which arcs follow this curve?

A biarc joins two points with given tangents by two arcs that share a tangent where they meet (K. M. Bolton, Biarc curves,
Computer-Aided Design 7, 1975). A chain of biarcs through points of a smooth curve, with the curve's own tangents,
is tangent-continuous; its distance from the curve shrinks with the cube of the step, so the number of arcs grows
as tolerance^(-1/3).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.primitives import Arc, Edge, Line, Point

Array = NDArray[np.float64]
Curve = Callable[[Array], tuple[Array, Array]]  # parameters (n,) -> points (n, 2) in metres, derivatives (n, 2)

SAMPLES = 24  # per biarc: the error curve has four humps, each then known within 1 %
SAMPLES_PER_BREAK = 8  # more where a step spans several pieces of the curve, so that none is overlooked
STRAIGHT = 1e6  # an arc of a radius above this many chords is a line: its rise is below 1.3e-7 of the chord
GOOD = 0.7  # a step whose deviation lies between GOOD and 1 times the tolerance is taken
TRIES = 8  # at most so many attempts to reach that band
NOTHING = 1e-5  # of the tolerance: edges shorter than that are left out
SHORTEST = 1e-9  # of the parameter range: at a cusp the step shrinks no further


class Fit(NamedTuple):
    """Edges in travel order, and the largest distance (metres) between the curve and them that was measured."""

    edges: tuple[Edge, ...]
    deviation: float


class _Knot(NamedTuple):
    """A point of the curve at parameter t with its unit tangent."""

    t: float
    at: Point
    tangent: Point


def fit_arcs(curve: Curve, breaks: Sequence[float], tolerance: float) -> Fit:
    """Arcs along `curve` from the first to the last of the ascending parameters `breaks`, within `tolerance` metres.

    The curve must be smooth in between; inner breaks mark where pieces of it meet (knots), to look closely there.
    """
    inner = np.asarray(breaks, dtype=float)
    stop = float(inner[-1])
    here = _knot(curve, float(inner[0]), inner)
    step = (stop - here.t) / 4.0
    edges: list[Edge] = []
    worst = 0.0
    while here.t < stop:
        there, piece, deviation = _longest_step(curve, here, step, inner, tolerance)
        edges.extend(edge for edge in piece if edge.length > NOTHING * tolerance)
        worst = max(worst, deviation)
        step = 1.1 * (there.t - here.t)
        here = there
    return Fit(tuple(edges), worst)


def _longest_step(curve: Curve, here: _Knot, step: float, breaks: Array, tolerance: float) -> tuple[_Knot, list[Edge], float]:
    """The biarc from `here` that nearly exhausts the tolerance: its far end, its edges, its deviation."""
    start, stop = float(breaks[0]), float(breaks[-1])
    smallest = SHORTEST * (stop - start)
    best: tuple[_Knot, list[Edge], float] | None = None
    tries = 0
    while True:
        # A remainder too small to matter is taken along: no sliver at the end.
        t = stop if here.t + 1.01 * step >= stop else here.t + step
        there = _knot(curve, t, breaks)
        edges = _candidate(here, there, tolerance)
        deviation = _deviation(curve, here, there, edges, breaks) if edges else math.inf
        tries += 1
        if deviation <= tolerance:
            best = (there, edges, deviation)
            if t == stop or deviation >= GOOD * tolerance or tries >= TRIES:
                return best
        elif best is not None and tries >= TRIES:
            return best
        if t - here.t <= smallest:
            chord: Edge = Line(*here.at, *there.at)
            return there, [chord], _deviation(curve, here, there, [chord], breaks)
        change = (0.9 * tolerance / deviation) ** (1.0 / 3.0) if deviation > 0.0 else 4.0
        step = (t - here.t) * min(max(change, 0.2), 4.0)


def _candidate(here: _Knot, there: _Knot, tolerance: float) -> list[Edge]:
    """A biarc; within a tolerance from end to end also a line: where the curve pauses or turns back it has no tangent."""
    edges = biarc(here.at, here.tangent, there.at, there.tangent)
    if not edges and math.dist(here.at, there.at) <= tolerance:
        return [Line(*here.at, *there.at)]
    return edges


def biarc(p: Point, tangent_p: Point, q: Point, tangent_q: Point) -> list[Edge]:
    """The two arcs (or lines) from p to q with these unit tangents; empty where there is no sensible biarc.

    Both end legs of the control polygon p, p + d·tp, q - d·tq, q have length d and the middle one 2d; with v = q - p,
    t = tp + tq and u = tp - tq that says d² u² + 2d v·t - v² = 0, whose positive root is written so that nothing cancels.
    """
    vx, vy = q[0] - p[0], q[1] - p[1]
    tx, ty = tangent_p[0] + tangent_q[0], tangent_p[1] + tangent_q[1]
    ux, uy = tangent_p[0] - tangent_q[0], tangent_p[1] - tangent_q[1]
    vv, vt, uu = vx * vx + vy * vy, vx * tx + vy * ty, ux * ux + uy * uy
    root = vt + math.sqrt(vt * vt + uu * vv)
    if vt <= 0.0 or root <= 0.0:
        return []
    d = vv / root
    joint = (0.5 * (p[0] + q[0] + d * ux), 0.5 * (p[1] + q[1] + d * uy))
    if joint in (p, q):
        return []
    first = arc_from(p, tangent_p, joint)
    second = arc_from(q, (-tangent_q[0], -tangent_q[1]), joint).reversed()
    return [first, second]


def arc_from(p: Point, tangent: Point, q: Point) -> Edge:
    """The arc from p, leaving along the unit `tangent`, to q; a line where it is straight."""
    cx, cy = q[0] - p[0], q[1] - p[1]
    along, across = cx * tangent[0] + cy * tangent[1], cy * tangent[0] - cx * tangent[1]
    chord2 = cx * cx + cy * cy
    if 2.0 * abs(across) * STRAIGHT <= math.sqrt(chord2):
        return Line(*p, *q)
    r = chord2 / (2.0 * across)  # positive: the centre lies to the left
    x, y = p[0] - r * tangent[1], p[1] + r * tangent[0]
    return Arc(x, y, abs(r), math.atan2(p[1] - y, p[0] - x), 2.0 * math.atan2(across, along))


def _knot(curve: Curve, t: float, breaks: Array) -> _Knot:
    points, slopes = curve(np.array([t]))
    (x, y), (dx, dy) = points[0], slopes[0]
    speed = math.hypot(dx, dy)
    if speed <= 0.0 or not math.isfinite(speed):
        return _Knot(t, (float(x), float(y)), _limit_tangent(curve, t, breaks))
    return _Knot(t, (float(x), float(y)), (float(dx / speed), float(dy / speed)))


def _limit_tangent(curve: Curve, t: float, breaks: Array) -> Point:
    """Where the curve pauses (coincident control points) its direction is that of the way just after, or before the end."""
    reach = 1e-4 * (breaks[-1] - breaks[0])
    ahead = t + reach <= breaks[-1]
    points, _ = curve(np.array([t, t + reach] if ahead else [t - reach, t]))
    dx, dy = points[1] - points[0]
    length = math.hypot(dx, dy)
    return (float(dx / length), float(dy / length)) if length > 0.0 else (1.0, 0.0)


def _deviation(curve: Curve, here: _Knot, there: _Knot, edges: list[Edge], breaks: Array) -> float:
    """The largest distance between the curve from `here` to `there` and one line or the two arcs of a biarc."""
    inside = breaks[np.searchsorted(breaks, here.t, "right") : np.searchsorted(breaks, there.t, "left")]
    stations = np.concatenate(([here.t], inside, [there.t]))
    count = max(SAMPLES // (len(stations) - 1), SAMPLES_PER_BREAK)
    fractions = np.arange(count) / count
    t = (stations[:-1, None] + np.diff(stations)[:, None] * fractions).ravel()
    points, _ = curve(t)
    if not np.all(np.isfinite(points)):
        return math.inf
    if len(edges) == 1:
        return _peak(_distances(points, edges[0]))
    if any(isinstance(edge, Arc) and abs(edge.sweep) > math.pi for edge in edges):
        return math.inf
    (jx, jy), (tx, ty) = edges[0].end, edges[1].tangent(0.0)
    before = (points[:, 0] - jx) * tx + (points[:, 1] - jy) * ty < 0.0
    return _peak(np.where(before, _distances(points, edges[0]), _distances(points, edges[1])))


def _distances(points: Array, edge: Edge) -> Array:
    """Distances from the endless line or the full circle of the edge: beside the edge these are the true ones."""
    if isinstance(edge, Arc):
        return np.abs(np.hypot(points[:, 0] - edge.x, points[:, 1] - edge.y) - edge.radius)
    if edge.length == 0.0:
        return np.hypot(points[:, 0] - edge.x0, points[:, 1] - edge.y0)
    tx, ty = edge.tangent(0.0)
    return np.abs((points[:, 1] - edge.y0) * tx - (points[:, 0] - edge.x0) * ty)


def _peak(values: Array) -> float:
    """The top of the parabola through the largest sample and its neighbours."""
    k = int(np.argmax(values))
    top = float(values[k])
    if not 0 < k < len(values) - 1:
        return top
    left, right = float(values[k - 1]), float(values[k + 1])
    bend = 2.0 * top - left - right
    return top + (right - left) ** 2 / (8.0 * bend) if bend > 0.0 else top
