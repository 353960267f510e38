"""What comes of a proposal as it stands? It is run for some seconds, and what does not work is said in a sentence."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.analysis.summary import summary
from watchsim.analysis.verdict import verdict
from watchsim.proposal.propose import Proposal, propose
from watchsim.scene.load import load
from watchsim.scene.roles import swings
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import Trajectory

SECONDS, LONGER = 3.0, 60.0  # the longer one where the wheel brakes at first, as a swing does that is too large
PATIENCE = 10.0  # s: a mechanism that takes longer to compute is left to its user
STILL = 1e-6  # rad or m: what moves less in all that time does not move


def tried(paths: Sequence[Path]) -> Proposal:
    """What drawings suggest, with what a run of it shows among the doubts.

    Where nothing says which way the wheel turns, it is the way in which it works. NothingToPropose as for `propose`.
    """
    found = propose(paths)
    if not found.meets:
        return found
    if found.either_way:
        ways = [(one, *_run(one.files)) for one in (propose(paths, way) for way in (-1, 1))]
        works = [one for one, wrong, drives in ways if drives and not wrong]
        if len(works) == 1:
            return works[0]
    return replace(found, doubts=(*found.doubts, *_run(found.files)[0]))


class _TakesLong(Exception):
    pass


def _run(files: Mapping[str, bytes]) -> tuple[list[str], bool]:
    """Sentences on what does not work in the first seconds of the scene among those files, none where all does, and whether the
    wheel drives the oscillator: it may tick and take from the swing all the same."""
    began = time.monotonic()

    def progress(_now: float, _end: float) -> None:
        if time.monotonic() - began > PATIENCE:
            raise _TakesLong

    with tempfile.TemporaryDirectory() as folder:
        for name, data in files.items():
            (Path(folder) / name).write_bytes(data)
        scene = load(Path(folder) / "scene.toml")
        try:
            run = simulate(scene, SECONDS, progress=progress, to_the_end=False)
            if (summary(run)["efficiency"] or 0.0) < 0.0:
                run = simulate(scene, LONGER, progress=progress, to_the_end=False)
        except _TakesLong:
            return [f"a trial of {SECONDS:g} s takes long and was broken off: whether it works is not known"], False
    numbers = summary(run)
    return list(_wrong(run, numbers)), (numbers["efficiency"] or 0.0) > 0.0


def _wrong(run: Trajectory, found: Mapping[str, Any]) -> Iterator[str]:
    tried, judged = f"in a trial of {run.simulated:.3g} s", verdict(run)
    if not judged.works:
        yield f"{tried} it does not work: {judged.message}"
        return
    if swings(run.scene) and found["amplitude_deg"] is None and found["timing_message"]:
        yield f"{tried} it keeps no time: {found['timing_message']}"
    if not (run.events["contact"] >= 0).any() and len(run.scene.bodies) > 1:
        yield f"{tried} nothing touches anything: no part drives another one"
        return
    if (share := found["efficiency"]) is not None and share < 0.0:
        yield f"{tried} the wheel drives nothing: it takes more from the swing than it gives. Try more torque"
    still = [
        body.name for body in run.scene.bodies if body.name in run.slices and np.ptp(run.q[:, run.slices[body.name]]) < STILL
    ]
    if still:
        yield f"{tried} {' and '.join(still)} never {'moves' if len(still) == 1 else 'move'}"
