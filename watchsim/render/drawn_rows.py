"""Which points does a curve of millions need, so that it looks as if all were drawn?

Of each stretch of time, finer than the dots of the picture, the first and last point and every column's least and largest: what
lies between them is drawn over.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.record.trajectory import Trajectory
from watchsim.storage.columns import blocks, let_go

STRETCHES = 8000  # of the picture's width, some thousand dots
AT_ONCE = 2000  # rows that are looked up together
POINTS = 1_000_000  # a record with more rows in the window than that is thinned

Array = NDArray[np.float64]


def thinned(run: Trajectory, window: tuple[float, float]) -> NDArray[np.intp]:
    """The rows to draw of those inside the window, in order; all of them where they are not so many."""
    start, stop = window
    first, last = int(np.searchsorted(run.t, start, side="right")), int(np.searchsorted(run.t, stop, side="left"))
    if last - first <= POINTS:
        return np.arange(first, last)
    found, offset = [], first
    for t, *motion in blocks(*(array[first:last] for array in (run.t, run.q, run.u, run.a))):
        stretch = np.minimum(((t - start) * (STRETCHES / (stop - start))).astype(np.int64), STRETCHES - 1)
        begins = np.flatnonzero(np.diff(stretch, prepend=-1))
        rows = [begins, np.append(begins[1:], len(t)) - 1]
        lengths = np.diff(np.append(begins, len(t)))
        for column in np.hstack(motion).T:
            for extreme in (np.minimum, np.maximum):
                met = np.flatnonzero(column == np.repeat(extreme.reduceat(column, begins), lengths))
                rows.append(met[np.flatnonzero(np.diff(stretch[met], prepend=-1))])
        found.append(offset + np.unique(np.concatenate(rows)))
        offset += len(t)
    return np.concatenate(found)


def taken(array: NDArray[np.float64], rows: NDArray[np.intp]) -> Array:
    """These rows of an array that may lie in a file."""
    parts = []
    for (part,) in blocks(rows, length=AT_ONCE):
        first, last = part[0], part[-1]
        parts.append(array[first : last + 1] if last - first == len(part) - 1 else array[part])  # they rise
        let_go(array)
    return np.concatenate(parts) if parts else array[:0]
