"""Which rows may be left out, so that what is interpolated between the others stays where it was?"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray


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
