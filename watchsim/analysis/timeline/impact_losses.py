"""What do impacts take in each phase, by pair of bodies?"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Array, Trajectory

LOSSES = (EventKind.IMPACT, EventKind.JAM)


@dataclass(frozen=True, slots=True)
class Losses:
    """Of n stretches of time: J by pair of bodies, (n, len(pairs)), and how many impacts that were."""

    pairs: tuple[str, ...]
    taken: Array
    count: NDArray[np.int64]

    @property
    def whole(self) -> Array:
        """(n,): of all pairs."""
        return self.taken.sum(axis=1)

    def by_pair(self) -> list[dict[str, float]]:
        """Of each stretch those pairs that struck."""
        rows = zip(self.taken.tolist(), (self.count > 0).tolist(), strict=True)
        return [{pair: value for pair, value, struck in zip(self.pairs, *row, strict=True) if struck} for row in rows]


def impact_losses(
    run: Trajectory, starts: Array, ends: Array, after_start: NDArray[np.bool_], with_end: NDArray[np.bool_]
) -> Losses:
    """Of the stretches from `starts` to `ends` (s).

    Impacts at its start belong to a stretch but for those of `after_start`, impacts at its end only to those of `with_end`.
    """
    # Bisection, not numpy's search: that would copy the whole column for each few beats.
    first, last = bisect_left(run.events["t"], starts[0]), bisect_right(run.events["t"], ends.max())
    own = run.events[first:last]
    own = own[np.isin(own["kind"], LOSSES)]
    used, contact = np.unique(own["contact"], return_inverse=True)
    named = [pair_name(run, k) for k in used.tolist()]
    pairs = tuple(dict.fromkeys(named))
    pair = np.array([pairs.index(name) for name in named], np.int64)[contact]
    t = np.ascontiguousarray(own["t"])
    low = np.where(after_start, np.searchsorted(t, starts, side="right"), np.searchsorted(t, starts, side="left"))
    high = np.where(with_end, np.searchsorted(t, ends, side="right"), np.searchsorted(t, ends, side="left"))
    number = np.maximum(high - low, 0)
    of = np.repeat(np.arange(len(starts)), number)
    k = low[of] + np.arange(len(of)) - (np.cumsum(number) - number)[of]
    cell, cells = of * len(pairs) + pair[k], len(starts) * len(pairs)
    taken = np.asarray(np.bincount(cell, own["energy_lost"][k], cells), np.float64).reshape(len(starts), len(pairs))
    return Losses(pairs, taken, np.bincount(cell, minlength=cells).reshape(taken.shape))


def pair_name(run: Trajectory, contact: int) -> str:
    """The two bodies of a contact, in the order of the scene."""
    pair = run.pairs[contact]
    return "-".join(sorted((pair.body_a, pair.body_b), key=[body.name for body in run.scene.bodies].index))
