"""Which contacts are candidates in each cell of two bodies' configuration space?

Asked for once (broad_phase.py), together with the cells ahead, on the way that the bodies move. What is found holds as well
for every part of a turn by which an outline comes back onto itself, and for later runs with the same geometry.
"""

from __future__ import annotations

import itertools
import math
import time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.cell_frame import axes_of, seen_from
from watchsim.candidates.cell_lookup import REACH, insert_cells
from watchsim.candidates.equivalent_contacts import AlikeContacts
from watchsim.candidates.pair_cache import Cell, Known, known_cells
from watchsim.model.records import NO_KEY, Cells, Model

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
AROUND = {1: 16, 2: 4, 3: 1}  # cells asked about together, to each side, by number of axes
BESIDE, AHEAD = {1: 4, 2: 1, 3: 1}, {1: 24, 2: 16, 3: 3}  # of bodies that move: to each side of their way, and along it
MOST = 1 << 20  # cells in the table; beyond it everything is forgotten, so that no run fills the memory


class CellFinder:
    """The table of one run: the candidate contacts of every cell that it, or an earlier run, has asked about."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.seconds = 0.0
        self.learned = 0  # cells that shapely was asked about
        self._forget()
        self._pairs = {int(p): PairCells(model, int(p)) for p in np.flatnonzero(model.pairs.listed)}
        for p, pair in self._pairs.items():
            self._insert_cells(p, pair.known.cells())

    def learn(self, p: int, q: Array, u: Array | None = None) -> Cells:
        """Find the cell of body pair p at q and its neighbours, or those ahead at velocities u; returns the new table."""
        start = time.perf_counter()
        pair = self._pairs[p]
        before = len(pair.known)
        if self.number > MOST:
            self._forget()
        self._insert_cells(p, pair.known_around(q, u))
        self.learned += len(pair.known) - before
        self.seconds += time.perf_counter() - start
        return self.cells

    def warm_up(self) -> None:
        """Load or compile the kernel that fills the table."""
        self._insert(*(np.zeros(0, np.int64),) * 3)

    def _forget(self) -> None:
        self.number = self._entries = 0
        self._inside: set[tuple[int, Cell]] = set()  # pairs of bodies and cells of theirs that the table holds
        self.cells = Cells(np.full(64, NO_KEY, np.int64), *(np.zeros(size, np.int64) for size in (64, 64, 256)))

    def _insert_cells(self, p: int, cells: list[Cell]) -> None:
        """Put cells of body pair p into the table that it does not hold yet."""
        new = [cell for cell in cells if (p, cell) not in self._inside]
        self._inside.update((p, cell) for cell in new)
        if new:
            self._insert(*self._pairs[p].everywhere(new))

    def _insert(self, keys: Integers, count: Integers, found: Integers) -> None:
        """Put cells into the table, which doubles so that it is never more than half full."""
        old = self.cells
        slots = len(old.keys)
        while slots < 2 * (self.number + len(keys)):
            slots *= 2
        if slots > len(old.keys):
            taken = old.keys >= 0
            empty = np.full(slots, NO_KEY, np.int64), np.zeros(slots, np.int64), np.zeros(slots, np.int64)
            insert_cells(*empty, old.keys[taken], old.start[taken], old.count[taken])
            old = Cells(*empty, old.entries)
        entries = old.entries
        if self._entries + len(found) > len(entries):
            entries = np.concatenate([entries[: self._entries], np.zeros(self._entries + 2 * len(found), np.int64)])
        entries[self._entries : self._entries + len(found)] = found
        start = self._entries + np.cumsum(count) - count
        self._entries += len(found)
        self.number += int(insert_cells(old.keys, old.start, old.count, keys, start, count))
        self.cells = Cells(old.keys, old.start, old.count, entries)


class _Axis(NamedTuple):
    """One cell coordinate, less coordinate `on` (-1: nothing); `wrap` cells make a turn (0: a length) of `fold` alike parts."""

    coordinate: int
    on: int
    size: float
    wrap: int
    fold: int

    def cell_of(self, q: Array) -> int:
        """In which cell along it q lies, not wrapped."""
        return math.floor((q[self.coordinate] - (q[self.on] if self.on >= 0 else 0.0)) / self.size)

    def pace_of(self, u: Array) -> float:
        """Cells that velocities pass in a second."""
        return float(u[self.coordinate] - (u[self.on] if self.on >= 0 else 0.0)) / self.size

    @property
    def part(self) -> int:
        """Cells after which everything repeats, 0 for a length."""
        return self.wrap // self.fold if self.wrap else 0


class PairCells:
    """The cells of one pair of bodies: indices, keys and symmetries."""

    def __init__(self, model: Model, p: int) -> None:
        self.model, self.p, self.pair = model, p, model.pairs[p]
        self.axes = [
            _Axis(*(self.pair[f"{name}{i}"].item() for name in ("c", "on", "size", "wrap", "fold")))
            for i in range(self.pair.axes)
        ]
        self._around, self._beside = (self._block(reach[len(self.axes)]) for reach in (AROUND, BESIDE))
        self._parts = np.array([axis.part for axis in self.axes])
        self.start = int(self.pair.start)
        near = model.near[self.pair.near_start : self.pair.near_stop]
        both = (int(self.pair.a), int(self.pair.b))
        body = [axis.body for b in both for axis in axes_of(model.bodies, b, int(self.pair.frame))]
        # Where a body is geared to turn against its coordinate, a later part of its turn is an earlier one of that.
        self._sense = [1 if seen_from(model.bodies, b, int(self.pair.frame)).ratio > 0.0 else -1 for b in body]
        self._alike = [
            AlikeContacts(model.primitives, model.contacts, self.pair, near, b) if axis.fold > 1 else None
            for axis, b in zip(self.axes, body, strict=True)
        ]
        loose = [alike.loose for alike in self._alike if alike is not None]
        self.known: Known = known_cells(model, p, np.concatenate([np.zeros(0, np.int64), *loose]))

    def _block(self, reach: int) -> Integers:
        """Steps from a cell to itself and all its neighbours within `reach`, (cells, axes)."""
        return np.array(list(itertools.product(range(-reach, reach + 1), repeat=len(self.axes))))

    def _steps(self, u: Array | None) -> Integers:
        """Steps from a cell to those that are asked about with it: around it, or along the way that bodies move."""
        pace = np.array([axis.pace_of(u) for axis in self.axes]) if u is not None else np.zeros(1)
        fastest = np.abs(pace).max()
        if not 0.0 < fastest < math.inf:
            return self._around
        way = np.arange(AHEAD[len(self.axes)] + 1)[:, None] * (pace / fastest)
        along = np.rint(way).astype(np.int64)
        return np.unique((along[:, None] + self._beside).reshape(-1, len(self.axes)), axis=0)

    def around(self, q: Array) -> tuple[Integers, Integers, Integers]:
        """Of the cell of q and its neighbours: keys of cells, numbers of candidates, and these one after another."""
        return self.everywhere(self.known_around(q))

    def known_around(self, q: Array, u: Array | None = None) -> list[Cell]:
        """The cell of q and those near it (see `learn`), of each the alike one in the first part of a turn; all known now."""
        parts = self._parts
        block = np.array([axis.cell_of(q) for axis in self.axes]) + self._steps(u)
        block = block[((np.abs(block) < REACH) | (parts > 0)).all(axis=1)]
        turns = np.where(parts > 0, block // np.maximum(parts, 1), 0)
        base = block - turns * parts
        # Cells of one part lie side by side: they are asked about together.
        if (turns == turns[:1]).all():
            self.known.ask(base)
        else:
            for turn in np.unique(turns, axis=0):
                self.known.ask(base[(turns == turn).all(axis=1)])
        return list(dict.fromkeys(map(tuple, base.tolist())))

    def here(self, q: Array) -> Integers:
        """The candidates in the cell of q alone: beyond the keys all that can touch, as in a run."""
        index = [axis.cell_of(q) for axis in self.axes]
        if any(abs(i) >= REACH and not axis.wrap for i, axis in zip(index, self.axes, strict=True)):
            return self.model.near[self.pair.near_start : self.pair.near_stop]
        keys, count, found = self.around(q)
        key = self._keys(np.array([[i % axis.wrap if axis.wrap else i for i, axis in zip(index, self.axes, strict=True)]]))[0]
        place = int(np.flatnonzero(keys == key)[0])
        start = int(count[:place].sum())
        return found[start : start + count[place]]

    def everywhere(self, cells: list[Cell]) -> tuple[Integers, Integers, Integers]:
        """Cells and their candidates in all alike parts of a turn."""
        if not cells:
            return (np.zeros(0, np.int64),) * 3
        count, found = self.known.answers(cells)
        index = np.array(cells, np.int64)
        # Within each cell ascending: sorted together with the number of the cell.
        first = np.repeat(np.arange(len(cells)) * int(self.pair.stop - self.pair.start), count)
        shift, moved = self._turned(found)
        keys = self._keys((index + shift[:, None]).reshape(-1, len(self.axes)))
        lists = np.sort(first + moved) - first + self.start
        return keys, np.tile(count, len(shift)), lists.ravel()

    def _turned(self, found: Integers) -> tuple[Integers, Integers]:
        """All alike parts of turns: how many cells away they are, (parts, axes); what is there for `found`, (parts, found)."""
        shift, moved = np.zeros((1, 0), np.int64), found[None]
        for axis, alike, sense in zip(self.axes, self._alike, self._sense, strict=True):
            turns = [moved]
            while alike is not None and len(turns) < axis.fold:
                turns.append(alike.later(turns[-1]))
            steps = sense * np.arange(axis.fold) % axis.fold * axis.part
            shift = np.column_stack([np.repeat(shift, axis.fold, axis=0), np.tile(steps, len(shift))])
            moved = np.stack(turns, axis=1).reshape(len(shift), len(found))
        return shift, moved

    def _keys(self, index: Integers) -> Integers:
        """The keys of cells, as `cell_lookup.cell_key` makes them."""
        key = np.full(len(index), self.p, np.int64)
        for i in range(3):
            key = key * 2 * REACH + REACH + (index[:, i] if i < len(self.axes) else 0)
        return key
