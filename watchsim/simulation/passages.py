"""When did a sprung body turn back, and when did it pass its rest position?"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.simulation.keep import keep_event
from watchsim.simulation.within import coordinate_within

TURN_EVENT, CROSS_EVENT = 8, 9
HALVINGS = 100


@kernel
def _value(model, state, step, i, turn, tau):
    q, u = coordinate_within(model, state, step, i, tau)
    return u if turn else q - model.coordinates[i].rest


@kernel
def _root(model, state, step, i, turn, end):
    """Time in [0, end] at which the velocity (turn) or the distance from rest changes sign: Illinois' method."""
    low, high = 0.0, end
    f_low, f_high = _value(model, state, step, i, turn, low), _value(model, state, step, i, turn, high)
    if f_low == 0.0 or f_low * f_high > 0.0:
        return low
    side = 0
    for _ in range(HALVINGS):
        middle = (low * f_high - high * f_low) / (f_high - f_low)
        if not low < middle < high or high - low <= 1e-16 * (step.span[0] + high):
            break
        f = _value(model, state, step, i, turn, middle)
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
def _sign(x):
    if x > 0.0:
        return 1
    return -1 if x < 0.0 else 0


@kernel
def keep_passages(model, state, step, end, record):
    """Write down the turning points and rest passages of sprung bodies in the step's first `end` seconds.

    The state's q and u are those at the end; `end` 0 means a jump of velocity at one instant.
    """
    now = state.clock[0]
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if coordinate.stiffness == 0.0:
            continue
        side = _sign(state.u[i])
        if side != 0 and side != state.side_u[i]:
            if state.side_u[i] != 0:
                tau = _root(model, state, step, i, True, end) if end > 0.0 else 0.0
                q = coordinate_within(model, state, step, i, tau)[0] if end > 0.0 else state.q[i]
                state.clock[0] = now - end + tau
                keep_event(state, record, TURN_EVENT, -1, coordinate.body, q)
            state.side_u[i] = side
        side = _sign(state.q[i] - coordinate.rest)
        if side != 0 and side != state.side_q[i]:
            if state.side_q[i] != 0 and end > 0.0:
                tau = _root(model, state, step, i, False, end)
                state.clock[0] = now - end + tau
                keep_event(state, record, CROSS_EVENT, -1, coordinate.body, coordinate_within(model, state, step, i, tau)[1])
            state.side_q[i] = side
        state.clock[0] = now
