"""Does the active-set method give what scipy's gives, and what no other choice betters?"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls

from watchsim.analysis.nonnegative import nonnegative


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
