"""Is an impact what the laws of Poisson and Coulomb and their tangential variants say?"""

import numpy as np
import pytest
from every_time import few
from naive.impact_oracle import compressed, expanded
from plain_kernels import in_python
from random_contacts import Case, random_case
from reference.single_impact import single_impact
from sparse_contacts import Sparse

from watchsim.contact.gaps import BACKWARD, FORWARD
from watchsim.dynamics import impact
from watchsim.dynamics.lcp import Level
from watchsim.model import COULOMB, PG1996, SHIFTED
from watchsim.verification.random_problems import BareContacts

# Is an impact what Poisson's and Coulomb's laws say? Closed forms for one contact; for several, the laws themselves.

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


# Do the three tangential laws say what they promise? One contact in closed form; several by the laws themselves.

LAWS = ("coulomb", "pg1996", "shifted")


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
def test_one_contact_in_closed_form_tangential_laws(law: str) -> None:
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


# Are impacts of two contacts those of the published complementarity problems, whose bases are tried one by one?

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
    case.work.system.inverse[:], after = np.nan, u.copy()
    system, problem, phases = case.work.system, case.work.problem, case.work.phases
    assert in_python(impact.impact)(case.model, case.closed, M, eps, (0.0, 0.0), system, problem, phases, after)
    assert phases.impulse[: 2 * M] == pytest.approx(total, abs=1e-10)
    assert after == pytest.approx(u + (case.W / mass).T @ total, abs=1e-10)
    assert phases.rates[: 2 * M] == pytest.approx(rates)
    rough, posed = int(np.count_nonzero(case.friction)), problem.last
    level = Level.EXPANSION if np.any((eps > 0.0) & (first[::2] > 0.0)) else Level.COMPRESSION
    assert (posed.contacts, posed.elements, posed.bearings, posed.level) == (M, rough, 0, level)
    gained, terms = in_python(impact.energy_gain)(2 * M, system.G, phases.rates, phases.impulse)
    assert gained == pytest.approx(0.5 * float(mass @ (after**2 - u**2)), abs=1e-12)
    by_hand = np.abs(total) @ np.abs(rates) + 0.5 * np.abs(total) @ np.abs(G @ total)
    assert terms == pytest.approx(by_hand)


@pytest.mark.parametrize("seed", range(8))
def test_over_a_time_what_forces_would_do_is_stopped_too(seed: int) -> None:
    rng = np.random.default_rng(seed)
    case = Sparse(rng, M, N, friction=0.25, slots=(5, 7))
    u, time = rng.normal(size=N), float(rng.uniform(0.3, 0.9))
    system, problem, phases = case.work.system, case.work.problem, case.work.phases
    rates = case.W @ (u + time * system.h * system.inverse) + time * case.bars
    system.b[2 * M :] = 5.0
    assert in_python(impact.plastic_impact)(case.model, case.closed, M, time, 0.0, u, system, problem, phases)
    assert np.all(system.b[2 * M :] == 5.0)
    assert phases.impulse[: 2 * M] == pytest.approx(compressed(case.G, rates, case.friction), abs=1e-10)
    posed = problem.last
    assert (posed.contacts, posed.elements, posed.bearings, posed.level) == (M, M, 0, Level.COMPRESSION)


# Do contacts and their mirror image, with the contacts in any order, get the same impulses and modes?

PROBLEMS = 300


def problem(rng: np.random.Generator) -> tuple[BareContacts, BareContacts, np.ndarray, np.ndarray]:
    """Contacts, their mirror image in another order, the signs of its tangents, and which of ours each of its contacts is."""
    m = int(rng.integers(2, 4))
    n = int(rng.integers(2, 4))
    mass = rng.uniform(0.5, 2.0, n)
    W = rng.normal(size=(2 * m, n))
    mu, eps = rng.uniform(0.2, 1.2, m), rng.uniform(0.0, 0.9, m)
    order = rng.permutation(m)
    sign = rng.choice([-1.0, 1.0], m)
    image = np.stack([row for i in order for row in (W[2 * i], sign[i] * W[2 * i + 1])])
    return BareContacts(mass, W, mu, eps), BareContacts(mass, image, mu[order], eps[order]), sign, order


@pytest.mark.parametrize("seed", few(range(4), 2))
def test_impulses_do_not_depend_on_the_orientation(seed: int) -> None:
    rng, solved = np.random.default_rng(seed), 0
    for _ in range(PROBLEMS):
        contacts, image, _, _ = problem(rng)
        u = rng.normal(size=contacts.n)
        found, after, _ = contacts.impact(u)
        other_found, other, _ = image.impact(u)
        assert found == other_found
        if found:
            solved += 1
            np.testing.assert_allclose(other, after, rtol=0.0, atol=1e-9 * np.abs(u).max())
    assert solved > 0.9 * PROBLEMS


def test_modes_do_not_depend_on_the_orientation() -> None:
    rng = np.random.default_rng(7)
    for _ in range(PROBLEMS):
        contacts, image, sign, order = problem(rng)
        h = rng.normal(size=contacts.n)
        solved, mode = contacts.modes(np.zeros(contacts.n), h, 1.0)
        other_solved, other = image.modes(np.zeros(contacts.n), h, 1.0)
        assert solved == other_solved
        if solved:
            expected = [mode[i] * (sign[i] if mode[i] in (FORWARD, BACKWARD) else 1) for i in order]
            assert list(other) == expected
