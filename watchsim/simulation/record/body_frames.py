"""Where in the movement are the frames of all bodies, from the coordinates of its scene?"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from watchsim.scene.body import Body
from watchsim.scene.carriers import carried_last
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]
NONE = slice(0, 0)


def frames(scene: Scene, slices: Mapping[str, slice], q: Array) -> dict[str, Array]:
    """For every body (rows, 3): x, y (m) and angle (rad) in the movement; q (rows, n) with the columns `slices` says."""
    found: dict[str, Array] = {}
    for body in carried_last(scene.bodies):
        own = _own(body, q[:, slices.get(body.name, NONE)])
        found[body.name] = own if body.on is None else _on(found[body.on], own)
    return found


def speeds(scene: Scene, slices: Mapping[str, slice], q: Array, u: Array) -> dict[str, Array]:
    """For every body (rows, 3): the velocity of its origin (m/s) and its turning rate (rad/s) in the movement."""
    places = frames(scene, slices, q)
    found: dict[str, Array] = {}
    for body in carried_last(scene.bodies):
        own = _own_speed(body, u[:, slices.get(body.name, NONE)])
        if body.on is not None:
            arm, carrier = places[body.name] - places[body.on], found[body.on]
            own = own + carrier + carrier[:, 2:] * np.stack([-arm[:, 1], arm[:, 0], np.zeros(len(arm))], axis=1)
        found[body.name] = own
    return found


def _own(body: Body, q: Array) -> Array:
    """The same in the frame of the carrier."""
    if body.motion == "free":
        return q
    found = np.tile([*body.position, body.angle], (len(q), 1))
    if body.motion == "pivot":
        found[:, 2] = q[:, 0]
    elif body.motion == "slide":
        found[:, :2] += q * np.array(body.axis)
    return found


def _own_speed(body: Body, u: Array) -> Array:
    """Only pivoted and fixed bodies are carried, whose origins rest in their carriers."""
    if body.motion == "free":
        return u
    found = np.zeros((len(u), 3))
    if body.motion == "pivot":
        found[:, 2] = u[:, 0]
    elif body.motion == "slide":
        found[:, :2] = u * np.array(body.axis)
    return found


def _on(carrier: Array, own: Array) -> Array:
    """Frames given in carriers' frames."""
    c, s = np.cos(carrier[:, 2]), np.sin(carrier[:, 2])
    x, y, angle = own.T
    return carrier + np.stack([c * x - s * y, s * x + c * y, angle], axis=1)
