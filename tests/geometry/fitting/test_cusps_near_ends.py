"""Is a cusp found wherever it lies on a curve, close to an end too?"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from watchsim.geometry.biarcs import Bundle, Curve
from watchsim.geometry.fitting import fit_arcs, pauses, smooth_parts

NEAR_ENDS = [0.001, 0.0071, 0.0156, 0.0157, 0.0312, 0.0313, 0.5, 0.9687, 0.9688, 0.9843, 0.9844, 0.9929, 0.999]


def cusped(u: float) -> Curve:
    """A cubic Bézier whose slope, (t - u)(6 - 2t, 1 + 5t) mm, falls to nothing at u and nowhere else from 0 to 1."""
    rows = []
    for factor in (Polynomial([6e-3, -2e-3]), Polynomial([1e-3, 5e-3])):
        _, a, b, c = (Polynomial([-u, 1.0]) * factor).integ().coef
        rows.append([0.0, a / 3.0, (2.0 * a + b) / 3.0, a + b + c])
    return Curve(np.array([*rows, [1.0] * 4]).T[None], np.array([0.0, 1.0]))


@pytest.mark.parametrize("u", NEAR_ENDS)
def test_a_curve_is_cut_at_its_cusp(u: float) -> None:
    parts = smooth_parts([cusped(u)], np.array([1e-6]))[0]
    assert [float(part.breaks[-1]) for part in parts] == pytest.approx([u, 1.0], rel=0.0, abs=1e-9)


def test_cusps_of_many_curves_are_found_at_once() -> None:
    found = pauses(Bundle([cusped(u) for u in NEAR_ENDS]))
    assert found == pytest.approx(2.0 * np.arange(len(NEAR_ENDS)) + NEAR_ENDS, rel=0.0, abs=1e-9)


@pytest.mark.parametrize("u", [0.006, 0.987])
def test_a_cusp_near_an_end_costs_two_arcs_more_at_most_than_one_at_the_end(u: float) -> None:
    at_the_end = len(fit_arcs(cusped(float(round(u))), 1e-7).edges)
    assert len(fit_arcs(cusped(u), 1e-7).edges) <= at_the_end + 2
