"""When does the wheel push an anchor that swings as one with the oscillator, when does it let go, when does it lock?

Such a beat has no unlocking of its own: the tooth slides from the locking face onto the impulse face (dead-beat), or turns
back with the wheel until the anchor returns (recoil).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.record.trajectory import Array

STANDING = 1e-6  # of the wheel's advance in a beat: it has not moved


class Marks(NamedTuple):
    """Of one half swing, s: the impulse begins, the tooth is let off, another one is locked."""

    pushed: float
    let_off: float
    lock: float


def anchor_marks(
    times: Array, held: NDArray[np.int32], at_events: Array, rows: Array, at_rows: Array, start: float, end: float
) -> Marks | None:
    """The marks of the half swing from `start` to `end` (s); None where the wheel does not drop in it.

    times, held, at_events  contact events of the wheel (n,): s, how many contacts hold after each, its progress (rad)
    rows, at_rows           times at which the motion was recorded (m,), s, and the wheel's progress then (rad)
    """
    first, last = np.searchsorted(times, (start, end))
    own = slice(max(int(first) - 1, 0), int(last))
    free = (held[own][:-1] == 0) & (np.diff(times[own]) > 0.0)
    if not free.any():
        return None
    drop = int(np.argmax(np.where(free, np.diff(at_events[own]), -np.inf)))
    let_off, lock = times[own][drop : drop + 2].tolist()
    i, j = np.searchsorted(rows, (start, let_off))
    if j <= i or let_off < start:
        return None
    before = at_rows[i : j + 1]
    way = float(at_events[own][drop + 1] - before.min())
    if not way > 0.0:
        return None
    standing = np.flatnonzero(before <= before.min() + STANDING * way)
    return Marks(float(rows[i + standing[-1]]), let_off, lock)
