"""Do contacts and their mirror image, with the contacts in any order, get the same impulses and modes?

Wedged between two contacts with friction, bodies may move on in several ways that all obey Coulomb's law; the form in which the
law is solved must not choose by the orientation of a drawing.
"""

from __future__ import annotations

import numpy as np
import pytest
from every_time import few

from watchsim.contact.index_sets import BACKWARD, FORWARD
from watchsim.verification.bare_contacts import BareContacts

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
