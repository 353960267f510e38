"""When do impacts that alternate between contacts come to their end?

A block that rocks from corner to corner, or a disc between two flanks, makes infinitely many impacts in a finite time, also
without restitution: no single contact rebounds, so the rule for rebounds (collide.py) does not see it. Where many impacts in
a row follow each other within `accumulation_time`, all slow, what is left of the motion off the contacts is about the
acceleration times that time squared, some picometres: it is taken away.
"""

from __future__ import annotations

from watchsim.contact.index_sets import OPEN
from watchsim.contact.poses import place
from watchsim.jit import kernel
from watchsim.simulation.closed import refresh
from watchsim.simulation.collide import ACCUMULATION_EVENT, kinetic_energy
from watchsim.simulation.drift import project_velocities
from watchsim.simulation.keep import keep_event
from watchsim.simulation.state import IMPACTS, N_ACCUMULATED

IN_A_ROW = 20  # impacts that have nothing to do with each other do not come so close so often


@kernel
def is_chatter(state, m, options, closed):
    """Count an impact that is about to happen; True if it is one of many in a row, and all contacts are slow."""
    soon = state.clock[0] - state.clock[2] < options.accumulation_time
    state.numbers[5] = state.numbers[5] + 1 if soon else 0
    for i in range(m):
        if abs(closed.kin[i].gN_dot) > options.accumulation_speed:
            return False
    return state.numbers[5] >= IN_A_ROW


@kernel
def end_chatter(model, state, m, scratch, record):
    """Bring the gap rates of the m closed contacts to zero by the smallest change of velocities; energy goes to the impacts."""
    closed, work = scratch.closed, scratch.work
    before = kinetic_energy(model, state.u)
    for i in range(m):
        scratch.trial[closed.ids[i]] = OPEN
        if closed.kin[i].gN_dot < 0.0:
            keep_event(state, record, ACCUMULATION_EVENT, closed.ids[i], -1, state.clock[0])
            state.counts[N_ACCUMULATED] += 1
    for j in range(len(model.coordinates)):
        work.inverse[j] = 1.0 / model.coordinates[j].mass
    project_velocities(closed, m, scratch.trial, work, state.u)
    state.sums[IMPACTS] += before - kinetic_energy(model, state.u)
    state.numbers[5] = 0
    place(model, state.q, state.u, scratch.pose)
    refresh(model, m, closed, scratch.pose)
