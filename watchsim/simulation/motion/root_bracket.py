"""Where, between two times with values of opposite sign, is a zero?

Illinois' method, with a bisection where three steps have not halved the bracket: a function that is flat at one end and steep
at the other, as the least of several margins is, would hold the method back for ever. The caller evaluates:

    bracket = opened(low, f_low, high, f_high)
    time = next_time(bracket)
    while is_open(bracket, time, resolution):
        bracket = narrowed(bracket, time, f := ..., on_high_side)
        time = next_time(bracket)
"""

from __future__ import annotations

from typing import NamedTuple

from watchsim.jit import kernel

MOST = 250  # evaluations at most: bisections alone reach the rounding of time before
LOOK_EVERY = 3

NEITHER, LOW, HIGH = 0, -1, 1


class Bracket(NamedTuple):
    """Two times with values of opposite sign; a value that has been kept twice in a row is halved (Illinois)."""

    low: float
    f_low: float
    high: float
    f_high: float
    moved: int  # the end that was moved last
    looks: int  # evaluations so far
    before: float  # width at the last of every third evaluations


@kernel
def opened(low, f_low, high, f_high):
    """The bracket to begin with."""
    return Bracket(low, f_low, high, f_high, NEITHER, 0, 2.0 * (high - low))


@kernel
def next_time(bracket):
    """The time to evaluate next; not strictly within the bracket where nothing is."""
    low, high = bracket.low, bracket.high
    middle = (low * bracket.f_high - high * bracket.f_low) / (bracket.f_high - bracket.f_low)
    is_slow = bracket.looks % LOOK_EVERY == 0 and high - low > 0.5 * bracket.before
    if is_slow or not low < middle < high:
        middle = 0.5 * (low + high)
    return middle


@kernel
def is_open(bracket, time, resolution):
    """True while the bracket is wider than `resolution` and something lies within it."""
    if bracket.looks >= MOST or bracket.high - bracket.low <= resolution:
        return False
    return bracket.low < time < bracket.high


@kernel
def narrowed(bracket, time, f, on_high_side):
    """The bracket after the value f at `time`, which replaces the upper end or the lower one."""
    before = bracket.high - bracket.low if bracket.looks % LOOK_EVERY == 0 else bracket.before
    if on_high_side:
        f_low = 0.5 * bracket.f_low if bracket.moved == HIGH else bracket.f_low
        return Bracket(bracket.low, f_low, time, f, HIGH, bracket.looks + 1, before)
    f_high = 0.5 * bracket.f_high if bracket.moved == LOW else bracket.f_high
    return Bracket(time, f, bracket.high, f_high, LOW, bracket.looks + 1, before)
