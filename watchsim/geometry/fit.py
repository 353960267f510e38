"""Which few arcs follow this curve?

The deviation e of a tangent-continuous chain of arcs from a curve obeys e″ = k - κ: k is constant on each arc, κ the curvature of
the curve. So the best chain is the best uniform approximation by quadratic splines with free knots. Where κ′ hardly changes
that leaves e = κ′ h³ B₃(s/h) / 6, the third Bernoulli polynomial, on arcs of length h, and |e| ≤ √3/216 |κ′| h³; hence no chain
within ε has fewer arcs than (√3/216 / ε)^(1/3) ∫ |κ′|^(1/3) ds, for small ε. (Biarcs that take the tangents of the curve where they
meet it, as in D. S. Meek, D. J. Walton, Approximating smooth planar curves by arc splines, J. Comput. Appl. Math. 59, 1995,
need 1.45 times as many.) This chain is built here: its joints lie on the curve or near it, and every second one has its tangent
turned by -κ′h²/12, the slope of the Bernoulli polynomial there. The lengths follow from equal deviations, step by step.
"""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.biarc import ArcChain, arcs_from, biarc_joints, crosses, dots
from watchsim.geometry.curve import Array, Curve
from watchsim.geometry.deviation import deviations
from watchsim.geometry.primitives import Edge, Line
from watchsim.geometry.smooth import smooth_parts

BEST = math.sqrt(3.0) / 216.0  # largest deviation of the best chain over |κ′| h³
# Arcs of the best chain whose work the pieces do. At its ends the chain has the tangent of the curve, which costs some.
ALONE, BOTH_ENDS, ONE_END, INSIDE = 0.69, 1.38, 1.75, 2.0
KINK = 1e-6  # radians between a single arc's and the curve's tangent at its end
MOST_TILT = 0.1  # radians, of the tangent at a joint
ROUNDS = 20  # of distributing the arcs anew
ATTEMPTS = 5  # with one number of arcs
SURE = 0.97  # of the number of arcs that seems necessary: fewer are not tried
HARDEST = 64.0  # tolerances: what a larger deviation counts
MANY = 10_000  # arcs: a part that needs more is halved before
NEWTON = 2
TRIAL_HALVINGS = 1
DAMPING = 0.6  # of the correction of the lengths from one distribution to the next
BALANCE = 0.1  # of the logarithm of two deviations: correction of that of the legs of a biarc

DEEPEST = 40  # halvings where nothing helps: at a cusp
NOTHING = 1e-5  # of the tolerance: edges shorter than that are left out


class Fit(NamedTuple):
    """Edges in travel order, and a bound of the distance (metres) between the curve and them."""

    edges: tuple[Edge, ...]
    deviation: float


class _Trial(NamedTuple):
    """Arcs between the stations (parameters) with bounds of their deviations; pieces between the nodes, and their first arcs."""

    stations: Array
    arcs: ArcChain
    nodes: Array
    ratios: Array
    first: NDArray[np.intp]
    errors: Array

    @property
    def worst(self) -> float:
        return float(np.max(self.errors))

    def strains(self, tolerance: float) -> Array:
        """For each piece by how much it is too long: the cube root of deviation over tolerance, the mean of its arcs."""
        strain = np.cbrt(np.minimum(self.errors / tolerance, HARDEST))
        return np.add.reduceat(strain, self.first) / np.diff(np.append(self.first, len(strain)))


def fit_arcs(curve: Curve, tolerance: float) -> Fit:
    """Tangent-continuous arcs along the whole curve, within `tolerance` metres.

    Where the curve itself has a corner or a cusp so have they. A larger deviation than the tolerance is possible where the
    curve jumps, and is told.
    """
    edges: list[Edge] = []
    worst = 0.0
    for low, high in pairwise(smooth_parts(curve, tolerance)):
        for part, deviation in _follow(curve, low, high, tolerance, 0):
            edges.extend(edge for edge in part if edge.length > NOTHING * tolerance)
            worst = max(worst, deviation)
    return Fit(tuple(edges), worst)


def _follow(curve: Curve, low: float, high: float, tolerance: float, depth: int) -> list[tuple[list[Edge], float]]:
    """The edges and deviations of the part from `low` to `high`, halved where no chain is found."""
    trial = _one_arc(curve, low, high, tolerance) or _fewest(curve, low, high, tolerance)
    if trial is not None:
        return [(trial.arcs.edges(), float(np.max(deviations(curve, trial.stations, trial.arcs))))]
    (p, q) = curve.points(np.array([low, high]))
    chord: list[Edge] = [Line(*p.tolist(), *q.tolist())]
    away = _from_chord(curve, low, high)
    if away <= tolerance or depth >= DEEPEST:
        return [(chord, away)]
    middle = 0.5 * (low + high)
    return _follow(curve, low, middle, tolerance, depth + 1) + _follow(curve, middle, high, tolerance, depth + 1)


def _from_chord(curve: Curve, low: float, high: float) -> float:
    """A bound of the distance between a short part of the curve and its chord, wherever it turns: its extent, sampled."""
    points = curve.points(np.unique(np.concatenate((np.linspace(low, high, 33), curve.between(low, high)))))
    return float(np.hypot(*np.ptp(points, axis=0)))


def _one_arc(curve: Curve, low: float, high: float, tolerance: float) -> _Trial | None:
    """The single arc or line, where it has the right tangents at both ends."""
    nodes = np.array([low, high])
    points, tangents = curve.points(nodes), curve.tangents(nodes, low, high)
    arc = arcs_from(points[:1], tangents[:1], points[1:])
    mirrored = arc.end_tangents if arc.curvatures[0] else tangents[:1]
    kink = abs(float(crosses(mirrored, tangents[1:])[0]))
    if not kink <= KINK or not dots(mirrored, tangents[1:])[0] > 0.0:
        return None
    errors = deviations(curve, nodes, arc)
    return _Trial(nodes, arc, nodes, np.ones(1), np.array([0]), errors) if errors[0] <= tolerance else None


def _fewest(curve: Curve, low: float, high: float, tolerance: float) -> _Trial | None:
    """The chain with the fewest arcs that was found within the tolerance."""
    t, load = _demand(curve, low, high, tolerance)
    skew = np.array([[low, high], [0.0, 0.0]])
    best: _Trial | None = None
    fewest = 10**9
    attempts: Counter[int] = Counter()
    count = arcs_for(float(min(load[-1], MANY)))
    most = 4 * count + 16
    for _ in range(ROUNDS):
        if count > most:
            break
        capacity = capacities(count)
        trial = _chain(curve, t, load, capacity, skew)
        attempts[count] += 1
        work = capacity * trial.strains(tolerance)
        needed = arcs_for(float(np.sum(work)))
        t, load = _redistributed(t, load, trial.nodes, work)
        skew = _balanced(trial)
        if trial.worst <= tolerance and np.max(deviations(curve, trial.stations, trial.arcs)) <= tolerance:
            best, fewest = trial, count
            count = min(needed, count - 1)
        elif needed > count:
            count = needed
        elif attempts[count] >= ATTEMPTS:
            count += 1
        if count >= fewest:
            count = fewest - 1
        if best is not None and (attempts[count] >= ATTEMPTS or count < SURE * needed or count < 2):
            break
    return best


def capacities(count: int) -> Array:
    """How the work of the best chain is shared by the pieces of a chain of `count` arcs: single arcs at the ends, else biarcs."""
    if count == 2:
        return np.array([BOTH_ENDS])
    if count % 2:
        return np.array([ALONE, *[INSIDE] * (count // 2 - 1), ONE_END])
    return np.array([ALONE, *[INSIDE] * (count // 2 - 1), ALONE])


def arcs_for(work: float) -> int:
    """The smallest number of arcs that can do the work of so many arcs of the best chain."""
    count = max(2, math.floor(work))
    while float(np.sum(capacities(count))) < work:
        count += 1
    return count


def _demand(curve: Curve, low: float, high: float, tolerance: float) -> tuple[Array, Array]:
    """Parameters (n,) and the number of arcs (n,) that the best chain needs from the first to each of them, from κ′ by differences."""
    breaks = np.concatenate(([low], curve.between(low, high), [high]))
    each = max(4, math.ceil(48 / (len(breaks) - 1)))
    t = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * np.arange(each) / each).ravel(), high)
    points, tangents = curve.points(t), curve.tangents(t, low, high)
    length = np.maximum(np.hypot(*np.diff(points, axis=0).T), 1e-300)
    turn = np.arctan2(crosses(tangents[:-1], tangents[1:]), dots(tangents[:-1], tangents[1:]))
    curvature = turn / length
    change = np.abs(np.diff(curvature)) / (0.5 * (length[:-1] + length[1:]))
    rate = np.cbrt(BEST * np.concatenate((change[:1], np.maximum(change[:-1], change[1:]), change[-1:])) / tolerance) * length
    rate = np.maximum(rate, 0.05 * np.sum(rate) * length / np.sum(length)) + 1e-12
    return t, np.append(0.0, np.cumsum(rate))


def _redistributed(t: Array, load: Array, nodes: Array, work: Array) -> tuple[Array, Array]:
    """The demand corrected piece by piece: between neighbouring nodes it is now `work`."""
    grid = np.union1d(t, nodes)
    steps = np.diff(np.interp(grid, t, load))
    piece = np.minimum(np.searchsorted(nodes, grid[:-1], "right") - 1, len(work) - 1)
    before = np.bincount(piece, steps, len(work))
    return grid, np.append(0.0, np.cumsum(steps * ((np.maximum(work, 1e-3) / before)**DAMPING)[piece]))


def _balanced(trial: _Trial) -> Array:
    """Middles of the pieces, and there the logarithm of the ratio of legs that makes both arcs of a biarc deviate alike."""
    double = np.diff(np.append(trial.first, len(trial.errors))) == 2
    change = np.zeros(len(trial.first))
    one, other = trial.errors[trial.first[double]], trial.errors[trial.first[double] + 1]
    with np.errstate(invalid="ignore", divide="ignore"):
        change[double] = np.clip(np.nan_to_num(np.log(one / other)) * BALANCE, -0.5, 0.5)
    middles = 0.5 * (trial.nodes[:-1] + trial.nodes[1:])
    return np.stack((middles[double], (np.log(trial.ratios) + change)[double]))


def _chain(curve: Curve, t: Array, load: Array, capacity: Array, skew: Array) -> _Trial:
    """Single arcs at the ends and biarcs in between, distributed so that each gets its share of the load."""
    bounds = np.append(0.0, np.cumsum(capacity)) * (load[-1] / np.sum(capacity))
    nodes = np.interp(bounds, load, t)
    nodes[0], nodes[-1] = t[0], t[-1]
    ratios = np.exp(np.interp(0.5 * (nodes[:-1] + nodes[1:]), *skew)) if skew.size else np.ones(len(capacity))
    middles = np.interp(bounds[:-1] + np.diff(bounds) / (1.0 + ratios), load, t)
    both = np.concatenate((nodes, middles))
    points, directions = curve.points(both), curve.tangents(both, float(t[0]), float(t[-1]))
    count = len(nodes)
    at, halfway = points[:count], points[count:]
    tangents = _tilted(at, halfway, directions[:count], directions[count:])
    single = capacity == ALONE
    if single[0]:
        tangents[1] = _mirrored(at[1] - at[0], tangents[0])
    if single[-1]:
        tangents[-2] = _mirrored(at[-1] - at[-2], tangents[-1])
    pairs = np.flatnonzero(~single)
    joints, along = biarc_joints(at[pairs], tangents[pairs], at[pairs + 1], tangents[pairs + 1], ratios[pairs])
    between = _abreast(curve, joints, along, nodes[pairs], middles[pairs], nodes[pairs + 1])
    stations = np.concatenate((nodes, between))
    order = np.argsort(stations, kind="stable")
    corners, ways = np.concatenate((at, joints))[order], np.concatenate((tangents, along))[order]
    arcs = arcs_from(corners[:-1], ways[:-1], corners[1:])
    errors = deviations(curve, stations[order], arcs, TRIAL_HALVINGS, beside=False)
    first = np.searchsorted(stations[order], nodes[:-1])
    return _Trial(stations[order], arcs, nodes, ratios, first, errors)


def _tilted(at: Array, halfway: Array, tangents: Array, between: Array) -> Array:
    """The tangents (n, 2) at the nodes, the inner ones turned by -κ′h²/12, from the curve's turns to the places half-way."""
    back, ahead = np.hypot(*(at[1:-1] - halfway[:-1]).T), np.hypot(*(halfway[1:] - at[1:-1]).T)
    inner = tangents[1:-1]
    turn_back = np.arctan2(crosses(between[:-1], inner), dots(between[:-1], inner))
    turn_ahead = np.arctan2(crosses(inner, between[1:]), dots(inner, between[1:]))
    with np.errstate(invalid="ignore", divide="ignore"):
        tilt = -(turn_ahead * back - turn_back * ahead) / (6.0 * (back + ahead))
    tilt = np.clip(np.where(np.isfinite(tilt), tilt, 0.0), -MOST_TILT, MOST_TILT)
    c, s = np.cos(tilt), np.sin(tilt)
    result = tangents.copy()
    result[1:-1] = np.column_stack((c * inner[:, 0] - s * inner[:, 1], s * inner[:, 0] + c * inner[:, 1]))
    return result


def _mirrored(chord: Array, tangent: Array) -> Array:
    """The tangent at the other end of an arc."""
    with np.errstate(invalid="ignore", divide="ignore"):
        result: Array = 2.0 * (chord @ tangent) / (chord @ chord) * chord - tangent
    return result


def _abreast(curve: Curve, joints: Array, along: Array, low: Array, guess: Array, high: Array) -> Array:
    """The parameters (n,) where the curve crosses the normals of the joints, by Newton's method; inside `low` to `high`."""
    margin = 0.01 * (high - low)
    t = guess
    for _ in range(NEWTON):
        rise = dots(curve.points(t) - joints, along)
        with np.errstate(invalid="ignore", divide="ignore"):
            step = rise / dots(curve.slopes(t), along)
        t = np.clip(t - np.where(np.isfinite(step), step, 0.0), low + margin, high - margin)
    return t
