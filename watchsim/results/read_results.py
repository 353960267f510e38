"""Which trajectory does a results folder hold?"""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path

from watchsim.results.archive import read_trajectory
from watchsim.results.scene_copy import LOCK
from watchsim.results.state_file import read_state
from watchsim.results.write_results import STATE, TRAJECTORY
from watchsim.scene.file.load import SCENE_FILES, load
from watchsim.simulation.record.trajectory import Trajectory


def read_results(folder: str | os.PathLike[str]) -> Trajectory:
    """The trajectory of a results folder, with its scene.

    FileNotFoundError where the folder or a file of it is missing, ValueError where one is damaged or does not belong to the
    others, SceneError where the scene can no longer be loaded.
    """
    place = Path(folder)
    if not place.is_dir():
        raise FileNotFoundError(f"{folder}: there is no such results folder")
    missing = [name for name in (LOCK, TRAJECTORY) if not (place / name).is_file()]
    if missing:
        cure = f". It holds a scene: watchsim run {folder} makes results of it" if (place / SCENE_FILES[0]).is_file() else ""
        raise FileNotFoundError(f"{folder} is not a results folder of watchsim: {' and '.join(missing)} missing{cure}")
    run = read_trajectory(place / TRAJECTORY, load(place / LOCK))
    if (place / STATE).is_file():
        run = dataclasses.replace(run, end_state=read_state(place / STATE))
    return run
