"""How do contact forces and impulses act on the gaps?

G = Wᵀ M⁻¹ W over the closed contacts, rows and columns ordered N, T of contact 0, N, T of contact 1, ...
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.dynamics.lcp import LcpWork, lcp_work
from watchsim.jit import by_reference, kernel

Array = NDArray[np.float64]


class ContactWork(NamedTuple):
    """Scratch of the contact problems, allocated once for `room` contacts and n coordinates."""

    G: Array  # (2 room, 2 room)
    b: Array  # (2 room,) accelerations or velocities of the gaps without contact forces
    size: Array  # (2 room,) the same with all terms taken positive: the scale of rounding
    force: Array  # (2 room,) lambda or Lambda
    more: Array  # (2 room,) a second set: impulses of the expansion
    unit: Array  # (room,) scale that gives G a unit diagonal
    drag: Array  # (room,) friction coefficient times direction
    tangent: NDArray[np.int64]  # (room,) row of the contact's tangential unknowns, -1: none
    A: Array
    rhs: Array
    x: Array
    order: NDArray[np.int64]
    lcp: LcpWork
    h: Array  # (n,)


ContactWorkRef = by_reference(ContactWork, __name__)


def contact_work(room: int, coordinates: int) -> ContactWork:
    """Room for that many closed contacts."""
    two, three = 2 * room, 3 * room
    return ContactWork(
        np.zeros((two, two)),
        np.zeros(two),
        np.zeros(two),
        np.zeros(two),
        np.zeros(two),
        np.zeros(room),
        np.zeros(room),
        np.zeros(room, np.int64),
        np.zeros((three, three)),
        np.zeros(three),
        np.zeros(three),
        np.zeros(three, np.int64),
        lcp_work(three),
        np.zeros(coordinates),
    )


@kernel
def fill_delassus(model, closed, m, work):
    """G of the first m closed contacts, and the scale of each."""
    for i in range(m):
        for j in range(i, m):
            nn, nt, tn, tt = 0.0, 0.0, 0.0, 0.0
            for k in range(closed.slots[i]):
                for q in range(closed.slots[j]):
                    if closed.coord[i, k] == closed.coord[j, q]:
                        inverse = 1.0 / model.coordinates[closed.coord[i, k]].mass
                        nn += closed.w_N[i, k] * closed.w_N[j, q] * inverse
                        nt += closed.w_N[i, k] * closed.w_T[j, q] * inverse
                        tn += closed.w_T[i, k] * closed.w_N[j, q] * inverse
                        tt += closed.w_T[i, k] * closed.w_T[j, q] * inverse
            work.G[2 * i, 2 * j], work.G[2 * j, 2 * i] = nn, nn
            work.G[2 * i, 2 * j + 1], work.G[2 * j + 1, 2 * i] = nt, nt
            work.G[2 * i + 1, 2 * j], work.G[2 * j, 2 * i + 1] = tn, tn
            work.G[2 * i + 1, 2 * j + 1], work.G[2 * j + 1, 2 * i + 1] = tt, tt


@kernel
def apply(model, closed, m, force, out_change):
    """Add M⁻¹ W force to `out_change`: accelerations from forces, velocity jumps from impulses."""
    for i in range(m):
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            push = closed.w_N[i, k] * force[2 * i] + closed.w_T[i, k] * force[2 * i + 1]
            out_change[j] += push / model.coordinates[j].mass


@kernel
def contact_velocities(model, closed, m, u, out_rates):
    """Rates w_N·u and w_T·u of the closed contacts."""
    for i in range(m):
        normal, tangential = 0.0, 0.0
        for k in range(closed.slots[i]):
            normal += closed.w_N[i, k] * u[closed.coord[i, k]]
            tangential += closed.w_T[i, k] * u[closed.coord[i, k]]
        out_rates[2 * i], out_rates[2 * i + 1] = normal, tangential
