"""Which pictures make up a film? Any of them can be drawn alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.render.frame.marks.force_arrows import ForceArrows
from watchsim.render.frame.marks.touching_points import ContactMarks
from watchsim.render.frame.pose_history import poses
from watchsim.render.frame.stage import Stage
from watchsim.render.movies.pace import Plan
from watchsim.simulation.record.trajectory import Trajectory

Integers = NDArray[np.int64]
Pixels = NDArray[np.uint8]

AT_ONCE = 1000  # instants whose poses are asked for together: memory does not grow with the film


@dataclass(frozen=True)
class Film:
    """What it takes to draw any frame of a plan."""

    stage: Stage
    run: Trajectory
    plan: Plan
    marks: ContactMarks | None
    arrows: ForceArrows | None
    tells_speed: bool

    def pictures(self, numbers: Integers, progress: Callable[[int, int], None] | None = None) -> Iterator[Pixels]:
        """Frames of these numbers, one after the other, each in the same memory."""
        for start in range(0, len(numbers), AT_ONCE):
            part = numbers[start : start + AT_ONCE]
            where = poses(self.run, self.plan.times[part])
            for k, number in enumerate(part.tolist()):
                yield self._picture(number, {name: rows[k] for name, rows in where.items()})
                if progress is not None:
                    progress(start + k + 1, len(numbers))

    def _picture(self, number: int, frames: dict[str, NDArray[np.float64]]) -> Pixels:
        t = float(self.plan.times[number])
        return self.stage.draw(
            t,
            frames,
            self.marks.points(t, frames) if self.marks else None,
            press=self.arrows.at(number) if self.arrows else None,
            speed=float(self.plan.speeds[number]) if self.tells_speed else None,
        )
