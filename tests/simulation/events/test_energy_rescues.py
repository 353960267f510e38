"""What is done with an impact that gains energy, by made-up impacts, and what counts as explained?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics.impact import energy_change
from watchsim.simulation.events import collision
from watchsim.simulation.events.impulse_check import is_explained, kinetic_energy

KINETIC, BEFORE = 2.0, np.array([1.0, -2.0])


def solved(gains: list[float], terms: float = 1.0, fails_at: int = 9) -> tuple[bool, list[list[float]], SimpleNamespace]:
    """(found, restitution of each attempt, counts) where attempts gain so much energy (J); all begin at the same velocities."""
    tried: list[list[float]] = []
    state = SimpleNamespace(u=np.zeros(2), counts=SimpleNamespace(lcp_failures=0, energy_rescues=0))
    room = SimpleNamespace(before=BEFORE, restitution=np.array([0.7, 0.3, 0.5, 0.1]))

    def impact(model, closed, m, restitution, jam, work, u) -> bool:
        assert u.tolist() == BEFORE.tolist() and jam == 0.25
        u[:] = 9.0
        tried.append(restitution.tolist())
        return len(tried) != fails_at

    instead = {
        "kinetic_energy": lambda model, u: KINETIC,
        "impact": impact,
        "count_problems": lambda *_: None,
        "energy_change": lambda m, work: (gains[len(tried) - 1], terms),
    }
    found = in_python(collision._solve, **instead)(None, state, 3, 0.25, None, None, room)
    return bool(found), tried, state.counts


ALL, LEAST, NONE = [0.7, 0.3, 0.5, 0.1], [0.3, 0.3, 0.3, 0.1], [0.0, 0.0, 0.0, 0.1]


@pytest.mark.parametrize("share", [-5.0, 0.9, 1.1])
def test_a_gain_beyond_rounding_is_tried_again_with_the_least_restitution_and_then_with_none(share: float) -> None:
    """A trillionth of the kinetic energy; of the three contacts that take part."""
    gain = share * 1e-12 * KINETIC
    once, twice = solved([gain, 0.0, 0.0]), solved([1.0, gain, 0.0])
    assert once[:2] == ((True, [ALL]) if share < 1.0 else (True, [ALL, LEAST]))
    assert twice[:2] == ((True, [ALL, LEAST]) if share < 1.0 else (True, [ALL, LEAST, NONE]))
    assert (once[2].energy_rescues, twice[2].energy_rescues) == ((0, 1) if share < 1.0 else (1, 2))
    assert once[2].lcp_failures == 0


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_without_restitution_a_gain_is_rounding_of_its_terms_or_wrong(share: float) -> None:
    found, tried, counts = solved([1.0, 1.0, share * 1e-12 * 50.0], terms=50.0)
    assert (found, len(tried), counts.energy_rescues) == (share < 1.0, 3, 2)


@pytest.mark.parametrize("attempt", [1, 2, 3])
def test_an_impact_that_nothing_solves_is_counted(attempt: int) -> None:
    found, tried, counts = solved([1.0, 1.0, 0.0], fails_at=attempt)
    assert (found, len(tried), counts.lcp_failures) == (False, attempt, 1)


def test_kinetic_energy_is_that_of_what_moves_by_itself() -> None:
    coordinates = [SimpleNamespace(mass=m, driven=d) for m, d in ((2.0, 0), (5.0, 1), (0.5, 0))]
    u = np.array([3.0, 7.0, -2.0])
    expected = 0.5 * (2.0 * 9.0 + 0.5 * 4.0)
    assert in_python(kinetic_energy)(SimpleNamespace(coordinates=coordinates), u) == pytest.approx(expected)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("share", [0.9, 1.1])
@pytest.mark.parametrize(("before", "highest", "speed_zero"), [(3.0, 0.0, 1e-12), (0.0, 4e6, 1e-12), (0.0, 0.0, 1e-3)])
def test_corrections_may_change_a_share_of_the_energy_and_what_is_as_slow_as_may_be_stopped(
    before: float, highest: float, speed_zero: float, share: float, sign: float
) -> None:
    """A millionth of it, a trillionth of the highest, and each coordinate at thirty times the speed that is zero."""
    coordinates = [SimpleNamespace(mass=2.0, driven=0, scale=0.5), SimpleNamespace(mass=3.0, driven=0, scale=0.25)]
    options = SimpleNamespace(speed_zero=speed_zero, size=0.5)
    slow = sum(0.5 * c.mass * (30.0 * speed_zero / options.size * c.scale) ** 2 for c in coordinates)
    allowed = 1e-6 * before + 1e-12 * highest + slow
    after = before + sign * share * allowed
    explained = in_python(is_explained)(SimpleNamespace(coordinates=coordinates), options, before, after, highest)
    assert bool(explained) == (share < 1.0)


@pytest.mark.parametrize("seed", range(4))
def test_an_impact_changes_the_energy_by_its_impulses_times_the_mean_of_the_rates(seed: int) -> None:
    """Of each row the terms count without their signs; a third contact does not take part."""
    rng = np.random.default_rng(seed)
    G, impulses, rates = rng.normal(size=(6, 6)), rng.normal(size=6), rng.normal(size=6)
    G = G @ G.T
    jumps = G[:4, :4] @ impulses[:4]
    change, terms = in_python(energy_change)(2, SimpleNamespace(G=G, force=impulses, b=rates))
    assert change == pytest.approx(float(impulses[:4] @ (rates[:4] + 0.5 * jumps)))
    assert terms == pytest.approx(float(np.abs(impulses[:4]) @ (np.abs(rates[:4]) + 0.5 * np.abs(jumps))))
