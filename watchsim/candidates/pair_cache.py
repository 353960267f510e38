"""What is known about the cells of two bodies, in this process, from whatever run?

Keyed by a digest of all that an answer depends on: the primitives of both bodies, where they sit and how they can move, the
declared contacts, and the cells. Runs of a sweep that leaves the geometry alone share it; the least recently used goes first.
"""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.broad_phase import PairSearch
from watchsim.candidates.cell_frame import seen_from
from watchsim.candidates.named_rows import named_rows
from watchsim.model.records import FIXED, PIVOT, SLIDE, Model

Integers = NDArray[np.int64]
Cell = tuple[int, ...]
KEPT = 32  # pairs of bodies
MOST_CELLS = 1 << 18  # of one pair; beyond it its answers are forgotten

_store: OrderedDict[bytes, Known] = OrderedDict()
_lock = threading.Lock()


class Known:
    """The candidates of one pair of bodies in the cells asked about so far, numbered from the pair's first contact."""

    def __init__(self, search: PairSearch) -> None:
        self._search = search
        self._found: dict[Cell, Integers] = {}
        self._lock = threading.Lock()

    def __len__(self) -> int:
        return len(self._found)

    def cells(self) -> list[Cell]:
        """All cells asked about so far."""
        return list(self._found)

    def ask(self, index: Integers) -> None:
        """Search those cells that are not known yet; `index`: neighbouring cells, (cells, axes)."""
        with self._lock:
            if len(self._found) > MOST_CELLS:
                self._found.clear()
            new = [i for i, cell in enumerate(map(tuple, index.tolist())) if cell not in self._found]
            if not new:
                return
            count, found = self._search.candidates(index[new])
            found, stops = found.astype(np.int64), np.cumsum(count).tolist()
            parts = [found[start:stop] for start, stop in zip([0, *stops], stops, strict=False)]
            self._found.update(zip(map(tuple, index[new].tolist()), parts, strict=True))

    def answers(self, cells: list[Cell]) -> tuple[Integers, Integers]:
        """Numbers of candidates of `cells`, and the candidates one after another."""
        parts = [self._found[cell] for cell in cells]
        return np.array([len(part) for part in parts], np.int64), np.concatenate(parts).astype(np.int64)


def known_cells(model: Model, p: int, loose: Integers) -> Known:
    """What is known about body pair p of `model`; the same object for every model with the same geometry.

    `loose`: primitives that do not share their outline's symmetry, which follow from the geometry.
    """
    key = _digest(model, p)
    with _lock:
        known = _store.pop(key, None)
        if known is None:
            known = Known(PairSearch(model, p, loose))
        _store[key] = known
        while len(_store) > KEPT:
            _store.popitem(last=False)
    return known


def forget() -> None:
    """Drop all that is known, for measurements and tests."""
    with _lock:
        _store.clear()


def _digest(model: Model, p: int) -> bytes:
    """Of everything that the candidates of body pair p depend on, with numbers counted from the pair's own first ones."""
    pair = model.pairs[p]
    axes = [int(pair[f"{name}{i}"]) for name in ("c", "on") for i in range(pair.axes)]
    used = sorted(set(axes) - {-1})
    place = {FIXED: ("x", "y", "angle"), PIVOT: ("x", "y"), SLIDE: ("x", "y", "angle", "axis_x", "axis_y")}
    digest = hashlib.blake2b(digest_size=20)
    for b in (pair.a, pair.b):
        body = seen_from(model.bodies, int(b), int(pair.frame))
        for part in (body, model.bodies[body.carrier]) if body.carrier >= 0 else (body,):
            where = [float(part[name]) for name in (*place.get(int(part.motion), ()), "ratio", "phase")]
            first = used.index(int(part.first)) if part.first in used else -1
            digest.update(repr((int(part.motion), first, where)).encode())
        digest.update(b"|")
    cells = [float(pair[f"{name}{i}"]) for i in range(pair.axes) for name in ("size", "wrap", "fold")]
    digest.update(repr((cells, [used.index(axis) if axis >= 0 else -1 for axis in axes], float(pair.clearance))).encode())
    contacts = model.contacts[pair.start : pair.stop]
    present, rows = named_rows(np.concatenate([contacts.a, contacts.b]), len(model.primitives))
    mine = model.primitives[present]
    for name in mine.dtype.names:
        if name in ("before", "after"):  # numbers in the whole model, which say nothing about places
            continue
        digest.update(np.ascontiguousarray(mine.body == pair.a if name == "body" else mine[name]).tobytes())
    near = model.near[pair.near_start : pair.near_stop] - pair.start
    for numbers in (rows, np.asarray(contacts.group), near):
        digest.update(np.ascontiguousarray(numbers, np.int64).tobytes())
        digest.update(b"|")
    return digest.digest()
