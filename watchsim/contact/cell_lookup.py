"""Which contacts are candidates here? Looked up, never computed: the compiled side of the cells."""

from __future__ import annotations

import math

from watchsim.jit import entry, kernel
from watchsim.model import FREE, NO_KEY, SLIDE

UNKNOWN, LISTED, ALL = -1, 0, 1
MARGIN = 0.5  # a cell's answer holds this share of its size beyond its faces
# Of their reach: bodies that are this much further apart need no cells, or, where they have none, no look at their contacts.
APART, APART_WITHOUT_CELLS = 0.25, 1e-3
STRIDE_WITHOUT_CELLS = 0.25  # of their reach: bodies that pass each other are examined again when they have moved so far
FEW_CONTACTS = 24  # with no more reachable pairs of primitives than this, a search costs more than it saves
REACH = 1 << 16  # cell indices beyond it fall back to all that can touch


@kernel
def cell_index(q, size, wrap):
    """Index of the cell that holds q."""
    index = math.floor(q / size)
    return int(index % wrap) if wrap > 0 else int(index)


@kernel
def along(value, coordinate, on):
    """The value of a cell coordinate from those of all coordinates; `on` is taken away from it, -1: nothing."""
    return value[coordinate] - value[on] if on >= 0 else value[coordinate]


@entry
def cell_key(model, p, q):
    """The key of body pair p's cell at coordinates q; NO_KEY where the indices leave the range of keys."""
    pair = model.pairs[p]
    x0, x1, x2 = q[pair.c0], q[pair.c1], q[pair.c2]
    if pair.frame >= 0:
        x0, x1 = along(q, pair.c0, pair.on0), along(q, pair.c1, pair.on1)
    i0 = cell_index(x0, pair.size0, pair.wrap0)
    i1 = cell_index(x1, pair.size1, pair.wrap1) if pair.axes > 1 else 0
    i2 = cell_index(x2, pair.size2, pair.wrap2) if pair.axes > 2 else 0
    if abs(i0) >= REACH or abs(i1) >= REACH or abs(i2) >= REACH:
        return NO_KEY
    return (((p * 2 * REACH + (i0 + REACH)) * 2 * REACH) + (i1 + REACH)) * 2 * REACH + (i2 + REACH)


@entry
def find_slot(keys, key):
    """Slot of `key`, or of the free place where it belongs."""
    slots = len(keys)
    # Neighbouring cells differ in one index: spread the three indices by primes. The table's length is a power of two.
    mixed = (key >> 34) * 7919 + ((key >> 17) & (2 * REACH - 1)) * 104729 + (key & (2 * REACH - 1)) * 31
    slot = (mixed ^ (mixed >> 15)) & (slots - 1)
    while keys[slot] != key and keys[slot] != NO_KEY:
        slot = (slot + 1) & (slots - 1)
    return slot


@entry
def insert_cells(keys, start, count, new_keys, new_start, new_count):
    """Put new cells into the table (keys, start, count), which must have room; returns how many were not there before."""
    added = 0
    for i in range(len(new_keys)):
        slot = find_slot(keys, new_keys[i])
        if keys[slot] == NO_KEY:
            added += 1
            keys[slot] = new_keys[i]
            start[slot], count[slot] = new_start[i], new_count[i]
    return added


@kernel
def _origin(body, q):
    """Where the origin of a body is that nothing carries."""
    if body.motion == FREE:
        return q[body.first], q[body.first + 1]
    way = body.ratio * q[body.first] + body.phase if body.motion == SLIDE else 0.0
    return body.x + way * body.axis_x, body.y + way * body.axis_y


@kernel
def _between(model, pair, q):
    """How far the bodies of a pair, whose `reach` is known, at least are from a touch, m; negative where they may touch."""
    ax, ay = _origin(model.bodies[pair.a], q)
    bx, by = _origin(model.bodies[pair.b], q)
    return math.sqrt((ax - bx) ** 2 + (ay - by) ** 2) - pair.reach


@kernel
def _is_apart(model, pair, q):
    """True if the bodies of a pair have flown so far apart that nothing of them is near."""
    return pair.reach > 0.0 and _between(model, pair, q) > (APART if pair.listed else APART_WITHOUT_CELLS) * pair.reach


@kernel
def _velocity(body, rate):
    """How the origin of a body moves, from the rates (or second derivatives) of the coordinates."""
    if body.motion == FREE:
        return rate[body.first], rate[body.first + 1]
    way = body.ratio * rate[body.first] if body.motion == SLIDE else 0.0
    return way * body.axis_x, way * body.axis_y


@kernel
def _time_to_move(model, pair, room, u, acceleration):
    """A time during which the origins of two bodies do not move by `room` against each other."""
    a, b = model.bodies[pair.a], model.bodies[pair.b]
    (ax, ay), (bx, by) = _velocity(a, u), _velocity(b, u)
    bound = math.hypot(*_velocity(a, acceleration)) + math.hypot(*_velocity(b, acceleration))
    return _time_to_leave(room, math.hypot(ax - bx, ay - by), bound)


@kernel
def candidates(model, cells, p, q):
    """Candidates of body pair p at q: (UNKNOWN | LISTED | ALL, start, count)."""
    pair = model.pairs[p]
    if _is_apart(model, pair, q):
        return ALL, 0, 0
    if pair.listed:
        key = cell_key(model, p, q)
        if key != NO_KEY:
            slot = find_slot(cells.keys, key)
            if cells.keys[slot] == NO_KEY:
                return UNKNOWN, 0, 0
            return LISTED, cells.start[slot], cells.count[slot]
    return ALL, pair.near_start, pair.near_stop - pair.near_start


@kernel
def candidate(model, cells, how, place):
    """The contact at a place of a candidate list."""
    return cells.entries[place] if how == LISTED else model.near[place]


@kernel
def _room(q, size):
    """How far q may move either way before the cell's answer ends."""
    low = math.floor(q / size) * size
    return min(q - low, low + size - q) + MARGIN * size


@kernel
def _time_to_leave(room, speed, acceleration):
    """Time in which no motion with these bounds covers `room`."""
    if speed == 0.0 and acceleration == 0.0:
        return math.inf
    return 2.0 * room / (speed + math.sqrt(speed * speed + 2.0 * acceleration * room))


@kernel
def time_in_cell(model, p, q, u, acceleration):
    """A time during which body pair p's candidates at q stay complete; acceleration bounds are per coordinate."""
    pair = model.pairs[p]
    if _is_apart(model, pair, q):
        return _time_to_move(model, pair, _between(model, pair, q), u, acceleration)
    if pair.axes == 0:
        if pair.reach == 0.0 or pair.near_stop - pair.near_start <= FEW_CONTACTS:
            return math.inf
        return _time_to_move(model, pair, STRIDE_WITHOUT_CELLS * pair.reach, u, acceleration)
    if pair.frame >= 0:
        return _time_in_relative_cell(pair, q, u, acceleration)
    i = pair.c0
    time = _time_to_leave(_room(q[i], pair.size0), abs(u[i]), acceleration[i])
    if pair.axes > 1:
        i = pair.c1
        time = min(time, _time_to_leave(_room(q[i], pair.size1), abs(u[i]), acceleration[i]))
    if pair.axes > 2:
        i = pair.c2
        time = min(time, _time_to_leave(_room(q[i], pair.size2), abs(u[i]), acceleration[i]))
    return time


@kernel
def _time_in_relative_cell(pair, q, u, acceleration):
    """The same seen from a carrier, on which at most two angles count."""
    time = math.inf
    for axis in range(pair.axes):
        i, on, size = (pair.c0, pair.on0, pair.size0) if axis == 0 else (pair.c1, pair.on1, pair.size1)
        bound = acceleration[i] + (acceleration[on] if on >= 0 else 0.0)
        time = min(time, _time_to_leave(_room(along(q, i, on), size), abs(along(u, i, on)), bound))
    return time


@kernel
def time_through_cells(model, p, q, u, acceleration, cells):
    """A time in which body pair p passes at most about `cells` cells along each coordinate."""
    pair, time = model.pairs[p], math.inf
    if pair.axes == 0:
        return time
    if _is_apart(model, pair, q):
        return _time_to_move(model, pair, _between(model, pair, q), u, acceleration)
    if pair.axes > 0:
        time = min(time, _time_through(pair, u, acceleration, pair.c0, pair.on0, cells * pair.size0))
    if pair.axes > 1:
        time = min(time, _time_through(pair, u, acceleration, pair.c1, pair.on1, cells * pair.size1))
    if pair.axes > 2:
        time = min(time, _time_through(pair, u, acceleration, pair.c2, pair.on2, cells * pair.size2))
    return time


@kernel
def _time_through(pair, u, acceleration, i, on, way):
    """Time in which one cell coordinate does not cover that way."""
    if pair.frame >= 0 and on >= 0:
        return _time_to_leave(way, abs(u[i] - u[on]), acceleration[i] + acceleration[on])
    return _time_to_leave(way, abs(u[i]), acceleration[i])
