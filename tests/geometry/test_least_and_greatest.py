"""Are least and greatest of four Chebyshev terms those that dense sampling sees, whether their extremes lie inside or not?"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev

from watchsim.geometry.fitting.deviation import _range


def test_the_range_is_that_on_the_interval() -> None:
    a = np.random.default_rng(8).normal(size=(400, 6)) * [1.0, 4.0, 1.0, 0.5, 0.1, 0.1]
    least, greatest, tail = _range(a)
    seen = chebyshev.chebval(np.linspace(-1.0, 1.0, 4001), a[:, :4].T)
    np.testing.assert_allclose(least, seen.min(axis=1), atol=1e-6)
    np.testing.assert_allclose(greatest, seen.max(axis=1), atol=1e-6)
    np.testing.assert_allclose(tail, np.abs(a[:, 4:]).sum(axis=1))
