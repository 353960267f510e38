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
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.biarcs import (
    PAUSE,
    ArcChain,
    Array,
    Bundle,
    Curve,
    Demand,
    Layout,
    Numbers,
    arcs_for,
    arcs_from,
    biarc_joints,
    corrected,
    crosses,
    deviations,
    dots,
    first_demand,
    glances,
    laid_out,
    of_chosen,
    shares,
)
from watchsim.geometry.primitives import GOLDEN, Edge, Line

# Where a curve pauses, turns back or changes its curvature at once the arcs take its own tangent, on either side.

LOOKS = 32  # places in each span where the speed is looked at
SLOW = 0.2  # of the usual speed: a minimum below that is looked at more closely
NARROWINGS = 45  # by the golden section, to 1e-9 of a step
STILL = 1e-12  # of the whole: a step of no length
LITTLE = 1e-30  # 1/m: no change of curvature
SLIVER = 1e-4  # of a span: nothing shorter is cut off
NEAR = 1e-3  # of a span: so far beside a break its curvature is measured
JUMP = 4.0  # tolerances: a jump of curvature over one arc's length that is worth an end there
BEST = 216.0 / 3.0**0.5  # an arc's length is the cube root of BEST times the tolerance over the rate of curvature


def smooth_parts(curves: Sequence[Curve], tolerance: Array) -> list[list[Curve]]:
    """Each curve, all of one degree, cut where it is not smooth; `tolerance` (curves,) in metres."""
    bundle = Bundle(curves)
    result = [[curve] for curve in curves]
    places = np.unique(np.concatenate((jumps(bundle, tolerance), pauses(bundle))))
    number = bundle.owner[bundle.locate(places)[0]]
    for k in np.unique(number):
        cuts = [0.0]
        for place in (places[number == k] - bundle.begin[k]).tolist():
            nearest = float(round(place))
            cut = nearest if abs(place - nearest) <= SLIVER else place  # what is beside a break is taken for it
            if cut - cuts[-1] > SLIVER and len(curves[k].control) - cut > SLIVER:
                cuts.append(cut)
        result[k] = cut_at(curves[k], cuts[1:])
    return result


def cut_at(curve: Curve, places: Sequence[float]) -> list[Curve]:
    """The parts between ascending places inside."""
    parts, last = [], float(len(curve.control))
    for place in reversed(places):
        span = int(place)
        curve, rest = curve.split(span + (place - span) / min(1.0, last - span))  # the last cut may have shortened the span
        parts.append(rest)
        last = place
    return [curve, *reversed(parts)]


def jumps(bundle: Bundle, tolerance: Array) -> Array:
    """The inner breaks (places) where the curvature jumps by more than an arc across it could bear."""
    inner = np.flatnonzero(np.diff(bundle.owner) == 0)
    if not len(inner):
        return np.empty(0)
    chosen = np.union1d(inner, inner + 1)
    start = bundle.start_of[chosen].astype(float)
    after = bend(bundle, start + NEAR, start + 2.0 * NEAR)
    before = bend(bundle, start + 1.0 - 2.0 * NEAR, start + 1.0 - NEAR)
    limit = tolerance[bundle.owner[chosen]]
    total = np.bincount(bundle.owner, bundle.lengths)[bundle.owner[chosen]]
    length = np.maximum(bundle.lengths[chosen], STILL * (total + limit))
    reach = np.minimum(length, np.cbrt(BEST * limit * length / np.maximum(np.abs(before - after), LITTLE)))
    one = np.searchsorted(chosen, inner)
    worth = np.abs(after[one + 1] - before[one]) * np.minimum(reach[one + 1], reach[one]) ** 2
    return start[one + 1][worth > JUMP * limit[one]]


def bend(bundle: Bundle, t: Array, later: Array) -> Array:
    """The mean curvature (1/m) from each place t to the one a little later; 0 where the curve stands."""
    chord = bundle.points(later) - bundle.points(t)
    a, b = bundle.slopes(t), bundle.slopes(later)
    length = np.hypot(chord[:, 0], chord[:, 1])
    turn = np.arctan2(crosses(a, b), dots(a, b))
    moving = length > STILL * bundle.lengths[bundle.locate(t)[0]]
    return np.where(moving, turn / np.where(moving, length, 1.0), 0.0)


def pauses(bundle: Bundle) -> Array:
    """The places inside where the speed falls to nothing: cusps, and corners at coincident control points."""
    t = np.sort(np.append((bundle.start_of[:, None] + np.arange(LOOKS) / LOOKS).ravel(), bundle.end))
    apart = np.diff(t) > 1.5 / LOOKS  # one curve ends, the next one begins
    first, last = np.append(True, apart), np.append(apart, True)
    speeds, usual = bundle.speeds(t), bundle.usual_speed[bundle.owner[bundle.locate(t)[0]]]
    here = np.arange(len(t))
    before, after = here - ~first, here + ~last  # an end has a neighbour on one side alone
    slow = (speeds <= SLOW * usual) & (speeds <= np.minimum(speeds[before], speeds[after]))
    still = speeds <= PAUSE * usual
    moving = slow & ~still
    chosen = slow & ~(still & (first | last))  # not where the curve pauses at its very end
    at = t.copy()
    at[moving] = slowest(bundle, t[before[moving]], t[after[moving]])
    return at[chosen][bundle.speeds(at[chosen]) <= PAUSE * usual[chosen]]


def slowest(bundle: Bundle, low: Array, high: Array) -> Array:
    """The places (n,) of least speed between two others, by the golden section."""
    for _ in range(NARROWINGS if len(low) else 0):
        width = GOLDEN * (high - low)
        nearer = bundle.speeds(high - width) <= bundle.speeds(low + width)
        low, high = np.where(nearer, low, high - width), np.where(nearer, low + width, high)
    return 0.5 * (low + high)


# A given number of arcs is laid along each curve: single arcs at the ends and biarcs in between. The tangents at the ends of
# the biarcs are the curve's, turned a little so that the deviation swings evenly (see fit). One chain for each of many curves,
# laid at once.

MOST_TILT = 0.1  # radians, of the tangent at a joint
HARDEST = 64.0  # tolerances: what a larger deviation counts
NEWTON = 2  # steps; the first guess is good
BALANCE = 0.1  # of the logarithm of two deviations: correction of that of the legs of a biarc


class Legs(NamedTuple):
    """At places (n,), the middles of a trial's pieces, the logarithm (n,) of the ratio of a biarc's legs."""

    places: Array
    logarithms: Array


class Trial(NamedTuple):
    """The arcs of all chains, from the places `low` to `high`, with chain numbers and deviations; pieces between the nodes."""

    low: Array
    high: Array
    arcs: ArcChain
    chain: Numbers
    errors: Array
    layout: Layout
    nodes: Array
    legs: Legs
    first: Numbers  # arc of each piece

    def work(self, tolerance: Array) -> Array:
        """For each piece what it should do: its own times the cube root of deviation over tolerance, mean of its arcs."""
        strain = np.cbrt(np.minimum(self.errors / tolerance[self.chain], HARDEST))
        return self.layout.capacity * np.add.reduceat(strain, self.first) / np.diff(np.append(self.first, len(strain)))

    def worst(self) -> Array:
        """The largest deviation of each chain."""
        result: Array = np.maximum.reduceat(self.errors, self.first[self.layout.first])
        return result

    def balanced(self) -> Legs:
        """Legs that make both arcs of a biarc deviate more alike; a single arc takes those of its neighbour."""
        layout, (places, before) = self.layout, self.legs
        double = np.flatnonzero(~layout.single)
        one, other = self.errors[self.first[double]], self.errors[self.first[double] + 1]
        with np.errstate(invalid="ignore", divide="ignore"):
            change = np.clip(np.nan_to_num(np.log(one / other)) * BALANCE, -0.5, 0.5)
        logarithms = before.copy()
        logarithms[double] += change
        for outer, step in ((layout.first, 1), (layout.last, -1)):
            alone = outer[layout.single[outer]]
            logarithms[alone] = logarithms[alone + step]
        return Legs(places, logarithms)


def lay_chains(bundle: Bundle, demand: Demand, begin: Array, end: Array, counts: Numbers, legs: Legs) -> Trial:
    """So many arcs from place `begin` to `end` of each curve, distributed so that each gets its share of the load."""
    layout = laid_out(counts)
    nodes, load = shares(demand, begin, end, layout)
    start, pairs = layout.start, np.flatnonzero(~layout.single)
    legs = _legs_at(0.5 * (nodes[start] + nodes[start + 1]), legs, begin, end, layout)
    ratios = np.exp(legs.logarithms)
    reached = load[start] + (load[start + 1] - load[start]) / (1.0 + ratios)
    middles = np.interp(reached, demand.load, demand.places)
    at, tangents = _at_nodes(bundle, nodes, middles, layout)
    p = start[pairs]
    joints, along = biarc_joints(at[p], tangents[p], at[p + 1], tangents[p + 1], ratios[pairs])
    between = _abreast(bundle, joints, along, nodes[p], middles[pairs], nodes[p + 1])
    first = np.cumsum(2 - layout.single) - (2 - layout.single)
    second = first[pairs] + 1
    low, high = _in_order(nodes[:, None], between[:, None], start, first, second)
    starts, ends = _in_order(at, joints, start, first, second)
    ways, _ = _in_order(tangents, along, start, first, second)
    low, high, chain = low[:, 0], high[:, 0], np.repeat(layout.chain, 2 - layout.single)
    arcs = arcs_from(starts, ways, ends)
    return Trial(low, high, arcs, chain, glances(bundle, low, high, arcs), layout, nodes, legs, first)


def _in_order(nodes: Array, joints: Array, start: Numbers, first: Numbers, second: Numbers) -> tuple[Array, Array]:
    """What holds where the arcs start and where they end, from what holds at nodes and joints; second arcs start at joints."""
    size = (len(first) + len(second), nodes.shape[1])
    starts, ends = np.empty(size), np.empty(size)
    starts[first], ends[first] = nodes[start], nodes[start + 1]
    ends[second] = ends[second - 1]
    starts[second] = ends[second - 1] = joints
    return starts, ends


def _at_nodes(bundle: Bundle, nodes: Array, middles: Array, layout: Layout) -> tuple[Array, Array]:
    """Points and unit tangents (nodes, 2): the curve's tangents, tilted, or those that a single arc has."""
    both = np.concatenate((nodes, middles))
    points, directions = bundle.points(both), bundle.tangents(both)
    at, tangents, start = points[: len(nodes)], directions[: len(nodes)].copy(), layout.start
    _tilt(tangents, at, points[len(nodes) :], directions[len(nodes) :], layout)
    one, other = start[layout.first[layout.single[layout.first]]], start[layout.last[layout.single[layout.last]]]
    tangents[one + 1] = _mirrored(at[one + 1] - at[one], tangents[one])
    tangents[other] = _mirrored(at[other + 1] - at[other], tangents[other + 1])
    return at, tangents


def _legs_at(places: Array, legs: Legs, begin: Array, end: Array, layout: Layout) -> Legs:
    """The legs of new pieces, between those before, and beyond the outermost of a curve like these."""
    if not len(legs.places):
        return Legs(places, np.zeros(len(places)))
    outermost = legs.places[np.searchsorted(legs.places, begin)], legs.places[np.searchsorted(legs.places, end) - 1]
    within = np.clip(places, outermost[0][layout.chain], outermost[1][layout.chain])
    return Legs(places, np.interp(within, *legs))


def _tilt(tangents: Array, at: Array, halfway: Array, between: Array, layout: Layout) -> None:
    """Turns the tangents (nodes, 2) at inner nodes by -κ′h²/12, from the curve's turns to the places half-way (pieces, 2)."""
    ahead_of = np.setdiff1d(np.arange(len(layout.chain)), layout.first, assume_unique=True)
    node = layout.start[ahead_of]
    inner = tangents[node]
    back, ahead = np.hypot(*(at[node] - halfway[ahead_of - 1]).T), np.hypot(*(halfway[ahead_of] - at[node]).T)
    one, other = between[ahead_of - 1], between[ahead_of]
    turn_back, turn_ahead = (
        np.arctan2(crosses(one, inner), dots(one, inner)),
        np.arctan2(crosses(inner, other), dots(inner, other)),
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        tilt = -(turn_ahead * back - turn_back * ahead) / (6.0 * (back + ahead))
    tilt = np.clip(np.where(np.isfinite(tilt), tilt, 0.0), -MOST_TILT, MOST_TILT)
    c, s = np.cos(tilt), np.sin(tilt)
    tangents[node] = np.column_stack((c * inner[:, 0] - s * inner[:, 1], s * inner[:, 0] + c * inner[:, 1]))


def _mirrored(chord: Array, tangent: Array) -> Array:
    """The tangents (n, 2) at the other ends of arcs."""
    with np.errstate(invalid="ignore", divide="ignore"):
        result: Array = (2.0 * dots(chord, tangent) / dots(chord, chord))[:, None] * chord - tangent
    return result


def _abreast(bundle: Bundle, joints: Array, along: Array, low: Array, guess: Array, high: Array) -> Array:
    """The places (n,) where the curves cross the normals of the joints, by Newton's method; inside `low` to `high`."""
    margin = 0.01 * (high - low)
    t = guess
    for _ in range(NEWTON):
        rise = dots(bundle.points(t) - joints, along)
        with np.errstate(invalid="ignore", divide="ignore"):
            step = rise / dots(bundle.slopes(t), along)
        t = np.clip(t - np.where(np.isfinite(step), step, 0.0), low + margin, high - margin)
    return t


# The chain with the fewest arcs within the tolerance: chains are laid, their lengths corrected until all deviations are alike,
# and the number of arcs lowered as long as that succeeds. All curves of a bundle are searched side by side, each as long as it
# needs. How hard to try is a choice: where thousands of curves wait, a search that stops a little sooner takes half the time
# and leaves some four per cent more arcs.

MOST = 5  # attempts with one number of arcs: more where one arc counts for more
WEIGHTY = 48  # arcs over attempts
SURE = 0.97  # of the number of arcs that seems necessary: fewer are not tried
MANY = 10_000  # arcs: a part that needs more is halved before


class Found(NamedTuple):
    """Arcs along one curve, and a bound of their distance from it, metres."""

    arcs: ArcChain
    deviation: float


class Effort(NamedTuple):
    """How hard the fewest arcs are looked for."""

    first: float  # times the number of arcs that the curvature asks for: the first attempt
    attempts: int  # with one number of arcs, at least
    enough: float  # times the number of arcs that seems necessary: no fewer are looked for


THOROUGH = Effort(1.0, 2, 1.04)
BRISK = Effort(1.3, 1, 1.15)


class Search:
    """The search along one curve: with how many arcs to try next, and the best chain so far."""

    def __init__(self, count: int, effort: Effort) -> None:
        self.effort = effort
        self.count = math.ceil(effort.first * count)
        self.limit = 4 * count + 16
        self.best: Found | None = None
        self.fewest = 10**9
        self.attempts: Counter[int] = Counter()

    def learn(self, needed: int, success: Found | None) -> bool:
        """Takes in what a trial has shown; is it worth going on? `needed` is the number of arcs that seems necessary."""
        count = self.count
        self.attempts[count] += 1
        if success is not None:
            self.best, self.fewest = success, count
            count = min(needed, count - 1)
        elif needed > count:
            count = needed
        elif self.attempts[count] >= self.enough_attempts(count):
            count += 1
        self.count = count = min(count, self.fewest - 1)
        if self.best is None:
            return count <= self.limit
        enough = self.fewest <= self.effort.enough * needed or count < SURE * needed or count < 2
        return not enough and self.attempts[count] < self.enough_attempts(count)

    def enough_attempts(self, count: int) -> int:
        return min(MOST, max(self.effort.attempts, WEIGHTY // count))


def fewest(bundle: Bundle, tolerance: Array, rounds: int, effort: Effort = THOROUGH) -> list[Found | None]:
    """For each curve the chain with the fewest arcs that was found within its tolerance (curves,) in metres."""
    demand = first_demand(bundle, tolerance)
    whole = np.interp(bundle.end, *demand) - np.interp(bundle.begin, *demand)
    searches = [Search(count, effort) for count in arcs_for(np.minimum(whole, MANY)).tolist()]
    active = np.arange(len(bundle))
    legs = Legs(np.empty(0), np.empty(0))
    for _ in range(rounds):
        counts = np.array([searches[k].count for k in active])
        trial = lay_chains(bundle, demand, bundle.begin[active], bundle.end[active], counts, legs)
        work = trial.work(tolerance[active])
        needed = arcs_for(np.add.reduceat(work, trial.layout.first)).tolist()
        found = successes(bundle, trial, tolerance[active])
        going_on = np.array([searches[k].learn(needed[i], found.get(i)) for i, k in enumerate(active)])
        if not np.any(going_on):
            break
        between = np.full(len(trial.nodes) - 1, np.nan)
        between[trial.layout.start] = work
        active, legs = active[going_on], trial.balanced()
        demand = of_chosen(corrected(demand, trial.nodes, between), bundle, active)
    return [search.best for search in searches]


def successes(bundle: Bundle, trial: Trial, tolerance: Array) -> dict[int, Found]:
    """The chains, by their numbers, that stay within the tolerance, surely."""
    hopeful = trial.worst() <= tolerance
    if not np.any(hopeful):
        return {}
    worst = bounds(bundle, trial, hopeful)
    first = np.append(trial.first[trial.layout.first], len(trial.low))
    return {
        int(k): Found(ArcChain(*(column[first[k] : first[k + 1]] for column in trial.arcs)), float(worst[k]))
        for k in np.flatnonzero(hopeful & (worst <= tolerance))
    }


def bounds(bundle: Bundle, trial: Trial, chosen: NDArray[np.bool_]) -> Array:
    """The largest deviations of the chosen chains (chains,); 0 for the others."""
    arcs = chosen[trial.chain]
    chain = trial.chain[arcs]
    worst = np.zeros(len(chosen))
    errors = deviations(bundle, trial.low[arcs], trial.high[arcs], ArcChain(*(c[arcs] for c in trial.arcs)), chain)
    np.maximum.at(worst, chain, errors)
    return worst


KINK = 1e-6  # radians between a single arc's and the curve's tangent at its end
ROUNDS = 20  # of redistributing the arcs
ROUNDS_OF_HALVES = 6  # where the whole did not succeed
AT_ONCE = 1024  # curves: so many that single steps cost little, so few that the numbers stay near the processor
MANY_SPANS = 4000  # spans: where more wait, the search for the fewest arcs stops a little sooner
DEEPEST = 40  # halvings where nothing helps: at a cusp
NOTHING = 1e-5  # of the tolerance: edges shorter than that are left out
EXTENT_LOOKS = 33  # places in each span that show its extent


class Fit(NamedTuple):
    """Edges in travel order, and a bound of the distance (metres) between the curve and them."""

    edges: tuple[Edge, ...]
    deviation: float


def fit_arcs(curve: Curve, tolerance: float) -> Fit:
    """Tangent-continuous arcs along the whole curve, within `tolerance` metres.

    Where the curve itself has a corner or a cusp so have they. A larger deviation than the tolerance is possible where the
    curve jumps, and is reported.
    """
    return fit_all([curve], [tolerance])[0]


def fit_all(curves: Sequence[Curve], tolerances: Sequence[float]) -> list[Fit]:
    """The same for many curves, much faster than one by one; where there are very many, with some more arcs."""
    effort = THOROUGH if sum(len(curve.control) for curve in curves) <= MANY_SPANS else BRISK
    parts: list[list[Curve]] = [[] for _ in curves]
    for chosen in batches(curves):
        smooth = smooth_parts([curves[k] for k in chosen], np.array([tolerances[k] for k in chosen]))
        for k, row in zip(chosen, smooth, strict=True):
            parts[k] = row
    each = np.array([limit for row, limit in zip(parts, tolerances, strict=True) for _ in row])
    fits = iter(_follow([part for row in parts for part in row], each, effort, 0))
    return [_end_to_end([next(fits) for _ in row]) for row in parts]


def batches(curves: Sequence[Curve]) -> Iterator[list[int]]:
    """Numbers of curves that can be looked at together."""
    alike: dict[int, list[int]] = {}
    for k, curve in enumerate(curves):
        alike.setdefault(curve.degree, []).append(k)
    for numbers in alike.values():
        for first in range(0, len(numbers), AT_ONCE):
            yield numbers[first : first + AT_ONCE]


def _follow(curves: Sequence[Curve], tolerance: Array, effort: Effort, depth: int) -> list[Fit]:
    """Arcs along smooth curves, which are halved where no chain is found."""
    result: list[Fit] = [Fit((), 0.0)] * len(curves)
    missing = []
    for chosen in batches(curves):
        rounds = ROUNDS if depth == 0 else ROUNDS_OF_HALVES
        found = _chains([curves[k] for k in chosen], tolerance[chosen], rounds, effort)
        for k, chain, fit in zip(chosen, found, _fits(found, tolerance[chosen]), strict=True):
            result[k] = fit
            if chain is None:
                away = _extent(curves[k])
                if away <= tolerance[k] or depth >= DEEPEST:
                    # The line from end to end of a short curve that is at most `away` from it.
                    (x0, y0), (x1, y1) = curves[k].ends.tolist()
                    chord = Line(x0, y0, x1, y1)
                    result[k] = Fit((chord,) if chord.length > NOTHING * float(tolerance[k]) else (), away)
                else:
                    missing.append(k)
    if missing:
        halves = [half for k in missing for half in curves[k].split(0.5 * len(curves[k].control))]
        fits = iter(_follow(halves, np.repeat(tolerance[missing], 2), effort, depth + 1))
        for k in missing:
            result[k] = _end_to_end((next(fits), next(fits)))
    return result


def _chains(curves: Sequence[Curve], tolerance: Array, rounds: int, effort: Effort) -> list[Found | None]:
    """One arc or the fewest along each of some curves of one degree; None where none are found."""
    found = _one_arc_each(Bundle(curves), tolerance)
    rest = [k for k, chain in enumerate(found) if chain is None]
    if rest:
        for k, chain in zip(rest, fewest(Bundle([curves[k] for k in rest]), tolerance[rest], rounds, effort), strict=True):
            found[k] = chain
    return found


def _end_to_end(fits: Sequence[Fit]) -> Fit:
    if len(fits) == 1:
        return fits[0]
    return Fit(tuple(edge for fit in fits for edge in fit.edges), max(fit.deviation for fit in fits))


def _fits(found: Sequence[Found | None], tolerance: Array) -> list[Fit]:
    """The lines and arcs of chains; nothing where there is none."""
    chains = [chain.arcs for chain in found if chain is not None]
    edges = iter(ArcChain(*(np.concatenate(column) for column in zip(*chains, strict=True))).edges() if chains else ())
    result = []
    for chain, limit in zip(found, (NOTHING * tolerance).tolist(), strict=True):
        own = [next(edges) for _ in chain.arcs.curvatures] if chain is not None else []
        result.append(Fit(tuple(edge for edge in own if edge.length > limit), chain.deviation if chain is not None else 0.0))
    return result


def _extent(curve: Curve) -> float:
    """A bound of the distance between a short curve and its chord, wherever it turns: its extent, sampled."""
    number = np.arange(len(curve.control))
    points = Bundle([curve]).at(number, np.broadcast_to(np.linspace(0.0, 1.0, EXTENT_LOOKS), (len(number), EXTENT_LOOKS)))
    return float(np.hypot(np.ptp(points[0]), np.ptp(points[1])))


def _one_arc_each(bundle: Bundle, tolerance: Array) -> list[Found | None]:
    """The single arc or line, where it has the right tangents at both ends and stays within the tolerance."""
    low, high = bundle.begin.astype(float), bundle.end.astype(float)
    starts, ways, ends, last = bundle.points(low), bundle.tangents(low), bundle.points(high), bundle.tangents(high)
    arcs = arcs_from(starts, ways, ends)
    mirrored = np.where((arcs.curvatures != 0.0)[:, None], arcs.end_tangents, ways)
    with np.errstate(invalid="ignore"):
        smooth: NDArray[np.bool_] = (np.abs(crosses(mirrored, last)) <= KINK) & (dots(mirrored, last) > 0.0)
    result: list[Found | None] = [None] * len(bundle)
    chosen = np.flatnonzero(smooth)
    if len(chosen):
        own = ArcChain(*(column[chosen] for column in arcs))
        errors = deviations(bundle, low[chosen], high[chosen], own, np.arange(len(chosen)))
        for i in np.flatnonzero(errors <= tolerance[chosen]).tolist():
            result[chosen[i]] = Found(ArcChain(*(column[i : i + 1] for column in own)), float(errors[i]))
    return result
