"""How is one smooth step made where contacts couple bodies?

Explicit Runge-Kutta of order 8 with error control and a continuous extension of order 7 (Hairer, Noersett & Wanner 1993,
II.5, II.6), in which events are found without stepping again. Where the extension misses more than the step, it is repeated.
"""

from __future__ import annotations

import math

from watchsim.contact.gaps import STICK
from watchsim.dynamics.delassus import copy
from watchsim.jit import kernel
from watchsim.simulation.coupled_motion import EXTENT, TANGENTIAL, engage, motion
from watchsim.simulation.dop853 import E3, E5, STAGES, A, C, D, dense, dense_value
from watchsim.simulation.free_motion import is_open, narrowed, next_time, opened, turning_time
from watchsim.simulation.options import longest_step
from watchsim.simulation.scratch import COUPLED, MONITORS, SUMS
from watchsim.simulation.step_path import bound_accelerations
from watchsim.tolerances import ROOT_RESOLUTION, SLIP_SLACK, SMALLEST_STEP, WITHIN_ENDS

# When, within a coupled step, does a decided mode end?

SAMPLES = 8
NONE_FIRED = -1  # in the place of a monitor's code


@kernel
def _slack(model, regime, options, code, smooth):
    """How far beyond zero velocity the monitors of slips and of moving bearings fire; the reversal is where it vanishes."""
    j = code - MONITORS * smooth.held.contacts
    if j >= 0:
        if regime.grip[j] == STICK:
            return 0.0
        return 0.5 * smooth.held.lenience * options.speed_zero / options.size * model.coordinates[j].scale
    slides = code % MONITORS == TANGENTIAL and regime.mode[regime.active[code // MONITORS]] != STICK
    return smooth.held.lenience * SLIP_SLACK * options.speed_zero if slides else 0.0


@kernel
def _evaluate(model, regime, options, tau, smooth, out_counts):
    """Evaluate the motion, and with it all monitors, at time tau of the step; returns the smallest."""
    step = smooth.step
    for i in range(len(smooth.y)):
        smooth.y[i] = dense_value(step, i, tau)
    return motion(model, regime, options, step.span.start + tau, smooth, out_counts)


@kernel
def _root(model, regime, options, which, low, high, smooth, out_counts):
    """Time at which one monitor, positive at low, passes zero; `high` where it is still positive then.

    The monitors at low are in `smooth.before`, those at high in `smooth.monitors`.
    """
    monitors = smooth.monitors
    f_low, f_high = smooth.before[which], monitors[which]
    if f_high > 0.0:
        return high  # another one has fired before
    slack = _slack(model, regime, options, which, smooth)
    if f_low <= slack:
        slack = 0.0
    f_low -= slack
    f_high -= slack
    bracket = opened(low, f_low, high, f_high)
    tau = next_time(bracket)
    while is_open(bracket, tau, ROOT_RESOLUTION * (smooth.step.span.start + bracket.high)):
        _evaluate(model, regime, options, tau, smooth, out_counts)
        f = monitors[which] - slack
        bracket = narrowed(bracket, tau, f, f <= 0.0)
        if f == 0.0:
            break
        tau = next_time(bracket)
    return bracket.high


@kernel
def first_leave(model, regime, options, smallest, smooth, out_counts):
    """(time, code of the monitor): when in the coupled step one is first no longer positive; infinity if all stay positive.

    `smallest`: the smallest monitor at the stages of the step. Beyond the end of a primitive forces mean nothing: where two
    contacts change places, the one that pulls before pushes then, so that monitors are read again just before one leaves.
    """
    if smallest > 0.0:
        return math.inf, NONE_FIRED
    length = smooth.step.span.length
    codes = MONITORS * smooth.held.contacts + len(model.coordinates)
    for code in range(codes):
        if smooth.before[code] <= 0.0:
            return 0.0, code
    before = 0.0
    for sample in range(1, SAMPLES + 1):
        tau = length * sample / SAMPLES
        if _evaluate(model, regime, options, tau, smooth, out_counts) <= 0.0:
            return _first_before(model, regime, options, before, tau, smooth, out_counts)
        before = tau
        copy(smooth.monitors, smooth.before)
    return math.inf, NONE_FIRED


@kernel
def _first_before(model, regime, options, before, tau, smooth, out_counts):
    """(time, code of the monitor): the first to end between `before`, where all are positive, and tau, where some are not."""
    best, code, left = _earliest(model, regime, options, before, tau, smooth, out_counts)
    for _ in range(SAMPLES):
        if not (left and before < best and smooth.held.contacts > 1):
            break
        tau = _while_within(options, before, best, smooth)
        if _evaluate(model, regime, options, tau, smooth, out_counts) > 0.0:
            break
        best, code, left = _earliest(model, regime, options, before, tau, smooth, out_counts)
    return best, code


@kernel
def _while_within(options, before, best, smooth):
    """A time just before `best`, at which the contacts that have left by then were within their primitives."""
    nearest = math.inf
    for j in range(smooth.held.contacts):
        nearest = min(nearest, smooth.before[MONITORS * j + EXTENT])
    return best - min(WITHIN_ENDS * options.extent / nearest, 0.5) * (best - before)


@kernel
def _earliest(model, regime, options, before, tau, smooth, out_counts):
    """The earliest root among the monitors that fire at tau and not `before`; its code; had a contact left by tau?"""
    fired, left = 0, False
    for code in range(MONITORS * smooth.held.contacts + len(model.coordinates)):
        if smooth.monitors[code] <= 0.0:
            smooth.fired[fired] = code
            fired += 1
            left = left or (code < MONITORS * smooth.held.contacts and code % MONITORS == EXTENT)
    best, first = tau, smooth.fired[0]
    for j in range(fired):
        if j > 0:
            _evaluate(model, regime, options, best, smooth, out_counts)
        root = _root(model, regime, options, smooth.fired[j], before, best, smooth, out_counts)
        if root < best:
            best, first = root, smooth.fired[j]
    return best, first, left


@kernel
def first_turn(model, regime, q, u):
    """First time in an exact flight at which a bearing with dry friction comes to a stop; infinity if none does."""
    first = math.inf
    for i in range(len(model.coordinates)):
        if regime.awake[i] and model.coordinates[i].coulomb > 0.0:
            if regime.grip[i] * u[i] < 0.0:
                return 0.0  # it turned at the very end of the last flight
            first = min(first, turning_time(model.coordinates[i], regime.grip[i], q[i], u[i]))
    return first


# Safety is smaller than usual: the motion of coupled bodies grows sharper from step to step, and repeating a step costs more
# than shortening it.
SAFETY, SHRINK, GROW = 0.78, 0.2, 6.0

# After what share of a step the extension's defect is largest, and how many tolerances it may be. The path is off by a fifth of
# its defect. In lever scenes that is at most 6 tolerances, in a step that has grown too fast 200.
PROBE, DEFECT = 0.75, 30.0


@kernel
def _stage(model, regime, options, s, h, smooth, out_counts):
    """Derivative of stage s into `stages[s]`; returns the smallest monitor."""
    step = smooth.step
    y0, y, stages = step.y0, smooth.y, step.stages
    width = len(y0)
    for i in range(width):
        y[i] = 0.0
    for j in range(s):
        share = A[s, j]
        if share != 0.0:
            for i in range(width):
                y[i] += share * stages[j, i]
    for i in range(width):
        y[i] = y0[i] + h * y[i]
    smallest = motion(model, regime, options, step.span.start + C[s] * h, smooth, out_counts)
    copy(smooth.dy, stages[s])
    return smallest


@kernel
def _error(model, options, h, step):
    """Estimated error of the step over the tolerance; above 1 it must be repeated."""
    n = len(model.coordinates)
    five, three = 0.0, 0.0
    for i in range(2 * n):
        coordinate = model.coordinates[i % n]
        scale = coordinate.scale
        if i >= n:
            scale = max(scale * coordinate.rate, abs(step.y0[i]), abs(step.y1[i]))
        e5, e3 = 0.0, 0.0
        for s in range(STAGES + 1):
            e5 += E5[s] * step.stages[s, i]
            e3 += E3[s] * step.stages[s, i]
        five += (e5 / scale) ** 2
        three += (e3 / scale) ** 2
    if five == 0.0:
        return 0.0
    return abs(h) * five / math.sqrt((five + 0.01 * three) * 2 * n) / options.tolerance


@kernel
def _extend(model, regime, options, h, smooth, out_counts):
    """Coefficients of the continuous extension into `dense`; returns the smallest monitor at its stages."""
    step, smallest = smooth.step, math.inf
    for s in range(STAGES + 1, STAGES + 4):
        smallest = min(smallest, _stage(model, regime, options, s, h, smooth, out_counts))
    for i in range(len(step.y0)):
        change = step.y1[i] - step.y0[i]
        first, last = h * step.stages[0, i], h * step.stages[STAGES, i]
        step.dense[0, i] = change
        step.dense[1, i] = first - change
        step.dense[2, i] = 2.0 * change - last - first
        for row in range(4):
            total = 0.0
            for s in range(STAGES + 4):
                total += D[row, s] * step.stages[s, i]
            step.dense[3 + row, i] = h * total
    return smallest


@kernel
def _defect(model, options, h, step):
    """How far the slope of the extended places is from the extended velocities, over what it may be; above 1: to be repeated.

    Neither is exact, and the error of both has the order of h^8. Times the step, so that it compares with a place.
    """
    n = len(model.coordinates)
    worst = 0.0
    for i in range(n):
        slope = dense(step, i, PROBE * h)[1]
        worst = max(worst, abs(slope - dense_value(step, n + i, PROBE * h)) / model.coordinates[i].scale)
    return abs(h) * worst / (DEFECT * options.tolerance)


@kernel
def coupled_step(model, state, options, longest, smooth):
    """One accepted step of at most `longest` seconds from the state, left in `smooth.step`.

    Returns (made: False if it gets too small, the smallest monitor met at its stages). Proposes the next length in
    `state.clock.step`.
    """
    step, regime = smooth.step, state.regime
    n = len(model.coordinates)
    step.span.kind, step.span.start = COUPLED, state.clock.time
    for i in range(n):
        step.q[i], step.u[i], step.awake[i], step.grip[i] = state.q[i], state.u[i], regime.awake[i], regime.grip[i]
        step.y0[i], step.y0[n + i] = state.q[i], state.u[i]
    for i in range(SUMS):
        step.y0[2 * n + i] = 0.0
    engage(model, regime.active, state.instant, smooth)
    h = min(state.clock.step, longest)
    shrunk = False
    at_start = _stage(model, regime, options, 0, h, smooth, state.counts)  # whatever the length of the step
    copy(smooth.monitors, smooth.before)
    while True:
        smallest = at_start
        for s in range(1, STAGES + 1):
            smallest = min(smallest, _stage(model, regime, options, s, h, smooth, state.counts))
        for i in range(len(step.y0)):
            step.y1[i] = smooth.y[i]
        error = _error(model, options, h, step)
        if error <= 1.0:
            step.span.length = h
            smallest = min(smallest, _extend(model, regime, options, h, smooth, state.counts))
            defect = _defect(model, options, h, step)
            error = defect if defect > 1.0 else error
        factor = min(GROW, max(SHRINK, SAFETY * error**-0.125)) if error > 0.0 else GROW
        if error <= 1.0:
            break
        if not h > SMALLEST_STEP * longest_step(options, state.clock.time):
            return False, smallest
        state.counts.rejected_steps += 1
        shrunk = True
        h *= factor if error < math.inf else SHRINK
    proposed = h * (min(1.0, factor) if shrunk else factor)
    if not shrunk:  # a step cut short by `longest` says nothing against a longer next one
        proposed = max(proposed, min(state.clock.step, h * GROW))
    state.clock.step = min(longest_step(options, state.clock.time), proposed)
    bound_accelerations(step, n)
    state.counts.steps += 1
    return True, smallest
