"""Which boxes hold these points?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FEW = 300  # up to that many, all pairs are compared; the library takes longer to load


def holding(boxes: NDArray[np.float64], points: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Numbers of points (n, 2) and of the boxes (m, 4) that hold them, one entry for each such pair."""
    if len(boxes) <= FEW:
        x, y = points[:, :1], points[:, 1:]
        held = (boxes[:, 0] <= x) & (x <= boxes[:, 2]) & (boxes[:, 1] <= y) & (y <= boxes[:, 3])
        point, box = np.nonzero(held)
        return point, box
    import shapely

    found = shapely.STRtree(shapely.box(*boxes.T)).query(shapely.points(points))
    return found[0], found[1]
