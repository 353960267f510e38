"""Which splines of a drawing are copies of each other?

Blocks that are inserted many times, teeth that were drawn once and turned, the two halves of a symmetrical part: what is
followed once need only be turned, shifted or mirrored. A copy may differ by rounding, which is measured: a spline leaves
another one by no more than their control points do.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from watchsim.drawing.curves.plane_shapes import Spline
from watchsim.drawing.curves.spline_to_arcs import splines_edges
from watchsim.geometry.fitting.fit import Fit
from watchsim.geometry.primitives import Edge, moved, reflected

SAME = 1e-3  # of the tolerance: copies may differ by so much
TRIED = 4  # splines of the same size that are compared


class Motion(NamedTuple):
    """Takes z = x + iy to `turn`·z + `shift`, or to `turn`·conj(z) + `shift` where it mirrors."""

    turn: complex
    shift: complex
    mirrors: bool

    def edge(self, edge: Edge) -> Edge:
        """The image of an edge (metres, as is `shift`), travelled in the same direction."""
        image = reflected(edge, (0.0, 0.0), (1.0, 0.0)) if self.mirrors else edge
        return moved(image, cmath.phase(self.turn), (self.shift.real, self.shift.imag))


class Follower:
    """Follows splines (drawing units of `scale` metres) by lines and arcs, those that are copies of earlier ones by copies."""

    def __init__(self, scale: float) -> None:
        self.scale = scale
        self.fits: list[tuple[Fit, bool]] = []
        self.places: list[np.ndarray] = []  # control points of the splines that were followed, complex, metres
        self.alike: dict[tuple[object, ...], list[int]] = {}

    def edges(self, splines: Sequence[Spline], tolerances: Sequence[float]) -> list[tuple[Fit, bool]]:
        """For each spline its edges (metres), and whether anything had to be fitted."""
        plans: list[tuple[int, Motion | None, float]] = []
        fresh: list[int] = []
        for k, (spline, limit) in enumerate(zip(splines, tolerances, strict=True)):
            plan = self._plan(spline, limit)
            if plan[1] is None:
                fresh.append(k)
            plans.append(plan)
        self.fits += splines_edges([splines[k] for k in fresh], self.scale, [tolerances[k] for k in fresh])
        return [self._fit(*plan) for plan in plans]

    def _plan(self, spline: Spline, limit: float) -> tuple[int, Motion | None, float]:
        """Which fit the spline takes, its own or another one's, moved; and by how far that misses (metres)."""
        z = self.scale * np.array([complex(x, y) for x, y, _ in spline.points])
        size = float(np.sum(np.abs(np.diff(z))))
        key = (spline.degree, round(size / limit), limit, tuple(spline.knots), tuple(spline.weights))
        others = self.alike.setdefault(key, [])
        for number in others[:TRIED]:
            for mirrors in (False, True):
                motion, away = motion_between(self.places[number], z, mirrors)
                if away <= SAME * limit:
                    return number, motion, away
        others.append(len(self.places))
        self.places.append(z)
        return len(self.places) - 1, None, 0.0

    def _fit(self, number: int, motion: Motion | None, away: float) -> tuple[Fit, bool]:
        fit, fitted = self.fits[number]
        if motion is None:
            return fit, fitted
        return Fit(tuple(map(motion.edge, fit.edges)), fit.deviation + away), fitted


def motion_between(z: np.ndarray, image: np.ndarray, mirrors: bool) -> tuple[Motion, float]:
    """The motion that takes some points nearly to others, and how far it misses; points as complex numbers."""
    if mirrors:
        z = z.conjugate()
    far = int(np.argmax(np.abs(z - z[0])))
    arm = (image[far] - image[0]) * (z[far] - z[0]).conjugate()
    if arm == 0.0:
        return Motion(1.0 + 0.0j, 0.0j, mirrors), math.inf
    turn = complex(arm / abs(arm))
    shift = complex(np.mean(image - turn * z))
    return Motion(turn, shift, mirrors), float(np.max(np.abs(turn * z + shift - image)))
