"""What is a curve that arcs are to follow?

A plane curve, rational between its breaks: splines and ellipses are of this kind exactly. Its spans are rational Béziers
(G. Farin, Curves and Surfaces for CAGD, ch. 5 and 13), whose homogeneous coordinates are polynomials: their range can be
bounded without doubt.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Curve:
    """Control points (spans, degree + 1, 3), homogeneous: x·w, y·w, w in metres; and the ascending breaks (spans + 1,)."""

    control: Array
    breaks: Array

    @property
    def degree(self) -> int:
        return self.control.shape[1] - 1

    @property
    def ends(self) -> Array:
        """The first and the last point (2, 2), metres."""
        ends = np.stack((self.control[0, 0], self.control[-1, -1]))
        result: Array = ends[:, :2] / ends[:, 2:]
        return result

    def open_by(self) -> float:
        """The distance between its ends over the length of its control polygon, which is longer than the curve."""
        corners = (self.control[..., :2] / self.control[..., 2:]).reshape(-1, 2)
        sides = np.diff(corners, axis=0)
        length = float(np.sum(np.hypot(sides[:, 0], sides[:, 1])))
        return math.dist(corners[0], corners[-1]) / length if length > 0.0 else math.inf

    def spans(self, first: int, last: int) -> Curve:
        """The spans from `first` to the one before `last`."""
        return Curve(self.control[first:last], self.breaks[first : last + 1])

    def split(self, place: float) -> tuple[Curve, Curve]:
        """The curve up to a place and from there; a place is the number of a span and, after the point, its share."""
        k = int(place)
        u = place - k
        if u == 0.0:
            return self.spans(0, k), self.spans(k, len(self.control))
        middle = (1.0 - u) * self.breaks[k] + u * self.breaks[k + 1]
        before, after = halves(self.control[k], u)
        return (
            Curve(np.concatenate((self.control[:k], before[None])), np.append(self.breaks[: k + 1], middle)),
            Curve(np.concatenate((after[None], self.control[k + 1 :])), np.append(middle, self.breaks[k + 1 :])),
        )


def halves(control: Array, u: float) -> tuple[Array, Array]:
    """The control points (degree + 1, 3) of a Bézier up to its parameter u and from there, by de Casteljau's scheme."""
    before, after, level = [control[0]], [control[-1]], control
    while len(level) > 1:
        level = (1.0 - u) * level[:-1] + u * level[1:]
        before.append(level[0])
        after.append(level[-1])
    return np.array(before), np.array(after[::-1])


def binomials(degree: int) -> Array:
    return np.array([math.comb(degree, k) for k in range(degree + 1)], dtype=float)


def bernstein_sum(scaled: Array, u: Array) -> Array:
    """The polynomials of coefficients times binomials, (degree + 1, …), at u (…) from 0 to 1."""
    v, power, total = 1.0 - u, u, np.asarray(scaled[0])
    for k in range(1, len(scaled)):
        total = np.multiply(total, v, out=total if k > 1 else None)
        total += scaled[k] * power
        if k + 1 < len(scaled):
            power = power * u
    return np.broadcast_to(total, np.broadcast_shapes(total.shape, u.shape))
