"""How do bodies move while contacts couple them?

Right-hand side of the smooth motion in the decided modes, and the monitors that tell when a mode ends: a normal force that
vanishes, a slip that reverses, a friction force that reaches its cone, a contact that leaves its primitive, a contact that
comes near Painlevé's paradox, a bearing with dry friction that stops or breaks loose.
"""

from __future__ import annotations

import math

from watchsim.contact.index_sets import OPEN, STICK
from watchsim.contact.poses import place_body
from watchsim.dynamics.acceleration import solve_mode
from watchsim.dynamics.applied_forces import damping_power, drive_power, forces
from watchsim.dynamics.bearing_friction import add_drag, add_loads, drag_power
from watchsim.dynamics.delassus import apply, drive_through_contacts, own_acceleration
from watchsim.dynamics.jamming import is_paradox
from watchsim.jit import hot_kernel, kernel
from watchsim.simulation.loop_state.scratch import MONITORS
from watchsim.simulation.motion.contact_islands import place_contacts
from watchsim.tolerances import PAINLEVE, PAINLEVE_WATCHED, SLIP_SLACK

NORMAL, TANGENTIAL, EXTENT, PARADOX = range(MONITORS)


@kernel
def bearing_monitor(model, state, options, j, smooth):
    """Of coordinate j at the state being evaluated; its grip holds while it is positive."""
    coordinate = model.coordinates[j]
    if state.grip[j] == OPEN or state.awake[j] == 0:
        return 1.0
    if state.grip[j] == STICK:
        return coordinate.coulomb - abs(smooth.load[j]) + state.now.lenience * options.force_zero * smooth.terms[j]
    slack = 0.5 * state.now.lenience * options.speed_zero / options.size * coordinate.scale
    return state.grip[j] * smooth.y[len(model.coordinates) + j] + slack


@kernel
def press_left(work, i, zero):
    """Normal force of contact i in the modes solved, with the share `zero` of its terms on top; not positive where it pulls."""
    normal = work.force[2 * i]
    if normal == 0.0 and work.size[2 * i] == 0.0:
        return 1.0  # nothing acts on this gap: touching bodies that travel together without a force
    return normal + zero * work.size[2 * i] / work.G[2 * i, 2 * i]


@kernel
def grip_left(friction, work, i, zero):
    """How far the friction force of contact i, which sticks, is from its bound, with the share `zero` of its terms on top."""
    normal = work.force[2 * i]
    if normal == 0.0 and work.size[2 * i] == 0.0:
        return 1.0
    slack = zero * work.size[2 * i] / work.G[2 * i, 2 * i]
    return friction * normal - abs(work.force[2 * i + 1]) + slack


@kernel
def _tangential_monitor(model, state, options, i, work, closed):
    k = closed.ids[i]
    friction = model.laws[model.contacts[k].group].friction
    if friction == 0.0:
        return 1.0
    if state.mode[k] == STICK:
        return grip_left(friction, work, i, state.now.lenience * options.force_zero)
    # A slip that counted as none may run against the mode decided: it ends only beyond what counts as none.
    return state.mode[k] * closed.kin[i].gT_dot + state.now.lenience * SLIP_SLACK * options.speed_zero


@hot_kernel
def _watch(model, state, options, first, m, work, smooth):
    """Set the monitors of an island's m contacts, the first of them at place `first` of `state.active`; returns the smallest.

    Code MONITORS * place + kind; the mode holds while all are positive.
    """
    closed, values = smooth.closed, smooth.monitors
    smallest = math.inf
    for i in range(m):
        code = MONITORS * (first + i)
        values[code + NORMAL] = press_left(work, i, state.now.lenience * options.force_zero)
        values[code + TANGENTIAL] = _tangential_monitor(model, state, options, i, work, closed)
        values[code + EXTENT] = closed.kin[i].margin + 2.0 * options.extent
        values[code + PARADOX] = -1.0 if is_paradox(work, m, i, PAINLEVE_WATCHED * PAINLEVE) else 1.0
        for kind in range(MONITORS):
            smallest = min(smallest, values[code + kind])
    return smallest


@kernel
def _watch_bearings(model, state, options, smooth):
    """Set the monitors of the bearings: one for each coordinate, codes after those of the contacts; returns the smallest."""
    smallest = math.inf
    code = MONITORS * state.now.awake_contacts
    for j in range(len(model.coordinates)):
        smooth.monitors[code + j] = bearing_monitor(model, state, options, j, smooth)
        smallest = min(smallest, smooth.monitors[code + j])
    return smallest


@kernel
def engage(model, state, smooth):
    """Find the bodies that the active contacts join, the only ones whose places matter while the modes last."""
    smooth.engaged[:] = 0
    for i in range(state.now.awake_contacts):
        contact = model.contacts[state.active[i]]
        smooth.engaged[model.primitives[contact.a].body] = 1
        smooth.engaged[model.primitives[contact.b].body] = 1


@kernel
def motion(model, state, options, t, work, smooth):
    """dy/dt of `smooth.y` = (q, u, sums) at time t into `smooth.dy`; returns the smallest monitor.

    `smooth.engaged` must be that of the active contacts; `work.inverse` is given.
    """
    n = len(model.coordinates)
    q, u = smooth.y[:n], smooth.y[n : 2 * n]
    closed, out = smooth.closed, smooth.dy
    forces(model, t, q, u, work.h)
    add_drag(model, state.grip, work.h)
    for b in range(len(model.bodies)):
        if smooth.engaged[b]:
            place_body(model, b, q, u, smooth.pose)
    for i in range(n):
        out[i], out[n + i] = u[i], own_acceleration(model, work, i)
        smooth.load[i], smooth.terms[i] = work.h[i], abs(work.h[i])
    smallest, friction, driven, first = math.inf, 0.0, 0.0, 0
    while first < state.now.awake_contacts:
        m = place_contacts(model, state.active, first, state.upto[first], smooth.pose, closed)
        solve_mode(model, closed, m, state.mode, state.now.lenience, work)
        apply(closed, m, work.force, work.inverse, out[n : 2 * n])
        add_loads(closed, m, work.force, state.grip, smooth.load, smooth.terms)
        driven += drive_through_contacts(model, closed, m, work.force, u)
        for i in range(m):
            friction -= work.force[2 * i + 1] * closed.kin[i].gT_dot
        smallest = min(smallest, _watch(model, state, options, first, m, work, smooth))
        first += m
    smallest = min(smallest, _watch_bearings(model, state, options, smooth))
    for i in range(n):
        if state.awake[i] == 0:
            out[n + i] = 0.0
    out[2 * n] = drive_power(model, t, q, u) + driven
    out[2 * n + 1] = damping_power(model, q, u) + drag_power(model, state.grip, u)
    out[2 * n + 2] = friction
    state.counts.evaluations += 1
    return smallest
