"""How does an uncoupled coordinate move? Exactly.

m q'' = f - c q' - k (q - rest) with constant f: any damping, with or without a spring, in closed form.
"""

from __future__ import annotations

import math

from watchsim.jit import kernel

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
def flow(coordinate, q, u, t):
    """Coordinate and velocity after time t from (q, u)."""
    k, m = coordinate.stiffness, coordinate.mass
    if k == 0.0:
        pull = coordinate.force / m
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
    middle = coordinate.rest + coordinate.force / k
    x = q - middle
    return middle + fade * (x * cosine + (u + decay * x) * sine), fade * (u * cosine - (k / m * x + decay * u) * sine)


@kernel
def acceleration(coordinate, q, u):
    """q'' at (q, u)."""
    return (coordinate.force - coordinate.viscous * u - coordinate.stiffness * (q - coordinate.rest)) / coordinate.mass


@kernel
def acceleration_bound(coordinate, q, u):
    """A bound of |q''| for all later times of the flight.

    q'' obeys the same linear equation without force, so its energy-like norm never grows:
    q''² + (m/k) q'''² k/m ≤ its start value, with q''' = -(c q'' + k u)/m.
    """
    a = acceleration(coordinate, q, u)
    if coordinate.stiffness == 0.0:
        return abs(a)
    jerk = -(coordinate.viscous * a + coordinate.stiffness * u) / coordinate.mass
    return math.sqrt(a * a + jerk * jerk * coordinate.mass / coordinate.stiffness)


@kernel
def quarter_period(coordinate):
    """A quarter of the undamped period; infinity without a spring."""
    if coordinate.stiffness == 0.0:
        return math.inf
    return 0.5 * math.pi * math.sqrt(coordinate.mass / coordinate.stiffness)
