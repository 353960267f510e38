"""Contacts that no drawing has: random force directions, as kernels keep them and as whole matrices."""

from types import SimpleNamespace

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import Closed, closed_contacts
from watchsim.simulation.scratch import Projection, _projection_room

Array = NDArray[np.float64]


def closed_of(normal: Array, tangential: Array, ids: list[int] | None = None, **kin: list[float]) -> Closed:
    """Contacts with these force directions, (m, n) each; entries in no particular order, none for what both leave alone."""
    m = len(normal)
    closed = closed_contacts(m + 2)
    for i in range(m):
        columns = [j for j in range(normal.shape[1]) if normal[i, j] != 0.0 or tangential[i, j] != 0.0][::-1]
        closed.ids[i], closed.slots[i] = i if ids is None else ids[i], len(columns)
        closed.coord[i, : len(columns)] = columns
        closed.w_N[i, : len(columns)], closed.w_T[i, : len(columns)] = normal[i, columns], tangential[i, columns]
    for name, values in kin.items():
        closed.kin[name][:m] = values
    closed.slots[m:], closed.w_N[m:], closed.kin["g"][m:] = 1, 99.0, -99.0  # of no contact asked about
    return closed


def projection_of(m: int, n: int) -> Projection:
    """Room for so many contacts and no more on n coordinates; whatever was in it before."""
    projection = _projection_room(n, m)
    for array in projection:
        array[...] = 1 if array.dtype.kind == "i" else 77.0
    return projection


def both(normal: Array, tangential: Array) -> Array:
    """(2 m, n): normal and tangential direction of one contact after another."""
    return np.stack([normal, tangential], axis=1).reshape(2 * len(normal), -1)


def named(**values: object) -> SimpleNamespace:
    """A record of made-up fields."""
    return SimpleNamespace(**values)
