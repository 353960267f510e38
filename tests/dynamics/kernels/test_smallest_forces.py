"""Are forces that no motion decides the smallest ones that obey the laws?

Held against numpy's least squares with every set of laws at its edge, one by one.
"""

from __future__ import annotations

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics import redundant_contacts, small_systems
from watchsim.dynamics.delassus import ContactWork, contact_work

MODEL = SimpleNamespace(coordinates=[])
M = 3
TANGENT = [3, -1, 4]  # contacts 0 and 2 stick, 1 slides with a friction of 0.6
UNKNOWNS = 5
WEIGHTS = np.array([1.0, 1.0 + 0.6**2, 1.0, 1.0, 1.0])


def eliminated(rng: np.random.Generator, rank: int) -> tuple[ContactWork, np.ndarray, np.ndarray]:
    """After `solve_small` on a problem of that rank, in uneven units; its matrix and right-hand side."""
    work = contact_work(M, 4)
    half, units = rng.normal(size=(UNKNOWNS, rank)), 10.0 ** rng.uniform(-1.0, 1.0, UNKNOWNS)
    A = half @ half.T * np.outer(units, units)
    b = A @ (np.array([1.0, 0.7, 1.3, 0.1, -0.2]) / units)
    work.A[:UNKNOWNS, :UNKNOWNS], work.rhs[:UNKNOWNS], work.scale[:UNKNOWNS] = A, b, np.diag(A) ** -0.5
    work.tangent[:], work.drag[:], work.width[:M] = TANGENT, [0.0, 0.6, 0.0], [0.5, 0.0, 0.8]
    work.G[:], work.size[:] = np.eye(len(work.G)), 1.0
    solve = in_python(small_systems.solve_small)
    assert solve(work.A, work.rhs, UNKNOWNS, work.scale, work.order, work.x, 1e-11) == rank
    assert A @ work.x[:UNKNOWNS] == pytest.approx(b)
    return work, A, b


def laws(x: np.ndarray) -> np.ndarray:
    """What must not be negative: normal forces, and both sides of the cones of those that stick."""
    return np.array([*x[:3], 0.5 * x[0] - x[3], 0.5 * x[0] + x[3], 0.8 * x[2] - x[4], 0.8 * x[2] + x[4]])


def smallest(A: np.ndarray, start: np.ndarray, rank: int) -> tuple[np.ndarray, np.ndarray | None]:
    """The smallest of all forces, and the smallest that obey the laws, if any do."""
    free = np.linalg.svd(A)[2][rank:]
    free = np.linalg.solve(np.linalg.cholesky(free * WEIGHTS @ free.T), free)  # of length one in the weights
    plain = start - free.T @ (free * WEIGHTS @ start)
    room = laws(plain)
    gain = np.array([laws(row) for row in free]).T
    changes = [
        np.linalg.pinv(gain[list(edges)]) @ -room[list(edges)] if edges else np.zeros(len(free))
        for count in range(len(free) + 1)
        for edges in itertools.combinations(range(len(room)), count)
    ]
    obeyed = [change for change in changes if (room + gain @ change).min() > -1e-10]
    return plain, plain + free.T @ min(obeyed, key=np.linalg.norm) if obeyed else None


@pytest.mark.parametrize("rank", [2, 3, 4])
@pytest.mark.parametrize("seed", range(8))
def test_the_smallest_forces_that_obey_the_laws_are_taken(seed: int, rank: int) -> None:
    """By the sum of squares of all forces, friction of sliding contacts among them; without such forces the smallest of all."""
    work, A, b = eliminated(np.random.default_rng(seed), rank)
    plain, lawful = smallest(A, work.x[:UNKNOWNS].copy(), rank)
    in_python(redundant_contacts.smallest_forces)(MODEL, None, M, UNKNOWNS, rank, 1.0, work)
    assert A @ work.x[:UNKNOWNS] == pytest.approx(b, rel=1e-8)
    assert work.x[:UNKNOWNS] == pytest.approx(plain if lawful is None else lawful, abs=1e-8)


def test_of_these_some_obey_the_laws_by_themselves_most_with_a_change_and_some_not_at_all() -> None:
    """So that the test above asks what it is meant to ask."""
    found = []
    for seed, rank in itertools.product(range(8), (2, 3, 4)):
        work, A, _ = eliminated(np.random.default_rng(seed), rank)
        plain, lawful = smallest(A, work.x[:UNKNOWNS].copy(), rank)
        found.append("none" if lawful is None else "change" if laws(plain).min() < -1e-3 else "plain")
    assert {word: found.count(word) for word in ("plain", "change", "none")} == {"plain": 5, "change": 17, "none": 2}
