"""How far can a curve be from the arcs that follow it, between any samples?

Let an arc start at p with unit tangent τ, left normal ν and signed curvature k, and let q = c - p for a point c of the curve.
Then g = q·ν - k q²/2 vanishes on the arc's circle, and the distance from that circle is |d| = 2|g| / (1 + √(1 - 2kg)).
Along a part of the curve that is rational of degree n, g times the squared weight is a polynomial of degree 2n: 2n + 1 samples
give its Chebyshev coefficients, and |T_j| ≤ 1. The first four terms are a cubic whose extremes are found in closed form;
the others add the sum of their magnitudes. So the bound holds for every parameter (up to rounding), and it is sharp,
because the deviation of an arc from a smooth curve is nearly a cubic. That the curve passes beside the arc itself, not the
rest of its circle, is bounded in the same way: what it overshoots the normals at both ends is added.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from watchsim.geometry.fitting.biarc import ArcChain
from watchsim.geometry.fitting.bundle import Bundle, Numbers
from watchsim.geometry.fitting.curve import Array

SLACK = 0.01  # of the bound: where the higher terms or unequal weights may add more, the interval is halved
HALVINGS = 6
GLANCES = 0.5 - 0.5 * np.cos(np.pi * (np.arange(6) + 0.5) / 6.0)  # places along an arc, denser towards its ends


def glances(bundle: Bundle, low: Array, high: Array, arcs: ArcChain) -> Array:
    """About the same as `deviations`, quickly: the largest (n,) of a few samples, some per cent too small at worst."""
    low, high, source = bundle.stretches(low, high)
    span, start = bundle.locate(low)
    x, y = bundle.at(span, start[:, None] + (high - low)[:, None] * GLANCES) - arcs.starts[source].T[:, :, None]
    tangent, k = arcs.start_tangents[source], arcs.curvatures[source][:, None]
    square = x * x  # in place from here: new memory would take longer than the arithmetic
    square += y * y
    square *= 0.5 * k
    y *= tangent[:, :1]
    x *= tangent[:, 1:]
    y -= x
    y -= square
    g = np.max(np.abs(y, out=y), axis=1)
    with np.errstate(invalid="ignore"):
        most = 2.0 * g / (1.0 + np.sqrt(1.0 - 2.0 * np.abs(k[:, 0]) * g))
    result = np.zeros(len(arcs.curvatures))
    np.maximum.at(result, source, np.where(np.isfinite(most), most, np.inf))
    return result


def deviations(bundle: Bundle, low: Array, high: Array, arcs: ArcChain, group: Numbers) -> Array:
    """Upper bounds (n,) in metres for the distance between arc i and the curve between the places low[i] and high[i].

    No arc may reach a half circle; then no point of either is further from the other. Intervals are halved where the deviation
    is far from a cubic and might be the largest of its group, so that the largest bound of each group is sharp.
    """
    bounds = np.zeros(len(arcs.curvatures))
    floor = np.zeros(int(np.max(group, initial=0)) + 1)
    low, high, owner = bundle.stretches(low, high)
    for left in range(HALVINGS, -1, -1):
        bound, slack = _interval_bounds(bundle, low, high, owner, arcs)
        sure = np.where(np.isfinite(bound), bound - slack, 0.0)
        np.maximum.at(floor, group[owner], sure)
        again = (slack > SLACK * bound) & (bound > floor[group[owner]]) if left else np.zeros(len(bound), dtype=bool)
        np.maximum.at(bounds, owner[~again], bound[~again])
        if not np.any(again):
            break
        middle = 0.5 * (low[again] + high[again])
        low, high = np.concatenate((low[again], middle)), np.concatenate((middle, high[again]))
        owner = np.concatenate((owner[again], owner[again]))
    return bounds


def _interval_bounds(bundle: Bundle, low: Array, high: Array, owner: Numbers, arcs: ArcChain) -> tuple[Array, Array]:
    """For each interval the bound of the distance from its arc, and by how much it may be too large."""
    rank = 2 * bundle.degree + 1
    x, transform = _chebyshev(rank)
    span, first = bundle.locate(low)
    h = bundle.homogeneous(span, first[:, None] + (high - low)[:, None] * (0.5 + 0.5 * x))
    w = h[2] if bundle.weighted else 1.0
    start, tangent, k = arcs.starts[owner], arcs.start_tangents[owner], arcs.curvatures[owner]
    qx, qy = h[0] - start[:, :1] * w, h[1] - start[:, 1:] * w
    along = qx * tangent[:, :1] + qy * tangent[:, 1:]
    across = qy * tangent[:, :1] - qx * tangent[:, 1:]
    g = across * w - 0.5 * k[:, None] * (qx * qx + qy * qy)
    g_low, g_high, g_tail = _range(g @ transform)
    lightest = heaviest = np.ones(len(low))
    if bundle.weighted:
        w_low, w_high, w_tail = _range(w @ transform)
        lightest, heaviest = w_low - w_tail, w_high + w_tail
    with np.errstate(invalid="ignore", divide="ignore"):
        most = (np.maximum(np.abs(g_low), np.abs(g_high)) + g_tail) / lightest**2
        bound = 2.0 * most / (1.0 + np.sqrt(1.0 - 2.0 * np.abs(k) * most))
        end, last = arcs.ends[owner], arcs.end_tangents[owner]
        beyond = (end[:, :1] * w - h[0]) * last[:, :1] + (end[:, 1:] * w - h[1]) * last[:, 1:]
        for projection in (along @ transform, beyond[:, ::-1] @ transform):
            bound = bound + np.maximum(0.0, -_least(projection)) / lightest
        slack = g_tail / lightest**2 + most * (1.0 - (lightest / heaviest) ** 2)
    return np.where((lightest > 0.0) & np.isfinite(bound), bound, np.inf), slack


@lru_cache(maxsize=64)
def _chebyshev(rank: int) -> tuple[Array, Array]:
    """The `rank` Chebyshev points of the first kind, and the matrix from values there (…, rank) to coefficients (…, rank)."""
    angle = np.pi * (np.arange(rank) + 0.5) / rank
    transform = 2.0 / rank * np.cos(np.outer(angle, np.arange(rank)))
    transform[:, 0] *= 0.5
    return np.cos(angle), transform


def _least(a: Array) -> Array:
    """A bound (n,) of the least value on [-1, 1] of what has the Chebyshev coefficients a (n, rank), mostly growing."""
    order = np.arange(a.shape[1])
    result: Array = a @ (1.0 - 2.0 * (order % 2))
    # The derivative of T_j is at most j²: where the first term outweighs the others the least is at the lower end.
    doubtful = ~(a[:, 1] >= np.abs(a[:, 2:]) @ (order[2:] ** 2))
    if np.any(doubtful):
        least, _, tail = _range(a[doubtful])
        result[doubtful] = least - tail
    return result


def _range(a: Array) -> tuple[Array, Array, Array]:
    """Least and greatest value of the first four Chebyshev terms on [-1, 1], and the sum of the magnitudes of the others."""
    a0, a1, a2, a3 = (a[:, j] if j < a.shape[1] else np.zeros(len(a)) for j in range(4))
    tail = np.sum(np.abs(a[:, 4:]), axis=1)
    # The derivative is (a1 - 3 a3) + 4 a2 x + 12 a3 x²; its roots in the form without cancellation.
    constant = a1 - 3.0 * a3
    with np.errstate(invalid="ignore", divide="ignore"):
        half = -0.5 * (4.0 * a2 + np.copysign(np.sqrt(16.0 * a2 * a2 - 48.0 * a3 * constant), a2))
        roots = np.stack((half / (12.0 * a3), constant / half, np.full(len(a), -1.0), np.ones(len(a))))
    # Where there is no root inside any other place will do: values there cannot exceed the range.
    x = np.where(np.abs(roots) <= 1.0, roots, 1.0)
    values = a0 + a1 * x + a2 * (2.0 * x * x - 1.0) + a3 * (4.0 * x * x - 3.0) * x
    return np.min(values, axis=0), np.max(values, axis=0), tail
