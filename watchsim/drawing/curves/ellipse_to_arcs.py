"""Which arcs follow these ellipses?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from watchsim.drawing.curves.plane_shapes import Conic
from watchsim.geometry.fitting.curve import Array, Curve
from watchsim.geometry.fitting.fit import Fit, fit_all
from watchsim.geometry.fitting.recognise import joined
from watchsim.geometry.primitives import Edge, moved, reflected

QUARTER = 0.5 * math.pi
SLIVER = 0.02  # radians of the parameter


class Stretch(NamedTuple):
    """A part of an ellipse: the number of the curve that is followed, and the quadrant that this one is mirrored into."""

    curve: int
    quadrant: int | None


def ellipses_edges(conics: Sequence[Conic], scale: float, tolerances: Sequence[float]) -> list[Fit]:
    """Tangent-continuous arcs (metres) within `tolerances` metres, for each ellipse the same in every quadrant.

    Cut at the ends of the axes: in between the curvature grows or falls throughout. Where the arcs on both sides of such an
    end belong to one circle they become one arc.
    """
    curves: list[Curve] = []
    limits: list[float] = []
    plans: list[tuple[Array, Array, list[Stretch]]] = []
    for conic, tolerance in zip(conics, tolerances, strict=True):
        first, cuts = axis_cuts(conic)
        c, s = math.cos(first), math.sin(first)
        u, v = scale * np.array(conic.u[:2]), scale * np.array(conic.v[:2])
        a, b = c * u + s * v, c * v - s * u  # the half axes
        stretches: list[Stretch] = []
        whole: int | None = None
        for low, high in pairwise(cuts):
            quarter = abs(high - low - QUARTER) <= 1e-9
            if whole is None or not quarter:
                curves.append(rational(a, b, 0.0, QUARTER) if quarter else rational(a, b, low - first, high - first))
                limits.append(tolerance)
            whole = whole if whole is not None or not quarter else len(curves) - 1
            if quarter and whole is not None:
                stretches.append(Stretch(whole, round((low - first) / QUARTER) % 4))
            else:
                stretches.append(Stretch(len(curves) - 1, None))
        plans.append((a, b, stretches))
    fits = fit_all(curves, limits)
    return [
        _put_together(scale * np.array(conic.centre[:2]), plan, fits, tolerance)
        for conic, plan, tolerance in zip(conics, plans, tolerances, strict=True)
    ]


def _put_together(centre: Array, plan: tuple[Array, Array, list[Stretch]], fits: Sequence[Fit], tolerance: float) -> Fit:
    """The edges of all stretches of one ellipse."""
    a, b, stretches = plan
    x, y = centre.tolist()
    edges: list[Edge] = []
    worst = 0.0
    for curve, quadrant in stretches:
        fit = fits[curve]
        edges += [moved(edge, 0.0, (x, y)) for edge in (fit.edges if quadrant is None else in_quadrant(fit, a, b, quadrant))]
        worst = max(worst, fit.deviation)
    edges, shift = joined(edges, tolerance - worst)
    return Fit(tuple(edges), worst + shift)


def rational(a: Array, b: Array, low: float, high: float) -> Curve:
    """a·cos t + b·sin t from `low` to at most a quarter turn later, as a rational parabola in the tangent of half the angle."""
    half = 0.5 * (high - low)
    angles, weights = np.array([low, low + half, high]), np.array([1.0, math.cos(half), 1.0])
    points = np.cos(angles)[:, None] * a + np.sin(angles)[:, None] * b
    points[1] /= weights[1]
    return Curve(np.column_stack((points * weights[:, None], weights))[None], np.array([0.0, 1.0]))


def in_quadrant(fit: Fit, a: Array, b: Array, number: int) -> list[Edge]:
    """The edges of the first quadrant mirrored in the axes into quadrant 0 to 3, in travel order."""
    edges = list(fit.edges)
    if number in (1, 2):
        edges = [mirrored(edge, a) for edge in edges]
    if number in (2, 3):
        edges = [mirrored(edge, b) for edge in edges]
    return edges if number in (0, 2) else [edge.reversed() for edge in reversed(edges)]


def mirrored(edge: Edge, axis: Array) -> Edge:
    """The mirror image with the component along `axis` turned round."""
    nx, ny = (axis / math.hypot(*axis)).tolist()
    return reflected(edge, (0.0, 0.0), (-ny, nx))


def axis_cuts(conic: Conic) -> tuple[float, list[float]]:
    """The parameter of one half axis; and start, the ends of the axes in between, end.

    The axes lie where |c'(t)| is extreme, at tan 2t = 2 u·v/(u² - v²). No sliver is cut off at start and end.
    """
    (ux, uy, _), (vx, vy, _) = conic.u, conic.v
    first = 0.5 * math.atan2(2.0 * (ux * vx + uy * vy), ux * ux + uy * uy - vx * vx - vy * vy)
    stop = conic.start + conic.sweep
    k = math.ceil((conic.start - first) / QUARTER)
    cuts = [conic.start]
    while first + k * QUARTER < stop - SLIVER:
        if first + k * QUARTER > conic.start + SLIVER:
            cuts.append(first + k * QUARTER)
        k += 1
    return first, [*cuts, stop]
