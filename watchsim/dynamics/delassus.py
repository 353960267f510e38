"""How do contact forces and impulses act on the gaps?

G = Wᵀ M⁻¹ W over the closed contacts, rows and columns ordered N, T of contact 0, N, T of contact 1, ...
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.index_sets import STICK
from watchsim.dynamics.lcp.lemke_pivoting import LcpWork, lcp_work
from watchsim.dynamics.problem_kinds import Rung
from watchsim.jit import by_reference, hot_kernel, kernel
from watchsim.model.named_fields import blank

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class Posed:
    """The last problem: what it was about, and how Lemke's method ended."""

    contacts: int
    elements: int
    bearings: int
    level: int  # a Level
    lemke: int  # an LcpOutcome


class ContactWork(NamedTuple):
    """Scratch of the contact problems, allocated once for `room` contacts and n coordinates.

    Rows of G: N, T of each of the m contacts, then one for each bearing that dry friction might hold. A block is such a contact
    or bearing. An element is a bounded force: the friction of one block.
    """

    lcp: LcpWork
    G: Array  # (rows, rows)
    b: Array  # (rows,) accelerations or velocities of the gaps without contact forces
    size: Array  # (rows,) the same with all terms taken positive: the scale of rounding
    worth: Array  # (room,) normal force that a contact's own terms make without those of others: the scale of its rounding
    force: Array  # (rows,) lambda or Lambda
    more: Array  # (rows,) impulses of the expansion
    rates: Array  # (rows,) velocities of the gaps at the start of the expansion, its least impulses included
    offset: Array  # (room,) tangential impulse whose slip moves the corner of the law pg1996
    loaded: Array  # (rows,) accelerations of the gaps without contact forces, bearings at the lower end of their friction
    correction: Array  # (rows,) impulses that take back drift (simulation/motion/drift_projection.py)
    inverse: Array  # (n,) 1/mass, 0 where dry friction holds the coordinate
    unit: Array  # (blocks,) scale that gives G a unit diagonal
    drag: Array  # (room,) friction per normal force at the lower end of the interval
    tangent: Integers  # (room,) element of the contact, -1: none
    block: Integers  # (blocks,) by element
    dry: Integers  # (n,) coordinate of each bearing that might hold
    width: Array  # (blocks,) length of an element's interval per normal force
    span: Array  # (blocks,) constant part of its length
    shift: Array  # (blocks,) constant part of its lower end
    hand: Array  # (rows,) -1 where a direction of friction is reversed, else 1
    A: Array  # the complementarity problem or the linear system in hand
    rhs: Array
    x: Array
    B: Array  # the same problem in its copositive form
    other_rhs: Array
    other_x: Array
    free: Array  # forces that no motion decides, one set a row (redundant_contacts.py)
    weight: Array  # of each unknown in the sum of squares of the forces
    dual: Array  # multipliers of the laws that such forces must obey
    scale: Array  # of a linear system, see `solve_small`
    order: Integers
    row: Integers  # (side,) of G, by row of a correction (simulation/motion/drift_projection.py)
    h: Array  # (n,)
    rungs: Integers  # problems solved since last asked, by Rung; the last one counts those without a solution
    sizes: Integers  # the same problems by their number of unknowns, see `LARGEST`
    posed: Posed


ContactWorkRef = by_reference(ContactWork, __name__)

LARGEST = (1, 2, 4, 8, 16)  # unknowns of the problems counted together; one more place for larger ones


def contact_work(room: int, coordinates: int) -> ContactWork:
    """Room for that many closed contacts."""
    rows, blocks = 2 * room + coordinates, room + coordinates
    side = room + 3 * blocks
    return ContactWork(
        G=np.zeros((rows, rows)),
        b=np.zeros(rows),
        size=np.zeros(rows),
        worth=np.zeros(room),
        force=np.zeros(rows),
        more=np.zeros(rows),
        rates=np.zeros(rows),
        offset=np.zeros(room),
        loaded=np.zeros(rows),
        correction=np.zeros(rows),
        inverse=np.zeros(coordinates),
        unit=np.zeros(blocks),
        drag=np.zeros(room),
        tangent=np.zeros(room, np.int64),
        block=np.zeros(blocks, np.int64),
        dry=np.zeros(coordinates, np.int64),
        width=np.zeros(blocks),
        span=np.zeros(blocks),
        shift=np.zeros(blocks),
        hand=np.ones(rows),
        A=np.zeros((side, side)),
        rhs=np.zeros(side),
        x=np.zeros(side),
        B=np.zeros((side, side)),
        other_rhs=np.zeros(side),
        other_x=np.zeros(side),
        free=np.zeros((side, side)),
        weight=np.zeros(side),
        dual=np.zeros(side),
        scale=np.zeros(side),
        order=np.zeros(side, np.int64),
        row=np.zeros(side, np.int64),
        lcp=lcp_work(side),
        h=np.zeros(coordinates),
        rungs=np.zeros(len(Rung), np.int64),
        sizes=np.zeros(len(LARGEST) + 1, np.int64),
        posed=blank(Posed),
    )


@kernel
def note_posed(work, m, elements, bearings, level):
    """Say what the problem now in `work` is about."""
    posed = work.posed
    posed.contacts, posed.elements, posed.bearings, posed.level = m, elements, bearings, level


@kernel
def size_class(n):
    """The place in `sizes` for a problem of n unknowns."""
    place = 0
    while place < len(LARGEST) and n > LARGEST[place]:
        place += 1
    return place


@kernel
def inverse_mass(coordinate):
    """1/mass towards contacts; 0 where the motion is prescribed, so that no force changes it."""
    return 0.0 if coordinate.driven else 1.0 / coordinate.mass


@kernel
def own_acceleration(model, work, j):
    """What the forces `work.h` alone give coordinate j; `h` of a prescribed motion is its acceleration."""
    return work.h[j] if model.coordinates[j].driven else work.h[j] * work.inverse[j]


@kernel
def fill_inverse(model, grip, out_inverse):
    """1/mass of each coordinate; 0 for those that `grip` says dry friction holds."""
    for i in range(len(model.coordinates)):
        out_inverse[i] = 0.0 if grip[i] == STICK else inverse_mass(model.coordinates[i])


@hot_kernel
def fill_delassus(closed, m, work):
    """G of the first m closed contacts."""
    for i in range(m):
        for j in range(i, m):
            nn, nt, tn, tt = 0.0, 0.0, 0.0, 0.0
            for k in range(closed.slots[i]):
                for q in range(closed.slots[j]):
                    if closed.coord[i, k] == closed.coord[j, q]:
                        inverse = work.inverse[closed.coord[i, k]]
                        nn += closed.w_N[i, k] * closed.w_N[j, q] * inverse
                        nt += closed.w_N[i, k] * closed.w_T[j, q] * inverse
                        tn += closed.w_T[i, k] * closed.w_N[j, q] * inverse
                        tt += closed.w_T[i, k] * closed.w_T[j, q] * inverse
            work.G[2 * i, 2 * j], work.G[2 * j, 2 * i] = nn, nn
            work.G[2 * i, 2 * j + 1], work.G[2 * j + 1, 2 * i] = nt, nt
            work.G[2 * i + 1, 2 * j], work.G[2 * j, 2 * i + 1] = tn, tn
            work.G[2 * i + 1, 2 * j + 1], work.G[2 * j + 1, 2 * i + 1] = tt, tt


@kernel
def fill_bearings(closed, m, bearings, work):
    """The rows and columns of G, after those of the contacts, for the bearings listed in `dry`."""
    for p in range(bearings):
        row, i = 2 * m + p, work.dry[p]
        for column in range(2 * m + bearings):
            work.G[row, column], work.G[column, row] = 0.0, 0.0
        work.G[row, row] = work.inverse[i]
        for j in range(m):
            for k in range(closed.slots[j]):
                if closed.coord[j, k] == i:
                    N, T = closed.w_N[j, k] * work.inverse[i], closed.w_T[j, k] * work.inverse[i]
                    work.G[row, 2 * j], work.G[2 * j, row] = N, N
                    work.G[row, 2 * j + 1], work.G[2 * j + 1, row] = T, T


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
