"""What can happen between two smooth steps, and what is kept of it?"""

from __future__ import annotations

from enum import IntEnum

import numpy as np


class EventKind(IntEnum):
    """What happened. IMPACT..ACCUMULATION and JAM name a contact pair; TURN and CROSS name a body with a spring."""

    IMPACT = 1  # approach ended by impulses; impulses and energy lost are given
    CLOSE = 2  # the contact now rests (its normal force acts)
    OPEN = 3  # the contact lets go
    STICK = 4  # sliding ended
    SLIDE = 5  # sliding began; `value` is the direction, +1 or -1
    HANDOVER = 6  # a contact in force passed from its primitives, contact number `value`, to their neighbours: `contact`
    ACCUMULATION = 7  # a sequence of rebounds was finished by rule; `value` is the time at which it would have ended
    TURN = 8  # a turning point of a sprung body; `value` is its coordinate
    CROSS = 9  # a sprung body passes its rest position; `value` is its velocity
    JAM = 10  # a sliding contact that no finite force could hold apart was stopped by impulses (Painlevé); `value` is its slip


EVENT_DTYPE = np.dtype(
    [
        ("t", "f8"),
        ("kind", "i4"),
        ("contact", "i4"),  # row of `Trajectory.pairs`, -1 for TURN and CROSS
        ("body", "i4"),  # index in scene.bodies for TURN and CROSS, else -1
        ("impulse_normal", "f8"),  # N·s (between pivoted bodies too: at the contact point)
        ("impulse_tangential", "f8"),
        ("energy_lost", "f8"),  # J
        ("value", "f8"),
    ]
)
