"""Where does a spring between two points lie?

It is drawn as a helical spring is seen from the side: a straight eye at either end, and between them a zigzag of always the
same width, which a stretched spring draws out. It takes no part in the motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.render.frame.pose_matrix import pose_matrix
from watchsim.scene.carriers import at_start
from watchsim.scene.force import LineSpring
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]

COILS = 10
WIDTH = 0.05  # of its length: half the width of the zigzag
EYES = 0.12  # of the way between the points: straight, at either end


@dataclass(frozen=True)
class Zigzag:
    """A spring between a point of one body and a point of another, or of the movement (None); `half` (m) of its width."""

    between: tuple[str, str | None]
    points: tuple[Array, Array]
    half: float

    def line(self, frames: dict[str, Array]) -> Array:
        """(2 COILS + 4, 2) points in the movement (m) from end to end, for the poses x, y, angle of one instant."""
        first, last = self.ends(frames)
        way = last - first
        length = math.hypot(*way)
        side = self.half * np.array([-way[1], way[0]]) / length if length > 0.0 else np.zeros(2)
        return first + SHARES[:, None] * way + SIDES[:, None] * side

    def ends(self, frames: dict[str, Array]) -> Array:
        """(2, 2): where the two points are, m."""
        return np.array([_placed(point, frames, body) for point, body in zip(self.points, self.between, strict=True)])


def _zigzag() -> tuple[Array, Array]:
    """Shares of the way and of half the width, from point to point of the line."""
    steps = np.arange(2 * COILS) + 0.5
    along = EYES + (1.0 - 2.0 * EYES) * np.concatenate(([0.0], steps, [2.0 * COILS])) / (2.0 * COILS)
    across = np.concatenate(([0.0], np.where(np.arange(2 * COILS) % 2, -1.0, 1.0), [0.0]))
    return np.concatenate(([0.0], along, [1.0])), np.concatenate(([0.0], across, [0.0]))


SHARES, SIDES = _zigzag()


def _placed(point: Array, frames: dict[str, Array], body: str | None) -> Array:
    return point if body is None else (pose_matrix(frames[body]) @ [*point, 1.0])[:2]


def zigzags(scene: Scene) -> tuple[Zigzag, ...]:
    """All springs between points; each is as wide as the longer of its free length and that at the start asks for."""
    frames = {body.name: np.array([*body.position, body.angle]) for body in at_start(scene).bodies}
    return tuple(_of(spring, frames) for spring in scene.line_springs)


def _of(spring: LineSpring, frames: dict[str, Array]) -> Zigzag:
    first, second = (np.array(point) for point in spring.points)
    drawn = Zigzag(spring.between, (first, second), 0.0)
    apart = math.hypot(*np.subtract(*drawn.ends(frames)))
    return Zigzag(spring.between, (first, second), WIDTH * max(spring.length, apart))


def fixed_ends(scene: Scene) -> Array:
    """(n, 2) points of the movement (m) that springs are hooked to."""
    return np.array([s.points[k] for s in scene.line_springs for k in (0, 1) if s.between[k] is None]).reshape(-1, 2)


def hooks(scene: Scene, body: str) -> Array:
    """(n, 2) points in the body's frame (m) that springs are hooked to."""
    return np.array([s.points[k] for s in scene.line_springs for k in (0, 1) if s.between[k] == body]).reshape(-1, 2)
