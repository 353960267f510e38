"""How few arcs can a chain of biarcs have that stays within a tolerance of a curve? By trying all of them.

Dynamic programming over a grid of parameters and, at each, a few tangents beside the curve's own. Complex numbers instead
of vectors, samples instead of bounds; nothing of the package is used.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

Array = np.ndarray
SAMPLES = 24


def biarc_deviation(p: Array, u: Array, q: Array, v: Array, points: Array) -> Array:
    """The largest distance (n,) between rows of `points` (n, m) and the biarc from p to q with unit tangents u and v."""
    chord = q - p
    s, w = u + v, 1.0 - (u * v.conj()).real
    b = (chord.conj() * s).real
    # Legs of equal length: 2 w a² + 2 b a - |chord|² = 0 after dividing by 2 twice over.
    with np.errstate(all="ignore"):
        a = np.abs(chord) ** 2 / (b + np.sqrt(b * b + 2.0 * w * np.abs(chord) ** 2))
        joint = 0.5 * ((p + a * u) + (q - a * v))
        along = (q - a * v) - (p + a * u)
        along = along / np.abs(along)
        first = ((points - joint[:, None]) * along.conj()[:, None]).real < 0.0
        distance = np.where(first, circle_distance(p, u, joint, points), circle_distance(joint, along, q, points))
        result = np.max(distance, axis=1)
    return np.where(np.isfinite(result) & (b > 0.0), result, np.inf)


def circle_distance(p: Array, u: Array, q: Array, points: Array) -> Array:
    """Distance of rows of points from the circle (or line) through p along u and through q."""
    local = (q - p) / u
    bend = 2.0 * local.imag / np.abs(local) ** 2
    z = (points - p[:, None]) / u[:, None]
    off = z.imag - 0.5 * bend[:, None] * np.abs(z) ** 2
    return np.abs(2.0 * off / (1.0 + np.sqrt(np.maximum(1.0 - 2.0 * bend[:, None] * off, 0.0))))


def fewest_arcs(curve: Callable[[Array], Array], t: Array, tolerance: float, tilts: Sequence[float] = (0.0,)) -> int:
    """The least number of arcs, twice that of biarcs, with ends at grid parameters `t`; `curve` gives complex points.

    `tilts` in radians are tried at all inner places; at the ends the tangent is the curve's.
    """
    step = 1e-5 * float(t[-1] - t[0])
    z = curve(t)
    inner = np.clip(t, t[0] + step, t[-1] - step)
    slope = (
        curve(inner + step)
        - curve(inner - step)
        + (t - inner) / step * (curve(inner + step) - 2.0 * curve(inner) + curve(inner - step)) * 2.0
    )
    ways = slope / np.abs(slope)
    turned = np.exp(1j * np.asarray(tilts))
    fractions = (np.arange(SAMPLES) + 0.5) / SAMPLES
    count = len(t)
    reached = np.full((count, len(tilts)), np.inf)
    reached[0, :] = np.inf
    reached[0, int(np.argmin(np.abs(np.asarray(tilts))))] = 0.0
    straight = int(np.argmin(np.abs(np.asarray(tilts))))
    frontier = 1
    while not np.isfinite(reached[-1, straight]):
        for i in range(count - 1):
            for k in np.flatnonzero(reached[i] == frontier - 1):
                extend(curve, t, z, ways, turned, straight, i, int(k), reached, frontier, fractions, tolerance)
        frontier += 1
    return 2 * int(reached[-1, straight])


def extend(curve, t, z, ways, turned, straight, i, k, reached, frontier, fractions, tolerance) -> None:  # type: ignore[no-untyped-def]
    """Marks all places that one biarc from place i with tilt k reaches."""
    ahead = np.arange(i + 1, len(t))
    for block in np.array_split(ahead, max(1, len(ahead) // 64)):
        points = curve((t[i] + (t[block] - t[i])[:, None] * fractions).ravel()).reshape(len(block), -1)
        found = False
        for other, turn in enumerate(turned):
            full = np.full(len(block), z[i]), np.full(len(block), ways[i] * turned[k]), z[block], ways[block] * turn
            near = biarc_deviation(*full, points) <= tolerance
            reached[block[near], other] = np.minimum(reached[block[near], other], frontier)
            found = found or bool(np.any(near))
        if not found:
            return
