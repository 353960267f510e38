"""Do the three tangential laws say what they promise? One contact in closed form; several by the laws themselves."""

from __future__ import annotations

import numpy as np
import pytest
from random_contacts import Case, random_case
from reference.single_impact import single_impact

LAWS = ("coulomb", "pg1996", "shifted")
SMALL = 1e-9


def draws(law: str, count: int, seed: int) -> int:
    """Compare `count` random single contacts with the closed form to 1e-12; returns how many stuck in the compression."""
    rng = np.random.default_rng(seed)
    done = stuck = 0
    while done < count:
        eps = rng.uniform(0.0, 1.0)
        back = 0.0 if law == "coulomb" else rng.uniform(0.0, eps if law == "shifted" else 1.0)
        nu = rng.uniform(0.0, 1.0) if law == "pg1996" and done % 2 else 0.0
        case, u = random_case(rng, 1, 3, eps=eps, law=law, tangential=back, nu=nu), rng.normal(size=3)
        before, G = case.W @ u, case.G
        if before[0] >= 0.0 or case.friction[0] * abs(G[0, 1]) >= 0.95 * G[0, 0]:
            continue
        done += 1
        truth = single_impact((G[0, 0], G[0, 1], G[1, 1]), tuple(before), case.friction[0], eps, law, back, nu)
        stuck += truth.regime == "stick"
        solved, after, force = case.impact(u)
        size = max(truth.normal, abs(truth.tangential))
        assert solved
        # The rates before are sums whose terms cancel, and a nearly singular G costs digits in both computations.
        size += 1e-2 * (np.abs(case.W) @ np.abs(u)).max() / min(G[0, 0], G[1, 1])
        assert force == pytest.approx([truth.normal, truth.tangential], abs=1e-12 * size * max(1.0, 1e-2 * np.linalg.cond(G)))
        assert after == pytest.approx(u + case.W.T @ force / case.mass, abs=1e-12 * (1.0 + np.abs(after).max()))
        if nu == 0.0:
            assert case.kinetic(after) <= case.kinetic(u) * (1.0 + 1e-12)
    return stuck


@pytest.mark.parametrize("law", LAWS)
def test_one_contact_in_closed_form(law: str) -> None:
    assert 50 < draws(law, 700, 51) < 600


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
def test_one_contact_in_closed_form_many_times(law: str) -> None:
    assert 5_000 < draws(law, 100_000, 52) < 95_000


def bounds(case: Case, N_C: np.ndarray, T_C: np.ndarray, N_E: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest tangential impulse of the expansion, from the words of docs/theory/laws.md."""
    cone, returned = case.friction * N_E, case.restitution * case.tangential * T_C
    if case.law == "pg1996":
        # A contact that took no part in the compression has half its cone.
        low, high = np.where(T_C > 0.0, returned, -cone), np.where(T_C > 0.0, cone, returned)
        return np.where(N_C == 0.0, -0.5 * cone, low), np.where(N_C == 0.0, 0.5 * cone, high)
    if case.law == "shifted":
        centre, radius = case.tangential * T_C, case.friction * (N_E - case.tangential * N_C)
        return centre - radius, centre + radius
    return -cone, cone


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("m", "n"), [(2, 3), (2, 6), (3, 6)])
def test_several_contacts_obey_the_law_of_the_expansion(law: str, m: int, n: int) -> None:
    """Within the interval; at its lower end where the slip is forward, at its upper end where it is backward."""
    rng = np.random.default_rng(10 * m + n)
    checked = 0
    for _ in range(150):
        eps = rng.uniform(0.2, 1.0)
        back = 0.0 if law == "coulomb" else rng.uniform(0.0, eps)
        case, u = random_case(rng, m, n, eps=eps, law=law, tangential=back), rng.normal(size=n)
        if (case.W @ u)[::2].min() >= 0.0:
            continue
        _, _, compression = case.impact(u, np.zeros(m))
        solved, after, total = case.impact(u)
        if not solved:
            continue
        unit = np.abs(total).max()
        N_C, T_C = compression[::2] / unit, compression[1::2] / unit
        N_E, T_E = total[::2] / unit - N_C, total[1::2] / unit - T_C
        low, high = bounds(case, N_C, T_C, N_E)
        clear = (N_C == 0.0) | (np.abs(T_C) > 1e-6 * N_C)
        if not clear.all():
            continue
        slip, scale = (case.W @ after)[1::2], np.abs(case.W @ u).max()
        assert np.all(low - SMALL <= T_E)
        assert np.all(high + SMALL >= T_E)
        assert np.all(np.abs(T_E - low)[slip > SMALL * scale] <= SMALL)
        assert np.all(np.abs(T_E - high)[slip < -SMALL * scale] <= SMALL)
        assert case.kinetic(after) <= case.kinetic(u) * (1.0 + 1e-12)
        checked += 1
    assert checked > 80


@pytest.mark.parametrize("law", ["pg1996", "shifted"])
def test_a_sticking_superball_reverses_slip_and_loses_nothing(law: str) -> None:
    rng = np.random.default_rng(61)
    for _ in range(50):
        case, u = random_case(rng, 1, 3, mu=1e3, eps=1.0, law=law, tangential=1.0), rng.normal(size=3)
        if case.friction[0] * abs(case.G[0, 1]) >= case.G[0, 0] or (case.W @ u)[0] >= 0.0:
            W = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.3]])
            case = Case(case.mass, W, case.friction, case.restitution, law, tangential=1.0)
            u[1] = -abs(u[1])
        solved, after, _ = case.impact(u)
        assert solved
        lost = 1e-14 * case.friction[0] * np.linalg.cond(case.G)  # the problem that is solved holds mu times the friction terms
        assert case.W @ after == pytest.approx(-(case.W @ u), abs=lost)
        assert case.kinetic(after) == pytest.approx(case.kinetic(u), rel=lost, abs=0.0)
