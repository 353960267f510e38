"""What does a hairspring that bends and weighs do at an angle of its balance?

Series of Chebyshev polynomials in the way from rest, summed by Clenshaw's rule; made by mechanism/coiled.py. Beyond the
last angle the torque stays what it is there.
"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.model import COIL_ENERGY, COIL_TORQUE, COIL_X, COIL_Y


@kernel
def coil_value(model, coil, column, way):
    """The sum of one series at `way` (rad) from rest; `coil`: that of the coordinate."""
    row = model.coils[coil - 1]
    x = min(max(way / row.furthest, -1.0), 1.0)
    one, two = 0.0, 0.0
    for k in range(row.first + row.count - 1, row.first, -1):
        one, two = model.windings[k, column] + 2.0 * x * one - two, one
    return model.windings[row.first, column] + x * one - two


@kernel
def coil_energy(model, coil, way):
    """Stored beyond that of a linear spring, J."""
    last = model.coils[coil - 1].furthest
    beyond = way - min(max(way, -last), last)
    energy = coil_value(model, coil, COIL_ENERGY, way)
    return energy - coil_value(model, coil, COIL_TORQUE, way) * beyond if beyond != 0.0 else energy


@kernel
def coil_pull(model, i, q):
    """The force of its coil on the body of coordinate i, N."""
    if i < 0 or model.coordinates[i].coil == 0:
        return 0.0, 0.0
    coordinate = model.coordinates[i]
    way = q[i] - coordinate.rest
    return coil_value(model, coordinate.coil, COIL_X, way), coil_value(model, coordinate.coil, COIL_Y, way)
