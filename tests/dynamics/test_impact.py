"""Is an impact what Poisson's and Coulomb's laws say? Closed forms for one contact; for several, the laws themselves."""

from __future__ import annotations

import numpy as np
import pytest
from random_contacts import Case, random_case
from reference.single_impact import single_impact

SMALL = 1e-9  # share of the impulses or rates involved that counts as zero in a law checked afterwards


def rates(case: Case, u: np.ndarray) -> np.ndarray:
    return case.W @ u


def singles(count: int) -> list[tuple[Case, np.ndarray]]:
    """Approaching single contacts that cannot jam, on 3 coordinates."""
    rng = np.random.default_rng(41)
    found = []
    while len(found) < count:
        case, u = random_case(rng, 1, 3), rng.normal(size=3)
        if rates(case, u)[0] < 0.0 and case.friction[0] * abs(case.G[0, 1]) < 0.95 * case.G[0, 0]:
            found.append((case, u))
    return found


def test_one_contact_in_closed_form() -> None:
    regimes = set()
    for case, u in singles(400):
        solved, after, force = case.impact(u)
        before = rates(case, u)
        G = (case.G[0, 0], case.G[0, 1], case.G[1, 1])
        truth = single_impact(G, tuple(before), case.friction[0], case.restitution[0])
        regimes.add(truth.regime)
        scale = np.abs(before).max() * max(1.0, case.G.max() / case.G[0, 0])
        size = max(truth.normal, abs(truth.tangential))
        assert solved
        assert force == pytest.approx([truth.normal, truth.tangential], abs=1e-12 * size)
        assert rates(case, after) == pytest.approx([truth.v_n, truth.v_t], abs=1e-11 * scale)
        assert after == pytest.approx(u + case.W.T @ force / case.mass, abs=1e-13 * (1.0 + np.abs(after).max()))
    assert regimes == {"stick", "slip"}


def test_energy_is_what_the_velocities_say() -> None:
    for case, u in singles(200):
        _, after, _ = case.impact(u)
        lost = case.kinetic(after) - case.kinetic(u)
        assert case.energy_change() == pytest.approx(lost, abs=1e-12 * case.kinetic(u))
        assert lost <= 1e-13 * case.kinetic(u)


def test_without_friction_a_single_contact_obeys_newton() -> None:
    rng = np.random.default_rng(42)
    for _ in range(200):
        case, u = random_case(rng, 1, 3, mu=0.0), rng.normal(size=3)
        before = rates(case, u)
        solved, after, force = case.impact(u)
        assert solved
        assert force[1] == 0.0
        expected = -case.restitution[0] * before[0] if before[0] < 0.0 else before[0]
        assert rates(case, after)[0] == pytest.approx(expected, abs=1e-12)


def test_separating_contacts_do_nothing() -> None:
    rng = np.random.default_rng(43)
    case = random_case(rng, 3, 6)
    u = np.linalg.lstsq(case.W[::2], np.ones(3), rcond=None)[0]
    solved, after, force = case.impact(u)
    assert solved
    assert np.all(force == 0.0)
    assert np.array_equal(after, u)


def coulomb_holds(normal: np.ndarray, tangential: np.ndarray, slip: np.ndarray, mu: np.ndarray, scale: float) -> bool:
    """|T| <= mu N, and T = -mu N sgn(slip) where there is slip; impulses of size 1, slips of size `scale`."""
    within = np.all(np.abs(tangential) <= mu * normal + SMALL)
    sliding = np.abs(slip) > SMALL * scale
    return bool(within and np.all(np.abs(tangential + mu * normal * np.sign(slip))[sliding] <= SMALL))


def complementary(x: np.ndarray, y: np.ndarray) -> bool:
    """x, y >= 0 and never both positive; both of size 1."""
    return bool(np.all(x >= -SMALL) and np.all(y >= -SMALL) and np.all(np.minimum(x, y) <= SMALL))


@pytest.mark.parametrize(("m", "n"), [(2, 3), (2, 6), (3, 3), (3, 6), (4, 3)])
def test_several_contacts_obey_the_laws_of_both_phases(m: int, n: int) -> None:
    """Equal restitution and friction up to 0.6: solvable, and no draw may gain energy (docs/theory/method.md 2.7)."""
    rng = np.random.default_rng(100 * m + n)
    solved = 0
    for _ in range(150):
        case, u = random_case(rng, m, n), rng.normal(size=n)
        if rates(case, u)[::2].min() >= 0.0:
            continue
        found, middle, compression = case.impact(u, np.zeros(m))
        if not found:
            continue
        found, after, total = case.impact(u)
        if not found:
            continue
        solved += 1
        unit = max(np.abs(total).max(), np.abs(compression).max())
        scale = max(np.abs(rates(case, v)).max() for v in (u, middle, after))
        N_C, T_C = compression[::2] / unit, compression[1::2] / unit
        v_C = rates(case, middle)
        assert complementary(N_C, v_C[::2] / scale)
        assert coulomb_holds(N_C, T_C, v_C[1::2], case.friction, scale)
        N_E, T_E = total[::2] / unit - N_C, total[1::2] / unit - T_C
        v_E = rates(case, after)
        assert complementary(N_E - case.restitution * N_C, v_E[::2] / scale)
        assert coulomb_holds(N_E, T_E, v_E[1::2], case.friction, scale)
        assert np.all(total[::2] / unit >= (1.0 + case.restitution) * N_C - SMALL)
        assert case.kinetic(middle) <= case.kinetic(u) * (1.0 + 1e-12)
        assert case.kinetic(after) <= case.kinetic(u) * (1.0 + 1e-12)
    assert solved >= 100


def test_nearly_every_impact_is_solved() -> None:
    """Two frictional contacts on three coordinates, friction up to 0.6: the method paper saw no failure in 3000 draws."""
    rng = np.random.default_rng(77)
    failed = sum(not random_case(rng, 2, 3).impact(rng.normal(size=3))[0] for _ in range(600))
    assert failed == 0


def test_two_contacts_without_friction_return_independent_shares() -> None:
    """Perpendicular directions do not feel one another: each rebounds by its own coefficient."""
    W = np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 2.0], [0.0, 0.0]])
    case = Case(np.array([2.0, 0.5]), W, np.zeros(2), np.array([0.25, 0.75]))
    solved, after, _ = case.impact(np.array([-3.0, -1.0]))
    assert solved
    assert after == pytest.approx([0.75, 0.75], abs=1e-14)


def test_newtons_cradle_of_equal_balls_at_once() -> None:
    """Three balls in a row touch, the first one comes: by Poisson's law the outer two leave, momentum and energy in balance."""
    W = np.array([[-1.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, -1.0, 1.0], [0.0, 0.0, 0.0]])
    case = Case(np.ones(3), W, np.zeros(2), np.ones(2))
    solved, after, force = case.impact(np.array([1.0, 0.0, 0.0]))
    # Compression makes all move with 1/3: impulses 2/3 and 1/3, both doubled by the expansion.
    assert solved
    assert force[::2] == pytest.approx([4.0 / 3.0, 2.0 / 3.0], abs=1e-14)
    assert after == pytest.approx([-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0], abs=1e-14)


def test_a_rotor_on_a_stop_has_a_singular_matrix() -> None:
    """One coordinate, one contact: G_c² = G_n G_t. Friction helps the compression and hinders the expansion.

    At the end of the compression everything stands still, so that Coulomb's law allows any friction tau Lam_N, |tau| <= mu,
    in it: the rebound eps (a - mu |b|) / (a + tau b) lies between that of full sliding (tau b = mu |b|) and eps.
    """
    a, mu, eps = 1.5, 0.2, 0.5
    for b in (-0.4, 0.4):
        case = Case(np.array([0.3]), np.array([[a], [b]]), np.array([mu]), np.array([eps]))
        solved, after, force = case.impact(np.array([-2.0]))
        assert solved
        sliding = (a - mu * abs(b)) / (a + mu * abs(b))
        assert sliding * (1.0 - 1e-12) <= after[0] / (2.0 * eps) <= 1.0 + 1e-12
        assert abs(force[1]) <= mu * force[0] * (1.0 + 1e-12)


def test_redundant_contacts_share_one_impulse() -> None:
    """The same contact twice: the velocities are those of one."""
    W = np.array([[0.0, 1.0], [1.0, 0.0]])
    mass, mu, eps = np.array([1.0, 2.0]), np.array([0.3]), np.array([0.4])
    once = Case(mass, W, mu, eps)
    twice = Case(mass, np.vstack([W, W]), np.repeat(mu, 2), np.repeat(eps, 2))
    u = np.array([1.0, -1.5])
    truth, double = once.impact(u), twice.impact(u)
    assert double[0]
    assert double[1] == pytest.approx(truth[1], abs=1e-13)


def test_a_disc_that_slides_down_a_wall_meets_the_floor() -> None:
    """Friction 1, both walls: exactly at rest towards the wall it is not pushed against it, which would make it jam.

    The floor turns it back: with both contacts pressed it can neither roll nor go on, and stands still or leaves the wall.
    """
    m, r = 0.01, 7.9e-3
    W = np.array([[-1.0, 0.0, 0.0], [0.0, 1.0, r], [0.0, 1.0, 0.0], [-1.0, 0.0, r]])
    case = Case(np.array([m, m, 0.5 * m * r * r]), W, np.ones(2), np.zeros(2))
    u = np.array([0.0, -0.0225, -2.84])
    assert (W @ u)[0] == 0.0
    solved, after, force = case.impact(u)
    assert solved
    after_rates = rates(case, after)
    assert np.all(after_rates[::2] >= -1e-12) and np.all(force[::2] >= 0.0)
    assert np.all(np.abs(force[1::2]) <= force[::2] * (1.0 + 1e-12))
    assert case.mass * (after - u) == pytest.approx(W.T @ force, abs=1e-12)
    assert case.energy_change() < 0.0
