"""Are the differences of exponentials in damped flight exact to rounding? Against forty digits."""

from __future__ import annotations

import mpmath
import pytest
from plain_kernels import in_python

from watchsim.simulation.motion.free_motion import SERIES, _phi


@pytest.mark.parametrize(
    "z", [1e-300, 1e-9, 1e-4, 0.3 * SERIES, 0.999 * SERIES, -0.999 * SERIES, 1.001 * SERIES, 0.3, 7.0, 60.0, -2.0]
)
def test_both_differences_have_all_their_digits(z: float) -> None:
    with mpmath.workdps(40):
        x = mpmath.mpf(z)
        first, second = (1 - mpmath.exp(-x)) / x, (x - 1 + mpmath.exp(-x)) / x**2
        if abs(z) < 1e-8:
            first, second = 1 - x / 2 + x**2 / 6, 0.5 - x / 6 + x**2 / 24
    found = in_python(_phi)(z)
    rounding = 4e-16 if abs(z) < SERIES else 4e-16 / min(1.0, abs(z))
    assert found[0] == pytest.approx(float(first), rel=4e-16, abs=0.0)
    assert found[1] == pytest.approx(float(second), rel=rounding, abs=0.0)
