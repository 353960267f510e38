"""Which written polygons cross themselves? Judged against shapely, on grids so coarse that corners lie on sides."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely

from watchsim.scene.outlines import first_crossing, signed_area


def folds_back(points: list[tuple[int, int]]) -> bool:
    """A side that returns on its neighbour: no crossing of two sides that are no neighbours."""
    ways = np.diff(np.array([*points, *points[:2]]), axis=0)
    return any(a[0] * b[1] == a[1] * b[0] and a @ b < 0 for a, b in pairwise(ways))


def test_it_is_found_where_sides_meet_and_nowhere_else() -> None:
    rng = np.random.default_rng(5)
    simple = crossed = touched = 0
    while min(simple, crossed, touched) < 30:
        points = [(int(x), int(y)) for x, y in rng.integers(0, 5, (rng.integers(3, 7), 2))]
        if len(set(points)) < len(points) or folds_back(points):
            continue
        found = first_crossing(points)
        assert (found is None) == shapely.LinearRing(points).is_simple, points
        if found is None:
            simple += 1
            continue
        sides = [shapely.LineString([points[i], points[(i + 1) % len(points)]]) for i in found]
        assert sides[0].intersects(sides[1]), points
        crossed, touched = crossed + sides[0].crosses(sides[1]), touched + sides[0].touches(sides[1])


def test_areas_have_the_sign_of_their_way_round() -> None:
    """Against shapely, wherever the polygon lies."""
    rng = np.random.default_rng(3)
    for _ in range(200):
        points = [(float(x), float(y)) for x, y in rng.normal(size=(int(rng.integers(3, 8)), 2)) + rng.normal(size=2)]
        shape = shapely.Polygon(points)
        ring = shapely.LinearRing(points)
        if ring.is_simple:
            assert signed_area(points) == pytest.approx(shape.area * (1.0 if ring.is_ccw else -1.0), rel=1e-9)
            assert signed_area(points[::-1]) == pytest.approx(-signed_area(points), rel=1e-9)
