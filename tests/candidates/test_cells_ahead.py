"""Which cells are asked about together, and where do they lie in a turn? Against counting by hand."""

from __future__ import annotations

import itertools
import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python
from test_cell_travel import made

from watchsim.candidates.cell_lookup import REACH, cell_key
from watchsim.candidates.cell_table import AHEAD, AROUND, BESIDE, PairCells
from watchsim.jit import callable_kernel
from watchsim.model.records import NO_KEY

CASES = [("pivot", "fixed"), ("pivot", "pivot"), ("slide", "slide"), ("free", "fixed"), ("pivot", "fixed", False)]
_key = callable_kernel(cell_key)


def cells_of(case: tuple[str | bool, ...]) -> tuple[PairCells, np.ndarray]:
    model = made(*case)[1].model
    pair = model.pairs[0]
    return PairCells(model, 0), np.array([pair[f"size{i}"] for i in range(pair.axes)])


def rates(cells: PairCells, pace: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Velocities that pass so many cells in a second."""
    u = np.zeros(len(cells.model.coordinates))
    for axis, speed in sorted(zip(cells.axes, pace * sizes, strict=True), key=lambda one: one[0].on):
        u[axis.coordinate] = speed + (u[axis.on] if axis.on >= 0 else 0.0)
    return u


@pytest.mark.parametrize("case", CASES, ids=str)
def test_along_the_way_and_beside_it(case: tuple[str | bool, ...]) -> None:
    """As far ahead as is said along the fastest coordinate, on the straight way, and so many cells to each side of it."""
    cells, sizes = cells_of(case)
    n, rng = len(cells.axes), np.random.default_rng(3)
    for _ in range(6):
        pace = rng.normal(size=n)
        steps = {tuple(step) for step in cells._steps(rates(cells, pace, sizes)).tolist()}
        expected = set()
        for k in range(AHEAD[n] + 1):
            there = [round(float(k * p / np.abs(pace).max())) for p in pace]
            beside = itertools.product(range(-BESIDE[n], BESIDE[n] + 1), repeat=n)
            expected |= {tuple(a + b for a, b in zip(there, side, strict=True)) for side in beside}
        assert steps == expected
        assert len(cells._steps(rates(cells, pace, sizes))) == len(steps)


@pytest.mark.parametrize("case", CASES, ids=str)
def test_of_what_stands_or_has_no_known_pace_all_cells_around(case: tuple[str | bool, ...]) -> None:
    cells, sizes = cells_of(case)
    n = len(cells.axes)
    block = set(itertools.product(range(-AROUND[n], AROUND[n] + 1), repeat=n))
    for u in (None, rates(cells, np.zeros(n), sizes), np.full(len(cells.model.coordinates), math.inf)):
        assert {tuple(step) for step in cells._steps(u).tolist()} == block


@pytest.mark.parametrize("case", CASES, ids=str)
def test_keys_are_those_that_the_loop_looks_up(case: tuple[str | bool, ...]) -> None:
    """Of the cell that holds q: several turns away, too, and where indices are negative."""
    cells, sizes = cells_of(case)
    rng = np.random.default_rng(5)
    for _ in range(10):
        q = rng.uniform(-20.0, 20.0, len(cells.model.coordinates))
        index = []
        for axis, size in zip(cells.axes, sizes, strict=True):
            place = (q[axis.coordinate] - (q[axis.on] if axis.on >= 0 else 0.0)) / size
            assert axis.cell_of(q) == math.floor(place)
            index.append(math.floor(place) % axis.wrap if axis.wrap else math.floor(place))
        assert int(cells._keys(np.array([index]))[0]) == int(_key(cells.model, 0, q))


def test_beyond_the_range_of_keys_no_lengths_are_asked_about() -> None:
    """Turns come back; a length does not."""
    cells, sizes = cells_of(("slide", "slide"))
    q = np.array([(REACH - 2.5) * sizes[0], 0.0])
    known = cells.known_around(q)
    columns = {cell[0] for cell in known}
    assert max(columns) == REACH - 1 and min(columns) == REACH - 3 - AROUND[2]
    turning, size = cells_of(("pivot", "fixed"))
    far = turning.known_around(np.array([1e5]))
    assert len(far) == 2 * AROUND[1] + 1 and all(0 <= cell < turning.axes[0].wrap for (cell,) in far)
    assert (math.floor(1e5 / size[0]) % turning.axes[0].wrap,) in far


def test_where_no_cell_is_left_there_is_nothing_to_ask() -> None:
    cells, sizes = cells_of(("slide", "slide"))
    beyond = 2.0 * REACH * sizes
    assert cells.known_around(beyond) == []
    assert [part.tolist() for part in cells.around(beyond)] == [[], [], []]


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_key_has_room_for_so_many_cells_to_either_side_along_each_axis(axis: int, sign: int) -> None:
    pair = SimpleNamespace(axes=3, frame=-1)
    for i in range(3):
        for name, value in ((f"c{i}", i), (f"on{i}", -1), (f"size{i}", 0.5), (f"wrap{i}", 0)):
            setattr(pair, name, value)
    model, keys = SimpleNamespace(pairs=[pair]), []
    for index in (0, 1, REACH - 1, REACH):
        q = np.full(3, 0.25)
        q[axis] += 0.5 * sign * index
        keys.append(in_python(cell_key)(model, 0, q))
    assert len(set(keys)) == 4 and min(keys[:3]) >= 0 and keys[3] == NO_KEY
