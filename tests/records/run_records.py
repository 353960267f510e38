"""Which numbers come of short runs of the library's mechanisms: summary, tables, report, forces, sound, instants of films?"""

import dataclasses
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from records.wording import said, shortened, without_unsure

from watchsim.analysis.flows import energy_shares
from watchsim.analysis.forces import forces
from watchsim.analysis.headlines import beats_csv, phases_csv
from watchsim.analysis.phases import phases
from watchsim.analysis.sound import score
from watchsim.analysis.summary import summary, summary_text
from watchsim.analysis.timegrapher import tape
from watchsim.analysis.timeline import timeline_text
from watchsim.analysis.timing import beats
from watchsim.paths import profiles_dir
from watchsim.render.keyframes import keyframes
from watchsim.render.movie import adaptive, busy
from watchsim.render.view import sampled, stretch
from watchsim.scene.load import load
from watchsim.scene.roles import frequency, swings
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import Trajectory

PROFILES = (
    *("balance", "bench_lever", "cam", "coaxial", "cylinder", "detent", "duplex", "geneva", "geneva_stop", "governor"),
    *("graham", "grasshopper", "incline", "jumper", "pin_wheel", "remontoir", "swiss_lever", "tourbillon", "verge"),
)
OSCILLATIONS, DURATION = 2.6, 0.5  # of what swings; s of the rest
LEFT_OUT = (  # where it runs, how long that takes, and how much work it was
    *("scene_file", "wall_s", "compile_s", "realtime_factor", "versions", "counts", "overlap"),
)
SHOWN = 5  # instants at which forces are asked for
ROUNDING = (1e-14, -3e-14, 7e-14, -1e-13)  # relative changes of a scene as another machine's arithmetic may make them


def records() -> dict[str, Callable[[Path], str]]:
    """By name: what is said of a run."""
    return {name: partial(of_profile, name) for name in PROFILES}


def kept(name: str, text: str) -> str:
    """A text as it is to be kept: what rounding moves, or the clock, is blotted out."""
    for change in ROUNDING:
        text = without_unsure(text, _said_of(shaken(load(profiles_dir() / name), change)))
    return text


def of_profile(name: str, _: Path) -> str:
    return _said_of(load(profiles_dir() / name))


def shaken(scene: Scene, change: float) -> Scene:
    """The scene with inertias, velocities, springs and drives changed by about as much, each by another share."""
    bodies = tuple(
        dataclasses.replace(
            body,
            inertia=body.inertia * (1.0 + change * (k + 1)),
            velocity=tuple(value * (1.0 - 0.7 * change) for value in body.velocity),
        )
        for k, body in enumerate(scene.bodies)
    )
    springs = tuple(dataclasses.replace(one, stiffness=one.stiffness * (1.0 + 0.4 * change)) for one in scene.springs)
    torques = tuple(dataclasses.replace(one, value=one.value * (1.0 - 0.3 * change)) for one in scene.torques)
    return dataclasses.replace(scene, bodies=bodies, springs=springs, torques=torques)


def _said_of(scene: Scene) -> str:
    hertz = frequency(scene)
    run = simulate(scene, duration=OSCILLATIONS / hertz if hertz else DURATION)
    return shortened("\n".join(_lines(dataclasses.replace(run, compile=0.0))) + "\n")


def _lines(run: Trajectory) -> Iterator[str]:
    numbers = summary(run)
    yield summary_text(run, numbers)
    energy = {name: value for name, value in numbers.pop("energy").items() if not name.startswith("residual")}
    yield from said({name: value for name, value in numbers.items() if name not in LEFT_OUT})
    yield from said(energy, "energy")
    if swings(run.scene):
        found = beats(run)
        yield "".join(beats_csv(found)).strip()
        yield "".join(phases_csv(run, found)).strip()
    for name, part in (("timeline", timeline_text), ("shares", energy_shares), ("tape", tape), ("sound", _heard)):
        yield from _or_why_not(name, part, run)
    if len(run.t):
        yield from _or_why_not("forces", _forces, run)
        yield from _filmed(run)


def _or_why_not(name: str, part: Callable[[Trajectory], Any], run: Trajectory) -> Iterator[str]:
    try:
        value = part(run)
    except ValueError as error:
        value = str(error)
    yield from (value.splitlines() if isinstance(value, str) else said(value, name))


def _heard(run: Trajectory) -> dict[str, Any]:
    found = score(run)
    return {"times": found.times[-6:], "energies": found.energies[-6:], "known": found.known, "loop": found.loop}


def _forces(run: Trajectory) -> dict[str, Any]:
    found = forces(run, np.linspace(run.t[0], run.t[-1], SHOWN + 2)[1:-1])
    return {"normal": found.normal, "tangential": found.tangential, "pivots": found.pivots, "drives": found.drives}


def _filmed(run: Trajectory) -> Iterator[str]:
    """How far each body goes, when films are slow, and how many keys its motion takes."""
    span = stretch(run, None) if len(run.spans) < 2 else run.spans[-1]
    slow = busy(run, phases(run), span)
    plan = adaptive(span, slow, 4.0, 10.0)
    yield from said({"slow": slow[:4], "frames": plan.times[::8], "speeds": plan.speeds[::8]}, "film")
    for track in keyframes(run, span, 0.05):
        yield f"{track.name}: {len(track.t)} keys, {track.t[0]:.10g} s to {track.t[-1]:.10g} s"
    for body in run.scene.bodies:
        if body.name in run.slices:
            rows = sampled(run, body, span)
            yield from said(np.ptp(rows, axis=0), f"{body.name} goes")
