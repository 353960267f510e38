"""How does Moreau's time stepping move the woodpecker toy? Relaxation in place of complementarity, steps in place of events.

The step of `--method moreau`, in the toy's modal coordinates: contacts closed at the middle of the step; stop and throw back
what approaches (Poisson); then forces and contacts together, the spring at the middle of the step.
"""

from __future__ import annotations

import numpy as np

from watchsim.jit import callable_kernel
from watchsim.simulation.moreau.percussion_laws import laws
from watchsim.simulation.moreau.prox_relaxation import relax
from watchsim.verification.woodpecker.toy import Array, Modal

_relax = callable_kernel(relax)


def percussions(G: Array, rates: Array, low: Array, friction: Array) -> Array:
    """(2m,) that keep the normal rates from being negative, at least `low` along the normals."""
    m = len(low)
    obeyed = laws(m, 0)
    obeyed.G[:], obeyed.b[:], obeyed.low[:] = G, rates, low
    obeyed.ends[:] = np.outer(friction, (0.0, -1.0, 0.0, 1.0))  # Coulomb's law, see percussion_laws
    _, settled = _relax(obeyed, m, 0)
    if not settled:
        raise RuntimeError("the relaxation of the woodpecker has not settled")
    return obeyed.P


def step_to(model: Modal, e: Array, v: Array, until: float, h: float) -> tuple[Array, Array]:
    """Modal coordinates and velocities at time `until` by steps of about h."""
    W, mu, restitution = model.contacts.W, model.contacts.friction, model.contacts.restitution
    count = round(until / h)
    h = until / count
    stiff = 1.0 + 0.25 * h * h * model.spring
    for _ in range(count):
        middle = e + 0.5 * h * v
        closed = [i for i in range(3) if model.gaps[i] + W[2 * i] @ middle <= 0.0]
        rows = W[[2 * i + k for i in closed for k in (0, 1)]]
        w = _impact(rows, v, mu[closed], restitution[closed]) if closed else v
        free = ((2.0 - stiff) * w + h * (model.load - model.spring * e)) / stiff
        new = free
        if closed:
            P = percussions(rows / stiff @ rows.T, rows @ free, np.zeros(len(closed)), mu[closed])
            new = free + rows.T @ P / stiff
        e = e + 0.5 * h * (w + new)
        v = new
    return e, v


def _impact(rows: Array, v: Array, mu: Array, restitution: Array) -> Array:
    """Velocities after compression and expansion."""
    G, m = rows @ rows.T, len(mu)
    P = percussions(G, rows @ v, np.zeros(m), mu)
    middle = v + rows.T @ P
    more = percussions(G, rows @ middle, restitution * P[::2], mu)
    return middle + rows.T @ more
