"""What does dry friction in a bearing do?

-T sgn(u) while the coordinate moves; while it stands, whatever keeps it at rest, up to T. A finite force: it takes part in
no impact. The grip of a coordinate is FORWARD or BACKWARD while it moves, STICK while it is held, OPEN without dry friction.
"""

from __future__ import annotations

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.jit import kernel


@kernel
def set_grips(model, u, label, island, options, out_grip):
    """What the velocities of the island's coordinates say; STICK where one is below rounding: held or about to move."""
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if label[i] != island:
            continue
        if coordinate.coulomb == 0.0:
            out_grip[i] = OPEN
        elif abs(u[i]) * options.size <= options.speed_zero * coordinate.scale:
            out_grip[i] = STICK
        else:
            out_grip[i] = FORWARD if u[i] > 0.0 else BACKWARD


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
def add_loads(closed, m, force, grip, out_load, out_terms):
    """Add what the m contacts do to the coordinates that are held, and the sum of its terms without sign."""
    for row in range(m):
        for k in range(closed.slots[row]):
            i = closed.coord[row, k]
            if grip[i] == STICK:
                normal, tangential = closed.w_N[row, k] * force[2 * row], closed.w_T[row, k] * force[2 * row + 1]
                out_load[i] += normal + tangential
                out_terms[i] += abs(normal) + abs(tangential)


@kernel
def stop_held(label, island, grip, out_u):
    """Velocities of the island after a decision: zero where held; where just set in motion, never against the new direction."""
    for i in range(len(label)):
        if label[i] != island:
            continue
        if grip[i] == STICK or (grip[i] != OPEN and grip[i] * out_u[i] < 0.0):
            out_u[i] = 0.0
