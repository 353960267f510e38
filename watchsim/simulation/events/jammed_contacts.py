"""What is made of velocities before contacts are taken for jammed: no rounding of an impact, and gaps that do not open.

A contact jams where it slides and no finite force exists (docs/theory/method.md 2.6).
"""

from __future__ import annotations

from watchsim.contact.index_sets import FORWARD, OPEN, STICK
from watchsim.contact.poses import place
from watchsim.dynamics.delassus import inverse_mass
from watchsim.jit import kernel
from watchsim.simulation.events.closed_contacts import refresh
from watchsim.simulation.motion.drift_projection import project_velocities
from watchsim.tolerances import DEPENDENT_AT_EVENTS, VELOCITY_ROUNDING


@kernel
def hold_gaps(model, state, r, options, work, event):
    """Zero the gap rates of the r contacts in `event.rest`, and the slip of those that hold.

    The gaps of jammed contacts must not open, however slowly, or there is nothing to stop.
    """
    rest = event.rest
    for i in range(r):
        k = rest.ids[i]
        holds = model.laws[model.contacts[k].group].friction > 0.0 and abs(rest.kin[i].gT_dot) <= options.speed_zero
        event.trial[k] = STICK if holds else FORWARD
    for j in range(len(model.coordinates)):
        work.inverse[j] = inverse_mass(model.coordinates[j])
    project_velocities(rest, r, event.trial, DEPENDENT_AT_EVENTS, work, state.u)
    place(model, state.q, state.u, event.pose)


@kernel
def stop_rounding(model, state, m, r, options, scratch):
    """Stop velocities and slips at the r contacts in `event.rest` that are rounding of the impact just solved; True if any.

    The tangential impulse is sought within its cone, mu Lambda_N to either side: slips are rounded by what that much would do.
    """
    work, event = scratch.work, scratch.event
    closed, rest = event.closed, event.rest
    found = _stop_bodies(r, event, state.u)
    for i in range(r):
        k, slip, rounding = rest.ids[i], abs(rest.kin[i].gT_dot), 0.0
        friction = model.laws[model.contacts[k].group].friction
        for j in range(m):
            if closed.ids[j] == k:
                rounding = VELOCITY_ROUNDING * friction * scratch.impact.impulse[2 * j] * work.G[2 * i + 1, 2 * i + 1]
        stops = options.speed_zero < slip <= rounding
        event.trial[k] = STICK if stops else OPEN
        found = found or stops
    if found:
        project_velocities(rest, r, event.trial, DEPENDENT_AT_EVENTS, work, state.u)
        place(model, state.q, state.u, event.pose)
        refresh(model, m, closed, event.pose)
    return found


@kernel
def _stop_bodies(r, event, out_u):
    """Zero velocities that are rounding of what they were at this instant: a body that should stand has no w̄; True if any."""
    rest, found = event.rest, False
    for i in range(r):
        for slot in range(rest.slots[i]):
            j = rest.coord[i, slot]
            if 0.0 < abs(out_u[j]) <= VELOCITY_ROUNDING * event.pace[j]:
                out_u[j], found = 0.0, True
    return found


@kernel
def slides(r, speed_zero, rest):
    """True if one of the r contacts in I_N slides."""
    for i in range(r):
        if abs(rest.kin[i].gT_dot) > speed_zero:
            return True
    return False
