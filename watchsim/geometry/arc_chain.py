"""How are so many arcs laid along each curve?

Single arcs at the ends and biarcs in between. The tangents at the ends of the biarcs are the curve's, turned a little so that
the deviation swings evenly (see fit). One chain for each of many curves, laid at once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.biarc import ArcChain, arcs_from, biarc_joints, crosses, dots
from watchsim.geometry.bundle import Bundle, Numbers
from watchsim.geometry.curve import Array
from watchsim.geometry.deviation import glances

# Arcs of the best chain whose work the pieces do. At its ends the chain has the tangent of the curve, which costs some.
ALONE, BOTH_ENDS, ONE_END, INSIDE = 0.69, 1.38, 1.75, 2.0
LOST_EVEN, LOST_ODD = 0.62, 0.56  # so many arcs less than it has does a whole chain
MOST_TILT = 0.1  # radians, of the tangent at a joint
HARDEST = 64.0  # tolerances: what a larger deviation counts
NEWTON = 2  # steps; the first guess is good
BALANCE = 0.1  # of the logarithm of two deviations: correction of that of the legs of a biarc


class Demand(NamedTuple):
    """Ascending places (n,) of curves and how many arcs (n,) the best chains need up to each; both skip 1 between curves."""

    places: Array
    load: Array


class Legs(NamedTuple):
    """At places (n,), the middles of a trial's pieces, the logarithm (n,) of the ratio of a biarc's legs."""

    places: Array
    logarithms: Array


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


def lay_chains(bundle: Bundle, demand: Demand, begin: Array, end: Array, counts: Numbers, legs: Legs) -> Trial:
    """So many arcs from place `begin` to `end` of each curve, distributed so that each gets its share of the load."""
    layout = laid_out(counts)
    nodes, load = _shares(demand, begin, end, layout)
    legs = _legs_at(0.5 * (nodes[layout.start] + nodes[layout.start + 1]), legs, begin, end, layout)
    ratios = np.exp(legs.logarithms)
    reached = load[layout.start] + (load[layout.start + 1] - load[layout.start]) / (1.0 + ratios)
    middles = np.interp(reached, demand.load, demand.places)
    start, pairs = layout.start, np.flatnonzero(~layout.single)
    both = np.concatenate((nodes, middles))
    points, directions = bundle.points(both), bundle.tangents(both)
    at, tangents = points[: len(nodes)], directions[: len(nodes)].copy()
    _tilt(tangents, at, points[len(nodes) :], directions[len(nodes) :], layout)
    one, other = layout.first[layout.single[layout.first]], layout.last[layout.single[layout.last]]
    tangents[start[one] + 1] = _mirrored(at[start[one] + 1] - at[start[one]], tangents[start[one]])
    tangents[start[other]] = _mirrored(at[start[other] + 1] - at[start[other]], tangents[start[other] + 1])
    p = start[pairs]
    joints, along = biarc_joints(at[p], tangents[p], at[p + 1], tangents[p + 1], ratios[pairs])
    between = _abreast(bundle, joints, along, nodes[p], middles[pairs], nodes[p + 1])
    first = np.cumsum(2 - layout.single) - (2 - layout.single)
    second = first[pairs] + 1
    size = len(layout.chain) + len(pairs)
    low, high, chain = np.empty(size), np.empty(size), np.empty(size, dtype=np.intp)
    starts, ways, ends = np.empty((size, 2)), np.empty((size, 2)), np.empty((size, 2))
    low[first], starts[first], ways[first], chain[first] = nodes[start], at[start], tangents[start], layout.chain
    high[first], ends[first] = nodes[start + 1], at[start + 1]
    low[second], starts[second], ways[second], chain[second] = between, joints, along, layout.chain[pairs]
    high[second], ends[second] = high[second - 1], ends[second - 1]
    high[second - 1], ends[second - 1] = between, joints
    arcs = arcs_from(starts, ways, ends)
    return Trial(low, high, arcs, chain, glances(bundle, low, high, arcs), layout, nodes, legs, first)


def _shares(demand: Demand, begin: Array, end: Array, layout: Layout) -> tuple[Array, Array]:
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
