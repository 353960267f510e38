"""Where does the stop of a spring stand, and on what?

A stop has no place of its own: it only says at which angle, or after which travel, its body comes to a stop. It is drawn as a
pin that the body then touches, on the side to which the spring presses, far out on the body's longest arm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.render.frame.filled_parts import loops_of, outline
from watchsim.render.frame.pose_history import placed
from watchsim.render.frame.view import size_of
from watchsim.scene.body import Body
from watchsim.scene.carriers import at_start, rides
from watchsim.scene.force import Spring
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]

PIN = 0.04  # of the body's reach: radius of the pin
OUT = 0.7  # of the reach: where the pin stands on the arm
FINE = 400  # points along the reach of a body


@dataclass(frozen=True)
class StopPin:
    """A circle of `radius` m at `place` (m) in the frame of the body `on`, or in the movement (None)."""

    spring: Spring
    on: str | None
    place: tuple[float, float]
    radius: float


def stop_pins(scene: Scene) -> list[StopPin]:
    """One for each spring with a stop whose body has an outline."""
    return [pin for spring in scene.springs if spring.stop is not None and (pin := _pin(scene, spring)) is not None]


def _pin(scene: Scene, spring: Spring) -> StopPin | None:
    body = scene.body(spring.body)
    shapes = loops_of(body)  # what can touch is often the tip of an arm alone
    if not shapes or spring.stop is None:
        return None
    number = [one.name for one in scene.bodies].index(body.name)
    carrier = rides(scene.bodies)[number].turns_with
    on = spring.against or (scene.bodies[carrier].name if carrier >= 0 else None)
    frames = {one.name: np.array([*one.position, one.angle]) for one in at_start(scene).bodies}
    points = np.concatenate([_dense(outline([loop], size_of(body) / FINE), size_of(body) / FINE) for loop in shapes])
    side = math.copysign(1.0, spring.rest - spring.stop)  # to which the spring presses
    if body.motion == "pivot":
        start = body.angle - (scene.body(spring.against).angle if spring.against else 0.0)
        place, radius = _round(points, frames[body.name], spring.stop - start, side)
    else:
        place, radius = _along(points, body, frames[body.name], spring.stop, side)
    if on is None:
        return StopPin(spring, None, place, radius)
    x, y, angle = frames[on]
    c, s = math.cos(angle), math.sin(angle)
    dx, dy = place[0] - x, place[1] - y
    return StopPin(spring, on, (c * dx + s * dy, c * dy - s * dx), radius)


def _dense(points: Array, step: float) -> Array:
    """The points of a line with others between them, no further apart than `step` m."""
    ways = np.diff(points, axis=0)
    count = np.clip(np.ceil(np.hypot(*ways.T) / step), 1, FINE).astype(int)
    starts = zip(points[:-1], ways, count, strict=True)
    between = [start + np.linspace(0.0, 1.0, n, endpoint=False)[:, None] * way for start, way, n in starts]
    return np.concatenate((*between, points[-1:]))


def _round(points: Array, frame: Array, way: float, side: float) -> tuple[tuple[float, float], float]:
    """Beside the longest arm of a body that turns by `way` to its stop: the circle that the outline then touches."""
    r, turn = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
    reach = float(r.max())
    radius, out = PIN * reach, OUT * reach
    arm = float(turn[np.argmax(r)])
    beside = (turn - arm + math.pi) % math.tau - math.pi
    near = (np.abs(r - out) < radius) & (np.abs(beside) < 0.5 * math.pi)
    cosine = (out**2 + r[near] ** 2 - radius**2) / (2.0 * out * r[near])
    met = side * beside[near] + np.arccos(np.clip(cosine, -1.0, 1.0))
    far = float(met.max(initial=math.asin(PIN / OUT)))
    direction = float(frame[2]) + way + arm + side * far
    return (float(frame[0]) + out * math.cos(direction), float(frame[1]) + out * math.sin(direction)), radius


def _along(points: Array, body: Body, frame: Array, stop: float, side: float) -> tuple[tuple[float, float], float]:
    """Before a body that slides, where it is longest."""
    here = placed(points, frame[None])[0]
    axis = np.array(body.axis)
    radius = 0.5 * PIN * float(np.ptp(here, axis=0).max())
    first = here[np.argmax(side * (here @ axis))]
    spot = first + (stop + side * radius) * axis
    return (float(spot[0]), float(spot[1])), radius
