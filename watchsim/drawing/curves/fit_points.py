"""Which spline runs through these points?

Programs may store a spline by the points it was drawn through alone. Between them it is cubic, with steady curvature.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from watchsim.drawing.curves.affine import Vector
from watchsim.drawing.dxf_records import DxfError

FEWEST = 3  # points round a closed curve


class Cubic(NamedTuple):
    """A B-spline without weights."""

    degree: int
    knots: list[float]
    points: list[Vector]


def through(fit_points: Sequence[Vector], tangents: Sequence[Vector], closed: bool) -> Cubic:
    """The cubic spline through points; smooth at its end, too, where it is closed and does not repeat its first point."""
    if len(fit_points) < 2:
        raise DxfError("it has neither control points nor at least two fit points")
    distinct = [b for a, b in pairwise([fit_points[-1], *fit_points]) if a != b]
    if closed and fit_points[0] != fit_points[-1] and len(distinct) >= FEWEST:
        return around(distinct)
    return from_end_to_end(fit_points, tangents)


def from_end_to_end(fit_points: Sequence[Vector], tangents: Sequence[Vector]) -> Cubic:
    """As CAD programs draw it (ezdxf's)."""
    from ezdxf.math import fit_points_to_cad_cv

    try:
        curve = fit_points_to_cad_cv(fit_points, tangents=list(tangents) or None)
    except (ValueError, ArithmeticError) as error:
        raise DxfError(f"no curve can be laid through its fit points ({error})") from None
    return Cubic(curve.degree, list(curve.knots()), [(p.x, p.y, p.z) for p in curve.control_points])


def around(fit_points: Sequence[Vector]) -> Cubic:
    """The periodic cubic spline with the chords' lengths as its parameter (C. de Boor, A Practical Guide to Splines, ch. IV).

    At each point the second derivatives from both sides agree: that fixes the slopes. Double knots between cubic pieces.
    """
    p = np.array(fit_points)
    chords = np.roll(p, -1, axis=0) - p
    after = np.sqrt(np.sum(chords * chords, axis=1))
    before = np.roll(after, 1)
    rise = chords / after[:, None]
    number = np.arange(len(p))
    matrix = np.diag(2.0 * (before + after))
    matrix[number, number - 1] += after
    matrix[number, (number + 1) % len(p)] += before
    slopes = np.linalg.solve(matrix, 3.0 * (after[:, None] * np.roll(rise, 1, axis=0) + before[:, None] * rise))
    handles = after[:, None] * slopes / 3.0, after[:, None] * np.roll(slopes, -1, axis=0) / 3.0
    inner = np.stack((p + handles[0], np.roll(p, -1, axis=0) - handles[1]), axis=1).reshape(-1, 3)
    breaks = np.append(0.0, np.cumsum(after)).tolist()
    points = [(x, y, z) for x, y, z in np.vstack((p[:1], inner, p[:1])).tolist()]
    return Cubic(3, [breaks[0]] * 2 + [knot for knot in breaks for _ in (0, 1)] + [breaks[-1]] * 2, points)
