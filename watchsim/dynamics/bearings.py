"""What does a pivot carry, and how much friction does that make?

The force R of a bearing on its body follows from the body's momentum: R = m a_c - m g - F, with a_c the acceleration of its
centre of mass and F what contacts and springs between points do to it. Its friction is T = grip |R|, with the contact forces
and accelerations that T itself makes: a fixed point. One unit more of friction changes the load by at most one over the lever
arm of the force that carries it, so that the iteration contracts while grip is less than that arm: while no force passes
through the circle of friction. What does not settle jams in its bearing (docs/theory/method.md 2.5).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import BACKWARD, FORWARD
from watchsim.dynamics.forces import spring_pull
from watchsim.dynamics.moving_frame import inertial_on
from watchsim.dynamics.redundant import solve_small
from watchsim.jit import by_reference, kernel
from watchsim.tolerances import LOAD_ROUGH, LOAD_SETTLED, RANK

Array = NDArray[np.float64]


class Pivots(NamedTuple):
    """The bearings of a problem whose loads are solved with it, by their rows of G; see coupled_loads.py.

    N at the level of accelerations, N·s at an impact.
    """

    load: NDArray[np.int64]  # (n,) place among the bearings with a load, -1: its friction is a number
    way: Array  # (n, 2) direction along which the load is measured
    start: Array  # (n, 2) load without forces by row
    lean: Array  # (n, 2, rows) load by unit force of each row
    grip: Array  # (n,) m: friction by load
    fixed: Array  # (n,) friction that goes with no load
    slides: Array  # (n,) 1, -1: moves that way; 0: may hold
    base: Array  # (rows,) what contacts bear whatever is found
    made: Array  # (rows,) forces of one unknown


PivotsRef = by_reference(Pivots, __name__)


def pivots(room: int, coordinates: int) -> Pivots:
    """For `room` closed contacts and as many bearings as coordinates."""
    n, rows = coordinates, 2 * room + coordinates
    way, start = np.zeros((2, n, 2))
    grip, fixed, slides = np.zeros((3, n))
    base, made = np.zeros((2, rows))
    return Pivots(np.zeros(n, np.int64), way, start, np.zeros((n, 2, rows)), grip, fixed, slides, base, made)


@kernel
def begin_loads(model, t, q, u, system):
    """What bearings carry without contacts and angular acceleration, and the arms by which that acts; friction as poised."""
    for p in range(len(model.bearings)):
        bearing = model.bearings[p]
        i = bearing.coordinate
        body = model.bodies[bearing.body]
        angle = body.ratio * q[i] + body.phase
        c, s = math.cos(angle), math.sin(angle)
        x, y = c * bearing.moment_x - s * bearing.moment_y, s * bearing.moment_x + c * bearing.moment_y
        fx, fy = spring_pull(model, bearing.body, q, u)
        ix, iy = inertial_on(model, bearing.body, t, q, u)
        system.arm[p, 0], system.arm[p, 1] = x, y
        system.pull[p, 0] = -u[i] * u[i] * x - bearing.weight_x - fx - ix
        system.pull[p, 1] = -u[i] * u[i] * y - bearing.weight_y - fy - iy
        system.dry[i] = model.coordinates[i].coulomb


@kernel
def lay_on(model, share, system):
    """Begin the load with that share of what is there without contacts: 1, or 0 for the impulses of an impact."""
    for p in range(len(model.bearings)):
        system.press[p, 0], system.press[p, 1] = share * system.pull[p, 0], share * system.pull[p, 1]


@kernel
def press_contacts(model, closed, m, force, system):
    """Add what the forces or impulses `force` of m contacts do to the load of their bodies."""
    for i in range(m):
        contact, kin = model.contacts[closed.ids[i]], closed.kin[i]
        normal, tangential = force[2 * i], force[2 * i + 1]
        fx, fy = kin.nx * normal - kin.ny * tangential, kin.ny * normal + kin.nx * tangential
        a, b = model.primitives[contact.a].body, model.primitives[contact.b].body
        for p in range(len(model.bearings)):
            body = model.bearings[p].body
            sign = (1.0 if body == b else 0.0) - (1.0 if body == a else 0.0)
            system.press[p, 0] += sign * fx
            system.press[p, 1] += sign * fy


@kernel
def load_vector(system, p, a):
    """R of loaded bearing p as its coordinate accelerates by a (or, at an impact, its velocity jumps by a)."""
    return system.press[p, 0] - a * system.arm[p, 1], system.press[p, 1] + a * system.arm[p, 0]


@kernel
def load_on(system, p, a):
    """|R| of the same."""
    x, y = load_vector(system, p, a)
    return math.sqrt(x * x + y * y)


@kernel
def rub(model, grip, system):
    """Friction of the load just found into `system.dry`, and into `system.h` of what moves.

    Returns the largest change there, as a share of the friction. That of a bearing that holds is only a bound.
    """
    worst = 0.0
    for p in range(len(model.bearings)):
        bearing = model.bearings[p]
        i = bearing.coordinate
        weight = math.sqrt(bearing.weight_x * bearing.weight_x + bearing.weight_y * bearing.weight_y)
        load = load_on(system, p, system.a[i])
        dry = model.coordinates[i].coulomb + bearing.grip * (load - weight)
        change, scale = dry - system.dry[i], max(bearing.grip * (load + weight) + model.coordinates[i].coulomb, system.dry[i])
        system.dry[i] = dry
        if grip[i] == FORWARD or grip[i] == BACKWARD:
            system.h[i] -= grip[i] * change
            worst = max(worst, settled_share(change, scale))
    return worst


@kernel
def settled_share(change, scale):
    """A change as a share of its scale; infinity where it is no number."""
    if not math.isfinite(change):
        return math.inf
    return abs(change) / scale if scale > 0.0 else 0.0


LOAD_ROUNDS = 60  # of the iteration: halved each time, 1e-18 is left


@kernel
def has_settled(worst, number):
    """True if the round `number` ends the iteration: nothing changes any more, or what does is rounding."""
    return worst <= LOAD_SETTLED or (number == LOAD_ROUNDS - 1 and worst <= LOAD_ROUGH)


# Where the rounds do not settle: within a mode loads are linear in the frictions y beyond what goes with no load,
# R = bare + shares y, so that y = grip (|R| - weight) is a small equation by itself. Newton's method takes |R| as d·R, d the
# last direction of R.


@kernel
def poise(model, system):
    """Friction that goes with no load, and the forces with it."""
    for i in range(len(system.h)):
        system.h[i] = system.poised[i]
    for p in range(len(model.bearings)):
        i = model.bearings[p].coordinate
        system.dry[i] = model.coordinates[i].coulomb


@kernel
def note_bare(model, system):
    """The loads just found into `system.bare`; returns the largest friction that goes with them, 0: none."""
    unit = 0.0
    for p in range(len(model.bearings)):
        x, y = load_vector(system, p, system.a[model.bearings[p].coordinate])
        system.bare[p, 0], system.bare[p, 1] = x, y
        unit = max(unit, model.bearings[p].grip * math.sqrt(x * x + y * y))
    return unit


@kernel
def note_share(model, q, unit, system):
    """The loads just found, with so much friction more in bearing q, into `system.shares`."""
    for p in range(len(model.bearings)):
        x, y = load_vector(system, p, system.a[model.bearings[p].coordinate])
        system.shares[p, q, 0] = (x - system.bare[p, 0]) / unit if unit > 0.0 else 0.0
        system.shares[p, q, 1] = (y - system.bare[p, 1]) / unit if unit > 0.0 else 0.0


@kernel
def rub_shares(model, grip, y, system):
    """Friction y of each bearing into `system.dry`, and into `system.h` of what moves."""
    for q in range(len(model.bearings)):
        j = model.bearings[q].coordinate
        if grip[j] == FORWARD or grip[j] == BACKWARD:
            system.dry[j] += y[q]
            system.h[j] -= grip[j] * y[q]


@kernel
def share_friction(model, system, modes):
    """y of each loaded bearing into `modes.x`, from `system.bare` and `system.shares`; True if it is found."""
    n, worst = len(model.bearings), math.inf
    modes.x[:n] = 0.0
    for number in range(LOAD_ROUNDS):
        worst, largest = 0.0, 0.0
        for p in range(n):
            bearing = model.bearings[p]
            x, y = system.bare[p, 0], system.bare[p, 1]
            for q in range(n):
                x += system.shares[p, q, 0] * modes.x[q]
                y += system.shares[p, q, 1] * modes.x[q]
            load = math.sqrt(x * x + y * y)
            weight = math.sqrt(bearing.weight_x * bearing.weight_x + bearing.weight_y * bearing.weight_y)
            worst = max(worst, abs(bearing.grip * (load - weight) - modes.x[p]))
            largest = max(largest, bearing.grip * (load + weight))
            x, y = (x / load, y / load) if load > 0.0 else (0.0, 0.0)
            modes.rhs[p] = bearing.grip * (x * system.bare[p, 0] + y * system.bare[p, 1] - weight)
            for q in range(n):
                along = x * system.shares[p, q, 0] + y * system.shares[p, q, 1]
                modes.A[p, q] = (1.0 if p == q else 0.0) - bearing.grip * along
            modes.scale[p] = 1.0
        if not math.isfinite(worst):
            return False
        if has_settled(settled_share(worst, largest), number):
            return True
        solve_small(modes.A, modes.rhs, n, modes.scale, modes.order, modes.x, RANK)
    return False
