"""How many pairs of primitives are declared, and how many can ever touch?

A pair can be reached only if the circles (or, for a free body, nothing) that its primitives sweep about their pivots meet.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cells import primitive_points
from watchsim.mechanism.compile import compile_scene
from watchsim.mechanism.model import FIXED, PIVOT, Model
from watchsim.mechanism.scene import Scene


def count_pairs(scene: Scene) -> dict[str, int]:
    """Numbers of declared and of reachable pairs of primitives of a scene."""
    model = compile_scene(scene).model
    return {"declared": len(model.contacts), "reachable": int(np.count_nonzero(reachable(model)))}


def reachable(model: Model) -> NDArray[np.bool_]:
    """For each contact, whether its primitives can meet at any pose of their bodies."""
    rings = [_ring(model, i) for i in range(len(model.primitives))]
    out = np.zeros(len(model.contacts), bool)
    for k, contact in enumerate(model.contacts):
        a, b = rings[contact.a], rings[contact.b]
        if a is None or b is None:
            out[k] = True
            continue
        distance = math.dist(a[0], b[0])
        out[k] = _annuli_meet(distance, a[1], b[1])
    return out


def _ring(model: Model, i: int) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Centre and (inner, outer) radius of what primitive i sweeps about its body's pivot; None for a body that travels."""
    primitive = model.primitives[i]
    body = model.bodies[primitive.body]
    points, sag = primitive_points(primitive)
    if body.motion == PIVOT:
        far = float(np.hypot(*points.T).max())
        near = _nearest(points)
        return (float(body.x), float(body.y)), (max(0.0, near - sag), far + sag)
    if body.motion == FIXED:
        c, s = math.cos(body.angle), math.sin(body.angle)
        middle = points.mean(axis=0)
        far = float(np.hypot(*(points - middle).T).max())
        x, y = body.x + c * middle[0] - s * middle[1], body.y + s * middle[0] + c * middle[1]
        return (float(x), float(y)), (0.0, far + sag)
    return None


def _nearest(points: NDArray[np.float64]) -> float:
    """Distance of the origin from the line through the points."""
    start, step = points[:-1], np.diff(points, axis=0)
    square = np.maximum((step**2).sum(axis=1), 1e-300)
    fraction = np.clip(-(start * step).sum(axis=1) / square, 0.0, 1.0)
    return float(np.hypot(*(start + fraction[:, None] * step).T).min())


def _annuli_meet(distance: float, a: tuple[float, float], b: tuple[float, float]) -> bool:
    """Two rings (inner, outer radius) whose centres are `distance` apart have a point in common."""
    return distance <= a[1] + b[1] and a[0] <= distance + b[1] and b[0] <= distance + a[1]
