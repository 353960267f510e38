"""At which instants could two layers overlap by more than a depth? The compiled sieve before the polygons.

One layer is shrunk by that depth. The other one passes where its outline stays away from the shrunk one by half the depth and
does not lie wholly within, nor the other way round. What merely touches passes; what does not pass is for the polygons to judge
(overlap_instants.py). Nothing here is shared with the gap functions of contacts: chords against chords, circles around
stretches of them first.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import entry, kernel
from watchsim.simulation.trajectory import place_between

# At which instants of a run are the outlines compared?
#
# A contact that is lost shows in a long way without an event: chosen are the longest moves between two recorded rows, and some
# of the first ones. Within a move there are several instants, by its length.

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

BLOCK = 32768  # rows, of which the longest moves of each coordinate are looked at. Large: less is seen; small: costs time
EVERY = 2  # of the blocks: one in so many. Large, small: as above
FEW = 8  # coordinates whose longest moves are looked at in one block; of more, others in the next
STRIDE = 0.1  # of the scene's size: moves between two rows are looked at in such steps
MOST_STEPS = 7  # in one move
EARLY = (0, 1, 4, 16, 64, 256, 1024)  # rows looked at in any case


class Instants(NamedTuple):
    """Times (s), coordinates of the model (instants, n), and how many instants each move has, with those before it."""

    times: Array
    q: Array
    ends: Integers


@entry
def longest_moves(rows, start, stop, columns, out_way, out_row):
    """For each of some columns the row in start … stop - 1 from which it is furthest to the next one, and how far."""
    out_way[:], out_row[:] = 0.0, start
    for row in range(start, stop):  # once through the rows: they come from memory
        for i in range(len(columns)):
            way = abs(rows[row + 1, columns[i]] - rows[row, columns[i]])
            if way > out_way[i]:
                out_way[i], out_row[i] = way, row


def chosen_moves(rows: Array, n: int, first: int) -> NDArray[np.int64]:
    """Between which rows to look: places of the rows before. n coordinates; `first` rows of the run came before these.

    Of each block of rows the longest moves of the coordinates, and some of the first rows, since what is lost at the start may
    be over soon after.
    """
    chosen: list[int] = []
    for start in range(0, len(rows) - 1, BLOCK):
        number = (first + start) // BLOCK
        if number % EVERY:
            continue
        columns = np.arange(1, 1 + n) if n <= FEW else 1 + (number // EVERY * FEW + np.arange(FEW)) % n
        longest = np.zeros(len(columns), np.int64)
        longest_moves(rows, start, min(start + BLOCK, len(rows) - 1), columns, np.zeros(len(columns)), longest)
        chosen += longest.tolist()
    chosen += [number - first for number in EARLY if first <= number < first + len(rows) - 1]
    places = np.array(sorted(set(chosen)), np.int64)
    return places[rows[places + 1, 0] > rows[places, 0]]


def instants_within(before: Array, after: Array, scale: Array, stepped: bool) -> Instants:
    """Instants within the moves from rows (t, q, u, a) `before` to rows `after`; where time is stepped the latter alone.

    `scale`: for each coordinate what moves a point by the scene's size: 1 rad, or that size (m).
    """
    n = len(scale)
    if stepped or not len(before):
        return Instants(after[:, 0], after[:, 1 : 1 + n], np.arange(len(after) + 1))
    way = np.abs(after[:, 1 : 1 + n] - before[:, 1 : 1 + n]) / scale
    steps = np.minimum(np.maximum(np.ceil(way.max(axis=1) / STRIDE), 1), MOST_STEPS).astype(np.int64)
    ends = np.zeros(len(steps) + 1, np.int64)
    np.cumsum(steps, out=ends[1:])
    move = np.repeat(np.arange(len(steps)), steps)
    share = ((np.arange(len(move)) - ends[move] + 1.0) / (steps[move] + 1.0))[:, None]
    first, last = before[move], after[move]
    h = last[:, :1] - first[:, :1]
    left, right = ((at[:, 1 : 1 + n], at[:, 1 + n : 1 + 2 * n], at[:, 1 + 2 * n :]) for at in (first, last))
    return Instants(first[:, 0] + share[:, 0] * h[:, 0], place_between(share, h, left, right), ends)


STRETCH = np.dtype(
    [
        ("x", "f8"),  # of a circle around some chords, m
        ("y", "f8"),
        ("radius", "f8"),
        ("half", "f8"),  # m, half of its longest chord
        ("first", "i8"),  # the chords join points first … last
        ("last", "i8"),
        ("begins", "i8"),  # 1 if the first point begins an outer ring
    ]
)
PAIR = np.dtype(
    [
        ("still", "i8"),  # body whose shrunk outline stays where it is
        ("mover", "i8"),  # body whose outline is brought to it
        ("still_x", "f8"),  # centre of a circle around everything, m
        ("still_y", "f8"),
        ("mover_x", "f8"),
        ("mover_y", "f8"),
        ("still_radius", "f8"),
        ("mover_radius", "f8"),
        ("still_first", "i8"),  # stretches of the shrunk outline
        ("still_stop", "i8"),
        ("mover_first", "i8"),  # stretches of the other one
        ("mover_stop", "i8"),
        ("swallows", "i8"),  # 1 if the mover could hold the other within
        ("open", "i8"),  # 1 if open faces are to be looked at wherever the circles meet
    ]
)


@entry
def sieve(pairs, stretches, points, where, margin, room, out_left):
    """Write True into `out_left` (pairs, instants) where a pair does not pass.

    `where` (bodies, instants, 3): x, y (m), angle (rad); `margin`: how near (m) outlines count; `room`: for a stretch's points.
    """
    for k in range(len(pairs)):
        pair = pairs[k]
        before_x, before_y, before_c, before_s, was_left = math.nan, 0.0, 0.0, 0.0, False
        for i in range(where.shape[1]):
            still, mover = where[pair.still, i], where[pair.mover, i]
            # The mover's frame in the other one's.
            back_c, back_s = math.cos(still[2]), -math.sin(still[2])
            x, y = _turned(mover[0] - still[0], mover[1] - still[1], back_c, back_s)
            c, s = _turned(math.cos(mover[2]), math.sin(mover[2]), back_c, back_s)
            # Two bodies that rest on each other are looked at once.
            if not (x == before_x and y == before_y and c == before_c and s == before_s):
                was_left = _is_left(pair, stretches, points, (x, y, c, s), margin, room)
                before_x, before_y, before_c, before_s = x, y, c, s
            out_left[k, i] = was_left


@kernel
def _turned(x, y, c, s):
    return c * x - s * y, s * x + c * y


@kernel
def _moved(px, py, frame):
    """A point of a frame that stands at x, y with the cosine and sine of its angle."""
    x, y, c, s = frame
    return c * px - s * py + x, s * px + c * py + y


@kernel
def _is_left(pair, stretches, points, frame, margin, room):
    """True if the pair does not pass where the mover's `frame` (x, y, cosine, sine) stands so."""
    x, y, c, s = frame
    mx, my = _moved(pair.mover_x, pair.mover_y, frame)
    if math.hypot(mx - pair.still_x, my - pair.still_y) > pair.still_radius + pair.mover_radius + margin:
        return False
    if pair.open == 1:
        return True
    for m in range(pair.mover_first, pair.mover_stop):
        if _comes_near(stretches[m], pair, stretches, points, frame, margin, room):
            return True
    for m in range(pair.mover_first, pair.mover_stop):
        if stretches[m].begins == 1:
            px, py = _moved(points[stretches[m].first, 0], points[stretches[m].first, 1], frame)
            near = _is_within(px - pair.still_x, py - pair.still_y, pair.still_radius)
            if near and _winding(px, py, pair.still_first, pair.still_stop, stretches, points) != 0:
                return True
    if pair.swallows == 1:
        for m in range(pair.still_first, pair.still_stop):
            if stretches[m].begins == 1:
                px, py = _turned(points[stretches[m].first, 0] - x, points[stretches[m].first, 1] - y, c, -s)
                near = _is_within(px - pair.mover_x, py - pair.mover_y, pair.mover_radius)
                if near and _winding(px, py, pair.mover_first, pair.mover_stop, stretches, points) != 0:
                    return True
    return False


@kernel
def _is_within(x, y, radius):
    """True for a way x, y no longer than a radius."""
    return x * x + y * y <= radius * radius


@kernel
def _comes_near(moved, pair, stretches, points, frame, margin, room):
    """Does a stretch of the mover come within `margin` of the other outline?"""
    mx, my = _moved(moved.x, moved.y, frame)
    if not _is_within(mx - pair.still_x, my - pair.still_y, pair.still_radius + moved.radius + margin):
        return False  # as most of a large mover
    is_placed = False
    for k in range(pair.still_first, pair.still_stop):
        other = stretches[k]
        dx, dy, reach = mx - other.x, my - other.y, moved.radius + other.radius + margin
        if dx * dx + dy * dy > reach * reach:
            continue
        if not is_placed:
            is_placed = True
            for j in range(moved.first, moved.last + 1):
                room[j - moved.first, 0], room[j - moved.first, 1] = _moved(points[j, 0], points[j, 1], frame)
        reach = moved.half + other.radius + margin
        for j in range(moved.last - moved.first):
            dx, dy = 0.5 * (room[j, 0] + room[j + 1, 0]) - other.x, 0.5 * (room[j, 1] + room[j + 1, 1]) - other.y
            if dx * dx + dy * dy <= reach * reach and _chord_comes_near(room[j], room[j + 1], other, points, margin):
                return True
    return False


@kernel
def _chord_comes_near(a, b, other, points, margin):
    """Does the chord from a to b come within `margin` of a chord of the stretch?"""
    left, right = min(a[0], b[0]) - margin, max(a[0], b[0]) + margin
    low, high = min(a[1], b[1]) - margin, max(a[1], b[1]) + margin
    for k in range(other.first, other.last):
        p, q = points[k], points[k + 1]
        if (p[0] < left and q[0] < left) or (p[0] > right and q[0] > right):
            continue
        if (p[1] < low and q[1] < low) or (p[1] > high and q[1] > high):
            continue
        if _cross(a, b, p, q) or min(_apart(a, p, q), _apart(b, p, q), _apart(p, a, b), _apart(q, a, b)) < margin:
            return True
    return False


@kernel
def _side(p, a, b):
    """Positive where p lies left of the line from a to b."""
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


@kernel
def _cross(a, b, p, q):
    """True if the chords from a to b and from p to q cross."""
    return (_side(p, a, b) > 0.0) != (_side(q, a, b) > 0.0) and (_side(a, p, q) > 0.0) != (_side(b, p, q) > 0.0)


@kernel
def _apart(p, a, b):
    """The distance of p from the chord from a to b."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared = dx * dx + dy * dy
    share = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / squared if squared > 0.0 else 0.0
    share = min(max(share, 0.0), 1.0)
    return math.hypot(p[0] - a[0] - share * dx, p[1] - a[1] - share * dy)


@kernel
def _winding(x, y, first, stop, stretches, points):
    """How often the rings of some stretches go round a point: not 0 within material, holes running the other way round."""
    turns = 0
    for k in range(first, stop):
        other = stretches[k]
        if abs(y - other.y) > other.radius or x > other.x + other.radius:
            continue
        for j in range(other.first, other.last):
            p, q = points[j], points[j + 1]
            if (p[1] <= y) == (q[1] <= y):
                continue
            # A chord that crosses the height of the point counts where it lies to the right.
            side = (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])
            if q[1] > p[1] and side > 0.0:
                turns += 1
            elif q[1] <= p[1] and side < 0.0:
                turns -= 1
    return turns
