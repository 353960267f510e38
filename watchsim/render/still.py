"""What does a scene look like at its start, and what of it can touch?"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from watchsim.geometry.primitives import Point
from watchsim.mechanism.check import ModelledPairs
from watchsim.mechanism.compile import Compiled
from watchsim.render.drawing_picture import FAULT
from watchsim.render.palette import DARK, LIGHT
from watchsim.render.parts import Edges
from watchsim.render.stage import Stage
from watchsim.render.view import poses
from watchsim.scene.scene import Scene
from watchsim.simulation.state import EVENT_DTYPE, Stop
from watchsim.simulation.trajectory import Trajectory
from watchsim.storage.write import write_file

SIZE = (1280, 720)
REACHABLE, CANDIDATE = "#1971c2", "#f76707"
REACHABLE_DARK = "#74c0fc"


def still(
    scene: Scene,
    path: str | os.PathLike[str],
    compiled: Compiled,
    pairs: ModelledPairs,
    overlaps: Sequence[Point] = (),
    dark: bool = False,
) -> None:
    """Write a picture (PNG or what else imageio knows) of the bodies where the scene puts them at t = 0.

    Edges that can ever touch another body are in colour, those of which a pair is a candidate at the start in another; rings
    mark the places (m) where bodies overlap. `dark`: on dark ground.
    """
    import imageio.v3 as imageio

    model = compiled.model
    picked: tuple[Edges, ...] = (
        Edges(model, np.setdiff1d(pairs.reachable, pairs.candidates), REACHABLE_DARK if dark else REACHABLE, "can ever touch"),
        Edges(model, pairs.candidates, CANDIDATE, "candidate at the start"),
    )
    if overlaps:
        picked = (*picked, Edges(model, np.zeros(0, np.int64), FAULT, "bodies overlap"))
    run = at_rest(scene, compiled)
    stage = Stage(run, SIZE, (0.0, 1.0), picked=picked, style=DARK if dark else LIGHT)
    frames = {name: rows[0] for name, rows in poses(run, np.zeros(1)).items()}
    pixels = stage.draw(0.0, frames, np.array(overlaps).reshape(-1, 2), FAULT)[..., :3]
    write_file(Path(path), lambda scratch: imageio.imwrite(scratch, pixels), "the picture")


def at_rest(scene: Scene, compiled: Compiled) -> Trajectory:
    """A run in which nothing moves."""
    q = compiled.relative(np.stack([compiled.q, compiled.q]))
    rest = np.zeros_like(q)
    events = np.zeros(0, EVENT_DTYPE)
    return Trajectory(scene, np.array([0.0, 1.0]), q, rest, rest, compiled.slices, events, (), Stop.DURATION)
