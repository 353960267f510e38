"""Are the boxes found that hold a point, their borders included, however many there are?"""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.geometry.primitives import FEW, Boxes


@pytest.mark.parametrize("count", [1, FEW, FEW + 1, 2 * FEW])
def test_every_box_that_holds_a_point_is_found(count: int) -> None:
    """Against one comparison after another; on a coarse grid half of the points lie on borders and corners."""
    rng = np.random.default_rng(count)
    low = rng.integers(0, 12, (count, 2)).astype(float)
    boxes = np.hstack((low, low + rng.integers(0, 4, (count, 2))))
    points = rng.integers(-1, 16, (40, 2)).astype(float)
    truth = {(i, k) for i, (x, y) in enumerate(points) for k, (a, b, c, d) in enumerate(boxes) if a <= x <= c and b <= y <= d}
    point, box = Boxes(boxes).holding(points)
    assert len(point) == len(truth) and set(zip(point.tolist(), box.tolist(), strict=True)) == truth
