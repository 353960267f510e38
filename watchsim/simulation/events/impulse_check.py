"""Is every change of velocities at an instant explained by its impulses?

Impulses account for what they take. What else moves velocities at an instant are corrections of rounding size: drift
taken back, slips and speeds that count as zero. The kinetic energy that such a change takes or gives must be next to nothing.
"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.tolerances import EXPLAINED_OF_HIGHEST, EXPLAINED_SHARE, STOPPABLE_SPEED


@kernel
def kinetic_energy(model, u):
    """J."""
    total = 0.0
    for i in range(len(u)):
        if not model.coordinates[i].driven:
            total += 0.5 * model.coordinates[i].mass * u[i] * u[i]
    return total


@kernel
def is_explained(model, options, before, after, highest):
    """True if a change of kinetic energy from `before` to `after` (J, impulses taken out) is of the size of rounding."""
    allowed = EXPLAINED_SHARE * before + EXPLAINED_OF_HIGHEST * highest
    change = abs(after - before)
    if change <= allowed:
        return True
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if coordinate.driven:
            continue
        slow = STOPPABLE_SPEED * options.speed_zero / options.size * coordinate.scale
        allowed += 0.5 * coordinate.mass * slow * slow
    return change <= allowed
