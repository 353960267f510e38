"""What comes of a proposal as it stands? It is run for some seconds, and what does not work is said in a sentence."""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.analysis.summary import summary
from watchsim.analysis.verdict import verdict
from watchsim.escapement.measure import measure
from watchsim.proposal.propose import SCENE, Proposal, propose
from watchsim.proposal.words import CLICK, DRIVER, OSCILLATOR, WHEEL
from watchsim.scene.load import load
from watchsim.scene.roles import frequency, swings
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop
from watchsim.simulation.trajectory import Trajectory

SECONDS, PERIODS = 3.0, 6.0  # at least: over the last three periods the work of the wheel is counted
LONGER = 60.0  # where the wheel brakes at first, as a swing does that is too large
PATIENCE = 10.0  # s of processor time: a mechanism that takes longer to compute is left to its user
ON = 0.9  # of a pitch: a wheel that goes on by less in all that time stands
STILL = 1e-6  # rad or m: what moves less in all that time does not move
BY_TRIAL = "tried both ways, it works this way only"
BY_FUNCTION = "only this way do its teeth lock and drive, as check --turn measures them"
EITHER_WAY = (
    "its teeth lock and drive either way, as check --turn measures them; it is driven the way that their tips lean: other "
    "inertias or another torque may mend what the trial shows"
)


def tried(paths: Sequence[Path]) -> Proposal:
    """What drawings suggest, with what a run of it shows among the doubts.

    Where nothing says which way the wheel turns, or it does not work the way that its teeth lean, as those of a cylinder
    escapement, whose tips trail, it turns the way in which its function can be measured, where both are the way of the lean,
    else the way in which it works: a trial has guessed inertias and torques, a measurement has none. NothingToPropose as for
    `propose`.
    """
    found = propose(paths)
    if not found.meets:
        return found
    faults, works = _run(found)
    tasks = {role.task for role in found.roles}
    if not tasks & {OSCILLATOR, DRIVER, CLICK} or (works and not found.either_way):
        return found.doubting(faults)
    other = propose(paths, -found.way)
    faults_there, works_there = _run(other)
    here, there = (_is_measured(found), works), (_is_measured(other), works_there)
    by_function, leans = here[0] != there[0], not found.either_way
    if here[0] and there[0] and leans:  # the drawing says more than a trial
        return found.doubting([*faults, EITHER_WAY])
    if here == there:
        return found.doubting(faults)
    if there > here or not leans:
        found = propose(paths, (other if there > here else found).way, BY_FUNCTION if by_function else BY_TRIAL)
        faults = faults_there if there > here else faults
    stepped = CLICK in tasks and DRIVER not in tasks
    if by_function and faults:
        faults.append(f"{BY_FUNCTION}: other inertias or another torque may mend what the trial shows")
    elif not by_function and (stepped or (there > here and leans and any(role.little for role in found.roles))):
        faults.append(
            f"which way the wheel is driven is a guess: {BY_TRIAL}, with inertias, springs and a torque that are guesses"
        )
    return found.doubting(faults)


class _TakesLong(Exception):
    pass


def _is_measured(found: Proposal) -> bool:
    """Do both pallets lock teeth, lift, and let them drop?"""
    with tempfile.TemporaryDirectory() as folder:
        return measure(_loaded(found, Path(folder)), few=1, fork_too=False).pallets is not None


def _loaded(found: Proposal, folder: Path) -> Scene:
    for name, data in found.files.items():
        (folder / name).write_bytes(data)
    return load(folder / SCENE)


def _run(found: Proposal) -> tuple[list[str], bool]:
    """Sentences on what does not work in the first seconds of the scene, none where all does, and whether it works: the wheel
    drives the oscillator, which it may not do though it ticks, or is driven on by a tooth."""
    began: list[float] = []  # at the first step: kernels may have to be compiled before

    def progress(_now: float, _end: float) -> None:
        if not began:
            began.append(time.process_time())
        if time.process_time() - began[0] > PATIENCE:
            raise _TakesLong

    with tempfile.TemporaryDirectory() as folder:
        scene = _loaded(found, Path(folder))
        try:
            seconds = max(SECONDS, PERIODS / (frequency(scene) or math.inf))
            run = simulate(scene, seconds, progress=progress, to_the_end=False)
            if (summary(run)["efficiency"] or 0.0) < 0.0:
                run = simulate(scene, LONGER, progress=progress, to_the_end=False)
        except _TakesLong:
            return [f"a trial of {seconds:.3g} s takes long and was broken off: whether it works is not known"], False
    numbers = summary(run)
    faults = list(_wrong(run, numbers, found))
    stepped = _stepped(found)
    return faults, not faults and ((numbers["efficiency"] or 0.0) > 0.0 or bool(stepped))


def _stepped(found: Proposal) -> list[str]:
    """The toothed wheels that go on tooth by tooth, moved by a body that turns evenly, or held by a click."""
    tasks = {role.task for role in found.roles}
    stepwise = OSCILLATOR not in tasks and (CLICK in tasks or b'motion = "driven"' in found.files[SCENE])
    return [role.name for role in found.roles if role.task == WHEEL and role.teeth and stepwise]


def _wrong(run: Trajectory, found: Mapping[str, Any], proposal: Proposal) -> Iterator[str]:
    tried, judged = f"in a trial of {run.simulated:.3g} s", verdict(run)
    if not judged.works:
        yield f"{tried} it does not work: {judged.message}"
        return
    if run.stop is not None and Stop(run.stop).gave_up:
        yield f"{tried} it ends: {run.stop_message}"
        return
    if swings(run.scene) and found["amplitude_deg"] is None and found["timing_message"]:
        yield f"{tried} it keeps no time: {found['timing_message']}"
    if not (run.events["contact"] >= 0).any() and len(run.scene.bodies) > 1:
        yield f"{tried} nothing touches anything: no part drives another one"
        return
    if (share := found["efficiency"]) is not None and share < 0.0:
        yield f"{tried} the wheel drives nothing: it takes more from the swing than it gives. Try more torque"
    still = [name for name, place in run.slices.items() if np.ptp(run.q[:, place]) < STILL]
    if still:
        yield f"{tried} {' and '.join(still)} never {'moves' if len(still) == 1 else 'move'}"
    for role in (role for role in proposal.roles if role.name in _stepped(proposal) and role.name not in still):
        if np.ptp(run.q[[0, -1], run.slices[role.name].start]) < ON * math.tau / role.teeth:
            driven = any(torque.body == role.name for torque in run.scene.torques)
            why = (
                "stands: its torque does not carry it on"
                if driven
                else "is moved, and falls back each time: nothing carries it on"
            )
            yield f"{tried} {role.name} {why} by a tooth"
