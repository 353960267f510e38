"""Which contact problems can be put to the kernels from Python?

One entry serves all of them, so that what they share, the greater part, is compiled once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import Closed, ClosedRef
from watchsim.dynamics import acceleration
from watchsim.dynamics import impact as impacts
from watchsim.jit import entry
from watchsim.model import Model, ModelRef
from watchsim.simulation.scratch import ContactWork, contact_work_by_reference

Array = NDArray[np.float64]
Codes = NDArray[np.int8]

IMPACT, MODES, FORCES, ACCELERATIONS = range(4)
_impact, _decide_modes, _solve_mode, _accelerate = (
    impacts.impact,
    acceleration.decide_modes,
    acceleration.solve_mode,
    acceleration.accelerate,
)
NO_CODES, NO_NUMBERS = np.zeros(0, np.int8), np.zeros(0)


def impact(model: Model, closed: Closed, m: int, restitution: Array, jam: float, work: ContactWork, out_u: Array) -> bool:
    """See `watchsim.dynamics.impact.impact`."""
    return bool(_solved(IMPACT, model, closed, (m, 0), jam, restitution, work, (NO_CODES, NO_CODES, out_u)))


def decide_modes(
    model: Model, closed: Closed, m: int, bearings: int, speed_zero: float, work: ContactWork, out_grip: Codes, out_mode: Codes
) -> bool:
    """See `watchsim.dynamics.acceleration.decide_modes`."""
    out = out_grip, out_mode, NO_NUMBERS
    return bool(_solved(MODES, model, closed, (m, bearings), speed_zero, NO_NUMBERS, work, out))


def solve_mode(model: Model, closed: Closed, m: int, mode: Codes, lenience: float, work: ContactWork) -> bool:
    """See `watchsim.dynamics.acceleration.solve_mode`."""
    return bool(_solved(FORCES, model, closed, (m, 0), lenience, NO_NUMBERS, work, (NO_CODES, mode, NO_NUMBERS)))


def accelerate(model: Model, closed: Closed, m: int, work: ContactWork, out_a: Array) -> None:
    """See `watchsim.dynamics.acceleration.accelerate`."""
    _solved(ACCELERATIONS, model, closed, (m, 0), 0.0, NO_NUMBERS, work, (NO_CODES, NO_CODES, out_a))


@entry
def _solved(what, model, closed, sizes, number, restitution, work, out):
    """True where the problem `what` has a solution (of forces: one only).

    `sizes`: contacts and bearings; `number`: a speed or the lenience; `out`: grips, modes and velocities or accelerations.
    """
    parts, rows, room = ModelRef(*model), ClosedRef(*closed), contact_work_by_reference(work)
    m, bearings = sizes
    grip, mode, vector = out
    if what == IMPACT:
        return _impact(parts, rows, m, restitution, (number, 0.0), room.system, room.problem, room.phases, vector)
    if what == MODES:
        return _decide_modes(parts, rows, m, bearings, number, room.system, room.problem, grip, mode)
    if what == FORCES:
        return _solve_mode(parts, rows, m, mode, number, room.system, room.modes)
    _accelerate(parts, rows, m, room.system, vector)
    return True
