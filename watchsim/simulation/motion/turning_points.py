"""When did a sprung body turn back, and when did it pass its rest position?"""

from __future__ import annotations

from watchsim.candidates.cell_lookup import along
from watchsim.jit import kernel
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.motion.dense_output import coordinate_within
from watchsim.simulation.motion.root_bracket import is_open, narrowed, next_time, opened
from watchsim.simulation.record.write_buffers import keep_event
from watchsim.tolerances import PASSAGE_RESOLUTION


@kernel
def _seen(model, state, step, i, on, tau):
    """Coordinate i and its velocity at time tau of the step; against coordinate `on` if that is not -1."""
    q, u = coordinate_within(model, state, step, i, tau)
    if on >= 0:
        there, speed = coordinate_within(model, state, step, on, tau)
        return q - there, u - speed
    return q, u


@kernel
def _value(model, state, step, spring, turn, tau):
    i, on, rest = spring
    q, u = _seen(model, state, step, i, on, tau)
    return u if turn else q - rest


@kernel
def _root(model, state, step, spring, turn, end):
    """Time in [0, end] at which the velocity (turn) or the distance from rest changes sign."""
    f_low, f_high = _value(model, state, step, spring, turn, 0.0), _value(model, state, step, spring, turn, end)
    if f_low == 0.0 or f_low * f_high > 0.0:
        return 0.0
    bracket = opened(0.0, f_low, end, f_high)
    tau = next_time(bracket)
    while is_open(bracket, tau, PASSAGE_RESOLUTION * (step.span.start + bracket.high)):
        f = _value(model, state, step, spring, turn, tau)
        bracket = narrowed(bracket, tau, f, f * bracket.f_high > 0.0)
        if f == 0.0:
            break
        tau = next_time(bracket)
    return bracket.low if abs(bracket.f_low) < abs(bracket.f_high) else bracket.high


@kernel
def sign(x):
    """-1, 0 or 1."""
    if x > 0.0:
        return 1
    return -1 if x < 0.0 else 0


@kernel
def keep_passages(model, state, step, end, record):
    """Write down the turning points and rest passages of sprung bodies in the step's first `end` seconds.

    The state's q and u are those at the end; `end` 0 means a jump of velocity at one instant.
    """
    now, n = state.clock.time, len(model.coordinates)
    for spring in range(n + len(model.joints)):
        if spring < n:
            if model.coordinates[spring].watched == 0:
                continue
            i, on, rest = spring, -1, model.coordinates[spring].level
        else:
            joint = model.joints[spring - n]
            if joint.watched == 0:
                continue
            i, on, rest = joint.coordinate, joint.on, joint.rest
        side = sign(along(state.u, i, on))
        if side != 0 and side != state.side_u[i]:
            if state.side_u[i] != 0:
                tau = _root(model, state, step, (i, on, rest), True, end) if end > 0.0 else 0.0
                q = _seen(model, state, step, i, on, tau)[0] if end > 0.0 else along(state.q, i, on)
                state.clock.time = now - end + tau
                keep_event(state, record, EventKind.TURN, -1, model.coordinates[i].body, q)
            state.side_u[i] = side
        side = sign(along(state.q, i, on) - rest)
        if side != 0 and side != state.side_q[i]:
            if state.side_q[i] != 0 and end > 0.0:
                tau = _root(model, state, step, (i, on, rest), False, end)
                state.clock.time = now - end + tau
                speed = _seen(model, state, step, i, on, tau)[1]
                keep_event(state, record, EventKind.CROSS, -1, model.coordinates[i].body, speed)
            state.side_q[i] = side
        state.clock.time = now
