"""Where has a dense polygon corners, whichever way it runs?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.drawing.splines import corners, smooth


@pytest.mark.parametrize("hand", [1.0, -1.0])
@pytest.mark.parametrize("turn", [40.0, -40.0, 100.0])
def test_a_corner_between_two_arcs_is_found_and_their_facets_are_none(turn: float, hand: float) -> None:
    """Two arcs of facets of one degree, with a sharp turn between them: to the left and to the right, along and against."""
    facets = np.radians(np.append(np.full(40, 1.0), np.append(turn, np.full(40, -1.0))))
    heading = hand * np.append(0.0, np.cumsum(facets))
    points = np.vstack((np.zeros(2), np.cumsum(np.column_stack((np.cos(heading), np.sin(heading))), axis=0)))
    rise = math.radians(1.0) / 8.0  # of the facets, which are one long
    assert corners(points, 4.0 * rise) == [0, 41, len(points) - 1]
    assert corners(points[::-1], 4.0 * rise) == [0, 41, len(points) - 1]


def test_a_curve_that_swings_too_far_is_refused_on_either_side() -> None:
    """Uneven facets of random turns: what is refused is refused in the mirror, and most of both are tried."""
    outcomes = []
    for seed in range(30):
        rng = np.random.default_rng(seed)
        heading = np.cumsum(rng.uniform(0.0, 0.12, 12) * rng.choice([-1.0, 1.0]))
        lengths = rng.uniform(0.3, 1.0, 12)
        points = np.cumsum(lengths[:, None] * np.column_stack((np.cos(heading), np.sin(heading))), axis=0)
        refused = [smooth(points * (1.0, hand), 0.025) is None for hand in (1.0, -1.0)]
        assert refused[0] == refused[1]
        outcomes.append(refused[0])
    assert 3 < sum(outcomes) < 27


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_what_is_refused_is_refused_in_any_unit_of_length(unit: float) -> None:
    for seed in range(30):
        rng = np.random.default_rng(seed)
        heading = np.cumsum(rng.uniform(0.0, 0.12, 12) * rng.choice([-1.0, 1.0]))
        points = np.cumsum(rng.uniform(0.3, 1.0, 12)[:, None] * np.column_stack((np.cos(heading), np.sin(heading))), axis=0)
        assert (smooth(points, 0.025) is None) == (smooth(unit * points, unit * 0.025) is None)
