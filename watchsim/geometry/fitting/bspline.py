"""Which Béziers is a B-spline made of?

Control point m of degree n between the knots a < b is the blossom at n - m times a and m times b, by de Boor's scheme
(L. Ramshaw, Blossoms are polar forms, Computer Aided Geometric Design 6, 1989). All spans at once.
"""

from __future__ import annotations

import numpy as np

from watchsim.geometry.fitting.bundle import Numbers
from watchsim.geometry.fitting.curve import Array


def beziers(degree: int, knots: Array, points: Array, knot: Numbers, point: Numbers) -> Array:
    """Control points (spans, degree + 1, columns) of the spans that start at the knots numbered `knot` (spans,).

    `point` are the numbers of the last control points (rows of `points`) that act on these spans. No span may have no length.
    """
    near = knots[knot[:, None] + np.arange(1 - degree, degree + 1)]  # (spans, 2 degree)
    acting = points[point[:, None] + np.arange(-degree, 1)]
    a, b = near[:, degree - 1 : degree], near[:, degree : degree + 1]
    result = np.empty_like(acting)
    for m in range(degree + 1):
        level = acting
        for r in range(1, degree + 1):
            before = near[:, r - 1 : degree]
            share = (((a if r <= degree - m else b) - before) / (near[:, degree : 2 * degree + 1 - r] - before))[..., None]
            one, other = level[:, :-1], level[:, 1:]
            level = np.where(one == other, one, (1.0 - share) * one + share * other)  # points that coincide stay so
        result[:, m] = level[:, 0]
    return result
