"""How long is the first step in a mode?

The step before was made under other forces: tried with its length, three of ten steps of a lever are rejected. But a mechanism
meets its modes again at every beat. So the length that the errors of a first step allowed is remembered, and tried when the
same mode follows on the same one; whether the step is good is judged as that of any other.
"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.simulation.events.mode_recurrence import BASE, MODULUS
from watchsim.simulation.motion.free_flight import can_fly

NO_MODE = -1  # in the place of a mode's: the next step is no first one
LONGER = 1.05  # from one time to the next at most. Large: steps are rejected where visits differ; small: short ones stay


@kernel
def _key(model, state):
    """A number for the contacts of awake bodies and the grips: alike for all teeth of a wheel."""
    key = 1
    for j in range(state.now.awake_contacts):
        contact = model.contacts[state.active[j]]
        a, b = model.primitives[contact.a], model.primitives[contact.b]
        kinds = 9 * int(contact.group) + 3 * int(a.kind) + int(b.kind)
        key = (key * BASE + 4 * kinds + int(state.mode[state.active[j]]) + 1) % MODULUS
    for i in range(len(state.grip)):
        key = (key * BASE + int(state.grip[i]) + 1) % MODULUS
    return key


@kernel
def begin_mode(model, state):
    """The modes have been decided: propose a length for the first step, where it is known."""
    first = state.first
    if can_fly(model, state):
        first.begun = NO_MODE
        return
    mode = _key(model, state)
    key = (first.before * BASE + mode) % MODULUS + 1
    first.before, first.begun = mode, key % len(first.keys)
    if first.keys[first.begun] != key:
        first.keys[first.begun], first.lengths[first.begun] = key, 0.0
    if first.lengths[first.begun] > 0.0:
        state.clock.step = first.lengths[first.begun]


@kernel
def note_first_step(state, allowed):
    """A coupled step has been made whose errors allow that length (s); remembered where it was the first one in its mode."""
    first = state.first
    if first.begun != NO_MODE:
        known = first.lengths[first.begun]
        first.lengths[first.begun] = min(allowed, LONGER * known) if known > 0.0 else allowed
        first.begun = NO_MODE
