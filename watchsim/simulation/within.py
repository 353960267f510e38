"""Where is everything at a time within the current step?"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.simulation.free import acceleration, acceleration_bound, flow
from watchsim.simulation.integrator import dense_value
from watchsim.simulation.state import FLIGHT


@kernel
def begin_flight(model, state, length, scratch):
    """Make the current step an exact flight of all awake coordinates."""
    step = scratch.step
    step.kind[0] = FLIGHT
    step.span[0], step.span[1] = state.clock[0], length
    for i in range(len(model.coordinates)):
        step.q[i], step.u[i] = state.q[i], state.u[i]
        step.bound[i] = 0.0
        if state.awake[i]:
            step.bound[i] = acceleration_bound(model.coordinates[i], state.grip[i], state.q[i], state.u[i])


@kernel
def coordinate_within(model, state, step, i, tau):
    """Coordinate i and its velocity at time tau after the start of the step."""
    if step.kind[0] == FLIGHT:
        if state.awake[i] == 0:
            return step.q[i], 0.0
        return flow(model.coordinates[i], state.grip[i], step.q[i], step.u[i], tau)
    n = len(model.coordinates)
    return dense_value(step, i, tau), dense_value(step, n + i, tau)


@kernel
def flight_acceleration(model, state, i, q, u):
    """q'' of coordinate i during a flight."""
    return acceleration(model.coordinates[i], state.grip[i], q, u) if state.awake[i] else 0.0
