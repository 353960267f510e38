"""How do contact forces and impulses act on the gaps?

G = Wᵀ M⁻¹ W over the closed contacts (Delassus), rows and columns ordered N, T of contact 0, N, T of contact 1, ..., then one
for each bearing that dry friction might hold (docs/theory/method.md 2.2, 2.5).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import STICK
from watchsim.jit import by_reference, hot_kernel, kernel

Array = NDArray[np.float64]


class ContactSystem(NamedTuple):
    """What acts on the gaps of one island's closed contacts, and the forces found; SI.

    Written by whoever poses a problem: `solve_mode` in a mode, `decide_modes` at an event, `impact` at an impact.
    """

    h: Array  # (n,) all forces but those of contacts; of a prescribed motion its acceleration
    inverse: Array  # (n,) 1/mass towards contacts, 0 where dry friction holds the coordinate
    G: Array  # (rows, rows)
    b: Array  # (rows,) accelerations of the gaps without contact forces
    size: Array  # (rows,) the same with all terms taken positive: the scale of rounding
    normal_scale: Array  # (room,) normal force that a contact's own terms alone make: the scale of its rounding
    force: Array  # (rows,) lambda
    dry: Array  # (n,) dry friction of the bearings, N or N·m; of those with a load what it makes now, see `bearings`
    a: Array  # (n,) accelerations with which loads were found
    arm: Array  # (n, 2) by bearing with a load: mass times the way from the pivot to the centre of mass, kg·m
    pull: Array  # (n, 2) what it carries without contacts and angular acceleration, N
    press: Array  # (n, 2) what it carries but for angular acceleration, N or N·s
    poised: Array  # (n,) h before loads were sought, with the friction that goes with none
    bare: Array  # (n, 2) loads with that friction, N
    shares: Array  # (n, n, 2) loads of each by unit friction of each, N per N or N·m


ContactSystemRef = by_reference(ContactSystem, __name__)


def contact_system(room: int, coordinates: int) -> ContactSystem:
    """For `room` closed contacts and as many bearings as coordinates."""
    n, rows = coordinates, 2 * room + coordinates
    lengths = {"h": n, "inverse": n, "b": rows, "size": rows, "normal_scale": room, "force": rows, "dry": n, "a": n}
    lengths["poised"] = n
    parts: dict[str, Array] = {name: np.zeros(length) for name, length in lengths.items()}
    parts |= {name: np.zeros((n, 2)) for name in ("arm", "pull", "press", "bare")}
    return ContactSystem(G=np.zeros((rows, rows)), shares=np.zeros((n, n, 2)), **parts)


@kernel
def copy(values, out):
    """Copy an array into another one: an assignment of slices would allocate, lest they overlap."""
    for i in range(len(out)):
        out[i] = values[i]


@kernel
def inverse_mass(coordinate):
    """1/mass towards contacts; 0 where the motion is prescribed, so that no force changes it."""
    return 0.0 if coordinate.driven else 1.0 / coordinate.mass


@kernel
def own_acceleration(model, system, j):
    """What the forces `system.h` alone give coordinate j."""
    return system.h[j] if model.coordinates[j].driven else system.h[j] * system.inverse[j]


@kernel
def fill_inverse(model, grip, out_inverse):
    """1/mass of each coordinate; 0 for those that `grip` says dry friction holds."""
    for i in range(len(model.coordinates)):
        out_inverse[i] = 0.0 if grip[i] == STICK else inverse_mass(model.coordinates[i])


@hot_kernel
def fill_delassus(closed, m, inverse, out_G):
    """G of the first m closed contacts."""
    for i in range(m):
        for j in range(i, m):
            nn, nt, tn, tt = 0.0, 0.0, 0.0, 0.0
            for k in range(closed.slots[i]):
                for q in range(closed.slots[j]):
                    if closed.coord[i, k] == closed.coord[j, q]:
                        mobility = inverse[closed.coord[i, k]]
                        nn += closed.w_N[i, k] * closed.w_N[j, q] * mobility
                        nt += closed.w_N[i, k] * closed.w_T[j, q] * mobility
                        tn += closed.w_T[i, k] * closed.w_N[j, q] * mobility
                        tt += closed.w_T[i, k] * closed.w_T[j, q] * mobility
            out_G[2 * i, 2 * j], out_G[2 * j, 2 * i] = nn, nn
            out_G[2 * i, 2 * j + 1], out_G[2 * j + 1, 2 * i] = nt, nt
            out_G[2 * i + 1, 2 * j], out_G[2 * j, 2 * i + 1] = tn, tn
            out_G[2 * i + 1, 2 * j + 1], out_G[2 * j + 1, 2 * i + 1] = tt, tt


@kernel
def fill_bearings(closed, m, dry, bearings, inverse, out_G):
    """The rows and columns of G, after those of the contacts, for the coordinates `dry[:bearings]`."""
    for p in range(bearings):
        row, i = 2 * m + p, dry[p]
        for column in range(2 * m + bearings):
            out_G[row, column], out_G[column, row] = 0.0, 0.0
        out_G[row, row] = inverse[i]
        for j in range(m):
            for k in range(closed.slots[j]):
                if closed.coord[j, k] == i:
                    N, T = closed.w_N[j, k] * inverse[i], closed.w_T[j, k] * inverse[i]
                    out_G[row, 2 * j], out_G[2 * j, row] = N, N
                    out_G[row, 2 * j + 1], out_G[2 * j + 1, row] = T, T


@kernel
def apply(closed, m, force, inverse, out_change):
    """Add M⁻¹ W force to `out_change`: accelerations from forces, velocity jumps from impulses."""
    for i in range(m):
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            push = closed.w_N[i, k] * force[2 * i] + closed.w_T[i, k] * force[2 * i + 1]
            out_change[j] += push * inverse[j]


@kernel
def drive_through_contacts(model, closed, m, force, u):
    """Power (of impulses: work) that keeps prescribed motions up against the forces of m contacts."""
    total = 0.0
    for i in range(m):
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            if model.coordinates[j].driven:
                total -= (closed.w_N[i, k] * force[2 * i] + closed.w_T[i, k] * force[2 * i + 1]) * u[j]
    return total


@kernel
def contact_velocities(closed, m, u, out_rates):
    """Rates w_N·u and w_T·u of the closed contacts."""
    for i in range(m):
        normal, tangential = 0.0, 0.0
        for k in range(closed.slots[i]):
            normal += closed.w_N[i, k] * u[closed.coord[i, k]]
            tangential += closed.w_T[i, k] * u[closed.coord[i, k]]
        out_rates[2 * i], out_rates[2 * i + 1] = normal, tangential
