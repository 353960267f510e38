"""Which points does a dense curve need, so that it looks as if all were drawn?

In every column of dots the first, the last, the least and the largest value: a line through them covers the very same dots
(Jugel et al., M4: a visualization-oriented time series data aggregation, VLDB 2014), and no spike is lost, be it one sample
long. `thinned` does so for a record of millions of rows, `reduced` for one curve, `bands` for areas, `envelope` for what goes
to and fro too often to be seen, `distinct` for curves that are no functions. `kept_rows` serves players instead: it leaves out
the rows that interpolation brings back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.storage.columns import blocks, let_go

Rows = NDArray[np.intp]

STRETCHES = 8000  # columns of a record: finer than the dots of any picture
AT_ONCE = 2000  # rows that are looked up together
POINTS = 1_000_000  # a record with more rows in the window than that is thinned
COLUMNS = 4000  # of a panel: more than 600 dots per inch over 170 mm


def thinned(run: Trajectory, window: tuple[float, float]) -> Rows:
    """The rows to draw of those inside the window, in order; all of them where they are not so many."""
    start, stop = window
    first, last = int(np.searchsorted(run.t, start, side="right")), int(np.searchsorted(run.t, stop, side="left"))
    if last - first <= POINTS:
        return np.arange(first, last)
    found, offset = [], first
    for t, *motion in blocks(*(array[first:last] for array in (run.t, run.q, run.u, run.a))):
        column = _columns(t, STRETCHES, start, stop)
        found.append(offset + np.unique(np.concatenate(_kept(column, np.hstack(motion).T))))
        offset += len(t)
    return np.concatenate(found)


def reduced(x: Array, y: Array, columns: int = COLUMNS) -> tuple[Array, Array]:
    """The points of a curve over rising `x` that a picture so many columns wide needs, in order; gaps (nan) stay gaps."""
    if len(x) <= 4 * columns or not x[-1] > x[0]:
        return x, y
    kept = _kept(_columns(x, columns), y[None])
    # A gap stays one: its first row, and the rows before and after it.
    gaps = np.isnan(y)
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


FEWEST = 20  # columns of an envelope
HOLDS = 3.0  # of the longest time between two crossings of the middle: a full swing lies in it, wherever it begins


def envelope(x: Array, y: Array, swings: float) -> list[tuple[Array, Array, Array]]:
    """As `bands`, in columns that each hold a full swing, of a curve that goes to and fro all along and more than so often.

    Empty for any other curve, and for one with gaps.
    """
    above = y > 0.5 * (y.min() + y.max())  # never, where there is a gap
    crossings = x[1:][above[1:] != above[:-1]]
    if not len(crossings) > 2.0 * swings:
        return []
    longest = float(np.diff(crossings, prepend=x[0], append=x[-1]).max())
    columns = int((x[-1] - x[0]) / (HOLDS * longest))
    return bands(x, y, columns) if columns >= FEWEST else []


def distinct(x: Array, y: Array) -> tuple[Array, Array]:
    """The points of a curve that need not be a function: those that stand in another dot than the one before or after them."""
    if len(x) <= COLUMNS:
        return x, y
    marks = []
    for values in (x, y):
        low, high = np.nanmin(values), np.nanmax(values)
        scaled = (values - low) * (COLUMNS / (high - low)) if high > low else np.zeros(len(values))
        marks.append(np.where(np.isnan(scaled), -1.0, np.floor(scaled)))
    moved = (np.diff(marks[0]) != 0.0) | (np.diff(marks[1]) != 0.0)
    kept = np.concatenate(([True], moved)) | np.concatenate((moved, [True]))
    return x[kept], y[kept]


def _columns(x: Array, columns: int, start: float | None = None, stop: float | None = None) -> Rows:
    """In which column each point stands, of so many from `start` to `stop` (default the first and last point)."""
    start, stop = (x[0] if start is None else start), (x[-1] if stop is None else stop)
    return np.minimum(((x - start) * (columns / (stop - start))).astype(np.int64), columns - 1)


def _kept(column: Rows, curves: Iterable[Array]) -> list[Rows]:
    """Rows of the first and last point of each column, and of the least and largest value of each curve there."""
    begins = np.flatnonzero(np.diff(column, prepend=-1))
    ends = np.append(begins[1:], len(column))
    kept = [begins, ends - 1]
    for values in curves:
        for extreme in (np.fmin, np.fmax):
            met = np.flatnonzero(values == np.repeat(extreme.reduceat(values, begins), ends - begins))
            kept.append(met[np.flatnonzero(np.diff(column[met], prepend=-1))])
    return kept


def taken(array: Array, rows: Rows) -> Array:
    """These rows of an array that may lie in a file."""
    parts = []
    for (part,) in blocks(rows, length=AT_ONCE):
        first, last = part[0], part[-1]
        parts.append(array[first : last + 1] if last - first == len(part) - 1 else array[part])  # they rise
        let_go(array)
    return np.concatenate(parts) if parts else array[:0]


def kept_rows(count: int, fits: Callable[[int, int], bool], ends: Iterable[int] = ()) -> NDArray[np.int64]:
    """Rows of 0 … count - 1 to keep, in order: the first, the last, those in `ends`, and as many between as it takes.

    `fits(i, j)` says whether all rows between i and j are represented well enough by these two.
    """
    forced = sorted({0, count - 1, *ends}) if count else []
    kept = set(forced)
    open_parts = [(i, j) for i, j in pairwise(forced) if j > i + 1]
    while open_parts:
        i, j = open_parts.pop()
        if fits(i, j):
            continue
        middle = (i + j) // 2
        kept.add(middle)
        open_parts += [(low, high) for low, high in ((i, middle), (middle, j)) if high > low + 1]
    return np.array(sorted(kept), np.int64)


def off_line(t: Array, values: Array, i: int, j: int) -> Array:
    """How far (j - i - 1, n) the rows between i and j of `values` (m, n) lie off the straight line from i to j."""
    s = ((t[i + 1 : j] - t[i]) / (t[j] - t[i]))[:, None]
    return np.abs(values[i] + s * (values[j] - values[i]) - values[i + 1 : j])
