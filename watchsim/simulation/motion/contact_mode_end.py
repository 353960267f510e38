"""When, within a coupled step, does a decided mode end?"""

from __future__ import annotations

import math

from watchsim.contact.index_sets import STICK
from watchsim.dynamics.small_systems import copy
from watchsim.jit import kernel
from watchsim.simulation.loop_state.scratch import MONITORS
from watchsim.simulation.motion.coupled_motion import EXTENT, TANGENTIAL, motion
from watchsim.simulation.motion.dense_output import dense_value
from watchsim.simulation.motion.free_motion import turning_time
from watchsim.simulation.motion.root_bracket import is_open, narrowed, next_time, opened
from watchsim.tolerances import ROOT_RESOLUTION, SLIP_SLACK, WITHIN_ENDS

SAMPLES = 8
NONE_FIRED = -1  # in the place of a monitor's code


@kernel
def _slack(model, state, options, code):
    """How far beyond zero velocity the monitors of slips and of moving bearings fire; the reversal is where it vanishes."""
    j = code - MONITORS * state.now.awake_contacts
    if j >= 0:
        if state.grip[j] == STICK:
            return 0.0
        return 0.5 * state.now.lenience * options.speed_zero / options.size * model.coordinates[j].scale
    slides = code % MONITORS == TANGENTIAL and state.mode[state.active[code // MONITORS]] != STICK
    return state.now.lenience * SLIP_SLACK * options.speed_zero if slides else 0.0


@kernel
def _evaluate(model, state, options, tau, scratch):
    """Evaluate the motion, and with it all monitors, at time tau of the step; returns the smallest."""
    step, smooth = scratch.step, scratch.smooth
    for i in range(len(smooth.y)):
        smooth.y[i] = dense_value(step, i, tau)
    return motion(model, state, options, step.span.start + tau, scratch.work, smooth)


@kernel
def _root(model, state, options, which, low, high, scratch):
    """Time at which one monitor, positive at low, passes zero; `high` where it is still positive then.

    The monitors at low are in `smooth.before`, those at high in `smooth.monitors`.
    """
    monitors = scratch.smooth.monitors
    f_low, f_high = scratch.smooth.before[which], monitors[which]
    if f_high > 0.0:
        return high  # another one has fired before
    slack = _slack(model, state, options, which)
    if f_low <= slack:
        slack = 0.0
    f_low -= slack
    f_high -= slack
    bracket = opened(low, f_low, high, f_high)
    tau = next_time(bracket)
    while is_open(bracket, tau, ROOT_RESOLUTION * (scratch.step.span.start + bracket.high)):
        _evaluate(model, state, options, tau, scratch)
        f = monitors[which] - slack
        bracket = narrowed(bracket, tau, f, f <= 0.0)
        if f == 0.0:
            break
        tau = next_time(bracket)
    return bracket.high


@kernel
def first_leave(model, state, options, smallest, scratch):
    """(time, code of the monitor): when in the coupled step one is first no longer positive; infinity if all stay positive.

    `smallest`: the smallest monitor at the stages of the step. Beyond the end of a primitive forces mean nothing: where two
    contacts change places, the one that pulls before pushes then, so that monitors are read again just before one leaves.
    """
    if smallest > 0.0:
        return math.inf, NONE_FIRED
    length, smooth = scratch.step.span.length, scratch.smooth
    codes = MONITORS * state.now.awake_contacts + len(model.coordinates)
    for code in range(codes):
        if smooth.before[code] <= 0.0:
            return 0.0, code
    before = 0.0
    for sample in range(1, SAMPLES + 1):
        tau = length * sample / SAMPLES
        if _evaluate(model, state, options, tau, scratch) <= 0.0:
            return _first_before(model, state, options, before, tau, scratch)
        before = tau
        copy(smooth.monitors, smooth.before)
    return math.inf, NONE_FIRED


@kernel
def _first_before(model, state, options, before, tau, scratch):
    """(time, code of the monitor): the first to end between `before`, where all are positive, and tau, where some are not."""
    best, code, left = _earliest(model, state, options, before, tau, scratch)
    for _ in range(SAMPLES):
        if not (left and before < best and state.now.awake_contacts > 1):
            break
        tau = _while_within(state, options, before, best, scratch)
        if _evaluate(model, state, options, tau, scratch) > 0.0:
            break
        best, code, left = _earliest(model, state, options, before, tau, scratch)
    return best, code


@kernel
def _while_within(state, options, before, best, scratch):
    """A time just before `best`, at which the contacts that have left by then were within their primitives."""
    nearest = math.inf
    for j in range(state.now.awake_contacts):
        nearest = min(nearest, scratch.smooth.before[MONITORS * j + EXTENT])
    return best - min(WITHIN_ENDS * options.extent / nearest, 0.5) * (best - before)


@kernel
def _earliest(model, state, options, before, tau, scratch):
    """The earliest root among the monitors that fire at tau and not `before`; its code; had a contact left by tau?"""
    smooth, fired, left = scratch.smooth, 0, False
    for code in range(MONITORS * state.now.awake_contacts + len(model.coordinates)):
        if smooth.monitors[code] <= 0.0:
            smooth.fired[fired] = code
            fired += 1
            left = left or (code < MONITORS * state.now.awake_contacts and code % MONITORS == EXTENT)
    best, first = tau, smooth.fired[0]
    for j in range(fired):
        if j > 0:
            _evaluate(model, state, options, best, scratch)
        root = _root(model, state, options, smooth.fired[j], before, best, scratch)
        if root < best:
            best, first = root, smooth.fired[j]
    return best, first, left


@kernel
def first_turn(model, state):
    """First time in an exact flight at which a bearing with dry friction comes to a stop; infinity if none does."""
    first = math.inf
    for i in range(len(model.coordinates)):
        if state.awake[i] and model.coordinates[i].coulomb > 0.0:
            if state.grip[i] * state.u[i] < 0.0:
                return 0.0  # it turned at the very end of the last flight
            first = min(first, turning_time(model.coordinates[i], state.grip[i], state.q[i], state.u[i]))
    return first
