"""How does an uncoupled coordinate move? Exactly.

m q'' = f - c q' - k (q - rest) with constant f: any damping, with or without a spring, in closed form. Dry friction of the
bearing is part of f until the velocity vanishes.
"""

from __future__ import annotations

import math

from watchsim.jit import hot_kernel, kernel

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
