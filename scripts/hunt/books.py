"""Does one run obey mechanics, whatever the right motion is?

Energy is computed here from the rows of the motion and the scene, not taken from the ledger; overlap by shapely; impulses by
`hunt.impulses`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hunt.energies import masses, of_a_step, potential, pulls, unopposed
from hunt.generator.material import Material, reach
from hunt.impulses import Touches
from watchsim.scene.scene import Scene
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

Array = NDArray[np.float64]

RESIDUAL = 1e-6  # of the energy turned over, at tolerances up to 1e-8
OVERLAP = 2e-5  # of the size: what counts as material inside material, at tolerances up to 1e-8
JUMP = (
    3e-5  # of the largest speed, in the metric of the masses: joints up to 1e-5 rad are handed over as tangent, without impact
)
NEAR = 1e-6  # of the size: outlines this close touch
ONWARD = 1e-4  # of the size: bodies that turn this far part by its square, less than `NEAR`
OUTSIDE = 1e-3  # share of a jump that no impulses of the contacts explain
AUDITED = 6  # jumps of a run
LOOKS = 8  # for overlap, evenly spread over the run
SHIFT = 1e3  # tolerances of the size: drift of one tolerance, between faces at the smallest angle that is corrected, 1e-3
OPPOSED = 1e-13  # rounding of forces that cancel, as a share of what they would give without each other
MANY = 20_000  # events
NESTED = 10.0  # times the square of the rebounds until a contact rests: bodies that rattle on what rattles itself
AT_REST = 1e-6  # of the first rebound's speed
SUDDEN = (EventKind.IMPACT, EventKind.ACCUMULATION, EventKind.JAM)


def faults(run: Trajectory, material: Material) -> Iterator[str]:
    """What is wrong with the run by itself, a phrase each: the first word names the class."""
    if run.stop.gave_up or run.stop == Stop.INTERRUPTED:
        yield f"{'hanging' if run.stop == Stop.INTERRUPTED else 'gave up'}: {run.stop.name} at t = {run.simulated:.6g} s"
    if len(run.t) == 0:
        return
    loose = max(1.0, run.tolerance / 1e-8)
    scene, m = run.scene, masses(run.scene)
    kinetic = 0.5 * (run.u**2) @ m
    turned_over = max(float(kinetic.max()), abs(run.energy["in_J"]), sum(run.energy["dissipated"].values()))
    turned_over = max(turned_over, abs(run.energy["stored_J"]))
    residual = abs(run.energy["residual_J"])
    allowed = RESIDUAL * loose * turned_over + OPPOSED * unopposed(scene, run.simulated)
    allowed += of_a_step(scene, run.tolerance, float(kinetic.max()))
    if turned_over > 0.0 and residual > allowed:
        yield f"residual: {residual / turned_over:.1e} of the energy turned over"
    yield from _rise(run, kinetic + potential(scene, run), allowed, turned_over)
    if len(run.events) > most_events(run.scene):
        yield f"events: {len(run.events)}"
    deep, when = _overlap(run, material)
    if deep > OVERLAP * loose * material.size:
        share, told = deep / material.size, run.worst_penetration / material.size
        yield f"overlap: {share:.1e} of the size at t = {when:.6g} s, reported {told:.1e}"
    yield from _shifts(run, SHIFT * max(run.tolerance, 1e-9) * material.size)
    yield from _jumps(run, m, float(kinetic.max()), loose)


def most_events(scene: Scene) -> float:
    """More are wrong. What loses nothing, or stands on it, may go on bouncing, however low; what loses little bounces long."""
    restitution = max((contact.restitution for contact in scene.contacts), default=0.0)
    if restitution in (0.0, 1.0):
        return math.inf if restitution else MANY
    return max(MANY, NESTED * (math.log(AT_REST) / math.log(restitution)) ** 2)


def _rise(run: Trajectory, total: Array, allowed: float, scale: float) -> Iterator[str]:
    """Energy with that of the drives never grows."""
    rise = total - np.minimum.accumulate(total)
    worst = int(np.argmax(rise))
    if rise[worst] > allowed:
        yield f"energy: rises by {rise[worst] / scale:.1e} of what is turned over, until t = {run.t[worst]:.6g} s"


def _overlap(run: Trajectory, material: Material) -> tuple[float, float]:
    times = np.linspace(0.0, run.simulated, LOOKS + 1)[1:]
    q, _ = run.sample(times)
    deepest, when = 0.0, 0.0
    for t, row in zip(times, q, strict=True):
        depth = material.depth({body.name: run.pose_of(body.name, row) for body in run.scene.bodies})
        if depth > deepest:
            deepest, when = depth, float(t)
    return deepest, when


def _shifts(run: Trajectory, allowed: float) -> Iterator[str]:
    """Bodies are where they were: positions do not jump. Angles count with the body's reach."""
    jump = np.abs(np.diff(run.q, axis=0))[np.diff(run.t) == 0.0]
    if len(jump):
        worst = int(np.argmax(jump.max(axis=1)))
        far = float((jump[worst] * _lengths(run.scene)).max())
        if far > allowed:
            t = run.t[:-1][np.diff(run.t) == 0.0][worst]
            yield f"shift: coordinates jump by {far:.1e} m at t = {t:.9g} s"


def _lengths(scene: Scene) -> Array:
    """(n,): what makes lengths of coordinates."""
    found: list[float] = []
    for body in scene.bodies:
        own = 0.0 if body.motion == "fixed" else reach(replace(scene, bodies=(body,)))
        found += {"fixed": [], "pivot": [own], "slide": [1.0], "free": [1.0, 1.0, own]}[body.motion]
    return np.array(found)


def _held(run: Trajectory, events: NDArray[Any], row: int, m: Array) -> Iterator[Array]:
    """What contact forces will do while impacts end by rule, which such an end has taken back; nothing at all comes first.

    The rule (method, 2.9) sets the velocities such that the motion is right at the end of that time T: the contacts make
    the jump and what their forces do within T.
    """
    yield np.zeros(len(m))
    ends = events["value"][events["kind"] == EventKind.ACCUMULATION]
    if len(ends):
        yield (run.a[row] - pulls(run.scene, run, row) / m) * float(ends.max() - run.t[row])


def _onward(run: Trajectory, row: int) -> Array:
    """(n,): where the motion before a jam leads to within `ONWARD` of the size.

    On the line of centres the two ends of a cone are parallel. What locks there is found from the cones that open behind it.
    """
    way: Array = run.u[row] * (ONWARD * reach(run.scene) / float(np.abs(run.u[row] * _lengths(run.scene)).max()))
    return run.q[row] + way


def _jumps(run: Trajectory, m: Array, largest: float, loose: float) -> Iterator[str]:
    """Each jump of velocity must come from impulses that push, within the cones of friction, where outlines touch."""
    first = np.flatnonzero((np.diff(run.t) == 0.0) & np.append(True, np.diff(run.t)[:-1] > 0.0))
    if not len(first):
        return
    last = np.searchsorted(run.t, run.t[first], side="right") - 1
    size = 0.5 * ((run.u[last] - run.u[first]) ** 2) @ m
    touches = None
    for k in np.argsort(-size)[:AUDITED]:
        if size[k] <= JUMP**2 * largest:
            return
        row, then = int(first[k]), int(last[k])
        t, jump = run.t[row], run.u[then] - run.u[row]
        here = run.events[run.events["t"] == t]
        touches = touches or Touches(run.scene, run.slices, m, NEAR * loose)
        if not np.isin(here["kind"], SUDDEN).any():
            if touches.turn(run.q[then], run.u[row], jump) <= JUMP:
                continue
            yield f"jump: without an impact at t = {t:.9g} s, of {math.sqrt(size[k] / largest):.1e} of the speed"
            return
        found = [touches.unexplained(run.q[then], jump + held) for held in _held(run, here, then, m)]
        if (here["kind"] == EventKind.JAM).any():
            found.append(touches.unexplained(_onward(run, row), jump))
        share, points = min(found)
        part = math.sqrt(size[k] / largest)
        if share > OUTSIDE and share * part > JUMP * loose:
            yield (
                f"impulse: {share:.1e} of a jump of {part:.1e} of the speed at t = {t:.9g} s lies outside the cones of "
                f"{points} contacts"
            )
            return
