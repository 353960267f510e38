"""Which closed contacts and coordinates act on each other?

Coordinates that closed contacts join, or that belong to a free body or to a body and its carrier, form an island. No force or
impulse passes from one island to another: every contact problem is posed for one island, and what happens in it leaves the
others as they are.
"""

from __future__ import annotations

from watchsim.contact.kinematics import contact_kinematics
from watchsim.jit import kernel
from watchsim.model.records import FREE


@kernel
def _join(label, i, j):
    """Give both coordinates' islands one label, the smaller."""
    low, high = min(label[i], label[j]), max(label[i], label[j])
    if low == high:
        return
    for k in range(len(label)):
        if label[k] == high:
            label[k] = low


@kernel
def _mover(model, b):
    """A coordinate that moves body b, -1 where none does."""
    body = model.bodies[b]
    if body.first >= 0 or body.carrier < 0:
        return body.first
    return model.bodies[body.carrier].first


@kernel
def label_islands(model, ids, m, out_label):
    """Number the islands that the contacts ids[:m] make: by coordinate, the smallest coordinate of its island."""
    for i in range(len(out_label)):
        out_label[i] = i
    for b in range(len(model.bodies)):
        body = model.bodies[b]
        if body.motion == FREE:
            _join(out_label, body.first, body.first + 1)
            _join(out_label, body.first, body.first + 2)
        if body.first >= 0 and body.carrier >= 0:
            _join(out_label, body.first, model.bodies[body.carrier].first)
    for j in range(len(model.joints)):
        _join(out_label, model.joints[j].coordinate, model.joints[j].on)
    for j in range(len(model.lines)):
        a, b = model.lines[j].a, model.lines[j].b
        if b >= 0 and model.bodies[a].first >= 0 and model.bodies[b].first >= 0:
            _join(out_label, model.bodies[a].first, model.bodies[b].first)
    for row in range(m):
        contact = model.contacts[ids[row]]
        i, j = _mover(model, model.primitives[contact.a].body), _mover(model, model.primitives[contact.b].body)
        if i >= 0 and j >= 0:
            _join(out_label, i, j)


@kernel
def island_of(model, label, k):
    """The island that contact k belongs to."""
    contact = model.contacts[k]
    i = _mover(model, model.primitives[contact.a].body)
    return label[i if i >= 0 else _mover(model, model.primitives[contact.b].body)]


@kernel
def sort_by_island(model, label, m, ids, out_upto):
    """Put the contacts of each island in `ids` side by side, islands ascending, else in the order found.

    upto[i] becomes the place behind the last contact of the island to which ids[i] belongs.
    """
    for row in range(m):
        k, island = ids[row], island_of(model, label, ids[row])
        place = row
        while place > 0 and out_upto[place - 1] > island:
            ids[place], out_upto[place] = ids[place - 1], out_upto[place - 1]
            place -= 1
        ids[place], out_upto[place] = k, island
    end, island = m, -1
    for row in range(m - 1, -1, -1):
        if out_upto[row] != island:
            end, island = row + 1, out_upto[row]
        out_upto[row] = end


@kernel
def place_contacts(model, ids, first, last, pose, out_closed):
    """Kinematics of the contacts ids[first:last] into the first rows of `out_closed`; returns how many."""
    for place in range(first, last):
        contact_kinematics(model, ids[place], pose, place - first, out_closed)
    return last - first
