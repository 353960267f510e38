"""Which bodies stand still on their contacts, and may be left alone until something touches them?"""

from __future__ import annotations

from watchsim.contact.index_sets import STICK
from watchsim.jit import kernel
from watchsim.mechanism.model import FREE, OVER_TIME


@kernel
def _join(label, i, j):
    """Give both coordinates' groups one label."""
    low, high = min(label[i], label[j]), max(label[i], label[j])
    for k in range(len(label)):
        if label[k] == high:
            label[k] = low


@kernel
def label_islands(model, closed, m, out_label):
    """Number the groups of coordinates that the first m contacts, and what acts at pivots of carried bodies, couple."""
    for i in range(len(out_label)):
        out_label[i] = i
    for b in range(len(model.bodies)):
        body = model.bodies[b]
        if body.motion == FREE:
            _join(out_label, body.first, body.first + 1)
            _join(out_label, body.first, body.first + 2)
    for j in range(len(model.joints)):
        _join(out_label, model.joints[j].coordinate, model.joints[j].on)
    for i in range(m):
        for k in range(1, closed.slots[i]):
            _join(out_label, closed.coord[i, 0], closed.coord[i, k])


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
def find_sleepers(model, state, options, scratch, m):
    """Set `state.awake`: a group with a contact or a bearing that holds sleeps if it is still and nothing depends on time.

    The m contacts in force are in `scratch.rest`, their forces in `scratch.work.force`, accelerations in `state.a`.
    """
    closed, work, label = scratch.rest, scratch.work, scratch.label
    label_islands(model, closed, m, label)
    n = len(label)
    for i in range(n):
        state.awake[i] = 0
        scratch.q[i] = abs(work.h[i])
    touched = scratch.u
    touched[:] = 0.0
    for i in range(m):
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            scratch.q[j] += abs(closed.w_N[i, k] * work.force[2 * i]) + abs(closed.w_T[i, k] * work.force[2 * i + 1])
            touched[label[j]] = 1.0
    _share_terms(model, scratch.q)
    for i in range(n):
        if state.grip[i] == STICK:
            touched[label[i]] = 1.0
    for i in range(n):
        if touched[label[i]] == 0.0 or not _is_still(model, state, options, i, scratch.q[i]):
            _wake(state, label, label[i])
    for j in range(len(model.tables)):
        if model.tables[j].over == OVER_TIME:
            _wake(state, label, label[model.tables[j].coordinate])
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
