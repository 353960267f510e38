"""Where has a dense polygon corners, whichever way it runs?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.drawing.curves.dense_polygon import corners


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
