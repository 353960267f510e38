"""How does a wheel with cycloidal teeth turn its pinion? By points on exact curves, without arcs, contacts or dynamics.

A circle is rolled step by step to describe the wheel's flank. Every point of it, wherever the wheel stands, keeps the leaf
at least as far round as the leaf is wide at the point's distance from the pinion's centre; what is furthest on drives.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Teeth:
    """Lengths in modules: heights and depths from the pitch circles, widths on them; `rounding` the radius on the leaves."""

    wheel: int
    leaves: int
    addendum: float
    dedendum: float
    tooth: float
    leaf: float
    rounding: float

    def flank(self, points: int) -> Array:
        """The leading flank of a tooth as complex numbers about the wheel's centre, from floor to tip."""
        pitch, rolling = self.wheel / 2.0, self.leaves / 4.0
        along = np.linspace(0.0, self.leaves, 400 * points) / 2.0  # length that has been rolled off
        centres = (pitch + rolling) * np.exp(1j * along / pitch)
        drawn = centres * (1.0 - rolling / (pitch + rolling) * np.exp(1j * along / rolling))
        drawn = drawn[: np.searchsorted(np.abs(drawn), pitch + self.addendum)]
        below = np.linspace(pitch - self.dedendum, pitch, points) + 0j
        return np.concatenate([below, drawn[:: max(1, len(drawn) // points)], drawn[-1:]]) * np.exp(
            -1j * self.tooth / self.wheel
        )

    def half_leaf(self, radius: Array) -> Array:
        """Half the angle of a leaf at distances from the pinion's centre; minus infinity beyond its tip."""
        pitch, half = self.leaves / 2.0, self.leaf / self.leaves
        centre = (pitch + 1j * self.rounding) * np.exp(-1j * half)  # of the arc that touches the flank below the axis
        far = np.abs(centre)
        with np.errstate(invalid="ignore"):
            there = np.arccos((radius**2 + far**2 - self.rounding**2) / (2.0 * radius * far)) - np.angle(centre)
        return np.where(radius <= pitch, half, np.where(there > 0.0, there, -np.inf))

    def driven(self, wheel: Array, points: int = 4000) -> Array:
        """Where the pinion stands, rad, for angles of a wheel that turns clockwise; at zero a tooth is on the line of centres.

        The pinion's angle, counter-clockwise, is that of the middle of the driven leaf from the line of centres at zero.
        """
        distance, flank = (self.wheel + self.leaves) / 2.0, self.flank(points)
        pitch, out = 2.0 * np.pi / self.wheel, np.empty_like(wheel)
        for i, angle in enumerate(wheel):
            furthest = -np.inf
            for tooth in np.arange(-2, 3) + np.round(angle / pitch):
                seen = flank * np.exp(1j * (tooth * pitch - angle)) - distance
                inwards = np.angle(-seen) + self.half_leaf(np.abs(seen))  # least angle of the leaf's middle
                furthest = max(furthest, float(inwards.max()) + tooth * 2.0 * np.pi / self.leaves)
            out[i] = furthest
        return out
