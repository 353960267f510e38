"""Are impacts of two contacts those of the published complementarity problems, whose bases are tried one by one?

The matrices are those of docs/theory/method.md 2.6, put down block by block.
"""

from __future__ import annotations

import numpy as np
import pytest
from naive.lcp_oracle import solutions
from plain_kernels import in_python
from sparse_contacts import Sparse

from watchsim.dynamics import impact
from watchsim.dynamics.problem_kinds import Level
from watchsim.model.records import COULOMB, PG1996, SHIFTED

M, N = 2, 7
ZERO, ONE = np.zeros((M, M)), np.eye(M)


def blocks(G: np.ndarray) -> tuple[np.ndarray, ...]:
    """G_NN, G_NT, G_TN, G_TT."""
    return G[::2, ::2], G[::2, 1::2], G[1::2, ::2], G[1::2, 1::2]


def interval_problem(G: np.ndarray, low: np.ndarray, span: np.ndarray, right: np.ndarray) -> np.ndarray:
    """(normal unknowns, distances from the lower ends); there must be one solution alone."""
    NN, NT, TN, TT = blocks(G)
    L = np.diag(low)
    A = np.block([[NN - NT @ L, NT, ZERO], [TN - TT @ L, TT, ONE], [np.diag(span), -ONE, ZERO]])
    found = solutions(A, right, 1e-10)
    assert found and all(np.allclose(found[0], other, atol=1e-8) for other in found)
    return found[0][: 2 * M].reshape(2, M)


def compressed(G: np.ndarray, rates: np.ndarray, mu: np.ndarray) -> np.ndarray:
    normal, above = interval_problem(G, mu, 2.0 * mu, np.concatenate([rates[::2], rates[1::2], np.zeros(M)]))
    return np.ravel([normal, above - mu * normal], order="F")


def expanded(case: Sparse, G: np.ndarray, rates: np.ndarray, first: np.ndarray, eps: np.ndarray, kind: int) -> np.ndarray:
    """Impulses of the expansion: `rates` are those before the impact, `first` the impulses of the compression."""
    mu, laws = case.friction, case.model.laws[case.model.contacts[case.closed.ids[:M]].group]
    N_C, T_C, back = first[::2], first[1::2], eps * first[::2]
    NN, NT, TN, TT = blocks(G)
    offset = np.zeros(M)
    if kind == PG1996:
        forward = 0.5 * (1.0 + np.sign(T_C))
        least = eps * laws.tangential * np.abs(T_C)
        low, span, rest = (1.0 - forward) * mu, mu, mu * back - least
        shift = forward * least - (1.0 - forward) * mu * back
        shift = np.where(T_C == 0.0, -0.5 * mu * back, shift)
        offset = laws.nu * eps * laws.tangential * T_C
    else:
        share = np.minimum(laws.tangential, eps) if kind == SHIFTED else np.zeros(M)
        low, span, rest = mu, 2.0 * mu, 2.0 * mu * (eps - share) * N_C
        shift = share * T_C - mu * (eps - share) * N_C
    after = rates + G @ first
    normal = after[::2] + NN @ back + NT @ shift
    tangential = after[1::2] + TN @ back + TT @ shift - TT @ offset
    extra, above = interval_problem(G, low, span, np.concatenate([normal, tangential, rest]))
    return np.ravel([back + extra, above + shift - low * extra], order="F")


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
        laws.friction[case.model.contacts[case.closed.ids[0]].group] = case.friction[0] = 0.0
    u = rng.normal(size=N)
    u -= (case.W / mass).T @ np.linalg.solve(case.G, case.W @ u - rng.normal(size=4) * [1.0, 0.5, 1.0, 0.5] + [1.2, 0, 0.4, 0])
    rates, G = case.W @ u, case.G
    first = compressed(G, rates, case.friction)
    total = first.copy()
    if np.any((eps > 0.0) & (first[::2] > 0.0)):
        total += expanded(case, G, rates, first, eps, kind)
    case.work.inverse[:], after = np.nan, u.copy()
    assert in_python(impact.impact)(case.model, case.closed, M, eps, 0.0, case.work, after)
    assert case.work.force[: 2 * M] == pytest.approx(total, abs=1e-10)
    assert after == pytest.approx(u + (case.W / mass).T @ total, abs=1e-10)
    assert case.work.b[: 2 * M] == pytest.approx(rates)
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
    assert in_python(impact.plastic_impact)(case.model, case.closed, M, time, u, case.work)
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
