"""Is a record of named fields one piece of memory, which kernels and Python read and write alike?"""

from types import GenericAlias
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import entry
from watchsim.model import blank, copy_of, dtype_of, row_of, words_of


class Mixed:
    """Two kinds of numbers, and several of one kind."""

    time: float
    number: int
    by: Annotated[NDArray[np.int64], 3]


class Times:
    """Of one kind."""

    first: float
    last: float


class Aliased:
    """An array type as numpy 2.5 spells it: an alias that only holds its element."""

    by: Annotated[GenericAlias(list, (np.float64,)), 2]  # type: ignore[valid-type]


@entry
def _count(record: Any, i: int) -> float:
    record.number += 1
    record.by[i] += record.number
    record.time += 0.5
    return float(record.time)


def test_a_kernel_writes_what_python_reads() -> None:
    record = blank(Mixed)
    record.time = 1.0
    assert [_count(record, i) for i in (0, 2)] == [1.5, 2.0]
    assert (record.time, record.number, list(record.by)) == (2.0, 2, [1, 0, 2])


def test_fields_take_eight_bytes_each() -> None:
    assert dtype_of(Mixed).itemsize == 8 * 5
    assert dtype_of(Mixed).names == ("time", "number", "by")


def test_views_share_the_memory_and_copies_do_not() -> None:
    record = blank(Times)
    words_of(record, float)[:] = 3.0, 4.0
    assert (record.first, record.last) == (3.0, 4.0)
    row_of(record)["last"] = 5.0
    apart = copy_of(record)
    apart.first = 7.0
    assert (record.first, record.last, apart.last) == (3.0, 5.0, 5.0)


def test_the_element_of_an_array_is_found_however_its_type_is_made() -> None:
    assert dtype_of(Aliased) == np.dtype([("by", "f8", (2,))])
    assert dtype_of(Mixed)["by"].base == np.int64
