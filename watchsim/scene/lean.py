"""Which way do the teeth of a wheel lean, and where does each stand?"""

from __future__ import annotations

import cmath
import functools
import math
from dataclasses import dataclass

import numpy as np

from watchsim.geometry.loops import Loop, points_along
from watchsim.scene.roles import pitch, toothed_sides
from watchsim.scene.scene import Scene
from watchsim.scene.teeth import touching_loops

# Teeth of escape wheels lean the way they turn: the locking face is undercut, so that only the point of a tooth touches. At
# each radius the middle of a tooth is the phase of ∫ exp(i Z φ) dφ over its material, which its two flanks bound.

HEIGHT = 0.4  # of the pitch at the rim: so deep a tooth is looked at
PIECES = 200  # of each edge
UPRIGHT = 0.02  # of the pitch: teeth that lean less lean neither way


@dataclass(frozen=True, slots=True)
class Teeth:
    """`lean` (rad): how far the outer half of a tooth is turned anticlockwise against its inner half; `first` (rad): where the
    outer half of a tooth is, in the wheel's frame."""

    pitch: float
    lean: float
    first: float

    @property
    def count(self) -> int:
        return round(math.tau / self.pitch)

    @property
    def direction(self) -> float:
        """+1 anticlockwise or -1: the way the teeth are made to turn; 0 where they stand upright."""
        return 0.0 if abs(self.lean) < UPRIGHT * self.pitch else math.copysign(1.0, self.lean)

    def number(self, angle: float) -> int:
        """Of the tooth at an angle (rad) in the wheel's frame: counted anticlockwise from 1, the one nearest to the x axis."""
        return round((angle - math.remainder(self.first, self.pitch)) / self.pitch) % self.count + 1


def teeth(scene: Scene, wheel: str) -> Teeth | None:
    """None for a wheel without equal teeth."""
    whole = pitch(scene, wheel)
    if whole is None:
        return None
    points = [_points(loop) for loop in touching_loops(scene, toothed_sides(scene, wheel))]
    rim = max(float(np.abs(outline).max()) for outline in points)
    depth = HEIGHT * whole * rim
    outer, inner = (_middle(points, whole, rim - depth * deep, rim - depth * high) for high, deep in ((0.0, 0.5), (0.5, 1.0)))
    if outer == 0.0 or inner == 0.0:
        return None
    return Teeth(whole, cmath.phase(outer / inner) * whole / math.tau, cmath.phase(outer) * whole / math.tau)


@functools.lru_cache(maxsize=64)
def _points(loop: Loop) -> np.ndarray:
    """Complex points along the outline, closed."""
    begins = np.concatenate([points_along(edge, np.arange(PIECES) / PIECES) for edge in loop.edges])
    return np.append(begins, begins[0])


def _middle(outlines: list[np.ndarray], whole: float, low: float, high: float) -> complex:
    """Where the material between two radii lies, as exp(i Z φ) of its middle times how much there is."""
    total = 0j
    for points in outlines:
        radius = np.clip(np.abs(points), low, high)
        middle = np.angle(points[1:] + points[:-1])
        total += complex(1j * np.sum(np.diff(radius) * np.exp(1j * math.tau / whole * middle)))
    return total
