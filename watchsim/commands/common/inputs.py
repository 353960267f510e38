"""How does a command get its scene, and a results folder its trajectory?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from watchsim.commands.common.console import InputError

if TYPE_CHECKING:
    from watchsim.scene.scene import Scene
    from watchsim.simulation.record.trajectory import Trajectory


def load_scene(name: str, changes: list[str] | None = None, overlap: bool = True) -> Scene:
    """The scene of a file or folder with the KEY=VALUE of --set in it; SceneError lists all that is wrong, expectations that no
    run can answer and overlaps included.
    """
    from watchsim.analysis.promised import expectation_faults
    from watchsim.mechanism.overlap import overlap_faults
    from watchsim.scene.errors import SceneError
    from watchsim.scene.file.load import load_set
    from watchsim.scene.file.override import assignments

    scene = load_set(name, assignments(changes or ()))
    faults = [*(overlap_faults(scene) if overlap else ()), *expectation_faults(scene)]
    if faults:
        raise SceneError(faults)
    return scene


def read_run(folder: str) -> Trajectory:
    """The trajectory kept in a results folder."""
    from watchsim.results.read_results import read_results

    try:
        return read_results(folder)
    except (OSError, ValueError, KeyError) as error:
        told = str(error)
        raise InputError(told if told.startswith(folder) else f"{folder}: {told}") from error
