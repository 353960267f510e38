"""How does a body move whose motion is prescribed, whatever it meets?

With q'' = a(t) - w² (q - middle): a constant speed has neither, a swing has w, a path has a(t).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Prescribed:
    """The law of a driven coordinate, in SI units.

    `square` (1/s²) is w² of a swing about `middle` (rad or m); `table` holds times (s) and accelerations (rad/s² or m/s²)
    of a path, between which the acceleration is linear; it is zero at both ends. Start and start velocity are the body's.
    """

    square: float = 0.0
    middle: float = 0.0
    table: tuple[tuple[float, float], ...] = ()


def swing(middle: float, amplitude: float, frequency: float, phase: float) -> tuple[Prescribed, float, float]:
    """q = middle + amplitude sin(2π frequency t + phase): the law, q and q' at t = 0."""
    w = math.tau * frequency
    start = middle + amplitude * math.sin(phase)
    return Prescribed(square=w * w, middle=middle), start, amplitude * w * math.cos(phase)


def path(points: Sequence[tuple[float, float]]) -> Prescribed:
    """The smoothest way through two or more points (time in s, coordinate), from rest to rest.

    The acceleration is linear between the points and zero at both ends, so that nothing jerks there; that takes two more
    knots, which divide the first and the last stretch (a single one in three). The later points and the rest at the end
    are as many equations as there are accelerations to find.
    """
    t, q = np.array(points, float).T
    knots = _divided(t)
    inner = len(knots) - 2
    way, speed = np.zeros((len(t) - 1, inner)), np.zeros(inner)
    for j in range(inner):
        pulse = np.zeros(len(knots))
        pulse[j + 1] = 1.0
        u, s = _integrated(knots, pulse)
        way[:, j], speed[j] = s[np.searchsorted(knots, t[1:])], u[-1]
    # Lengths against speeds times the whole time, so that the equations are of one size.
    rows = np.vstack([way, speed * (t[-1] - t[0])])
    found = np.linalg.solve(rows, np.concatenate([q[1:] - q[0], [0.0]]))
    return Prescribed(table=tuple(zip(knots.tolist(), [0.0, *found.tolist(), 0.0], strict=True)))


def _divided(t: np.ndarray) -> np.ndarray:
    if len(t) == 2:
        return np.linspace(t[0], t[1], 4)
    return np.sort(np.concatenate([t, [0.5 * (t[0] + t[1]), 0.5 * (t[-2] + t[-1])]]))


def _integrated(knots: np.ndarray, a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Velocity and way at the knots, from rest, of an acceleration that is linear between them: exactly."""
    h = np.diff(knots)
    u = np.concatenate([[0.0], np.cumsum(0.5 * h * (a[:-1] + a[1:]))])
    s = np.concatenate([[0.0], np.cumsum(h * u[:-1] + h * h * (a[:-1] / 3.0 + a[1:] / 6.0))])
    return u, s
