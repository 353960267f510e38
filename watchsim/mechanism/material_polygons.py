"""Which polygons stand for the material that some outlines bound?

Arcs become chords. Polygons of chords serve wherever a check must share nothing with the gap functions of contacts.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.geometry.polyline import chords, polyline
from watchsim.geometry.primitives import Arc

Floats = NDArray[np.float64]
Bits = NDArray[np.bool_]


@functools.lru_cache(maxsize=512)
def chord_points(loop: Loop, deviation: float) -> Floats:
    """(chords + 1, 2) points of the loop in metres, read-only, no chord further than `deviation` from its arc."""
    points = polyline(loop, deviation)
    points.flags.writeable = False
    return points


def refined_points(loop: Loop, coarse: float, near: Bits, fine: float) -> tuple[Floats, float]:
    """`chord_points` of deviation `coarse`, in which the chords marked `near` are split until they deviate by at most `fine`.

    Returns the points and the largest deviation (m) of the chords that were marked.
    """
    parts, worst, at = [], 0.0, 0
    for edge in loop.edges:
        count = chords(edge, coarse) if isinstance(edge, Arc) else 1
        flags = near[at : at + count]
        at += count
        if not isinstance(edge, Arc):
            parts.append(np.array([edge.start]))
            continue
        step = abs(edge.sweep) / count
        pieces = max(1, math.ceil(step * math.sqrt(edge.radius / (8.0 * fine))))
        number = np.where(flags, pieces, 1)
        place = np.repeat(np.arange(count), number)
        nth = np.arange(len(place)) - np.repeat(np.cumsum(number) - number, number)
        angles = edge.start_angle + edge.sweep * (place + nth / number[place]) / count
        parts.append(np.column_stack((edge.x + edge.radius * np.cos(angles), edge.y + edge.radius * np.sin(angles))))
        if flags.any():
            worst = max(worst, edge.radius * (step / pieces) ** 2 / 8.0)
    end = parts[0][:1] if loop.closed else np.array([loop.edges[-1].end])
    return np.concatenate([*parts, end]), worst


def material(rings: Sequence[tuple[Floats, bool]]) -> list[Any]:
    """Polygons, each an outer ring without the holes that lie directly in it; `rings`: points, and whether it is a hole."""
    import shapely

    outers = [shapely.Polygon(points) for points, hole in rings if not hole]
    holes: list[list[Floats]] = [[] for _ in outers]
    for points, hole in rings:
        if hole:
            inside = shapely.Polygon(points).representative_point()
            around = [i for i, outer in enumerate(outers) if outer.covers(inside)]
            if around:
                holes[min(around, key=lambda i: outers[i].area)].append(points)
    pierced = [shapely.Polygon(outer.exterior, inner) if inner else outer for outer, inner in zip(outers, holes, strict=True)]
    return [polygon if polygon.is_valid else polygon.buffer(0.0) for polygon in pierced]


def placed(points: Floats, pose: tuple[float, float, float]) -> Floats:
    """Points of a body's frame that stands at `pose` (x, y, angle), in the movement."""
    x, y, angle = pose
    c, s = math.cos(angle), math.sin(angle)
    return np.column_stack((c * points[:, 0] - s * points[:, 1] + x, s * points[:, 0] + c * points[:, 1] + y))
