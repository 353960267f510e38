"""What does dry friction in a bearing do?

-T sgn(u) while the coordinate moves; while it stands, whatever keeps it at rest, up to T. A finite force: it takes part in
no impact. The grip of a coordinate is FORWARD or BACKWARD while it moves, STICK while it is held, OPEN without dry friction.
"""

from __future__ import annotations

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.jit import kernel


@kernel
def set_grips(model, u, speed_zero, size, out_grip):
    """What the velocities say; STICK where one is below rounding: held or about to move. Returns how many of those."""
    standing = 0
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if coordinate.coulomb == 0.0:
            out_grip[i] = OPEN
        elif abs(u[i]) * size <= speed_zero * coordinate.scale:
            out_grip[i] = STICK
            standing += 1
        else:
            out_grip[i] = FORWARD if u[i] > 0.0 else BACKWARD
    return standing


@kernel
def add_drag(model, grip, out_h):
    """Dry friction of the moving bearings."""
    for i in range(len(model.coordinates)):
        if grip[i] == FORWARD or grip[i] == BACKWARD:
            out_h[i] -= grip[i] * model.coordinates[i].coulomb


@kernel
def drag_power(model, grip, u):
    """Power the moving bearings take, W. A smooth function of u also beyond a reversal, where the step will end."""
    power = 0.0
    for i in range(len(model.coordinates)):
        if grip[i] == FORWARD or grip[i] == BACKWARD:
            power += grip[i] * model.coordinates[i].coulomb * u[i]
    return power


@kernel
def load_on(closed, m, work, i):
    """(force, sum of its terms without sign) of drives and contacts on coordinate i, from `work.h` and `work.force`."""
    load, terms = work.h[i], abs(work.h[i])
    for j in range(m):
        for k in range(closed.slots[j]):
            if closed.coord[j, k] == i:
                normal, tangential = closed.w_N[j, k] * work.force[2 * j], closed.w_T[j, k] * work.force[2 * j + 1]
                load += normal + tangential
                terms += abs(normal) + abs(tangential)
    return load, terms


@kernel
def stop_held(model, grip, out_u):
    """Velocities after a decision: zero where held; where just set in motion, never against the new direction."""
    for i in range(len(model.coordinates)):
        if grip[i] == STICK or (grip[i] != OPEN and grip[i] * out_u[i] < 0.0):
            out_u[i] = 0.0
