"""Which rows of a table are named by a list of numbers, and as which of those?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Integers = NDArray[np.int64]


def named_rows(numbers: Integers, rows: int) -> tuple[Integers, Integers]:
    """The numbers that occur, ascending, each once, and for each of `numbers` its place among them; all below `rows`.

    As `np.unique` with `return_inverse`, in linear time: the lists are as long as the contacts, the tables are short.
    """
    present = np.zeros(rows, bool)
    present[numbers] = True
    return np.flatnonzero(present), (np.cumsum(present) - 1)[numbers]
