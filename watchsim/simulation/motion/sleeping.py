"""Which bodies stand still on their contacts, and may be left alone until something touches them?"""

from __future__ import annotations

from watchsim.contact.index_sets import STICK
from watchsim.jit import kernel
from watchsim.model.records import FREE, OVER_TIME, REPEATED
from watchsim.simulation.motion.contact_islands import island_of


@kernel
def _share_terms(model, out_terms):
    """Rounding in a coordinate of a free body comes from the forces on all three, whatever angle the body has."""
    for b in range(len(model.bodies)):
        if model.bodies[b].motion == FREE:
            x, y, turn = model.bodies[b].first, model.bodies[b].first + 1, model.bodies[b].first + 2
            gyration = (model.coordinates[turn].mass / model.coordinates[x].mass) ** 0.5
            largest = max(out_terms[x], out_terms[y], out_terms[turn] / gyration)
            out_terms[x], out_terms[y], out_terms[turn] = largest, largest, largest * gyration


@kernel
def _is_still(model, state, options, i, terms):
    """Coordinate i has no velocity and no acceleration beyond rounding; `terms` is the sum of the forces on it without sign."""
    coordinate = model.coordinates[i]
    if abs(state.u[i]) * options.size > options.speed_zero * coordinate.scale:
        return False
    return abs(state.a[i]) * coordinate.mass <= options.sleep * terms


@kernel
def begin_terms(h, out_terms):
    """The magnitudes of the forces h."""
    for i in range(len(h)):
        out_terms[i] = abs(h[i])


@kernel
def add_terms(closed, m, force, out_terms):
    """Add the magnitudes of what the m contacts do to each coordinate."""
    for i in range(m):
        for k in range(closed.slots[i]):
            normal, tangential = closed.w_N[i, k] * force[2 * i], closed.w_T[i, k] * force[2 * i + 1]
            out_terms[closed.coord[i, k]] += abs(normal) + abs(tangential)


@kernel
def _will_change(model, table, t):
    """A force over time has knots left; behind the last one it is as constant as any other. One that repeats always has."""
    if table.over == REPEATED:
        return True
    return table.over == OVER_TIME and t < model.knots[table.start + table.count - 1, 0]


@kernel
def find_sleepers(model, state, options, event, f):
    """Set `state.awake`: an island with a contact or a bearing that holds sleeps if it is still and nothing depends on time.

    The f contacts in force are in `state.active`, their islands in `event.label`, accelerations in `state.a`, the
    magnitudes of the forces on each coordinate in `event.terms`.
    """
    label, touched = event.label, event.touched
    n = len(label)
    for i in range(n):
        state.awake[i] = 0
    touched[:] = 0
    for j in range(f):
        touched[island_of(model, label, state.active[j])] = 1
    _share_terms(model, event.terms)
    for i in range(n):
        if state.grip[i] == STICK:
            touched[label[i]] = 1
    for i in range(n):
        if touched[label[i]] == 0 or not _is_still(model, state, options, i, event.terms[i]):
            _wake(state, label, label[i])
    for j in range(len(model.tables)):
        if _will_change(model, model.tables[j], state.clock.time):
            _wake(state, label, label[model.tables[j].coordinate])
    for i in range(n):
        if model.coordinates[i].driven:
            _wake(state, label, label[i])
    for i in range(n):
        if state.awake[i] == 0:
            state.u[i], state.a[i] = 0.0, 0.0


@kernel
def is_at_rest(model, state, b):
    """True for fixed bodies and bodies asleep whose carrier, if any, is asleep as well."""
    body = model.bodies[b]
    if body.first >= 0 and state.awake[body.first]:
        return False
    return body.carrier < 0 or state.awake[model.bodies[body.carrier].first] == 0


@kernel
def _wake(state, label, group):
    for i in range(len(label)):
        if label[i] == group:
            state.awake[i] = 1
