"""Which x without negative entries brings A x nearest to b?

The active-set method of Lawson and Hanson (Solving Least Squares Problems, 1974, ch. 23). Written out here because a run needs
it for a few dozen systems of a few unknowns, and loading scipy's takes longer than solving them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LEAST = 1e-14  # of the largest |A| |b|: a slope below that is rounding
TURNS = 10  # for each unknown; each turn lowers the distance, so that more are not needed but for rounding


def nonnegative(system: Array, right: Array, likely: NDArray[np.bool_] | None = None) -> Array:
    """x (n,) with x >= 0 that makes |A x - b| smallest; A (m, n) should have independent columns, m >= n.

    `likely` are the entries that are probably above zero, such as those of a similar system: if so, most of the work is saved.
    """
    count = system.shape[1]
    x, used = _begun(system, right, likely)
    least = LEAST * float(np.abs(system).max(initial=0.0) * np.abs(right).max(initial=0.0))
    for _ in range(TURNS * count):
        slope = np.where(used, -np.inf, system.T @ (right - system @ x))
        best = int(np.argmax(slope))
        if not slope[best] > least:
            break
        used[best] = True
        x = _within(system, right, x, used)
        if not used[best]:  # only rounding lets it out again at once
            break
    return x


def nonnegative_of_many(systems: Array, rights: Array) -> Array:
    """x (k, n): of each of k systems (k, m, n) with b (k, m) what `nonnegative` gives.

    Of systems that are much alike most have the same entries above zero: found for one, they are tried on all that are left.
    """
    x = np.zeros((len(systems), systems.shape[2]))
    left, likely = np.arange(len(systems)), None
    while len(left):
        first, left = left[0], left[1:]
        x[first] = nonnegative(systems[first], rights[first], likely)
        likely = x[first] > 0.0
        found, best = _of_alike(systems[left], rights[left], likely)
        x[left[best]] = found[best]
        left = left[~best]
    return x


def _of_alike(systems: Array, rights: Array, used: NDArray[np.bool_]) -> tuple[Array, NDArray[np.bool_]]:
    """The best x with only the `used` entries; and where it is the best of all: none is negative, and no other would help."""
    q, r = np.linalg.qr(systems[:, :, used])
    x = np.zeros((len(systems), len(used)))
    x[:, used] = np.linalg.solve(r, q.transpose(0, 2, 1) @ rights[:, :, None])[:, :, 0]
    slope = (systems.transpose(0, 2, 1) @ (rights[:, :, None] - systems @ x[:, :, None]))[:, :, 0]
    least = LEAST * np.abs(systems).max(axis=(1, 2)) * np.abs(rights).max(axis=1)
    return x, (x[:, used] > 0.0).all(axis=1) & (slope[:, ~used] <= least[:, None]).all(axis=1)


def _begun(system: Array, right: Array, likely: NDArray[np.bool_] | None) -> tuple[Array, NDArray[np.bool_]]:
    """Where to begin, and which entries are in use there: the best with the likely ones, if none of them is negative."""
    x = np.zeros(system.shape[1])
    if likely is not None and likely.any():
        x[likely] = np.linalg.lstsq(system[:, likely], right, rcond=None)[0]
        if np.all(x[likely] > 0.0):
            return x, likely.copy()
        x[:] = 0.0
    return x, np.zeros(len(x), bool)


def _within(system: Array, right: Array, x: Array, used: NDArray[np.bool_]) -> Array:
    """The best x that has only the `used` entries, from one that is feasible; those that would become negative leave `used`."""
    while used.any():
        best = np.zeros(len(x))
        best[used] = np.linalg.lstsq(system[:, used], right, rcond=None)[0]
        falling = np.flatnonzero(used & (best <= 0.0))
        if not len(falling):
            return best
        way = x[falling] - best[falling]
        steps = np.divide(x[falling], way, out=np.zeros(len(way)), where=way > 0.0)
        x = np.maximum(x + steps.min() * (best - x), 0.0)
        first = falling[np.argmin(steps)]
        x[first], used[first] = 0.0, False
    return np.zeros(len(x))
