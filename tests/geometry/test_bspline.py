"""Do the Béziers of a B-spline run where it runs?"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import BSpline

from watchsim.geometry.biarcs import Bundle, Curve, beziers


@pytest.mark.parametrize("degree", [1, 2, 3, 5, 11, 24])
@pytest.mark.parametrize("clamped", [True, False])
def test_beziers_against_scipy(degree: int, clamped: bool) -> None:
    rng = np.random.default_rng(degree)
    inner = np.sort(rng.uniform(0.0, 1.0, 6))
    inner[3] = inner[2]  # a double knot
    outer = np.zeros(degree), np.ones(degree)
    if not clamped:
        outer = -0.1 * np.arange(degree, 0, -1), 1.0 + 0.1 * np.arange(1, degree + 1)
    knots = np.concatenate((outer[0], [0.0], inner, [1.0], outer[1]))
    points = np.column_stack(
        (rng.uniform(-1.0, 1.0, (len(knots) - degree - 1, 2)), rng.uniform(0.5, 2.0, len(knots) - degree - 1))
    )
    starts = np.array([i for i in range(degree, len(points)) if knots[i] < knots[i + 1]])
    control = beziers(degree, knots, points, starts, starts)
    breaks = np.array([*knots[starts], knots[starts[-1] + 1]])
    whole = BSpline(knots, points, degree)
    bundle = Bundle([Curve(control, breaks)])
    for k, (low, high) in enumerate(pairwise(breaks)):
        u = np.linspace(0.0, 1.0, 7)[:-1]
        h = whole(low + u * (high - low))
        assert bundle.points(k + u) == pytest.approx(h[:, :2] / h[:, 2:], abs=1e-11)


def test_coincident_points_stay_one_point() -> None:
    point = (0.1, 0.7, 1.0)
    control = beziers(
        3, np.array([0.0, 0.0, 0.0, 0.0, 0.3, 1.0, 1.0, 1.0, 1.0]), np.array([point] * 5), *[np.array([3, 4])] * 2
    )
    assert np.all(control == point)
