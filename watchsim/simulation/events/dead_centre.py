"""Does friction lock two bodies where their contact lies on the line of centres?

There w_T is parallel to w_N, so that forces with w_N lambda_N + w_T lambda_T = 0 move nothing, however large they are. Where
they lie within the cone of friction and press, and the bodies' motion would close the gap between them, no finite force
lets the motion go on: just beyond the line of centres an impulse stops both bodies, the larger the nearer it is to that line
(docs/theory/method.md 2.6).
"""

from __future__ import annotations

from watchsim.contact.index_sets import OPEN, STICK
from watchsim.jit import kernel
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.events.impulse_check import kinetic_energy
from watchsim.simulation.record.write_buffers import keep_event
from watchsim.tolerances import DEAD_CENTRE


@kernel
def stop_at_dead_centre(model, state, r, solved, work, event, record):
    """Stop what the r contacts in `event.rest` lock on the line of centres; True if anything.

    There no finite forces let the motion go on. That their problem is `solved`, with modes in `event.decided`, is no sign that
    there are any: two directions that are one to rounding give forces of 10¹⁴ N. `work.G` and `work.inverse` are its own.
    """
    found, rest = False, event.rest
    for i in range(r):
        kin = rest.kin[i]
        if (solved and event.decided[rest.ids[i]] != STICK) or not _locks(model, rest, i, work):
            continue
        # What the forces without effect would have to make up for, which they cannot: sigma·w̄.
        if kin.bar_N - kin.bar_T * work.G[2 * i, 2 * i] / work.G[2 * i, 2 * i + 1] >= 0.0:
            continue
        before = kinetic_energy(model, state.u)
        for k in range(rest.slots[i]):
            state.u[rest.coord[i, k]] = 0.0
        row = keep_event(state, record, EventKind.JAM, rest.ids[i], -1, kin.gT_dot)
        record.events[row].energy_lost = before - kinetic_energy(model, state.u)
        state.sums.impacts += record.events[row].energy_lost
        state.counts.jams += 1
        found = True
    return found


@kernel
def stands_at_dead_centre(model, state, island, r, solved, work, event):
    """Let an island of two bodies that stand, locked on the line of centres by its only contact, hold; True if it is one.

    Forces exist, but the rounding of the lever arms, which are one vector, decides whether the problem for them is `solved`,
    and whether that lets them begin to roll, which the lock forbids either way.
    """
    rest = event.rest
    if r != 1 or (solved and event.decided[rest.ids[0]] == OPEN) or not _locks(model, rest, 0, work):
        return False
    for j in range(len(event.label)):
        other = j != rest.coord[0, 0] and j != rest.coord[0, 1]
        if event.label[j] == island and (other or state.u[j] != 0.0):
            return False
    event.decided[rest.ids[0]] = STICK
    return True


@kernel
def hold_at_dead_centre(model, state, m, work, rest):
    """Take the accelerations from bodies that stand, locked by one of the m contacts in force in `rest`.

    The forces are in `work`.
    """
    for i in range(m):
        if state.mode[rest.ids[i]] != STICK or not work.force[2 * i] > 0.0 or not _locks(model, rest, i, work):
            continue
        one, other = rest.coord[i, 0], rest.coord[i, 1]
        if state.u[one] == 0.0 and state.u[other] == 0.0:
            state.a[one], state.a[other] = 0.0, 0.0


@kernel
def _locks(model, rest, i, work):
    """True if w_T of contact i, between two coordinates, is parallel to w_N, and forces without effect lie within its cone."""
    if rest.slots[i] != 2 or work.inverse[rest.coord[i, 0]] == 0.0 or work.inverse[rest.coord[i, 1]] == 0.0:
        return False
    N, T, both = work.G[2 * i, 2 * i], work.G[2 * i + 1, 2 * i + 1], work.G[2 * i, 2 * i + 1]
    friction = model.laws[model.contacts[rest.ids[i]].group].friction
    return N * T - both * both <= DEAD_CENTRE * N * T and 0.0 < N <= friction * abs(both)
