"""Which way round are the directions of friction taken, so that a mechanism and its mirror image have the same problem?

The complementarity form of friction treats the two ends of the cone differently (coulomb.py). Where friction leaves more than
one solution, Lemke's method ends in another one when a direction is reversed: the mechanism in a mirror would move otherwise.
So each direction is reversed, for the time of the solution, such that what the contact does without friction is positive: its
slip (rate or acceleration), or, if that is zero, what a normal force does to it. Both change sign with the direction, and
neither depends on where the drawing came from.
"""

from __future__ import annotations

from watchsim.dynamics.coulomb import element_row
from watchsim.jit import kernel
from watchsim.tolerances import NO_HAND


@kernel
def reverse_directions(work, m, rows, elements, slip):
    """Reverse G and `slip` in the rows of elements whose slip without friction is negative.

    What was reversed is noted in `work.hand` (-1), for `restore_directions`.
    """
    largest = 0.0
    for e in range(elements):
        row = element_row(work, m, e)
        largest = max(largest, _share(work, row, slip))
    for row in range(rows):
        work.hand[row] = 1.0
    for e in range(elements):
        row, block = element_row(work, m, e), work.block[e]
        direction = slip[row]
        if _share(work, row, slip) <= NO_HAND * NO_HAND * largest and block < m:
            direction = work.G[row, 2 * block]
        if direction < 0.0:
            work.hand[row] = -1.0
    _turn(work, rows, slip)


@kernel
def restore_directions(work, rows, slip):
    """Undo `reverse_directions` in G, `slip` and the forces found."""
    _turn(work, rows, slip)
    for row in range(rows):
        work.force[row] *= work.hand[row]


@kernel
def _share(work, row, slip):
    """What the row alone would cost to stop: the same in all units, and in a mirror."""
    return slip[row] * slip[row] / work.G[row, row] if work.G[row, row] > 0.0 else 0.0


@kernel
def _turn(work, rows, slip):
    for row in range(rows):
        if work.hand[row] < 0.0:
            slip[row] = -slip[row]
            for column in range(rows):
                work.G[row, column], work.G[column, row] = -work.G[row, column], -work.G[column, row]
            work.G[row, row] = -work.G[row, row]
