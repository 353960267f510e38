"""What have springs between points of bodies stored at the rows of a run?"""

from __future__ import annotations

import numpy as np

from watchsim.dynamics.line_springs import line_spring_energies as _energies
from watchsim.model.records import Model
from watchsim.simulation.record.trajectory import Array


def line_spring_energies(model: Model, q: Array) -> Array:
    """(rows,), J."""
    out = np.zeros(len(q))
    if len(model.lines):
        _energies(model, q, out)
    return out
