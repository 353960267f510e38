"""Where, between two times with values of opposite sign, is a zero looked for next?

Illinois' method, with a bisection where three steps have not halved the bracket: a function that is flat at one end and steep
at the other, as the least of several margins is, would hold the method back for ever.
"""

from __future__ import annotations

from watchsim.jit import kernel

MOST = 250  # evaluations at most: bisections alone reach the rounding of time before
LOOK_EVERY = 3
RESOLUTION = 1e-15  # share of the time since the start of the run: closer bounds are the same instant


@kernel
def next_time(low, f_low, high, f_high, halve):
    """The time between `low` and `high` to evaluate next; not strictly between them where nothing is."""
    middle = (low * f_high - high * f_low) / (f_high - f_low)
    if halve or not low < middle < high:
        middle = 0.5 * (low + high)
    return middle


@kernel
def is_slow(number, width, before):
    """True if evaluation `number` should be in the middle: the bracket, now `width`, was `before` three evaluations ago."""
    return number % LOOK_EVERY == 0 and width > 0.5 * before
