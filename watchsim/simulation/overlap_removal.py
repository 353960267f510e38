"""By which smallest change of the coordinates is an overlap taken back?

Contacts push only: no gap may be left negative, each may open. Among all changes that achieve this the one is taken that is
smallest in the metric of the mass matrix.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.kinematics import Closed, closed_contacts, every_contact
from watchsim.contact.poses import poses
from watchsim.model.records import Model
from watchsim.simulation.options import Options
from watchsim.tolerances import FURTHEST_TAKEN_BACK, IMMOBILE, NO_CHANGE_LEFT, OVERLAP_GONE

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

ROUNDS = 6  # of Newton's method; an overlap is smaller than all radii, so that two suffice


def kinematics_at(model: Model, q: Array) -> Closed:
    """Gaps and force directions of all contacts of the model at rest at q."""
    closed = closed_contacts(len(model.contacts))
    every_contact(model, q, np.zeros(len(q)), poses(len(model.bodies)), closed)
    return closed


def overlapping_rows(model: Model, closed: Closed, options: Options, near: float, least: float) -> Integers:
    """Contacts within their primitives that overlap by more than `least`, up to `near`, without the backs of convex corners."""
    gap = closed.kin.g
    rows = np.flatnonzero((gap < -least) & (gap >= -near) & (closed.kin.margin >= -options.extent))
    return np.array([k for k in rows if not _is_back(model, gap, closed.kin.margin >= -options.extent, int(k))], np.int64)


def _is_back(model: Model, gap: Array, inside: NDArray[np.bool_], k: int) -> bool:
    """True if the same circle lies less deep behind a neighbouring edge: near a sharp corner both faces are close."""
    contact = model.contacts[k]
    beside = set(_beside(model, int(contact.b)))
    rivals = np.flatnonzero((model.contacts.a == contact.a) & inside & (gap > gap[k]))
    return any(int(model.contacts[r].b) in beside for r in rivals)


def _beside(model: Model, primitive: int) -> Iterator[int]:
    """The edges next to one on the same outline, round a convex corner too."""
    for side in ("before", "after"):
        other = int(model.primitives[primitive][side])
        if other >= 0:
            yield other
            beyond = int(model.primitives[other][side])
            if beyond >= 0:
                yield beyond


def taken_back_from(model: Model, q: Array, options: Options, near: float) -> Array | None:
    """Coordinates close to q at which nothing overlaps; None where there are none."""
    kept: set[int] = set()
    root = np.sqrt(model.coordinates.mass)
    moved = q.copy()
    for _ in range(ROUNDS):
        closed = kinematics_at(model, moved)
        # What no motion opens, as a disc about its own pivot against a bar that slides past it, stays as it is drawn.
        across, along = directions(closed, closed.w_N, len(q)) / root, directions(closed, closed.w_T, len(q)) / root
        mobile = np.linalg.norm(across, axis=1) > IMMOBILE * np.linalg.norm(np.hstack([across, along]), axis=1)
        overlapping = overlapping_rows(model, closed, options, near, 0.0)
        overlapping = overlapping[mobile[overlapping]]
        if not len(overlapping) or -closed.kin.g[overlapping].min() <= OVERLAP_GONE * options.gap_zero:
            return moved if _furthest(model, moved - q, options.size) <= FURTHEST_TAKEN_BACK * near else None
        # What touches from outside must not be pushed into.
        close = (np.abs(closed.kin.g) <= near) & (closed.kin.margin >= -options.extent) & (closed.kin.g >= 0.0)
        kept |= {*overlapping.tolist(), *np.flatnonzero(close & mobile).tolist()}
        rows = np.array(sorted(kept))
        change = _least_change(across[rows], -closed.kin.g[rows])
        if change is None:
            return None
        moved += change / root
    return None


def directions(closed: Closed, sparse: Array, n: int) -> Array:
    """(contacts, n): w_N or w_T of all contacts over the coordinates."""
    out = np.zeros((len(closed.ids), n))
    for row, slots in enumerate(closed.slots):
        np.add.at(out[row], closed.coord[row, :slots], sparse[row, :slots])
    return out


def _least_change(ways: Array, wanted: Array) -> Array | None:
    """The shortest y with ways · y >= wanted, None where there is none (Lawson and Hanson 1974, chapter 23)."""
    from scipy.optimize import nnls

    size = np.linalg.norm(ways, axis=1)
    scale = float(wanted.max())
    rows, bounds = ways / size[:, None], wanted / size
    unit = scale / float(size.max())
    system = np.vstack([rows.T, bounds[None] / unit])
    target = np.append(np.zeros(ways.shape[1]), 1.0)
    loads, _ = nnls(system, target)
    left = system @ loads - target
    if np.linalg.norm(left) < NO_CHANGE_LEFT:
        return None
    change: Array = -left[:-1] / left[-1] * unit
    return change


def _furthest(model: Model, change: Array, size: float) -> float:
    """A bound of how far any point moves, m."""
    return float(np.max(np.abs(change) / model.coordinates.scale * size, initial=0.0))
