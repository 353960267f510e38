"""What may the percussions of a step be, and how far from it are they?

Rows are N, T of each of the m closed contacts, then one for each bearing with dry friction. Percussions P make rates b + G P.
A normal percussion is at least `low`, and more only where its rate is zero. A tangential one lies within
ends[i, 0] + ends[i, 1] N and ends[i, 2] + ends[i, 3] N, N the normal percussion of its contact, that of a bearing within
ends[m + k, 0] and ends[m + k, 2]: at the lower end where its rate is positive, at the upper one where that is negative.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import by_reference, kernel

Array = NDArray[np.float64]


class Laws(NamedTuple):
    """The laws in SI units, the percussions P that obey them, and room for `projected_newton` to work in."""

    G: Array  # (rows, rows)
    b: Array
    low: Array  # (contacts,)
    ends: Array  # (contacts + bearings, 4)
    P: Array
    trial: Array
    step: Array
    right: Array
    J: Array  # (rows, rows)
    scale: Array
    order: NDArray[np.int64]


LawsRef = by_reference(Laws, __name__)


def laws(contacts: int, bearings: int) -> Laws:
    """Room for that many contacts and bearings."""
    rows = 2 * contacts + bearings
    by_row = {name: np.zeros(rows) for name in ("b", "P", "trial", "step", "right", "scale")}
    square = {name: np.zeros((rows, rows)) for name in ("G", "J")}
    low, ends, order = np.zeros(contacts), np.zeros((contacts + bearings, 4)), np.zeros(rows, np.int64)
    return Laws(low=low, ends=ends, order=order, **square, **by_row)


@kernel
def cone(ends, i, friction):
    """Coulomb's law for contact i."""
    ends[i, 0], ends[i, 1], ends[i, 2], ends[i, 3] = 0.0, -friction, 0.0, friction


@kernel
def improvement(laws, rows, row, P):
    """What P[row] would have to be to end its own rate."""
    rate = laws.b[row]
    for column in range(rows):
        rate += laws.G[row, column] * P[column]
    return P[row] - rate / laws.G[row, row]


@kernel
def bounds(laws, m, row, P):
    """Between which values P[row] may be."""
    if row >= 2 * m:
        return laws.ends[row - m, 0], laws.ends[row - m, 2]
    i = row // 2
    if row % 2 == 0:
        return laws.low[i], math.inf
    ends, normal = laws.ends, P[row - 1]
    return ends[i, 0] + ends[i, 1] * normal, ends[i, 2] + ends[i, 3] * normal


@kernel
def improved(laws, m, rows, row, P):
    """P[row] changed by what would end its own rate, and put back where it may be."""
    least, most = bounds(laws, m, row, P)
    return min(most, max(least, improvement(laws, rows, row, P)))


@kernel
def size(laws, rows, P):
    """The largest percussion, or what it takes to stop the fastest rate; each times the root of G's diagonal."""
    largest = 0.0
    for row in range(rows):
        if laws.G[row, row] > 0.0:
            root = laws.G[row, row] ** 0.5
            largest = max(largest, abs(P[row]) * root, abs(laws.b[row]) / root)
    return largest


@kernel
def residual(laws, m, rows):
    """How far P is from its own projected improvement, as a share of its size."""
    worst, scale = 0.0, size(laws, rows, laws.P)
    for row in range(rows):
        if laws.G[row, row] > 0.0:
            worst = max(worst, abs(improved(laws, m, rows, row, laws.P) - laws.P[row]) * laws.G[row, row] ** 0.5)
    return worst / scale if scale > 0.0 else 0.0
