"""Does every expectation of a scene name a number that its runs give, in a unit of its kind?

Worth asking before a long run: the names are those of the summary of a run that has not begun.
"""

from __future__ import annotations

import numpy as np

from watchsim.analysis.expectations import mistakes
from watchsim.analysis.summary import summary
from watchsim.mechanism.compile import compile_scene
from watchsim.mechanism.errors import Fault, Faults
from watchsim.mechanism.locate import key_lines
from watchsim.mechanism.scene import Scene
from watchsim.simulation.state import COUNT_NAMES
from watchsim.simulation.stops import Stop
from watchsim.simulation.trajectory import EVENT_DTYPE, Trajectory

COUNTS = (*COUNT_NAMES, "cells", "cells_asked", "declared_pairs", "sweeps")
LOOKED = ("worst_m", "resolution_m", "allowed_m", "looks", "t_s", "x_mm", "y_mm")
CAUSES = ("friction", "damping", "impacts", "stepping")


def expectation_faults(scene: Scene) -> list[Fault]:
    """A fault for each expectation that no run of the scene can answer."""
    if not scene.expect:
        return []
    numbers = summary(_not_begun(scene))
    lines = key_lines(scene.path.read_text(encoding="utf-8-sig")) if scene.path and scene.path.is_file() else {}
    faults = Faults(str(scene.path or "scene"), lines)
    for expectation, message in zip(scene.expect, mistakes(scene.expect, numbers), strict=True):
        if message:
            faults.add(f"expect.{expectation.key}", message)
    return faults.found


def _not_begun(scene: Scene) -> Trajectory:
    compiled = compile_scene(scene)
    q = compiled.relative(compiled.q[None])
    rest = np.zeros_like(q)
    return Trajectory(
        scene=scene,
        t=np.zeros(1),
        q=q,
        u=rest,
        a=rest,
        slices=compiled.slices,
        events=np.zeros(0, EVENT_DTYPE),
        pairs=(),
        stop=Stop.DURATION,
        energy={"dissipated": dict.fromkeys(CAUSES, 0.0)},
        counts=dict.fromkeys(COUNTS, 0),
        overlap={**dict.fromkeys(LOOKED, 0.0), "between": None},
    )
