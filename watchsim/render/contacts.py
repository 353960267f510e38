"""Where do bodies touch at this instant?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.simulation.trajectory import EventKind, Trajectory

Array = NDArray[np.float64]


def contact_points(run: Trajectory, t: float, frames: dict[str, Array]) -> Array:
    return np.empty((0, 2))
