"""Which chain of arcs within the tolerance has the fewest?

Chains are laid, their lengths corrected until all deviations are alike, and the number of arcs lowered as long as that
succeeds. All curves of a bundle are searched side by side, each as long as it needs. How hard to try is a choice: where
thousands of curves wait, a search that stops a little sooner takes half the time and leaves some four per cent more arcs.
"""

from __future__ import annotations

import math
from collections import Counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.fitting.arc_chain import Legs, Trial, lay_chains
from watchsim.geometry.fitting.biarc import ArcChain
from watchsim.geometry.fitting.bundle import Bundle
from watchsim.geometry.fitting.curve import Array
from watchsim.geometry.fitting.demand import corrected, first_demand, of_chosen
from watchsim.geometry.fitting.deviation import deviations
from watchsim.geometry.fitting.piece_layout import arcs_for

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
