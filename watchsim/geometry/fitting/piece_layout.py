"""How do the pieces of chains share the work?

A chain begins and ends with single arcs; all others come in pairs, as biarcs. What a piece can do is measured in arcs of the
best chain there could be (see fit).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.fitting.bundle import Numbers
from watchsim.geometry.fitting.curve import Array

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
