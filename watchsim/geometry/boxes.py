"""Which boxes hold these points?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FEW = 300  # up to that many, all pairs are compared; the library takes longer to load


class Boxes:
    """Boxes (m, 4), queried again and again."""

    def __init__(self, boxes: NDArray[np.float64]) -> None:
        self.boxes = boxes
        if len(boxes) > FEW:
            import shapely

            self.tree = shapely.STRtree(shapely.box(*boxes.T))

    def holding(self, points: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Numbers of points (n, 2) and of the boxes that hold them, one entry for each such pair."""
        if len(self.boxes) <= FEW:
            x, y = points[:, :1], points[:, 1:]
            held = (self.boxes[:, 0] <= x) & (x <= self.boxes[:, 2]) & (self.boxes[:, 1] <= y) & (y <= self.boxes[:, 3])
            point, box = np.nonzero(held)
            return point, box
        import shapely

        found = self.tree.query(shapely.points(points))
        return found[0], found[1]
