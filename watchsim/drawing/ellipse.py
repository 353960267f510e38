"""Which arcs follow this ellipse?"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.shapes import Conic
from watchsim.geometry.biarc import Fit, fit_arcs

QUARTER = 0.5 * math.pi
Array = NDArray[np.float64]


def ellipse_edges(conic: Conic, scale: float, tolerance: float) -> Fit:
    """Tangent-continuous arcs (metres) within `tolerance` metres, the same in every quadrant.

    Cut at the ends of the axes: in between the curvature grows or falls throughout, which biarcs follow best.
    """
    centre = scale * np.array(conic.centre[:2])
    u, v = scale * np.array(conic.u[:2]), scale * np.array(conic.v[:2])

    def curve(t: Array) -> tuple[Array, Array]:
        c, s = np.cos(t)[:, None], np.sin(t)[:, None]
        return centre + c * u + s * v, c * v - s * u

    cuts = axis_cuts(conic)
    fits = [fit_arcs(curve, (a, b), tolerance) for a, b in pairwise(cuts)]
    return Fit(tuple(edge for fit in fits for edge in fit.edges), max(fit.deviation for fit in fits))


def axis_cuts(conic: Conic) -> list[float]:
    """Start, the ends of the axes in between, end: the axes lie where |c'(t)| is extreme, at tan 2t = 2 u·v/(u² - v²)."""
    (ux, uy, _), (vx, vy, _) = conic.u, conic.v
    first = 0.5 * math.atan2(2.0 * (ux * vx + uy * vy), ux * ux + uy * uy - vx * vx - vy * vy)
    stop = conic.start + conic.sweep
    k = math.ceil((conic.start - first) / QUARTER)
    cuts = [conic.start]
    while first + k * QUARTER < stop - 1e-9:
        if first + k * QUARTER > conic.start + 1e-9:
            cuts.append(first + k * QUARTER)
        k += 1
    return [*cuts, stop]
