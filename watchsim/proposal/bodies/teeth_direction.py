"""Which way do the teeth of a wheel lean?

Their tips stand ahead of their roots in the direction in which an escape wheel is made to turn: its teeth lock with the tip.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from watchsim.proposal.bodies.centres import is_toothed
from watchsim.proposal.bodies.part import Part

TIP, ROOT = 0.9, 0.25  # of a tooth's height: where its middle is taken
SYMMETRIC = 0.03  # of a pitch: teeth that lean less do not lean


def lean_of(part: Part) -> int:
    """+1 where the tips stand ahead counter-clockwise of the roots, -1 clockwise; 0 where the teeth are symmetric."""
    toothed = [piece for piece in part.pieces if piece.turned is not None and is_toothed(piece.turned)]
    if not toothed:
        return 0
    piece = max(toothed, key=lambda one: one.turned.outer if one.turned else 0.0)
    symmetry = piece.turned
    assert symmetry is not None
    height = symmetry.outer - symmetry.inner
    middles = [_middle(piece.rings, symmetry.centre, symmetry.inner + share * height, symmetry.fold) for share in (TIP, ROOT)]
    if None in middles:
        return 0
    tip, root = (middle for middle in middles if middle is not None)
    pitch = 2.0 * math.pi / symmetry.fold
    way = (tip - root + 0.5 * pitch) % pitch - 0.5 * pitch
    return 0 if abs(way) < SYMMETRIC * pitch else 1 if way > 0.0 else -1


def _middle(
    rings: list[tuple[NDArray[np.float64], bool]], centre: tuple[float, float], radius: float, fold: int
) -> float | None:
    """The angle, modulo a pitch, of the middle of the material on a circle: the circular mean of what lies in it."""
    angles = np.linspace(0.0, 2.0 * math.pi, 64 * fold, endpoint=False)
    points = np.column_stack((centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles)))
    inside = np.zeros(len(points), bool)
    for ring, _ in rings:
        inside ^= _inside(ring, points)
    if not inside.any() or inside.all():
        return None
    mean = np.exp(1j * fold * angles[inside]).mean()
    return float(np.angle(mean)) / fold if abs(mean) > 1e-6 else None


def _inside(ring: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Even-odd rule, all points at once."""
    x, y = points[:, 0], points[:, 1]
    inside = np.zeros(len(points), bool)
    for (x0, y0), (x1, y1) in zip(ring[:-1].tolist(), ring[1:].tolist(), strict=True):
        if y0 != y1:
            inside ^= ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return inside
