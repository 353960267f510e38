"""Which of the open contacts that may close in a step could close first?

A binary heap (Williams 1964) by the time up to which each is known to stay open. It is what the search for the time of impact
looks at next: so no contact is searched beyond the first closing by more than one turn of looks.
"""

from __future__ import annotations

from watchsim.jit import kernel


@kernel
def put(waiting, count, contact, pair, times):
    """Add an entry to the heap `waiting[:count]`, `times` being (start, until, stays_open); returns the new count."""
    start, until, stays_open = times
    place = count
    while place > 0 and waiting[(place - 1) // 2].stays_open > stays_open:
        _copy(waiting[(place - 1) // 2], waiting[place])
        place = (place - 1) // 2
    entry = waiting[place]
    entry.contact, entry.pair, entry.start, entry.until, entry.stays_open = contact, pair, start, until, stays_open
    return count + 1


@kernel
def drop_first(waiting, count):
    """Take the first entry, `waiting[0]`, off the heap; returns the new count."""
    last, place = count - 1, 0
    while True:
        child = 2 * place + 1
        if child + 1 < last and waiting[child + 1].stays_open < waiting[child].stays_open:
            child += 1
        if child >= last or waiting[child].stays_open >= waiting[last].stays_open:
            break
        _copy(waiting[child], waiting[place])
        place = child
    _copy(waiting[last], waiting[place])
    return last


@kernel
def _copy(entry, out_entry):
    out_entry.contact, out_entry.pair = entry.contact, entry.pair
    out_entry.start, out_entry.until, out_entry.stays_open = entry.start, entry.until, entry.stays_open
