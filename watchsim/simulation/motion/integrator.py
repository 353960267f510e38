"""How is one smooth step made where contacts couple bodies?

Explicit Runge-Kutta of order 8 with error control and a continuous extension of order 7 (Hairer, Noersett & Wanner 1993,
II.5, II.6), in which events are found without stepping again. Where the extension misses more than the step, it is repeated.
"""

from __future__ import annotations

import math

from watchsim.dynamics.small_systems import copy
from watchsim.jit import kernel
from watchsim.simulation.loop_state.scratch import COUPLED, SUMS
from watchsim.simulation.motion.coupled_motion import engage, motion
from watchsim.simulation.motion.dense_output import dense, dense_value
from watchsim.simulation.motion.dop853 import E3, E5, STAGES, A, C, D
from watchsim.simulation.motion.step_path import bound_accelerations
from watchsim.tolerances import SMALLEST_STEP

# Safety is smaller than usual: the motion of coupled bodies grows sharper from step to step, and repeating a step costs more
# than shortening it.
SAFETY, SHRINK, GROW = 0.78, 0.2, 6.0

# After what share of a step the extension's defect is largest, and how many tolerances it may be. The path is off by a fifth of
# its defect. In lever scenes that is at most 6 tolerances, in a step that has grown too fast 200.
PROBE, DEFECT = 0.75, 30.0


@kernel
def _stage(model, state, options, s, h, scratch):
    """Derivative of stage s into `stages[s]`; returns the smallest monitor."""
    step, smooth = scratch.step, scratch.smooth
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
    smallest = motion(model, state, options, step.span.start + C[s] * h, scratch.work, smooth)
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
def _extend(model, state, options, h, scratch):
    """Coefficients of the continuous extension into `dense`; returns the smallest monitor at its stages."""
    step, smallest = scratch.step, math.inf
    for s in range(STAGES + 1, STAGES + 4):
        smallest = min(smallest, _stage(model, state, options, s, h, scratch))
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
def coupled_step(model, state, options, longest, scratch):
    """One accepted step of at most `longest` seconds from the state, left in `scratch.step`.

    Returns (made: False if it gets too small, the smallest monitor met at its stages). Proposes the next length in
    `state.clock.step`.
    """
    step = scratch.step
    n = len(model.coordinates)
    step.span.kind, step.span.start = COUPLED, state.clock.time
    for i in range(n):
        step.q[i], step.u[i] = state.q[i], state.u[i]
        step.y0[i], step.y0[n + i] = state.q[i], state.u[i]
    for i in range(SUMS):
        step.y0[2 * n + i] = 0.0
    engage(model, state, scratch.smooth)
    h = min(state.clock.step, longest)
    shrunk = False
    at_start = _stage(model, state, options, 0, h, scratch)  # whatever the length of the step
    copy(scratch.smooth.monitors, scratch.smooth.before)
    while True:
        smallest = at_start
        for s in range(1, STAGES + 1):
            smallest = min(smallest, _stage(model, state, options, s, h, scratch))
        for i in range(len(step.y0)):
            step.y1[i] = scratch.smooth.y[i]
        error = _error(model, options, h, step)
        if error <= 1.0:
            step.span.length = h
            smallest = min(smallest, _extend(model, state, options, h, scratch))
            defect = _defect(model, options, h, step)
            error = defect if defect > 1.0 else error
        factor = min(GROW, max(SHRINK, SAFETY * error**-0.125)) if error > 0.0 else GROW
        if error <= 1.0:
            break
        if not h > SMALLEST_STEP * options.max_step:
            return False, smallest
        state.counts.rejected_steps += 1
        shrunk = True
        h *= factor if error < math.inf else SHRINK
    proposed = h * (min(1.0, factor) if shrunk else factor)
    if not shrunk:  # a step cut short by `longest` says nothing against a longer next one
        proposed = max(proposed, min(state.clock.step, h * GROW))
    state.clock.step = min(options.max_step, proposed)
    bound_accelerations(step, n)
    state.counts.steps += 1
    return True, smallest
