"""Are least and greatest of four Chebyshev terms those that dense sampling sees, whether their extremes lie inside or not?"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev

from watchsim.geometry.biarcs import _range


def test_the_range_is_that_on_the_interval() -> None:
    a = np.random.default_rng(8).normal(size=(400, 6)) * [1.0, 4.0, 1.0, 0.5, 0.1, 0.1]
    least, greatest, tail = _range(a)
    seen = chebyshev.chebval(np.linspace(-1.0, 1.0, 4001), a[:, :4].T)
    np.testing.assert_allclose(least, seen.min(axis=1), atol=1e-6)
    np.testing.assert_allclose(greatest, seen.max(axis=1), atol=1e-6)
    np.testing.assert_allclose(tail, np.abs(a[:, 4:]).sum(axis=1))


def test_the_range_of_a_parabola_has_its_vertex_however_small_the_cubic_term_is() -> None:
    """T2 a2 + T1 a1 is least or greatest at -a1 / (4 a2): there the formula for two roots divides by what vanishes."""
    rng = np.random.default_rng(9)
    for cubic in (0.0, 1e-18, 1e-9):
        a = np.column_stack((np.zeros(50), rng.uniform(-3.0, 3.0, 50), rng.choice((-1.0, 1.0), 50), np.full(50, cubic)))
        vertex = -a[:, 2] - a[:, 1] ** 2 / (8.0 * a[:, 2])
        least, greatest, _ = _range(a)
        np.testing.assert_allclose(np.where(a[:, 2] > 0.0, least, greatest), vertex, rtol=1e-8)
