"""Which moves between rows are looked at, and at which instants within them? Against brute force and scipy's polynomials."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BPoly

from watchsim.simulation.record import watched_instants
from watchsim.simulation.record.watched_instants import EARLY, EVERY, MOST_STEPS, chosen_moves, instants_within, longest_moves

BLOCK, FEW = 50, 3


def rows(count: int, n: int, seed: int) -> np.ndarray:
    """Rows (t, q, u, a) of n coordinates; now and then two at one instant."""
    rng = np.random.default_rng(seed)
    found = rng.normal(size=(count, 1 + 3 * n))
    found[:, 0] = np.cumsum(rng.random(count) * (rng.random(count) < 0.9))
    return found


def by_hand(table: np.ndarray, n: int, first: int) -> list[int]:
    """Of every second block, counted from the start of the run, the longest move of each coordinate or of a few in turn."""
    chosen = {early - first for early in EARLY if first <= early and early - first + 1 < len(table)}
    for start in range(0, len(table) - 1, BLOCK):
        number = (first + start) // BLOCK
        if number % EVERY == 0:
            turn = number // EVERY * FEW
            for i in range(n) if n <= FEW else [(turn + j) % n for j in range(FEW)]:
                way = np.abs(np.diff(table[start : start + BLOCK + 1, 1 + i]))
                chosen.add(start + int(way.argmax()))
    return sorted(k for k in chosen if table[k + 1, 0] > table[k, 0])


@pytest.mark.parametrize("n", [1, 3, 4, 7])
@pytest.mark.parametrize(("count", "first"), [(2, 0), (17, 0), (51, 0), (330, 0), (260, 37), (120, 250), (40, 1010), (1, 5)])
def test_the_longest_moves_of_every_second_block_are_looked_at(
    n: int, count: int, first: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watched_instants, "BLOCK", BLOCK)
    monkeypatch.setattr(watched_instants, "FEW", FEW)
    table = rows(count, n, count + n)
    assert chosen_moves(table, n, first).tolist() == by_hand(table, n, first)


def test_the_first_two_moves_of_a_run_are_looked_at_in_any_case() -> None:
    table = np.column_stack([np.arange(6.0), [0.0, 0.1, 0.2, 5.0, 5.1, 5.2], np.zeros((6, 2))])
    assert chosen_moves(table, 1, 0).tolist() == [0, 1, 2, 4]


def test_of_equal_moves_the_first_one_is_the_longest() -> None:
    table = np.array([[0.0, 5.0], [1.0, 7.0], [2.0, 5.0], [3.0, 5.0]])
    ways, places = np.full(2, 9.0), np.full(2, 9)
    longest_moves(table, 1, 3, np.array([1, 0]), ways, places)
    assert (ways.tolist(), places.tolist()) == ([2.0, 1.0], [1, 1])
    longest_moves(table, 2, 3, np.array([1]), ways[:1], places[:1])
    assert (ways[0], places[0]) == (0.0, 2)


@pytest.mark.parametrize("seed", range(3))
def test_within_a_move_there_are_evenly_spaced_instants_by_its_length(seed: int) -> None:
    """One in each tenth of the scene's size or begun one, at most so many; none at the ends. Places are quintics."""
    rng = np.random.default_rng(seed)
    scale = np.array([0.5, 2.0])
    before, after = rows(6, 2, seed), rows(6, 2, seed + 9)
    after[:, 0] = before[:, 0] + rng.uniform(0.1, 0.4, 6)
    ways = (0.0, 0.09, 0.11, -0.55, 0.61, 5.0)
    for k, way in enumerate(ways):
        after[k, 1:3] = before[k, 1:3] + scale * (np.array([way, 0.3 * way]) if k % 2 else np.array([-0.2 * way, way]))
    made = instants_within(before, after, scale, stepped=False)
    steps = [1, 1, 2, 6, 7, MOST_STEPS]
    assert made.ends.tolist() == [0, *np.cumsum(steps)] and len(made.times) == len(made.q) == sum(steps)
    for k, count in enumerate(steps):
        for j in range(count):
            place, share = made.ends[k] + j, (j + 1) / (count + 1)
            assert made.times[place] == pytest.approx(before[k, 0] + share * (after[k, 0] - before[k, 0]), rel=1e-14)
            for i in range(2):
                ends = [[row[k, 1 + i], row[k, 3 + i], row[k, 5 + i]] for row in (before, after)]
                quintic = BPoly.from_derivatives([before[k, 0], after[k, 0]], ends)
                assert made.q[place, i] == pytest.approx(float(quintic(made.times[place])), abs=1e-12)


def test_where_time_is_stepped_rows_themselves_are_looked_at() -> None:
    before, after = rows(3, 2, 1), rows(3, 2, 2)
    made = instants_within(before, after, np.ones(2), stepped=True)
    assert (made.times.tolist(), made.q.tolist(), made.ends.tolist()) == (
        after[:, 0].tolist(),
        after[:, 1:3].tolist(),
        [0, 1, 2, 3],
    )
    none = instants_within(before[:0], after[:0], np.ones(2), stepped=False)
    assert (len(none.times), none.q.shape, none.ends.tolist()) == (0, (0, 2), [0])
