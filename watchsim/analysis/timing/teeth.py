"""How many equal teeth has a wheel?

An outline with Z equal teeth looks the same after 1/Z of a turn, so of the moments of its length, ∮ r² exp(i n φ) ds, only
those with n a multiple of Z are not zero. That holds for pointed teeth, club teeth and pins alike.
"""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from watchsim.geometry.loop import Loop
from watchsim.geometry.polyline import points_along
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import Array

MOST_TEETH = 240
SPACING = 1.0 / 400.0  # of the wheel's radius, between sampled points
NOTICEABLE = 0.05  # share of the largest moment; smaller ones are inaccuracies of the drawing
ROUND = 1e-6  # share of the length's own moment; a wheel without larger ones is a plain disc

_recent: deque[tuple[list[Loop], int]] = deque(maxlen=4)  # several questions about one run ask for the same wheel


def pitch(scene: Scene, wheel: str) -> float | None:
    """Angle (rad) from tooth to tooth, of the outlines with which body `wheel` touches others; None without equal teeth."""
    loops = toothed_loops(scene, wheel)
    count = next((known for others, known in _recent if _same(others, loops)), None)
    if count is None:
        count = tooth_count(loops)
        _recent.appendleft((loops, count))
    return math.tau / count if count > 1 else None


def _same(first: list[Loop], second: list[Loop]) -> bool:
    return len(first) == len(second) and all(one is other for one, other in zip(first, second, strict=True))


def toothed_loops(scene: Scene, wheel: str) -> list[Loop]:
    """The outlines with which body `wheel` touches others."""
    body = scene.body(wheel)
    sides = [side for contact in scene.contacts for side in contact.sides if side.body == wheel]
    layers = {layer for side in sides for layer in ([side.layer] if side.layer is not None else body.layers)}
    return [loop for loop in body.loops if loop.layer in layers and loop.closed and not loop.hole]


def tooth_count(loops: list[Loop]) -> int:
    """The order of the outlines' rotational symmetry about the origin; 1 without any, 0 where all is round or nothing there."""
    points, lengths = _sampled(loops)
    weights = lengths * np.abs(points) ** 2
    direction = points / np.maximum(np.abs(points), 1e-300)
    turned, moments = weights.astype(complex), np.zeros(MOST_TEETH)
    for n in range(MOST_TEETH):
        turned = turned * direction
        moments[n] = abs(turned.sum())
    if moments.max() < ROUND * weights.sum():
        return 0
    return math.gcd(*(np.flatnonzero(moments > NOTICEABLE * moments.max()) + 1).tolist())


def _sampled(loops: list[Loop]) -> tuple[Array, Array]:
    """Complex points in the middle of short pieces of all edges, and the lengths of these pieces."""
    edges = [edge for loop in loops for edge in loop.edges]
    reach = max((math.hypot(*edge.point(f)) for edge in edges for f in (0.0, 0.5)), default=0.0)
    counts = [max(2, math.ceil(edge.length / (SPACING * reach))) for edge in edges]
    points = [points_along(edge, (np.arange(count) + 0.5) / count) for edge, count in zip(edges, counts, strict=True)]
    lengths = [edge.length / count for edge, count in zip(edges, counts, strict=True)]
    return np.concatenate([np.zeros(0, complex), *points]), np.repeat(lengths, counts)
