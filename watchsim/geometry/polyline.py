"""Which points draw an outline?

Pictures, movies and overlap checks need plain vertices; lines give their ends, arcs are sampled so finely that no
chord strays further from its arc than requested.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge

SMALLEST_STEP = 1e-4  # radians; a finer chord differs from its arc by rounding only


def chords(arc: Arc, deviation: float) -> int:
    """Number of equal chords (at least 1; a turn at least 3) whose sagitta stays below `deviation` metres."""
    ratio = min(max(deviation / arc.radius, 0.0), 1.0) if arc.radius > 0.0 else 1.0
    step = max(2.0 * math.acos(1.0 - ratio), SMALLEST_STEP)
    fewest = math.ceil(abs(arc.sweep) / (2.0 * math.pi / 3.0) - 1e-9)
    return max(1, fewest, math.ceil(abs(arc.sweep) / step))


def edge_points(edge: Edge, deviation: float) -> NDArray[np.float64]:
    """(n, 2) points from the start of the edge to just before its end, metres."""
    if not isinstance(edge, Arc):
        return np.array([edge.start])
    count = chords(edge, deviation)
    angles = edge.start_angle + edge.sweep * np.arange(count) / count
    return np.column_stack((edge.x + edge.radius * np.cos(angles), edge.y + edge.radius * np.sin(angles)))


def points_along(edge: Edge, fractions: NDArray[np.float64]) -> NDArray[np.complex128]:
    """The points x + iy (m) at these fractions (0 to 1) of the way."""
    if isinstance(edge, Arc):
        return complex(edge.x, edge.y) + edge.radius * np.exp(1j * (edge.start_angle + fractions * edge.sweep))
    start, end = complex(*edge.start), complex(*edge.end)
    return np.asarray(start + fractions * (end - start))


def polyline(loop: Loop, deviation: float) -> NDArray[np.float64]:
    """(n, 2) points along the loop in metres, arcs within `deviation` metres; a closed loop ends on its first point."""
    if not loop.edges:
        return np.empty((0, 2))
    parts = [edge_points(edge, deviation) for edge in loop.edges]
    last = parts[0][:1] if loop.closed else np.array([loop.edges[-1].end])
    return np.concatenate([*parts, last])
