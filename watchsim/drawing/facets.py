"""Which lines and arcs do the straight pieces of a faceted outline stand for?

A mesh has no arcs. Its corners lie on the curves that it was made of, its pieces leave them by their sagitta. So a row of
corners is an arc where all lie on one circle, by far closer to it than the pieces.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.circles import FEWEST, SHARPEST
from watchsim.geometry.primitives import TURN, Arc, Edge, Line

Array = NDArray[np.float64]

SHARE = 0.25  # of the sagitta: corners further from a circle were not made of it
LEAST = 3  # pieces: through the ends of two a circle always goes
UNSEEN = 1e-6  # m: fewer than FEWEST pieces are an arc only if they leave it by less, else they may be a chamfer


class Fitted(NamedTuple):
    """Lines and arcs in a row, how many arcs, and how far (m) corners and pieces lie from these at most."""

    edges: list[Edge]
    arcs: int
    deviation: float


class _Circle(NamedTuple):
    x: float
    y: float
    radius: float
    off: float  # m, of the corners
    sagitta: float


def fitted(corners: Array, closed: bool, fit: float, rounding: float) -> Fitted:
    """The edges through corners (n, 2) in metres, of which no three neighbours lie in a line.

    The last corner of a `closed` outline is not the first. Corners lie within `fit` of arcs, and within `rounding` at best.
    """
    if closed:
        turns = _turns(np.concatenate((corners[-1:], corners, corners[:1])))
        if (whole := _whole(corners, turns, fit, rounding)) is not None:
            start = math.atan2(corners[0, 1] - whole.y, corners[0, 0] - whole.x)
            arc = Arc(whole.x, whole.y, whole.radius, start, math.copysign(TURN, turns[0]))
            return Fitted([arc], 1, whole.off + whole.sagitta)
        lengths = np.hypot(*(np.roll(corners, -1, axis=0) - corners).T)
        sharp = np.abs(turns)
        first = int(np.argmax(sharp if sharp.max() >= SHARPEST else lengths))  # where no arc goes through
        corners = np.roll(corners, -first, axis=0)
        corners = np.concatenate((corners, corners[:1]))
    return _along(corners, fit, rounding)


def _turns(points: Array) -> Array:
    """From piece to piece at the inner points, radians, positive to the left."""
    a, b = np.diff(points, axis=0)[:-1], np.diff(points, axis=0)[1:]
    turns: Array = np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], np.sum(a * b, axis=1))
    return turns


def _whole(corners: Array, turns: Array, fit: float, rounding: float) -> _Circle | None:
    """The circle that goes through all corners of a closed outline, once round."""
    if len(corners) < FEWEST or np.abs(turns).max() >= SHARPEST or abs(abs(turns.sum()) - TURN) > SHARE:
        return None
    if np.any(turns * turns[0] <= 0.0):
        return None
    middle = corners.mean(axis=0)
    local = corners - middle
    squares = np.sum(local * local, axis=1)
    (x, y, rest), *_ = np.linalg.lstsq(np.column_stack((2.0 * local, np.ones(len(local)))), squares, rcond=None)
    return _judged(
        np.concatenate((corners, corners[:1])), middle[0] + x, middle[1] + y, math.sqrt(rest + x * x + y * y), fit, rounding
    )


def _along(points: Array, fit: float, rounding: float) -> Fitted:
    """The edges of an open row of points: from each corner on the longest arc, else the piece itself."""
    turns = np.concatenate(([0.0], _turns(points), [0.0]))
    sides = np.where(np.abs(turns) < SHARPEST, np.sign(turns), 0.0)
    ends = np.flatnonzero(np.append(np.diff(sides) != 0.0, True)) + 1  # here another side begins
    edges: list[Edge] = []
    count, deviation, k = 0, 0.0, 0
    while k < len(points) - 1:
        limit = k + 1 if sides[k + 1] == 0.0 else int(ends[np.searchsorted(ends, k + 1, side="right")])
        last, circle = _longest(points, k, limit, fit, rounding)
        if circle is None or (last - k < FEWEST and circle.sagitta > UNSEEN):
            edges.append(Line(*points[k].tolist(), *points[k + 1].tolist()))
            k += 1
            continue
        start, end = (math.atan2(y - circle.y, x - circle.x) for x, y in (points[k], points[last]))
        side = float(sides[k + 1])
        edges.append(Arc(circle.x, circle.y, circle.radius, start, side * (side * (end - start) % TURN)))
        count, deviation, k = count + 1, max(deviation, circle.off + circle.sagitta), last
    return Fitted(edges, count, deviation)


def _longest(points: Array, first: int, limit: int, fit: float, rounding: float) -> tuple[int, _Circle | None]:
    """The last point, at most `limit`, up to which all lie on one circle: by steps that double, then by halving."""
    good, found, step = first + LEAST - 1, None, 1
    while step:
        circle = _through(points[first : good + step + 1], fit, rounding) if good + step <= limit else None
        if circle is not None:
            good, found, step = good + step, circle, 2 * step
        elif found is None:
            break
        else:
            limit = min(limit, good + step - 1)
            step //= 2
    return good, found


def _through(points: Array, fit: float, rounding: float) -> _Circle | None:
    """The circle through the first and last of these points (n, 2) nearest to those between, in the algebraic sense."""
    a, b = points[0], points[-1]
    middle, half = 0.5 * (a + b), 0.5 * math.dist(a, b)
    if half == 0.0:
        return None
    along = (b - a) / (2.0 * half)
    local = points[1:-1] - middle
    v = local @ np.array([-along[1], along[0]])
    square = float(v @ v)
    if square == 0.0:
        return None
    t = float((np.sum(local * local, axis=1) - half * half) @ v) / (2.0 * square)
    x, y = middle[0] - t * along[1], middle[1] + t * along[0]
    return _judged(points, float(x), float(y), math.hypot(half, t), fit, rounding)


def _judged(points: Array, x: float, y: float, radius: float, fit: float, rounding: float) -> _Circle | None:
    """The circle, if the points lie on it."""
    off = float(np.abs(np.hypot(points[:, 0] - x, points[:, 1] - y) - radius).max())
    half = 0.5 * float(np.hypot(*np.diff(points, axis=0).T).max())
    if not half < radius:
        return None
    sagitta = half * half / (radius + math.sqrt(radius * radius - half * half))
    return _Circle(x, y, radius, off, sagitta) if off <= max(min(fit, SHARE * sagitta), rounding) else None
