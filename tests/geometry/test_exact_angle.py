"""Are cosine and sine right to 38 digits?"""

from __future__ import annotations

import random
from decimal import Decimal

import mpmath
import pytest

from watchsim.geometry.primitives import QUARTER, cos_sin

CHOSEN = random.Random(1)
ANGLES = [
    *(QUARTER * k / 2 for k in range(-9, 10)),  # where one series takes over from the other
    *(Decimal(CHOSEN.uniform(-20.0, 20.0)) for _ in range(30)),
    *(sign * Decimal(10) ** -power for sign in (-1, 1) for power in (1, 7, 19)),
]


@pytest.mark.parametrize("angle", ANGLES, ids=lambda angle: f"{angle:.4g}")
def test_many_digits(angle: Decimal) -> None:
    """Against mpmath with 60 digits; what is small keeps its digits, too."""
    with mpmath.workdps(60):
        exact = mpmath.mpf(str(angle))
        for value, truth in zip(cos_sin(angle), (mpmath.cos(exact), mpmath.sin(exact)), strict=True):
            assert abs(mpmath.mpf(str(value)) - truth) < mpmath.mpf("1e-37")
