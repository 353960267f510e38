"""Which forces are chosen where contacts are redundant? Against every choice that there is, and by what they must keep."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from watchsim.analysis.balanced_forces import _least, _pressing, _within_cones

RNG = np.random.default_rng(77)


def redundant(contacts: int, coordinates: int) -> tuple[np.ndarray, np.ndarray]:
    """Directions of contacts by coordinate, more of them than coordinates."""
    return RNG.normal(size=(contacts, coordinates)), RNG.uniform(0.5, 2.0, coordinates)


@pytest.mark.parametrize("unit", [1.0, 1e-3, 1e4])
@pytest.mark.parametrize("contacts", [1, 2, 3, 5])
def test_the_smallest_of_all_solutions(contacts: int, unit: float) -> None:
    """Measured so that the diagonal is one: no other solution is smaller; in other units of a contact it is the same."""
    directions, mobility = redundant(contacts, 3)
    system = np.array([directions * mobility @ directions.T for _ in range(2)])
    units = np.where(np.arange(contacts) == 0, unit, 1.0)
    right = (system @ RNG.normal(size=(2, contacts, 1)))[:, :, 0]
    found = _least(system * units[:, None] * units, right * units)
    assert (system @ (found * units)[:, :, None])[:, :, 0] == pytest.approx(right, rel=1e-8, abs=1e-9)
    scale = np.sqrt(np.diagonal(system, axis1=1, axis2=2))
    for k in range(2):
        scaled = system[k] / np.outer(scale[k], scale[k])
        smallest = np.linalg.lstsq(scaled, right[k] / scale[k], rcond=1e-12)[0] / scale[k]
        assert found[k] * units == pytest.approx(smallest, rel=1e-6, abs=1e-9)


def test_a_contact_that_moves_nothing_has_no_force() -> None:
    system = np.array([[[2.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 8.0]]])
    assert _least(system, np.array([[4.0, 0.0], [0.0, 4.0]])) == pytest.approx(np.array([[2.0, 0.0], [0.0, 0.5]]), abs=1e-12)


def test_friction_may_turn_the_sign_of_a_diagonal() -> None:
    system = np.array([[[-4.0, 0.5], [0.25, 9.0]]])
    found = _least(system, np.array([[8.0, -3.0]]))
    assert (system @ found[:, :, None])[:, :, 0] == pytest.approx(np.array([[8.0, -3.0]]), rel=1e-12)


def smallest(system: np.ndarray, right: np.ndarray) -> np.ndarray:
    """The smallest of all solutions without negative entries: every choice of entries in use is tried."""
    shares = system.shape[1]
    found = []
    for mask in itertools.product([False, True], repeat=shares):
        used, x = np.array(mask), np.zeros(shares)
        if used.any():
            x[used] = np.linalg.pinv(system[:, used]) @ right
        if x.min() >= -1e-9 and np.abs(system @ x - right).max() <= 1e-9 * np.abs(right).max():
            found.append(x)
    return min(found, key=lambda x: float(x @ x))


@pytest.mark.parametrize("unit", [1.0, 1e-6, 1e5])
@pytest.mark.parametrize("shares", [1, 3, 6, 8])
def test_shares_press_and_balance(shares: int, unit: float) -> None:
    """None is negative, what is asked for comes out, and no other such choice is smaller, of each of ten systems."""
    system = RNG.normal(size=(10, 3, shares)) * unit
    there = np.where(RNG.random((10, shares)) < 0.6, RNG.uniform(0.5, 2.0, (10, shares)), 0.0)
    right = (system @ there[:, :, None])[:, :, 0]
    found = _pressing(system, right)
    for k in range(10):
        assert (found[k] >= -1e-12 * max(1.0, found[k].max())).all()
        assert system[k] @ found[k] == pytest.approx(right[k], rel=1e-9, abs=1e-9 * unit)
        assert found[k] == pytest.approx(smallest(system[k], right[k]), abs=1e-9)


@pytest.mark.parametrize("sticking", [[], [0], [1, 2], [0, 1, 2, 3]])
def test_forces_stay_in_their_cones(sticking: list[int]) -> None:
    """What sticks within friction, what slides on its edge; together they do what is asked, at each of ten instants."""
    w_n, w_t = RNG.normal(size=(2, 10, 4, 3))
    friction, sticks = RNG.uniform(0.1, 0.6, 4), np.array(sticking, np.int64)
    slide = np.where(np.isin(np.arange(4), sticks), 0.0, friction * RNG.choice([-1.0, 1.0], 4))
    normal = RNG.uniform(0.5, 2.0, (10, 4))
    tangential = np.where(slide == 0.0, normal * friction * RNG.uniform(-0.9, 0.9, (10, 4)), slide * normal)
    system = RNG.normal(size=(10, 5, 3))
    right = np.array([system[k] @ (normal[k] @ w_n[k] + tangential[k] @ w_t[k]) for k in range(10)])
    found = _within_cones(system, right, (w_n, w_t), (sticks, slide, friction))
    for k, force in enumerate(found):
        done = system[k] @ (force[:, 0] @ w_n[k] + force[:, 1] @ w_t[k])
        assert done == pytest.approx(right[k], rel=1e-8, abs=1e-9)
        assert (force[:, 0] >= -1e-9).all() and (np.abs(force[:, 1]) <= friction * force[:, 0] + 1e-9).all()
        sliding = slide != 0.0
        assert force[sliding, 1] == pytest.approx(slide[sliding] * force[sliding, 0], abs=1e-12)


@pytest.mark.parametrize("tangential", [0.9, -0.9, 0.0, 1.0, -1.0])
def test_what_sticks_may_rub_both_ways(tangential: float) -> None:
    """A single contact with µ = 0.5 that has to press with 2."""
    laws, along, across = (np.array([0]), np.zeros(1), np.array([0.5])), np.array([[[1.0, 0.0]]]), np.array([[[0.0, 1.0]]])
    found = _within_cones(np.eye(2)[None], np.array([[2.0, tangential]]), (along, across), laws)
    assert found == pytest.approx(np.array([[[2.0, tangential]]]), rel=1e-9, abs=1e-9)
