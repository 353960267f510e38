"""How are many curves looked at in one go?

Curves of one degree side by side, so that each step is made for all of them at once. A place is one number: spans are
numbered through, one number is left out behind each curve, and the share of the span stands after the point. So the start of
a span is a whole number, and places ascend along a curve and from curve to curve.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.fitting.curve import Array, Curve, bernstein_sum, binomials

Numbers = NDArray[np.intp]

PAUSE = 1e-5  # of the usual speed: below that the derivative shows no direction
GLANCE = 1e-5  # of a span: so far beside the direction is looked for where the curve pauses
LOOKS = 8  # chords of a span that give its length, roughly


class Bundle:
    """Some curves of one degree: `begin` and `end` (curves,) are the places of their ends; `owner` (spans,) their numbers."""

    def __init__(self, curves: Sequence[Curve]) -> None:
        control = np.concatenate([curve.control for curve in curves])
        counts = np.array([len(curve.control) for curve in curves])
        self.degree = control.shape[1] - 1
        self.weighted = bool(np.any(control[..., 2] != 1.0))
        self.widths = np.concatenate([np.diff(curve.breaks) for curve in curves])
        self.owner: Numbers = np.repeat(np.arange(len(curves)), counts)
        self.start_of = np.arange(len(control)) + self.owner
        self.end = np.cumsum(counts + 1) - 1
        self.begin = self.end - counts
        self._span_at = np.repeat(np.arange(len(control)), 1 + (np.diff(self.owner, append=len(curves)) > 0))
        # Coefficients come first, then x, y and the weight if there is one, then the spans.
        columns = np.moveaxis(control, (1, 2), (0, 1))[:, : 3 if self.weighted else 2]
        self._scaled = np.ascontiguousarray(columns * binomials(self.degree)[:, None, None])
        self.corners = control[..., :2] / control[..., 2:]  # control points (spans, degree + 1, 2), metres
        self._slopes = np.ascontiguousarray(self.degree * np.diff(columns, axis=0) * binomials(self.degree - 1)[:, None, None])

    def __len__(self) -> int:
        return len(self.begin)

    def locate(self, places: Array) -> tuple[Numbers, Array]:
        """The spans of places, and the parameters there from 0 to 1."""
        span = self._span_at[places.astype(np.intp)]
        return span, places - self.start_of[span]

    def homogeneous(self, span: Numbers, u: Array) -> Array:
        """x·w, y·w and, where there are weights, w: (2 or 3, *u.shape), for spans (n,) and u (n,) or (n, m)."""
        scaled = self._scaled[:, :, span]
        return bernstein_sum(scaled if u.ndim == 1 else scaled[..., None], u)

    def at(self, span: Numbers, u: Array) -> Array:
        """Points (2, *u.shape), metres."""
        h = self.homogeneous(span, u)
        return h[:2] / h[2] if self.weighted else h

    def points(self, places: Array) -> Array:
        """Points (n, 2), metres."""
        return self.at(*self.locate(places)).T

    def slopes(self, places: Array) -> Array:
        """Derivatives (n, 2) of the points by the place, by the quotient rule."""
        span, u = self.locate(places)
        dh = bernstein_sum(self._slopes[:, :, span], u)
        if not self.weighted:
            return dh.T
        h = self.homogeneous(span, u)
        return ((dh[:2] - h[:2] * (dh[2] / h[2])) / h[2]).T

    def speeds(self, places: Array) -> Array:
        """Metres per unit of the curve's own parameter (n,): steady where the breaks are not evenly set."""
        slopes = self.slopes(places)
        return np.hypot(slopes[:, 0], slopes[:, 1]) / self.widths[self.locate(places)[0]]

    def tangents(self, places: Array) -> Array:
        """Unit tangents (n, 2); where the curve pauses, the direction beside."""
        slopes = self.slopes(places)
        speed = np.hypot(slopes[:, 0], slopes[:, 1])
        span = self.locate(places)[0]
        still = speed <= PAUSE * (self.usual_speed[self.owner] * self.widths)[span]
        if np.any(still):
            there, ends = places[still], self.end[self.owner[span[still]]]
            slopes = slopes.copy()
            slopes[still] = self.slopes(np.where(there + GLANCE <= ends, there + GLANCE, there - GLANCE))
            speed = np.hypot(slopes[:, 0], slopes[:, 1])
        result: Array = slopes / np.where(speed > 0.0, speed, 1.0)[:, None]
        return result

    @cached_property
    def lengths(self) -> Array:
        """Of the spans (spans,), metres: of the polygon through a few points of each."""
        u = np.broadcast_to(np.arange(LOOKS + 1) / LOOKS, (len(self.owner), LOOKS + 1))
        sides = np.diff(self.at(np.arange(len(self.owner)), u), axis=2)
        return np.sum(np.hypot(sides[0], sides[1]), axis=1)

    @cached_property
    def usual_speed(self) -> Array:
        """Length over range of the curves' own parameters (curves,), roughly."""
        return np.bincount(self.owner, self.lengths) / np.bincount(self.owner, self.widths)

    def stretches(self, low: Array, high: Array) -> tuple[Array, Array, Numbers]:
        """The intervals between places (n,) cut at the breaks: lower, upper ends, and from which interval each is."""
        first = np.floor(low)
        counts = np.maximum(1, np.ceil(high) - first).astype(np.intp)
        if np.all(counts == 1):
            return low, high, np.arange(len(low))
        source = np.repeat(np.arange(len(low)), counts)
        k = first[source] + np.arange(len(source)) - (np.cumsum(counts) - counts)[source]
        return np.maximum(low[source], k), np.minimum(high[source], k + 1.0), source
