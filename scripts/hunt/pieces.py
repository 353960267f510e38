"""How much of a disagreement do two runs make on the way, and how much has only grown from rounding?

Unstable motion multiplies: a cam that chatters under an arm turns the rounding of one impact into 10⁻³ of the size. Twins,
which differ from the start, do not show that where the motion has forgotten its start before. So a run is restarted at each of
its samples: what a piece does otherwise is made there, and grows no further. It is taken for a difference of rates, which goes
on to the end. Where both runs are what the other description makes piece by piece, they obey the same laws, and what parts them
is growth. What has gone wrong in one whole run alone, as a contact lost, shows in the piece where it happens.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hunt.views import View
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.state import Stop
from watchsim.simulation.trajectory import Trajectory

if TYPE_CHECKING:
    from hunt.judge import Judge

Array = NDArray[np.float64]

LONG = 2  # samples a piece: a rate that comes out otherwise in the first shows in the second


def made(judge: Judge, run: Trajectory, tolerance: float, view: View | None = None) -> Array:
    """(samples,): how far, as shares of the size, pieces at that tolerance and seen from there lead away from a run."""
    found = np.zeros(len(judge.times))
    starts, step = np.concatenate([[0.0], judge.times[:-1]]), judge.times[0]
    for k, start in enumerate(starts):
        own = _piece(judge, run, tolerance, view, start, judge.times[k : k + LONG])
        found[k:] += own * np.maximum(judge.times[k:] - start, step) / step
    return found


def _piece(judge: Judge, run: Trajectory, tolerance: float, view: View | None, start: float, times: Array) -> float:
    """How far a piece leads away from the run that it begins on; infinite where it comes to no end."""
    row = max(int(np.searchsorted(run.t, start, side="right")) - 1, 0)  # the end of a step, where gaps are closed
    scene, begun = resumed(run, row, float(times[-1]))
    try:
        piece = judge.run(scene if view is None else view.of(scene), tolerance)
    except SceneError:
        return np.inf
    if piece.stop != Stop.DURATION:
        return np.inf
    q, _ = run.sample(times)
    away = judge.motion(piece, view, times - run.t[row]) + (begun - q) * judge.weights
    return float(np.abs(away).max())


def resumed(run: Trajectory, row: int, until: float) -> tuple[Scene, Array]:
    """The scene of a run from one of its rows on, and what its coordinates there are to be raised by to be those of the run.

    A sliding body starts again at zero, where its guide stands.
    """
    scene, q, u = run.scene, run.q[row], run.u[row]
    bodies, springs, begun = [], list(scene.springs), np.zeros(len(q))
    for body in scene.bodies:
        own = run.slices.get(body.name, slice(0))
        bodies.append(_standing(body, q[own], u[own]))
        if body.motion == "slide":
            begun[own] = q[own]
            springs = [replace(s, rest=s.rest - float(q[own][0])) if s.body == body.name else s for s in springs]
    return replace(scene, bodies=tuple(bodies), springs=tuple(springs), duration=until - float(run.t[row])), begun


def _standing(body: Body, q: Array, u: Array) -> Body:
    """A body moved to where its coordinates are `q`, with the velocities `u`."""
    velocity = tuple(float(value) for value in u)
    if body.motion == "pivot":
        return replace(body, angle=float(q[0]), velocity=velocity)
    if body.motion == "slide":
        (x, y), (ax, ay), way = body.position, body.axis, float(q[0])
        return replace(body, position=(x + way * ax, y + way * ay), velocity=velocity)
    if body.motion == "free":
        return replace(body, position=(float(q[0]), float(q[1])), angle=float(q[2]), velocity=velocity)
    return body
