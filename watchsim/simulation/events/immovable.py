"""Can any motion change the gap of a contact?

Not that of a disc about its own pivot against a bar that slides past it: the normal force has no lever arm on either body, so
that it can neither stop nor be stopped by anything. Such a contact is left out until its lever arms are more than rounding.
"""

from __future__ import annotations

from watchsim.contact.index_sets import OPEN
from watchsim.contact.kinematics import contact_kinematics
from watchsim.dynamics.delassus import inverse_mass
from watchsim.jit import kernel
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.write_buffers import keep_event
from watchsim.tolerances import IMMOVABLE


# sine² of the angle between a face and the motion: drawings are rounded to a nanometre, which over a millimetre is a millionth
@kernel
def is_immovable(model, closed, i):
    """True if the gap of row i of `closed` changes by next to nothing however its bodies move."""
    across, along, _ = _mobilities(model, closed, i)
    return across <= IMMOVABLE * along


@kernel
def has_one_way(model, closed, i, depth):
    """True if faces along which the bodies of row i of `closed` move are immovable, there or where they are sunk in by `depth`.

    They are where the bodies move past each other in one direction only. A circle of reduced radius r that has sunk in meets
    the next face beside its place on the last one where that turns by up to sqrt(2 depth/r), and by so much directions differ.
    """
    across, along, both = _mobilities(model, closed, i)
    reduced = abs(model.contacts[closed.ids[i]].reduced)
    turned = IMMOVABLE + 2.0 * depth / reduced if reduced > 0.0 else IMMOVABLE
    return across * along - both * both <= turned * (across + along) ** 2


@kernel
def _mobilities(model, closed, i):
    """What a force along the normal does along it, a tangential one along its own direction, and either along the other's."""
    across, along, both = 0.0, 0.0, 0.0
    for slot in range(closed.slots[i]):
        inverse = inverse_mass(model.coordinates[closed.coord[i, slot]])
        across += closed.w_N[i, slot] ** 2 * inverse
        along += closed.w_T[i, slot] ** 2 * inverse
        both += closed.w_N[i, slot] * closed.w_T[i, slot] * inverse
    return across, along, both


@kernel
def drop_immovable(model, state, m, event, record):
    """Leave the immovable ones out of the m contacts in `event.closed`; returns how many are left."""
    closed, kept = event.closed, 0
    for i in range(m):
        k = closed.ids[i]
        if is_immovable(model, closed, i):
            if state.mode[k] != OPEN:
                state.mode[k] = OPEN
                keep_event(state, record, EventKind.OPEN, k, -1, 0.0)
            continue
        if kept < i:
            contact_kinematics(model, k, event.pose, kept, closed)
        kept += 1
    return kept
