"""How few arcs can a chain of biarcs have that stays within a tolerance of a curve? By trying all of them.

Dynamic programming over a grid of parameters and, at each, a few tangents beside the curve's own. Complex numbers instead
of vectors, samples instead of bounds; nothing of the package is used.
"""

from collections.abc import Callable, Iterator, Sequence

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
    grid = Grid(curve, t, np.asarray(tilts))
    straight = int(np.argmin(np.abs(tilts)))
    reached = np.full((len(t), len(tilts)), np.inf)  # the least number of biarcs to each place and tilt
    reached[0, straight] = 0.0
    frontier = 0
    while not np.isfinite(reached[-1, straight]):
        for i, k in np.argwhere(reached[:-1] == frontier).tolist():
            for places, tilt in grid.reachable(i, k, tolerance):
                reached[places, tilt] = np.minimum(reached[places, tilt], frontier + 1)
        frontier += 1
    return 2 * int(reached[-1, straight])


class Grid:
    """Places on a curve, and at each the curve's tangent turned by each of some tilts."""

    def __init__(self, curve: Callable[[Array], Array], t: Array, tilts: Array) -> None:
        step = 1e-5 * float(t[-1] - t[0])
        inner = np.clip(t, t[0] + step, t[-1] - step)
        before, at, after = curve(inner - step), curve(inner), curve(inner + step)
        slope = after - before + 2.0 * (t - inner) / step * (after - 2.0 * at + before)
        self.curve, self.t, self.z = curve, t, curve(t)
        self.ways = (slope / np.abs(slope))[:, None] * np.exp(1j * tilts)

    def reachable(self, i: int, k: int, tolerance: float) -> Iterator[tuple[Array, int]]:
        """Places, and the tilt there, which one biarc from place i with tilt k reaches."""
        fractions = (np.arange(SAMPLES) + 0.5) / SAMPLES
        ahead = np.arange(i + 1, len(self.t))
        for block in np.array_split(ahead, max(1, len(ahead) // 64)):
            between = self.t[i] + (self.t[block] - self.t[i])[:, None] * fractions
            samples = self.curve(between.ravel()).reshape(between.shape)
            start, way = np.full(len(block), self.z[i]), np.full(len(block), self.ways[i, k])
            near = np.array(
                [biarc_deviation(start, way, self.z[block], other, samples) <= tolerance for other in self.ways[block].T]
            )
            if not np.any(near):
                return
            yield from ((block[row], tilt) for tilt, row in enumerate(near))
