"""How far may a motion part from that of a run because Coulomb's law leaves forces open?

Bodies that press on each other in more places than their motion decides may share their loads in many ways. Where one of these
places slides, its friction goes with its load, and so do the accelerations: all those between two bounds obey the laws, and two
methods may take two of them. The bounds are linear programs over the contact forces at a row of the run: these make the run's
gap accelerations, push, lie within their cones, and on their edges where contacts slide.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from hunt.books import Touches, masses, pulls
from watchsim.simulation.state import EventKind
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


# Which touches may a run make or miss?
#
# Bodies that swing back to where they parted, as equal pendulums do, approach each other to nothing and turn. Whether they
# touch then is a matter of rounding. An impact whose gap would open again by itself before it is deeper than the error of a
# position is such a graze: of two runs with that error one makes it and the other does not, and both are right. What it does is
# no more than the jump of velocities in the rows.
LOOKS = 12  # each at a quarter of the time of the one before
ALIKE = 0.995  # cosine of the angle by which a normal may turn meanwhile
PASSED_ON = 1e-9  # of the fastest approach of an instant: slower ones are carried along


def grazed(run: Trajectory, gap: float, weights: Array, times: Array) -> Array:
    """(samples,): how far grazes have moved bodies until those times, as shares of the size that `weights` makes.

    `gap` (m) is the error of a position.
    """
    touches = Touches(run.scene, run.slices, np.ones(run.q.shape[1]), NEAR)
    hits, moved = run.events[run.events["kind"] == EventKind.IMPACT], np.zeros(len(times))
    for t in np.unique(hits["t"]):
        rows, here = np.flatnonzero(run.t == t), hits[hits["t"] == t]
        speeds = -here["value"]
        struck = here[speeds > PASSED_ON * speeds.max()]
        if len(rows) > 1 and len(struck) and all(_is_graze(run, touches, event, rows[0], gap) for event in struck):
            jump = np.abs(run.u[rows[-1]] - run.u[rows[0]])
            moved += float((jump * weights).max()) * np.maximum(times - t, 0.0)
    return moved


def _is_graze(run: Trajectory, touches: Touches, event: np.void, row: int, gap: float) -> bool:
    """Would the gap open again before it is deeper than `gap`, if the bodies went on as they did before?

    A gap that closes at v and turns within a time t gets no deeper than v t / 2.
    """
    pair = run.pairs[int(event["contact"])]
    bodies, speed, u = (pair.body_a, pair.body_b), -float(event["value"]), run.u[row]
    closing = [normal for normal, rate in touches.gap_rates(run.q[row], u, bodies) if rate < -0.5 * speed]
    for look in range(LOOKS):
        after = 2.0 * gap / speed * 0.25**look
        q = run.q[row] + after * (u + 0.5 * after * run.a[row])
        rates = [
            rate
            for (x, y), rate in touches.gap_rates(q, u + after * run.a[row], bodies)
            if any(x * nx + y * ny > ALIKE for nx, ny in closing)
        ]
        if rates and min(rates) >= 0.0:
            return True
    return False
