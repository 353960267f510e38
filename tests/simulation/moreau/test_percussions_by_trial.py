"""Do relaxation and Newton's method find the percussions that trying all bases finds, and impacts those of the other solver?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from naive.impact_oracle import compressed, expanded
from plain_kernels import in_python
from sparse_contacts import Sparse

from watchsim.model.records import COULOMB, PG1996, SHIFTED
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.moreau import mobility, percussion_laws, percussions, projected_newton, prox_relaxation
from watchsim.simulation.moreau.percussion_laws import Laws, laws

M, N, K = 2, 7, 3
RELAX, FINISH, EQUATION = (
    in_python(kernel) for kernel in (prox_relaxation.relax, projected_newton.finish, projected_newton._equation)
)


def room_of(case: Sparse, dry: list[int]) -> SimpleNamespace:
    """Room of a step for these contacts and bearings."""
    rows = 2 * case.m + len(dry)
    made = laws(case.m, len(dry))
    for values in made[:-1]:
        values[:] = np.nan
    arrays = {name: np.full(case.n, np.nan) for name in ("u", "inverse", "change")}
    more = {name: np.full(rows, np.nan) for name in ("rates", "more")}
    work = SimpleNamespace(closed=case.closed, laws=made, dry=dry, restitution=np.full(case.m, np.nan), **arrays, **more)
    work.kept = SimpleNamespace(sweeps=0, violation=0.0)
    return work


@pytest.mark.parametrize("dry", [[], [4], [5, 1, 0]])
def test_percussions_move_by_whole_matrices_bearings_behind_contacts(dry: list[int]) -> None:
    rng = np.random.default_rng(len(dry))
    case, count = Sparse(rng, M, N), len(dry)
    work, rows = room_of(case, dry), 4 + count
    both = np.vstack([case.W, np.eye(N)[dry]])
    work.inverse[:] = case.work.inverse
    in_python(mobility.fill_mobility)(work, M, count)
    np.testing.assert_allclose(work.laws.G, both * work.inverse @ both.T, atol=1e-14)
    u, P, rates = rng.normal(size=N), rng.normal(size=rows), np.full(rows, np.nan)
    in_python(mobility.rates_of)(work, M, count, u, rates)
    assert rates == pytest.approx(both @ u)
    after = u.copy()
    in_python(mobility.push)(work, M, count, P, after)
    assert after == pytest.approx(u + work.inverse * (both.T @ P))


def random_laws(seed: int, bearings: int) -> Laws:
    """Three contacts and so many bearings; every row has limits of its own, two contacts a least normal percussion.

    Every other time everything is a million times heavier.
    """
    rng = np.random.default_rng(seed)
    made, rows = laws(K, bearings), 2 * K + bearings
    half = rng.normal(size=(rows, rows + 2))
    made.G[:], made.b[:] = half @ half.T, rng.normal(size=rows)
    made.low[:] = 0.0, 0.1, 0.05
    for i in range(K):
        made.ends[i] = -0.02 * i, -rng.uniform(0.1, 0.4), 0.03 * i, rng.uniform(0.1, 0.4)
    made.ends[K:, 0], made.ends[K:, 2] = -rng.uniform(0.01, 0.2, bearings), rng.uniform(0.01, 0.2, bearings)
    made.P[:] = rng.normal(size=rows)
    unit = heavy(seed)
    made.G[:] /= unit
    for values in (made.low, made.ends[:, 0], made.ends[:, 2], made.P):
        np.multiply(values, unit, out=values)
    return made


def heavy(seed: int) -> float:
    return 1e6 if seed % 2 else 1.0


def projections(made: Laws, P: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(what would end each rate, the least, the most) by the words of percussion_laws.py."""
    wanted = P - (made.b + made.G @ P) / np.diag(made.G)
    least, most = np.empty(len(P)), np.empty(len(P))
    for i in range(K):
        least[2 * i], most[2 * i] = made.low[i], np.inf
        least[2 * i + 1] = made.ends[i, 0] + made.ends[i, 1] * P[2 * i]
        most[2 * i + 1] = made.ends[i, 2] + made.ends[i, 3] * P[2 * i]
    least[2 * K :], most[2 * K :] = made.ends[K:, 0], made.ends[K:, 2]
    return wanted, least, most


@pytest.mark.parametrize("bearings", [0, 2])
@pytest.mark.parametrize("seed", range(8))
def test_settled_percussions_are_their_own_projections(seed: int, bearings: int) -> None:
    """By sweeps, and by Newton's method alone; the share that is told is the naive one."""
    made, rows = random_laws(seed, bearings), 2 * K + bearings
    root = np.sqrt(np.diag(made.G))
    wanted, least, most = projections(made, made.P)
    size = max((np.abs(made.P) * root).max(), (np.abs(made.b) / root).max())
    naive = (np.abs(np.clip(wanted, least, most) - made.P) * root).max() / size
    assert in_python(percussion_laws.residual)(made, K, rows) == pytest.approx(naive)
    assert in_python(percussion_laws.size)(made, rows, made.P) == pytest.approx(size)
    sweeps, settled = RELAX(made, K, bearings)
    assert settled and sweeps > 1
    found = made.P.copy()
    unit = heavy(seed)
    assert found / unit == pytest.approx(np.clip(*projections(made, found)) / unit, abs=1e-11)
    made.P[:] += 1e-4 * unit
    assert FINISH(made, K, rows, 1e-12)
    np.testing.assert_allclose(made.P / unit, found / unit, atol=1e-10)
    start = made.P + 0.3 * unit
    made.P[:] = start
    if not FINISH(made, K, rows, 0.0):
        assert np.array_equal(made.P, start)  # left alone where modes go on changing, or rounding remains


@pytest.mark.parametrize("seed", range(12))
def test_newton_s_equations_are_slopes_of_what_percussions_are_short_of(seed: int) -> None:
    """By central quotients; a row that nothing moves keeps its percussion."""
    bearings, rows = 1, 7
    made, rng = random_laws(seed, bearings), np.random.default_rng(seed)
    if seed % 3 == 0:
        made.G[6, :] = made.G[:, 6] = 0.0
    unit = heavy(seed)
    P = 0.3 * unit * rng.normal(size=rows)
    P[:6:2] = np.abs(P[:6:2]) + 0.2 * unit  # wide cones
    made.trial[:] = P
    own, h = np.diag(made.G).copy(), 1e-7 * unit
    own[own == 0.0] = 1.0

    def short_of(percussions: np.ndarray) -> np.ndarray:
        with np.errstate(divide="ignore", invalid="ignore"):
            return own * (np.clip(*projections(made, percussions)) - percussions)

    slopes = np.array([(short_of(P + h * e) - short_of(P - h * e)) / (2.0 * h) for e in np.eye(rows)]).T
    for row in range(rows):
        made.J[row] = np.nan
        short = EQUATION(made, K, rows, row)
        if made.G[row, row] == 0.0:
            assert (short, made.right[row], made.scale[row]) == (0.0, 0.0, 1.0)
            assert made.J[row].tolist() == np.eye(rows)[row].tolist()
            continue
        assert unit * made.J[row] == pytest.approx(-unit * slopes[row], abs=1e-6)
        assert made.right[row] == pytest.approx(short_of(P)[row])
        assert made.scale[row] == pytest.approx(own[row] ** -0.5)
        assert short == pytest.approx(abs(short_of(P)[row]) / own[row] ** 0.5)


def stopped(case: Sparse, u: np.ndarray, slowest: float) -> tuple[bool, SimpleNamespace, SimpleNamespace, np.ndarray]:
    """(is any written down?, room, state, events) of the impacts at the start of a step."""
    work, sums = room_of(case, []), SimpleNamespace(drive=0.5, impacts=0.25)
    counts = SimpleNamespace(lcp=0, lcp_sizes=[0] * 6, lcp_failures=0, energy_rescues=0, impacts=0, events=0)
    state = SimpleNamespace(u=u, sums=sums, counts=counts, clock=SimpleNamespace(time=3.5))
    record = SimpleNamespace(events=np.zeros(4, EVENT_DTYPE).view(np.recarray), used=SimpleNamespace(events=0))
    options = SimpleNamespace(accumulation_speed=slowest)
    written = in_python(percussions.stop_approaches)(case.model, state, options, case.m, work, record)
    return bool(written), work, state, record.events[: record.used.events]


@pytest.mark.parametrize("kind", [COULOMB, SHIFTED, PG1996])
@pytest.mark.parametrize("seed", range(6))
def test_impacts_are_those_of_the_complementarity_problems(seed: int, kind: int) -> None:
    """With a driven coordinate, whose drive works against the percussions; the books close."""
    rng = np.random.default_rng(seed)
    case = Sparse(rng, M, N, friction=0.25, slots=(5, 7))
    given = case.model.laws
    given.kind, given.tangential, given.nu = kind, rng.uniform(0.1, 0.9, 2 * M), rng.uniform(0.1, 0.9, 2 * M)
    given.restitution = rng.uniform(0.3, 0.9)
    case.model.coordinates.driven[2], case.work.inverse[2] = 1, 0.0
    eps, u, mass = case.laws.restitution, rng.normal(size=N), case.model.coordinates.mass
    u -= (case.W * case.work.inverse).T @ np.linalg.solve(case.G, case.W @ u + [1.2, 0.3, 0.4, -0.5])
    rates, G = case.W @ u, case.G
    first = compressed(G, rates, case.friction)
    total = first + expanded(G, rates, first, eps, case.laws)
    after = u + (case.W * case.work.inverse).T @ total
    written, work, state, events = stopped(case, u.copy(), 0.8)
    if state.counts.energy_rescues == 0:
        assert work.u == pytest.approx(after, abs=1e-9)
        np.testing.assert_allclose(work.laws.P, total, atol=1e-9)
    P, mean = work.laws.P, 0.5 * (rates + case.W @ work.u)
    lost = [-float(P[2 * i : 2 * i + 2] @ mean[2 * i : 2 * i + 2]) for i in range(M)]
    free = np.arange(N) != 2
    gained = 0.5 * float((mass * (work.u**2 - u**2))[free].sum())
    assert state.sums.impacts == pytest.approx(0.25 + sum(lost))
    assert state.sums.drive - 0.5 - (state.sums.impacts - 0.25) == pytest.approx(gained)
    assert written and events["kind"].tolist() == [EventKind.IMPACT]  # the slower one is not written down
    assert (events["contact"][0], events["t"][0], events["body"][0]) == (case.closed.ids[0], 3.5, -1)
    assert events["value"][0] == pytest.approx(rates[0]) and events["energy_lost"][0] == pytest.approx(lost[0])
    assert [events["impulse_normal"][0], events["impulse_tangential"][0]] == pytest.approx(P[:2])
    tries = 2 + state.counts.energy_rescues
    assert (state.counts.lcp, state.counts.lcp_sizes, state.counts.impacts) == (tries, [0, 0, tries, 0, 0, 0], 1)
    assert work.kept.sweeps > tries and state.counts.lcp_failures == 0 and 0.0 < work.kept.violation < 1e-12


def test_where_nothing_approaches_nothing_happens() -> None:
    case = Sparse(np.random.default_rng(1), M, N, slots=(5, 7))
    u = (case.W * case.work.inverse).T @ np.linalg.solve(case.G, [0.3, 1.0, 0.0, -2.0])
    for name, lift in (("leaves", 1e-9), ("approaches", -1e-9)):
        v = u + (case.W * case.work.inverse).T @ np.linalg.solve(case.G, [0.0, 0.0, lift, 0.0])
        written, work, state, events = stopped(case, v.copy(), 0.8)
        assert not written and len(events) == 0
        assert (state.counts.lcp == 0) == (name == "leaves")
        assert work.u == pytest.approx(v, abs=1e-8)
