"""Which forces act over a stretch of time, between which bodies and in which bearings?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from watchsim.analysis.contact_forces import Forces, forces
from watchsim.analysis.timeline.impact_losses import pair_name
from watchsim.render.frame.pose_history import Window
from watchsim.simulation.record.trajectory import Array, Trajectory

MOST = 12_000  # instants; each takes a quarter of a millisecond
FINE = 400  # instants at least
JUST = 1e-6  # of a step: so long before its end its contacts still hold


@dataclass(frozen=True)
class Curves:
    """Forces at the times t (s, n): normal and tangential by pair of bodies, and those of the bearings, N (n,)."""

    t: Array
    normal: dict[str, Array]
    tangential: dict[str, Array]
    pivots: dict[str, Array]


def curves(run: Trajectory, spans: Sequence[Window]) -> list[Curves]:
    """Forces over some stretches of time: right after every row, just before the next, and between."""
    times = [_instants(run, span) for span in spans]
    count = sum(map(len, times))
    if count > MOST:
        raise ValueError(
            f"{spans[0][0]:.9g} s to {spans[-1][1]:.9g} s hold {count} instants at which forces would have to be worked out, "
            f"more than {MOST}; choose a shorter window"
        )
    found = forces(run, np.concatenate(times))
    ends = np.cumsum([0, *map(len, times)]).tolist()
    return [_summed(run, found, slice(first, last)) for first, last in pairwise(ends)]


def _summed(run: Trajectory, found: Forces, own: slice) -> Curves:
    """By pair of bodies: several points may touch at once, and what they press, and what they rub, adds up."""
    normal: dict[str, Array] = {}
    tangential: dict[str, Array] = {}
    for k, contact in enumerate(found.pairs):
        name = pair_name(run, int(contact))
        normal[name] = normal.get(name, 0.0) + found.normal[own, k]
        tangential[name] = tangential.get(name, 0.0) + found.tangential[own, k]
    loads = {name: np.hypot(*force[own].T) for name, force in found.pivots.items()}
    return Curves(found.t[own], normal, tangential, loads)


def _instants(run: Trajectory, span: Window) -> Array:
    inside = run.t[(run.t > span[0]) & (run.t < span[1])]
    edges = np.unique(np.concatenate(([span[0]], inside, [span[1]])))
    before = edges[1:] - np.maximum(JUST * np.diff(edges), np.spacing(edges[1:]))
    return np.unique(np.concatenate((edges[:-1], before, np.linspace(span[0], before[-1], FINE))))
