"""Does the acceleration problem decide what trying all modes, one by one with numpy, says is the only way?"""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from plain_kernels import in_python
from sparse_contacts import Sparse

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.dynamics import acceleration

SIGN = {STICK: 0, FORWARD: 1, BACKWARD: -1}
Way = tuple[tuple[int, ...], tuple[int, ...], np.ndarray, np.ndarray]  # modes, grips, u', forces
SLOWEST = 1e-5  # m/s: contacts that slip less may stick


def accelerations(case: Sparse, dry: list[int], modes: tuple[int, ...], grips: tuple[int, ...]) -> tuple[np.ndarray, ...]:
    """(u', contact forces, bearing torques) in these modes, by one linear system."""
    n, m = case.n, case.m
    mass, h = case.model.coordinates.mass, case.work.h
    friction, torque = case.friction, np.array([case.model.coordinates[j].coulomb for j in dry])
    size = n + 2 * m + len(dry)
    A, right = np.zeros((size, size)), np.zeros(size)
    A[:n, :n], right[:n] = np.diag(mass), h
    A[:n, n : n + 2 * m] = -case.W.T
    for k, j in enumerate(dry):
        line = n + 2 * m + k
        A[j, line] = -1.0
        if grips[k] == STICK:
            A[line, j] = 1.0
        else:
            A[line, line], right[line] = 1.0, -grips[k] * torque[k]
    for i, mode in enumerate(modes):
        N, T = n + 2 * i, n + 2 * i + 1
        if mode == OPEN:
            A[N, N] = A[T, T] = 1.0
            continue
        A[N, :n], right[N] = case.W[2 * i], -case.bars[2 * i]
        if mode == STICK:
            A[T, :n], right[T] = case.W[2 * i + 1], -case.bars[2 * i + 1]
        else:
            A[T, T], A[T, N] = 1.0, mode * friction[i]
    x = np.linalg.solve(A, right)
    return x[:n], x[n : n + 2 * m], x[n + 2 * m :]


def ways(case: Sparse, dry: list[int], slips: np.ndarray) -> list[Way]:
    """All that no law forbids."""
    found = []
    slides = [(OPEN, FORWARD if s > 0.0 else BACKWARD) for s in slips]
    choices = [(*two, STICK, -two[1]) if abs(s) <= SLOWEST else two for s, two in zip(slips, slides, strict=True)]
    for modes in itertools.product(*choices):
        for grips in itertools.product((STICK, FORWARD, BACKWARD), repeat=len(dry)):
            a, force, torque = accelerations(case, dry, modes, grips)
            gaps = case.W @ a + case.bars
            good = all(force[2 * i] >= 0.0 and gaps[2 * i] >= -1e-9 for i in range(case.m))
            for i, mode in enumerate(modes):
                good &= mode != STICK or abs(force[2 * i + 1]) <= case.friction[i] * force[2 * i]
                good &= abs(slips[i]) > SLOWEST or mode not in (FORWARD, BACKWARD) or mode * gaps[2 * i + 1] > 0.0
            for k, j in enumerate(dry):
                good &= grips[k] != STICK or abs(torque[k]) <= case.model.coordinates[j].coulomb
                good &= grips[k] == STICK or grips[k] * a[j] > 0.0
            if good:
                found.append((modes, grips, a, force))
    return found


@pytest.mark.parametrize("seed", sorted({*range(24)} - {11}))  # there friction grips too much
def test_contacts_and_bearings_move_in_the_only_way_there_is(seed: int) -> None:
    rng = np.random.default_rng(seed)
    m, n, bearings = 1 + seed % 2, 8, seed % 3
    case = Sparse(rng, m, n, friction=0.3, slots=(5, 7))
    work, dry = case.work, [int(j) for j in rng.permutation(n)[:bearings]]
    case.model.coordinates.coulomb[dry] = rng.uniform(0.1, 1.5, bearings)
    if m == 2:  # without friction, or with next to none
        one = 0.0 if seed % 4 == 1 else 5e-4
        case.model.laws.friction[case.model.contacts[case.closed.ids[1]].group] = case.friction[1] = one
    slips = rng.choice([0.0, 0.9e-5, -0.9e-5, 1.1e-5, -1.1e-5], m)
    case.closed.kin.gT_dot[:m] = slips
    found = ways(case, dry, slips)
    assert len(found) == 1
    modes, grips, a, force = found[0]
    work.dry[:bearings], h, inverse = dry, work.h.copy(), work.inverse.copy()
    out_grip, out_mode = np.full(n, STICK, np.int8), np.full(2 * m, 77, np.int8)
    decide = in_python(acceleration.decide_modes)
    assert decide(case.model, case.closed, m, bearings, SLOWEST, work, out_grip, out_mode)
    expected = list(modes)
    for i in range(m):
        if case.friction[i] == 0.0 and modes[i] != OPEN:  # which way it slides makes no difference
            expected[i] = BACKWARD if slips[i] < 0.0 else FORWARD
    assert [out_mode[k] for k in case.closed.ids[:m]] == expected
    assert np.count_nonzero(out_mode == 77) == m
    assert [out_grip[j] for j in dry] == list(grips)
    assert work.force[: 2 * m] == pytest.approx(force, abs=1e-12)
    for j, grip in zip(dry, grips, strict=True):
        inverse[j] *= grip != STICK
        h[j] -= SIGN[grip] * case.model.coordinates[j].coulomb
    assert work.h == pytest.approx(h) and work.inverse == pytest.approx(inverse)
    for values in (work.b, work.size, work.loaded):
        assert not np.isnan(values[: 2 * m + bearings]).any() and np.isnan(values[2 * m + bearings :]).all()
    speeding = np.zeros(n)
    in_python(acceleration.accelerate)(case.model, case.closed, m, work, speeding)
    assert speeding == pytest.approx(a, abs=1e-12)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("light", [1.0, 1e-12])
def test_forces_in_decided_modes_solve_one_linear_system(seed: int, light: float) -> None:
    """Also where a second mechanism, which shares no coordinate with the first, is a million million times lighter."""
    rng = np.random.default_rng(100 + seed)
    case = Sparse(rng, 3, 8)
    for i, first in ((0, 0), (1, 4), (2, 0)):
        case.moves(i, first + rng.permutation(4), rng)
    modes = tuple(int(mode) for mode in rng.choice([STICK, FORWARD, BACKWARD], 3))
    case.model.laws.friction[case.model.contacts[case.closed.ids[seed % 3]].group] = case.friction[seed % 3] = 5e-4
    _, force, _ = accelerations(case, [], modes, ())
    for values in (case.model.coordinates.mass, case.work.h):
        values[4:] *= light
    case.work.inverse[:] = 1.0 / case.model.coordinates.mass
    by_number = np.full(6, 55, np.int8)
    by_number[case.closed.ids[:3]] = modes
    assert in_python(acceleration.solve_mode)(case.model, case.closed, 3, by_number, 1.0, case.work)
    force[2:4] *= light
    assert case.work.force[:6] == pytest.approx(force, rel=1e-9, abs=0.0)
