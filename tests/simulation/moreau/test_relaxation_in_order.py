"""When does relaxation end, when is Newton's method tried, and what becomes of an impact that gains energy?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.model.records import COULOMB, PG1996, SHIFTED
from watchsim.simulation.moreau import percussions, projected_newton, prox_relaxation

SIZE, SETTLED = 7.0, 1e-13
MANY = 200  # sweeps at each pace, in place of twenty thousand


def relaxed(changes: Any, newton: int = 0) -> tuple[tuple[int, bool], list[float], list[int]]:
    """((sweeps, settled?), the pace of each sweep, sweeps after which Newton's method was tried).

    `changes(sweep)` is the largest change in a sweep; Newton's method works when it is tried the `newton`th time.
    """
    paces: list[float] = []
    tried: list[int] = []

    def sweep(laws: object, m: int, rows: int, pace: float) -> float:
        assert (m, rows) == (3, 8)
        paces.append(pace)
        return float(changes(len(paces)))

    def finish(laws: object, m: int, rows: int, settled: float) -> bool:
        assert (m, rows, settled) == (3, 8, SETTLED)
        tried.append(len(paces))
        return len(tried) == newton

    instead = {"_sweep": sweep, "finish": finish, "size": lambda laws, rows, P: SIZE, "SWEEPS": MANY}
    found = in_python(prox_relaxation.relax, **instead)(SimpleNamespace(P=None), 3, 2)
    return found, paces, tried


def test_it_ends_when_a_sweep_changes_nothing_but_rounding() -> None:
    assert relaxed(lambda n: 1.1 * SETTLED * SIZE if n < 5 else 0.9 * SETTLED * SIZE)[0] == (5, True)
    assert relaxed(lambda n: 0.0)[0] == (1, True)


def test_newton_s_method_is_tried_after_twice_as_many_sweeps_each_time() -> None:
    found, _, tried = relaxed(lambda n: 1.0, newton=3)
    assert found == (128, True) and tried == [32, 64, 128]


def test_where_it_goes_round_in_circles_smaller_paces_are_taken_four_in_all() -> None:
    found, paces, tried = relaxed(lambda n: 1.0)
    assert found == (4 * MANY, False)
    assert paces[::MANY] == pytest.approx([1.0, 0.4, 0.16, 0.064]) and len(set(paces)) == 4
    assert tried == [MANY * k + n for k in range(4) for n in (32, 64, 128)]


@pytest.mark.parametrize("pace", [1.0, 0.4])
def test_a_sweep_improves_one_percussion_after_another(pace: float) -> None:
    """The change that is told is that of a full pace; rows that nothing moves are left alone."""
    G = np.diag([4.0, 0.0, 9.0, 1e-6])
    laws = SimpleNamespace(G=G, P=np.array([1.0, 2.0, 3.0, 4.0]))

    def improved(laws: Any, m: int, rows: int, row: int, P: np.ndarray) -> float:
        assert (m, rows) == (2, 4) and P is laws.P
        return float(P.sum() * [0.1, 9.0, -0.2, 0.5][row])

    change = in_python(prox_relaxation._sweep, improved=improved)(laws, 2, 4, pace)
    P, largest = [1.0, 2.0, 3.0, 4.0], 0.0
    for row, share in ((0, 0.1), (2, -0.2), (3, 0.5)):
        step = share * sum(P) - P[row]
        largest = max(largest, abs(step) * G[row, row] ** 0.5)
        P[row] += pace * step
    assert laws.P.tolist() == pytest.approx(P) and change == pytest.approx(largest)


@pytest.mark.parametrize(("shorts", "found"), [([1.0] * 20, False), ([1.0] * 19 + [0.0], True), ([0.0], True)])
def test_newton_s_method_guesses_twenty_modes(shorts: list[float], found: bool) -> None:
    """And leaves percussions alone where none of them fits."""
    left = iter(shorts)
    laws = SimpleNamespace(P=np.array([3.0]), trial=np.zeros(1), step=np.array([0.5]))
    laws.J = laws.right = laws.scale = laws.order = None
    instead = {"_equation": lambda *_: next(left), "size": lambda *_: SIZE, "solve_small": lambda *_: 1}
    assert in_python(projected_newton.finish, **instead)(laws, 1, 1, SETTLED) == found
    assert next(left, None) is None
    assert laws.P[0] == (3.0 + 0.5 * (len(shorts) - 1) if found else 3.0)


@pytest.mark.parametrize("settled", [True, False])
def test_what_relaxation_takes_is_counted(settled: bool) -> None:
    """Two contacts and three bearings; the worst residual is kept."""
    counts = SimpleNamespace(lcp=5, lcp_sizes=[0] * 6, lcp_failures=1)
    work = SimpleNamespace(laws="laws", kept=SimpleNamespace(sweeps=100, violation=1e-3))
    for violation in (0.25, 0.125):
        instead = {
            "relax": lambda laws, m, bearings: (17, settled) if (m, bearings) == (2, 3) else None,
            "residual": lambda laws, m, rows, violation=violation: violation if (m, rows) == (2, 7) else None,
        }
        in_python(percussions.solve_percussions, **instead)(SimpleNamespace(counts=counts), 2, 3, work)
    assert (counts.lcp, counts.lcp_sizes, counts.lcp_failures) == (7, [0, 0, 0, 2, 0, 0], 1 if settled else 3)
    assert (work.kept.sweeps, work.kept.violation) == (134, 0.25)


def test_losses_are_impulses_times_the_mean_of_rates() -> None:
    laws = SimpleNamespace(P=np.array([2.0, -3.0, 5.0, 0.7, 9.0]), b=np.array([0.3, 0.2, -0.6, 1.1, 9.0]))
    work = SimpleNamespace(laws=laws, rates=np.array([-1.0, 0.5, 0.0, 0.4, 9.0]))
    assert in_python(percussions._loss)(2, work) == pytest.approx(-0.5 * (2.0 * -0.7 - 3.0 * 0.7 + 5.0 * -0.6 + 0.7 * 1.5))


@pytest.mark.parametrize("T", [0.25, -0.25])
def test_ends_of_friction_in_the_expansion_are_those_of_the_laws(T: float) -> None:
    """Beside and per normal percussion, after N = 2 in the compression; restitution 0.6, or 0.2 below the tangential one."""
    for kind, share, expected, back in (
        (COULOMB, 0.6, (0.0, -0.4, 0.0, 0.4), 0.0),
        (SHIFTED, 0.6, (0.3 * (T + 0.8), -0.4, 0.3 * (T - 0.8), 0.4), 0.0),
        (SHIFTED, 0.2, (0.2 * (T + 0.8), -0.4, 0.2 * (T - 0.8), 0.4), 0.0),
        (PG1996, 0.6, (0.18 * T, 0.0, 0.0, 0.4) if T > 0.0 else (0.0, -0.4, 0.18 * T, 0.0), 0.18 * T),
    ):
        ends, law = np.full((3, 4), np.nan), SimpleNamespace(kind=kind, friction=0.4, tangential=0.3, nu=9.0)
        assert in_python(percussions._expansion_ends)(law, share, 2.0, T, ends, 1) == pytest.approx(back)
        assert ends[1] == pytest.approx(expected) and np.isnan(ends[[0, 2]]).all()


@pytest.mark.parametrize(
    ("losses", "shares"),
    [
        ([-0.9e-12], [(0.6, 0.3)]),
        ([-1.1e-12, 0.0], [(0.6, 0.3), (0.3, 0.3)]),
        ([-1.0, -1.0, -1.0], [(0.6, 0.3), (0.3, 0.3), (0.0, 0.0)]),
    ],
)
def test_where_energy_is_gained_the_least_restitution_is_taken_then_none(
    losses: list[float], shares: list[tuple[float, float]]
) -> None:
    """Beyond a trillionth of the kinetic energy; the velocities are those of the last try."""
    taken, left = [], iter(losses)
    laws = SimpleNamespace(P=np.zeros(4), b=np.zeros(4))
    work = SimpleNamespace(u=np.zeros(2), rates=np.array([-1.0, 0.0, 0.5, 0.0]), restitution=np.zeros(2), laws=laws)
    work.inverse, work.more, work.closed = np.zeros(2), np.array([1.0, 2.0, 3.0, 4.0]), None
    sums, counts = SimpleNamespace(drive=1.0), SimpleNamespace(energy_rescues=5)
    state = SimpleNamespace(u=np.array([3.0, 4.0]), sums=sums, counts=counts)

    def expand(model: object, state: object, m: int, work: Any) -> None:
        taken.append(tuple(work.restitution))
        work.laws.P[:] = 10.0 * len(taken)

    instead = {
        "rates_of": lambda *_: None,
        "_law": lambda model, work, i: SimpleNamespace(restitution=(0.6, 0.3)[i]),
        "inverse_mass": lambda one: one,
        "kinetic_energy": lambda model, u: 1.0,
        "fill_mobility": lambda *_: None,
        "_compress": lambda *_: None,
        "_expand": expand,
        "push": lambda work, m, b, P, u: u.__iadd__(P[:2]),
        "_loss": lambda m, work: next(left),
        "drive_through_contacts": lambda *_: 0.25,
        "_write_impacts": lambda *_: "written",
    }
    model = SimpleNamespace(coordinates=[0.5, 0.25])
    assert in_python(percussions.stop_approaches, **instead)(model, state, None, 2, work, None) == "written"
    assert taken == shares and counts.energy_rescues == 5 + len(shares) - 1
    assert work.u.tolist() == [3.0 + 10.0 * len(shares) + 1.0, 4.0 + 10.0 * len(shares) + 2.0]
    assert work.inverse.tolist() == [0.5, 0.25] and sums.drive == 1.25
