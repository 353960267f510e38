"""When did a sprung body turn back, and when did it pass its rest position?"""

from __future__ import annotations

from watchsim.candidates.cell_lookup import along
from watchsim.jit import kernel
from watchsim.simulation.motion.dense_output import coordinate_within
from watchsim.simulation.motion.root_bracket import LOOK_EVERY, MOST, is_slow, next_time
from watchsim.simulation.record.write_buffers import keep_event

TURN_EVENT, CROSS_EVENT = 8, 9


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
    low, high = 0.0, end
    f_low, f_high = _value(model, state, step, spring, turn, low), _value(model, state, step, spring, turn, high)
    if f_low == 0.0 or f_low * f_high > 0.0:
        return low
    side = 0
    before = 2.0 * (high - low)
    for number in range(MOST):
        middle = next_time(low, f_low, high, f_high, is_slow(number, high - low, before))
        if number % LOOK_EVERY == 0:
            before = high - low
        if not low < middle < high or high - low <= 1e-16 * (step.span.start + high):
            break
        f = _value(model, state, step, spring, turn, middle)
        if f * f_high > 0.0:
            high, f_high = middle, f
            if side == 1:
                f_low *= 0.5
            side = 1
        else:
            low, f_low = middle, f
            if f == 0.0:
                break
            if side == -1:
                f_high *= 0.5
            side = -1
    return low if abs(f_low) < abs(f_high) else high


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
            if joint.stiffness == 0.0:
                continue
            i, on, rest = joint.coordinate, joint.on, joint.rest
        side = sign(along(state.u, i, on))
        if side != 0 and side != state.side_u[i]:
            if state.side_u[i] != 0:
                tau = _root(model, state, step, (i, on, rest), True, end) if end > 0.0 else 0.0
                q = _seen(model, state, step, i, on, tau)[0] if end > 0.0 else along(state.q, i, on)
                state.clock.time = now - end + tau
                keep_event(state, record, TURN_EVENT, -1, model.coordinates[i].body, q)
            state.side_u[i] = side
        side = sign(along(state.q, i, on) - rest)
        if side != 0 and side != state.side_q[i]:
            if state.side_q[i] != 0 and end > 0.0:
                tau = _root(model, state, step, (i, on, rest), False, end)
                state.clock.time = now - end + tau
                speed = _seen(model, state, step, i, on, tau)[1]
                keep_event(state, record, CROSS_EVENT, -1, model.coordinates[i].body, speed)
            state.side_q[i] = side
        state.clock.time = now
