"""What does a pivot carry, and how much friction does that make?

The force R of a bearing on its body follows from the body's momentum: R = m a_c - m g - F, with a_c the acceleration of its
centre of mass and F what contacts and springs between points do to it. Its friction is T = grip |R|, with the contact forces
and accelerations that T itself makes: a fixed point. One unit more of friction changes the load by at most one over the lever
arm of the force that carries it, so that the iteration contracts while grip is less than that arm: while no force passes
through the circle of friction. What does not settle jams in its bearing (docs/theory/method.md 2.5).
"""

from __future__ import annotations

import math

from watchsim.contact.gaps import BACKWARD, FORWARD
from watchsim.dynamics.forces import spring_pull
from watchsim.dynamics.moving_frame import inertial_on
from watchsim.jit import kernel
from watchsim.tolerances import LOAD_ROUGH, LOAD_SETTLED


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
def load_on(system, p, a):
    """|R| of loaded bearing p as its coordinate accelerates by a (or, at an impact, its velocity jumps by a)."""
    x, y = system.press[p, 0] - a * system.arm[p, 1], system.press[p, 1] + a * system.arm[p, 0]
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
