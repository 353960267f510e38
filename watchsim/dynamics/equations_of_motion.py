"""What acts at some instants of a run, besides the forces that are sought: force directions of some contacts, and all else?"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import shape_of_contact
from watchsim.contact.kinematics import contact_kinematics
from watchsim.contact.poses import place
from watchsim.dynamics.applied_forces import forces
from watchsim.jit import entry

Array = NDArray[np.float64]


class Seen(NamedTuple):
    """Kinematics of m contacts at n instants, and the forces h of all else."""

    w_N: Array  # (n, m, coordinates)
    w_T: Array
    bar: Array  # (n, 2, m): bar terms along normals and tangents
    normal: Array  # (n, m, 2)
    point: Array
    h: Array  # (n, coordinates)


def room(instants: int, contacts: int, coordinates: int) -> Seen:
    """Zeros for that many."""
    direction, place = (instants, contacts, coordinates), (instants, contacts, 2)
    shapes = (direction, direction, (instants, 2, contacts), place, place, (instants, coordinates))
    return Seen(*(np.zeros(shape) for shape in shapes))


@entry
def balance(model, t, q, u, ids, out_pose, out_closed, out_seen):
    """Fill `out_seen`, all zeros so far, for the contacts `ids`; t, q and u have a row per instant.

    `out_pose` is room for all bodies, `out_closed` for one contact.
    """
    for i in range(len(t)):
        place(model, q[i], u[i], out_pose)
        forces(model, t[i], q[i], u[i], out_seen.h[i])
        for row in range(len(ids)):
            contact_kinematics(model, ids[row], out_pose, 0, out_closed)
            for slot in range(out_closed.slots[0]):  # two of them may be of one coordinate
                j = out_closed.coord[0, slot]
                out_seen.w_N[i, row, j] += out_closed.w_N[0, slot]
                out_seen.w_T[i, row, j] += out_closed.w_T[0, slot]
            kin, contact = out_closed.kin[0], model.contacts[ids[row]]
            out_seen.bar[i, 0, row], out_seen.bar[i, 1, row] = kin.bar_N, kin.bar_T
            out_seen.point[i, row, 0], out_seen.point[i, row, 1] = kin.x, kin.y
            a, b = model.primitives[contact.a], model.primitives[contact.b]
            shape = shape_of_contact(contact, a, b, out_pose[a.body], out_pose[b.body])
            out_seen.normal[i, row, 0], out_seen.normal[i, row, 1] = shape.nx, shape.ny
