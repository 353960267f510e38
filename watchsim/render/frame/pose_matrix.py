"""How does a body's frame lie in the plane?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def pose_matrix(frame: Array) -> Array:
    """The 3 × 3 map from a body's frame to the plane, for its pose x, y, angle."""
    x, y, angle = frame
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, x], [s, c, y], [0.0, 0.0, 1.0]])
