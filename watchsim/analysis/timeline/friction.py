"""What do the contacts take by friction, pair by pair, in a stretch of time?

Worked out from forces and slip at the contacts, not from what is missing in the books: that the two agree is a check of both.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from watchsim.analysis.contact_forces import Forces, forces
from watchsim.analysis.timeline.flows import NODES, WEIGHTS
from watchsim.analysis.timeline.impact_losses import pair_name
from watchsim.simulation.record.body_frames import frames, speeds
from watchsim.simulation.record.trajectory import Array, Trajectory


def friction_by_pair(run: Trajectory, ends: Sequence[float]) -> list[dict[str, float]]:
    """J taken by each pair of bodies from each of the times `ends` (s) to the next; they must be times of rows."""
    first, last = np.searchsorted(run.t, ends[0], side="left"), np.searchsorted(run.t, ends[-1], side="right")
    rows = np.unique(run.t[first:last])
    h = np.diff(rows)
    times = (rows[:-1, None] + h[:, None] * NODES).ravel()
    weights = (h[:, None] * WEIGHTS).ravel()
    found = forces(run, times)
    taken = weights[:, None] * _powers(run, found)
    stretch = np.searchsorted(np.asarray(ends), times, side="right") - 1
    names = [pair_name(run, int(k)) for k in found.pairs]
    out: list[dict[str, float]] = [{} for _ in range(len(ends) - 1)]
    for k, name in enumerate(names):
        for i, one in enumerate(out):
            value = float(taken[stretch == i, k].sum())
            if value != 0.0:
                one[name] = one.get(name, 0.0) + value
    return out


def _powers(run: Trajectory, found: Forces) -> Array:
    """What each contact takes at each time, W (n, k): the tangential force against the slip."""
    q, u = run.sample(found.t)
    places, rates = frames(run.scene, run.slices, q), speeds(run.scene, run.slices, q, u)
    powers = np.zeros(found.tangential.shape)
    for k, contact in enumerate(found.pairs):
        pair = run.pairs[int(contact)]
        held = np.isfinite(found.point[:, k, 0])
        point, normal = found.point[held, k], found.direction[held, k]
        slip = _speed(pair.body_a, places, rates, held, point) - _speed(pair.body_b, places, rates, held, point)
        along = -normal[:, 1] * slip[:, 0] + normal[:, 0] * slip[:, 1]
        powers[held, k] = -found.tangential[held, k] * along
    return powers


def _speed(body: str, places: dict[str, Array], rates: dict[str, Array], held: Array, point: Array) -> Array:
    """Velocity of a body's material at points, m/s (n, 2)."""
    arm = point - places[body][held, :2]
    spin = rates[body][held, 2]
    return rates[body][held, :2] + np.column_stack((-spin * arm[:, 1], spin * arm[:, 0]))
