"""Are the primitives of an outline where its edges are, to the last digit where arcs are flat?"""

from __future__ import annotations

import mpmath
import pytest

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc
from watchsim.mechanism.contact_features import FLAT, features
from watchsim.model.records import ARC

SIZE, LENGTH = 0.01, 2e-3  # m


@pytest.mark.parametrize("radius", [1.25 * FLAT * SIZE, 1.0, 1e3, 1e6])
def test_the_middle_of_a_flat_arc_is_rounded_once(radius: float) -> None:
    """In coordinates of millimetres, though the centre is a kilometre away: against mpmath with 50 digits."""
    for number in range(20):
        start = 0.3 + 0.31 * number
        with mpmath.workdps(50):
            away = mpmath.mpf(start) + mpmath.mpf(LENGTH / radius) / 2
            centre = (float(1.3e-3 - radius * mpmath.cos(away)), float(0.7e-3 - radius * mpmath.sin(away)))
            edge = Arc(*centre, radius, start, LENGTH / radius)
            truth = [float(c + mpmath.mpf(radius) * f(away)) for c, f in zip(centre, (mpmath.cos, mpmath.sin), strict=True)]
        (row,) = (row for row in features(Loop((edge,), closed=False), 0, SIZE) if row.kind == ARC)
        assert [float(row.px), float(row.py)] == truth
