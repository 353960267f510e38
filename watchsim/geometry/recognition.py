"""Which parts of a curve are straight or round?

Programs write circles as rational splines, exactly, or as cubics, nearly. What was meant as one line or one arc shall come
out as one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.biarcs import ArcChain, Array, Bundle, Curve, arc_from, crosses, deviations, dots
from watchsim.geometry.fitting import KINK, Fit, batches
from watchsim.geometry.primitives import TURN, Arc, Edge, Line

ON_LINE = 1e-9  # of the length
ROUND = 1e-5  # of the rise of the arc: a spiral whose radius changes by more than some 1e-4 is none
MEANT = 0.05  # of the tolerance: so far circles may lie apart that were meant as one
SHORTEST = 20.0  # tolerances: shorter spans go with their neighbours
CLOSED = 1e-9  # of the length


class Part(NamedTuple):
    """A part of a curve, and the edge that it is, if it is one."""

    curve: Curve
    edge: Edge | None


class _Spans(NamedTuple):
    """For each span of the curve: its sampled points (n, m, 2), whether it is straight or round, and its circle."""

    points: Array
    straight: NDArray[np.bool_]
    round: NDArray[np.bool_]
    centres: Array
    radii: Array

    def chosen(self, first: int, last: int) -> _Spans:
        part = slice(first, last)
        return _Spans(self.points[part], self.straight[part], self.round[part], self.centres[part], self.radii[part])


def parts_of(curves: Sequence[Curve], tolerances: Sequence[float]) -> list[list[Part]]:
    """Each curve cut into what is exactly straight, what is exactly round, and the rest."""
    result = [[Part(curve, None)] for curve in curves]
    for chosen in batches(curves):
        bundle = Bundle([curves[k] for k in chosen])
        spans = _classified(bundle, np.array([tolerances[k] for k in chosen])[bundle.owner])
        special = np.bincount(bundle.owner, spans.straight | spans.round) > 0
        first = np.searchsorted(bundle.owner, np.arange(len(chosen) + 1)).tolist()
        for i in np.flatnonzero(special).tolist():
            own = spans.chosen(first[i], first[i + 1])
            result[chosen[i]] = _grouped(curves[chosen[i]], own, tolerances[chosen[i]])
    return result


def _grouped(curve: Curve, spans: _Spans, tolerance: float) -> list[Part]:
    """The parts of a curve whose spans are those."""
    groups: list[list[int]] = []
    for k in range(len(spans.radii)):
        if groups and _continues(spans, groups[-1][0], k, tolerance):
            groups[-1].append(k)
        else:
            groups.append([k])
    return [Part(curve.spans(g[0], g[-1] + 1), _edge(spans, g)) for g in groups]


def _classified(bundle: Bundle, tolerance: Array) -> _Spans:
    """Samples, so many that what holds for them holds for the whole span, up to their decimals; tolerances (spans,)."""
    count = 2 * bundle.degree + 2
    number = np.arange(len(bundle.owner))
    p = bundle.at(number, np.broadcast_to(np.arange(count + 1) / count, (len(number), count + 1))).transpose(1, 2, 0)
    chord = p[:, -1] - p[:, 0]
    length = np.hypot(chord[:, 0], chord[:, 1])
    offset = p - p[:, :1]
    # Where the control points ascend along the chord the curve does, too.
    along = np.einsum("nmk,nk->nm", bundle.corners - p[:, :1], chord)
    across = np.abs(offset[..., 1] * chord[:, :1] - offset[..., 0] * chord[:, 1:])
    sides = np.diff(p, axis=1)
    long = np.sum(np.hypot(sides[..., 0], sides[..., 1]), axis=1) > SHORTEST * tolerance
    limit = np.minimum(ON_LINE * length, tolerance) * length
    straight = (
        long
        & (length > 0.0)
        & np.all(across <= limit[:, None], axis=1)
        & np.all(np.diff(along, axis=1) > -limit[:, None], axis=1)
    )
    third = count // 3
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        a = p[:, 0]
        u, v = p[:, third] - a, p[:, 2 * third] - a
        area = 2.0 * crosses(u, v)
        uu, vv = dots(u, u), dots(v, v)
        centres = a + np.column_stack((v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu)) / area[:, None]
        arms = p - centres[:, None]
        distances = np.hypot(arms[..., 0], arms[..., 1])
        radii = np.mean(distances, axis=1)
        steps = np.arctan2(
            arms[:, :-1, 0] * arms[:, 1:, 1] - arms[:, :-1, 1] * arms[:, 1:, 0], np.sum(arms[:, :-1] * arms[:, 1:], axis=2)
        )
        rise = radii * np.minimum(1.0, np.sum(steps, axis=1) ** 2 / 8.0)
        near = np.max(np.abs(distances - radii[:, None]), axis=1) <= np.minimum(ROUND * rise, MEANT * tolerance)
    one_way = np.all(steps > 0.0, axis=1) | np.all(steps < 0.0, axis=1)
    return _Spans(p, straight, ~straight & long & near & one_way & np.isfinite(radii), centres, radii)


def _continues(spans: _Spans, first: int, k: int, tolerance: float) -> bool:
    """Is span k of the same kind, line or circle as the span `first` before it?"""
    if spans.straight[first]:
        if not spans.straight[k]:
            return False
        start, corner, end = spans.points[first, 0], spans.points[first, -1], spans.points[k, -1]
        away = abs(float(crosses((corner - start)[None], (end - start)[None])[0]))
        return away <= ON_LINE * float(np.dot(end - start, end - start)) and float(np.dot(corner - start, end - corner)) > 0.0
    if spans.round[first]:
        apart = float(np.hypot(*(spans.centres[k] - spans.centres[first]))) + abs(spans.radii[k] - spans.radii[first])
        return bool(spans.round[k]) and bool(apart <= MEANT * tolerance)
    return not spans.straight[k] and not spans.round[k]


def _edge(spans: _Spans, group: Sequence[int]) -> Edge | None:
    """The line or arc of a row of spans of one kind."""
    first, last = group[0], group[-1]
    p, q = spans.points[first, 0], spans.points[last, -1]
    if spans.straight[first]:
        return Line(*p.tolist(), *q.tolist())
    if not spans.round[first]:
        return None
    centre, radius = np.mean(spans.centres[group], axis=0), float(np.mean(spans.radii[group]))
    arms = spans.points[group].reshape(-1, 2) - centre
    angles = np.unwrap(np.arctan2(arms[:, 1], arms[:, 0]))
    sweep = float(angles[-1] - angles[0])
    if math.dist(p, q) <= CLOSED * radius and abs(sweep) > math.pi:
        sweep = math.copysign(TURN, sweep)
    return Arc(float(centre[0]), float(centre[1]), radius, float(angles[0]), sweep)


def whole_circle(curve: Curve, tolerance: float) -> Fit | None:
    """The circle that a closed curve follows within the tolerance all round, in its direction; None if it does not."""
    if curve.open_by() > CLOSED:
        return None
    bundle = Bundle([curve])
    t = np.arange(8 * len(curve.control) + 1) / 8.0
    p = bundle.points(t)
    length = float(np.sum(np.hypot(*np.diff(p, axis=0).T)))
    if not 0.0 < math.dist(p[0], p[-1]) + length <= (1.0 + CLOSED) * length:
        return None
    middle = np.mean(p[:-1], axis=0)
    local = p[:-1] - middle
    # Least squares: x² + y² = 2 x·c + s.
    solution, *_ = np.linalg.lstsq(np.column_stack((2.0 * local, np.ones(len(local)))), dots(local, local), rcond=None)
    centre, radius = middle + solution[:2], math.sqrt(max(0.0, float(solution[2] + solution[:2] @ solution[:2])))
    if not radius > 0.0 or np.max(np.abs(np.hypot(*(p - centre).T) - radius)) > tolerance:
        return None
    angles = np.unwrap(np.arctan2(*(p - centre).T[::-1]))
    sweep = float(angles[-1] - angles[0])
    if abs(abs(sweep) - TURN) > 1e-6 or np.any(np.diff(angles) * sweep <= 0.0):
        return None
    arms = np.column_stack((np.cos(angles), np.sin(angles)))
    arms[-1] = arms[0]
    side = math.copysign(1.0, sweep)
    ways = side * np.column_stack((-arms[:, 1], arms[:, 0]))
    places = centre + radius * arms
    chain = ArcChain(places[:-1], ways[:-1], places[1:], ways[1:], np.full(len(t) - 1, side / radius))
    deviation = float(np.max(deviations(bundle, t[:-1], t[1:], chain, np.zeros(len(t) - 1, dtype=np.intp))))
    if deviation > tolerance:
        return None
    return Fit((Arc(float(centre[0]), float(centre[1]), radius, float(angles[0]), side * TURN),), deviation)


def joined(edges: Sequence[Edge], spare: float) -> tuple[list[Edge], float]:
    """Neighbouring arcs of one circle made one, and by how much (metres, below `spare`) that moved them."""
    result: list[Edge] = []
    moved = 0.0
    for edge in edges:
        apart = _apart(result[-1], edge) if result else math.inf
        if apart <= MEANT * spare:
            result[-1] = _together(result[-1], edge)
            moved = max(moved, apart)
        else:
            result.append(edge)
    return result, moved


def put_together(fits: Sequence[Fit], tolerance: float) -> Fit:
    """What follows the parts of a curve, end to end, with neighbouring arcs of one circle made one."""
    worst = max((fit.deviation for fit in fits), default=0.0)
    edges, shift = joined([edge for fit in fits for edge in fit.edges], tolerance - worst)
    return Fit(tuple(edges), worst + shift)


def _apart(one: Edge, other: Edge) -> float:
    """How far two arcs' circles are from each other; infinite unless both turn one way, in all one turn at most."""
    if not (isinstance(one, Arc) and isinstance(other, Arc)) or one.sweep * other.sweep < 0.0:
        return math.inf
    apart = math.hypot(one.x - other.x, one.y - other.y) + abs(one.radius - other.radius)
    return apart if abs(one.sweep + other.sweep) <= TURN * (1.0 + CLOSED) and apart <= KINK * one.radius * 10.0 else math.inf


def _together(one: Edge, other: Edge) -> Edge:
    """One arc from the start of one to the end of the other; a full circle where they meet."""
    if not (isinstance(one, Arc) and isinstance(other, Arc)):
        raise TypeError("only arcs can be put together")
    sweep = one.sweep + other.sweep
    if abs(sweep) > TURN * (1.0 - CLOSED):
        return Arc(one.x, one.y, one.radius, one.start_angle, math.copysign(TURN, sweep))
    start, way = one.start, one.tangent(0.0)
    whole = arc_from(start, way, other.end)
    return whole if isinstance(whole, Arc) else one
