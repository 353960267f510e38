"""Where does the hairspring of a balance lie?

It is drawn from the shape that a scene gives its spring: the collet turns with the balance, the stud stays where it is. It
takes no part in the motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.coil import Coil
from watchsim.render.frame.pose_matrix import pose_matrix
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]

STUD = 0.045  # of the stud's radius: half a side of the block that holds the outer end


@dataclass(frozen=True)
class Hairspring:
    """A spring's `coil` about the pivot of `body`, which stands on the body `on`; at rest where the body's angle is `rest`."""

    body: str
    on: str | None
    rest: float
    coil: Coil

    def turned(self, frames: dict[str, Array]) -> float:
        """How far (rad) the collet is turned from its rest, for the poses x, y, angle of one instant."""
        return float(frames[self.body][2]) - self._base(frames) - self.rest

    def line(self, frames: dict[str, Array], chords: int) -> Array:
        """(chords + 1, 2) points of the strip's middle in the movement (m), from collet to stud."""
        return self._placed(self.coil.line(self.turned(frames), chords), frames)

    def stud(self, frames: dict[str, Array]) -> Array:
        """(5, 2) corners (m) of the block at the outer end, the first one twice."""
        half, coil = STUD * self.coil.outer, self.coil
        middle = coil.outer * np.array([math.cos(coil.stud), math.sin(coil.stud)])
        along, across = middle / coil.outer, np.array([-middle[1], middle[0]]) / coil.outer
        sides = ((1, 1), (1, -1), (-1, -1), (-1, 1), (1, 1))
        return self._placed(np.array([middle + half * (a * along + b * across) for a, b in sides]), frames)

    def _base(self, frames: dict[str, Array]) -> float:
        return 0.0 if self.on is None else float(frames[self.on][2])

    def _placed(self, points: Array, frames: dict[str, Array]) -> Array:
        x, y, _ = frames[self.body]
        matrix = pose_matrix(np.array([x, y, self._base(frames)]))
        return points @ matrix[:2, :2].T + matrix[:2, 2]


def hairsprings(scene: Scene) -> tuple[Hairspring, ...]:
    """Those that the scene gives a shape."""
    return tuple(
        Hairspring(spring.body, scene.body(spring.body).on, spring.rest, spring.coil)
        for spring in scene.springs
        if spring.coil is not None
    )


def room_for(scene: Scene, body: str) -> Array:
    """(n, 2) points in the body's frame (m) that bound its hairspring; none without one."""
    reach = max((one.coil.outer * (1.0 + STUD) for one in hairsprings(scene) if one.body == body), default=0.0)
    angles = np.linspace(0.0, math.tau, 24, endpoint=False)
    return reach * np.column_stack((np.cos(angles), np.sin(angles))) if reach else np.empty((0, 2))
