"""Are impacts of two contacts those of the published complementarity problems, whose bases are tried one by one?"""

from __future__ import annotations

import numpy as np
import pytest
from naive.impact_oracle import compressed, expanded
from plain_kernels import in_python
from sparse_contacts import Sparse

from watchsim.dynamics import impact
from watchsim.dynamics.problem_kinds import Level
from watchsim.model.records import COULOMB, PG1996, SHIFTED

M, N = 2, 7


@pytest.mark.parametrize("kind", [COULOMB, SHIFTED, PG1996])
@pytest.mark.parametrize("seed", range(14))
def test_two_contacts_rebound_by_their_laws(seed: int, kind: int) -> None:
    """Each contact with its own friction and restitution; the energy is that of the velocities."""
    rng = np.random.default_rng(seed)
    case = Sparse(rng, M, N, friction=0.25, slots=(5, 7))
    laws = case.model.laws
    laws.kind, laws.tangential, laws.nu = kind, rng.uniform(0.1, 0.9, 2 * M), rng.uniform(0.1, 0.9, 2 * M)
    mass, eps = case.model.coordinates.mass, rng.uniform(0.2, 0.9, M) * (1.0 if seed % 5 else np.array([0.0, 1.0]))
    if seed % 3 == 0:
        smooth = seed // 3 % 2
        laws.friction[case.model.contacts[case.closed.ids[smooth]].group] = case.friction[smooth] = 0.0
    u = rng.normal(size=N)
    u -= (case.W / mass).T @ np.linalg.solve(case.G, case.W @ u - rng.normal(size=4) * [1.0, 0.5, 1.0, 0.5] + [1.2, 0, 0.4, 0])
    rates, G = case.W @ u, case.G
    first = compressed(G, rates, case.friction)
    total = first.copy()
    if np.any((eps > 0.0) & (first[::2] > 0.0)):
        total += expanded(G, rates, first, eps, case.laws)
    case.work.inverse[:], after = np.nan, u.copy()
    assert in_python(impact.impact)(case.model, case.closed, M, eps, 0.0, case.work, after)
    assert case.work.force[: 2 * M] == pytest.approx(total, abs=1e-10)
    assert after == pytest.approx(u + (case.W / mass).T @ total, abs=1e-10)
    assert case.work.b[: 2 * M] == pytest.approx(rates)
    rough, posed = int(np.count_nonzero(case.friction)), case.work.posed
    level = Level.EXPANSION if np.any((eps > 0.0) & (first[::2] > 0.0)) else Level.COMPRESSION
    assert (posed.contacts, posed.elements, posed.bearings, posed.level) == (M, rough, 0, level)
    gained, terms = in_python(impact.energy_change)(M, case.work)
    assert gained == pytest.approx(0.5 * float(mass @ (after**2 - u**2)), abs=1e-12)
    by_hand = np.abs(total) @ np.abs(rates) + 0.5 * np.abs(total) @ np.abs(G @ total)
    assert terms == pytest.approx(by_hand)


@pytest.mark.parametrize("seed", range(8))
def test_over_a_time_what_forces_would_do_is_stopped_too(seed: int) -> None:
    rng = np.random.default_rng(seed)
    case = Sparse(rng, M, N, friction=0.25, slots=(5, 7))
    u, time = rng.normal(size=N), float(rng.uniform(0.3, 0.9))
    rates = case.W @ (u + time * case.work.h * case.work.inverse) + time * case.bars
    case.work.b[2 * M :] = 5.0
    assert in_python(impact.plastic_impact)(case.model, case.closed, M, time, u, case.work)
    assert np.all(case.work.b[2 * M :] == 5.0)
    assert case.work.force[: 2 * M] == pytest.approx(compressed(case.G, rates, case.friction), abs=1e-10)
    posed = case.work.posed
    assert (posed.contacts, posed.elements, posed.bearings, posed.level) == (M, M, 0, Level.COMPRESSION)


@pytest.mark.parametrize("share", [0.9, -0.9, 1.1, -1.1])
def test_rates_that_are_rounding_of_their_terms_are_zero(share: float) -> None:
    """Each row by the lever arms of its contact, normal and tangential."""
    rng = np.random.default_rng(3)
    case = Sparse(rng, 3, 6)
    u = rng.normal(size=6)
    terms = (np.abs(case.W[::2]) + np.abs(case.W[1::2])) @ np.abs(u)
    rates = np.repeat(share * 4e-15 * terms, 2)
    rates[4] = 0.1
    rates[1] *= 2.0
    expected = rates.copy()
    if abs(share) < 1.0:
        expected[[0, 2, 3, 5]] = 0.0
    in_python(impact._drop_rounding)(case.closed, 3, u, rates)
    assert np.array_equal(rates, expected)
