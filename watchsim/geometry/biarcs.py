"""Which two arcs join two points with given tangents?

A biarc: two arcs that share a tangent where they meet (K. M. Bolton, Biarc curves, Computer-Aided Design 7, 1975). Many at
a time, as arrays.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.primitives import Arc, Edge, Line, Point

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Curve:
    """Control points (spans, degree + 1, 3), homogeneous: x·w, y·w, w in metres; and the ascending breaks (spans + 1,).

    A plane curve that arcs are to follow, rational between its breaks: splines and ellipses are of this kind exactly. Its spans
    are rational Béziers (G. Farin, Curves and Surfaces for CAGD, ch. 5 and 13), whose homogeneous coordinates are polynomials:
    their range can be bounded without doubt.
    """

    control: Array
    breaks: Array

    @property
    def degree(self) -> int:
        return self.control.shape[1] - 1

    @property
    def ends(self) -> Array:
        """The first and the last point (2, 2), metres."""
        ends = np.stack((self.control[0, 0], self.control[-1, -1]))
        result: Array = ends[:, :2] / ends[:, 2:]
        return result

    def open_by(self) -> float:
        """The distance between its ends over the length of its control polygon, which is longer than the curve."""
        corners = (self.control[..., :2] / self.control[..., 2:]).reshape(-1, 2)
        sides = np.diff(corners, axis=0)
        length = float(np.sum(np.hypot(sides[:, 0], sides[:, 1])))
        return math.dist(corners[0], corners[-1]) / length if length > 0.0 else math.inf

    def spans(self, first: int, last: int) -> Curve:
        """The spans from `first` to the one before `last`."""
        return Curve(self.control[first:last], self.breaks[first : last + 1])

    def split(self, place: float) -> tuple[Curve, Curve]:
        """The curve up to a place and from there; a place is the number of a span and, after the point, its share."""
        k = int(place)
        u = place - k
        if u == 0.0:
            return self.spans(0, k), self.spans(k, len(self.control))
        middle = (1.0 - u) * self.breaks[k] + u * self.breaks[k + 1]
        before, after = halves(self.control[k], u)
        return (
            Curve(np.concatenate((self.control[:k], before[None])), np.append(self.breaks[: k + 1], middle)),
            Curve(np.concatenate((after[None], self.control[k + 1 :])), np.append(middle, self.breaks[k + 1 :])),
        )


def halves(control: Array, u: float) -> tuple[Array, Array]:
    """The control points (degree + 1, 3) of a Bézier up to its parameter u and from there, by de Casteljau's scheme."""
    before, after, level = [control[0]], [control[-1]], control
    while len(level) > 1:
        level = (1.0 - u) * level[:-1] + u * level[1:]
        before.append(level[0])
        after.append(level[-1])
    return np.array(before), np.array(after[::-1])


def binomials(degree: int) -> Array:
    return np.array([math.comb(degree, k) for k in range(degree + 1)], dtype=float)


def bernstein_sum(scaled: Array, u: Array) -> Array:
    """The polynomials of coefficients times binomials, (degree + 1, …), at u (…) from 0 to 1."""
    v, power, total = 1.0 - u, u, np.asarray(scaled[0])
    for k in range(1, len(scaled)):
        total = np.multiply(total, v, out=total if k > 1 else None)
        total += scaled[k] * power
        if k + 1 < len(scaled):
            power = power * u
    return np.broadcast_to(total, np.broadcast_shapes(total.shape, u.shape))


# Curves of one degree side by side, so that each step is made for all of them at once. A place is one number: spans are
# numbered through, one number is left out behind each curve, and the share of the span stands after the point. So the start of
# a span is a whole number, and places ascend along a curve and from curve to curve.

Numbers = NDArray[np.intp]

PAUSE = 1e-5  # of the usual speed: below that the derivative shows no direction
GLANCE = 1e-5  # of a span: so far beside the direction is looked for where the curve pauses
LOOKS = 8  # chords of a span that give its length, roughly


class Bundle:
    """Some curves of one degree: `begin` and `end` (curves,) are the places of their ends; `owner` (spans,) their numbers."""

    def __init__(self, curves: Sequence[Curve]) -> None:
        control = np.concatenate([curve.control for curve in curves])
        counts = np.array([len(curve.control) for curve in curves])
        self.degree = control.shape[1] - 1
        self.weighted = bool(np.any(control[..., 2] != 1.0))
        self.widths = np.concatenate([np.diff(curve.breaks) for curve in curves])
        self.owner: Numbers = np.repeat(np.arange(len(curves)), counts)
        self.start_of = np.arange(len(control)) + self.owner
        self.end = np.cumsum(counts + 1) - 1
        self.begin = self.end - counts
        self._span_at = np.repeat(np.arange(len(control)), 1 + (np.diff(self.owner, append=len(curves)) > 0))
        # Coefficients come first, then x, y and the weight if there is one, then the spans.
        columns = np.moveaxis(control, (1, 2), (0, 1))[:, : 3 if self.weighted else 2]
        self._scaled = np.ascontiguousarray(columns * binomials(self.degree)[:, None, None])
        self.corners = control[..., :2] / control[..., 2:]  # control points (spans, degree + 1, 2), metres
        self._slopes = np.ascontiguousarray(self.degree * np.diff(columns, axis=0) * binomials(self.degree - 1)[:, None, None])

    def __len__(self) -> int:
        return len(self.begin)

    def locate(self, places: Array) -> tuple[Numbers, Array]:
        """The spans of places, and the parameters there from 0 to 1."""
        span = self._span_at[places.astype(np.intp)]
        return span, places - self.start_of[span]

    def homogeneous(self, span: Numbers, u: Array) -> Array:
        """x·w, y·w and, where there are weights, w: (2 or 3, *u.shape), for spans (n,) and u (n,) or (n, m)."""
        scaled = self._scaled[:, :, span]
        return bernstein_sum(scaled if u.ndim == 1 else scaled[..., None], u)

    def at(self, span: Numbers, u: Array) -> Array:
        """Points (2, *u.shape), metres."""
        h = self.homogeneous(span, u)
        return h[:2] / h[2] if self.weighted else h

    def points(self, places: Array) -> Array:
        """Points (n, 2), metres."""
        return self.at(*self.locate(places)).T

    def slopes(self, places: Array) -> Array:
        """Derivatives (n, 2) of the points by the place, by the quotient rule."""
        span, u = self.locate(places)
        dh = bernstein_sum(self._slopes[:, :, span], u)
        if not self.weighted:
            return dh.T
        h = self.homogeneous(span, u)
        return ((dh[:2] - h[:2] * (dh[2] / h[2])) / h[2]).T

    def speeds(self, places: Array) -> Array:
        """Metres per unit of the curve's own parameter (n,): steady where the breaks are not evenly set."""
        slopes = self.slopes(places)
        return np.hypot(slopes[:, 0], slopes[:, 1]) / self.widths[self.locate(places)[0]]

    def tangents(self, places: Array) -> Array:
        """Unit tangents (n, 2); where the curve pauses, the direction beside."""
        slopes = self.slopes(places)
        speed = np.hypot(slopes[:, 0], slopes[:, 1])
        span = self.locate(places)[0]
        still = speed <= PAUSE * (self.usual_speed[self.owner] * self.widths)[span]
        if np.any(still):
            there, ends = places[still], self.end[self.owner[span[still]]]
            slopes = slopes.copy()
            slopes[still] = self.slopes(np.where(there + GLANCE <= ends, there + GLANCE, there - GLANCE))
            speed = np.hypot(slopes[:, 0], slopes[:, 1])
        result: Array = slopes / np.where(speed > 0.0, speed, 1.0)[:, None]
        return result

    @cached_property
    def lengths(self) -> Array:
        """Of the spans (spans,), metres: of the polygon through a few points of each."""
        u = np.broadcast_to(np.arange(LOOKS + 1) / LOOKS, (len(self.owner), LOOKS + 1))
        sides = np.diff(self.at(np.arange(len(self.owner)), u), axis=2)
        return np.sum(np.hypot(sides[0], sides[1]), axis=1)

    @cached_property
    def usual_speed(self) -> Array:
        """Length over range of the curves' own parameters (curves,), roughly."""
        return np.bincount(self.owner, self.lengths) / np.bincount(self.owner, self.widths)

    def stretches(self, low: Array, high: Array) -> tuple[Array, Array, Numbers]:
        """The intervals between places (n,) cut at the breaks: lower, upper ends, and from which interval each is."""
        first = np.floor(low)
        counts = np.maximum(1, np.ceil(high) - first).astype(np.intp)
        if np.all(counts == 1):
            return low, high, np.arange(len(low))
        source = np.repeat(np.arange(len(low)), counts)
        k = first[source] + np.arange(len(source)) - (np.cumsum(counts) - counts)[source]
        return np.maximum(low[source], k), np.minimum(high[source], k + 1.0), source


def beziers(degree: int, knots: Array, points: Array, knot: Numbers, point: Numbers) -> Array:
    """Control points (spans, degree + 1, columns) of the spans of a B-spline that start at the knots numbered `knot` (spans,).

    Control point m of degree n between the knots a < b is the blossom at n - m times a and m times b, by de Boor's scheme
    (L. Ramshaw, Blossoms are polar forms, Computer Aided Geometric Design 6, 1989). All spans at once.
    `point` are the numbers of the last control points (rows of `points`) that act on these spans. No span may have no length.
    """
    near = knots[knot[:, None] + np.arange(1 - degree, degree + 1)]  # (spans, 2 degree)
    acting = points[point[:, None] + np.arange(-degree, 1)]
    a, b = near[:, degree - 1 : degree], near[:, degree : degree + 1]
    result = np.empty_like(acting)
    for m in range(degree + 1):
        level = acting
        for r in range(1, degree + 1):
            before = near[:, r - 1 : degree]
            share = (((a if r <= degree - m else b) - before) / (near[:, degree : 2 * degree + 1 - r] - before))[..., None]
            one, other = level[:, :-1], level[:, 1:]
            level = np.where(one == other, one, (1.0 - share) * one + share * other)  # points that coincide stay so
        result[:, m] = level[:, 0]
    return result


# A chain begins and ends with single arcs; all others come in pairs, as biarcs. What a piece can do is measured in arcs of the
# best chain there could be (see fit).

# Arcs of the best chain whose work the pieces do. At its ends the chain has the tangent of the curve, which costs some.
ALONE, BOTH_ENDS, ONE_END, INSIDE = 0.69, 1.38, 1.75, 2.0
LOST_EVEN, LOST_ODD = 0.62, 0.56  # so many arcs less than it has does a whole chain


class Demand(NamedTuple):
    """Ascending places (n,) of curves and how many arcs (n,) the best chains need up to each; both skip 1 between curves."""

    places: Array
    load: Array


class Layout(NamedTuple):
    """The pieces of some chains: their chains' numbers, what work they do; which of them are single arcs, first or last."""

    chain: Numbers
    capacity: Array
    single: NDArray[np.bool_]
    first: Numbers  # piece of each chain
    last: Numbers

    @property
    def start(self) -> Numbers:
        """The numbers of the nodes where the pieces start; they end at the next."""
        return np.arange(len(self.chain)) + self.chain


def arcs_for(work: Array) -> Numbers:
    """The smallest numbers of arcs that can do the work of so many arcs of the best chain."""
    count = np.maximum(2, np.ceil(work + LOST_ODD)).astype(np.intp)
    return count + ((count % 2 == 0) & (count - LOST_EVEN < work))


def laid_out(counts: Numbers) -> Layout:
    """The pieces of chains of so many arcs (two or more): single arcs at the ends, else biarcs."""
    pieces = np.where(counts == 2, 1, counts // 2 + 1)
    last = np.cumsum(pieces) - 1
    first = last - pieces + 1
    capacity = np.full(int(np.sum(pieces)), INSIDE)
    capacity[first] = ALONE
    capacity[last] = np.where(counts % 2 == 1, ONE_END, np.where(counts == 2, BOTH_ENDS, ALONE))
    return Layout(np.repeat(np.arange(len(counts)), pieces), capacity, capacity == ALONE, first, last)


def shares(demand: Demand, begin: Array, end: Array, layout: Layout) -> tuple[Array, Array]:
    """The places of the nodes, and the load there."""
    low, high = np.interp(begin, *demand), np.interp(end, *demand)
    done = np.append(0.0, np.cumsum(layout.capacity))
    unit = ((high - low) / (done[layout.last + 1] - done[layout.first]))[layout.chain]
    load = np.empty(len(layout.chain) + len(begin))
    start = layout.start
    load[start] = low[layout.chain] + unit * (done[:-1] - done[layout.first][layout.chain])
    load[start[layout.last] + 1] = high
    nodes = np.interp(load, demand.load, demand.places)
    nodes[start[layout.first]], nodes[start[layout.last] + 1] = begin, end
    return nodes, load


STRAIGHT = 1e6  # an arc of a radius above this many chords is a line: its rise is below 1.3e-7 of the chord


class ArcChain(NamedTuple):
    """Arcs in travel order: starts, ends (n, 2) in metres; unit tangents there (n, 2); signed curvatures (n,) in 1/m.

    A curvature of 0 marks a line, whose tangents are those of its chord; not finite marks what is no sensible arc.
    """

    starts: Array
    start_tangents: Array
    ends: Array
    end_tangents: Array
    curvatures: Array

    def edges(self) -> list[Edge]:
        """The same as lines and arcs."""
        (px, py), (qx, qy), (tx, ty) = self.starts.T, self.ends.T, self.start_tangents.T
        chord = self.ends - self.starts
        along, across = dots(chord, self.start_tangents), crosses(self.start_tangents, chord)
        flat = _is_flat(chord, across)
        with np.errstate(invalid="ignore", divide="ignore"):
            r = dots(chord, chord) / (2.0 * across)  # positive: the centre lies to the left
            x, y = px - r * ty, py + r * tx
            arcs = np.stack((x, y, np.abs(r), np.arctan2(py - y, px - x), 2.0 * np.arctan2(across, along)))
        rows = np.where(flat, np.stack((px, py, qx, qy, px)), arcs).T.tolist()
        return [Line(*row[:4]) if line else Arc(*row) for row, line in zip(rows, flat.tolist(), strict=True)]


def arcs_from(starts: Array, tangents: Array, ends: Array) -> ArcChain:
    """The arcs that leave the starts (n, 2) along the unit tangents and reach the ends; each below a half circle."""
    chord = ends - starts
    along, across = dots(chord, tangents), crosses(tangents, chord)
    square = dots(chord, chord)
    with np.errstate(invalid="ignore", divide="ignore"):
        curvature = np.where(along > 0.0, 2.0 * across / square, np.nan)
        # The end tangent is the start tangent mirrored in the chord.
        last = 2.0 * (along / square)[:, None] * chord - tangents
        flat = _is_flat(chord, across)
        straight = chord / np.sqrt(square)[:, None]
    first = np.where(flat[:, None], straight, tangents)
    return ArcChain(starts, first, ends, np.where(flat[:, None], straight, last), np.where(flat, 0.0, curvature))


def biarc_joints(p: Array, tangent_p: Array, q: Array, tangent_q: Array, ratio: Array) -> tuple[Array, Array]:
    """Where the two arcs from p to q (n, 2) with these unit tangents meet, and their tangent there; nan where they cannot.

    The end legs of the control polygon p, p + a·tp, q - b·tq, q have the lengths a and b = `ratio`·a, the middle one a + b;
    with v = q - p, t = tp + ratio·tq and u = tp - tq that says ratio·a² u² + 2a v·t - v² = 0, whose positive root is written so
    that nothing cancels.
    """
    r = ratio[:, None]
    v, u = q - p, tangent_p - tangent_q
    vv, vt = dots(v, v), dots(v, tangent_p + r * tangent_q)
    with np.errstate(invalid="ignore", divide="ignore"):
        a = np.where(vt > 0.0, vv / (vt + np.sqrt(vt * vt + ratio * dots(u, u) * vv)), np.nan)[:, None]
        first, last = p + a * tangent_p, q - r * a * tangent_q
        middle = v - a * (tangent_p + r * tangent_q)
        return (r * first + last) / (1.0 + r), middle / np.hypot(middle[:, 0], middle[:, 1])[:, None]


def arc_from(p: Point, tangent: Point, q: Point) -> Edge:
    """The arc from p, leaving along the unit `tangent`, to q; a line where it is straight."""
    return arcs_from(np.array([p]), np.array([tangent]), np.array([q])).edges()[0]


def _is_flat(chord: Array, across: Array) -> NDArray[np.bool_]:
    """Is an arc with these chords (n, 2) and such legs (n,) across it straight?"""
    return 2.0 * np.abs(across) * STRAIGHT <= np.hypot(chord[:, 0], chord[:, 1])


def dots(a: Array, b: Array) -> Array:
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]


def crosses(a: Array, b: Array) -> Array:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


# How far a curve can be from the arcs that follow it, between any samples: let an arc start at p with unit tangent τ, left
# normal ν and signed curvature k, and let q = c - p for a point c of the curve. Then g = q·ν - k q²/2 vanishes on the arc's
# circle, and the distance from that circle is |d| = 2|g| / (1 + √(1 - 2kg)). Along a part of the curve that is rational of
# degree n, g times the squared weight is a polynomial of degree 2n: 2n + 1 samples give its Chebyshev coefficients, and |T_j| ≤
# 1. The first four terms are a cubic whose extremes are found in closed form; the others add the sum of their magnitudes. So
# the bound holds for every parameter (up to rounding), and it is sharp, because the deviation of an arc from a smooth curve is
# nearly a cubic. That the curve passes beside the arc itself, not the rest of its circle, is bounded in the same way: what it
# overshoots the normals at both ends is added.

SLACK = 0.01  # of the bound: where the higher terms or unequal weights may add more, the interval is halved
HALVINGS = 6
GLANCES = 0.5 - 0.5 * np.cos(np.pi * (np.arange(6) + 0.5) / 6.0)  # places along an arc, denser towards its ends


def glances(bundle: Bundle, low: Array, high: Array, arcs: ArcChain) -> Array:
    """About the same as `deviations`, quickly: the largest (n,) of a few samples, some per cent too small at worst."""
    low, high, source = bundle.stretches(low, high)
    span, start = bundle.locate(low)
    x, y = bundle.at(span, start[:, None] + (high - low)[:, None] * GLANCES) - arcs.starts[source].T[:, :, None]
    tangent, k = arcs.start_tangents[source], arcs.curvatures[source][:, None]
    square = x * x  # in place from here: new memory would take longer than the arithmetic
    square += y * y
    square *= 0.5 * k
    y *= tangent[:, :1]
    x *= tangent[:, 1:]
    y -= x
    y -= square
    g = np.max(np.abs(y, out=y), axis=1)
    with np.errstate(invalid="ignore"):
        most = 2.0 * g / (1.0 + np.sqrt(1.0 - 2.0 * np.abs(k[:, 0]) * g))
    result = np.zeros(len(arcs.curvatures))
    np.maximum.at(result, source, np.where(np.isfinite(most), most, np.inf))
    return result


def deviations(bundle: Bundle, low: Array, high: Array, arcs: ArcChain, group: Numbers) -> Array:
    """Upper bounds (n,) in metres for the distance between arc i and the curve between the places low[i] and high[i].

    No arc may reach a half circle; then no point of either is further from the other. Intervals are halved where the deviation
    is far from a cubic and might be the largest of its group, so that the largest bound of each group is sharp.
    """
    bounds = np.zeros(len(arcs.curvatures))
    floor = np.zeros(int(np.max(group, initial=0)) + 1)
    low, high, owner = bundle.stretches(low, high)
    for left in range(HALVINGS, -1, -1):
        bound, slack = _interval_bounds(bundle, low, high, owner, arcs)
        sure = np.where(np.isfinite(bound), bound - slack, 0.0)
        np.maximum.at(floor, group[owner], sure)
        again = (slack > SLACK * bound) & (bound > floor[group[owner]]) if left else np.zeros(len(bound), dtype=bool)
        np.maximum.at(bounds, owner[~again], bound[~again])
        if not np.any(again):
            break
        middle = 0.5 * (low[again] + high[again])
        low, high = np.concatenate((low[again], middle)), np.concatenate((middle, high[again]))
        owner = np.concatenate((owner[again], owner[again]))
    return bounds


def _interval_bounds(bundle: Bundle, low: Array, high: Array, owner: Numbers, arcs: ArcChain) -> tuple[Array, Array]:
    """For each interval the bound of the distance from its arc, and by how much it may be too large."""
    rank = 2 * bundle.degree + 1
    x, transform = _chebyshev(rank)
    span, first = bundle.locate(low)
    h = bundle.homogeneous(span, first[:, None] + (high - low)[:, None] * (0.5 + 0.5 * x))
    w = h[2] if bundle.weighted else 1.0
    start, tangent, k = arcs.starts[owner], arcs.start_tangents[owner], arcs.curvatures[owner]
    qx, qy = h[0] - start[:, :1] * w, h[1] - start[:, 1:] * w
    along = qx * tangent[:, :1] + qy * tangent[:, 1:]
    across = qy * tangent[:, :1] - qx * tangent[:, 1:]
    g = across * w - 0.5 * k[:, None] * (qx * qx + qy * qy)
    g_low, g_high, g_tail = _range(g @ transform)
    lightest = heaviest = np.ones(len(low))
    if bundle.weighted:
        w_low, w_high, w_tail = _range(w @ transform)
        lightest, heaviest = w_low - w_tail, w_high + w_tail
    with np.errstate(invalid="ignore", divide="ignore"):
        most = (np.maximum(np.abs(g_low), np.abs(g_high)) + g_tail) / lightest**2
        bound = 2.0 * most / (1.0 + np.sqrt(1.0 - 2.0 * np.abs(k) * most))
        end, last = arcs.ends[owner], arcs.end_tangents[owner]
        beyond = (end[:, :1] * w - h[0]) * last[:, :1] + (end[:, 1:] * w - h[1]) * last[:, 1:]
        for projection in (along @ transform, beyond[:, ::-1] @ transform):
            bound = bound + np.maximum(0.0, -_least(projection)) / lightest
        slack = g_tail / lightest**2 + most * (1.0 - (lightest / heaviest) ** 2)
    return np.where((lightest > 0.0) & np.isfinite(bound), bound, np.inf), slack


@lru_cache(maxsize=64)
def _chebyshev(rank: int) -> tuple[Array, Array]:
    """The `rank` Chebyshev points of the first kind, and the matrix from values there (…, rank) to coefficients (…, rank)."""
    angle = np.pi * (np.arange(rank) + 0.5) / rank
    transform = 2.0 / rank * np.cos(np.outer(angle, np.arange(rank)))
    transform[:, 0] *= 0.5
    return np.cos(angle), transform


def _least(a: Array) -> Array:
    """A bound (n,) of the least value on [-1, 1] of what has the Chebyshev coefficients a (n, rank), mostly growing."""
    order = np.arange(a.shape[1])
    result: Array = a @ (1.0 - 2.0 * (order % 2))
    # The derivative of T_j is at most j²: where the first term outweighs the others the least is at the lower end.
    doubtful = ~(a[:, 1] >= np.abs(a[:, 2:]) @ (order[2:] ** 2))
    if np.any(doubtful):
        least, _, tail = _range(a[doubtful])
        result[doubtful] = least - tail
    return result


def _range(a: Array) -> tuple[Array, Array, Array]:
    """Least and greatest value of the first four Chebyshev terms on [-1, 1], and the sum of the magnitudes of the others."""
    a0, a1, a2, a3 = (a[:, j] if j < a.shape[1] else np.zeros(len(a)) for j in range(4))
    tail = np.sum(np.abs(a[:, 4:]), axis=1)
    # The derivative is (a1 - 3 a3) + 4 a2 x + 12 a3 x²; its roots in the form without cancellation.
    constant = a1 - 3.0 * a3
    with np.errstate(invalid="ignore", divide="ignore"):
        half = -0.5 * (4.0 * a2 + np.copysign(np.sqrt(16.0 * a2 * a2 - 48.0 * a3 * constant), a2))
        roots = np.stack((half / (12.0 * a3), constant / half, np.full(len(a), -1.0), np.ones(len(a))))
    # Where there is no root inside any other place will do: values there cannot exceed the range.
    x = np.where(np.abs(roots) <= 1.0, roots, 1.0)
    values = a0 + a1 * x + a2 * (2.0 * x * x - 1.0) + a3 * (4.0 * x * x - 3.0) * x
    return np.min(values, axis=0), np.max(values, axis=0), tail


# How many arcs each part of a curve needs, from the rate of its curvature first; then from what a trial has shown.

BEST = math.sqrt(3.0) / 216.0  # largest deviation of the best chain over |κ′| h³
STEPS = 48  # in which the change of curvature is measured, along each curve at least
FEWEST = 4  # of these in each span
STILL = 1e-12  # of the whole: a step of no length
SHORT = 1e-5  # of the tolerance, likewise
EVEN = 0.05  # of the demand is shared by length, for where the curvature does not seem to change
DAMPING = 0.5  # of the correction of the lengths from one distribution to the next
LEAST_WORK = 1e-3  # of a piece


def first_demand(bundle: Bundle, tolerance: Array) -> Demand:
    """How many arcs the best chains need, from κ′ by differences."""
    spans = (bundle.end - bundle.begin)[bundle.owner]
    each = np.maximum(FEWEST, -(-STEPS // spans))
    k = np.arange(int(np.sum(each))) - np.repeat(np.cumsum(each) - each, each)
    t = np.sort(np.append(np.repeat(bundle.start_of, each) + k / np.repeat(each, each), bundle.end))
    owner = bundle.owner[bundle.locate(t)[0]]
    gap = np.flatnonzero(np.diff(owner))  # the steps from one curve to the next
    points, tangents = bundle.points(t), bundle.tangents(t)
    length = np.hypot(*np.diff(points, axis=0).T)
    length[gap] = 0.0
    owner, limit = owner[:-1], tolerance[owner[:-1]]
    total = np.bincount(owner, length)[owner]
    length = np.maximum(length, STILL * total + SHORT * limit)
    turn = np.arctan2(crosses(tangents[:-1], tangents[1:]), dots(tangents[:-1], tangents[1:]))
    curvature = turn / length
    change = np.abs(np.diff(curvature)) / (0.5 * (length[:-1] + length[1:]))
    change[gap - 1] = change[gap] = 0.0
    rate = np.cbrt(BEST * np.maximum(np.append(0.0, change), np.append(change, 0.0)) / limit) * length
    rate[gap] = 0.0
    rate = np.maximum(rate, EVEN * np.bincount(owner, rate)[owner] * length / np.maximum(total, SHORT * limit)) + 1e-12
    rate[gap] = 1.0
    return Demand(t, np.append(0.0, np.cumsum(rate)))


def corrected(demand: Demand, nodes: Array, work: Array) -> Demand:
    """The demand corrected piece by piece: between neighbouring nodes it is now `work`; nan between two chains."""
    places = np.union1d(demand.places, nodes)
    steps = np.diff(np.interp(places, *demand))
    piece = np.searchsorted(nodes, places[:-1], "right") - 1
    before = np.bincount(piece, steps, len(work))
    known = (before > 0.0) & ~np.isnan(work)
    factor = (np.where(known, np.maximum(work, LEAST_WORK), 1.0) / np.where(known, before, 1.0)) ** DAMPING
    return Demand(places, np.append(0.0, np.cumsum(steps * factor[piece])))


def of_chosen(demand: Demand, bundle: Bundle, chosen: Numbers) -> Demand:
    """The demand of some of the curves only."""
    owner = bundle.owner[bundle.locate(demand.places)[0]]
    kept = np.zeros(len(bundle), dtype=bool)
    kept[chosen] = True
    keep = kept[owner]
    owner = owner[keep]
    steps = np.diff(demand.load)[np.flatnonzero(keep)[:-1]]
    steps[np.diff(owner) != 0] = 1.0
    return Demand(demand.places[keep], np.append(0.0, np.cumsum(steps)))
