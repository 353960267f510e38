"""What comes of a proposal as it stands? It is run for some seconds, and what does not work is said in a sentence."""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.analysis.summary import summary
from watchsim.analysis.verdict import verdict
from watchsim.proposal.pieces import OSCILLATOR
from watchsim.proposal.propose import Proposal, propose
from watchsim.scene.load import load
from watchsim.scene.roles import frequency, pitch, swings
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import Trajectory

SECONDS, PERIODS = 3.0, 6.0  # at least: over the last three periods the work of the wheel is counted
LONGER = 60.0  # where the wheel brakes at first, as a swing does that is too large
PATIENCE = 10.0  # s of processor time: a mechanism that takes longer to compute is left to its user
STILL = 1e-6  # rad or m: what moves less in all that time does not move


def tried(paths: Sequence[Path]) -> Proposal:
    """What drawings suggest, with what a run of it shows among the doubts.

    The wheel turns the way in which it works where nothing says which way it turns, or where it does not work the way that its
    teeth lean, as those of a cylinder escapement, whose tips trail. NothingToPropose as for `propose`.
    """
    found = propose(paths)
    if not found.meets:
        return found
    wrong, drives = _run(found.files)
    works = drives and not wrong
    if found.either_way or (not works and any(role.task == OSCILLATOR for role in found.roles)):
        other = propose(paths, -found.way)
        wrong_there, drives_there = _run(other.files)
        if works != (drives_there and not wrong_there):
            return other if not works else propose(paths, found.way)
    return replace(found, doubts=(*found.doubts, *wrong))


class _TakesLong(Exception):
    pass


def _run(files: Mapping[str, bytes]) -> tuple[list[str], bool]:
    """Sentences on what does not work in the first seconds of the scene among those files, none where all does, and whether the
    wheel drives the oscillator, which it may not do though it ticks, or is driven on by a tooth."""
    began = time.process_time()

    def progress(_now: float, _end: float) -> None:
        if time.process_time() - began > PATIENCE:
            raise _TakesLong

    with tempfile.TemporaryDirectory() as folder:
        for name, data in files.items():
            (Path(folder) / name).write_bytes(data)
        scene = load(Path(folder) / "scene.toml")
        try:
            seconds = max(SECONDS, PERIODS / (frequency(scene) or math.inf))
            run = simulate(scene, seconds, progress=progress, to_the_end=False)
            if (summary(run)["efficiency"] or 0.0) < 0.0:
                run = simulate(scene, LONGER, progress=progress, to_the_end=False)
        except _TakesLong:
            return [f"a trial of {seconds:.3g} s takes long and was broken off: whether it works is not known"], False
    numbers = summary(run)
    return list(_wrong(run, numbers)), (numbers["efficiency"] or 0.0) > 0.0 or _fall_back(run) == []


def _fall_back(run: Trajectory) -> list[str] | None:
    """The toothed bodies that a driven one carries on by no tooth, since they fall back; None without such bodies."""
    pivoted = [body for body in run.scene.bodies if body.motion in ("pivot", "driven") and body.geared is None]
    toothed = [(body.name, pitch(run.scene, body.name)) for body in pivoted if body.prescribed is None]
    found = [(name, one) for name, one in toothed if one]
    if not found or len(toothed) == len(pivoted):
        return None
    return [name for name, one in found if np.ptp(run.q[[0, -1], run.slices[name].start]) < 0.9 * one]


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
    if back := _fall_back(run):
        yield f"{tried} {' and '.join(back)} is moved, and falls back each time: nothing carries it on by a tooth"
    still = [
        body.name for body in run.scene.bodies if body.name in run.slices and np.ptp(run.q[:, run.slices[body.name]]) < STILL
    ]
    if still:
        yield f"{tried} {' and '.join(still)} never {'moves' if len(still) == 1 else 'move'}"
