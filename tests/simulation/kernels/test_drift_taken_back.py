"""Are gaps and rates taken back by the smallest change in the metric of the masses? Against pseudo-inverses."""

from __future__ import annotations

import numpy as np
import pytest
from made_up import both, closed_of, work_of
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.simulation.motion import drift_projection

BEHIND = 1e-6
INDEPENDENT = 1e-6  # sine² of the angle


def directions(seed: int, m: int = 3, n: int = 7) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normal and tangential directions, far from parallel, and inverse masses; one coordinate is held."""
    rng = np.random.default_rng(seed)
    normal, tangential = rng.normal(size=(2, m, n))
    normal[0, 2] = tangential[0, 2] = normal[-1, 0] = tangential[-1, 0] = 0.0
    inverse = rng.uniform(0.2, 3.0, n)
    inverse[4] = 0.0
    return normal, tangential, inverse


def least(ways: np.ndarray, wanted: np.ndarray, inverse: np.ndarray) -> np.ndarray:
    """Of all changes x with ways x = wanted the one with the smallest x M x: by the pseudo-inverse."""
    root = np.sqrt(inverse)
    return np.asarray(root * (np.linalg.pinv(ways * root) @ wanted))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("all_of_them", [True, False])
@pytest.mark.parametrize("m", [2, 3])
def test_gaps_are_closed_by_the_smallest_change(seed: int, m: int, all_of_them: bool) -> None:
    """Only negative ones where not all are wanted: the others stay as they are."""
    normal, tangential, inverse = directions(seed, m)
    gaps = np.array([5e-8, -7e-8, -3e-8])[:m]
    q = np.random.default_rng(seed).normal(size=7)
    moved = q.copy()
    closed, work = closed_of(normal, tangential, g=gaps.tolist()), work_of(m, inverse)
    deepest = in_python(drift_projection.project_positions)(closed, m, all_of_them, BEHIND, work, moved)
    wanted = -gaps if all_of_them else np.where(gaps < 0.0, -gaps, 0.0)
    assert deepest == 7e-8
    assert moved - q == pytest.approx(least(normal, wanted, inverse), rel=1e-6, abs=1e-14)


def test_nothing_moves_where_no_gap_is_negative_or_none_is_off() -> None:
    normal, tangential, inverse = directions(0)
    for gaps, whole, moves in (([0.0] * 3, True, False), ([1e-8, 0.0, 2e-8], False, False), ([1e-8, 0.0, 2e-8], True, True)):
        q = np.zeros(7)
        closed = closed_of(normal, tangential, g=gaps)
        deepest = in_python(drift_projection.project_positions)(closed, 3, whole, BEHIND, work_of(3, inverse), q)
        assert deepest == 0.0 and bool(np.any(q != 0.0)) == moves


def test_of_gaps_that_depend_on_each_other_those_met_first_are_closed() -> None:
    """Three on two coordinates: the one whose own force moves it least for its depth waits."""
    normal = 1e-4 * np.array([[1.0, 0.0], [0.0, 2.0], [0.6, 0.8]])
    inverse = np.array([1.0, 1.0])
    gaps = [-3e-8, -2e-8, -9e-8]  # over the lengths of their directions: 3, 1, 9
    q = np.zeros(2)
    closed, work = closed_of(normal, 0.01 * normal[:, ::-1], g=gaps), work_of(3, inverse)
    assert in_python(drift_projection.project_positions)(closed, 3, True, BEHIND, work, q) == 9e-8
    assert q == pytest.approx(np.linalg.solve(normal[[0, 2]], [3e-8, 9e-8]), rel=1e-9, abs=0.0)
    assert work.correction[:6] == pytest.approx([work.correction[0], 0.0, 0.0, 0.0, work.correction[4], 0.0])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("modes", [(STICK, OPEN, FORWARD), (BACKWARD, STICK, STICK), (OPEN, FORWARD, BACKWARD)])
def test_rates_of_what_is_in_force_and_slips_of_what_sticks_vanish(seed: int, modes: tuple[int, ...]) -> None:
    normal, tangential, inverse = directions(seed)
    rng = np.random.default_rng(seed + 9)
    rates, slips, u = rng.normal(size=3), rng.normal(size=3), rng.normal(size=7)
    ids = [6, 2, 4]
    closed = closed_of(normal, tangential, ids, gN_dot=rates.tolist(), gT_dot=slips.tolist())
    mode = np.zeros(8, np.int8)
    mode[ids] = modes
    work, changed = work_of(3, inverse), u.copy()
    in_python(drift_projection.project_velocities)(closed, 3, mode, INDEPENDENT, work, changed)
    rows = [2 * i for i in range(3) if modes[i] != OPEN] + [2 * i + 1 for i in range(3) if modes[i] == STICK]
    every = np.stack([rates, slips], axis=1).ravel()
    whole = both(normal, tangential)
    assert changed - u == pytest.approx(least(whole[rows], -every[rows], inverse), rel=1e-6, abs=1e-9)
    assert [i for i in range(6) if work.correction[i] != 0.0] == sorted(rows)
    left = in_python(drift_projection.rate_left)
    for i in range(3):
        assert left(closed, 3, i, work) == pytest.approx(rates[i] + normal[i] @ (changed - u), abs=1e-12)


@pytest.mark.parametrize("row", [2, 3])
@pytest.mark.parametrize("share", [0.9, 1.1])
def test_what_next_to_no_impulse_moves_is_left_as_it_is(row: int, share: float) -> None:
    """A lever arm whose square is less than that share of both of the contact's; slips count half beside gap rates."""
    own, other = 4.0, 0.0
    easy = own * INDEPENDENT * share / (1.0 - INDEPENDENT * share)
    work = work_of(2, np.ones(2))
    work.G[:2, :2] = 99.0
    work.G[row, row], work.G[5 - row, 5 - row], work.G[2, 3] = easy, own, other
    scale = in_python(drift_projection._scale_of)(work, row, INDEPENDENT)
    assert scale == (0.0 if share < 1.0 else pytest.approx((1.0 if row == 2 else 0.5) / easy**0.5))
    assert in_python(drift_projection._scale_of)(work, 5 - row, INDEPENDENT) == pytest.approx((1.0, 0.5)[3 - row] / 2.0)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_two_directions_count_as_one_below_an_angle(share: float) -> None:
    """By its sine²: what is one is taken back by one impulse only."""
    angle = (share * INDEPENDENT) ** 0.5
    normal = np.array([[1.0, 0.0], [np.cos(angle), np.sin(angle)]])
    closed = closed_of(normal, 1e-9 * normal, gN_dot=[0.3, -0.2])
    work = work_of(2, np.ones(2))
    in_python(drift_projection.find_correction)(closed, 2, np.array([FORWARD] * 2), INDEPENDENT, work)
    assert np.count_nonzero(work.correction[:4]) == (1 if share < 1.0 else 2)


@pytest.mark.parametrize("share", [0.9, 1.1])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_no_gap_is_taken_back_where_that_is_a_long_way_along_the_face(share: float, sign: float) -> None:
    """A force that opens the gap by its G moves the contact along by what both directions share: fifty times `behind`."""
    work = work_of(2, np.ones(2))
    work.G[2, 2], work.G[2, 3] = 3.0, sign * share * 50.0 * BEHIND * 3.0 / 4e-7
    assert in_python(drift_projection._has_drifted)(work, 2, -4e-7, BEHIND) == (share < 1.0)
