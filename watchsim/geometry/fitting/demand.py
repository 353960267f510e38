"""How many arcs does each part of a curve need?

From the rate of its curvature first; then from what a trial has shown.
"""

from __future__ import annotations

import math

import numpy as np

from watchsim.geometry.fitting.biarc import crosses, dots
from watchsim.geometry.fitting.bundle import Bundle, Numbers
from watchsim.geometry.fitting.curve import Array
from watchsim.geometry.fitting.piece_layout import Demand

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
