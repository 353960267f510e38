"""Has every cell of every pair of bodies a key of its own, the same wherever it is made, and is it found soon?"""

from __future__ import annotations

import itertools
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from plain_kernels import in_python
from test_times_in_cells import COORDINATES, SIZES, Q, model, pair

from watchsim.candidates.cell_lookup import REACH, along, cell_key, find_slot, insert_cells
from watchsim.candidates.cell_table import PairCells
from watchsim.model.records import NO_KEY

_key, _slot, _insert, _along = (in_python(kernel) for kernel in (cell_key, find_slot, insert_cells, along))


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize(("index", "known"), [(REACH - 1, True), (REACH, False), (1 - REACH, True), (-REACH, False)])
def test_indices_that_keys_can_hold(axis: int, index: int, known: bool) -> None:
    q = 1e-3 * Q
    q[COORDINATES[axis]] = (index + 0.5) * SIZES[axis]
    assert (_key(model(pair(3)), 0, q) != NO_KEY) is known


def test_every_cell_of_every_pair_has_a_key_of_its_own() -> None:
    """Neighbours along each coordinate, of three pairs; coordinates beyond the number of axes do not count."""
    for axes in (1, 2, 3):
        keys = set()
        for p in range(3):
            for index in np.ndindex(3, 3, 3):
                q = Q.copy()
                for k, i in enumerate(COORDINATES):
                    q[i] = (index[k] - 1 + 0.5) * SIZES[k]
                keys.add(_key(SimpleNamespace(pairs=[pair(axes)] * 3), p, q))
        assert len(keys) == 3 * 3**axes


@pytest.mark.parametrize("k", [0, 1])
def test_keys_seen_from_a_carrier_are_of_differences(k: int) -> None:
    on = tuple(4 if i == k else -1 for i in range(3))
    q = Q.copy()
    q[COORDINATES[k]] -= q[4]
    assert _key(model(pair(2, 0, on)), 0, Q) == _key(model(pair(2)), 0, q) != _key(model(pair(2)), 0, Q)
    assert _key(model(pair(2, -1, on)), 0, Q) == _key(model(pair(2)), 0, Q)


@pytest.mark.parametrize("axes", [1, 2, 3])
@pytest.mark.parametrize("p", [0, 1, 5])
def test_the_table_makes_the_same_keys_as_the_kernel(axes: int, p: int) -> None:
    rng = np.random.default_rng(p)
    index = rng.integers(1 - REACH, REACH, (20, axes))
    table: Any = object.__new__(PairCells)
    table.p, table.axes = p, [None] * axes
    wanted = []
    for row in index:
        q = np.zeros(5)
        for k in range(axes):
            q[COORDINATES[k]] = (row[k] + 0.5) * SIZES[k]
        wanted.append(_key(SimpleNamespace(pairs=[pair(axes)] * 6), p, q))
    assert table._keys(index).tolist() == wanted and wanted[0] >= p * (2 * REACH) ** 3


def filled(keys: np.ndarray, room: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    table = np.full(room, NO_KEY), np.zeros(room, int), np.zeros(room, int)
    assert _insert(*table, keys, 3 * np.arange(len(keys)), np.arange(len(keys)) % 7) == len(keys)
    return table


@pytest.mark.parametrize("reach", [(500,), (14, 14), (4, 4, 4)])
def test_neighbouring_cells_lie_apart_in_the_table(reach: tuple[int, ...]) -> None:
    """At most half full: two looks and a half find a cell; of places drawn at random one and a half would do."""
    table: Any = object.__new__(PairCells)
    table.p, table.axes = 2, [None] * len(reach)
    index = np.array(list(itertools.product(*(range(-k, k + 1) for k in reach))))
    keys = table._keys(index)
    room = 1 << (2 * len(keys) - 1).bit_length()
    slots, start, count = filled(keys, room)
    begun: list[int] = []
    for key in keys.tolist():
        alone = np.full(room, NO_KEY)
        begun.append(int(_slot(alone, key)))
    places = [int(np.flatnonzero(slots == key)[0]) for key in keys.tolist()]
    looks = [(place - begin) % room + 1 for place, begin in zip(places, begun, strict=True)]
    assert np.mean(looks) < 2.5
    assert start[places].tolist() == (3 * np.arange(len(keys))).tolist()
    assert count[places].tolist() == (np.arange(len(keys)) % 7).tolist()


def test_what_is_known_is_left_as_it_is() -> None:
    """Only new cells are counted; the last place of a table is followed by the first."""
    keys = np.array([11, 12, 13])
    slots, start, count = filled(keys, 8)
    more = _insert(slots, start, count, np.array([12, 14]), np.array([90, 91]), np.array([5, 6]))
    place = int(np.flatnonzero(slots == 12)[0])
    assert more == 1 and (start[place], count[place]) == (3, 1)
    full = np.array([int(k) for k in range(100, 104)])
    crowded = np.full(4, NO_KEY)
    for key in full:
        crowded[_slot(crowded, key)] = key
    assert sorted(crowded.tolist()) == full.tolist() and all(crowded[_slot(crowded, key)] == key for key in full)


@pytest.mark.parametrize("key", [5, 1 << 40, 987654321])
def test_the_only_free_place_is_found_wherever_it_is(key: int) -> None:
    for place in range(8):
        keys = np.arange(1000, 1008)
        keys[place] = NO_KEY
        assert _slot(keys, key) == place
        keys[place] = key
        assert _slot(keys, key) == place


def test_what_is_taken_away_may_be_the_first_coordinate() -> None:
    q = [0.3, 1.1, 2.4]
    assert [_along(q, 2, on) for on in (-1, 0, 1)] == [2.4, 2.4 - 0.3, 2.4 - 1.1]
