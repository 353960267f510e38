"""Which contacts of primitives that do not share a symmetry could touch in a cell, whatever part of the turn it stands for?

Such a primitive counts as being everywhere on the ring that it sweeps about its body's origin.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.cell_motion import CellMotion, turned
from watchsim.candidates.chords import chords
from watchsim.model.records import Model

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class LooseContacts:
    """Contacts `ids` between loose primitives of one body and primitives of another that share its symmetry, or need none."""

    def __init__(self, model: Model, p: int, ids: Integers, loose: Integers, partner: Integers) -> None:
        """`loose`, `partner`: the two primitives of each contact."""
        pair, self._ids = model.pairs[p], ids
        self._motion, self._clearance = CellMotion(model.bodies, pair), float(pair.clearance)
        rings, self._ring = np.unique(loose, return_inverse=True)
        partners, self._partner = np.unique(partner, return_inverse=True)
        drawn = chords(model.primitives[rings], self._clearance)
        self._low, self._high = _range(np.hypot(*drawn.points.T), drawn.points[None], drawn.first, drawn.sag)
        self._drawn = chords(model.primitives[partners], self._clearance)
        self._reach = np.maximum.reduceat(np.hypot(*self._drawn.points.T), self._drawn.first[:-1]) + self._drawn.sag
        bodies = model.primitives.body
        self._turning, self._other = int(bodies[rings[0]]), int(bodies[partners[0]])

    def candidates(self, at: Array, room: Array) -> tuple[Integers, Integers]:
        """(places, contacts) that could touch when cell coordinates are within `room` of `at`, (places, axes)."""
        (ox, oy, _), (x, y, angle) = (self._motion.pose(body, at) for body in (self._turning, self._other))
        points = turned(self._drawn.points[None], angle) + np.stack([x - ox, y - oy], axis=1)[:, None, :]
        low, high = _range(np.hypot(points[..., 0], points[..., 1]), points, self._drawn.first, self._drawn.sag)
        shift, swing = self._motion.freedom(self._other, room)
        travel = shift + swing * self._reach + self._motion.freedom(self._turning, room)[0] + self._clearance
        low, high = (low - travel)[:, self._partner], (high + travel)[:, self._partner]
        place, found = np.nonzero((low <= self._high[..., self._ring]) & (self._low[..., self._ring] <= high))
        return place, self._ids[found]


def _range(distance: Array, points: Array, first: Integers, sag: Array) -> tuple[Array, Array]:
    """Bounds of the distance from the origin over each primitive, of whose points it is `distance`, (..., points)."""
    # A chord of length L between points at distances a and b comes no closer than (a + b - L)/2.
    length = np.hypot(*np.moveaxis(np.diff(points, axis=-2), -1, 0))
    inner = 0.5 * (distance[..., :-1] + distance[..., 1:] - length.reshape(distance[..., 1:].shape))
    inner = np.concatenate([inner, distance[..., -1:]], axis=-1)
    inner[..., first[1:] - 1] = distance[..., first[1:] - 1]
    low = np.minimum.reduceat(inner, first[:-1], axis=-1) - sag
    return np.maximum(low, 0.0), np.maximum.reduceat(distance, first[:-1], axis=-1) + sag
