"""How does an uncoupled coordinate move? Exactly.

m q'' = f - c q' - k (q - rest) with constant f: any damping, with or without a spring, in closed form. Dry friction of the
bearing is part of f until the velocity vanishes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from watchsim.jit import hot_kernel, kernel

# Where, between two times with values of opposite sign, is a zero?
#
# Illinois' method, with a bisection where three steps have not halved the bracket: a function that is flat at one end and steep
# at the other, as the least of several margins is, would hold the method back for ever. The caller evaluates:
#
#     bracket = opened(low, f_low, high, f_high)
#     time = next_time(bracket)
#     while is_open(bracket, time, resolution):
#         bracket = narrowed(bracket, time, f := ..., on_high_side)
#         time = next_time(bracket)

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


# How does an uncoupled coordinate move? Exactly.

SERIES = 1e-2  # below it the exponential differences are summed as series: no cancellation


@kernel
def _phi(z):
    """(1 - exp(-z))/z and (z - 1 + exp(-z))/z²."""
    if abs(z) < SERIES:
        first = 1.0 - z / 2.0 * (1.0 - z / 3.0 * (1.0 - z / 4.0 * (1.0 - z / 5.0 * (1.0 - z / 6.0))))
        second = 0.5 * (1.0 - z / 3.0 * (1.0 - z / 4.0 * (1.0 - z / 5.0 * (1.0 - z / 6.0 * (1.0 - z / 7.0)))))
        return first, second
    first = -math.expm1(-z) / z
    return first, (1.0 - first) / z


@kernel
def steady_force(coordinate, grip):
    """The constant force, with the dry friction of a bearing that moves in direction `grip` (0: none)."""
    return coordinate.force - grip * coordinate.coulomb


@hot_kernel
def flow(coordinate, grip, q, u, t):
    """Coordinate and velocity after time t from (q, u)."""
    k, m, force = coordinate.stiffness, coordinate.mass, steady_force(coordinate, grip)
    if k == 0.0:
        pull = force / m
        first, second = _phi(coordinate.viscous * t / m)
        return q + t * (u * first + pull * t * second), u * math.exp(-coordinate.viscous * t / m) + pull * t * first
    decay = 0.5 * coordinate.viscous / m
    square = k / m - decay * decay
    if square > 0.0:
        rate = math.sqrt(square)
        cosine, sine = math.cos(rate * t), math.sin(rate * t) / rate
    elif square < 0.0:
        rate = math.sqrt(-square)
        cosine, sine = math.cosh(rate * t), math.sinh(rate * t) / rate
    else:
        cosine, sine = 1.0, t
    fade = math.exp(-decay * t)
    middle = coordinate.rest + force / k
    x = q - middle
    return middle + fade * (x * cosine + (u + decay * x) * sine), fade * (u * cosine - (k / m * x + decay * u) * sine)


@kernel
def acceleration(coordinate, grip, q, u):
    """q'' at (q, u)."""
    pull = steady_force(coordinate, grip) - coordinate.viscous * u - coordinate.stiffness * (q - coordinate.rest)
    return pull / coordinate.mass


@kernel
def acceleration_bound(coordinate, grip, q, u):
    """A bound of |q''| for all later times of the flight.

    q'' obeys the same linear equation without force, so its energy-like norm never grows:
    q''² + (m/k) q'''² k/m ≤ its start value, with q''' = -(c q'' + k u)/m.
    """
    a = acceleration(coordinate, grip, q, u)
    if coordinate.stiffness == 0.0:
        return abs(a)
    jerk = -(coordinate.viscous * a + coordinate.stiffness * u) / coordinate.mass
    return math.sqrt(a * a + jerk * jerk * coordinate.mass / coordinate.stiffness)


@kernel
def fastest_change(coordinate):
    """What `acceleration_bound` times this bounds: the rate of change of the acceleration. 1/s."""
    if coordinate.stiffness == 0.0:
        return coordinate.viscous / coordinate.mass
    return math.sqrt(coordinate.stiffness / coordinate.mass)


@kernel
def quarter_period(coordinate):
    """A quarter of the undamped period; infinity without a spring."""
    if coordinate.stiffness == 0.0:
        return math.inf
    return 0.5 * math.pi * math.sqrt(coordinate.mass / coordinate.stiffness)


@kernel
def turning_time(coordinate, grip, q, u):
    """The first time after the start of a flight from (q, u) at which the velocity vanishes; infinity if it never does."""
    k, m = coordinate.stiffness, coordinate.mass
    if k == 0.0:
        pull = steady_force(coordinate, grip)
        if not u * pull < 0.0:
            return math.inf
        share = -coordinate.viscous * u / pull
        return m / coordinate.viscous * math.log1p(share) if coordinate.viscous > 0.0 else -m * u / pull
    # exp(decay t) u(t) = u cos(w t) + slope sin(w t) / w, w imaginary where damping is strong.
    decay = 0.5 * coordinate.viscous / m
    square = k / m - decay * decay
    slope = acceleration(coordinate, grip, q, u) + decay * u
    if square > 0.0:
        rate = math.sqrt(square)
        if u == 0.0:
            return math.pi / rate
        side = 1.0 if u > 0.0 else -1.0
        return math.atan2(side * u, -side * slope / rate) / rate
    if not u * slope < 0.0:
        return math.inf
    rate = math.sqrt(-square)
    if rate == 0.0:
        return -u / slope
    share = -u * rate / slope
    return math.atanh(share) / rate if share < 1.0 else math.inf
