"""Which contacts of an instant do the same to the bodies as one that is met first?

Both corners of a flap that lands on a bar turn it about its one pivot. If its face is off by a picometre, only one of them can
be closed: to close the other one, too, would press the first one in. The other one waits until it is met itself.
"""

from __future__ import annotations

import math

from watchsim.contact.index_sets import OPEN
from watchsim.contact.kinematics import contact_kinematics
from watchsim.dynamics.delassus import fill_delassus
from watchsim.jit import kernel
from watchsim.tolerances import DEPENDENT_IN_STEPS, HIDDEN_REBOUND


@kernel
def drop_later(model, state, m, options, work, event):
    """Leave out those of the m contacts in `event.closed` that are apart and behind a parallel one; returns how many are left.

    `work` holds the inverse masses.
    """
    closed, least = event.closed, HIDDEN_REBOUND * options.gap_zero
    waiting = False
    for i in range(m):
        waiting = waiting or _may_wait(state, closed, i, least)
    if not waiting or m < 2:
        return m
    fill_delassus(closed, m, work)
    for i in range(m):
        work.rhs[i] = closed.kin[i].g
    kept = 0
    for i in range(m):
        if _may_wait(state, closed, i, least) and _is_behind(m, i, least, work):
            continue
        if kept < i:
            contact_kinematics(model, closed.ids[i], event.pose, kept, closed)
        kept += 1
    return kept


@kernel
def _may_wait(state, closed, i, least):
    """True if row i is neither in force nor has it just touched, and its gap is more than `least` (m)."""
    k = closed.ids[i]
    return state.mode[k] == OPEN and k != state.now.touched and closed.kin[i].g > least


@kernel
def _is_behind(m, i, least, work):
    """True if closing a row that moves the bodies alike leaves row i open by more than `least`; gaps (m) are in `work.rhs`."""
    own = work.G[2 * i, 2 * i]
    for j in range(m):
        both, other = work.G[2 * i, 2 * j], work.G[2 * j, 2 * j]
        is_parallel = j != i and both > 0.0 and both * both >= (1.0 - DEPENDENT_IN_STEPS) * own * other
        if is_parallel and work.rhs[i] - work.rhs[j] * math.sqrt(own / other) > least:
            return True
    return False
