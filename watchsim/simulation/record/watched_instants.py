"""At which instants of a run are the outlines compared?

A contact that is lost shows in a long way without an event: chosen are the longest moves between two recorded rows, and some of
the first ones. Within a move there are several instants, by its length.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import entry
from watchsim.simulation.record.trajectory import place_between

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
