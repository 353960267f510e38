"""Where is a body at given cell coordinates, and how far can it move while they change a little?"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.model import FREE, PIVOT, SLIDE

Array = NDArray[np.float64]


class CellMotion:
    """The cell coordinates of one pair of bodies, read from its record (model.py)."""

    def __init__(self, pair: Any) -> None:
        self.coordinates = [int(pair[f"c{i}"]) for i in range(pair.axes)]
        self.sizes = np.array([float(pair[f"size{i}"]) for i in range(pair.axes)])

    def pose(self, body: Any, at: Array) -> tuple[Array, Array, Array]:
        """Places x, y (m) and angles (rad) of a body at cell coordinates `at`, (places, axes)."""
        value = {coordinate: at[:, axis] for axis, coordinate in enumerate(self.coordinates)}
        x, y, angle = (np.full(len(at), v) for v in (body.x, body.y, body.angle))
        if body.motion == PIVOT:
            angle = value[body.first]
        elif body.motion == SLIDE:
            x, y = x + value[body.first] * body.axis_x, y + value[body.first] * body.axis_y
        elif body.motion == FREE:
            x, y, angle = (value[body.first + i] for i in range(3))
        return x, y, angle

    def freedom(self, body: Any, room: Array) -> tuple[float, float]:
        """How far (m) a body's origin may move and (rad) the body turn when each cell coordinate changes by up to `room`."""
        value = dict(zip(self.coordinates, room.tolist(), strict=True))
        if body.motion == FREE:
            return math.hypot(value[body.first], value[body.first + 1]), value[body.first + 2]
        if body.motion == PIVOT:
            return 0.0, value[body.first]
        return (value[body.first], 0.0) if body.motion == SLIDE else (0.0, 0.0)


def turned(points: Array, angle: Array) -> Array:
    """Points (places or 1, n, 2), turned by one angle for each place."""
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return np.stack([c * points[..., 0] - s * points[..., 1], s * points[..., 0] + c * points[..., 1]], axis=-1)
