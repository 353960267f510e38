"""By which part of a turn does an outline come back onto itself, and about which centre?

The centre of area of a wheel is its centre, whatever its teeth are like.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.geometry.solids.mass import section
from watchsim.mechanism.material_polygons import material, placed

Floats = NDArray[np.float64]
MOST = 400  # teeth
MISS = 2e-3  # of the radius: what a drawing may fail to be alike
ROUND = 0.02  # of the radius: what differs less from a circle is a disc


@dataclass(frozen=True)
class Turned:
    """Turned by 1/fold of a turn about `centre` it lies on itself; `inner` and `outer` are its least and largest radius (m)."""

    fold: int
    centre: Point
    inner: float
    outer: float


def turned(loops: Sequence[Loop], rings: Sequence[Floats]) -> Turned | None:
    """Of closed outlines together, with their chords; None where they are a disc, or come back only after a whole turn."""
    centre = section(loops).centroid
    around = [points - np.array(centre) for points in rings]
    points = np.concatenate(around)
    radii = np.hypot(*points.T)
    outer = float(radii.max())
    if outer <= 0.0 or float(radii.min()) > (1.0 - ROUND) * outer:
        return None
    tip = points[int(radii.argmax())]
    region = _region(around)
    for fold in range(min(MOST, len(points)), 1, -1):
        angle = 2.0 * math.pi / fold
        there = placed(tip[None], (0.0, 0.0, angle))
        if np.hypot(*(points - there).T).min() > MISS * outer:
            continue
        if _region([placed(ring, (0.0, 0.0, angle)) for ring in around]).hausdorff_distance(region) <= MISS * outer:
            return Turned(fold, centre, float(radii.min()), outer)
    return None


def _region(rings: Sequence[Floats]) -> Any:
    parts = material([(points, False) for points in rings])
    whole = parts[0]
    for part in parts[1:]:
        whole = whole.union(part)
    return whole
