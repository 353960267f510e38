"""Which contacts cannot hold with the forces that their modes ask for?

The complementarity problem decides by accelerations, what ends a mode by forces. Where a force moves its own contact by next
to nothing, or where several contacts share it, the two may differ: a mode would end as soon as it began, and begin again.
"""

from __future__ import annotations

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.dynamics.acceleration import solve_mode
from watchsim.jit import kernel
from watchsim.simulation.events.closed_contacts import refresh
from watchsim.simulation.motion.coupled_motion import grip_left, press_left
from watchsim.simulation.record.write_buffers import keep_change
from watchsim.tolerances import BEGIN_SLACK, FORCE_NOISE


@kernel
def _weakest(model, state, m, options, work, rest):
    """(does any not hold? row of the contact that is furthest from holding, does it pull?)."""
    zero = BEGIN_SLACK * state.now.lenience * options.force_zero
    worst, found, row, pulls, largest = 0.0, False, 0, False, 0.0
    for i in range(m):
        largest = max(largest, work.force[2 * i])
    for i in range(m):
        left = press_left(work, i, zero) - FORCE_NOISE * largest
        if left <= worst:
            worst, found, row, pulls = left, True, i, True
        friction = model.laws[model.contacts[rest.ids[i]].group].friction
        if friction > 0.0 and state.mode[rest.ids[i]] == STICK:
            left = grip_left(friction, work, i, zero)
            if left <= worst:
                worst, found, row, pulls = left, True, i, False
    return found, row, pulls


@kernel
def let_go(model, state, m, options, work, event, record):
    """Forces of the m contacts in `event.rest`, without those that would pull; those that cannot stick slide.

    The forces are left in `work`. Returns (number of contacts in force, are their forces unique?).
    """
    rest = event.rest
    unique = solve_mode(model, rest, m, state.mode, state.now.lenience, work)
    for _ in range(2 * m):
        found, i, pulls = _weakest(model, state, m, options, work, rest)
        if not found:
            break
        k = rest.ids[i]
        old = state.mode[k]
        if pulls:
            state.mode[k] = OPEN
            m -= 1
            for j in range(i, m):
                rest.ids[j] = rest.ids[j + 1]
            refresh(model, m, rest, event.pose)
        else:
            state.mode[k] = FORWARD if work.force[2 * i + 1] < 0.0 else BACKWARD
        keep_change(state, record, k, old)
        unique = solve_mode(model, rest, m, state.mode, state.now.lenience, work)
    return m, unique
