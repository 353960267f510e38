"""Which points does a dense curve need, so that it looks as if all were drawn?

In every column of dots the first, the last, the least and the largest value: a line through them covers the very same dots
(Jugel et al., M4: a visualization-oriented time series data aggregation, VLDB 2014), and no spike is lost, be it one sample
long.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

COLUMNS = 4000  # of a panel: more than 600 dots per inch over 170 mm
Array = NDArray[np.float64]


def reduced(x: Array, y: Array, columns: int = COLUMNS) -> tuple[Array, Array]:
    """The points of a curve over rising `x` that a picture so many columns wide needs, in order; gaps (nan) stay gaps."""
    if len(x) <= 4 * columns or not x[-1] > x[0]:
        return x, y
    place = _columns(x, columns)
    begins = np.flatnonzero(np.diff(place, prepend=-1))
    ends = np.append(begins[1:], len(x)) - 1
    lengths = ends - begins + 1
    gaps = np.isnan(y)
    kept = [begins, ends]
    for extreme, missing in ((np.minimum, np.inf), (np.maximum, -np.inf)):
        found = extreme.reduceat(np.where(gaps, missing, y), begins)
        met = np.flatnonzero(y == np.repeat(found, lengths))
        kept.append(met[np.flatnonzero(np.diff(place[met], prepend=-1))])
    # A gap stays one: its first row, and the row before it.
    opened = np.flatnonzero(gaps & ~np.concatenate(([False], gaps[:-1])))
    closed = np.flatnonzero(gaps & ~np.concatenate((gaps[1:], [False])))
    kept += [opened, np.maximum(opened - 1, 0), np.minimum(closed + 1, len(x) - 1)]
    rows = np.unique(np.concatenate(kept))
    return x[rows], y[rows]


def bands(x: Array, y: Array, columns: int = COLUMNS) -> list[tuple[Array, Array, Array]]:
    """The area that a dense curve over rising `x` covers: x, least and largest value of each column, stretch by stretch.

    Filling it takes a hundredth of the time that thousands of strokes beside each other take. Empty where the points are so few
    that a curve is to be drawn. Gaps part the stretches, but for those within a column.
    """
    if len(x) <= 4 * columns or not x[-1] > x[0]:
        return []
    begins = np.flatnonzero(np.diff(_columns(x, columns), prepend=-1))
    middle = 0.5 * (x[begins] + x[np.append(begins[1:], len(x)) - 1])
    middle[0], middle[-1] = x[0], x[-1]
    low, high = np.fmin.reduceat(y, begins), np.fmax.reduceat(y, begins)
    known = np.isfinite(low)
    edges = np.flatnonzero(np.diff(known.astype(np.int8), prepend=0, append=0))
    return [(middle[i:j], low[i:j], high[i:j]) for i, j in edges.reshape(-1, 2).tolist()]


def _columns(x: Array, columns: int) -> NDArray[np.int64]:
    """In which column each point stands."""
    return np.minimum(((x - x[0]) * (columns / (x[-1] - x[0]))).astype(np.int64), columns - 1)


def distinct(x: Array, y: Array, cells: int = COLUMNS) -> tuple[Array, Array]:
    """The points of a curve that need not be a function: those that stand in another dot than the one before or after them."""
    if len(x) <= cells:
        return x, y
    marks = []
    for values in (x, y):
        low, high = np.nanmin(values), np.nanmax(values)
        scaled = (values - low) * (cells / (high - low)) if high > low else np.zeros(len(values))
        marks.append(np.where(np.isnan(scaled), -1.0, np.floor(scaled)))
    moved = (np.diff(marks[0]) != 0.0) | (np.diff(marks[1]) != 0.0)
    kept = np.concatenate(([True], moved)) | np.concatenate((moved, [True]))
    return x[kept], y[kept]
