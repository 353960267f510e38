"""What is written down while the loop runs?"""

from __future__ import annotations

from watchsim.contact.index_sets import OPEN, STICK
from watchsim.jit import kernel
from watchsim.simulation.event_kinds import EventKind


@kernel
def is_kept(record, t, length):
    """True if rows within `length` seconds after t lie in one of the windows."""
    for j in range(len(record.windows)):
        if record.windows[j, 0] <= t + length and t <= record.windows[j, 1]:
            return True
    return False


@kernel
def keep_row(state, record, t, q, u, a):
    """Append a row unless t lies outside all windows."""
    if not is_kept(record, t, 0.0):
        return
    row = record.used.rows
    n = len(q)
    record.rows[row, 0] = t
    for i in range(n):
        record.rows[row, 1 + i] = q[i]
        record.rows[row, 1 + n + i] = u[i]
        record.rows[row, 1 + 2 * n + i] = a[i]
    record.used.rows = row + 1


@kernel
def keep_event(state, record, kind, contact, body, value):
    """Append an event at the current time and return its row."""
    row = record.used.events
    event = record.events[row]
    event.t, event.kind, event.contact, event.body, event.value = state.clock.time, kind, contact, body, value
    event.impulse_normal, event.impulse_tangential, event.energy_lost = 0.0, 0.0, 0.0
    record.used.events = row + 1
    state.counts.events += 1
    return row


@kernel
def keep_change(state, record, k, old):
    """Write down how contact k's mode changed."""
    new = state.mode[k]
    if new == old:
        return
    if old == OPEN:
        keep_event(state, record, EventKind.CLOSE, k, -1, float(new))
    elif new == OPEN:
        keep_event(state, record, EventKind.OPEN, k, -1, 0.0)
    elif new == STICK:
        keep_event(state, record, EventKind.STICK, k, -1, 0.0)
    else:
        keep_event(state, record, EventKind.SLIDE, k, -1, float(new))
