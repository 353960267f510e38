"""Which forces act at contacts and pivots, at any time of a run?

A run keeps where its bodies were and which contact had which mode. Between events the forces follow from these: a contact in
force does not accelerate apart, a sticking one does not slip, a sliding one rubs (docs/theory/method.md 2.4).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.balanced_forces import Balanced, Mechanism
from watchsim.analysis.mesh_forces import Loads, Motion, Pressed, mesh_forces
from watchsim.analysis.modes_in_force import modes_in_force
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.oscillation import loads
from watchsim.scene.recording import STATISTICS
from watchsim.simulation.methods import EVENT_DRIVEN
from watchsim.simulation.record.trajectory import Array, Trajectory


@dataclass(frozen=True)
class Forces:
    """At times t (n,), s. Contacts are those that were in force at any of them, in the order of `pairs`.

    pairs       row of `Trajectory.pairs` of each contact (k,)
    normal      how hard it presses, N (n, k); 0 where it is open
    tangential  along t, the normal turned by +90°, on body A, N (n, k)
    direction   the normal, out of body B's material (n, k, 2); nan where it is open
    point       where it touches, m (n, k, 2); nan where it is open
    pivots      name of a pivoted body -> force on it from its bearing in the movement, N (n, 2), with that of the teeth of
                [[gears]] (`mesh_forces`); what springs between points do to it is left out
    drives      name of a driven body -> torque, N·m, or force along its axis, N, that keeps its motion up (n,)
    """

    t: Array
    pairs: NDArray[np.int64]
    normal: Array
    tangential: Array
    direction: Array
    point: Array
    pivots: dict[str, Array]
    drives: dict[str, Array]

    def __repr__(self) -> str:
        most = f"up to {self.normal.max():.3g} N at {len(self.pairs)} contacts" if self.normal.size else "no contact in force"
        return f"<Forces at {len(self.t)} instants: {most}; pivots of {', '.join(self.pivots) or 'nothing'}>"


def forces(run: Trajectory, times: Iterable[float] | float | None = None) -> Forces:
    """Forces at these times (s) or this one, by default at all rows; after an impact where one happens at that time.

    Where contacts are redundant the smallest forces are given. ValueError for a run by fixed steps, whose contacts have
    impulses only, and where events were not kept.
    """
    if run.method != EVENT_DRIVEN:
        raise ValueError(f"forces need a run by events; {run.method} knows impulses over its steps only")
    if run.keep == STATISTICS:
        raise ValueError('forces need all events of a run: simulate with record = "events", "all" or windows')
    if isinstance(times, Iterable) and not isinstance(times, np.ndarray):
        times = list(times)
    t = np.atleast_1d(np.array(run.t if times is None else times, float))
    q, u = run.sample(t)
    compiled = compile_scene(run.scene)
    where, speed = absolute(compiled, q, False), absolute(compiled, u, True)
    mechanism = Mechanism(compiled)
    alike = modes_in_force(run, t)
    pairs = np.array(sorted({k for in_force in alike for k, _ in in_force}), np.int64)
    shape = (len(t), len(pairs), 2)
    force, pressed, load, turning = np.zeros((2, *shape[:2])), np.zeros(shape), np.zeros(where.shape), np.zeros(where.shape)
    out = Forces(t, pairs, force[0], force[1], np.full(shape, np.nan), np.full(shape, np.nan), {}, {})
    for in_force, rows in alike.items():
        found = mechanism.balanced(t[rows], where[rows], speed[rows], dict(in_force))
        place = np.ix_(np.array(rows), np.searchsorted(pairs, found.ids))
        out.normal[place], out.tangential[place] = found.force[:, :, 0], found.force[:, :, 1]
        out.direction[place], out.point[place], pressed[place] = found.normal, found.point, _pressed(found)
        load[rows], turning[rows] = found.load, found.acceleration
    motion = Motion(t, where, speed, turning)
    both = Loads(pairs, np.moveaxis(force, 0, 2), pressed)
    meshed = list(mesh_forces(run.scene, compiled, motion, both))
    out.pivots.update(_pivots(run, compiled, motion, both, meshed))
    out.drives.update(_drives(run, compiled, load, turning))
    return out


def absolute(compiled: Compiled, values: Array, rates: bool) -> Array:
    """Coordinates in the movement from those that the trajectory gives: the inverse of `Compiled.relative`."""
    out = np.array(values)
    out = out[:, : len(compiled.q)]  # what is geared to others follows from them
    for own, on, angle in compiled.against:  # carriers come before what they carry
        out[:, own] += (out[:, on] if on >= 0 else 0.0) + (0.0 if rates else angle)
    return out


def _pressed(found: Balanced) -> Array:
    """Force on body A of each contact, N (n, m, 2)."""
    across = np.stack((-found.normal[:, :, 1], found.normal[:, :, 0]), axis=2)
    return np.asarray(found.force[:, :, :1] * found.normal + found.force[:, :, 1:] * across)


def _pivots(
    run: Trajectory, compiled: Compiled, motion: Motion, loads_found: Loads, meshed: list[Pressed]
) -> Iterator[tuple[str, Array]]:
    """What the bearings in the movement take: change of momentum less weight less contacts, of a body with all it carries."""
    hung, weighed, _ = loads(run.scene.bodies)
    on_a, on_b = _bodies_of(compiled, loads_found.ids)
    for i, (body, ride, load) in enumerate(zip(run.scene.bodies, hung, weighed, strict=True)):
        if body.motion != "pivot" or ride.host >= 0:
            continue
        own = [k for k, other in enumerate(hung) if i in (k, other.part_of, other.host)]
        sign = np.isin(on_a, own).astype(float) - np.isin(on_b, own).astype(float)
        angle, spin, turn = (
            compiled.own(i, values, rates) for values, rates in ((motion.q, False), (motion.u, True), (motion.a, True))
        )
        c, s = np.cos(angle), np.sin(angle)
        moment = np.stack((c * load.moment[0] - s * load.moment[1], s * load.moment[0] + c * load.moment[1]), axis=1)
        change = turn[:, None] * np.stack((-moment[:, 1], moment[:, 0]), axis=1) - (spin * spin)[:, None] * moment
        pressed = np.einsum("k,nkx->nx", sign, loads_found.pressed) + sum(one.force for one in meshed if one.body in own)
        yield body.name, change - load.mass * np.array(run.scene.gravity) - pressed


def _drives(run: Trajectory, compiled: Compiled, load: Array, a: Array) -> Iterator[tuple[str, Array]]:
    """Against the contacts, and for the acceleration of as much mass or inertia as the scene gives the body."""
    for body, mass in zip(run.scene.bodies, loads(run.scene.bodies)[2], strict=True):
        if body.prescribed is not None:
            j = compiled.slices[body.name].start
            yield body.name, mass * a[:, j] - load[:, j]


def _bodies_of(compiled: Compiled, pairs: NDArray[np.int64]) -> tuple[Array, Array]:
    """The bodies of the model on both sides of each contact."""
    contacts, primitives = compiled.model.contacts[pairs], compiled.model.primitives
    return primitives.body[contacts.a], primitives.body[contacts.b]
