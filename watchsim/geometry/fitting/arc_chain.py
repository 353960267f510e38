"""How is a given number of arcs laid along each curve?

Single arcs at the ends and biarcs in between. The tangents at the ends of the biarcs are the curve's, turned a little so that
the deviation swings evenly (see fit). One chain for each of many curves, laid at once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from watchsim.geometry.fitting.biarc import ArcChain, arcs_from, biarc_joints, crosses, dots
from watchsim.geometry.fitting.bundle import Bundle, Numbers
from watchsim.geometry.fitting.curve import Array
from watchsim.geometry.fitting.deviation import glances
from watchsim.geometry.fitting.piece_layout import Demand, Layout, laid_out, shares

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
