"""When do impacts that alternate between contacts come to their end?

A block that rocks from corner to corner, or a disc between two flanks, makes infinitely many impacts in a finite time, also
without restitution: no single contact rebounds, so the rule for rebounds (collide.py) does not see it. A contact that the
others' impulses lift by less than `gap_close`, the distance at which contacts count as closed, is not lifted at all.
"""

from __future__ import annotations

from watchsim.contact.index_sets import OPEN, STICK
from watchsim.contact.poses import place
from watchsim.jit import kernel
from watchsim.simulation.drift import project_velocities


@kernel
def may_be_chatter(m, options, scratch):
    """True if after an impact some contact is slowly leaving, and none of those that were hit keeps all its energy."""
    found = False
    for i in range(m):
        rate = scratch.closed.kin[i].gN_dot
        if rate > options.accumulation_speed:
            return False
        hit = scratch.impulse[2 * i] > 0.0
        if hit and scratch.restitution[i] == 1.0:
            return False
        # Where only contacts leave that rebound, their own rule knows when that would end.
        if rate > options.speed_zero and not (hit and scratch.restitution[i] > 0.0):
            found = True
    return found


@kernel
def return_time(closed, i, a):
    """Time after which contact i, leaving at its rate under the accelerations a, is closed again; -1 if it is not, s."""
    closing = -closed.kin[i].bar_N
    for k in range(closed.slots[i]):
        closing -= closed.w_N[i, k] * a[closed.coord[i, k]]
    return 2.0 * closed.kin[i].gN_dot / closing if closing > 0.0 else -1.0


@kernel
def is_chatter(state, m, options, closed):
    """True if no contact that leaves comes further than `gap_close` before it is back; accelerations are in `state.a`."""
    for i in range(m):
        rate = closed.kin[i].gN_dot
        if rate <= options.speed_zero:
            continue
        back = return_time(closed, i, state.a)
        # It rises on a parabola, to a quarter of the way it would go at its first speed.
        if back < 0.0 or 0.25 * rate * back > options.gap_close:
            return False
    return True


@kernel
def stand_still(model, state, closed, m, options, scratch):
    """Zero the gap rates of m contacts, and the slip of those that hold, by the smallest change of velocities.

    It only takes energy. A block that stopped turning but went on sliding would be tipped over by its friction, and rock anew.
    """
    for i in range(m):
        k = closed.ids[i]
        holds = model.laws[model.contacts[k].group].friction > 0.0 and abs(closed.kin[i].gT_dot) <= options.speed_zero
        scratch.trial[k] = STICK if holds else OPEN
    for j in range(len(model.coordinates)):
        scratch.work.inverse[j] = 1.0 / model.coordinates[j].mass
    project_velocities(closed, m, scratch.trial, scratch.work, state.u)
    place(model, state.q, state.u, scratch.pose)
