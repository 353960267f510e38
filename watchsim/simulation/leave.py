"""When, within a coupled step, does a decided mode end?"""

from __future__ import annotations

import math

from watchsim.contact.index_sets import STICK
from watchsim.jit import kernel
from watchsim.simulation.coupled import MONITORS, monitor, motion
from watchsim.simulation.integrator import dense_value

SAMPLES = 8
HALVINGS = 60


@kernel
def _evaluate(model, state, options, tau, scratch):
    """Evaluate the motion at time tau of the step, so that all monitors can be read."""
    for i in range(len(scratch.y)):
        scratch.y[i] = dense_value(scratch.step, i, tau)
    # `motion` reads `scratch.y` and writes `scratch.dy`.
    motion(model, state, options, scratch.step.span[0] + tau, scratch.y, scratch)


@kernel
def _root(model, state, options, which, low, high, scratch):
    """Time at which one monitor (4 i + kind) passes zero between low (positive) and high (not positive): Illinois' method."""
    i, kind = which // 4, which % 4
    _evaluate(model, state, options, low, scratch)
    f_low = monitor(model, state, scratch, options, i, kind)
    _evaluate(model, state, options, high, scratch)
    f_high = monitor(model, state, scratch, options, i, kind)
    if not f_low > 0.0:
        return low
    # A slip monitor fires a little beyond zero slip; the reversal itself is where the slip vanishes.
    slack = 0.5 * options.speed_zero if kind == 1 and state.mode[scratch.closed.ids[i]] != STICK else 0.0
    if f_low <= slack:
        slack = 0.0
    f_low -= slack
    f_high -= slack
    side = 0
    for _ in range(HALVINGS):
        if high - low <= 1e-15 * (scratch.step.span[0] + high):
            break
        middle = (low * f_high - high * f_low) / (f_high - f_low)
        if not low < middle < high:
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
        _evaluate(model, state, options, middle, scratch)
        f = monitor(model, state, scratch, options, i, kind) - slack
        if f <= 0.0:
            high, f_high = middle, f
            if side == 1:
                f_low *= 0.5
            side = 1
            if f == 0.0:
                break
        else:
            low, f_low = middle, f
            if side == -1:
                f_high *= 0.5
            side = -1
    return high


@kernel
def first_leave(model, state, options, scratch):
    """First time in the coupled step at which a monitor is no longer positive; infinity if all stay positive."""
    if scratch.alarm[0] > 0.0:
        return math.inf
    length = scratch.step.span[1]
    before = 0.0
    for sample in range(SAMPLES + 1):
        tau = length * sample / SAMPLES
        scratch.alarm[0] = math.inf
        _evaluate(model, state, options, tau, scratch)
        if scratch.alarm[0] <= 0.0:
            return _earliest(model, state, options, before, tau, scratch)
        before = tau
    return math.inf


@kernel
def _earliest(model, state, options, before, tau, scratch):
    """The earliest root among the monitors that are not positive at tau, all of them positive at `before`."""
    if tau == 0.0:
        return 0.0
    fired = 0
    m = state.numbers[0]
    for i in range(m):
        for kind in range(MONITORS):
            if monitor(model, state, scratch, options, i, kind) <= 0.0:
                scratch.closed.slots[fired + m] = 4 * i + kind
                fired += 1
                if fired + m == len(scratch.closed.slots):
                    break
    best = tau
    for j in range(fired):
        best = min(best, _root(model, state, options, scratch.closed.slots[m + j], before, best, scratch))
    return best
