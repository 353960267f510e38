"""Which straight pieces stand for a primitive, and how far is the true curve from them?"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.model.records import ARC, FULL, LINE, Records

Array = NDArray[np.float64]
MOST = 64  # pieces of one arc, unless asked otherwise


class Chords(NamedTuple):
    """Points along each primitive, in its body's frame."""

    points: Array  # (n, 2), m
    first: NDArray[np.int64]  # points of primitive i are first[i] : first[i + 1]
    sag: Array  # m, how far the primitive may lie from the line through its points

    @property
    def owner(self) -> NDArray[np.int64]:
        """The primitive that each point belongs to."""
        return np.repeat(np.arange(len(self.sag)), np.diff(self.first))


def chords(primitives: Records, sag: float, most: int = MOST) -> Chords:
    """Chords of all `primitives`: one point for a corner, two for a line, for an arc as many as keep within about `sag` m.

    No arc has more than `most`; how far its true curve then lies from them is told.
    """
    kind, radius = primitives.kind, primitives.radius
    arc, line = kind == ARC, kind == LINE
    half = np.where(primitives.extent == FULL, np.pi, np.arctan2(primitives.half_sin, primitives.half_cos))
    # Sagitta of an arc of half angle h: 2 R sin²(h/2).
    with np.errstate(divide="ignore", invalid="ignore"):
        largest = 2.0 * np.arcsin(np.sqrt(np.minimum(1.0, sag / (2.0 * radius))))
        pieces = np.where(arc, np.clip(np.ceil(half / largest), 1, most), np.where(line, 1, 0)).astype(int)
    first = np.concatenate([[0], np.cumsum(pieces + 1)])
    owner = np.repeat(np.arange(len(primitives)), pieces + 1)
    share = (np.arange(len(owner)) - first[owner]) / np.maximum(pieces[owner], 1)
    straight, way = line[owner], primitives.length[owner] * share
    x = primitives.x[owner] + np.where(straight, way * primitives.tx[owner], 0.0)
    y = primitives.y[owner] + np.where(straight, way * primitives.ty[owner], 0.0)
    if arc.any():
        nx, ny = primitives.side * primitives.nx, primitives.side * primitives.ny
        angle = np.arctan2(ny, nx)[owner] + half[owner] * (2.0 * share - 1.0)
        # From the middle of the arc, so that nothing is lost where the centre is far away.
        dx, dy = _swung(radius[owner], nx[owner], ny[owner], angle)
        curved = arc[owner]
        x, y = np.where(curved, primitives.px[owner] + dx, x), np.where(curved, primitives.py[owner] + dy, y)
    depth = 2.0 * radius * np.sin(0.5 * half / np.maximum(pieces, 1)) ** 2
    return Chords(np.stack([x, y], axis=1), first, np.where(arc, depth, 0.0))


def _swung(radius: Array, nx: Array, ny: Array, angle: Array) -> tuple[Array, Array]:
    """The way from the middle of an arc, in direction (nx, ny) from its centre, to its point in direction `angle`."""
    return radius * (np.cos(angle) - nx), radius * (np.sin(angle) - ny)
