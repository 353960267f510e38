"""What is left behind where no impulses are found, and what does the plastic impact over a time come to?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python
from random_contacts import random_case

from watchsim.dynamics import impact as impacts


@pytest.mark.parametrize("solved", [(False, True), (True, False), (True, True)])
def test_directions_are_put_back_whether_an_impact_is_solved_or_not(solved: tuple[bool, bool]) -> None:
    """All 2 m rows, once; velocities are changed, by all impulses, only where both phases are solved."""
    m, put_back, applied = 3, [], []
    work = SimpleNamespace(force=np.array([1.0, 0.5, 0.0, 0.0, 2.0, -0.25]), more=np.arange(6.0), b=object(), inverse=None)
    kernel = in_python(
        impacts.impact,
        _compress=lambda *_: (solved[0], 2),
        _expand=lambda *_: solved[1],
        restore_directions=lambda work, rows, b: put_back.append((rows, b)),
        apply=lambda closed, m, force, inverse, u: applied.append((m, force.tolist())),
    )
    assert kernel(None, None, m, np.array([0.0, 0.5, 0.3]), 0.0, work, None) is all(solved)
    assert put_back == [(2 * m, work.b)]
    assert applied == ([(m, [1.0, 1.5, 2.0, 3.0, 6.0, 4.75])] if all(solved) else [])


@pytest.mark.parametrize("restitution", [(0.0, 0.5, 0.0), (0.0, 0.0, 0.0)])
def test_without_restitution_where_something_was_hit_there_is_no_expansion(restitution: tuple[float, ...]) -> None:
    """The one that could rebound carries no impulse."""
    work = SimpleNamespace(force=np.array([1.0, 0.5, 0.0, 0.0, 2.0, -0.25]), more=np.zeros(6), b=None, inverse=None)

    def expand(*_):
        raise AssertionError

    kernel = in_python(
        impacts.impact,
        _compress=lambda *_: (True, 2),
        _expand=expand,
        restore_directions=lambda *_: None,
        apply=lambda *_: None,
    )
    assert kernel(None, None, 3, np.array(restitution), 0.0, work, None)


@pytest.mark.parametrize(("m", "n"), [(1, 3), (2, 6), (3, 6), (4, 8)])
def test_the_plastic_impact_over_a_time_obeys_the_laws_at_the_rates_that_free_motion_leads_to(m: int, n: int) -> None:
    """Signorini and Coulomb, from the matrices alone; the rates are left as they were found."""
    rng = np.random.default_rng(10 * m + n)
    solved = 0
    for _ in range(20):
        case, u, time = random_case(rng, m, n), rng.normal(size=n), rng.uniform(0.1, 1.0)
        work = case.work
        work.h[:n], work.inverse[:n] = rng.normal(size=n), 1.0 / case.mass
        free = case.W @ (u + time * work.h[:n] / case.mass)
        if not in_python(impacts.plastic_impact)(case.model, case.closed, m, time, u, work):
            continue
        solved += 1
        force = work.force[: 2 * m]
        after = free + case.G @ force
        scale = np.abs(free).max()
        np.testing.assert_allclose(work.b[: 2 * m], free, atol=1e-12 * scale)
        N, T, opening, slip = force[::2], force[1::2], after[::2], after[1::2]
        assert N.min() >= 0.0 and opening.min() >= -1e-9 * scale
        assert np.abs(N * opening).max() <= 1e-9 * scale * max(1.0, N.max())
        assert np.all(np.abs(T) <= case.friction * N + 1e-9)
        sliding = np.abs(slip) > 1e-9 * scale
        np.testing.assert_allclose(T[sliding], -np.sign(slip[sliding]) * (case.friction * N)[sliding], atol=1e-9)
    assert solved >= 15


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_rates_are_dropped_that_are_the_rounding_of_their_terms(scale: float) -> None:
    """In any unit of speed."""
    case = random_case(np.random.default_rng(3), 2, 3)
    u = scale * np.array([0.3, -2.0, 0.7])
    terms = (np.abs(case.W) @ np.abs(u)).reshape(2, 2).sum(axis=1)
    rounding = np.repeat(4e-15 * terms, 2)
    rates = rounding * np.array([0.9, -1.1, -0.9, 1.1])
    kept = rates.copy()
    in_python(impacts._drop_rounding)(case.closed, 2, u, rates)
    np.testing.assert_array_equal(rates, np.where(np.abs(kept) <= rounding, 0.0, kept))
    assert np.count_nonzero(rates) == 2
