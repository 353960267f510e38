"""Which cells are asked about together, and where do they lie in a turn? Against counting by hand."""

from __future__ import annotations

import itertools
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from plain_kernels import in_python
from test_cell_travel import made

from watchsim.candidates.cell_lookup import REACH, cell_key
from watchsim.candidates.cell_table import AHEAD, AROUND, BESIDE, CellFinder, PairCells, _Axis
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


class Answers:
    """So many candidates for each cell, of twenty contacts; notes what is asked."""

    def __init__(self) -> None:
        self.asked: list[list[list[int]]] = []

    def ask(self, index: np.ndarray) -> None:
        self.asked.append(sorted(index.tolist()))

    def answers(self, cells: list[tuple[int, ...]]) -> tuple[np.ndarray, np.ndarray]:
        lists = [self.of(cell) for cell in cells]
        return np.array([len(one) for one in lists]), np.array([k for one in lists for k in one])

    @staticmethod
    def of(cell: tuple[int, ...]) -> list[int]:
        return sorted({(7 * k + sum(cell)) % 20 for k in range(2 + cell[0] % 3)})


def two_wheels(*axes: _Axis) -> Any:
    """Cells of the third pair, whose twenty contacts begin with number 100; the second coordinate turns its body backwards."""
    cells: Any = object.__new__(PairCells)
    cells.p, cells.axes, cells.start, cells.known, cells._sense = 2, list(axes), 100, Answers(), [1, -1]
    cells.pair = SimpleNamespace(start=100, stop=120)
    cells._parts = np.array([axis.part for axis in axes])
    cells._alike = [SimpleNamespace(later=lambda k: (k + 3) % 20), SimpleNamespace(later=lambda k: (7 * k + 1) % 20)]
    return cells


TURNS = _Axis(0, -1, 0.1, 12, 4), _Axis(2, 1, 0.2, 15, 3)


def test_candidates_everywhere_in_a_turn() -> None:
    """Four parts of three cells by three parts of five: where each contact's next one is, and in which cell."""
    cells, some = two_wheels(*TURNS), [(0, 4), (2, 1), (1, 0)]
    keys, count, found = cells.everywhere(some)
    parts = [part.tolist() for part in np.split(found, np.cumsum(count)[:-1])]
    expected = {}
    for one, other in itertools.product(range(4), range(3)):
        for cell in some:
            ids = Answers.of(cell)
            for _ in range(one):
                ids = [(k + 3) % 20 for k in ids]
            for _ in range(other):
                ids = [(7 * k + 1) % 20 for k in ids]
            place = np.array([[cell[0] + 3 * one, (cell[1] - 5 * other) % 15]])
            expected[int(cells._keys(place)[0])] = sorted(100 + k for k in ids)
    assert dict(zip(keys.tolist(), parts, strict=True)) == expected and len(keys) == 36


def test_cells_of_one_part_are_asked_about_together() -> None:
    """Around a cell at a corner of four parts; each stands for the alike one in the first part."""
    cells = two_wheels(*TURNS)
    cells._around = np.array(list(itertools.product((-1, 0, 1), repeat=2)))
    q = np.array([0.35 + 1.2, 0.3, 0.3 + 0.2 * 5.5 - 3.0])
    found = cells.known_around(q)
    groups = [[[x, y] for x in xs for y in ys] for xs in ([2], [0, 1]) for ys in ([4], [0, 1])]
    assert sorted(cells.known.asked) == sorted(groups) and sorted(map(list, found)) == sorted(itertools.chain(*groups))
    inside = two_wheels(*TURNS)
    inside._around = cells._around
    inside.known_around(np.array([0.15 - 1.2, 0.3, 0.3 + 0.2 * 7.5]))
    assert inside.known.asked == [[[x, y] for x in (0, 1, 2) for y in (1, 2, 3)]]


@pytest.mark.parametrize("sign", [1, -1])
def test_lengths_end_where_keys_do(sign: int) -> None:
    cells = two_wheels(_Axis(0, -1, 0.5, 0, 1), TURNS[1])
    cells._around = np.array([[k, 0] for k in range(-3, 4)])
    found = cells.known_around(np.array([0.5 * (sign * (REACH - 2) + 0.5), 0.0, 0.1]))
    assert sorted(cell[0] for cell in found) == sorted(sign * (REACH - k) for k in range(1, 6))


@pytest.mark.parametrize(("on", "less"), [(-1, 0.0), (0, 1.3), (1, -0.9)])
def test_cells_and_paces_are_of_differences(on: int, less: float) -> None:
    axis, values = _Axis(2, on, 0.25, 0, 1), np.array([1.3, -0.9, 3.1])
    assert axis.cell_of(values) == math.floor((3.1 - less) / 0.25)
    assert axis.pace_of(values) == pytest.approx((3.1 - less) / 0.25, rel=1e-14)


@pytest.mark.parametrize("numbers", [(32,), (33,), (10, 22), (10, 23), (5, 60, 64)])
def test_the_table_is_at_most_half_full(numbers: tuple[int, ...]) -> None:
    """It begins with 64 places and doubles; what was in it stays."""
    finder: Any = object.__new__(CellFinder)
    finder._forget()
    expected: dict[int, list[int]] = {}
    for number in numbers:
        keys = np.arange(number) * 37 + 5000 * (1 + len(expected))
        lists = [[int(key) + k for k in range(int(key) % 4)] for key in keys]
        finder._insert(keys, np.array([len(one) for one in lists]), np.array([k for one in lists for k in one]))
        expected |= dict(zip(keys.tolist(), lists, strict=True))
        cells = finder.cells
        assert len(cells.keys) == max(64, 1 << (2 * len(expected) - 1).bit_length()) and finder.number == len(expected)
        taken = np.flatnonzero(cells.keys != NO_KEY)
        held = {int(cells.keys[i]): cells.entries[cells.start[i] : cells.start[i] + cells.count[i]].tolist() for i in taken}
        assert held == expected
