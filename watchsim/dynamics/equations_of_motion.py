"""What acts at one instant of a run, besides the forces that are sought: force directions of some contacts, and all else?"""

from __future__ import annotations

from watchsim.contact.gaps import shape_of_contact
from watchsim.contact.kinematics import contact_kinematics
from watchsim.contact.poses import place
from watchsim.dynamics.applied_forces import forces
from watchsim.jit import entry


@entry
def balance(model, t, q, u, ids, out_pose, out_closed, out_normal, out_h):
    """Kinematics and normals of the contacts `ids`, row by row, and the forces h(t, q, u) of all that is no contact."""
    place(model, q, u, out_pose)
    for row in range(len(ids)):
        contact_kinematics(model, ids[row], out_pose, row, out_closed)
        contact = model.contacts[ids[row]]
        a, b = model.primitives[contact.a], model.primitives[contact.b]
        shape = shape_of_contact(contact, a, b, out_pose[a.body], out_pose[b.body])
        out_normal[row, 0], out_normal[row, 1] = shape.nx, shape.ny
    forces(model, t, q, u, out_h)
