"""When does a hairspring come to bear on a curb pin, or leave it?

Its force is smooth on either side of a pin only. A step goes on with the law with which it begins, so that neither error
control nor the extension meets a kink, and ends where the coil passes a pin.
"""

from __future__ import annotations

import math

from watchsim.dynamics.forces import beyond_pins
from watchsim.jit import kernel
from watchsim.simulation.step_path import dense_value, is_open, narrowed, next_time, opened
from watchsim.tolerances import PASSAGE_RESOLUTION

LOW_PIN, BETWEEN_PINS, HIGH_PIN = -1, 0, 1
PIN_SAMPLES = 8
ON_PIN = 1e-12  # rad: a step that begins so near to a pin begins on it


@kernel
def begin_on_pins(model, a, out_step):
    """Which pins the coils bear on at the start of a step, into `out_step.side`; on a pin the motion says it.

    Returns 1 if there are any, else 0.
    """
    found = 0
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if coordinate.pinned == 0.0:
            continue
        found = 1
        way, onward = out_step.q[i] - coordinate.rest, out_step.u[i] if out_step.u[i] != 0.0 else a[i]
        high, low = way - coordinate.pin_high, way - coordinate.pin_low
        is_high = onward > 0.0 if abs(high) <= ON_PIN else high > 0.0
        is_low = onward < 0.0 if abs(low) <= ON_PIN else low < 0.0
        out_step.side[i] = HIGH_PIN if is_high else (LOW_PIN if is_low else BETWEEN_PINS)
    return found


@kernel
def first_pin(model, step):
    """The time of a coupled step at which the first hairspring passes a curb pin; infinity if none does."""
    first = math.inf
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if coordinate.pinned == 0.0:
            continue
        if step.side[i] != LOW_PIN:
            first = min(first, _passes(step, i, coordinate.rest + coordinate.pin_high, step.side[i] == HIGH_PIN))
        if step.side[i] != HIGH_PIN:
            first = min(first, _passes(step, i, coordinate.rest + coordinate.pin_low, step.side[i] != LOW_PIN))
    return first


@kernel
def _passes(step, i, edge, is_above):
    """The first time at which coordinate i, which begins above or below `edge`, is on its other side; infinity if it stays."""
    low, side = 0.0, 1.0 if is_above else -1.0
    f_low = max(side * (step.y0[i] - edge), ON_PIN)
    for sample in range(1, PIN_SAMPLES + 1):
        high = step.span.length * sample / PIN_SAMPLES
        f_high = side * (dense_value(step, i, high) - edge)
        if f_high < 0.0:
            bracket = opened(low, f_low, high, f_high)
            tau = next_time(bracket)
            while is_open(bracket, tau, PASSAGE_RESOLUTION * bracket.high):
                f = side * (dense_value(step, i, tau) - edge)
                bracket = narrowed(bracket, tau, f, f <= 0.0)
                if f == 0.0:
                    break
                tau = next_time(bracket)
            return bracket.high
        low, f_low = high, f_high
    return math.inf


@kernel
def _beyond_of(coordinate, side, way):
    """The same, on one side of the pins or between them and on from there as if there were no other."""
    if side == BETWEEN_PINS:
        return 0.0
    return way - (coordinate.pin_high if side == HIGH_PIN else coordinate.pin_low)


@kernel
def stay_on_side(model, side, q, out_h):
    """Make of the forces of curb pins those on the sides on which a step began."""
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if coordinate.pinned != 0.0:
            way = q[i] - coordinate.rest
            out_h[i] += coordinate.pinned * (beyond_pins(coordinate, way) - _beyond_of(coordinate, side[i], way))


@kernel
def energy_on_side(model, side, q):
    """What the pins store more on the sides on which a step began, J."""
    more = 0.0
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if coordinate.pinned != 0.0:
            way = q[i] - coordinate.rest
            more += 0.5 * coordinate.pinned * (_beyond_of(coordinate, side[i], way) ** 2 - beyond_pins(coordinate, way) ** 2)
    return more
