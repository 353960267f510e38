"""Where is everything at a time within the current step?

In a coupled step: the continuous extension, a polynomial of degree 7 in the share x of the step that has passed (Hairer,
Noersett & Wanner 1993, II.6). In a flight: the closed form.
"""

from __future__ import annotations

from watchsim.jit import hot_kernel, kernel
from watchsim.simulation.loop_state.scratch import FLIGHT
from watchsim.simulation.motion.free_motion import acceleration, flow


@kernel
def dense(step, i, tau):
    """Component i of y, and its time derivative, at time tau after the start of a coupled step."""
    h, d = step.span.length, step.dense
    x = tau / h
    w = 1.0 - x
    value, slope = d[5, i] + x * d[6, i], d[6, i]
    value, slope = d[4, i] + w * value, w * slope - value
    value, slope = d[3, i] + x * value, x * slope + value
    value, slope = d[2, i] + w * value, w * slope - value
    value, slope = d[1, i] + x * value, x * slope + value
    value, slope = d[0, i] + w * value, w * slope - value
    return step.y0[i] + x * value, (x * slope + value) / h


@kernel
def dense_bend(step, i, tau):
    """Second time derivative of component i of y at time tau after the start of a coupled step."""
    h, d = step.span.length, step.dense
    x = tau / h
    w = 1.0 - x
    value, slope, bend = d[5, i] + x * d[6, i], d[6, i], 0.0
    for term in range(4, -1, -1):  # what is nested in `dense`, times w and x in turn
        share, way = (w, -1.0) if term % 2 == 0 else (x, 1.0)
        value, slope, bend = d[term, i] + share * value, share * slope + way * value, share * bend + 2.0 * way * slope
    return (x * bend + 2.0 * slope) / (h * h)


@kernel
def dense_value(step, i, tau):
    """Component i of y alone."""
    return dense(step, i, tau)[0]


@hot_kernel
def coordinate_within(model, state, step, i, tau):
    """Coordinate i and its velocity at time tau after the start of the step."""
    if step.span.kind == FLIGHT:
        if state.awake[i] == 0:
            return step.q[i], 0.0
        return flow(model.coordinates[i], state.grip[i], step.q[i], step.u[i], tau)
    n = len(model.coordinates)
    return dense_value(step, i, tau), dense_value(step, n + i, tau)


@kernel
def flight_acceleration(model, state, i, q, u):
    """q'' of coordinate i during a flight."""
    return acceleration(model.coordinates[i], state.grip[i], q, u) if state.awake[i] else 0.0
