"""Where is a body at given cell coordinates, and how far can it move while they change a little?"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.cell_frame import seen_from
from watchsim.model.records import FIXED, FREE, PIVOT, SLIDE, Records

Array = NDArray[np.float64]


class _Body(NamedTuple):
    """What counts of a body, in plain numbers: reading a field of a record takes a microsecond."""

    motion: int
    first: int
    carrier: int
    x: float
    y: float
    angle: float
    axis_x: float
    axis_y: float
    ratio: float
    phase: float


class CellMotion:
    """The cell coordinates of one pair of bodies, read from its record (records.py), and the frame they are given in."""

    def __init__(self, bodies: Records, pair: Any) -> None:
        self.coordinates = [int(pair[f"c{i}"]) for i in range(pair.axes)]
        self.sizes = np.array([float(pair[f"size{i}"]) for i in range(pair.axes)])
        self.on = [int(pair[f"on{i}"]) for i in range(pair.axes)]
        self._seen = {int(b): _plain(seen_from(bodies, int(b), int(pair.frame))) for b in (pair.a, pair.b)}
        self._carrier = {b: _plain(bodies[body.carrier]) for b, body in self._seen.items() if body.carrier >= 0}

    def pose(self, b: int, at: Array) -> tuple[Array, Array, Array]:
        """Places x, y (m) and angles (rad) of body b at cell coordinates `at`, (places, axes)."""
        body = self._seen[int(b)]
        if int(b) not in self._carrier:
            return self._own(body, at)
        x, y, angle = self._own(self._carrier[int(b)], at)
        c, s = np.cos(angle), np.sin(angle)
        return x + c * body.x - s * body.y, y + s * body.x + c * body.y, self._own(body, at)[2]

    def _own(self, body: _Body, at: Array) -> tuple[Array, Array, Array]:
        """The same for a body that nothing carries."""
        value = {coordinate: at[:, axis] for axis, coordinate in enumerate(self.coordinates)}
        x, y, angle = (np.full(len(at), v) for v in (body.x, body.y, body.angle))
        if body.motion == PIVOT:
            angle = np.full(len(at), body.phase) if body.ratio == 0.0 else body.ratio * value[body.first] + body.phase
        elif body.motion == SLIDE:
            way = body.ratio * value[body.first] + body.phase
            x, y = x + way * body.axis_x, y + way * body.axis_y
        elif body.motion == FREE:
            x, y, angle = (value[body.first + i] for i in range(3))
        return x, y, angle

    def freedom(self, b: int, room: Array) -> tuple[float, float]:
        """How far (m) body b's origin may move and (rad) the body turn when each cell coordinate changes by up to `room`."""
        body = self._seen[int(b)]
        shift, turn = self._own_freedom(body, room)
        if int(b) in self._carrier:
            more, swing = self._own_freedom(self._carrier[int(b)], room)
            shift += more + swing * math.hypot(body.x, body.y)
        return shift, turn

    def _own_freedom(self, body: _Body, room: Array) -> tuple[float, float]:
        value = dict(zip(self.coordinates, room.tolist(), strict=True))
        if body.motion == FIXED or body.ratio == 0.0:
            return 0.0, 0.0
        if body.motion == FREE:
            return math.hypot(value[body.first], value[body.first + 1]), value[body.first + 2]
        way = abs(body.ratio) * value[body.first]
        return (0.0, way) if body.motion == PIVOT else (way, 0.0)


def _plain(body: Any) -> _Body:
    return _Body(*(body[name].item() for name in _Body._fields))


def turned(points: Array, angle: Array) -> Array:
    """Points (places or 1, n, 2), turned by one angle for each place."""
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return np.stack([c * points[..., 0] - s * points[..., 1], s * points[..., 0] + c * points[..., 1]], axis=-1)
