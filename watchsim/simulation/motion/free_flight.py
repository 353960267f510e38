"""How does an exact flight go: how long, with which work and losses, and with which rows?

Where no contact couples the moving bodies, each coordinate follows its own closed form (see `free`) up to the next event.
"""

from __future__ import annotations

import math

from watchsim.jit import kernel
from watchsim.simulation.loop_state.scratch import FLIGHT
from watchsim.simulation.motion.dense_output import coordinate_within, flight_acceleration
from watchsim.simulation.motion.free_motion import acceleration_bound, quarter_period
from watchsim.simulation.record.write_buffers import is_kept, keep_row
from watchsim.tolerances import FLIGHT_SIZES

FLIGHT_PHASE = 1.6  # rad of the fastest coordinate's own time scale: the longest flight

# Gauss-Legendre nodes and weights on [0, 1]: damping losses of a flight of at most a quarter period, to rounding.
_NODES = (0.019855071751231856, 0.10166676129318664, 0.2372337950418355, 0.4082826787521751)
_WEIGHTS = (0.05061426814518813, 0.11119051722668724, 0.15685332293894363, 0.18134189168918099)


@kernel
def can_fly(model, state):
    """True if no contact is in force between awake bodies and all awake coordinates have exact solutions."""
    if state.now.awake_contacts > 0:
        return False
    for i in range(len(model.coordinates)):
        if state.awake[i] and not model.coordinates[i].linear:
            return False
    return True


@kernel
def _row_spacing(model, options, i):
    """Longest time between rows for coordinate i in flight: its own time scale."""
    coordinate = model.coordinates[i]
    spacing = math.inf
    if coordinate.stiffness > 0.0:
        spacing = options.row_phase * math.sqrt(coordinate.mass / coordinate.stiffness)
    if coordinate.viscous > 0.0:
        spacing = min(spacing, options.row_phase * coordinate.mass / coordinate.viscous)
    return spacing


@kernel
def _time_far(model, state, i):
    """A time (s) in which coordinate i goes no further than `FLIGHT_SIZES` times the scene's size.

    What falls with 1e30 m/s² would be looked for in 1e27 places along one step.
    """
    far = FLIGHT_SIZES * model.coordinates[i].scale
    speed, bound = abs(state.u[i]), acceleration_bound(model.coordinates[i], state.grip[i], state.q[i], state.u[i])
    both = speed + math.sqrt(speed * speed + 2.0 * bound * far)
    return 2.0 * far / both if both > 0.0 else math.inf


@kernel
def flight_length(model, state, options):
    """(length, row spacing): of an exact flight now."""
    length, spacing = options.max_step, math.inf
    for i in range(len(model.coordinates)):
        if state.awake[i]:
            length = min(length, quarter_period(model.coordinates[i]), _time_far(model, state, i))
            spacing = min(spacing, _row_spacing(model, options, i))
    return min(length, FLIGHT_PHASE / options.row_phase * spacing), spacing


@kernel
def begin_flight(model, state, length, out_step):
    """Make the current step an exact flight of all awake coordinates."""
    step = out_step
    step.span.kind = FLIGHT
    step.span.start, step.span.length = state.clock.time, length
    for i in range(len(model.coordinates)):
        step.q[i], step.u[i] = state.q[i], state.u[i]
        step.bound[i] = 0.0
        if state.awake[i]:
            step.bound[i] = acceleration_bound(model.coordinates[i], state.grip[i], state.q[i], state.u[i])


@kernel
def add_flight_sums(model, state, step, end):
    """Work in and damping losses of the first `end` seconds of a flight."""
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if not state.awake[i] or coordinate.driven:
            continue
        state.sums.drive += coordinate.force * (coordinate_within(model, state, step, i, end)[0] - step.q[i])
        if coordinate.coulomb > 0.0:
            state.sums.damping += coordinate.coulomb * abs(coordinate_within(model, state, step, i, end)[0] - step.q[i])
        if coordinate.viscous == 0.0:
            continue
        total = 0.0
        for j in range(4):
            first = coordinate_within(model, state, step, i, end * _NODES[j])[1]
            last = coordinate_within(model, state, step, i, end * (1.0 - _NODES[j]))[1]
            total += _WEIGHTS[j] * (first * first + last * last)
        state.sums.damping += coordinate.viscous * end * total


@kernel
def keep_flight_rows(model, state, end, spacing, step, record):
    """Rows of a flight, evenly spaced, the last one at its end; brings the state there."""
    n = len(model.coordinates)
    rows = 1 if spacing == math.inf or not is_kept(record, step.span.start, end) else max(1, math.ceil(end / spacing))
    for row in range(1, rows + 1):
        tau = end * row / rows if row < rows else end
        for i in range(n):
            state.q[i], state.u[i] = coordinate_within(model, state, step, i, tau)
            state.a[i] = flight_acceleration(model, state, i, state.q[i], state.u[i])
        keep_row(state, record, step.span.start + tau, state.q, state.u, state.a)
