"""Which few arcs follow this curve?

The deviation e of a tangent-continuous chain of arcs from a curve obeys e″ = k - κ: k is constant on each arc, κ the curvature
of the curve. So the best chain is the best uniform approximation by quadratic splines with free knots. Where κ′ hardly
changes that leaves e = κ′ h³ B₃(s/h) / 6, the third Bernoulli polynomial, on arcs of length h, and |e| ≤ √3/216 |κ′| h³.
Hence no chain within ε has fewer arcs than (√3/216 / ε)^(1/3) ∫ |κ′|^(1/3) ds, for small ε. Biarcs that take the tangents of
the curve where they meet it (D. S. Meek, D. J. Walton, Approximating smooth planar curves by arc splines, J. Comput. Appl.
Math. 59, 1995) leave 2/81 |κ′| h³ and need 1.45 times as many. Here their tangents are turned by -κ′h²/12, the slope of the
Bernoulli polynomial, and the lengths are corrected step by step until all deviations are alike.
"""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from watchsim.geometry.arc_chain import Trial, balanced, capacities, lay_chain
from watchsim.geometry.biarc import arcs_from, crosses, dots
from watchsim.geometry.curve import Array, Curve
from watchsim.geometry.deviation import deviations
from watchsim.geometry.primitives import Edge, Line
from watchsim.geometry.smooth import smooth_parts

BEST = math.sqrt(3.0) / 216.0  # largest deviation of the best chain over |κ′| h³
KINK = 1e-6  # radians between a single arc's and the curve's tangent at its end
ROUNDS = 20  # of distributing the arcs anew
ROUNDS_OF_HALVES = 6  # where the whole did not succeed
FEW, MOST = 2, 5  # attempts with one number of arcs: more where one arc counts for more
WEIGHTY = 48  # arcs over attempts
ENOUGH = 1.04  # times the number of arcs that seems necessary
SURE = 0.97  # of the number of arcs that seems necessary: fewer are not tried
MANY = 10_000  # arcs: a part that needs more is halved before
DAMPING = 0.6  # of the correction of the lengths from one distribution to the next

STILL = 1e-12  # of the whole: a step of no length
DEEPEST = 40  # halvings where nothing helps: at a cusp
NOTHING = 1e-5  # of the tolerance: edges shorter than that are left out


class Fit(NamedTuple):
    """Edges in travel order, and a bound of the distance (metres) between the curve and them."""

    edges: tuple[Edge, ...]
    deviation: float


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
    trial = _one_arc(curve, low, high, tolerance) or _fewest(
        curve, low, high, tolerance, ROUNDS if depth == 0 else ROUNDS_OF_HALVES
    )
    if trial is not None:
        return [(trial.arcs.edges(), trial.worst)]
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


def _one_arc(curve: Curve, low: float, high: float, tolerance: float) -> Trial | None:
    """The single arc or line, where it has the right tangents at both ends."""
    nodes = np.array([low, high])
    points, tangents = curve.points(nodes), curve.tangents(nodes, low, high)
    arc = arcs_from(points[:1], tangents[:1], points[1:])
    mirrored = arc.end_tangents if arc.curvatures[0] else tangents[:1]
    kink = abs(float(crosses(mirrored, tangents[1:])[0]))
    if not kink <= KINK or not dots(mirrored, tangents[1:])[0] > 0.0:
        return None
    errors = deviations(curve, nodes, arc)
    return Trial(nodes, arc, nodes, np.ones(1), np.array([0]), errors) if errors[0] <= tolerance else None


def _fewest(curve: Curve, low: float, high: float, tolerance: float, rounds: int) -> Trial | None:
    """The chain with the fewest arcs that was found within the tolerance."""
    t, load = _demand(curve, low, high, tolerance)
    skew = np.array([[low, high], [0.0, 0.0]])
    best: Trial | None = None
    fewest = 10**9
    attempts: Counter[int] = Counter()
    count = arcs_for(float(min(load[-1], MANY)))
    most = 4 * count + 16
    for _ in range(rounds):
        if count > most:
            break
        capacity = capacities(count)
        trial = lay_chain(curve, t, load, capacity, skew)
        attempts[count] += 1
        work = capacity * trial.strains(tolerance)
        needed = arcs_for(float(np.sum(work)))
        t, load = _redistributed(t, load, trial.nodes, work)
        skew = balanced(trial)
        if trial.worst <= tolerance:
            trial = trial._replace(errors=deviations(curve, trial.stations, trial.arcs))
        if trial.worst <= tolerance:
            best, fewest = trial, count
            count = min(needed, count - 1)
        elif needed > count:
            count = needed
        elif attempts[count] >= enough_attempts(count):
            count += 1
        if count >= fewest:
            count = fewest - 1
        enough = fewest <= ENOUGH * needed or count < SURE * needed or count < 2
        if best is not None and (enough or attempts[count] >= enough_attempts(count)):
            break
    return best


def enough_attempts(count: int) -> int:
    return min(MOST, max(FEW, WEIGHTY // count))


def arcs_for(work: float) -> int:
    """The smallest number of arcs that can do the work of so many arcs of the best chain."""
    count = max(2, math.floor(work))
    while float(np.sum(capacities(count))) < work:
        count += 1
    return count


def _demand(curve: Curve, low: float, high: float, tolerance: float) -> tuple[Array, Array]:
    """Parameters (n,) and how many arcs (n,) the best chain needs up to each of them, from κ′ by differences."""
    breaks = np.concatenate(([low], curve.between(low, high), [high]))
    each = max(4, math.ceil(48 / (len(breaks) - 1)))
    t = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * np.arange(each) / each).ravel(), high)
    points, tangents = curve.points(t), curve.tangents(t, low, high)
    length = np.hypot(*np.diff(points, axis=0).T)
    length = np.maximum(length, STILL * np.sum(length) + NOTHING * tolerance)
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
    return grid, np.append(0.0, np.cumsum(steps * ((np.maximum(work, 1e-3) / before) ** DAMPING)[piece]))
