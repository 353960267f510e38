"""What comes of a proposal as it stands? It is run for some seconds, and what does not work is said in a sentence."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from watchsim.analysis.summary import summary
from watchsim.analysis.verdict import verdict
from watchsim.scene.load import load
from watchsim.scene.roles import swings
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import Trajectory

SECONDS = 3.0
PATIENCE = 10.0  # s: a mechanism that takes longer to compute is left to its user
STILL = 1e-6  # rad or m: what moves less in all that time does not move


class _TakesLong(Exception):
    pass


def trial(files: Mapping[str, bytes]) -> list[str]:
    """Sentences on what does not work in the first seconds of the scene among those files; none where all does."""
    began = time.monotonic()

    def progress(_now: float, _end: float) -> None:
        if time.monotonic() - began > PATIENCE:
            raise _TakesLong

    with tempfile.TemporaryDirectory() as folder:
        for name, data in files.items():
            (Path(folder) / name).write_bytes(data)
        scene = load(Path(folder) / "scene.toml")
        try:
            return list(_wrong(simulate(scene, SECONDS, progress=progress, to_the_end=False)))
        except _TakesLong:
            return [f"a trial of {SECONDS:g} s takes long and was broken off: whether it works is not known"]


def _wrong(run: Trajectory) -> Iterator[str]:
    tried = f"in a trial of {SECONDS:g} s"
    found, judged = summary(run), verdict(run)
    if not judged.works:
        yield f"{tried} it does not work: {judged.message}"
        return
    if swings(run.scene) and found["amplitude_deg"] is None and found["timing_message"]:
        yield f"{tried} it keeps no time: {found['timing_message']}"
    if not found["impacts"] and len(run.scene.bodies) > 1:
        yield f"{tried} nothing strikes anything: no part drives another one"
        return
    still = [
        body.name for body in run.scene.bodies if body.name in run.slices and np.ptp(run.q[:, run.slices[body.name]]) < STILL
    ]
    if still:
        yield f"{tried} {' and '.join(still)} never {'moves' if len(still) == 1 else 'move'}"
