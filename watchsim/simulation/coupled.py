"""How do bodies move while contacts couple them?

Right-hand side of the smooth motion in the decided modes, and the monitors that tell when a mode ends: a normal force that
vanishes, a slip that reverses, a friction force that reaches its cone, a contact that leaves its primitive, a contact that
comes near Painlevé's paradox, a bearing with dry friction that stops or breaks loose.
"""

from __future__ import annotations

from watchsim.contact.index_sets import OPEN, STICK
from watchsim.contact.kinematics import contact_kinematics
from watchsim.contact.poses import place_body
from watchsim.dynamics.acceleration import accelerate, is_paradox, solve_mode
from watchsim.dynamics.dry import add_drag, drag_power, load_on
from watchsim.dynamics.forces import damping_power, drive_power, forces
from watchsim.jit import kernel
from watchsim.simulation.state import N_EVALUATIONS

MONITORS = 4


@kernel
def bearing_monitor(model, state, scratch, options, j):
    """Of coordinate j at the state last evaluated; its grip holds while it is positive."""
    coordinate = model.coordinates[j]
    if state.grip[j] == OPEN or state.awake[j] == 0:
        return 1.0
    if state.grip[j] == STICK:
        load, terms = load_on(scratch.closed, state.numbers[0], scratch.work, j)
        return coordinate.coulomb - abs(load) + options.force_zero * terms
    return state.grip[j] * scratch.y[len(model.coordinates) + j] + 0.5 * options.speed_zero / options.size * coordinate.scale


@kernel
def monitor(model, state, scratch, options, i, which):
    """Monitor `which` of active contact i at the state last evaluated; the mode holds while it is positive."""
    closed, work = scratch.closed, scratch.work
    k = closed.ids[i]
    normal = work.force[2 * i]
    if which == 0:
        if normal == 0.0 and work.size[2 * i] == 0.0:
            return 1.0  # nothing acts on this gap: touching bodies that travel together without a force
        slack = options.force_zero * work.size[2 * i] / work.G[2 * i, 2 * i]
        return normal + slack
    if which == 1:
        friction = model.laws[model.contacts[k].group].friction
        if friction == 0.0:
            return 1.0
        if state.mode[k] == STICK:
            slack = options.force_zero * (work.size[2 * i] / work.G[2 * i, 2 * i] + abs(normal))
            return friction * normal - abs(work.force[2 * i + 1]) + slack
        # Half of what `decide_modes` calls no slip: a contact that fires here may stick there, and one that turns back
        # starts a whole `speed_zero` away from firing again.
        return state.mode[k] * closed.kin[i].gT_dot + 0.5 * options.speed_zero
    if which == 3:
        return -1.0 if is_paradox(work, state.numbers[0], i) else 1.0
    return closed.kin[i].margin + 2.0 * options.extent


@kernel
def engage(model, state, scratch):
    """Find the bodies that the active contacts join, the only ones whose places matter while the modes last."""
    scratch.engaged[:] = 0
    for i in range(state.numbers[0]):
        contact = model.contacts[state.active[i]]
        scratch.engaged[model.primitives[contact.a].body] = 1
        scratch.engaged[model.primitives[contact.b].body] = 1


@kernel
def motion(model, state, options, t, y, scratch):
    """dy/dt of y = (q, u, sums) at time t into `scratch.dy`; lowers `scratch.alarm` to the smallest monitor.

    `scratch.engaged` must be that of the active contacts.
    """
    n = len(model.coordinates)
    q, u = y[:n], y[n : 2 * n]
    m = state.numbers[0]
    work, closed, out = scratch.work, scratch.closed, scratch.dy
    forces(model, t, q, u, work.h)
    add_drag(model, state.grip, work.h)
    friction = 0.0
    if m > 0:
        for b in range(len(model.bodies)):
            if scratch.engaged[b]:
                place_body(model, b, q, u, scratch.pose)
        for i in range(m):
            contact_kinematics(model, state.active[i], scratch.pose, i, closed)
        solve_mode(model, closed, m, state.mode, work)
        for i in range(m):
            friction -= work.force[2 * i + 1] * closed.kin[i].gT_dot
            for which in range(MONITORS):
                scratch.alarm[0] = min(scratch.alarm[0], monitor(model, state, scratch, options, i, which))
    accelerate(closed, m, work, out[n : 2 * n])
    for i in range(n):
        scratch.alarm[0] = min(scratch.alarm[0], bearing_monitor(model, state, scratch, options, i))
        if state.awake[i] == 0:
            out[n + i] = 0.0
        out[i] = u[i]
    out[2 * n] = drive_power(model, t, q, u)
    out[2 * n + 1] = damping_power(model, u) + drag_power(model, state.grip, u)
    out[2 * n + 2] = friction
    state.counts[N_EVALUATIONS] += 1
