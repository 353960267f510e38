"""What does a scene look like at its start?"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from watchsim.mechanism.compile import compile_scene
from watchsim.mechanism.scene import Scene
from watchsim.render.movie import frame
from watchsim.simulation.stops import Stop
from watchsim.simulation.trajectory import EVENT_DTYPE, Trajectory


def still(scene: Scene, path: str | os.PathLike[str], size: tuple[int, int] = (1280, 720)) -> None:
    """Write a picture (PNG or what else imageio knows) of the bodies where the scene puts them at t = 0."""
    import imageio.v3 as imageio

    compiled = compile_scene(scene)
    q = compiled.relative(np.stack([compiled.q, compiled.q]))
    rest = Trajectory(
        scene=scene,
        t=np.array([0.0, 1.0]),
        q=q,
        u=np.zeros_like(q),
        a=np.zeros_like(q),
        slices=compiled.slices,
        events=np.zeros(0, EVENT_DTYPE),
        pairs=(),
        stop=Stop.DURATION,
    )
    imageio.imwrite(Path(path), frame(rest, 0.0, size=size))
