"""What is a curve that arcs shall follow?

A plane curve, rational between its breaks: splines and ellipses are of this kind exactly. Homogeneous coordinates keep
it a polynomial, whose range can be bounded without doubt.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PAUSE = 1e-5  # of the usual speed: below that the derivative shows no direction
GLANCE = 1e-5  # of the range of the parameter: so far ahead the direction is looked for where the curve pauses


@dataclass(frozen=True)
class Curve:
    """Parameters (n,) to homogeneous points (n, 3): x·w, y·w, w in metres, and their derivatives (n, 3).

    Between neighbours of the ascending `breaks` every column is a polynomial of at most `degree`.
    """

    homogeneous: Callable[[Array], Array]
    derivative: Callable[[Array], Array]
    breaks: Array
    degree: int

    def points(self, t: Array) -> Array:
        """Points (n, 2), metres."""
        h = self.homogeneous(t)
        return h[:, :2] / h[:, 2:] if self.weighted else h[:, :2]

    def slopes(self, t: Array) -> Array:
        """Derivatives (n, 2) of the points, by the quotient rule."""
        dh = self.derivative(t)
        if not self.weighted:
            return dh[:, :2]
        h = self.homogeneous(t)
        return (dh[:, :2] - h[:, :2] * (dh[:, 2:] / h[:, 2:])) / h[:, 2:]

    def tangents(self, t: Array, low: float, high: float) -> Array:
        """Unit tangents (n, 2) of the part from `low` to `high`; where it pauses, the direction beside."""
        slopes = self.slopes(t)
        speed = np.hypot(slopes[:, 0], slopes[:, 1])
        still = speed <= PAUSE * self.usual_speed
        if np.any(still):
            reach = GLANCE * (high - low)
            slopes[still] = self.slopes(np.where(t[still] + reach <= high, t[still] + reach, t[still] - reach))
            speed = np.hypot(slopes[:, 0], slopes[:, 1])
        return slopes / np.where(speed > 0.0, speed, 1.0)[:, None]

    @cached_property
    def weighted(self) -> bool:
        """Is there a weight other than one?"""
        w = self.homogeneous(np.linspace(self.breaks[0], self.breaks[-1], self.degree * (len(self.breaks) - 1) + 1))[:, 2]
        return bool(np.any(w != 1.0))

    @cached_property
    def usual_speed(self) -> float:
        """Length over range of the parameter, roughly: of the polygon through the breaks and a few points in between."""
        t = np.unique(np.concatenate((self.breaks, np.linspace(self.breaks[0], self.breaks[-1], 33))))
        sides = np.diff(self.points(t), axis=0)
        return float(np.sum(np.hypot(sides[:, 0], sides[:, 1]))) / float(t[-1] - t[0])

    def between(self, low: float, high: float) -> Array:
        """The breaks strictly between two parameters."""
        return self.breaks[np.searchsorted(self.breaks, low, "right") : np.searchsorted(self.breaks, high, "left")]
