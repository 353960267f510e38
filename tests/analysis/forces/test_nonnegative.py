"""Does the active-set method give what scipy's gives, and what no other choice betters?"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls

from watchsim.analysis.nonnegative import _begun, _of_alike, _within, nonnegative, nonnegative_of_many


@pytest.mark.parametrize("seed", range(40))
def test_the_same_as_scipy(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows, columns = rng.integers(1, 9, 2)
    system = np.vstack((rng.normal(size=(rows, columns)), 10.0 ** rng.uniform(-4.0, 0.0) * np.eye(columns)))
    right = np.append(rng.normal(size=rows), np.zeros(columns))
    expected, rest = nnls(system, right)
    got = nonnegative(system, right)
    assert np.all(got >= 0.0)
    assert np.allclose(got, expected, rtol=1e-9, atol=1e-9 * max(1.0, expected.max()))
    assert np.linalg.norm(system @ got - right) <= rest * (1.0 + 1e-9) + 1e-13


def test_where_nothing_helps_all_is_zero() -> None:
    assert np.array_equal(nonnegative(np.eye(3), -np.ones(3)), np.zeros(3))
    assert np.array_equal(nonnegative(np.eye(2), np.array([3.0, -1.0])), [3.0, 0.0])


@pytest.mark.parametrize("seed", range(40))
def test_wherever_it_begins_the_same_comes_out(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows, columns = rng.integers(2, 9, 2)
    system = np.vstack((rng.normal(size=(rows, columns)), 10.0 ** rng.uniform(-4.0, 0.0) * np.eye(columns)))
    right = np.append(rng.normal(size=rows), np.zeros(columns))
    expected, _ = nnls(system, right)
    for likely in (expected > 0.0, expected == 0.0, rng.random(columns) < 0.5, np.ones(columns, bool)):
        before = likely.copy()
        got = nonnegative(system, right, likely)
        assert np.allclose(got, expected, rtol=1e-9, atol=1e-9 * max(1.0, expected.max()))
        assert np.array_equal(likely, before)


@pytest.mark.parametrize("seed", [*range(20), 111, 187])
def test_columns_that_are_nearly_alike(seed: int) -> None:
    """Then entries come into use and leave it again and again."""
    rng = np.random.default_rng(seed)
    columns, rows = int(rng.integers(5, 25)), int(rng.integers(3, 15))
    alike = rng.normal(size=(rows, 3)) @ rng.normal(size=(3, columns)) + 0.05 * rng.normal(size=(rows, columns))
    system = np.vstack((alike, 10.0 ** rng.uniform(-3.0, 0.0) * np.eye(columns)))
    right = np.append(rng.normal(size=rows), np.zeros(columns))
    expected, _ = nnls(system, right)
    assert np.allclose(nonnegative(system, right), expected, rtol=1e-8, atol=1e-8 * max(1.0, expected.max()))


@pytest.mark.parametrize("seed", range(10))
def test_in_other_units_it_is_the_same_to_the_bit(seed: int) -> None:
    """Forces and lever arms of a watch are small numbers; a power of two changes no digit."""
    rng = np.random.default_rng(seed)
    alike = rng.normal(size=(6, 3)) @ rng.normal(size=(3, 9)) + 0.05 * rng.normal(size=(6, 9))
    right, unit = rng.normal(size=6), 2.0**-60
    likely = rng.random(9) < 0.5
    assert np.array_equal(nonnegative(alike, right * unit, likely), unit * nonnegative(alike, right, likely))
    assert np.array_equal(nonnegative(alike, right * unit), unit * nonnegative(alike, right))
    assert np.array_equal(nonnegative(alike * unit, right), nonnegative(alike, right) / unit)


@pytest.mark.parametrize("seed", range(20))
def test_of_many_each_is_the_same_as_scipy(seed: int) -> None:
    """Of systems that change little by little or jump, in any order, and whichever of them are asked about together."""
    rng = np.random.default_rng(seed)
    count, rows, columns = 30, *rng.integers(1, 8, 2)
    change = np.cumsum(rng.normal(size=(count, rows, columns + 1)) * rng.choice([0.0, 0.02, 1.0], (count, 1, 1)), axis=0)
    gentle = 10.0 ** rng.uniform(-4.0, 0.0) * np.eye(columns)
    systems = np.array([np.vstack((one[:, :-1], gentle)) for one in change])
    rights = np.array([np.append(one[:, -1], np.zeros(columns)) for one in change])
    expected = np.array([nnls(system, right)[0] for system, right in zip(systems, rights, strict=True)])
    for chosen in (np.arange(count), rng.permutation(count), rng.permutation(count)[:7], np.arange(1), np.arange(0)):
        got = nonnegative_of_many(systems[chosen], rights[chosen])
        assert np.all(got >= 0.0)
        assert np.allclose(got, expected[chosen], rtol=1e-9, atol=1e-9 * max(1.0, expected.max()))


def test_of_alike_ones_the_first_is_looked_into(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of twenty systems two kinds take turns: one search for each kind."""
    asked: list[float] = []

    def searched(system: np.ndarray, right: np.ndarray, likely: object) -> np.ndarray:
        asked.append(right[0])
        return np.maximum(right, 0.0)

    monkeypatch.setattr("watchsim.analysis.nonnegative.nonnegative", searched)
    rights = np.array([(1.0 + k, -2.0) if k % 2 else (-1.0 - k, 3.0) for k in range(20)])
    assert nonnegative_of_many(np.array([np.eye(2)] * 20), rights) == pytest.approx(np.maximum(rights, 0.0))
    assert asked == [-1.0, 2.0]


def test_what_is_tried_is_taken_only_where_it_is_the_best() -> None:
    """With the first of two alone: the best; the second would help; it would pull; rounding is no help; it would be zero."""
    right = np.array([[2.0, -1.0], [2.0, 1.0], [-2.0, -1.0], [2.0, 1e-15], [0.0, -1.0]])
    x, best = _of_alike(np.array([np.diag([4.0, 1.0])] * 5), right, np.array([True, False]))
    assert x.tolist() == [[0.5, 0.0], [0.5, 0.0], [-0.5, 0.0], [0.5, 0.0], [0.0, 0.0]]
    assert best.tolist() == [True, False, False, True, False]


@pytest.mark.parametrize("seed", range(25))
def test_a_step_leaves_what_would_pull_and_comes_nearer(seed: int) -> None:
    """From any place without negative entries to the best with some of those in use; the way there goes only downhill."""
    rng = np.random.default_rng(seed)
    columns = int(rng.integers(3, 10))
    system, right = rng.normal(size=(columns + 2, columns)), rng.normal(size=columns + 2)
    used = rng.random(columns) < 0.8
    start = np.where(used, rng.uniform(0.0, 2.0, columns) * (rng.random(columns) < 0.8), 0.0)
    before = used.copy()
    found = _within(system, right, start, used)
    assert not (used & ~before).any() and np.array_equal(found > 0.0, used) and np.array_equal(found != 0.0, used)
    assert np.linalg.norm(system @ found - right) <= np.linalg.norm(system @ start - right) + 1e-12
    assert system[:, used].T @ (system @ found - right) == pytest.approx(np.zeros(used.sum()), abs=1e-10)


@pytest.mark.parametrize("unit", [1.0, 2.0**-30, 2.0**20])
def test_of_several_that_would_pull_the_first_met_leaves(unit: float) -> None:
    """From (3, 2, 1) towards (-1, -8, 7) the second is zero after a fifth of the way. With the others the best is (0.5, 0, 4),
    so that the first need not leave."""
    best, rest = np.array([-1.0, -8.0, 7.0]), np.array([0.5, 0.0, 4.0])
    # Of the normal equations G x = c, the first and the third have both solutions.
    first, third = 8.0 * (rest[0] - best[0]) / best[1], 4.0 * (rest[2] - best[2]) / best[1]
    gram = np.array([[8.0, first, 0.0], [first, 6.0, third], [0.0, third, 4.0]])
    system, used = np.linalg.cholesky(gram).T, np.ones(3, bool)
    found = _within(system, system @ best * unit, np.array([3.0, 2.0, 1.0]) * unit, used)
    assert found == pytest.approx(rest * unit, rel=1e-9, abs=0.0) and used.tolist() == [True, False, True]


def test_where_it_begins() -> None:
    """With the likely ones, unless one of them would pull: then with none."""
    system, right = np.diag([2.0, 4.0, 5.0]), np.array([1.0, 3.0, -10.0])
    x, used = _begun(system, right, np.array([True, False, False]))
    assert x == pytest.approx([0.5, 0.0, 0.0]) and used.tolist() == [True, False, False]
    for likely in (None, np.zeros(3, bool), np.array([True, False, True])):
        x, used = _begun(system, right, likely)
        assert not x.any() and not used.any()
