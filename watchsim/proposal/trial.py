"""What comes of a proposal as it stands? It is run for some seconds, and what does not work is said in a sentence."""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.analysis.escape_wheel import not_held
from watchsim.analysis.summary import summary
from watchsim.analysis.verdict import verdict
from watchsim.escapement.function_report import findings
from watchsim.escapement.measure import WASTE, dropped, measure
from watchsim.escapement.turn import turn
from watchsim.geometry.primitives import Point
from watchsim.mechanism.check import notes
from watchsim.mechanism.overlap import chord_points, placed
from watchsim.proposal.pieces import ring
from watchsim.proposal.propose import SCENE, Proposal, propose
from watchsim.proposal.words import CLICK, DRIVER, OSCILLATOR, WHEEL
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.roles import frequency, oscillators, roles, swings
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop
from watchsim.simulation.trajectory import Trajectory

SECONDS, PERIODS = 3.0, 6.0  # at least: over the last three periods the work of the wheel is counted
LONGER = 60.0  # where the wheel brakes at first, as a swing does that is too large
PATIENCE = 10.0  # s of processor time: a mechanism that takes longer to compute is left to its user
ON = 0.9  # of a pitch: a wheel that goes on by less in all that time stands
STILL = 1e-6  # rad or m: what moves less in all that time does not move
BY_TRIAL = "tried both ways, it works this way only"
ALIKE = "it works either way"
BY_FUNCTION = "only this way do its teeth lock and drive, as check --turn measures them"
BY_DROP = "its teeth lock and drive either way, as check --turn measures them, and drop far less this way"
EITHER_WAY = "its teeth lock and drive either way, as check --turn measures them; it is driven the way that their tips lean"
TOGETHER = (
    "the drawings were taken to share one coordinate system: where each part is drawn about a zero of its own, give its place "
    "with position"
)
JAMS = "jams between two teeth"
BLOCKS = ("shake", "banking", "lock")  # findings of check
MENDED = "other inertias or another torque may mend what the trial shows"
CHORD, HELD = 1e-4, 1e-3  # of an outline, of the wheel: its chords, and how near to them something is held
NEAR = 1.25  # times the swing that a scene starts with: a jam within that is in the way


def tried(paths: Sequence[Path]) -> Proposal:
    """What drawings suggest, and what of it cannot be true, or does not work. NothingToPropose as for `propose`."""
    found = _tried(paths)
    apart = any(guess.key.endswith(".position") for guess in found.guesses)
    together = len(paths) > 1 and found.doubts and not apart
    return found.doubting([TOGETHER]) if together else found


def _tried(paths: Sequence[Path]) -> Proposal:
    """What drawings suggest, with what a run of it shows among the doubts.

    Where nothing says which way the wheel turns, or it does not work the way that its teeth lean, as those of a cylinder
    escapement, whose tips trail, it turns the way in which its function can be measured. Where both can, that is the way of the
    lean, unless they drop far less the other way; where neither can, the way in which it works: a trial has guessed inertias
    and torques, a measurement has none.
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
    drops = _drop(found), _drop(other)
    here, there = (math.isfinite(drops[0]), works), (math.isfinite(drops[1]), works_there)
    by_function, leans = here[0] != there[0], not found.either_way
    if here[0] and there[0] and leans:  # the drawing says more than a trial
        if drops[0] > WASTE * drops[1]:
            return propose(paths, other.way, BY_DROP).doubting(faults_there)
        return found.doubting([*faults, _in_doubt(EITHER_WAY, faults, found)])
    if here == there:
        return (propose(paths, found.way, ALIKE) if works and not leans else found).doubting(faults)
    if there > here or not leans:
        found = propose(paths, (other if there > here else found).way, BY_FUNCTION if by_function else BY_TRIAL)
        faults = faults_there if there > here else faults
    stepped = CLICK in tasks and DRIVER not in tasks
    if by_function and faults:
        faults.append(_in_doubt(BY_FUNCTION, faults, found))
    elif not by_function and (stepped or (there > here and leans and any(role.little for role in found.roles))):
        faults.append(
            f"which way the wheel is driven is a guess: {BY_TRIAL}, with inertias, springs and a torque that are guesses"
        )
    return found.doubting(faults)


def _in_doubt(why: str, faults: Sequence[str], found: Proposal) -> str:
    """Why it is driven that way, and what may mend what a trial showed, unless the outlines show a cause."""
    if any(JAMS in words for words in faults):
        return why
    causes = list(_by_outlines(found))
    return f"{why}; but {'; '.join(causes)}" if causes else f"{why}: {MENDED}"


def _by_outlines(found: Proposal) -> Iterator[str]:
    """What no inertia or torque mends, as `check` finds it: parts out of reach, a wheel that jams, no lock, a tight bank."""
    with tempfile.TemporaryDirectory() as folder:
        scene = _loaded(found, Path(folder))
    yield from (one.message for one in notes(scene) if one.code == "apart")
    measured = findings(scene, measure(scene, few=1))
    yield from (str(one["message"]) for one in measured if one["severity"] == "warning" and one["code"] in BLOCKS)


class _TakesLong(Exception):
    pass


def _drop(found: Proposal) -> float:
    """Of both pallets together (rad); infinite where they do not lock teeth, lift, and let them drop."""
    with tempfile.TemporaryDirectory() as folder:
        return dropped(measure(_loaded(found, Path(folder)), few=1, fork_too=False))


def _jam(scene: Scene) -> str | None:
    """Where an anchor that is led through its swing, the wheel pressed on, is held between two teeth; None where nowhere."""
    swings, wheel = roles(scene).oscillator, roles(scene).wheel
    spring = next((one for one in oscillators(scene) if one.body == swings), None)
    if swings is None or wheel is None or spring is None or roles(scene).lever is not None:
        return None
    try:
        found = turn(scene, NEAR * abs(scene.body(swings).angle - spring.rest))
    except SceneError:
        return None
    if found.cycle.jam is None:
        return None
    poses = {name: float(value) for name, value in zip(found.names, found.cycle.rows[-1], strict=True)}
    touched = _held(scene.body(swings), scene.body(wheel), poses, found.teeth)
    if len(touched) < 2:
        return None
    (x, y), (x2, y2) = ((1e3 * px, 1e3 * py) for px, py in touched[:2])
    return (
        f"{swings} {JAMS} of {wheel}: led to {math.degrees(poses[swings]):.3g}°, it is held at ({x:.4g}, {y:.4g}) and "
        f"({x2:.4g}, {y2:.4g}) mm, and {wheel}, at {math.degrees(poses[wheel]):.3g}°, cannot give way. No inertia or "
        f"torque mends that: make the pallet thinner, cut the teeth deeper, or let {swings} swing less"
    )


def _held(anchor: Body, wheel: Body, poses: Mapping[str, float], teeth: int) -> list[Point]:
    """The places (m) at which an anchor touches, the nearest first; two on one tooth count once."""
    one, other = (
        [placed(chord_points(loop, CHORD * loop.length), (*body.position, poses[body.name])) for loop in body.loops]
        for body in (anchor, wheel)
    )
    outer = max(math.dist(place, wheel.position) for place in np.concatenate(other).tolist())
    found = [
        (min(ring(loop, (x, y))[0] for loop in others), (x, y))
        for mine, others in ((one, other), (other, one))
        for x, y in np.concatenate(mine).tolist()
    ]
    held: list[Point] = []
    for away, place in sorted(found):
        if away <= HELD * outer and all(math.dist(place, there) > 0.5 * math.pi / teeth * outer for there in held):
            held.append(place)
    return held


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
        jam = _jam(run.scene)
        if jam is not None:
            yield jam
        return
    if run.stop is not None and Stop(run.stop).gave_up:
        yield f"{tried} it ends: {run.stop_message}"
        return
    if (why := not_held(run)) is not None:
        yield f"{tried} {why}"
    elif swings(run.scene) and found["amplitude_deg"] is None and found["timing_message"]:
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
