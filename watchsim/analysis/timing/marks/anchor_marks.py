"""When does the wheel push an anchor that swings as one with the oscillator, when does it let go, when does it lock?

Such a beat has no unlocking of its own: the tooth slides from the locking face onto the impulse face (dead-beat), or turns
back with the wheel until the anchor returns (recoil). Only where the tooth comes off its rest before it meets the face that is
pushed, as at the lips of a cylinder or in the notch of a duplex, is there an unlocking, and a catching up after it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.record.trajectory import Array

STANDING = 1e-6  # of the wheel's advance in a beat: it has not moved
NEAR_REST = 0.1  # of the wheel's advance in the beat: a free run that ends so near to rest may be the drop
CATCHES_UP = 0.05  # of it: a shorter free run is a loss of contact amid the impulse


class Marks(NamedTuple):
    """Of one half swing, s: the wheel begins to move, comes off its rest, meets the face that is pushed (these two None where
    it slides from one to the other), the tooth is let off, another one is locked."""

    moved: float
    freed: float | None
    caught: float | None
    let_off: float
    lock: float


def anchor_marks(
    times: Array, held: NDArray[np.int32], at_events: Array, rows: Array, at_rows: Array, start: float, end: float
) -> Marks | None:
    """The marks of the half swing from `start` to `end` (s); None where the wheel does not go on in it.

    times, held, at_events  contact events of the wheel (n,): s, how many contacts hold after each, its progress (rad)
    rows, at_rows           times at which the motion was recorded (m,), s, and the wheel's progress then (rad)
    """
    first, last = np.searchsorted(times, (start, end))
    own = slice(max(int(first) - 1, 0), int(last))
    t, angle = times[own], at_events[own]
    runs = np.where((held[own][:-1] == 0) & (np.diff(t) > 0.0), np.diff(angle), 0.0)
    before, after = np.interp((start, end), rows, at_rows).tolist()
    if not len(runs) or not after - before > NEAR_REST * runs.max():
        return None
    ends_at_rest = angle[1:] >= after - NEAR_REST * (after - before)
    drop = int(np.argmax(np.where(ends_at_rest, runs, 0.0)))
    let_off, lock = t[drop : drop + 2].tolist()
    i, j = np.searchsorted(rows, (start, let_off))
    if j <= i or let_off < start or not runs[drop] > 0.0:
        return None
    when, earlier = np.append(start, rows[i : j + 1]), np.append(before, at_rows[i : j + 1])  # recoils end at it
    way = float(angle[drop + 1] - earlier.min())
    moved = float(when[np.flatnonzero(earlier <= earlier.min() + STANDING * way)[-1]])
    free = np.where(t[:drop] >= moved, runs[:drop], 0.0)
    if not free.max(initial=0.0) > CATCHES_UP * way:
        return Marks(moved, None, None, let_off, lock)
    freed, caught = t[(k := int(np.argmax(free))) : k + 2].tolist()
    return Marks(moved, freed, caught, let_off, lock)
