"""How far may a motion part from that of a run because Coulomb's law leaves forces open?

Bodies that press on each other in more places than their motion decides may share their loads in many ways. Where one of these
places slides, its friction goes with its load, and so do the accelerations: all those between two bounds obey the laws, and two
methods may take two of them. The bounds are linear programs over the contact forces at a row of the run: these make the run's
gap accelerations, push, lie within their cones, and on their edges where contacts slide.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from hunt.energies import masses, pulls
from hunt.impulses import Touches
from watchsim.simulation.trajectory import Trajectory

Array = NDArray[np.float64]

NEAR = 1e-6  # of the size: outlines this close touch
RATE = 1e-6  # of the fastest: a slip, or what a gap opens by, below is none
INSTANTS = 24


def open_motion(run: Trajectory, until: float, weights: Array) -> float:
    """Upper bound, as a share of the size that `weights` makes of coordinates, of how far motions may part by `until` (s)."""
    rows = np.unique(np.searchsorted(run.t, np.linspace(run.t[0], until, INSTANTS, endpoint=False), side="right") - 1)
    touches = Touches(run.scene, run.slices, masses(run.scene), NEAR)
    spans = [float((open_accelerations(run, int(row), touches) * weights).max()) for row in rows]
    return 0.5 * max(spans, default=0.0) * (until - float(run.t[0])) ** 2


def open_accelerations(run: Trajectory, row: int, touches: Touches) -> Array:
    """(n,): how far apart the bounds are between which the laws leave the acceleration of each coordinate open at a row."""
    m, u, a = masses(run.scene), run.u[row], run.a[row]
    load, quickest = pulls(run.scene, run, row), float(np.abs(a).max())
    places = list(touches.rows(run.q[row], apart=True))
    if not places or quickest == 0.0:
        return np.zeros(len(m))
    frictions, normals, tangents = (np.array(column) for column in zip(*places, strict=True))
    rate, change = (RATE * float((np.abs(np.vstack([normals, tangents])) @ np.abs(x)).max()) for x in (u, a))
    lasts = (np.abs(normals @ u) <= rate) & (np.abs(normals @ a) <= change)
    if not lasts.any():
        return np.zeros(len(m))
    frictions, normals, tangents = frictions[lasts], normals[lasts], tangents[lasts]
    forces = np.vstack([normals, tangents]).T / m[:, None]  # accelerations that unit forces along normals and tangents make
    free = load / m
    slips, starts = tangents @ u, tangents @ a
    way = np.where(np.abs(slips) > rate, np.sign(slips), np.where(np.abs(starts) > change, np.sign(starts), 0.0))
    sliding, stuck, count = way != 0.0, way == 0.0, len(normals)
    kept = np.vstack([normals, tangents[stuck]])
    edges = np.hstack([np.diag(frictions * way), np.eye(count)])[sliding]
    one, other = (np.hstack([-np.diag(frictions), side * np.eye(count)])[stuck] for side in (1.0, -1.0))
    # Forces in units that accelerate about as much as the run does.
    unit = quickest / float(np.abs(forces).max())
    laws = {
        "A_eq": np.vstack([kept @ forces * unit / quickest, edges]),
        "b_eq": np.append(kept @ (a - free) / quickest, np.zeros(len(edges))),
        "A_ub": np.vstack([one, other]),
        "b_ub": np.zeros(2 * len(one)),
        "bounds": [(0.0, None)] * count + [(None, None)] * count,
    }
    ends = [[_least(side * row_of_forces, laws) for side in (1.0, -1.0)] for row_of_forces in forces]
    return np.array([-(low + high) * unit if low is not None and high is not None else 0.0 for low, high in ends])


def _least(slope: Array, laws: dict[str, Any]) -> float | None:
    """None where no forces obey the laws, or where nothing bounds them."""
    found = linprog(slope, **laws)
    return float(found.fun) if found.status == 0 else None
