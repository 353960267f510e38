"""How does a class of named fields become a record that kernels read and write?

The class lists the fields: `float`, `int`, or an annotated array with its length. A record is one row of a numpy record array;
numba passes it as one pointer, so that `state.clock.time` costs what `state.clock[0]` did.
"""

from __future__ import annotations

import functools
from typing import Any, TypeVar, cast, get_args, get_type_hints

import numpy as np
from numpy.typing import NDArray

Fields = TypeVar("Fields")

_CODES = {float: "f8", int: "i8"}


@functools.cache
def dtype_of(fields: type) -> np.dtype[Any]:
    """The numpy type with the fields of that class, eight bytes each; `Annotated[Integers, 5]` is five of them."""
    described: list[tuple[Any, ...]] = []
    for name, kind in get_type_hints(fields, include_extras=True).items():
        if kind in _CODES:
            described.append((name, _CODES[kind]))
        else:
            array, length = get_args(kind)
            described.append((name, get_args(get_args(array)[1])[0], (length,)))
    return np.dtype(described)


def blank(fields: type[Fields]) -> Fields:
    """A record with these fields, all zero."""
    return cast(Fields, np.zeros(1, dtype_of(cast(type, fields))).view(np.recarray)[0])


def row_of(record: Any) -> NDArray[Any]:
    """(1,): the record array to which a record belongs, sharing its memory."""
    return np.asarray(record).reshape(1)


def words_of(record: Any, kind: type) -> NDArray[Any]:
    """(fields,): all fields of a record one after another, sharing its memory; they must be of one kind, float or int."""
    return row_of(record).view(_CODES[kind])


def copy_of(record: Fields) -> Fields:
    """A record of its own with the same values."""
    return cast(Fields, row_of(record).copy().view(np.recarray)[0])
