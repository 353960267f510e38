"""Has this set of modes been decided at this instant before?

Decisions are made from accelerations, modes end by forces, slips and ways, and where all of these are rounding the two can
contradict each other for ever. So no set of modes is decided twice at one instant on the same terms: at the second time what
counts as zero for forces and slips is made ten times larger, until time has gone on. There are finitely many sets of modes and
finitely many such terms, so that every instant comes to an end (docs/theory/method.md 3.5).
"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.tolerances import LENIENCE_STEP, MOST_LENIENT

BASE, MODULUS = 1000003, 2147483647


@kernel
def begin_instant(state):
    """Forget what was decided before."""
    state.now.decisions, state.now.lenience = 0, 1.0


@kernel
def forget_decisions(state):
    """After an impact the same modes may be decided again: the velocities are others."""
    state.now.decisions = 0


@kernel
def key_of_modes(state):
    """A number for the modes of all contacts in force and the grips of all bearings."""
    key = 1
    for j in range(state.now.awake_contacts + state.now.sleeping_contacts):
        k = state.active[j]
        key = (key * BASE + 4 * int(k) + int(state.mode[k]) + 1) % MODULUS
    for i in range(len(state.grip)):
        key = (key * BASE + int(state.grip[i]) + 1) % MODULUS
    return key


@kernel
def decide_once(state):
    """Note the modes just decided; False if they come back on the most lenient terms there are."""
    key, known = key_of_modes(state), state.now.decisions
    for j in range(known):
        if state.decided[j] == key:
            state.now.decisions = 0
            state.now.lenience *= LENIENCE_STEP
            return state.now.lenience <= MOST_LENIENT
    if known < len(state.decided):
        state.decided[known] = key
        state.now.decisions = known + 1
    return True
