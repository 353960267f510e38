"""Where is everything at a time within the current step?"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.simulation.motion.free_motion import acceleration, flow
from watchsim.simulation.motion.integrator import dense_value
from watchsim.simulation.scratch import FLIGHT


@kernel
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
