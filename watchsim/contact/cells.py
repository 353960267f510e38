"""Which contacts are candidates in each cell of two bodies' configuration space?

Looked up once (broad_phase.py), together with the cells ahead, on the way that the bodies move. What is found holds as well
for every turn that maps an outline onto itself, and for later runs with the same geometry.
"""

from __future__ import annotations

import hashlib
import itertools
import math
import threading
import time
from collections import OrderedDict
from collections.abc import Sequence
from typing import NamedTuple
from weakref import WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.broad_phase import PairSearch
from watchsim.contact.cell_frames import MOVEMENT, TRAVEL, Axis, axes_of, chords, named_rows, seen_from
from watchsim.contact.cell_lookup import FEW_CONTACTS, REACH, insert_cells
from watchsim.contact.symmetry import AlikeContacts
from watchsim.model import ARC, CORNER, FIXED, FULL, NO_KEY, PIVOT, SLIDE, Cells, Model, Records

# Into which cells is the configuration space of two bodies divided?
#
# Cells are sized by how far a point travels in one. An outline with rotational symmetry gets as many cells
# for each such part, so that they can be shared (symmetry.py).

# A cell lets the outermost point of either body travel this share of the larger one's reach: the first where outlines are made
# of pieces as short as that, so that few of them fit into it, else the second.
FINEST_SHARE, CELL_SHARE = 0.01, 0.02
FEWEST = 8  # cells in a turn
MOST_PARTS = 1024  # a symmetry with more parts is not worth the table


class _Cells(NamedTuple):
    """One cell coordinate: its number, what is taken away, the size of a cell, cells in a turn (0: a length), alike parts."""

    c: int
    on: int
    size: float
    wrap: int
    fold: int


def choose_cells(bodies: Records, primitives: Records, contacts: Records, pairs: Records, near: NDArray[np.int64]) -> None:
    """Fill in the reach of each pair of bodies of which one travels, and the cells of those with many contacts."""
    for pair in pairs:
        ids = near[pair.near_start : pair.near_stop]
        axes = {b: axes_of(bodies, b, pair.frame) for b in (int(pair.a), int(pair.b))}
        used_by = [axis.coordinate for own in axes.values() for axis in own]
        travels = any(axis.kind == TRAVEL for own in axes.values() for axis in own)
        has_reach = travels and len(ids) and pair.frame == MOVEMENT and all(bodies[b].carrier < 0 for b in axes)
        # A coordinate that moves both bodies, as that of two gears, would need cells of both.
        has_cells = len(ids) > FEW_CONTACTS and 1 <= len(used_by) <= 3 and len(set(used_by)) == len(used_by)
        if not (has_reach or has_cells):
            continue
        used, _ = named_rows(np.concatenate([contacts.a[ids], contacts.b[ids]]), len(primitives))
        mine = {b: primitives[used[primitives.body[used] == b]] for b in axes}
        reach = {b: float(np.hypot(*chords(rows, pair.clearance).points.T).max(initial=0.0)) for b, rows in mine.items()}
        if has_reach:
            pair.reach = sum(reach.values()) + 2.0 * pair.clearance
        if not has_cells:
            continue
        moving = [b for b in axes if axes[b]]
        piece = _typical_length(primitives[used])
        largest = max(reach[b] for b in moving)
        travel = min(max(FINEST_SHARE * largest, piece), CELL_SHARE * largest) or pair.clearance
        cells: list[_Cells] = []
        parts = 1
        for b in moving:
            seen = seen_from(bodies, b, pair.frame)
            slides = seen.motion == SLIDE
            fold = 1 if slides else AlikeContacts(primitives, contacts, pair, ids, b).fold
            fold = fold if parts * fold <= MOST_PARTS else 1
            parts *= fold
            # Only a body's own angle, the last of its axes, maps its outline onto itself, and only there is it geared.
            cells += [_cells(axis, travel, reach[b]) for axis in axes[b][:-1]]
            cells.append(_cells(axes[b][-1], travel, reach[b], fold, seen.ratio))
        pair.axes, pair.listed = len(cells), 1
        for i, axis in enumerate(cells):
            for name, value in axis._asdict().items():
                pair[f"{name}{i}"] = value


def _typical_length(rows: Records) -> float:
    """Median length of the lines and arcs among some primitives, m; 0 without any."""
    half = np.where(rows.extent == FULL, np.pi, np.arctan2(rows.half_sin, rows.half_cos))
    lengths = np.where(rows.kind == ARC, 2.0 * half * rows.radius, rows.length)[rows.kind != CORNER]
    return float(np.median(lengths)) if len(lengths) else 0.0


def _cells(axis: Axis, travel: float, reach: float, fold: int = 1, ratio: float = 1.0) -> _Cells:
    """Cells in which the points of a body within `reach` of its origin travel about `travel` metres.

    `ratio`: how far the body itself goes when the coordinate changes by one.
    """
    if axis.kind == TRAVEL:
        return _Cells(axis.coordinate, axis.on, travel / abs(ratio), 0, 1)
    cells = max(FEWEST, 2.0 * math.pi * (axis.arm + reach) / travel)
    turn = fold * math.ceil(cells / fold)
    return _Cells(axis.coordinate, axis.on, 2.0 * math.pi / (turn * abs(ratio)), turn, fold)


# What is known about the cells of two bodies, in this process, from whatever run?
#
# Keyed by a digest of all that an answer depends on: the primitives of both bodies, where they sit and how they can move, the
# declared contacts, and the cells. Runs of a sweep that leaves the geometry alone share it; the least recently used goes
# first.

Integers = NDArray[np.int64]
Cell = tuple[int, ...]
KEPT = 32  # pairs of bodies, besides those of runs under way
FEW_CELLS = 100  # of a pair: a run that moves on passes more
MOST_CELLS = 1 << 18  # of one pair; beyond it its answers are forgotten

_store: OrderedDict[bytes, Known] = OrderedDict()
_used: WeakValueDictionary[bytes, Known] = WeakValueDictionary()
_usual: OrderedDict[tuple[object, ...], Known] = OrderedDict()  # by pair and cells: whose cells alike geometry asks for, too
_lock = threading.Lock()


class Known:
    """The candidates of one pair of bodies in the cells searched so far, numbered from the pair's first contact."""

    def __init__(self, search: PairSearch, usual: Sequence[Cell] = ()) -> None:
        """`usual`: cells that are searched with the first ones, for they are likely to be needed."""
        self._search, self._usual = search, usual
        self._found: dict[Cell, Integers] = {}
        self._lock = threading.Lock()

    def __len__(self) -> int:
        return len(self._found)

    def cells(self) -> list[Cell]:
        """All cells searched so far."""
        return list(self._found)

    def ask(self, index: Integers) -> None:
        """Search those cells that are not known yet; `index`: neighbouring cells, (cells, axes)."""
        with self._lock:
            if len(self._found) > MOST_CELLS:
                self._found.clear()
            asked = dict.fromkeys(map(tuple, index.tolist()))
            asked.update(() if self._found else dict.fromkeys(self._usual))
            new = [cell for cell in asked if cell not in self._found]
            if not new:
                return
            count, found = self._search.candidates(np.array(new, np.int64))
            found, stops = found.astype(np.int64), np.cumsum(count).tolist()
            parts = [found[start:stop] for start, stop in zip([0, *stops], stops, strict=False)]
            self._found.update(zip(new, parts, strict=True))

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
        known = _store.pop(key, None) or _used.get(key)
        if known is None:
            known = _made(model, p, loose)
        _store[key] = _used[key] = known
        while len(_store) > KEPT:
            _store.popitem(last=False)
    return known


def _made(model: Model, p: int, loose: Integers) -> Known:
    """Of a mechanism with a dimension changed a little the bodies pass the same cells: one search for all, not one for each
    stretch of the way. It costs time where they do not, and changes no answer."""
    pair = model.pairs[p]
    shape = tuple(int(pair[f"{name}{i}"]) for i in range(pair.axes) for name in ("c", "on", "wrap", "fold"))
    alike = (p, int(pair.a), int(pair.b), int(pair.stop - pair.start), *shape)
    usual = _usual.pop(alike, None)
    known = Known(PairSearch(model, p, loose), () if usual is None else usual.cells())
    # The first one, so that its cells do not become more and more; another where that went hardly anywhere.
    _usual[alike] = known if usual is None or len(usual) < FEW_CELLS else usual
    while len(_usual) > KEPT:
        _usual.popitem(last=False)
    return known


def forget() -> None:
    """Drop all that is known, for measurements and tests."""
    with _lock:
        _store.clear()
        _used.clear()
        _usual.clear()


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


Array = NDArray[np.float64]
AROUND = {1: 16, 2: 4, 3: 1}  # cells searched together, to each side, by number of axes
BESIDE, AHEAD = {1: 4, 2: 1, 3: 1}, {1: 24, 2: 16, 3: 3}  # of bodies that move: to each side of their way, and along it
MOST = 1 << 20  # cells in the table; beyond it everything is forgotten, so that no run fills the memory


class CellFinder:
    """The table of one run: the candidate contacts of every cell that it, or an earlier run, has searched."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.seconds = 0.0
        self.learned = 0  # cells that shapely has searched
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
        around = pair.known_around(q, u)
        self._insert_cells(p, around if before else pair.known.cells())
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
        """Steps from a cell to those that are searched with it: around it, or along the way that bodies move."""
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
        # Cells of one part lie side by side: they are searched together.
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
