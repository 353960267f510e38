"""Is it told rightly how far percussions are from their laws, in any units?"""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.jit import callable_kernel
from watchsim.simulation.moreau.percussion_laws import Laws, cone, laws, residual
from watchsim.simulation.moreau.prox_relaxation import relax

_cone, _residual, _relax = (callable_kernel(kernel) for kernel in (cone, residual, relax))


def random_laws(seed: int, mass: float, speed: float) -> Laws:
    """Two contacts and a bearing, inverse masses and rates of order 1 / mass and speed; percussions that nobody solved for."""
    rng = np.random.default_rng(seed)
    made, jacobian = laws(2, 1), rng.normal(size=(5, 6))
    made.G[:] = jacobian @ jacobian.T / mass
    made.b[:] = speed * rng.normal(size=5)
    made.P[:] = mass * speed * rng.normal(size=5)
    for i, friction in enumerate((0.2, 0.0)):
        _cone(made.ends, i, friction)
    made.ends[2] = -0.1 * mass * speed, 0.0, 0.1 * mass * speed, 0.0
    return made


def naive(made: Laws) -> float:
    """The distance from the projection row by row, each times the root of G's diagonal, over the largest of what there is."""
    rates, diagonal = made.b + made.G @ made.P, np.diag(made.G)
    wanted = made.P - rates / diagonal
    for i in range(2):
        wanted[2 * i] = max(wanted[2 * i], made.low[i])
        reach = made.ends[i, 3] * made.P[2 * i]
        wanted[2 * i + 1] = min(reach, max(-reach, wanted[2 * i + 1]))
    wanted[4] = np.clip(wanted[4], made.ends[2, 0], made.ends[2, 2])
    roots = np.sqrt(diagonal)
    return float((np.abs(wanted - made.P) * roots).max() / max((np.abs(made.P) * roots).max(), (np.abs(made.b) / roots).max()))


@pytest.mark.parametrize("seed", range(6))
def test_the_share_is_the_naive_one_whatever_the_units(seed: int) -> None:
    for mass, speed in ((1.0, 1.0), (1e-9, 1e-3), (1e6, 30.0)):
        made = random_laws(seed, mass, speed)
        assert _residual(made, 2, 5) == pytest.approx(naive(made), rel=1e-12)
    assert naive(random_laws(seed, 1.0, 1.0)) == pytest.approx(naive(made), rel=1e-12, abs=0.0)


def test_of_nothing_there_is_no_share() -> None:
    assert _residual(laws(2, 1), 2, 5) == 0.0


@pytest.mark.parametrize("seed", range(3))
def test_sweeps_settle_after_as_many_in_any_units(seed: int) -> None:
    """Powers of two, so that every rounding is the same; where they settle, the laws are obeyed."""
    counts = []
    for mass, speed in ((1.0, 1.0), (2.0**-30, 2.0**-10), (2.0**20, 2.0**5)):
        made = random_laws(seed, mass, speed)
        counts.append(_relax(made, 2, 1))
        assert counts[-1][1] and naive(made) < 1e-9
    assert counts[0] == counts[1] == counts[2]
