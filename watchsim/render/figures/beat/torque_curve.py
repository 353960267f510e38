"""Which torque do the contacts exert on the balance, and which work do forces and impacts do on it in each phase of a beat?

From the forces at the contacts and the jumps of the velocity; the timeline (phases.csv) has the same energies from the books of
the balance alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from watchsim.analysis.contact_forces import forces
from watchsim.analysis.timeline.rows import Stage
from watchsim.analysis.timeline.shown_beats import Beat
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.roles import roles
from watchsim.simulation.record.body_frames import frames
from watchsim.simulation.record.trajectory import Array, Trajectory

WITHIN = 3  # instants in a step
FINE = 60  # steps of a phase at least
JUST = 1e-6  # of a step: so long before its end its contacts still hold


@dataclass(frozen=True)
class Push:
    """A phase with the torque in it.

    angle   of the balance, rad (n,), and `torque` of all contacts on it, N·m (n,)
    forces  work of the torque over the angle, J; `impacts` that of the impacts, J
    struck  angles (rad) at which the impacts hit, and the work of each, J
    way     +1 or -1: the direction of the swing
    """

    stage: Stage
    angle: Array
    torque: Array
    forces: float
    impacts: float
    struck: tuple[tuple[float, float], ...]
    way: float


def pushes(run: Trajectory, beats: Sequence[Beat]) -> list[list[Push]]:
    """Of every phase of some beats but the free oscillation."""
    name = roles(run.scene).oscillator
    assert name is not None
    compiled = compile_scene(run.scene)
    stages = [[stage for stage in beat.stages if stage.name != "locked"] for beat in beats]
    times = [_instants(run, stage.phase.start, stage.phase.end) for own in stages for stage in own]
    whole = torque_on(run, name, np.concatenate(times))
    curves = zip(times, np.split(whole, np.cumsum([len(own) for own in times])[:-1]), strict=True)
    return [[_push(run, compiled, name, stage, *next(curves)) for stage in own] for own in stages]


def _push(run: Trajectory, compiled: Compiled, name: str, stage: Stage, times: Array, torque: Array) -> Push:
    angle = run.positions(times, [run.slices[name].start])[:, 0]
    work = float(np.sum(0.5 * (torque[1:] + torque[:-1]) * np.diff(angle)))
    struck = _impacts(run, compiled, name, stage)
    way = 1.0 if angle[-1] >= angle[0] else -1.0
    return Push(stage, angle, torque, work, sum(value for _, value in struck), struck, way)


def _instants(run: Trajectory, start: float, end: float) -> Array:
    """Of each step between rows its start, some instants within, and one just before its end."""
    inside = run.t[(run.t > start) & (run.t < end)]
    edges, longest = np.unique(np.concatenate(([start], inside, [end]))), (end - start) / FINE
    found = []
    for low, high in pairwise(edges.tolist()):
        count = max(WITHIN, int(np.ceil((high - low) / longest)) + 1) if high - low > longest else WITHIN
        last = high - max(JUST * (high - low), float(np.spacing(high)))
        found.append(np.linspace(low, max(last, low), count))
    return np.concatenate(found) if found else np.array([start])


def torque_on(run: Trajectory, name: str, times: Array) -> Array:
    """Moment of all contact forces on a body about its pivot, N·m (n,), after what happens at these times (s)."""
    told = forces(run, times)
    places = frames(run.scene, run.slices, run.sample(times)[0])[name]
    total = np.zeros(len(times))
    for k, contact in enumerate(told.pairs):
        pair = run.pairs[int(contact)]
        side = {pair.body_a: 1.0, pair.body_b: -1.0}.get(name, 0.0)
        if side == 0.0:
            continue
        normal = told.direction[:, k]
        across = np.stack((-normal[:, 1], normal[:, 0]), axis=1)
        force = told.normal[:, k, None] * normal + told.tangential[:, k, None] * across
        arm = told.point[:, k] - places[:, :2]
        total += side * np.nan_to_num(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0])
    return total


def _impacts(run: Trajectory, compiled: Compiled, name: str, stage: Stage) -> tuple[tuple[float, float], ...]:
    """Angle and work of every jump of the balance's velocity that the timeline counts with this phase."""
    column = run.slices[name].start
    low = np.searchsorted(run.t, stage.phase.start, "right" if stage.name == "run to banking" else "left")
    high = np.searchsorted(run.t, stage.phase.end, "right" if stage.name == "drop" else "left")
    rows = np.arange(max(int(low), 1), int(high) + 1)
    rows = rows[(rows < len(run.t))]
    jumps = rows[(run.t[rows] == run.t[rows - 1]) & (rows - 1 >= low) & (rows < high)]
    inertia = float(compiled.model.coordinates[column].mass)
    return tuple(
        (float(run.q[k, column]), 0.5 * inertia * float(run.u[k, column] ** 2 - run.u[k - 1, column] ** 2))
        for k in jumps.tolist()
        if run.u[k, column] != run.u[k - 1, column]
    )
