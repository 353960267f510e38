"""Where is a function zero?

Of the library's own methods none is used here: scipy.optimize takes half a second to load, for which every command that draws
a Swiss lever, down to the refusal of a misspelt key, would have to wait.
"""

from __future__ import annotations

from collections.abc import Callable

ROUNDING = 2.0**-51  # of the zero, to which it is found at best


def zero_between(function: Callable[[float], float], low: float, high: float, within: float) -> float:
    """A zero of the function, known to `within`. ValueError where both ends have the same sign.

    By inverse quadratic interpolation where the three last points allow it, else by bisection (T. R. Chandrupatla, Advances in
    Engineering Software 28 (1997) 145-149).
    """
    newest, other = high, low
    f_newest, f_other = function(newest), function(other)
    if not f_newest * f_other <= 0.0:
        raise ValueError(f"the function has the same sign at {low:g} and {high:g}")
    share = 0.5  # of the way from the newest point to the other end of the bracket
    while True:
        best = newest if abs(f_newest) < abs(f_other) else other
        least = (within + ROUNDING * abs(best)) / abs(other - newest) if other != newest else 1.0
        if least > 0.5 or 0.0 in (f_newest, f_other):
            return best
        point = newest + min(max(share, least), 1.0 - least) * (other - newest)
        value = function(point)
        if value * f_newest > 0.0:
            before, f_before = newest, f_newest
        else:
            before, f_before, other, f_other = other, f_other, newest, f_newest
        newest, f_newest = point, value
        along, up = (newest - other) / (before - other), (f_newest - f_other) / (f_before - f_other)
        share = 0.5
        if up * up < along and (1.0 - up) * (1.0 - up) < 1.0 - along:
            share = f_newest / (f_other - f_newest) * f_before / (f_other - f_before)
            share += (before - newest) / (other - newest) * f_newest / (f_before - f_newest) * f_other / (f_before - f_other)
