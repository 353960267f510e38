"""How do the springs between points of bodies become records, and which coordinates do they hold how stiffly?"""

from __future__ import annotations

import math

from watchsim.model.records import LINE_SPRING, Records, records
from watchsim.scene.gear_trains import Bond
from watchsim.scene.scene import Scene

MOVEMENT = -1


def line_springs(scene: Scene) -> Records:
    """A record for each."""
    numbers = {body.name: i for i, body in enumerate(scene.bodies)}
    rows = records(LINE_SPRING, len(scene.line_springs))
    for row, spring in zip(rows, scene.line_springs, strict=True):
        first, second = spring.between
        row.a, row.b = numbers[first], MOVEMENT if second is None else numbers[second]
        (row.xa, row.ya), (row.xb, row.yb) = spring.points
        row.stiffness, row.length, row.viscous = spring.stiffness, spring.length, spring.viscous
    return rows


def coordinates_of_lines(
    scene: Scene, lines: Records, slices: dict[str, slice], bound: tuple[Bond, ...]
) -> list[tuple[int, float]]:
    """(coordinate, most stiffness that a line spring gives it) for each end on a body that moves."""
    found = []
    for line in lines:
        for b, x, y in ((int(line.a), line.xa, line.ya), (int(line.b), line.xb, line.yb)):
            if b == MOVEMENT or scene.bodies[b].motion == "fixed":
                continue
            part = slices[scene.bodies[bound[b].to].name]
            turns = scene.bodies[b].motion in ("pivot", "free")
            arm = bound[b].ratio * (math.hypot(x, y) if turns else 1.0)
            found += [
                (k, float(line.stiffness) * (arm if k == part.stop - 1 else 1.0) ** 2) for k in range(part.start, part.stop)
            ]
    return found
