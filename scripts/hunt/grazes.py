"""Which touches may a run make or miss?

Bodies that swing back to where they parted, as equal pendulums do, approach each other to nothing and turn. Whether they touch
then is a matter of rounding. An impact whose gap would open again by itself before it is deeper than the error of a position is
such a graze: of two runs with that error one makes it and the other does not, and both are right. What it does is no more than
the jump of velocities in the rows.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hunt.impulses import Touches
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

Array = NDArray[np.float64]

NEAR = 1e-6  # of the size: outlines this close touch
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
