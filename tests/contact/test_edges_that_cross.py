"""Are two edges that cross twice found to do so, where both ends of one lie on the same side of the other?"""

from __future__ import annotations

import numpy as np
import pytest
from test_edge_distance import along, apart, checked, drawn

from watchsim.geometry.primitives import Edge, Line


def crossings(a: Edge, b: Edge) -> int:
    """How often a crosses b, by the signs of many points of a; only what is well inside both counts."""
    points = along(a, np.linspace(0.003, 0.997, 401))
    if isinstance(b, Line):
        side = ((points - along(b, 0.0)) / (along(b, 1.0) - along(b, 0.0))).imag
    else:
        side = np.abs(points - complex(b.x, b.y)) - b.radius
    near = apart(b, points) < 0.02
    return int(np.count_nonzero((side[:-1] * side[1:] < 0.0) & near[1:] & near[:-1]))


def crossing_twice(count: int) -> list[tuple[Edge, Edge]]:
    rng = np.random.default_rng(5)
    found: list[tuple[Edge, Edge]] = []
    while len(found) < count:
        a, b = drawn(rng), drawn(rng)
        if crossings(a, b) == 2:
            found.append((a, b))
    return found


@pytest.mark.parametrize(("a", "b"), crossing_twice(40))
def test_those_that_cross_twice_are_found(a: Edge, b: Edge) -> None:
    assert checked(a, b) == checked(b, a) == (0.0, True)
