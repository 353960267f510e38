"""Where do the parts stand that rest on the oscillator, when it turns at another amplitude?

A dead-beat tooth stays where it is, since its locking arc has the oscillator's pivot as centre; a recoiling one gives way. The
contacts in force stay closed: of all positions that keep their gaps, the nearest one in the metric of the mass matrix.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.model.records import frozen
from watchsim.simulation.loop_state.state import State
from watchsim.simulation.overlap_removal import directions, kinematics_at
from watchsim.studies.limit_cycle.run_from_state import Loop

ROUNDS = 30  # of Newton's method; faces are lines and arcs
CLOSED = 0.1  # of what the event loop takes for a closed gap; some units in the last place


def in_force(state: State) -> NDArray[np.int64]:
    """The closed contacts."""
    return state.active[: int(state.now.awake_contacts + state.now.sleeping_contacts)]


def follow(loop: Loop, state: State, coordinate: int) -> bool:
    """Move all but that coordinate until the contacts in force have the gap 0 again.

    False where that cannot be: the oscillator is turned too far, and another face would be touched.
    """
    ids = np.unique(in_force(state))
    if not len(ids):
        return True
    model = loop.compiled.model._replace(contacts=frozen(loop.compiled.model.contacts[ids].copy()))
    root = np.sqrt(model.coordinates.mass)
    for _ in range(ROUNDS):
        closed = kinematics_at(model, state.q)
        gaps = closed.kin.g
        if np.abs(gaps).max() <= CLOSED * loop.options.gap_zero:
            return bool((closed.kin.margin >= -loop.options.extent).all())
        ways = directions(closed, closed.w_N, len(state.q)) / root
        ways[:, coordinate] = 0.0
        change = -np.linalg.lstsq(ways, gaps, rcond=1e-9)[0]
        state.q[:] += change / root
        if np.abs(change / root / model.coordinates.scale).max() > 1.0:
            return False
    return False
