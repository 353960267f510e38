"""Where does a study begin when a changed dimension has pushed bodies into each other?

A scene is drawn so that bodies touch at the start: a tooth at its locking face, the lever at its banking. Shift a pivot by a
micrometre, and they overlap. A limit cycle does not depend on the start, so the coordinates may give way: by the smallest
change that leaves no gap negative.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled
from watchsim.model.records import frozen
from watchsim.simulation.options import Options
from watchsim.simulation.overlap_removal import kinematics_at, overlapping_rows, taken_back_from

DEEPEST = (1e-6, 1e-5)  # m: how deep an overlap may be; tried in turn, since far behind a face other faces are near


def freed_start(compiled: Compiled, options: Options) -> NDArray[np.float64] | None:
    """Coordinates near the scene's start at which nothing overlaps; None where bodies overlap by more than a little."""
    ids = np.unique(compiled.model.near)
    model = compiled.model._replace(contacts=frozen(compiled.model.contacts[ids]))
    for near in DEEPEST:
        if not len(overlapping_rows(model, kinematics_at(model, compiled.q), options, near, options.behind)):
            continue
        q = taken_back_from(model, compiled.q, options, near)
        if q is not None:
            return q
    return None
